#include "host/runtime.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/compute/platform.hpp>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include "host/byte_order.hpp"
#include "host/clock.hpp"
#include "host/device.hpp"
#include "host/huge_pages.hpp"
#include "host/pocl.hpp"
#include "host/program_cache.hpp"
#include "host/system_memory.hpp"
#include "kernels/embedded.hpp"
#include "operations/counting.h"

namespace flaunay::host {
namespace {

std::string read_kernel_file(const std::string& name) {
  if (const char* directory = std::getenv("FLAUNAY_KERNEL_PATH");
      directory != nullptr && *directory != '\0') {
    const std::string path = std::string(directory) + "/" + name;
    std::ifstream file(path, std::ios::binary);
    if (!file) throw DeviceError(fmt::format("cannot read {} (FLAUNAY_KERNEL_PATH={})", path, directory));
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  for (const EmbeddedFile& file : embedded_kernels()) {
    if (name == file.name) return std::string(file.text, file.size);
  }
  throw DeviceError(fmt::format("no kernel file {} in this build", name));
}

// Inserts included files, each once, so that the driver does not have to find files.
void append_with_includes(const std::string& name, std::set<std::string>& seen, std::string& out) {
  if (!seen.insert(name).second) return;
  std::istringstream lines(read_kernel_file(name));
  out += fmt::format("#line 1 \"{}\"\n", name);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string prefix = "#include \"";
    if (line.compare(0, prefix.size(), prefix) == 0) {
      append_with_includes(line.substr(prefix.size(), line.find('"', prefix.size()) - prefix.size()), seen,
                           out);
      out += fmt::format("#line {} \"{}\"\n", number + 1, name);
    } else {
      out += line + "\n";
    }
  }
}

}  // namespace

std::string kernel_source(const std::string& file) {
  std::set<std::string> seen;
  std::string source;
  append_with_includes(file + ".cl", seen, source);
  return source;
}

Runtime::Runtime(const boost::compute::device& device, std::shared_ptr<const Sizes> sizes)
    : Runtime(boost::compute::context(device), device, std::move(sizes)) {}

Runtime::Runtime(const boost::compute::context& context, const boost::compute::device& device,
                 std::shared_ptr<const Sizes> sizes)
    : device_(device),
      on_pocl_(is_pocl(device.platform().id())),
      sizes_(std::move(sizes)),
      context_(context),
      own_queues_{make_queue(false), {}},
      queue_(own_queues_[0]),
      arena_(memory_of(context_, device)) {
  if (sizes_->separate_buffers != 0) arena_.separate_buffers();
}

Runtime::Runtime(std::shared_ptr<const Sizes> sizes)
    : threads_(std::make_unique<Threads>()), sizes_(std::move(sizes)), arena_(native_memory()) {
  if (sizes_->separate_buffers != 0) arena_.separate_buffers();
}

Runtime::~Runtime() {
  settle();
  if (on_pocl_ && !programs_[0].empty()) note_pocl_ended_well();
  for (const TimedLaunch& timed : events_) clReleaseEvent(timed.event);
}

std::string Runtime::name() const { return is_native() ? "host" : device_.name(); }

std::string Runtime::identity() const {
  const auto platform = device_.platform();
  return fmt::format("{}\n{}\n{}\n{}\n{}", platform.name(), platform.version(), device_.vendor(),
                     device_.name(), device_.driver_version());
}

MemorySource Runtime::memory() const { return is_native() ? native_memory() : memory_of(context_, device_); }

// Makes an in-order queue. Time stamps slow some devices down, so they are only enabled for profiling.
boost::compute::command_queue Runtime::make_queue(bool profiling) const {
  return {context_, device_, profiling ? CL_QUEUE_PROFILING_ENABLE : cl_command_queue_properties{0}};
}

void Runtime::use_queue(cl_command_queue wanted, bool profiling) {
  if (is_native()) {
    profiling_ = profiling;
    return;
  }
  if (wanted == nullptr || (wanted == own_queues_[0].get() && profiling)) {
    if (profiling && own_queues_[1].get() == nullptr) own_queues_[1] = make_queue(true);
    wanted = own_queues_[profiling].get();
  }
  collect_times();
  const boost::compute::command_queue before = queue_;
  queue_ = boost::compute::command_queue(wanted);
  if (before != queue_) follow(before.get());
  // Work that was enqueued on the other queue must be complete before later work begins.
  if (wanted == own_queues_[1].get() && before != own_queues_[0]) follow(own_queues_[0].get());
  profiling_ = profiling;
  is_unordered_ = queue_.get_info<cl_command_queue_properties>(CL_QUEUE_PROPERTIES) &
                  CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE;
  keep_order();
}

void Runtime::follow(cl_command_queue other) {
  cl_event done = nullptr;
  FLAUNAY_CL(clEnqueueMarkerWithWaitList(other, 0, nullptr, &done));
  const cl_int flushed = clFlush(other);
  const cl_int code = clEnqueueBarrierWithWaitList(queue_.get(), 1, &done, nullptr);
  clReleaseEvent(done);
  check_call(flushed, "clFlush");
  check_call(code, "clEnqueueBarrierWithWaitList");
}

void Runtime::wait_for(const std::vector<cl_event>& events) {
  if (events.empty()) return;
  FLAUNAY_CL(clEnqueueBarrierWithWaitList(queue_.get(), static_cast<cl_uint>(events.size()), events.data(),
                                          nullptr));
}

cl_event Runtime::mark() {
  cl_event event = nullptr;
  FLAUNAY_CL(clEnqueueMarkerWithWaitList(queue_.get(), 0, nullptr, &event));
  return event;
}

void Runtime::await(cl_event event) {
  ++waits_;
  FLAUNAY_CL(clWaitForEvents(1, &event));
}

void Runtime::keep_order() {
  if (is_unordered_) FLAUNAY_CL(clEnqueueBarrierWithWaitList(queue_.get(), 0, nullptr, nullptr));
}

void Runtime::set_sizes(std::shared_ptr<const Sizes> sizes) {
  // Pending events refer to kernels by name.
  collect_times();
  const std::string compiled_for = sizes_->build_options();
  sizes_ = std::move(sizes);
  if (sizes_->build_options() == compiled_for) return;
  for (auto& kernels : kernels_) kernels.clear();
  for (auto& programs : programs_) programs.clear();
}

void Runtime::set_counters(const Buffer<cl_uint>& counters) {
  counters_ = counters;
  counting_ = counters.memory() != nullptr;
}

void Runtime::record_launches(bool with_steps) {
  // Pending events refer to launches of another log, if any.
  collect_times();
  log_ = std::make_unique<LaunchLog>(memory(), with_steps && !is_native());
  if (!log_->counts_steps()) return;
  set_counters(log_->counters());
  const cl_uint zero = 0;
  FLAUNAY_CL(clEnqueueFillBuffer(queue_.get(), counters_.memory(), &zero, sizeof zero, 0,
                                 counters_.size() * sizeof zero, 0, nullptr, nullptr));
  keep_order();
}

void Runtime::stop_recording() {
  if (log_ == nullptr) return;
  // The device may still write counters to the log.
  settle();
  if (log_->counts_steps()) set_counters({});
  log_ = nullptr;
}

std::vector<Launch> Runtime::recorded_launches() {
  if (log_ == nullptr) return {};
  collect_times();
  settle();
  return log_->launches();
}

// Reads what the last launch has counted and sets it to 0; these are no commands of the call.
void Runtime::record_steps() {
  constexpr std::size_t kOffset = kernel::COUNTER_STEPS * sizeof(cl_uint),
                        kBytes = kernel::STEP_COUNTERS * sizeof(cl_uint);
  const cl_uint zero = 0;
  FLAUNAY_CL(clEnqueueReadBuffer(queue_.get(), counters_.memory(), CL_FALSE, kOffset, kBytes,
                                 log_->steps_of_last(), 0, nullptr, nullptr));
  keep_order();
  FLAUNAY_CL(clEnqueueFillBuffer(queue_.get(), counters_.memory(), &zero, sizeof zero, kOffset, kBytes, 0,
                                 nullptr, nullptr));
  keep_order();
}

// What a copy of a compiled program needs at most, the driver's own work included.
constexpr std::size_t kSpaceForBinaries = std::size_t{512} << 20;

const boost::compute::program& Runtime::find_program(const std::string& file) {
  auto& programs = programs_[counting_];
  const auto found = programs.find(file);
  if (found != programs.end()) return found->second;
  const double begin = now();
  if (on_pocl_) require_pocl_compiler();
  const std::string source = kernel_source(file);
  const std::string options =
      fmt::format("-cl-std=CL1.2 {}{}", sizes_->build_options(), counting_ ? " -DFLAUNAY_COUNT" : "");
  // Everything that a compiled program depends on.
  const std::string key = fmt::format("{}\n{}\n{}\n{}", FLAUNAY_VERSION, identity(), options, source);
  const ProgramCache cache(default_cache_folder());
  boost::compute::program program;
  if (const auto binary = cache.load(key)) program = program_of(*binary, options);
  if (program.get() == nullptr) {
    if (before_compiling_) before_compiling_();
    program = compiled(file, source, options);
    // Some drivers end the process if there is no memory for the copy.
    const bool is_kept = !cache.folder().empty() && address_space_left().bytes >= kSpaceForBinaries;
    if (const std::string binary = is_kept ? binary_of(program) : ""; !binary.empty()) {
      cache.store(key, binary);
    }
  }
  const double seconds = now() - begin;
  build_seconds_ += seconds;
  all_build_seconds_ += seconds;
  return programs.emplace(file, std::move(program)).first->second;
}

// Makes a program of what binary_of returned; null if the driver does not accept it.
boost::compute::program Runtime::program_of(const std::string& binary, const std::string& options) const {
  const auto* bytes = reinterpret_cast<const unsigned char*>(binary.data());
  const std::size_t size = binary.size();
  const cl_device_id id = device_.id();
  cl_int status = CL_SUCCESS, code = CL_SUCCESS;
  cl_program made = clCreateProgramWithBinary(context_.get(), 1, &id, &size, &bytes, &status, &code);
  if (made == nullptr) return {};
  boost::compute::program program(made, false);
  if (code != CL_SUCCESS || status != CL_SUCCESS) return {};
  if (clBuildProgram(made, 1, &id, options.c_str(), nullptr, nullptr) != CL_SUCCESS) return {};
  return program;
}

boost::compute::program Runtime::compiled(const std::string& file, const std::string& source,
                                          const std::string& options) const {
  auto program = boost::compute::program::create_with_source(source, context_);
  const cl_device_id id = device_.id();
  const cl_int code = clBuildProgram(program.get(), 1, &id, options.c_str(), nullptr, nullptr);
  if (code != CL_SUCCESS) {
    std::size_t size = 0;
    clGetProgramBuildInfo(program.get(), id, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
    std::string log(size, '\0');
    clGetProgramBuildInfo(program.get(), id, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
    throw DeviceError(fmt::format("{} ({}) from clBuildProgram of kernels/{}.cl; {}\n{}", error_name(code),
                                  code, file, error_advice(code), log.c_str()),
                      code, "clBuildProgram");
  }
  return program;
}

// The compiled program as the driver stores it; empty if it does not.
std::string Runtime::binary_of(const boost::compute::program& program) const {
  // One entry per device of the context, of which only ours has a binary.
  cl_uint devices = 0;
  if (clGetProgramInfo(program.get(), CL_PROGRAM_NUM_DEVICES, sizeof devices, &devices, nullptr) !=
      CL_SUCCESS)
    return "";
  std::vector<cl_device_id> ids(devices);
  std::vector<std::size_t> sizes(devices);
  const std::size_t bytes = devices * sizeof(std::size_t);
  if (clGetProgramInfo(program.get(), CL_PROGRAM_DEVICES, devices * sizeof(cl_device_id), ids.data(),
                       nullptr) != CL_SUCCESS ||
      clGetProgramInfo(program.get(), CL_PROGRAM_BINARY_SIZES, bytes, sizes.data(), nullptr) != CL_SUCCESS) {
    return "";
  }
  std::vector<std::string> binaries;
  std::vector<unsigned char*> places;
  for (const std::size_t size : sizes) binaries.emplace_back(size, '\0');
  for (std::string& binary : binaries) places.push_back(reinterpret_cast<unsigned char*>(binary.data()));
  if (clGetProgramInfo(program.get(), CL_PROGRAM_BINARIES, devices * sizeof(unsigned char*), places.data(),
                       nullptr) != CL_SUCCESS) {
    return "";
  }
  const auto own = std::find(ids.begin(), ids.end(), device_.id());
  return own == ids.end() ? "" : binaries[static_cast<std::size_t>(own - ids.begin())];
}

Runtime::Kernel& Runtime::find_kernel(const KernelName& name) {
  auto& kernels = kernels_[counting_];
  const auto found = kernels.find(&name);
  return found != kernels.end() ? found->second : kernels.emplace(&name, make_kernel(name)).first->second;
}

Runtime::Kernel Runtime::make_kernel(const KernelName& wanted) {
  const auto [file, name, native] = wanted;
  if (is_native()) {
    if (native == nullptr) throw DeviceError(fmt::format("kernel {} needs an OpenCL device", name));
    return {{}, name, 0, 1, false, native};
  }
  const boost::compute::program& program = find_program(file);
  cl_int code = CL_SUCCESS;
  cl_kernel kernel = clCreateKernel(program.get(), name, &code);
  check_call(code, "clCreateKernel", fmt::format("{}.cl: {}", file, name));
  const boost::compute::kernel owned(kernel, false);
  const auto arguments = static_cast<cl_uint>(owned.arity());
  std::size_t largest = 0;
  std::size_t required[3] = {};
  cl_ulong local_memory = 0;
  const auto query = [&](cl_kernel_work_group_info what, std::size_t size, void* value) {
    FLAUNAY_CL_KERNEL(clGetKernelWorkGroupInfo(kernel, device_.id(), what, size, value, nullptr), name);
  };
  query(CL_KERNEL_WORK_GROUP_SIZE, sizeof largest, &largest);
  query(CL_KERNEL_COMPILE_WORK_GROUP_SIZE, sizeof required, required);
  query(CL_KERNEL_LOCAL_MEM_SIZE, sizeof local_memory, &local_memory);
  if (local_memory > device_.get_info<cl_ulong>(CL_DEVICE_LOCAL_MEM_SIZE)) largest = 0;
  return {owned, name, arguments, largest, required[0] != 0};
}

// Parts of a launch are several groups, but not so many that threads would wait for the last one for long.
constexpr std::size_t kPartsPerThread = 8;

void Runtime::run_natively(Kernel& kernel, std::size_t work_items, std::size_t group) {
  std::vector<void*> arguments;
  arguments.reserve(kernel.native_arguments.size());
  for (Argument& argument : kernel.native_arguments) arguments.push_back(argument.bytes);
  const double begin = profiling_ ? now() : 0;
  threads_->share(work_items, std::max(group, work_items / (kPartsPerThread * threads_->count())),
                  [&](std::size_t first, std::size_t last) {
                    kernel.native({first, last, work_items}, arguments.data());
                  });
  if (!profiling_) return;
  const double seconds = now() - begin;
  KernelTime& time = times_[kernel.name];
  ++time.launches;
  time.seconds += seconds;
  if (log_ != nullptr) log_->set_seconds(log_->last(), seconds);
}

void Runtime::touch_new(void* begin, std::size_t bytes) {
  prefer_huge_pages(begin, bytes);
  // On a device, pages are touched while it computes.
  if (!is_native()) return;
  constexpr std::size_t kPage = 4096, kPagesPerPart = 512;
  auto* const pages = static_cast<volatile unsigned char*>(begin);
  threads_->share((bytes + kPage - 1) / kPage, kPagesPerPart, [&](std::size_t first, std::size_t last) {
    for (std::size_t page = first; page < last; ++page) pages[page * kPage] = 0;
  });
}

void Runtime::enqueue(Kernel& kernel, std::size_t work_items, std::size_t group) {
  if (work_items == 0) return;  // OpenCL 1.2 does not allow empty launches
  if (!is_native() && !kernel.requires_group)
    group = std::max<std::size_t>(1, std::min(group, kernel.largest_group));
  ++launches_;
  const std::size_t elements = std::exchange(elements_, 1), spread = std::exchange(spread_, 1);
  const std::size_t busy = std::exchange(busy_items_, std::numeric_limits<std::size_t>::max());
  if (log_ != nullptr) {
    log_->add({kernel.name, std::min(work_items, busy), group, (group + spread - 1) / spread, elements});
  }
  if (is_native()) return run_natively(kernel, work_items, group);
  cl_event event = nullptr;
  for (;;) {
    const std::size_t global = (work_items + group - 1) / group * group;
    const cl_int code = clEnqueueNDRangeKernel(queue_.get(), kernel.kernel.get(), 1, nullptr, &global, &group,
                                               0, nullptr, profiling_ ? &event : nullptr);
    // The launch may need more registers than the device has, although the driver reported the group size as
    // possible.
    const bool is_too_large = code == CL_INVALID_WORK_GROUP_SIZE || code == CL_OUT_OF_RESOURCES;
    if (!is_too_large || group == 1 || kernel.requires_group) {
      check_call(code, "clEnqueueNDRangeKernel", kernel.name);
      break;
    }
    group /= 2;
    kernel.largest_group = group;
  }
  if (profiling_) events_.push_back({event, &kernel.name, log_ != nullptr ? log_->last() : 0});
  keep_order();
  if (profiling_ && events_.size() >= 4096) collect_times();
}

void Runtime::enqueue_read(cl_mem from, std::size_t offset, std::size_t bytes, void* to, cl_bool wait) {
  if (is_native()) {
    std::memcpy(to, address_of(from) + offset, bytes);
    return;
  }
  FLAUNAY_CL(clEnqueueReadBuffer(queue_.get(), from, wait, offset, bytes, to, 0, nullptr, nullptr));
  bytes_to_host_ += bytes;
  if (wait) {
    ++waits_;
    kept_.clear();
  } else {
    keep_order();
  }
}

void Runtime::enqueue_write(cl_mem to, std::size_t offset, std::size_t bytes, const void* from,
                            cl_bool wait) {
  if (is_native()) {
    std::memcpy(address_of(to) + offset, from, bytes);
    return;
  }
  FLAUNAY_CL(clEnqueueWriteBuffer(queue_.get(), to, wait, offset, bytes, from, 0, nullptr, nullptr));
  bytes_to_device_ += bytes;
  // A blocking write may return as soon as the driver has a copy, before earlier commands have ended, as it
  // does with Intel's CPU runtime: so kept values stay.
  if (wait) {
    ++waits_;
  } else {
    keep_order();
  }
}

void Runtime::enqueue_fill(cl_mem to, const void* value, std::size_t value_bytes, std::size_t bytes) {
  if (is_native()) {
    for (std::size_t at = 0; at < bytes; at += value_bytes)
      std::memcpy(address_of(to) + at, value, value_bytes);
    return;
  }
  ++launches_;
  if (log_ != nullptr) log_->add({"fill", 0, 0, 0, 0, bytes});
  FLAUNAY_CL(clEnqueueFillBuffer(queue_.get(), to, value, value_bytes, 0, bytes, 0, nullptr, nullptr));
  keep_order();
}

void Runtime::enqueue_copy(cl_mem from, std::size_t from_offset, cl_mem to, std::size_t to_offset,
                           std::size_t bytes) {
  if (is_native()) {
    std::memmove(address_of(to) + to_offset, address_of(from) + from_offset, bytes);
    return;
  }
  ++launches_;
  if (log_ != nullptr) log_->add({"copy", 0, 0, 0, 0, bytes});
  FLAUNAY_CL(clEnqueueCopyBuffer(queue_.get(), from, to, from_offset, to_offset, bytes, 0, nullptr, nullptr));
  keep_order();
}

std::shared_ptr<_cl_mem> Runtime::wrap(void* memory, std::size_t bytes, cl_mem_flags access) {
  if (is_native()) return {std::shared_ptr<void>(), handle_of(memory)};
  cl_int code = CL_SUCCESS;
  cl_mem buffer = clCreateBuffer(context_.get(), access | CL_MEM_USE_HOST_PTR, bytes, memory, &code);
  check_call(code, "clCreateBuffer");
  return std::shared_ptr<_cl_mem>(buffer, [](cl_mem m) { clReleaseMemObject(m); });
}

void Runtime::hand_over(cl_mem shared, std::size_t bytes) {
  if (is_native()) return;
  cl_int code = CL_SUCCESS;
  void* mapped =
      clEnqueueMapBuffer(queue_.get(), shared, CL_FALSE, CL_MAP_READ, 0, bytes, 0, nullptr, nullptr, &code);
  check_call(code, "clEnqueueMapBuffer");
  keep_order();
  FLAUNAY_CL(clEnqueueUnmapMemObject(queue_.get(), shared, mapped, 0, nullptr, nullptr));
  keep_order();
}

void Runtime::flush() {
  if (!is_native()) FLAUNAY_CL(clFlush(queue_.get()));
}

void Runtime::settle() const {
  if (!is_native()) clFinish(queue_.get());
}

void Runtime::finish() {
  if (is_native()) {
    kept_.clear();
    return;
  }
  ++waits_;
  FLAUNAY_CL(clFinish(queue_.get()));
  kept_.clear();
}

void Runtime::collect_times() {
  if (events_.empty()) return;
  FLAUNAY_CL(clFinish(queue_.get()));
  const auto events = std::exchange(events_, {});
  for (const auto& [event, name, launch] : events) {
    cl_ulong begin = 0, end = 0;
    const cl_int code =
        clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof begin, &begin, nullptr) |
        clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, nullptr);
    clReleaseEvent(event);
    if (code != CL_SUCCESS) continue;  // the kernel failed, which other calls report
    KernelTime& time = times_[*name];
    ++time.launches;
    const double seconds = 1e-9 * static_cast<double>(end - begin);
    time.seconds += seconds;
    if (log_ != nullptr) log_->set_seconds(launch, seconds);
  }
}

std::map<std::string, KernelTime> Runtime::kernel_times() {
  collect_times();
  return times_;
}

double Runtime::working_clock() const { return now() - all_build_seconds_; }

void Runtime::reset_accounts() {
  collect_times();
  times_.clear();
  launches_ = 0;
  waits_ = 0;
  bytes_to_device_ = 0;
  bytes_to_host_ = 0;
  build_seconds_ = 0;
  arena_.reset_peak();
  if (log_ != nullptr) {
    settle();
    log_->clear();
  }
}

}  // namespace flaunay::host
