// The members of a Triangulator: its device, memory, and the statistics of a call.
#pragma once

#include <CL/cl.h>

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>

#include "call/errors.hpp"
#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"

namespace flaunay {

struct Triangulator::Implementation {
  /// Throws Error(device) if there is no such device or if its arithmetic fails the self-test.
  explicit Implementation(const std::string& wanted);
  Implementation(const boost::compute::context& context, const boost::compute::device& device);

  /// The largest number of points of one call, with the memory that is free now.
  std::size_t capacity() const;
  /// Throws Error if n is larger than the capacity.
  void check_size(std::size_t n) const;

  /// Makes the arenas use memory of their own instead of the caller's workspace.
  void use_own_memory();
  /// Makes the arenas large enough for mode blocks. They use the caller's workspace if there is one,
  /// otherwise memory of their own. Throws Error(usage) if the workspace is too small.
  void provide_memory(std::size_t n, std::size_t sets);

  /// Begins a call on host memory: selects the triangulator's own memory and queue, and resets the accounts.
  void begin_call(bool profile);
  void reset_accounts();
  /// Writes to the statistics what the device did since the accounts were reset.
  void write_accounts(Statistics& statistics);

  host::Runtime runtime;
  host::Arena persistent;  ///< arrays that live as long as a call
  host::Arena even, odd;   ///< the regions of even and of odd levels, in the modes that go level by level
  std::shared_ptr<_cl_mem> workspace;  ///< the caller's workspace, or null
  std::size_t buffer_allocations = 0;  ///< number of buffers made for DeviceBuffers
  std::atomic<bool> is_busy{false};    ///< whether a call is running; see Turn
  /// The device memory that was held when no call was running. Any thread may read it.
  std::atomic<std::size_t> held_at_rest{0};
  std::size_t held_bytes() const;

 private:
  std::size_t allocations() const;

  std::size_t allocations_before_ = 0;
};

/// Gives functions that are not members of Triangulator access to its implementation.
struct TriangulatorAccess {
  using Implementation = Triangulator::Implementation;
  static Implementation& implementation(Triangulator& triangulator) { return *triangulator.implementation_; }
};

namespace call {

using Implementation = TriangulatorAccess::Implementation;

/// Marks a triangulator as busy for the length of a call. Throws Error(usage) if it is busy already, since
/// two calls at once would overwrite each other's memory and kernel arguments.
class Turn {
 public:
  explicit Turn(Implementation& self);
  ~Turn();
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  Implementation& self_;
};

/// Runs a public call that uses the triangulator's memory or queue; see Turn and with_errors.
template <typename Work>
auto take_turn(Implementation& self, const Work& work) {
  return with_errors([&] {
    const Turn turn(self);
    return work();
  });
}

}  // namespace call

}  // namespace flaunay
