// A device that is ready for work: its kernels, memory and accounts, and typed launches and copies. A back
// end runs them: an OpenCL device, or the host itself with kernels compiled as C++ (host/backend.hpp).
#pragma once

#include <algorithm>
#include <boost/compute/context.hpp>
#include <boost/compute/device.hpp>
#include <cstddef>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/backend.hpp"
#include "host/launch/accounts.hpp"
#include "host/launch/argument_list.hpp"
#include "host/launch/kernel_arguments.hpp"
#include "host/launch/sizes.hpp"
#include "host/memory/arena.hpp"

namespace flaunay::host {

/// Owns everything that belongs to one device. Must be used by one thread at a time, because OpenCL's kernel
/// objects hold their arguments.
class Runtime {
 public:
  /// settings: for compiling and launching kernels.
  Runtime(const boost::compute::device& device, Settings settings);
  /// Uses the given context, which the device must belong to.
  Runtime(const boost::compute::context& context, const boost::compute::device& device, Settings settings);
  /// Runs kernels natively, on threads of the host: OpenCL is not used. Launches and copies are complete when
  /// the call returns; there are no queues and events. threads: see Threads.
  explicit Runtime(std::shared_ptr<const Sizes> sizes, std::size_t threads = 0);
  /// Runs nothing, but counts the memory that work would take on this other runtime
  /// (host/memory/counting.hpp). Its arena has no memory.
  Runtime(const Runtime& counted, std::shared_ptr<const Sizes> sizes);
  ~Runtime();

  /// Returns a value that depends on data, or if the runtime only counts memory, its upper bound. Every value
  /// that determines the size of an array must be read through this function.
  template <typename T>
  T at_most(T value, T most) const {
    return counts_only_ ? most : value;
  }

  /// Whether kernels run on threads of the host; each command is complete when its call returns.
#ifdef FLAUNAY_WITHOUT_OPENCL
  static constexpr bool is_native() { return true; }
#else
  bool is_native() const { return is_native_; }
#endif
  /// Whether nothing runs: arrays must not be accessed.
  bool counts_only() const { return counts_only_; }
  /// Null if kernels run natively.
  boost::compute::device device() const { return backend_->device(); }
  /// Null if kernels run natively.
  boost::compute::context context() const { return backend_->context(); }
  /// The device's name; "host" if kernels run natively.
  std::string name() const { return backend_->name(); }
  /// Platform, device and driver with their versions: all that compiled programs, apart from their text, and
  /// measurements depend on. For devices only.
  std::string identity() const { return backend_->identity(); }
  /// The number of threads that run native kernels; 0 on a device.
  std::size_t threads() const { return backend_->threads(); }
  /// Calls work(k) for each k below n, on the threads that run native kernels. It must not use this runtime.
  void share(std::size_t n, const std::function<void(std::size_t)>& work) { backend_->share(n, work); }
  /// Calls work(begin, end) likewise, for parts of [0, n) with kPart elements each, or fewer at the end.
  template <typename Work>
  void share_parts(std::size_t n, const Work& work) {
    share((n + kPart - 1) / kPart, [&](std::size_t k) { work(k * kPart, std::min(n, (k + 1) * kPart)); });
  }
  static constexpr std::size_t kPart = std::size_t{1} << 14;
  /// Where arenas and buffers get their memory from.
  MemorySource memory() const;
  /// The capabilities of the device; the host has all.
  const Capabilities& capabilities() const { return capabilities_; }
  const Sizes& sizes() const { return *sizes_; }
  /// Change the settings for launches. Kernels are compiled again if a changed setting is compiled into them.
  void set_capabilities(const Capabilities& capabilities) { set({sizes_, capabilities}); }
  void set_sizes(std::shared_ptr<const Sizes> sizes) { set({std::move(sizes), capabilities_}); }
  Arena& arena() { return arena_; }
  const Arena& arena() const { return arena_; }
  cl_command_queue queue() const { return backend_->queue(); }
  cl_command_queue own_queue() const { return backend_->own_queue(); }
  /// Makes later work use the caller's queue, which is retained, or the runtime's own queue if it is null.
  /// Each command begins when the previous one has ended, even on an out-of-order queue and when the queue
  /// changes. profiling: whether to time kernels; the caller's queue must support that.
  void use_queue(cl_command_queue wanted, bool profiling) { backend_->use_queue(wanted, profiling); }
  /// Uses the runtime's own queue, and times kernels or not.
  void set_profiling(bool on) { use_queue(nullptr, on); }
  /// Makes later commands wait for the events.
  void wait_for(const std::vector<cl_event>& events) { backend_->wait_for(events); }
  /// Returns an event that completes when everything enqueued so far is complete. The caller releases it.
  cl_event mark() { return backend_->mark(); }
  /// Waits for an event that mark() returned.
  void await(cl_event event) { backend_->await(event); }

  /// Launches a kernel with one work-item per element. The kernel must ignore the surplus work-items of the
  /// last group.
  template <typename Kernel>
  void map(std::size_t n, const Kernel& kernel) {
    launch(n, sizes_->map_group, n, kernel);
  }

  /// map for a kernel with large private arrays. PoCL keeps the private arrays of a whole group on the stack
  /// of one thread, which may be small.
  template <typename Kernel>
  void map_in_small_groups(std::size_t n, const Kernel& kernel) {
    launch(n, sizes_->private_group, n, kernel);
  }

  /// Launches a kernel with one work-item per chunk of elements.
  template <typename Kernel>
  void chunks(std::size_t n, std::size_t chunk, const Kernel& kernel) {
    static_assert(Kernel::form == Form::PerChunk);
    if (n == 0) return;
    note_elements(std::min(n, chunk));
    launch_with((n + chunk - 1) / chunk, sizes_->chunk_group, kernel, Value<cl_int>(n), Value<cl_int>(chunk));
  }

  /// Launches a kernel with this many work-items, rounded up to whole groups. Groups are smaller than given
  /// if the device does not support that size for this kernel, unless the kernel requires the size.
  template <typename Kernel>
  void launch(std::size_t work_items, std::size_t group, const Kernel& kernel) {
    static_assert(Kernel::form == Form::Plain);
    launch_with(work_items, group, kernel);
  }
  /// Launches a kernel whose number of elements n differs from its number of work-items.
  template <typename Kernel>
  void launch(std::size_t work_items, std::size_t group, std::size_t n, const Kernel& kernel) {
    static_assert(Kernel::form == Form::PerElement);
    if (n > work_items) note_elements((n + work_items - 1) / work_items);
    if (n < work_items) accounts_.next.busy = n;
    launch_with(work_items, group, kernel, Value<cl_int>(n));
  }

  /// Launches one pass of segmented_arg_reduce (host/launch/vector_operations.hpp).
  template <typename Kernel>
  void arg_reduce(std::size_t n, std::size_t chunk, bool is_first_pass, const In<cl_int>& segment,
                  const In<cl_int>& candidate, const Out<cl_int>& partial_segment,
                  const Out<cl_int>& partial_candidate, const Kernel& kernel) {
    static_assert(Kernel::form == Form::ArgReduce);
    note_elements(std::min(n, chunk));
    launch_with((n + chunk - 1) / chunk, sizes_->chunk_group, kernel, Value<cl_int>(n), Value<cl_int>(chunk),
                Value<cl_int>(is_first_pass), segment, candidate, partial_segment, partial_candidate,
                kernel.result);
  }

  /// Launches a kernel that has no launcher, such as kernels of tests. The arguments are not checked.
  template <typename... Arguments>
  void launch_unchecked(const KernelName& name, std::size_t work_items, std::size_t group,
                        const Arguments&... arguments) {
    launch_by(name, work_items, group, [&](auto&& visit) { (visit(arguments), ...); });
  }

  /// The largest work-group size of this kernel; 0 if it needs more local memory than the device has.
  std::size_t largest_group(const KernelName& name) {
    if (is_native()) return 1;
    const Kernel& kernel = find_kernel(name);
    return kernel.has_local_memory ? kernel.largest_group : 0;
  }

  /// Copies from the device to the host, and waits for it.
  template <typename T>
  void read(const Buffer<T>& from, std::size_t first, std::size_t count, T* to) {
    if (count == 0) return;
    read_bytes(from.memory(), first * sizeof(T), count * sizeof(T), to);
  }
  template <typename T>
  T read_one(const Buffer<T>& from, std::size_t index) {
    T value{};
    read(from, index, 1, &value);
    return value;
  }
  /// Copies to the device. `from` may be changed when the call returns.
  template <typename T>
  void write(const Buffer<T>& to, std::size_t first, std::size_t count, const T* from) {
    if (count == 0) return;
    backend_->write(to.memory(), first * sizeof(T), count * sizeof(T), from, true);
  }
  /// Enqueues a copy to the host, so that several copies share a wait. `to` has the values after the next
  /// wait. Large copies wait here for all but their end.
  template <typename T>
  void read_later(const Buffer<T>& from, std::size_t first, std::size_t count, T* to) {
    if (count == 0) return;
    backend_->read(from.memory(), first * sizeof(T), count * sizeof(T), to, false);
  }
  /// Enqueues a copy to the device. `from` must not be changed until the next wait. Large copies wait here
  /// for all but their end.
  template <typename T>
  void write_later(const Buffer<T>& to, std::size_t first, std::size_t count, const T* from) {
    if (count == 0) return;
    backend_->write(to.memory(), first * sizeof(T), count * sizeof(T), from, false);
  }
  /// Enqueues a copy to the device without waiting, and keeps the values until it is done.
  template <typename T>
  void write_kept(const Buffer<T>& to, std::vector<T> values) {
    if (is_native()) return write_later(to, 0, values.size(), values.data());
    const auto kept = std::make_shared<std::vector<T>>(std::move(values));
    kept_.push_back(kept);
    write_later(to, 0, kept->size(), kept->data());
  }
  /// Returns a buffer from the arena that holds the values.
  template <typename T>
  Buffer<T> upload(Arena& arena, std::vector<T> values) {
    const auto buffer = arena.allocate<T>(values.size());
    write_kept(buffer, std::move(values));
    return buffer;
  }
  /// Returns a buffer from which kernels read host memory. On a device that works in host memory it is that
  /// memory itself, otherwise a copy in the arena. The host memory must not be changed until the work is
  /// done.
  template <typename T>
  Buffer<T> view(const T* values, std::size_t count) {
    return view_by(values, count, &Runtime::write<T>);
  }
  /// As view, but does not wait for the copy.
  template <typename T>
  Buffer<T> view_later(const T* values, std::size_t count) {
    return view_by(values, count, &Runtime::write_later<T>);
  }
  /// Makes a vector this long, for output(). New memory is in huge pages; if kernels run natively, their
  /// threads share the work that the system has with it. room: for how many new memory is.
  template <typename T>
  void resize(std::vector<T>& values, std::size_t size, std::size_t room = 0) {
    if (size > values.capacity()) {
      values.reserve(std::max(size, room));
      touch_new(values.data() + values.size(), (size - values.size()) * sizeof(T));
    }
    values.resize(size);
  }
  /// Makes room for a vector that will be so long, as resize does for one that is.
  template <typename T>
  void reserve(std::vector<T>& values, std::size_t size) {
    values.reserve(size);
    touch_new(values.data() + values.size(), (size - values.size()) * sizeof(T));
  }
  /// Returns a buffer in which kernels write results for `values`. On a device that works in host memory it
  /// is the vector's own memory, otherwise it comes from the arena. Call fetch_later after the kernels.
  template <typename T>
  Buffer<T> output(std::vector<T>& values) {
    if (sizes_->in_host_memory && !values.empty()) {
      return {backend_->wrap(values.data(), values.size() * sizeof(T), CL_MEM_READ_WRITE), values.size()};
    }
    return arena_.allocate<T>(values.size());
  }
  /// Enqueues the transfer from a buffer that output() has made: after the next wait, `values` has the data
  /// that kernels have written until now.
  template <typename T>
  void fetch_later(const Buffer<T>& from, std::vector<T>& values) {
    if (values.empty()) return;
    if (sizes_->in_host_memory) {
      backend_->hand_over(from.memory(), values.size() * sizeof(T));
    } else {
      read_later(from, 0, values.size(), values.data());
    }
  }
  template <typename T>
  void fill(const Buffer<T>& to, std::size_t count, T value) {
    if (count > 0) backend_->fill(to.memory(), 0, count * sizeof(T), &value, sizeof(T));
  }
  template <typename T>
  void copy(const Buffer<T>& from, std::size_t from_first, const Buffer<T>& to, std::size_t to_first,
            std::size_t count) {
    if (count == 0) return;
    backend_->copy(from.memory(), from_first * sizeof(T), to.memory(), to_first * sizeof(T),
                   count * sizeof(T));
  }
  void finish() {
    backend_->finish();
    kept_.clear();
  }
  /// Waits like finish, but ignores errors and does not count.
  void settle() const { backend_->settle(); }
  /// Submits the enqueued commands to the device, which may then begin.
  void flush() { backend_->flush(); }

  /// If an exception ends its scope, waits for the copies of read_later, write_later, view_later and
  /// fetch_later, so that none uses host memory that is gone. Must be declared after the vectors that they
  /// use.
  class Settled {
   public:
    explicit Settled(const Runtime& runtime) : runtime_(runtime), exceptions_(std::uncaught_exceptions()) {}
    ~Settled() {
      if (std::uncaught_exceptions() > exceptions_) runtime_.settle();
    }
    Settled(const Settled&) = delete;
    Settled& operator=(const Settled&) = delete;

   private:
    const Runtime& runtime_;
    int exceptions_;
  };

  /// As long as this lives, calls a function before a program is compiled from its source, which takes time.
  class BeforeCompiling {
   public:
    BeforeCompiling(Runtime& runtime, std::function<void()> call) : runtime_(runtime) {
      runtime.backend_->before_compiling = std::move(call);
    }
    ~BeforeCompiling() { runtime_.backend_->before_compiling = nullptr; }
    BeforeCompiling(const BeforeCompiling&) = delete;
    BeforeCompiling& operator=(const BeforeCompiling&) = delete;

   private:
    Runtime& runtime_;
  };

  /// Records later launches. words: the counters of each launch, in a slower build of the kernels; not while
  /// they count otherwise (set_counters), and not natively.
  void record_launches(const CountedWords& words = {});
  void stop_recording();
  /// The launches since the last reset, empty if they are not recorded. Waits, which is not counted.
  std::vector<Launch> recorded_launches();
  /// For the record: how many elements each work-item of the next launch goes through, at most.
  void note_elements(std::size_t elements) { accounts_.next.elements = elements; }
  /// For the record: one of `spread` consecutive work-items of the next launch has work.
  void note_spread(std::size_t spread) { accounts_.next.spread = spread; }

  /// Makes later launches use kernels that are compiled with FLAUNAY_COUNT. Kernels that count get these
  /// counters as their last argument. An empty buffer ends this.
  void set_counters(const Buffer<cl_uint>& counters);
  /// The times per kernel since the last reset; empty without profiling.
  std::map<std::string, KernelTime> kernel_times();
  const Accounts& accounts() const { return accounts_; }
  /// Seconds on a clock that stands still while kernels are compiled.
  double working_clock() const;
  void reset_accounts();

 private:
  using MakeBackend = std::function<std::unique_ptr<Backend>(Accounts&)>;
  Runtime(Settings settings, const MakeBackend& make);

  void set(Settings settings);
  /// The compiler options of the kernels.
  std::string build_options() const;

  template <typename T>
  Buffer<T> view_by(const T* values, std::size_t count,
                    void (Runtime::*write_to)(const Buffer<T>&, std::size_t, std::size_t, const T*)) {
    if (sizes_->in_host_memory && count > 0) {
      return {backend_->wrap(const_cast<T*>(values), count * sizeof(T), CL_MEM_READ_ONLY), count};
    }
    const auto copy = arena_.allocate<T>(count);
    (this->*write_to)(copy, 0, count, values);
    return copy;
  }
  void touch_new(void* begin, std::size_t bytes);
  template <typename Launcher, typename... Leading>
  void launch_with(std::size_t work_items, std::size_t group, const Launcher& launcher,
                   const Leading&... leading) {
    if (work_items == 0 || counts_only_) return;
    launch_by(Launcher::kernel_name, work_items, group, [&](auto&& visit) {
      (visit(leading), ...);
      launcher.for_each_argument(visit);
    });
  }
  /// for_each_argument: calls a function with each argument.
  template <typename ForEachArgument>
  void launch_by(const KernelName& name, std::size_t work_items, std::size_t group,
                 const ForEachArgument& for_each_argument) {
    ArgumentList arguments;
    for_each_argument([&](const auto& argument) { arguments(argument); });
    if (!is_native()) return launch_on_device(name, arguments, work_items, group);
    const bool counts = counting_ && name.counting != nullptr;
    if (counts) arguments(counters_);
    backend_->launch(name, counts ? name.counting : name.native, arguments.values(), work_items, group);
    if (counts && accounts_.log != nullptr) record_counted();
  }
  void launch_on_device(const KernelName& name, ArgumentList& arguments, std::size_t work_items,
                        std::size_t group);
  Kernel& find_kernel(const KernelName& name);
  void read_bytes(cl_mem from, std::size_t offset, std::size_t bytes, void* to);
  void record_counted();
  /// Runs commands that do not belong to the call. They are neither counted nor recorded.
  template <typename Commands>
  void uncounted(const Commands& commands) {
    const struct Restored {
      Accounts& accounts;
      Accounts kept = std::exchange(accounts, {});
      ~Restored() { accounts = std::move(kept); }
    } restored{accounts_};
    commands();
  }

  Accounts accounts_;
  std::shared_ptr<const Sizes> sizes_;
  Capabilities capabilities_;
  std::unique_ptr<Backend> backend_;
#ifndef FLAUNAY_WITHOUT_OPENCL
  bool is_native_;
#endif
  std::vector<std::shared_ptr<void>> kept_;  // values of write_kept
  Arena arena_;
  // Two of each: without counting, and with it.
  std::map<const KernelName*, std::unique_ptr<Kernel>> kernels_[2];
  Buffer<cl_uint> counters_{};
  bool counting_ = false;
  bool counts_only_ = false;
};

}  // namespace flaunay::host
