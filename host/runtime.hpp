// A device ready for work: context, queue, programs, kernels, memory, and the accounts of what was done.
#pragma once

#include <boost/compute/command_queue.hpp>
#include <boost/compute/context.hpp>
#include <boost/compute/device.hpp>
#include <boost/compute/kernel.hpp>
#include <boost/compute/program.hpp>
#include <cstddef>
#include <exception>
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
  /// In a context that the device belongs to.
  Runtime(const boost::compute::context& context, const boost::compute::device& device);
  ~Runtime();

  const boost::compute::device& device() const { return device_; }
  const boost::compute::context& context() const { return context_; }
  const Tuning& tuning() const { return tuning_; }
  /// For tests of boundaries: results must not depend on it.
  void set_tuning(const Tuning& tuning);
  Arena& arena() { return arena_; }
  const Arena& arena() const { return arena_; }
  cl_command_queue queue() const { return queue_.get(); }
  cl_command_queue own_queue() const { return own_queues_[0].get(); }
  /// From now on work goes to the caller's queue, which is retained, or with null to the runtime's own. Each
  /// command begins when the one before has ended, also where the queue may reorder and across a change of
  /// queues. profiling: whether kernels are timed, which the caller's queue must be made for.
  void use_queue(cl_command_queue wanted, bool profiling);
  /// The runtime's own queue, with or without.
  void set_profiling(bool on) { use_queue(nullptr, on); }
  /// What is enqueued from now on waits for the events.
  void wait_for(const std::vector<cl_event>& events);
  /// An event that is complete when all that was enqueued is; to be released.
  cl_event mark();

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
    enqueue_read(from.memory(), first * sizeof(T), count * sizeof(T), to, CL_TRUE);
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
    enqueue_write(to.memory(), first * sizeof(T), count * sizeof(T), from, CL_TRUE);
  }
  /// The same without waiting, for what is read together: `to` has the values after the next wait.
  template <typename T>
  void read_later(const Buffer<T>& from, std::size_t first, std::size_t count, T* to) {
    if (count == 0) return;
    enqueue_read(from.memory(), first * sizeof(T), count * sizeof(T), to, CL_FALSE);
  }
  /// The same without waiting: `from` must stay until the next wait.
  template <typename T>
  void write_later(const Buffer<T>& to, std::size_t first, std::size_t count, const T* from) {
    if (count == 0) return;
    enqueue_write(to.memory(), first * sizeof(T), count * sizeof(T), from, CL_FALSE);
  }
  /// The same, and the values are kept for as long as it takes.
  template <typename T>
  void write_kept(const Buffer<T>& to, std::vector<T> values) {
    const auto kept = std::make_shared<std::vector<T>>(std::move(values));
    write_later(to, 0, kept->size(), kept->data());
    kept_.push_back(kept);
  }
  /// A buffer of the arena with the values.
  template <typename T>
  Buffer<T> upload(Arena& arena, std::vector<T> values) {
    const auto buffer = arena.allocate<T>(values.size());
    write_kept(buffer, std::move(values));
    return buffer;
  }
  /// Host memory as kernels read it: in place on a device that works in host memory, else a copy, which comes
  /// from the arena. The memory must stay until the work is done.
  template <typename T>
  Buffer<T> view(const T* values, std::size_t count) {
    if (tuning_.in_host_memory && count > 0) {
      return {wrap(const_cast<T*>(values), count * sizeof(T), CL_MEM_READ_ONLY), count};
    }
    const auto copy = arena_.allocate<T>(count);
    write(copy, 0, count, values);
    return copy;
  }
  /// What kernels write for values: its own memory, or a buffer from the arena; fetch_later() ends it.
  template <typename T>
  Buffer<T> output(std::vector<T>& values) {
    if (tuning_.in_host_memory && !values.empty()) {
      return {wrap(values.data(), values.size() * sizeof(T), CL_MEM_READ_WRITE), values.size()};
    }
    return arena_.allocate<T>(values.size());
  }
  /// After the next wait, values are what kernels have written until now.
  template <typename T>
  void fetch_later(const Buffer<T>& from, std::vector<T>& values) {
    if (values.empty()) return;
    if (tuning_.in_host_memory) {
      hand_over(from.memory(), values.size() * sizeof(T));
    } else {
      read_later(from, 0, values.size(), values.data());
    }
  }
  template <typename T>
  void fill(const Buffer<T>& to, std::size_t count, T value) {
    if (count > 0) enqueue_fill(to.memory(), &value, sizeof(T), count * sizeof(T));
  }
  template <typename T>
  void copy(const Buffer<T>& from, std::size_t from_first, const Buffer<T>& to, std::size_t to_first,
            std::size_t count) {
    if (count == 0) return;
    enqueue_copy(from.memory(), from_first * sizeof(T), to.memory(), to_first * sizeof(T), count * sizeof(T));
  }
  void finish();
  /// Lets the device begin with what was enqueued.
  void flush();

  /// Waits, if an exception ends its scope, for what was to be read or written later: the memory that is
  /// meant must be declared before.
  class Settled {
   public:
    explicit Settled(const Runtime& runtime) : runtime_(runtime), exceptions_(std::uncaught_exceptions()) {}
    ~Settled() {
      if (std::uncaught_exceptions() > exceptions_) clFinish(runtime_.queue());
    }
    Settled(const Settled&) = delete;
    Settled& operator=(const Settled&) = delete;

   private:
    const Runtime& runtime_;
    int exceptions_;
  };

  /// From now on kernels are built with FLAUNAY_COUNT, and those that count get these counters as their last
  /// argument; see kernels/shared/counting.h. An empty buffer ends that.
  void set_counters(const Buffer<cl_uint>& counters);
  /// Per kernel, since the last reset; empty without profiling.
  std::map<std::string, KernelTime> kernel_times();
  std::size_t launches() const { return launches_; }
  std::size_t waits() const { return waits_; }
  std::size_t bytes_to_device() const { return bytes_to_device_; }
  std::size_t bytes_to_host() const { return bytes_to_host_; }
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

  boost::compute::command_queue make_queue(bool profiling) const;
  /// What is enqueued from now on waits for what was enqueued there.
  void follow(cl_command_queue other);
  Kernel& find_kernel(const char* file, const char* name);
  const boost::compute::program& find_program(const std::string& file);
  void enqueue(Kernel& kernel, std::size_t work_items, std::size_t group);
  void enqueue_read(cl_mem from, std::size_t offset, std::size_t bytes, void* to, cl_bool wait);
  std::shared_ptr<_cl_mem> wrap(void* memory, std::size_t bytes, cl_mem_flags access);
  void hand_over(cl_mem shared, std::size_t bytes);
  void enqueue_write(cl_mem to, std::size_t offset, std::size_t bytes, const void* from, cl_bool wait);
  void enqueue_fill(cl_mem to, const void* value, std::size_t value_bytes, std::size_t bytes);
  void enqueue_copy(cl_mem from, std::size_t from_offset, cl_mem to, std::size_t to_offset,
                    std::size_t bytes);
  /// After each command.
  void keep_order();
  void collect_times();

  boost::compute::device device_;
  Tuning tuning_;
  boost::compute::context context_;
  boost::compute::command_queue own_queues_[2];  // the second times kernels; made when it is needed
  boost::compute::command_queue queue_;
  bool profiling_ = false;
  bool is_unordered_ = false;
  std::vector<std::shared_ptr<void>> kept_;  // what is written later
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
  std::size_t bytes_to_device_ = 0;
  std::size_t bytes_to_host_ = 0;
  double build_seconds_ = 0;
};

/// The text of kernels/<file>.cl with its includes in place: from FLAUNAY_KERNEL_PATH if that is set, else as
/// embedded when the library was built. Throws DeviceError if there is no such file.
std::string kernel_source(const std::string& file);

}  // namespace flaunay::host
