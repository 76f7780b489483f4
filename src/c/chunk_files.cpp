#include "c/chunk_files.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "c/strided_points.hpp"
#include "files/file.hpp"
#include "files/mesh_stream.hpp"
#include "files/output.hpp"
#include "large/chunks/array_sink.hpp"

namespace flaunay::c {
namespace {

using Paths = std::array<std::string, io::kMeshArrays>;

Paths to_paths(const flaunay_mesh_files& files, const flaunay_mesh_arrays& arrays) {
  struct Part {
    const char* name;
    const char* path;
    const void* array;
  };
#define PART(name) Part{#name, files.name, arrays.name},
  const std::array parts = {FLAUNAY_MESH_ARRAYS(PART) PART(corner_offsets)};
#undef PART
  Paths paths;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k].path == nullptr) continue;
    if (parts[k].array != nullptr) {
      throw Error(ErrorKind::usage,
                  fmt::format("{} are wanted in an array and in a file; only one of them is possible",
                              parts[k].name));
    }
    io::check_ending(parts[k].path, ".npy");
    if (k < paths.size()) paths[k] = parts[k].path;
  }
  return paths;
}

// Each part goes to its file, or else to its array.
template <typename Index>
class Results : public MeshSink {
 public:
  Results(const flaunay_mesh_arrays& arrays, const flaunay_mesh_files& files, std::uint64_t n,
          const std::string& scratch)
      : paths_(to_paths(files, arrays)),
        corner_offsets_(files.corner_offsets != nullptr ? files.corner_offsets : ""),
        files_(outputs_, paths_, kType, {}, corner_offsets_),
        arrays_(to_arrays<Index>(arrays)) {
    io::check_room(paths_, n, kType, scratch, corner_offsets_);
  }

  bool wants(MeshArray array) const override { return files_.wants(array) || arrays_.wants(array); }

  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override {
    sink_of(array).write(array, first, values, count);
  }
  void write_doubles(MeshArray array, std::uint64_t first, const double* values, std::size_t count) override {
    sink_of(array).write_doubles(array, first, values, count);
  }
  void write_corner_offsets(std::uint64_t first, const std::int8_t* values, std::size_t count) override {
    files_.write_corner_offsets(first, values, count);
    arrays_.write_corner_offsets(first, values, count);
  }

  // Gives the files their names, all or none.
  void commit(std::uint64_t triangles) {
    files_.keep_triangles(triangles);
    files_.finish();
    outputs_.commit();
  }

 private:
  MeshSink& sink_of(MeshArray array) {
    if (files_.wants(array)) return files_;
    return arrays_;
  }

  static constexpr io::IndexType kType = sizeof(Index) == 4 ? io::IndexType::int32 : io::IndexType::int64;

  io::Outputs outputs_;
  Paths paths_;
  std::string corner_offsets_;
  io::MeshFiles files_;
  chunks::ArraySink<Index> arrays_;
};

// Neighbours refer to triangles, of which there may be twice as many as points.
template <typename Index>
void check_index_type(std::uint64_t n, bool has_neighbors) {
  const std::uint64_t most = std::numeric_limits<Index>::max() / (has_neighbors ? 2 : 1);
  if (n <= most) return;
  throw Error(ErrorKind::input,
              fmt::format("{} points are too many for indices of {} bits; at most {} are possible", n,
                          8 * sizeof(Index), most));
}

template <typename Index>
ChunkStatistics triangulate(PointSource& source, const flaunay_mesh_arrays& arrays,
                            const flaunay_mesh_files& files, const ChunkOptions& options) {
  // First what the input says: it has the same error on every disk.
  check_index_type<Index>(source.size(), arrays.neighbors != nullptr || files.neighbors != nullptr);
  Results<Index> results(arrays, files, source.size(), options.scratch);
  ChunkStatistics statistics = triangulate_chunks(source, results, options);
  results.commit(statistics.triangles);
  return statistics;
}

}  // namespace

ChunkStatistics triangulate_to_files(const flaunay_strided_points& points, const flaunay_mesh_arrays& arrays,
                                     const flaunay_mesh_files& files, const ChunkOptions& options) {
  check_reserved(arrays);
  check_reserved(files);
  chunks::check_corner_offsets(options.space,
                               arrays.corner_offsets != nullptr || files.corner_offsets != nullptr);
  StridedPoints source(points);
  switch (arrays.index_type) {
    case FLAUNAY_INT32:
      return triangulate<std::int32_t>(source, arrays, files, options);
    case FLAUNAY_INT64:
      return triangulate<std::int64_t>(source, arrays, files, options);
  }
  throw Error(ErrorKind::usage, fmt::format("there is no type of indices {}", arrays.index_type));
}

}  // namespace flaunay::c
