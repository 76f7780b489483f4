// A record of a runtime's launches, for programs that predict or explain times.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "host/memory/arena.hpp"

namespace flaunay::host {

/// One launch. A fill or a copy is a launch, too, with the bytes that it writes.
struct Launch {
  std::string kernel;  ///< its name, "fill" or "copy"
  std::size_t work_items = 0, group = 0;
  std::size_t busy = 0;               ///< the most work-items of a group that have work
  std::size_t elements = 0;           ///< the most elements that one work-item goes through
  std::size_t bytes = 0;              ///< of fills and copies
  std::vector<cl_uint> counted = {};  ///< the kernel's counts, if it counts
  double seconds = 0;                 ///< 0 without profiling
};

/// The words of an array of counters that belong to one launch of a counting kernel.
struct CountedWords {
  std::size_t length = 0;  ///< of the array; 0: kernels do not count
  std::size_t first = 0, count = 0;
};

/// The launches in their order. A runtime that records has one.
class LaunchLog {
 public:
  LaunchLog(MemorySource memory, const CountedWords& words);

  const CountedWords& words() const { return words_; }
  /// Kernels count here, if they do.
  const Buffer<cl_uint>& counters() const { return counters_; }

  void add(Launch launch) { launches_.push_back(std::move(launch)); }
  /// The position of the last launch.
  std::size_t last() const { return launches_.size() - 1; }
  void set_seconds(std::size_t launch, double seconds) { launches_[launch].seconds = seconds; }
  /// The memory into which the counts of the last launch must be read.
  cl_uint* counted_of_last();
  /// The launches so far. Reads into counted_of_last() must be complete.
  std::vector<Launch> launches() const;
  void clear();

 private:
  CountedWords words_;
  Arena arena_;
  Buffer<cl_uint> counters_{};
  std::deque<Launch> launches_;  // which does not move its elements
};

}  // namespace flaunay::host
