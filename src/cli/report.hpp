// What a triangulation's statistics look like to people and to programs.
#pragma once

#include <string>

#include "flaunay/flaunay.hpp"

namespace flaunay::cli {

/// What the command adds to the library's statistics.
struct RunFacts {
  std::string input;
  std::string mode;
  std::string cut;
  double reading_seconds = 0;
  double opening_seconds = 0;  ///< choosing the device and preparing it; programs may be built then
  double writing_seconds = 0;
};

/// The final line: counts, the time of each phase, points per second.
std::string summary(const Statistics& statistics, const RunFacts& facts);

/// Why there are no triangles, as a line; empty if there are some.
std::string degenerate_note(const Statistics& statistics);

/// The kernels' times as a table, the longest first.
std::string kernel_table(const Statistics& statistics);

/// The --stats file.
std::string statistics_json(const Statistics& statistics, const RunFacts& facts);

}  // namespace flaunay::cli
