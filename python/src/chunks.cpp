// Triangulations in chunks: arrays that may be mapped into memory are read in pieces, and results go to .npy
// files or to arrays.
#include "flaunay/chunks.hpp"

#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include "bindings.hpp"
#include "chunks/array_sink.hpp"
#include "io/mesh.hpp"
#include "io/mesh_stream.hpp"
#include "io/output.hpp"

namespace flaunay::python {
namespace {

constexpr std::array<const char*, io::kMeshArrays> kNames = {"triangles", "neighbors", "hull",
                                                             "representatives"};
constexpr const char* kEnding = ".npy";

// Points of an array with any strides, of float64 or float32.
template <typename Coordinate>
class StridedPoints : public PointSource {
 public:
  explicit StridedPoints(const py::array& points)
      : data_(static_cast<const char*>(points.data())),
        n_(count_points(points)),
        row_(points.strides(0)),
        column_(points.strides(1)) {}

  std::uint64_t size() const override { return n_; }

  void read(std::uint64_t first, std::size_t count, double* coordinates) override {
    const char* row = data_ + static_cast<py::ssize_t>(first) * row_;
    for (std::size_t k = 0; k < count; ++k, row += row_) {
      coordinates[2 * k] = at(row);
      coordinates[2 * k + 1] = at(row + column_);
    }
  }

 private:
  // An element may be anywhere, as in a field of records.
  static double at(const char* place) {
    Coordinate value;
    std::memcpy(&value, place, sizeof value);
    return value;
  }

  const char* data_;
  std::uint64_t n_;
  py::ssize_t row_, column_;
};

// What is wanted: the path of a file, or an array in memory.
using Wanted = std::map<std::string, std::optional<std::string>>;
using Paths = std::array<std::string, io::kMeshArrays>;

// Results of n points. All calls but the constructor and take() need no lock of the interpreter.
template <typename Index>
class Results : public MeshSink {
 public:
  Results(const Wanted& wanted, std::uint64_t n, const std::string& scratch)
      : paths_(paths_of(wanted)), files_(outputs_, paths_, kType), in_memory_(allocate(wanted, n)) {
    io::check_room(paths_, n, kType, scratch);
  }

  bool wants(MeshArray array) const override { return files_.wants(array) || in_memory_.wants(array); }

  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override {
    if (files_.wants(array)) {
      files_.write(array, first, values, count);
    } else {
      in_memory_.write(array, first, values, count);
    }
  }

  // Gives the files their names, all or none.
  void commit() {
    files_.finish();
    outputs_.commit();
  }

  // The arrays in memory, with room for more rows than there are.
  std::map<std::string, py::array> take() { return std::move(arrays_); }

 private:
  static constexpr io::IndexType kType = sizeof(Index) == 4 ? io::IndexType::int32 : io::IndexType::int64;

  static Paths paths_of(const Wanted& wanted) {
    Paths paths;
    for (std::size_t k = 0; k < io::kMeshArrays; ++k) {
      const auto found = wanted.find(kNames[k]);
      if (found == wanted.end() || !found->second) continue;
      io::check_output(*found->second, kEnding);
      paths[k] = *found->second;
    }
    return paths;
  }

  // What is never written is never in memory.
  chunks::ArraySink<Index> allocate(const Wanted& wanted, std::uint64_t n) {
    MeshArrays<Index> places;
    const std::array<Index**, io::kMeshArrays> members = {&places.triangles, &places.neighbors, &places.hull,
                                                          &places.representatives};
    for (std::size_t k = 0; k < io::kMeshArrays; ++k) {
      const auto found = wanted.find(kNames[k]);
      if (found == wanted.end() || found->second) continue;
      const auto size = static_cast<py::ssize_t>(n);
      const auto columns = static_cast<py::ssize_t>(io::columns_of(static_cast<MeshArray>(k)));
      py::array_t<Index> array(columns == 0 ? std::vector<py::ssize_t>{size}
                                            : std::vector<py::ssize_t>{2 * size, columns});
      *members[k] = array.mutable_data();
      arrays_[kNames[k]] = std::move(array);
    }
    return chunks::ArraySink<Index>(places);
  }

  std::map<std::string, py::array> arrays_;
  io::Outputs outputs_;
  Paths paths_;
  io::MeshFiles files_;
  chunks::ArraySink<Index> in_memory_;
};

py::dict to_dict(const ChunkStatistics& statistics) {
  py::list rounds, devices;
  for (const ChunkRound& round : statistics.rounds) {
    py::dict row;
    row["points"] = round.points;
    row["chunks"] = round.chunks;
    row["triangles"] = round.triangles;
    row["handed_on"] = round.handed_on;
    rounds.append(row);
  }
  for (std::size_t k = 0; k < statistics.devices.size(); ++k) {
    py::dict row;
    row["device"] = statistics.devices[k];
    row["points"] = statistics.device_points[k];
    devices.append(row);
  }
  py::dict result;
  result["points"] = statistics.points;
  result["duplicates"] = statistics.duplicates;
  result["triangles"] = statistics.triangles;
  result["hull_vertices"] = statistics.hull_vertices;
  result["undecided"] = statistics.undecided;
  result["scratch_bytes"] = statistics.scratch_bytes;
  result["chunk_points"] = statistics.chunk_points;
  result["rounds"] = rounds;
  result["devices"] = devices;
  result["phases"] = phases_to_dict(statistics.phases);
  result["seconds"] = statistics.seconds;
  return result;
}

// Signals are handled between pieces of the work, so that Ctrl-C ends it.
std::function<void(const std::string&, int, double)> with_signals(const py::object& progress) {
  // By reference: a copy would need the interpreter's lock.
  return [&progress](const std::string& stage, int round, double done) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!progress.is_none()) progress(stage, round, done);
  };
}

template <typename Index>
py::tuple run(PointSource& source, const Wanted& wanted, const ChunkOptions& options) {
  Results<Index> results(wanted, source.size(), options.scratch);
  ChunkStatistics statistics;
  {
    const py::gil_scoped_release release;
    statistics = flaunay::triangulate_chunks(source, results, options);
    results.commit();
  }
  return py::make_tuple(results.take(), to_dict(statistics));
}

template <typename Coordinate>
py::tuple triangulate(const py::array& points, const Wanted& wanted, bool wide, const ChunkOptions& options) {
  StridedPoints<Coordinate> source(points);
  return wide ? run<std::int64_t>(source, wanted, options) : run<std::int32_t>(source, wanted, options);
}

py::tuple triangulate_chunks(const py::array& points, const Wanted& wanted, bool wide, std::uint64_t memory,
                             const std::string& scratch, const std::vector<std::string>& devices,
                             std::size_t chunk_points, const py::object& progress) {
  ChunkOptions options;
  options.memory_bytes = memory;
  options.scratch = scratch;
  options.devices = devices;
  options.chunk_points = chunk_points;
  options.progress = with_signals(progress);
  if (py::isinstance<py::array_t<double>>(points)) return triangulate<double>(points, wanted, wide, options);
  if (py::isinstance<py::array_t<float>>(points)) return triangulate<float>(points, wanted, wide, options);
  throw Error(ErrorKind::usage, "points must be float64 or float32");
}

}  // namespace

void bind_chunks(py::module_& module) {
  module.def("triangulate_chunks", triangulate_chunks, py::arg("points"), py::arg("wanted"), py::arg("wide"),
             py::arg("memory"), py::arg("scratch"), py::arg("devices"), py::arg("chunk_points"),
             py::arg("progress"));
}

}  // namespace flaunay::python
