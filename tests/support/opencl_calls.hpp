// What a test program asks of OpenCL, counted at the calls themselves: its own definitions of some of them
// come before the loader's, count, and go on to those.
#pragma once

#include <CL/cl.h>

#include <atomic>
#include <cstddef>

namespace flaunay::testing {

struct OpenclCalls {
  std::atomic<std::size_t> buffers{0};          ///< made, but for sub-buffers
  std::atomic<std::size_t> bytes_to_host{0};    ///< read or mapped
  std::atomic<std::size_t> bytes_to_device{0};  ///< written
  std::atomic<std::size_t> waits{0};            ///< blocking calls
  /// If not CL_SUCCESS, clCreateBuffer fails with it.
  std::atomic<cl_int> buffer_failure{CL_SUCCESS};

  /// Whether no device has double precision.
  std::atomic<bool> without_fp64{false};

  void reset() { buffers = bytes_to_host = bytes_to_device = waits = 0; }
};
OpenclCalls& opencl_calls();

}  // namespace flaunay::testing
