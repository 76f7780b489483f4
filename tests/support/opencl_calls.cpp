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

}  // namespace
}  // namespace flaunay::testing

using flaunay::testing::next;
using flaunay::testing::opencl_calls;

extern "C" {

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t bytes, void* host, cl_int* code) {
  static auto* const real = next(clCreateBuffer, "clCreateBuffer");
  const cl_int failure = opencl_calls().buffer_failure;
  if (failure != CL_SUCCESS) {
    if (code != nullptr) *code = failure;
    return nullptr;
  }
  ++opencl_calls().buffers;
  return real(context, flags, bytes, host, code);
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
