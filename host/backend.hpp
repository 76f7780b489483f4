// The back end that runs the commands of a Runtime: an OpenCL device (host/opencl) or threads of the host
// (host/native). It is chosen when the runtime is made.
#pragma once

#include <CL/cl.h>

#include <boost/compute/context.hpp>
#include <boost/compute/device.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/launch/accounts.hpp"
#include "host/launch/kernel_arguments.hpp"
#include "host/memory/arena.hpp"

namespace flaunay::host {

/// A kernel of a device, with the arguments of its next launch.
class Kernel {
 public:
  explicit Kernel(std::string name) : name_(std::move(name)) {}
  virtual ~Kernel() = default;
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  const std::string& name() const { return name_; }
  /// Sets an argument to these bytes. The value of an array is its cl_mem.
  virtual void set_argument(cl_uint index, const void* value, std::size_t bytes) = 0;
  /// Whether the kernel takes counters after its first `arguments` arguments.
  virtual bool takes_counters(cl_uint arguments) const = 0;
  /// The largest size of a work-group.
  std::size_t largest_group = 1;
  /// Whether the device has the local memory that it needs, by the driver. Launches do not rely on that, and
  /// smaller groups would not need less: Mesa's rusticl 22.3 counts this memory twice.
  bool has_local_memory = true;

 private:
  std::string name_;
};

/// Commands begin in the order of the calls, each when the previous one has ended.
class Backend {
 public:
  /// accounts: outlive the back end.
  explicit Backend(Accounts& accounts) : accounts_(accounts) {}
  virtual ~Backend() = default;
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;

  virtual std::string name() const = 0;
  /// Where arenas and buffers get their memory from.
  virtual MemorySource memory() const = 0;
  /// The number of the host's threads that run kernels; 0 on a device. If there are some, a command is
  /// complete when its call returns, and there are no queues and events.
  virtual std::size_t threads() const { return 0; }

  virtual void read(cl_mem from, std::size_t offset, std::size_t bytes, void* to, bool wait) = 0;
  virtual void write(cl_mem to, std::size_t offset, std::size_t bytes, const void* from, bool wait) = 0;
  virtual void fill(cl_mem to, std::size_t offset, std::size_t bytes, const void* value,
                    std::size_t value_bytes) = 0;
  virtual void copy(cl_mem from, std::size_t from_offset, cl_mem to, std::size_t to_offset,
                    std::size_t bytes) = 0;
  /// A buffer that is this host memory itself.
  virtual std::shared_ptr<_cl_mem> wrap(void* memory, std::size_t bytes, cl_mem_flags access) = 0;
  /// Makes the system provide memory that was not accessed before, if this is the time for it.
  virtual void touch_new(void* begin, std::size_t bytes) = 0;
  /// See Runtime::use_queue.
  virtual void use_queue(cl_command_queue wanted, bool profiling) = 0;

  // The following functions are for threads of the host.

  /// Launches a function that a kernel is compiled to. arguments: see NativeFunction.
  virtual void launch(const KernelName&, NativeFunction, void* const* /*arguments*/,
                      std::size_t /*work_items*/, std::size_t /*group*/) {}
  /// Calls work(k) for each k below n, on all threads; on a device, on the calling one.
  virtual void share(std::size_t n, const std::function<void(std::size_t)>& work) {
    for (std::size_t k = 0; k < n; ++k) work(k);
  }

  // The following functions are for a device with queues. Without queues, there is nothing to wait for.

  /// options: the compiler's, without the one for counting. counting: whether the kernel shall count, if it
  /// can.
  virtual std::unique_ptr<Kernel> make_kernel(const KernelName&, const std::string& /*options*/,
                                              bool /*counting*/) {
    return nullptr;
  }
  /// Forgets compiled programs. No kernel that was made of them must be used later.
  virtual void forget_programs() {}
  /// Launches a kernel that make_kernel returned; global sizes are rounded up to whole groups.
  virtual void launch(Kernel&, std::size_t /*work_items*/, std::size_t /*group*/) {}
  /// After the next wait, wrapped host memory has the data that kernels have written.
  virtual void hand_over(cl_mem, std::size_t) {}
  /// See the functions of these names in Runtime.
  virtual void wait_for(const std::vector<cl_event>&) {}
  virtual cl_event mark() { return nullptr; }
  virtual void await(cl_event) {}
  virtual void flush() {}
  virtual void finish() {}
  virtual void settle() const {}
  /// Adds the times of launches that were profiled to the accounts. Waits for them, which is not counted.
  virtual void collect_times() {}
  virtual boost::compute::device device() const { return {}; }
  virtual boost::compute::context context() const { return {}; }
  virtual cl_command_queue queue() const { return nullptr; }
  virtual cl_command_queue own_queue() const { return nullptr; }
  virtual std::string identity() const { return {}; }

  /// Called before a program is compiled from its source, which takes time.
  std::function<void()> before_compiling;
  /// See Sizes.
  std::size_t staging_bytes = 0;

 protected:
  Accounts& accounts() const { return accounts_; }

 private:
  Accounts& accounts_;
};

}  // namespace flaunay::host
