// Compiling the kernels before the time is measured.
#pragma once

#include <algorithm>
#include <cstddef>

#include "app/command/progress.hpp"
#include "app/command/report.hpp"
#include "flaunay/research.hpp"

namespace flaunay::cli {

/// The text of the progress line while a device is being prepared, if that takes long.
constexpr const char* kCompiling = "compiling kernels, cached for next time";

/// Calls `call` with a number of points, and returns how many seconds that took. Drivers may compile a kernel
/// when it runs for the first time, so only a call that has run all kernels makes the next one free of
/// compiling.
template <typename Call>
double compile_kernels(std::size_t points, research::Mode mode, const Call& call) {
  // More than one block, or than the region at which levels may end; but a mode that launches kernels for
  // each region needs a thousand times longer.
  const std::size_t enough = mode == research::Mode::recursive_device ? 64
                             : mode == research::Mode::flattened      ? 10000
                                                                      : 2500;
  const Stopwatch stopwatch;
  call(std::min(points, enough));
  return stopwatch.seconds();
}

/// To be called with what `call` has made. What was left to the host, the next call says, too.
inline void note_compiling(const Triangulation& made, RunFacts& facts) {
  if (made.statistics.host_points == 0) facts.compiling_note = made.statistics.note;
}

}  // namespace flaunay::cli
