// Loops on the host's threads.
#pragma once

#include <algorithm>
#include <cstddef>

#include "host/runtime.hpp"

namespace flaunay::geometry {

/// Elements of a loop that one thread takes at a time.
constexpr std::size_t kRun = 1 << 12;

/// The number of runs of a loop over n elements.
constexpr std::size_t runs_of(std::size_t n) { return (n + kRun - 1) / kRun; }

/// Calls work(run, begin, end) for each run of n elements, on the threads of a native runtime. Null: on this
/// thread alone, which may be one of several that have a loop each.
template <typename Work>
void for_each_run(host::Runtime* runtime, std::size_t n, const Work& work) {
  const auto do_run = [&](std::size_t run) { work(run, run * kRun, std::min(n, (run + 1) * kRun)); };
  if (runtime != nullptr && runs_of(n) > 1) {
    runtime->share(runs_of(n), do_run);
  } else {
    for (std::size_t run = 0; run < runs_of(n); ++run) do_run(run);
  }
}

/// Calls work(i) for each i below n, on the threads that for_each_run has.
template <typename Work>
void for_each(host::Runtime* runtime, std::size_t n, const Work& work) {
  for_each_run(runtime, n, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}
template <typename Work>
void for_each(host::Runtime& runtime, std::size_t n, const Work& work) {
  for_each(&runtime, n, work);
}

}  // namespace flaunay::geometry
