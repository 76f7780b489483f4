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
#include "files/mesh_stream.hpp"
#include "flaunay/research.hpp"
#include "flaunay/result_arrays.hpp"

namespace flaunay::cli {

/// Where each result goes. An empty path means that the result is not written.
struct ResultPaths {
  std::string mesh;
  std::array<std::string, kTriangulationArrayCount> arrays;  ///< .npy files, in the order of the table
  std::string stats;

  /// In the order of the options.
  std::vector<std::string> all() const;
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

/// Writes the arrays that have a path.
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
