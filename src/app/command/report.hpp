// Statistics of a triangulation as text for people and as JSON for programs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "app/files/points.hpp"
#include "flaunay/chunks.hpp"
#include "flaunay/refinement.hpp"
#include "flaunay/research.hpp"

namespace flaunay::cli {

/// The facts that only triangulations with constraints have.
struct ConstraintFacts {
  std::size_t sets = 0, segments = 0, pieces = 0, edges = 0, added_points = 0, holes = 0;
  std::string crossings, outside, fill;  // as the options call them
};

/// Facts about a run that the command itself knows, besides the library's statistics.
struct RunFacts {
  std::string input;
  std::string mode = "blocks";  ///< the one of commands that have no choice
  std::string cut;              // empty if the mode has none
  std::string dividing_paths;   // empty if the mode has none
  bool counted = false;         ///< Triangulation::work is filled
  std::string what_was_done = "triangulated";
  std::optional<ConstraintFacts> constraints;
  std::optional<RefinementReport> refinement;
  double reading_seconds = 0;
  double opening_seconds = 0;    ///< choosing the device and testing it, which compiles a few kernels
  double compiling_seconds = 0;  ///< the call of compile_kernels
  std::string compiling_note;    ///< of that call, if it is about compiling
  double solving_seconds = 0;    ///< solving regions that no other program has solved
  double writing_seconds = 0;
};

/// The final line: counts, the time of each phase, points per second.
std::string summary(const Statistics& statistics, const RunFacts& facts);

/// The final line for a triangulation in chunks.
std::string chunk_summary(const ChunkStatistics& statistics, const RunFacts& facts);
std::string chunk_statistics_json(const ChunkStatistics& statistics, const RunFacts& facts);

/// The final line for a partition.
std::string partition_summary(const research::Partition& partition, const RunFacts& facts);

/// A line that says why there are no triangles; empty if there are some.
std::string degenerate_note(const Statistics& statistics);
/// A line that says how many points the input marks as not to be used; empty if none.
std::string withheld_note(const std::string& input, const io::Points& points);

/// How many triangles are worse than asked for, by the reasons.
std::string excuses_text(const RefinementReport& report);

/// A line that says what the device left to the host (Statistics::note); empty if it left nothing.
std::string host_note(const std::string& note);

/// The kernels' times as a table, the slowest kernel first.
std::string kernel_table(const Statistics& statistics);

/// A table of operations per point by component and kind, and of critical paths, summed over all levels.
std::string work_table(const research::Triangulation& result);

/// The contents of the --stats file.
std::string statistics_json(const research::Triangulation& result, const RunFacts& facts);

}  // namespace flaunay::cli
