// Visible to the library, whatever the tests are compiled with.
#pragma GCC visibility push(default)
#include <CL/cl.h>
#pragma GCC visibility pop

#include <dlfcn.h>

#include "tests/support/opencl_calls.hpp"

namespace flaunay::testing {

OpenclCalls& opencl_calls() {
  static OpenclCalls calls;
  return calls;
}

namespace {

template <typename Function>
Function* next(Function*, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

// Whether another buffer fits; if not, says so.
bool fits(cl_int* code) {
  std::atomic<std::size_t>& left = opencl_calls().buffers_that_fit;
  if (left > 0) {
    --left;
    return true;
  }
  if (code != nullptr) *code = CL_MEM_OBJECT_ALLOCATION_FAILURE;
  return false;
}

}  // namespace
}  // namespace flaunay::testing

using flaunay::testing::fits;
using flaunay::testing::next;
using flaunay::testing::opencl_calls;

extern "C" {

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t bytes, void* host, cl_int* code) {
  static auto* const real = next(clCreateBuffer, "clCreateBuffer");
  const bool is_pinned = flags & CL_MEM_ALLOC_HOST_PTR;
  if (is_pinned && opencl_calls().without_pinned) {
    *code = CL_MEM_OBJECT_ALLOCATION_FAILURE;
    return nullptr;
  }
  if (!fits(code)) return nullptr;
  ++opencl_calls().buffers;
  opencl_calls().pinned += is_pinned;
  return real(context, flags, bytes, host, code);
}

cl_mem clCreateSubBuffer(cl_mem buffer, cl_mem_flags flags, cl_buffer_create_type type, const void* info,
                         cl_int* code) {
  static auto* const real = next(clCreateSubBuffer, "clCreateSubBuffer");
  return fits(code) ? real(buffer, flags, type, info, code) : nullptr;
}

cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset,
                           size_t bytes, void* to, cl_uint count, const cl_event* list, cl_event* event) {
  static auto* const real = next(clEnqueueReadBuffer, "clEnqueueReadBuffer");
  opencl_calls().bytes_to_host += bytes;
  opencl_calls().waits += blocking != CL_FALSE;
  return real(queue, buffer, blocking, offset, bytes, to, count, list, event);
}

cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset,
                            size_t bytes, const void* from, cl_uint count, const cl_event* list,
                            cl_event* event) {
  static auto* const real = next(clEnqueueWriteBuffer, "clEnqueueWriteBuffer");
  opencl_calls().bytes_to_device += bytes;
  opencl_calls().waits += blocking != CL_FALSE;
  return real(queue, buffer, blocking, offset, bytes, from, count, list, event);
}

void* clEnqueueMapBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, cl_map_flags flags,
                         size_t offset, size_t bytes, cl_uint count, const cl_event* list, cl_event* event,
                         cl_int* code) {
  static auto* const real = next(clEnqueueMapBuffer, "clEnqueueMapBuffer");
  opencl_calls().bytes_to_host += bytes;
  opencl_calls().waits += blocking != CL_FALSE;
  return real(queue, buffer, blocking, flags, offset, bytes, count, list, event, code);
}

cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t bytes, void* value, size_t* needed) {
  static auto* const real = next(clGetDeviceInfo, "clGetDeviceInfo");
  const cl_int code = real(device, what, bytes, value, needed);
  if (what == CL_DEVICE_DOUBLE_FP_CONFIG && opencl_calls().without_fp64 && code == CL_SUCCESS &&
      value != nullptr) {
    *static_cast<cl_device_fp_config*>(value) = 0;
  }
  return code;
}

cl_int clFinish(cl_command_queue queue) {
  static auto* const real = next(clFinish, "clFinish");
  ++opencl_calls().waits;
  return real(queue);
}
}
