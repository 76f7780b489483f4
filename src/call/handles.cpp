#include "call/handles.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "geometry/arguments.hpp"

namespace flaunay {

DeviceBuffer::DeviceBuffer(cl_mem memory) : memory_(call::retained(memory)), is_callers_(true) {
  clGetMemObjectInfo(memory, CL_MEM_SIZE, sizeof bytes_, &bytes_, nullptr);
}

namespace call {
namespace {

std::size_t bytes_per_point(const DevicePoints& points) {
  return points.precision == Precision::float32 ? sizeof(cl_float2) : sizeof(cl_double2);
}

[[noreturn]] void throw_usage(const std::string& message) { throw Error(ErrorKind::usage, message); }

void check_queue(host::Runtime& runtime, const Enqueue& enqueue) {
  const cl_command_queue queue = enqueue.queue;
  if (queue == nullptr || queue == runtime.own_queue()) return;
  cl_context context = nullptr;
  const cl_int code = clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof context, &context, nullptr);
  if (code != CL_SUCCESS) {
    throw Error(ErrorKind::usage, fmt::format("the queue is no command queue: {}", host::error_name(code)),
                code, "clGetCommandQueueInfo");
  }
  cl_device_id device = nullptr;
  cl_command_queue_properties properties = 0;
  FLAUNAY_CL(clGetCommandQueueInfo(queue, CL_QUEUE_DEVICE, sizeof device, &device, nullptr));
  FLAUNAY_CL(clGetCommandQueueInfo(queue, CL_QUEUE_PROPERTIES, sizeof properties, &properties, nullptr));
  if (context != runtime.context().get()) {
    throw_usage("the queue is of another context than the triangulator");
  }
  if (device != runtime.device().id()) throw_usage("the queue is of another device than the triangulator");
  if (enqueue.profile && !(properties & CL_QUEUE_PROFILING_ENABLE)) {
    throw_usage("kernels can only be timed on a queue with CL_QUEUE_PROFILING_ENABLE");
  }
}

void check_event(host::Runtime& runtime, cl_event event) {
  cl_context context = nullptr;
  const cl_int code = event == nullptr
                          ? CL_INVALID_EVENT
                          : clGetEventInfo(event, CL_EVENT_CONTEXT, sizeof context, &context, nullptr);
  if (code != CL_SUCCESS) {
    throw Error(ErrorKind::usage, fmt::format("an event to wait for is none: {}", host::error_name(code)),
                code);
  }
  if (context != runtime.context().get()) {
    throw_usage("an event to wait for is of another context than the triangulator");
  }
  cl_int status = 0;
  FLAUNAY_CL(clGetEventInfo(event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr));
  if (status < 0) {
    throw Error(ErrorKind::usage,
                fmt::format("what an event to wait for stands for has failed: {}", host::error_name(status)),
                status);
  }
}

}  // namespace

std::shared_ptr<_cl_mem> retained(cl_mem memory) {
  const cl_int code = memory == nullptr ? CL_INVALID_MEM_OBJECT : clRetainMemObject(memory);
  if (code != CL_SUCCESS) {
    throw Error(ErrorKind::usage,
                fmt::format("{} is no buffer: {}", fmt::ptr(memory), host::error_name(code)), code,
                memory == nullptr ? "" : "clRetainMemObject");
  }
  return std::shared_ptr<_cl_mem>(memory, [](cl_mem m) { clReleaseMemObject(m); });
}

void check_buffer(host::Runtime& runtime, cl_mem memory, std::size_t bytes, Access access,
                  const std::string& what) {
  if (memory == nullptr) {
    if (bytes == 0) return;
    throw_usage(fmt::format("there is no buffer of {} ({} bytes are needed)", what, bytes));
  }
  cl_mem_object_type type = 0;
  const cl_int code = clGetMemObjectInfo(memory, CL_MEM_TYPE, sizeof type, &type, nullptr);
  if (code != CL_SUCCESS) {
    throw Error(ErrorKind::usage, fmt::format("the buffer of {} is none: {}", what, host::error_name(code)),
                code, "clGetMemObjectInfo");
  }
  cl_context context = nullptr;
  std::size_t size = 0;
  cl_mem_flags flags = 0;
  FLAUNAY_CL(clGetMemObjectInfo(memory, CL_MEM_CONTEXT, sizeof context, &context, nullptr));
  FLAUNAY_CL(clGetMemObjectInfo(memory, CL_MEM_SIZE, sizeof size, &size, nullptr));
  FLAUNAY_CL(clGetMemObjectInfo(memory, CL_MEM_FLAGS, sizeof flags, &flags, nullptr));
  if (type != CL_MEM_OBJECT_BUFFER) throw_usage(fmt::format("{} must be in a buffer, not in an image", what));
  if (context != runtime.context().get()) {
    throw_usage(fmt::format("the buffer of {} is of another context than the triangulator", what));
  }
  if (size < bytes) {
    throw_usage(
        fmt::format("the buffer of {} is too small: it has {} bytes, {} are needed", what, size, bytes));
  }
  if (access == Access::host && (flags & (CL_MEM_HOST_NO_ACCESS | CL_MEM_HOST_WRITE_ONLY))) {
    throw_usage(
        fmt::format("the buffer of {} is not for the host to read, but that is where it is read", what));
  }
  if (access == Access::workspace &&
      (flags & (CL_MEM_HOST_NO_ACCESS | CL_MEM_HOST_READ_ONLY | CL_MEM_HOST_WRITE_ONLY | CL_MEM_WRITE_ONLY |
                CL_MEM_READ_ONLY))) {
    throw_usage(
        fmt::format("{} must be for kernels and for the host to read and write: no CL_MEM_READ_ONLY, "
                    "CL_MEM_WRITE_ONLY or CL_MEM_HOST_... flags",
                    what));
  }
  if (access == Access::write && (flags & CL_MEM_READ_ONLY)) {
    throw_usage(fmt::format("the buffer of {} is CL_MEM_READ_ONLY, but results go there", what));
  }
  if (access == Access::read && (flags & CL_MEM_WRITE_ONLY)) {
    throw_usage(fmt::format("the buffer of {} is CL_MEM_WRITE_ONLY, but it is to be read", what));
  }
}

void check_enqueue(host::Runtime& runtime, const Enqueue& enqueue) {
  check_queue(runtime, enqueue);
  for (const cl_event event : enqueue.wait_for) check_event(runtime, event);
}

void check_distinct(std::vector<cl_mem> buffers) {
  buffers.erase(std::remove(buffers.begin(), buffers.end(), nullptr), buffers.end());
  std::sort(buffers.begin(), buffers.end());
  if (std::adjacent_find(buffers.begin(), buffers.end()) != buffers.end()) {
    throw_usage("one buffer is given for two things");
  }
}

std::vector<std::size_t> checked_offsets(host::Runtime& runtime, const DevicePoints& points) {
  std::vector<std::size_t> offsets = points.offsets;
  if (points.device_offsets != nullptr) {
    if (!offsets.empty()) throw_usage("offsets of sets are given twice, in host and in device memory");
    check_buffer(runtime, points.device_offsets, (points.sets + 1) * sizeof(cl_int), Access::host, "offsets");
    std::vector<cl_int> read(points.sets + 1);
    runtime.read(host::Buffer<cl_int>(retained(points.device_offsets), read.size()), 0, read.size(),
                 read.data());
    if (read.front() < 0) throw_usage("offsets of point sets must begin with 0 and not decrease");
    offsets.assign(read.begin(), read.end());
  }
  if (offsets.empty()) offsets = {0, points.count};
  check_offsets(offsets, points.count);
  return offsets;
}

void check_device_points(host::Runtime& runtime, const DevicePoints& points, const char* what) {
  check_enumerator(points.precision);
  check_count(points.count, what);
  check_count(points.first, fmt::format("{} before the first one", what).c_str(), kMostCountable);
  check_count(points.sets, "sets");
  const std::size_t bytes = points.count == 0 ? 0 : (points.first + points.count) * bytes_per_point(points);
  check_buffer(runtime, points.memory, bytes, Access::read, what);
}

void make_result(host::Runtime& runtime, DeviceBuffer& buffer, std::size_t bytes, const std::string& what,
                 std::size_t& made) {
  if (!buffer.is_callers() && buffer.bytes() < bytes) {
    DeviceBufferAccess::set(buffer, nullptr, 0);
    DeviceBufferAccess::set(buffer, host::allocate_memory(runtime.memory(), bytes), bytes);
    ++made;
  }
  check_buffer(runtime, buffer.memory(), bytes, Access::write, what);
}

QueuedCall::QueuedCall(host::Runtime& runtime, const Enqueue& enqueue)
    : runtime_(runtime), enqueue_(enqueue), settled_(runtime) {
  runtime.use_queue(enqueue.queue, enqueue.profile);
  runtime.wait_for(enqueue.wait_for);
}

void QueuedCall::end() {
  // Kernel times are available when all work is done.
  if (enqueue_.profile) runtime_.finish();
  if (enqueue_.event != nullptr) *enqueue_.event = runtime_.mark();
  runtime_.flush();
}

}  // namespace call
}  // namespace flaunay
