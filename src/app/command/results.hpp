// The files of a triangulation, for all subcommands that make one.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/command/report.hpp"
#include "app/files/points.hpp"
#include "flaunay/research.hpp"

namespace flaunay::cli {

/// An array that the command can write, to a .npy file of indices. In the order of MeshArray (chunks.hpp).
struct ArrayFile {
  const char* option;
  const char* description;
  std::vector<std::int32_t> Triangulation::*values;
  std::size_t columns;         ///< 0: an array of one dimension
  bool Options::*computed_if;  ///< null: computed always
};
constexpr std::array<ArrayFile, 4> kArrayFiles = {{
    {"--triangles", "Triangles: .npy, 3 point indices per row", &Triangulation::triangles, 3, nullptr},
    {"--neighbors", "Neighbours: .npy, the triangle opposite to each vertex, -1 on the hull",
     &Triangulation::neighbors, 3, &Options::neighbors},
    {"--hull", "Hull: .npy, counter-clockwise", &Triangulation::hull, 0, nullptr},
    {"--duplicates", "Duplicates: .npy, for each point the smallest index of an equal point",
     &Triangulation::representatives, 0, nullptr},
}};

/// Where each result goes. An empty path means that the result is not written.
struct ResultPaths {
  std::string mesh;
  std::array<std::string, kArrayFiles.size()> arrays;  ///< one per row of kArrayFiles
  std::string stats;

  /// In the order of the options.
  std::vector<std::string> all() const;
};

void add_results(CLI::App* command, ResultPaths& paths);
/// The same without --output.
void add_result_arrays(CLI::App* command, ResultPaths& paths);

/// Sets the options for the arrays that have a path, and clears them for the others.
void ask_for(const ResultPaths& paths, Options& options);

/// Announces the files to `outputs`, which checks their paths.
void announce(OutputFiles& outputs, const ResultPaths& paths, bool with_constraints = false);

/// Writes those of kArrayFiles that have a path.
void write_arrays(const ResultPaths& paths, const Triangulation& mesh, OutputFiles& outputs,
                  io::IndexType index);
/// Writes the statistics of `mesh`, if they have a path, and commits all files.
void commit_with_statistics(const ResultPaths& paths, const research::Triangulation& mesh,
                            const RunFacts& facts, OutputFiles& outputs);

/// Writes and commits the files, and ends the progress. The statistics come last, because they say how long
/// writing the others took.
void write_results(const ResultPaths& paths, const io::Points& points, const research::Triangulation& mesh,
                   RunFacts& facts, Progress& progress, OutputFiles& outputs,
                   io::IndexType index = io::IndexType::int32);

}  // namespace flaunay::cli
