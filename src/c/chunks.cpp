// The C interface to triangulations in chunks.
#include "flaunay/chunks.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "c/chunk_files.hpp"
#include "c/errors.hpp"
#include "c/handles.hpp"
#include "c/raster.hpp"
#include "c/strided_points.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/terrain.hpp"
#include "large/chunks/array_sink.hpp"

using namespace flaunay;

using c::create;
using c::guarded;
using c::read;
using c::required;

struct flaunay_chunk_report {
  explicit flaunay_chunk_report(ChunkStatistics done) : cpp(std::move(done)) {
    for (const ChunkRound& round : cpp.rounds) {
      rounds.push_back({round.points, round.chunks, round.triangles, round.handed_on});
    }
    for (std::size_t k = 0; k < cpp.devices.size(); ++k) {
      devices.push_back({cpp.devices[k].c_str(), cpp.device_points[k]});
    }
    for (const PhaseStatistics& phase : cpp.phases) phases.push_back({phase.name.c_str(), phase.seconds});
    c::show<"rounds", "round_count", "devices", "device_count", "phases", "phase_count">(cpp, view);
    view.rounds = c::elements(rounds);
    view.round_count = rounds.size();
    view.devices = c::elements(devices);
    view.device_count = devices.size();
    view.phases = c::elements(phases);
    view.phase_count = phases.size();
  }
  // The view refers to the other members.
  flaunay_chunk_report(const flaunay_chunk_report&) = delete;
  flaunay_chunk_report& operator=(const flaunay_chunk_report&) = delete;

  ChunkStatistics cpp;
  std::vector<flaunay_chunk_round> rounds;
  std::vector<flaunay_chunk_device> devices;
  std::vector<flaunay_phase> phases;
  flaunay_chunk_statistics view{};
};

namespace {

void stop_unless_zero(int returned, const char* function) {
  if (returned != 0)
    throw c::Stopped(fmt::format("the caller's function {} returned {}", function, returned));
}

ChunkOptions to_options(const flaunay_chunk_options* options) {
  ChunkOptions result;
  if (options == nullptr) return result;
  c::take<"devices", "device_count", "triangulators", "triangulator_count", "progress", "progress_data",
          "space">(*options, result);
  result.space = c::to_space(options->space);
  check_array(options->devices, options->device_count, "devices");
  for (std::size_t k = 0; k < options->device_count; ++k) {
    result.devices.emplace_back(options->devices[k] != nullptr ? options->devices[k] : "");
  }
  check_array(options->triangulators, options->triangulator_count, "triangulators");
  for (std::size_t k = 0; k < options->triangulator_count; ++k) {
    result.triangulators.push_back(&required(options->triangulators[k], "a triangulator for chunks").cpp);
  }
  if (options->progress != nullptr) {
    result.progress = [call = options->progress, data = options->progress_data](const std::string& stage,
                                                                                int round, double done) {
      stop_unless_zero(call(stage.c_str(), round, done, data), "progress");
    };
  }
  return result;
}

ChunkStatistics triangulate(const double* coordinates, std::uint64_t n, const flaunay_mesh_arrays& results,
                            const ChunkOptions& options) {
  c::check_reserved(results);
  switch (results.index_type) {
    case FLAUNAY_INT32:
      return triangulate_chunks(coordinates, n, c::to_arrays<std::int32_t>(results), options);
    case FLAUNAY_INT64:
      return triangulate_chunks(coordinates, n, c::to_arrays<std::int64_t>(results), options);
  }
  throw Error(ErrorKind::usage, fmt::format("there is no type of indices {}", results.index_type));
}

class CallersPoints : public PointSource {
 public:
  explicit CallersPoints(const flaunay_point_source& given) : given_(given) {
    c::check_reserved(given);
    if (given.count > 0) required(given.read, "the function that reads points");
  }
  std::uint64_t size() const override { return given_.count; }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    stop_unless_zero(given_.read(first, count, coordinates, given_.data), "read");
  }

 private:
  const flaunay_point_source& given_;
};

class StridedValuedPoints : public ValuedPoints {
 public:
  StridedValuedPoints(const flaunay_strided_points& points, const flaunay_strided_values& values)
      : points_(points), values_(values.values, values.precision, values.stride) {
    c::check_reserved(values);
    check_array(values.values, points.count, "values", kMostPointsInChunks);
  }
  std::uint64_t size() const override { return points_.size(); }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    points_.read(first, count, coordinates);
  }
  void read_values(std::uint64_t first, std::size_t count, double* values) override {
    values_.read(first, count, values, 1);
  }

 private:
  c::StridedPoints points_;
  c::StridedNumbers values_;
};

class CallersValuedPoints : public ValuedPoints {
 public:
  CallersValuedPoints(const flaunay_point_source& points, const flaunay_value_source& values)
      : points_(points), values_(values) {
    c::check_reserved(values);
    if (points.count > 0) required(values.read, "the function that reads values");
  }
  std::uint64_t size() const override { return points_.size(); }
  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    points_.read(first, count, coordinates);
  }
  void read_values(std::uint64_t first, std::size_t count, double* values) override {
    stop_unless_zero(values_.read(first, count, values, values_.data), "read of values");
  }

 private:
  CallersPoints points_;
  const flaunay_value_source& values_;
};

std::unique_ptr<flaunay_chunk_report> rasterize(ValuedPoints& points, int duplicates,
                                                const flaunay_raster& raster, double* pixels,
                                                const std::vector<double>& heights,
                                                flaunay_contours** contours,
                                                const flaunay_breaklines* breaklines,
                                                const flaunay_chunk_options* options) {
  Breaklines edges;
  if (breaklines != nullptr) {
    c::take<"count">(*breaklines, edges);
    edges.points = breaklines->count;
  }
  const c::AskedRaster asked = c::to_raster(raster);
  auto lines = std::make_unique<flaunay_contours>();
  auto report = std::make_unique<flaunay_chunk_report>(
      rasterize_chunks(points, c::to_enum<Duplicates>(duplicates), asked, asked, pixels, heights, lines->cpp,
                       edges, to_options(options)));
  if (contours != nullptr) *contours = lines.release();
  return report;
}

// Bit k of flaunay_part stands for the k-th array.
unsigned part_of(MeshArray array) { return 1u << kMeshArrayIndices[static_cast<std::size_t>(array)]; }

class CallersSink : public MeshSink {
 public:
  CallersSink(const flaunay_mesh_sink& given, const Space& space) : given_(given) {
    c::check_reserved(given);
    unsigned possible = FLAUNAY_PART_CORNER_OFFSETS;
    for (const std::size_t k : kMeshArrayIndices) possible |= 1u << k;
    if ((given.parts & ~possible) != 0) {
      throw Error(ErrorKind::usage,
                  fmt::format("triangulations in chunks have no parts {:#x}", given.parts & ~possible));
    }
    if (given.parts != 0) parts_ = given.parts;
    const unsigned doubles = part_of(MeshArray::areas);
    const bool has_corner_offsets = (parts_ & FLAUNAY_PART_CORNER_OFFSETS) != 0;
    if ((parts_ & ~(doubles | FLAUNAY_PART_CORNER_OFFSETS)) != 0)
      required(given.write, "the function that writes results");
    if ((parts_ & doubles) != 0) required(given.write_doubles, "the function that writes results in doubles");
    if (has_corner_offsets) required(given.write_corner_offsets, "the function that writes corner offsets");
    chunks::check_corner_offsets(space, has_corner_offsets);
  }
  bool wants(MeshArray array) const override { return (parts_ & part_of(array)) != 0; }
  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override {
    stop_unless_zero(given_.write(part_of(array), first, values, count, given_.data), "write");
  }
  void write_doubles(MeshArray array, std::uint64_t first, const double* values, std::size_t count) override {
    stop_unless_zero(given_.write_doubles(part_of(array), first, values, count, given_.data),
                     "write_doubles");
  }
  void write_corner_offsets(std::uint64_t first, const std::int8_t* values, std::size_t count) override {
    if ((parts_ & FLAUNAY_PART_CORNER_OFFSETS) == 0) return;
    stop_unless_zero(given_.write_corner_offsets(first, values, count, given_.data), "write_corner_offsets");
  }

 private:
  const flaunay_mesh_sink& given_;
  unsigned parts_ = FLAUNAY_PART_TRIANGLES;
};

}  // namespace

flaunay_status flaunay_triangulate_chunks(const double* coordinates, uint64_t n,
                                          const flaunay_mesh_arrays* results,
                                          const flaunay_chunk_options* options,
                                          flaunay_chunk_report** report) {
  return create(report, [&] {
    return std::make_unique<flaunay_chunk_report>(
        triangulate(coordinates, n, required(results, "the results"), to_options(options)));
  });
}

flaunay_status flaunay_triangulate_streams(const flaunay_point_source* points,
                                           const flaunay_mesh_sink* results,
                                           const flaunay_chunk_options* options,
                                           flaunay_chunk_report** report) {
  return create(report, [&] {
    CallersPoints source(required(points, "the points"));
    const ChunkOptions wanted = to_options(options);
    CallersSink sink(required(results, "the results"), wanted.space);
    return std::make_unique<flaunay_chunk_report>(triangulate_chunks(source, sink, wanted));
  });
}

flaunay_status flaunay_triangulate_chunks_to_files(const flaunay_strided_points* points,
                                                   const flaunay_mesh_arrays* arrays,
                                                   const flaunay_mesh_files* files,
                                                   const flaunay_chunk_options* options,
                                                   flaunay_chunk_report** report) {
  return create(report, [&] {
    const flaunay_mesh_arrays no_arrays{};
    const flaunay_mesh_files no_files{};
    return std::make_unique<flaunay_chunk_report>(
        c::triangulate_to_files(required(points, "the points"), arrays != nullptr ? *arrays : no_arrays,
                                files != nullptr ? *files : no_files, to_options(options)));
  });
}

flaunay_status flaunay_take_to_places(double* period, double* points, size_t n) {
  return guarded([&] {
    required(period, "the period");
    const Period rounded = take_to_places({period[0], period[1], period[2]}, points, n);
    period[0] = rounded.x;
    period[1] = rounded.y;
    period[2] = rounded.shear;
  });
}

flaunay_status flaunay_rasterize_chunks(const flaunay_strided_points* points,
                                        const flaunay_strided_values* values, int duplicates,
                                        const flaunay_raster* raster, double* pixels, const double* heights,
                                        size_t height_count, flaunay_contours** contours,
                                        const flaunay_breaklines* breaklines,
                                        const flaunay_chunk_options* options, flaunay_chunk_report** report) {
  return create(report, [&] {
    if (contours != nullptr) *contours = nullptr;
    StridedValuedPoints source(required(points, "the points"), required(values, "the values"));
    return rasterize(source, duplicates, required(raster, "the raster"), pixels,
                     c::to_heights(heights, height_count), contours, breaklines, options);
  });
}

flaunay_status flaunay_rasterize_streams(const flaunay_point_source* points,
                                         const flaunay_value_source* values, int duplicates,
                                         const flaunay_raster* raster, double* pixels, const double* heights,
                                         size_t height_count, flaunay_contours** contours,
                                         const flaunay_breaklines* breaklines,
                                         const flaunay_chunk_options* options,
                                         flaunay_chunk_report** report) {
  return create(report, [&] {
    if (contours != nullptr) *contours = nullptr;
    CallersValuedPoints source(required(points, "the points"), required(values, "the values"));
    return rasterize(source, duplicates, required(raster, "the raster"), pixels,
                     c::to_heights(heights, height_count), contours, breaklines, options);
  });
}

FLAUNAY_DESTROY(chunk_report)
FLAUNAY_ACCESSOR(const flaunay_chunk_statistics*, chunk_report, statistics, &handle.view)
