// The files of a triangulation, for all subcommands that make one.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/command/report.hpp"
#include "app/files/mesh.hpp"
#include "app/files/points.hpp"
#include "files/mesh_stream.hpp"
#include "flaunay/research.hpp"
#include "flaunay/result_arrays.hpp"

namespace flaunay::cli {

/// For each array of a table the path of its .npy file; an empty one means that the array is not written.
template <typename Table>
using ArrayPaths = std::array<std::string, std::tuple_size_v<Table>>;

/// Where each result goes. An empty path means that the result is not written.
struct ResultPaths {
  std::string mesh;
  ArrayPaths<decltype(kTriangulationArrays)> arrays;
  std::string stats;

  /// In the order of the options.
  std::vector<std::string> all() const;
};

/// The option for the file of an array: --constraint-edges for constraint_edges.
std::string option_of(std::string_view name);
/// An option for the array's file.
template <typename Array>
void add_array(CLI::App* command, const Array& array, std::string& path) {
  add_path(command, option_of(array.name), path, fmt::format("{}: .npy", array.text));
}

/// The request of a user who triangulates, whichever way.
struct Task {
  std::string input;
  io::Columns columns;
  std::string crs;  ///< of the points, in place of what the input says; empty: that
  ResultPaths results;
  std::string device;
  std::string index = "auto";  ///< "auto", "32" or "64"
  bool profile = false;
  bool quiet = false;
};

void add_results(CLI::App* command, ResultPaths& paths);
/// Without --output; in_chunks: only the arrays that triangulations in chunks have.
void add_result_arrays(CLI::App* command, ResultPaths& paths, bool in_chunks = false);

/// The paths of the arrays that triangulations in chunks have, in the order of MeshArray. Throws Error(usage)
/// if another one is wanted.
std::array<std::string, io::kMeshArrays> mesh_paths(const ResultPaths& paths);

/// Sets the options for the arrays that have a path, and clears them for the others.
void ask_for(const ResultPaths& paths, Options& options);

/// Announces the files to `outputs`, which checks their paths.
void announce(OutputFiles& outputs, const ResultPaths& paths, bool with_constraints = false);

/// Writes the arrays of a table that have a path.
template <typename Table, typename Mesh>
void write_arrays(const Table& table, const ArrayPaths<Table>& paths, const Mesh& mesh, OutputFiles& outputs,
                  io::IndexType index) {
  for_each_array(table, [&]<typename Array>(const Array& array, std::size_t k) {
    using Element = typename Array::Element;
    // Arrays with other elements have no file.
    if constexpr (std::is_same_v<Element, std::int32_t> || std::is_same_v<Element, double>) {
      if (!paths[k].empty()) io::write_npy(outputs, paths[k], mesh.*array.values, array.columns, index);
    }
  });
}
/// Calls `write`, which writes all files but the statistics, and then writes those, if they have a path,
/// since they say how long writing the others took. Commits the files, and ends the progress.
void write_files(const ResultPaths& paths, RunFacts& facts, Progress& progress, OutputFiles& outputs,
                 const std::function<void()>& write, const std::function<std::string()>& statistics);

/// Writes the files of a triangulation in this way.
void write_results(const ResultPaths& paths, const io::Points& points, const research::Triangulation& mesh,
                   RunFacts& facts, Progress& progress, OutputFiles& outputs,
                   io::IndexType index = io::IndexType::int32);

}  // namespace flaunay::cli
