// What a triangulation's statistics look like to people and to programs.
#pragma once

#include <string>

#include "flaunay/flaunay.hpp"

namespace flaunay::cli {

/// What the command adds to the library's statistics.
struct RunFacts {
  std::string input;
  std::string mode;
  std::string cut;             // empty: there is none
  std::string dividing_paths;  // likewise
  bool counted = false;        ///< Statistics::work is filled
  std::string what_was_done = "triangulated";
  double reading_seconds = 0;
  double opening_seconds = 0;  ///< choosing the device and preparing it; programs may be built then
  double solving_seconds = 0;  ///< of regions that have no solution from elsewhere
  double writing_seconds = 0;
};

/// The final line: counts, the time of each phase, points per second.
std::string summary(const Statistics& statistics, const RunFacts& facts);

/// The same for a partition.
std::string partition_summary(const Partition& partition, const RunFacts& facts);

/// Why there are no triangles, as a line; empty if there are some.
std::string degenerate_note(const Statistics& statistics);

/// The kernels' times as a table, the longest first.
std::string kernel_table(const Statistics& statistics);

/// The operations a point by component and kind, and the critical paths, all levels together.
std::string work_table(const Statistics& statistics);

/// The --stats file.
std::string statistics_json(const Statistics& statistics, const RunFacts& facts);

}  // namespace flaunay::cli
