// An engine runs calls: a device or the host itself, with memory and the accounts of a call.
#pragma once

#include <CL/cl.h>

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>

#include "blocks/memory.hpp"
#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::call {

struct Engine {
  /// Runs kernels natively on threads of the host, without OpenCL. tuning: as FLAUNAY_TUNING has it.
  explicit Engine(const std::string& tuning);
  /// Runs them on a device, in the given context or, if that is null, in one of its own: in double precision,
  /// or in fixed point if its tuning says so, if it lacks fp64, or if its doubles fail the self-test. Throws
  /// Error(device) if it fails the self-test of fixed point, too.
  Engine(const boost::compute::context& context, const boost::compute::device& device,
         const std::string& tuning);
  /// The calling thread's own, which runs kernels on that thread alone. As mode blocks does for small sets,
  /// it takes the compiler's arithmetic to be exact.
  static Engine& of_thread();
  /// Makes an engine with double precision on the same device and in the same context. Null if the device
  /// lacks fp64 or fails its self-test.
  std::unique_ptr<Engine> with_doubles() const;

  /// Whether kernels may compute with doubles; otherwise they compute in fixed point.
  bool has_doubles() const;

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
  /// The memory that was held when no call was running. Any thread may read it.
  std::atomic<std::size_t> held_at_rest{0};
  std::size_t held_bytes() const;

 private:
  explicit Engine(std::shared_ptr<const Tuning> tuning, std::size_t threads = 0);
  Engine(const boost::compute::context& context, const boost::compute::device& device,
         host::Settings settings);
  void check_arithmetic();
  std::size_t allocations() const;

  std::size_t allocations_before_ = 0;
  // The last result of provide_memory's count, and the numbers of points and sets that it was for.
  std::size_t counted_points_ = 0, counted_sets_ = 0;
  blocks::WorkspaceBytes needed_{};
};

}  // namespace flaunay::call
