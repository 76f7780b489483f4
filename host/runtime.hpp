// A device ready for work: context, queue, programs, kernels, memory, and the accounts of what was done.
#pragma once

#include <boost/compute/command_queue.hpp>
#include <boost/compute/context.hpp>
#include <boost/compute/device.hpp>
#include <boost/compute/kernel.hpp>
#include <boost/compute/program.hpp>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "host/arena.hpp"
#include "host/error.hpp"
#include "host/tuning.hpp"

namespace flaunay::host {

/// What one kernel cost, if profiling is on.
struct KernelTime {
  std::size_t launches = 0;
  double seconds = 0;
};

/// Owns everything that belongs to one device. One thread at a time: kernel objects carry their arguments.
class Runtime {
 public:
  explicit Runtime(const boost::compute::device& device);
  ~Runtime();

  const boost::compute::device& device() const { return device_; }
  const boost::compute::context& context() const { return context_; }
  const Tuning& tuning() const { return tuning_; }
  /// For tests of boundaries: results must not depend on it.
  void set_tuning(const Tuning& tuning);
  Arena& arena() { return arena_; }
  cl_command_queue queue() const { return queue_.get(); }

  /// Launches a kernel with one work-item per element. file: "scan" for kernels/scan.cl; both names are
  /// literals, whose addresses kernels are found by. The kernel's first argument is the number of elements as
  /// int; surplus work-items of the last group must do nothing.
  template <typename... Arguments>
  void map(const char* file, const char* name, std::size_t n, const Arguments&... arguments) {
    if (n == 0) return;
    launch(file, name, n, tuning_.map_group, static_cast<cl_int>(n), arguments...);
  }

  /// Launches a kernel with one work-item per chunk. Its first two arguments are the number of elements and
  /// the number of elements per chunk, as int.
  template <typename... Arguments>
  void chunks(const char* file, const char* name, std::size_t n, std::size_t chunk,
              const Arguments&... arguments) {
    if (n == 0) return;
    launch(file, name, (n + chunk - 1) / chunk, tuning_.chunk_group, static_cast<cl_int>(n),
           static_cast<cl_int>(chunk), arguments...);
  }

  /// Launches a kernel over work_items, padded to whole groups: of the size given, or smaller ones if the
  /// device takes no such groups of this kernel, unless the kernel itself requires a size.
  template <typename... Arguments>
  void launch(const char* file, const char* name, std::size_t work_items, std::size_t group,
              const Arguments&... arguments) {
    Kernel& kernel = find_kernel(file, name);
    cl_uint index = 0;
    (set_argument(kernel, index++, arguments), ...);
    if (counting_ && index < kernel.arguments) set_argument(kernel, index, counters_);
    enqueue(kernel, work_items, group);
  }

  /// The most work-items in a group of this kernel; 0 if it needs more local memory than there is.
  std::size_t largest_group(const char* file, const char* name) {
    return find_kernel(file, name).largest_group;
  }

  /// Copies from the device and waits; one host wait.
  template <typename T>
  void read(const Buffer<T>& from, std::size_t first, std::size_t count, T* to) {
    if (count == 0) return;
    read_bytes(from.memory(), first * sizeof(T), count * sizeof(T), to);
  }
  template <typename T>
  T read_one(const Buffer<T>& from, std::size_t index) {
    T value;
    read(from, index, 1, &value);
    return value;
  }
  /// Copies to the device; from may be reused at once.
  template <typename T>
  void write(const Buffer<T>& to, std::size_t first, std::size_t count, const T* from) {
    if (count == 0) return;
    write_bytes(to.memory(), first * sizeof(T), count * sizeof(T), from);
  }
  template <typename T>
  void fill(const Buffer<T>& to, std::size_t count, T value) {
    if (count == 0) return;
    ++launches_;
    FLAUNAY_CL(clEnqueueFillBuffer(queue_.get(), to.memory(), &value, sizeof(T), 0, count * sizeof(T), 0,
                                   nullptr, nullptr));
  }
  template <typename T>
  void copy(const Buffer<T>& from, std::size_t from_first, const Buffer<T>& to, std::size_t to_first,
            std::size_t count) {
    if (count == 0) return;
    ++launches_;
    FLAUNAY_CL(clEnqueueCopyBuffer(queue_.get(), from.memory(), to.memory(), from_first * sizeof(T),
                                   to_first * sizeof(T), count * sizeof(T), 0, nullptr, nullptr));
  }
  void finish();

  /// From now on kernels are built with FLAUNAY_COUNT, and those that count get these counters as their last
  /// argument; see kernels/shared/counting.h. An empty buffer ends that.
  void set_counters(const Buffer<cl_uint>& counters);
  /// Waits if that changes something.
  void set_profiling(bool on);
  /// Per kernel, since the last reset; empty without profiling.
  std::map<std::string, KernelTime> kernel_times();
  std::size_t launches() const { return launches_; }
  std::size_t waits() const { return waits_; }
  double build_seconds() const { return build_seconds_; }
  void reset_accounts();

 private:
  struct Kernel {
    boost::compute::kernel kernel;
    std::string name;
    cl_uint arguments;
    std::size_t largest_group;  ///< work-items
    bool requires_group;        ///< has an attribute reqd_work_group_size
  };
  template <typename T>
  void set_argument(Kernel& kernel, cl_uint index, const Buffer<T>& buffer) {
    const cl_mem memory = buffer.memory();
    FLAUNAY_CL_KERNEL(clSetKernelArg(kernel.kernel.get(), index, sizeof(cl_mem), &memory), kernel.name);
  }
  template <typename T, typename = std::enable_if_t<std::is_arithmetic_v<T>>>
  void set_argument(Kernel& kernel, cl_uint index, T value) {
    FLAUNAY_CL_KERNEL(clSetKernelArg(kernel.kernel.get(), index, sizeof(T), &value), kernel.name);
  }

  boost::compute::command_queue make_queue() const;
  Kernel& find_kernel(const char* file, const char* name);
  const boost::compute::program& find_program(const std::string& file);
  void enqueue(Kernel& kernel, std::size_t work_items, std::size_t group);
  void read_bytes(cl_mem from, std::size_t offset, std::size_t bytes, void* to);
  void write_bytes(cl_mem to, std::size_t offset, std::size_t bytes, const void* from);
  void collect_times();

  boost::compute::device device_;
  Tuning tuning_;
  boost::compute::context context_;
  bool profiling_ = false;
  boost::compute::command_queue queue_;
  Arena arena_;
  // Two of each: kernels that count and kernels that do not.
  std::map<std::string, boost::compute::program> programs_[2];
  std::map<std::pair<const char*, const char*>, Kernel> kernels_[2];
  Buffer<cl_uint> counters_{};
  bool counting_ = false;
  std::vector<std::pair<cl_event, const std::string*>> events_;
  std::map<std::string, KernelTime> times_;
  std::size_t launches_ = 0;
  std::size_t waits_ = 0;
  double build_seconds_ = 0;
};

/// The text of kernels/<file>.cl with its includes in place: from FLAUNAY_KERNEL_PATH if that is set, else as
/// embedded when the library was built. Throws DeviceError if there is no such file.
std::string kernel_source(const std::string& file);

}  // namespace flaunay::host
