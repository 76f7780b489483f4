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

/// Calls work(run, begin, end) for each run of n elements, on the threads of a native runtime.
template <typename Work>
void for_each_run(host::Runtime& runtime, std::size_t n, const Work& work) {
  runtime.share(runs_of(n), [&](std::size_t run) { work(run, run * kRun, std::min(n, (run + 1) * kRun)); });
}

/// Calls work(i) for each i below n, on the threads of a native runtime.
template <typename Work>
void for_each(host::Runtime& runtime, std::size_t n, const Work& work) {
  for_each_run(runtime, n, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}

}  // namespace flaunay::geometry
