// A record of what a runtime launches, for programs that predict or explain times.
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
  std::size_t busy = 0;             ///< the most work-items of a group that have work
  std::size_t elements = 0;         ///< the most elements that one work-item goes through
  std::size_t bytes = 0;            ///< of fills and copies
  std::uint32_t longest_chain = 0;  ///< the most steps of one work-item; 0 unless the kernel counted them
  std::uint64_t steps = 0;          ///< of all work-items
  double seconds = 0;               ///< 0 without profiling
};

/// The launches in their order. A runtime that records has one.
class LaunchLog {
 public:
  /// counts_steps: whether kernels count their steps.
  LaunchLog(MemorySource memory, bool counts_steps);

  bool counts_steps() const { return counts_steps_; }
  /// Kernels count here (kernels/operations/counting.h).
  const Buffer<cl_uint>& counters() const { return counters_; }

  void add(Launch launch) { launches_.push_back(std::move(launch)); }
  /// The position of the last launch.
  std::size_t last() const { return launches_.size() - 1; }
  void set_seconds(std::size_t launch, double seconds) { launches_[launch].seconds = seconds; }
  /// The memory to which the step counters of the last launch are to be read.
  cl_uint* steps_of_last();
  /// The launches so far. Reads into steps_of_last() must be complete.
  std::vector<Launch> launches() const;
  void clear();

 private:
  /// The counters of a launch as the device has them.
  struct Steps {
    std::size_t launch;
    cl_uint counters[3];
  };

  bool counts_steps_;
  Arena arena_;
  Buffer<cl_uint> counters_{};
  std::vector<Launch> launches_;
  std::deque<Steps> steps_;  // which does not move its elements
};

}  // namespace flaunay::host
