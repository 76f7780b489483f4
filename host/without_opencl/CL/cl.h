// Replaces OpenCL's header in a build without OpenCL (FLAUNAY_OPENCL=OFF). It has the types, constants and
// functions that code outside host/opencl uses. In such a build, this folder is the first include folder.
#pragma once

#include <cstddef>
#include <cstdint>

#include "src/include/flaunay/opencl.h"

using cl_char = std::int8_t;
using cl_uchar = std::uint8_t;
using cl_int = std::int32_t;
using cl_uint = std::uint32_t;
using cl_long = std::int64_t;
using cl_ulong = std::uint64_t;
using cl_float = float;
using cl_double = double;
using cl_bool = cl_uint;
using cl_mem_object_type = cl_uint;
using cl_command_queue_properties = cl_ulong;
using cl_device_fp_config = cl_ulong;
using cl_device_type = cl_ulong;
using cl_mem_flags = cl_ulong;
using cl_platform_id = struct _cl_platform_id*;

struct cl_buffer_region {
  std::size_t origin, size;
};

// Vectors, which are aligned to their size.
#define FLAUNAY_VECTOR(type, n)              \
  struct alignas(sizeof(type) * n) type##n { \
    type s[n];                               \
  };
FLAUNAY_VECTOR(cl_int, 2)
FLAUNAY_VECTOR(cl_int, 4)
FLAUNAY_VECTOR(cl_uint, 2)
FLAUNAY_VECTOR(cl_uint, 8)
FLAUNAY_VECTOR(cl_long, 2)
FLAUNAY_VECTOR(cl_float, 2)
FLAUNAY_VECTOR(cl_double, 2)
#undef FLAUNAY_VECTOR

// clang-format off
constexpr cl_int CL_SUCCESS = 0, CL_DEVICE_NOT_FOUND = -1, CL_DEVICE_NOT_AVAILABLE = -2,
    CL_COMPILER_NOT_AVAILABLE = -3, CL_MEM_OBJECT_ALLOCATION_FAILURE = -4, CL_OUT_OF_RESOURCES = -5,
    CL_OUT_OF_HOST_MEMORY = -6, CL_PROFILING_INFO_NOT_AVAILABLE = -7, CL_MEM_COPY_OVERLAP = -8,
    CL_BUILD_PROGRAM_FAILURE = -11, CL_MAP_FAILURE = -12, CL_MISALIGNED_SUB_BUFFER_OFFSET = -13,
    CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST = -14, CL_COMPILE_PROGRAM_FAILURE = -15,
    CL_LINKER_NOT_AVAILABLE = -16, CL_LINK_PROGRAM_FAILURE = -17, CL_KERNEL_ARG_INFO_NOT_AVAILABLE = -19,
    CL_INVALID_VALUE = -30, CL_INVALID_DEVICE_TYPE = -31, CL_INVALID_PLATFORM = -32, CL_INVALID_DEVICE = -33,
    CL_INVALID_CONTEXT = -34, CL_INVALID_QUEUE_PROPERTIES = -35, CL_INVALID_COMMAND_QUEUE = -36,
    CL_INVALID_HOST_PTR = -37, CL_INVALID_MEM_OBJECT = -38, CL_INVALID_BINARY = -42,
    CL_INVALID_BUILD_OPTIONS = -43, CL_INVALID_PROGRAM = -44, CL_INVALID_PROGRAM_EXECUTABLE = -45,
    CL_INVALID_KERNEL_NAME = -46, CL_INVALID_KERNEL_DEFINITION = -47, CL_INVALID_KERNEL = -48,
    CL_INVALID_ARG_INDEX = -49, CL_INVALID_ARG_VALUE = -50, CL_INVALID_ARG_SIZE = -51,
    CL_INVALID_KERNEL_ARGS = -52, CL_INVALID_WORK_DIMENSION = -53, CL_INVALID_WORK_GROUP_SIZE = -54,
    CL_INVALID_WORK_ITEM_SIZE = -55, CL_INVALID_GLOBAL_OFFSET = -56, CL_INVALID_EVENT_WAIT_LIST = -57,
    CL_INVALID_EVENT = -58, CL_INVALID_OPERATION = -59, CL_INVALID_BUFFER_SIZE = -61,
    CL_INVALID_GLOBAL_WORK_SIZE = -63, CL_INVALID_PROPERTY = -64, CL_INVALID_COMPILER_OPTIONS = -66,
    CL_INVALID_LINKER_OPTIONS = -67;
constexpr cl_uint CL_FALSE = 0, CL_MEM_OBJECT_BUFFER = 0x10F0,
    CL_MEM_READ_WRITE = 1 << 0, CL_MEM_WRITE_ONLY = 1 << 1, CL_MEM_READ_ONLY = 1 << 2,
    CL_MEM_USE_HOST_PTR = 1 << 3, CL_MEM_HOST_WRITE_ONLY = 1 << 7, CL_MEM_HOST_READ_ONLY = 1 << 8,
    CL_MEM_HOST_NO_ACCESS = 1 << 9,
    CL_DEVICE_TYPE_CPU = 1 << 1, CL_DEVICE_TYPE_GPU = 1 << 2, CL_QUEUE_PROFILING_ENABLE = 1 << 1;
// Arguments of functions that ignore them.
enum {
  CL_BUFFER_CREATE_TYPE_REGION, CL_CONTEXT_DEVICES, CL_DEVICE_DOUBLE_FP_CONFIG, CL_DEVICE_HOST_UNIFIED_MEMORY,
  CL_DEVICE_LOCAL_MEM_SIZE, CL_DEVICE_MAX_WORK_ITEM_SIZES, CL_DEVICE_MEM_BASE_ADDR_ALIGN,
  CL_DEVICE_PARENT_DEVICE, CL_DEVICE_VERSION, CL_EVENT_COMMAND_EXECUTION_STATUS, CL_EVENT_CONTEXT,
  CL_MEM_ASSOCIATED_MEMOBJECT, CL_MEM_CONTEXT, CL_MEM_FLAGS, CL_MEM_SIZE, CL_MEM_TYPE, CL_QUEUE_CONTEXT,
  CL_QUEUE_DEVICE, CL_QUEUE_PROPERTIES
};
// clang-format on

// There is no platform, so functions that return a code fail, and none makes an object.
constexpr cl_int kNoPlatform = -1001;  // CL_PLATFORM_NOT_FOUND_KHR
inline cl_int clReleaseEvent(cl_event) { return kNoPlatform; }
inline cl_int clReleaseMemObject(cl_mem) { return kNoPlatform; }
inline cl_int clRetainMemObject(cl_mem) { return kNoPlatform; }
inline cl_mem clCreateBuffer(cl_context, cl_mem_flags, std::size_t, void*, cl_int* code) {
  *code = kNoPlatform;
  return nullptr;
}
inline cl_mem clCreateSubBuffer(cl_mem, cl_mem_flags, int, const void*, cl_int* code) {
  *code = kNoPlatform;
  return nullptr;
}
inline cl_int clSetMemObjectDestructorCallback(cl_mem, void (*)(cl_mem, void*), void*) { return kNoPlatform; }
#define FLAUNAY_QUERY(name, Object) \
  inline cl_int name(Object, int, std::size_t, void*, std::size_t*) { return kNoPlatform; }
FLAUNAY_QUERY(clGetCommandQueueInfo, cl_command_queue)
FLAUNAY_QUERY(clGetContextInfo, cl_context)
FLAUNAY_QUERY(clGetDeviceInfo, cl_device_id)
FLAUNAY_QUERY(clGetEventInfo, cl_event)
FLAUNAY_QUERY(clGetMemObjectInfo, cl_mem)
#undef FLAUNAY_QUERY
