#include "host/opencl/backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/compute/kernel.hpp>
#include <boost/compute/platform.hpp>
#include <utility>

#include "host/clock.hpp"
#include "host/error.hpp"
#include "host/opencl/pocl.hpp"

namespace flaunay::host {
namespace {

class OpenClKernel : public Kernel {
 public:
  OpenClKernel(const char* name, boost::compute::kernel made, const boost::compute::device& device)
      : Kernel(name), kernel_(std::move(made)) {
    std::size_t required[3] = {};
    cl_ulong local_memory = 0;
    const auto query = [&](cl_kernel_work_group_info what, std::size_t size, void* value) {
      FLAUNAY_CL_KERNEL(clGetKernelWorkGroupInfo(kernel_.get(), device.id(), what, size, value, nullptr),
                        name);
    };
    query(CL_KERNEL_WORK_GROUP_SIZE, sizeof largest_group, &largest_group);
    query(CL_KERNEL_COMPILE_WORK_GROUP_SIZE, sizeof required, required);
    query(CL_KERNEL_LOCAL_MEM_SIZE, sizeof local_memory, &local_memory);
    has_local_memory = local_memory <= device.get_info<cl_ulong>(CL_DEVICE_LOCAL_MEM_SIZE);
    requires_group = required[0] != 0;
  }
  void set_argument(cl_uint index, const void* value, std::size_t bytes) override {
    FLAUNAY_CL_KERNEL(clSetKernelArg(kernel_.get(), index, bytes, value), name());
  }
  bool takes_counters(cl_uint arguments) const override { return arguments < kernel_.arity(); }
  cl_kernel get() const { return kernel_.get(); }

  bool requires_group = false;  ///< whether it has the attribute reqd_work_group_size

 private:
  boost::compute::kernel kernel_;
};

std::string identity_of(const boost::compute::device& device) {
  const auto platform = device.platform();
  return fmt::format("{}\n{}\n{}\n{}\n{}", platform.name(), platform.version(), device.vendor(),
                     device.name(), device.driver_version());
}

}  // namespace

OpenClBackend::OpenClBackend(Accounts& accounts, const boost::compute::context& context,
                             const boost::compute::device& device)
    : Backend(accounts),
      device_(device),
      context_(context),
      on_pocl_(is_pocl(device.platform().id())),
      own_queues_{make_queue(false), {}},
      queue_(own_queues_[0]),
      programs_(context_, device_, identity_of(device)) {
  if (device.get_info<cl_bool>(CL_DEVICE_ENDIAN_LITTLE)) return;
  throw DeviceError(
      fmt::format("{} cannot be used: it is big-endian (CL_DEVICE_ENDIAN_LITTLE), and arrays of the host are "
                  "little-endian; try another device (FLAUNAY_DEVICE)",
                  name()));
}

OpenClBackend::~OpenClBackend() {
  settle();
  if (on_pocl_ && !programs_.empty()) note_pocl_ended_well();
  for (const TimedLaunch& timed : events_) clReleaseEvent(timed.event);
}

std::string OpenClBackend::identity() const { return identity_of(device_); }

// Makes an in-order queue. Time stamps slow some devices down, so they are only enabled for profiling.
boost::compute::command_queue OpenClBackend::make_queue(bool profiling) const {
  return {context_, device_, profiling ? CL_QUEUE_PROFILING_ENABLE : cl_command_queue_properties{0}};
}

void OpenClBackend::use_queue(cl_command_queue wanted, bool profiling) {
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

void OpenClBackend::follow(cl_command_queue other) {
  cl_event done = nullptr;
  FLAUNAY_CL(clEnqueueMarkerWithWaitList(other, 0, nullptr, &done));
  const cl_int flushed = clFlush(other);
  const cl_int code = clEnqueueBarrierWithWaitList(queue_.get(), 1, &done, nullptr);
  clReleaseEvent(done);
  check_call(flushed, "clFlush");
  check_call(code, "clEnqueueBarrierWithWaitList");
}

void OpenClBackend::wait_for(const std::vector<cl_event>& events) {
  if (events.empty()) return;
  FLAUNAY_CL(clEnqueueBarrierWithWaitList(queue_.get(), static_cast<cl_uint>(events.size()), events.data(),
                                          nullptr));
}

cl_event OpenClBackend::mark() {
  cl_event event = nullptr;
  FLAUNAY_CL(clEnqueueMarkerWithWaitList(queue_.get(), 0, nullptr, &event));
  return event;
}

void OpenClBackend::await(cl_event event) {
  ++accounts().waits;
  FLAUNAY_CL(clWaitForEvents(1, &event));
  finish_reads();
}

void OpenClBackend::keep_order() {
  if (is_unordered_) FLAUNAY_CL(clEnqueueBarrierWithWaitList(queue_.get(), 0, nullptr, nullptr));
}

std::unique_ptr<Kernel> OpenClBackend::make_kernel(const KernelName& wanted, const std::string& settings,
                                                   bool counting) {
  const std::string options = fmt::format("-cl-std=CL1.2 {}{}", settings, counting ? " -DFLAUNAY_COUNT" : "");
  const boost::compute::program* program = programs_.find(wanted.program, options);
  if (program == nullptr) {
    const double begin = now();
    if (on_pocl_) require_pocl_compiler();
    program = programs_.make(wanted.program, options, before_compiling);
    const double seconds = now() - begin;
    accounts().build_seconds += seconds;
    accounts().all_build_seconds += seconds;
  }
  cl_int code = CL_SUCCESS;
  cl_kernel kernel = clCreateKernel(program->get(), wanted.name, &code);
  check_call(code, "clCreateKernel", fmt::format("{}.cl: {}", wanted.program, wanted.name));
  return std::make_unique<OpenClKernel>(wanted.name, boost::compute::kernel(kernel, false), device_);
}

void OpenClBackend::launch(Kernel& launched, std::size_t work_items, std::size_t group) {
  auto& kernel = static_cast<OpenClKernel&>(launched);
  if (!kernel.requires_group) group = std::max<std::size_t>(1, std::min(group, kernel.largest_group));
  accounts().add_launch(kernel.name().c_str(), work_items, group);
  cl_event event = nullptr;
  for (;;) {
    const std::size_t global = (work_items + group - 1) / group * group;
    const cl_int code = clEnqueueNDRangeKernel(queue_.get(), kernel.get(), 1, nullptr, &global, &group, 0,
                                               nullptr, profiling_ ? &event : nullptr);
    // The launch may need more registers than the device has, although the driver reported the group size as
    // possible.
    const bool is_too_large = code == CL_INVALID_WORK_GROUP_SIZE || code == CL_OUT_OF_RESOURCES;
    if (!is_too_large || group == 1 || kernel.requires_group) {
      check_call(code, "clEnqueueNDRangeKernel", kernel.name());
      break;
    }
    group /= 2;
    kernel.largest_group = group;
  }
  if (profiling_) events_.push_back({event, &kernel.name(), accounts().last_launch()});
  keep_order();
  if (profiling_ && events_.size() >= 4096) collect_times();
}

Staging* OpenClBackend::staging_for(std::size_t bytes) {
  // To wake threads up for fewer bytes takes as long as the driver's own copy.
  constexpr std::size_t kLeastShare = 4;
  if (staging_bytes == 0 || bytes < staging_bytes / kLeastShare) return nullptr;
  if (staging_of_ != staging_bytes) {
    finish_reads();
    staging_.reset();
    staging_of_ = staging_bytes;
    try {
      staging_ = std::make_unique<Staging>(own_queues_[0], staging_bytes);
    } catch (const DeviceError&) {
      // Without that memory, transfers take longer.
    }
  }
  return staging_.get();
}

void OpenClBackend::end_transfer(bool wait) {
  if (!wait) return keep_order();
  ++accounts().waits;
  finish_reads();
}

void OpenClBackend::read(cl_mem from, std::size_t offset, std::size_t bytes, void* to, bool wait) {
  if (Staging* const staging = staging_for(bytes)) {
    staging->read(bytes, to, [&](std::size_t begin, std::size_t part, char* staged, cl_event* event) {
      FLAUNAY_CL(
          clEnqueueReadBuffer(queue_.get(), from, CL_FALSE, offset + begin, part, staged, 0, nullptr, event));
      keep_order();
      flush();
    });
  } else {
    FLAUNAY_CL(clEnqueueReadBuffer(queue_.get(), from, wait ? CL_TRUE : CL_FALSE, offset, bytes, to, 0,
                                   nullptr, nullptr));
  }
  accounts().bytes_to_host += bytes;
  end_transfer(wait);
}

void OpenClBackend::write(cl_mem to, std::size_t offset, std::size_t bytes, const void* from, bool wait) {
  if (Staging* const staging = staging_for(bytes)) {
    staging->write(bytes, from, [&](std::size_t begin, std::size_t part, char* staged, cl_event* event) {
      FLAUNAY_CL(
          clEnqueueWriteBuffer(queue_.get(), to, CL_FALSE, offset + begin, part, staged, 0, nullptr, event));
      keep_order();
      flush();
    });
  } else {
    FLAUNAY_CL(clEnqueueWriteBuffer(queue_.get(), to, wait ? CL_TRUE : CL_FALSE, offset, bytes, from, 0,
                                    nullptr, nullptr));
  }
  accounts().bytes_to_device += bytes;
  end_transfer(wait);
}

void OpenClBackend::fill(cl_mem to, std::size_t offset, std::size_t bytes, const void* value,
                         std::size_t value_bytes) {
  accounts().add_transfer("fill", bytes);
  FLAUNAY_CL(clEnqueueFillBuffer(queue_.get(), to, value, value_bytes, offset, bytes, 0, nullptr, nullptr));
  keep_order();
}

void OpenClBackend::copy(cl_mem from, std::size_t from_offset, cl_mem to, std::size_t to_offset,
                         std::size_t bytes) {
  accounts().add_transfer("copy", bytes);
  FLAUNAY_CL(clEnqueueCopyBuffer(queue_.get(), from, to, from_offset, to_offset, bytes, 0, nullptr, nullptr));
  keep_order();
}

std::shared_ptr<_cl_mem> OpenClBackend::wrap(void* memory, std::size_t bytes, cl_mem_flags access) {
  cl_int code = CL_SUCCESS;
  cl_mem buffer = clCreateBuffer(context_.get(), access | CL_MEM_USE_HOST_PTR, bytes, memory, &code);
  check_call(code, "clCreateBuffer");
  return std::shared_ptr<_cl_mem>(buffer, [](cl_mem m) { clReleaseMemObject(m); });
}

void OpenClBackend::hand_over(cl_mem shared, std::size_t bytes) {
  cl_int code = CL_SUCCESS;
  void* mapped =
      clEnqueueMapBuffer(queue_.get(), shared, CL_FALSE, CL_MAP_READ, 0, bytes, 0, nullptr, nullptr, &code);
  check_call(code, "clEnqueueMapBuffer");
  keep_order();
  FLAUNAY_CL(clEnqueueUnmapMemObject(queue_.get(), shared, mapped, 0, nullptr, nullptr));
  keep_order();
}

void OpenClBackend::flush() { FLAUNAY_CL(clFlush(queue_.get())); }

void OpenClBackend::settle() const {
  try {
    if (staging_ != nullptr) staging_->finish();
  } catch (const std::exception&) {
    // Errors are ignored here, as those of clFinish.
  }
  clFinish(queue_.get());
}

void OpenClBackend::finish() {
  ++accounts().waits;
  finish_reads();
  FLAUNAY_CL(clFinish(queue_.get()));
}

void OpenClBackend::collect_times() {
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
    accounts().add_time(*name, launch, 1e-9 * static_cast<double>(end - begin));
  }
}

}  // namespace flaunay::host
