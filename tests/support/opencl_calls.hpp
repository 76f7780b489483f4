// What a test program asks of OpenCL, counted at the calls themselves: its own definitions of some of them
// come before the loader's, count, and go on to those.
#pragma once

#include <CL/cl.h>

#include <atomic>
#include <cstddef>
#include <limits>

namespace flaunay::testing {

struct OpenclCalls {
  std::atomic<std::size_t> buffers{0};          ///< made, but for sub-buffers
  std::atomic<std::size_t> bytes_to_host{0};    ///< read or mapped
  std::atomic<std::size_t> bytes_to_device{0};  ///< written
  std::atomic<std::size_t> waits{0};            ///< blocking calls
  /// After so many buffers, sub-buffers included, the next one and all later ones cannot be made.
  std::atomic<std::size_t> buffers_that_fit{std::numeric_limits<std::size_t>::max()};
  std::atomic<std::size_t> pinned{0};  ///< buffers made in memory of the host's that a driver allocates
  /// Whether there are none of those.
  std::atomic<bool> without_pinned{false};
  /// Whether no device has double precision.
  std::atomic<bool> without_fp64{false};

  void reset() { buffers = pinned = bytes_to_host = bytes_to_device = waits = 0; }
};
OpenclCalls& opencl_calls();

}  // namespace flaunay::testing
