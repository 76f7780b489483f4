// The public calls for triangulations in chunks: devices, memory, arrays.
#include "large/chunks/chunk_calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include "call/implementation.hpp"
#include "call/with_errors.hpp"
#include "flaunay/chunks.hpp"
#include "geometry/arguments.hpp"
#include "host/memory/system_memory.hpp"
#include "large/chunks/array_sink.hpp"
#include "large/chunks/run.hpp"
#include "tuning/tuning.hpp"

namespace flaunay {
namespace {

// Memory that a call uses with chunks of any size.
constexpr std::uint64_t kFixedBytes = std::uint64_t{64} << 20;
// Bytes on the host per point of a chunk: the points that are read ahead, the triangulation with its working
// memory, the results, and the results of the chunk before, which are being written.
constexpr std::uint64_t kBytesPerPoint = 480;
// The areas of a chunk and of the chunk before, if areas are wanted.
constexpr std::uint64_t kAreasBytesPerPoint = 2 * 2 * sizeof(double);
// The values of a chunk's points while it is triangulated, while its triangles are scanned, and while the
// next chunk is read; and the indices of the triangles that are scanned.
constexpr std::uint64_t kValuesBytesPerPoint = 3 * sizeof(double) + 24;
// Chunks differ in size: a chunk with more than one and a half times the planned points is cut again.
constexpr double kMostUnequal = 1.6;
constexpr std::uint64_t kBufferShare = 16;  // of the memory, to the scratch file

constexpr const char* kAllDevices = "all";

// Devices that cannot be used are left out if all were asked for.
std::vector<std::string> device_names(const std::vector<std::string>& wanted) {
  if (wanted.empty()) return {""};
  if (std::find(wanted.begin(), wanted.end(), kAllDevices) == wanted.end()) return wanted;
  std::vector<std::string> names;
  const std::vector<DeviceInfo> devices = list_devices(true);
  for (std::size_t k = 0; k < devices.size(); ++k) {
    if (devices[k].self_test_passed) names.push_back(fmt::format("#{}", k));
  }
  if (names.empty())
    throw Error(ErrorKind::device, "none of the devices can be used; flaunay devices tells why");
  return names;
}

struct Devices {
  std::vector<chunks::Solver> solvers;
  std::size_t capacity = std::numeric_limits<std::size_t>::max();
  std::size_t chunk_points = std::numeric_limits<std::size_t>::max();  // that suit all of them
};

void add_device(Devices& devices, const std::shared_ptr<Triangulator>& triangulator, bool with_areas) {
  devices.capacity = std::min(devices.capacity, triangulator->capacity());
  call::Engine& engine = TriangulatorAccess::implementation(*triangulator).for_host_memory();
  devices.chunk_points = std::min(devices.chunk_points, tuning_of(engine.runtime).chunk_points);
  devices.solvers.push_back(
      {triangulator->device().name, [triangulator, with_areas](const double* coordinates, std::size_t n) {
         Options options;
         options.areas = with_areas;
         return triangulator->triangulate(coordinates, n, options);
       }});
}

Devices open_devices(const ChunkOptions& options, bool with_areas) {
  Devices devices;
  for (Triangulator* const own : options.triangulators) {
    if (own == nullptr) throw Error(ErrorKind::usage, "a triangulator for chunks is null");
    add_device(devices, std::shared_ptr<Triangulator>(own, [](Triangulator*) {}), with_areas);
  }
  if (!devices.solvers.empty()) return devices;
  for (const std::string& name : device_names(options.devices)) {
    add_device(devices, std::make_shared<Triangulator>(name), with_areas);
  }
  return devices;
}

chunks::Plan make_plan(std::uint64_t n, const ChunkOptions& options, const Devices& devices,
                       std::uint64_t bytes_per_point) {
  const std::uint64_t memory = call::chunk_memory(options);
  chunks::Plan plan;
  plan.buffer_bytes = memory / kBufferShare;
  const std::uint64_t for_chunks = memory - kFixedBytes - plan.buffer_bytes;
  const std::size_t at_once = for_chunks / bytes_per_point;
  plan.largest_chunk = std::min(at_once, devices.capacity);
  if (devices.capacity < at_once) plan.limit = "the smallest device";
  const std::size_t most = std::min(at_once / devices.solvers.size(), devices.capacity);
  const auto on_average = static_cast<std::size_t>(static_cast<double>(most) / kMostUnequal);
  const std::size_t wanted = options.chunk_points != 0 ? options.chunk_points : devices.chunk_points;
  // Each chunk has a buffer.
  const std::uint64_t most_chunks = plan.buffer_bytes / chunks::kBufferUnit;
  plan.chunk_points = std::max<std::size_t>(std::min(on_average, wanted), n / most_chunks + 1);
  return plan;
}

// Points that rows and their number can refer to.
void check_indices(std::uint64_t n, std::uint64_t most_index) {
  if (n <= most_index / 2) return;
  throw Error(
      ErrorKind::input,
      fmt::format(
          "{} points are too many for 32-bit indices of triangles; at most {} are possible, more with "
          "64-bit indices",
          n, most_index / 2));
}

template <typename Index>
ChunkStatistics triangulate_arrays(const double* coordinates, std::uint64_t n,
                                   const MeshArrays<Index>& results, const ChunkOptions& options) {
  check_array(coordinates, n, "points", kMostPointsInChunks);
  check_indices(n, static_cast<std::uint64_t>(std::numeric_limits<Index>::max()));
  chunks::check_corner_offsets(options.space, results.corner_offsets != nullptr);
  ArrayPoints points(coordinates, n);
  chunks::ArraySink<Index> sink(results);
  return triangulate_chunks(points, sink, options);
}

}  // namespace

PointSource::~PointSource() = default;
MeshSink::~MeshSink() = default;
void MeshSink::write_doubles(MeshArray, std::uint64_t, const double*, std::size_t) {}
void MeshSink::write_corner_offsets(std::uint64_t, const std::int8_t*, std::size_t) {}

void ArrayPoints::read(std::uint64_t first, std::size_t count, double* coordinates) {
  std::memcpy(coordinates, coordinates_ + 2 * first, 2 * count * sizeof(double));
}

std::uint64_t call::chunk_memory(const ChunkOptions& options) {
  const std::uint64_t memory =
      options.memory_bytes != 0 ? options.memory_bytes : host::memory_left().bytes / 2;
  if (memory < kLeastChunkBytes) {
    throw Error(ErrorKind::usage, fmt::format("{} of memory are too little for chunks; give at least {}",
                                              host::mebibytes(memory), host::mebibytes(kLeastChunkBytes)));
  }
  return memory;
}

ChunkStatistics call::triangulate_chunks(PointSource& points, const chunks::Values* values, MeshSink& sink,
                                         const ChunkOptions& options, chunks::Folding* folding) {
  if (points.size() == 0) return ChunkStatistics();
  check_count(points.size(), "points", kMostPointsInChunks);
  const bool with_areas = sink.wants(MeshArray::areas);
  const Devices devices = open_devices(options, with_areas);
  const std::uint64_t bytes_per_point = kBytesPerPoint + (with_areas ? kAreasBytesPerPoint : 0) +
                                        (values != nullptr ? kValuesBytesPerPoint : 0);
  const chunks::Plan plan = make_plan(points.size(), options, devices, bytes_per_point);
  return chunks::run(points, values, sink, plan, devices.solvers, options, folding);
}

ChunkStatistics triangulate_chunks(PointSource& points, MeshSink& sink, const ChunkOptions& options) {
  return with_errors([&] {
    const Space& space = options.space;
    const bool is_on_torus = space.kind == SpaceKind::torus;
    expect((is_on_torus || space.kind == SpaceKind::plane) && space.weights == nullptr,
           "chunks are of points without weights in the plane, on a torus or on a cylinder");
    return is_on_torus ? call::triangulate_chunks_on_torus(points, sink, options)
                       : call::triangulate_chunks(points, nullptr, sink, options);
  });
}

ChunkStatistics triangulate_chunks(const double* coordinates, std::uint64_t n,
                                   const MeshArrays<std::int32_t>& results, const ChunkOptions& options) {
  return triangulate_arrays(coordinates, n, results, options);
}

ChunkStatistics triangulate_chunks(const double* coordinates, std::uint64_t n,
                                   const MeshArrays<std::int64_t>& results, const ChunkOptions& options) {
  return triangulate_arrays(coordinates, n, results, options);
}

}  // namespace flaunay
