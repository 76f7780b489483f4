#include "host/error.hpp"

#include <fmt/format.h>

namespace flaunay::host {

std::string error_name(cl_int code) {
  // Boost.Compute describes the codes of OpenCL 1.x in words; the names of the constants are easier to search
  // for.
  switch (code) {
#define FLAUNAY_NAME(constant) \
  case constant:               \
    return #constant;
    FLAUNAY_NAME(CL_SUCCESS)
    FLAUNAY_NAME(CL_DEVICE_NOT_FOUND)
    FLAUNAY_NAME(CL_DEVICE_NOT_AVAILABLE)
    FLAUNAY_NAME(CL_COMPILER_NOT_AVAILABLE)
    FLAUNAY_NAME(CL_MEM_OBJECT_ALLOCATION_FAILURE)
    FLAUNAY_NAME(CL_OUT_OF_RESOURCES)
    FLAUNAY_NAME(CL_OUT_OF_HOST_MEMORY)
    FLAUNAY_NAME(CL_PROFILING_INFO_NOT_AVAILABLE)
    FLAUNAY_NAME(CL_MEM_COPY_OVERLAP)
    FLAUNAY_NAME(CL_BUILD_PROGRAM_FAILURE)
    FLAUNAY_NAME(CL_MAP_FAILURE)
    FLAUNAY_NAME(CL_MISALIGNED_SUB_BUFFER_OFFSET)
    FLAUNAY_NAME(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST)
    FLAUNAY_NAME(CL_COMPILE_PROGRAM_FAILURE)
    FLAUNAY_NAME(CL_LINKER_NOT_AVAILABLE)
    FLAUNAY_NAME(CL_LINK_PROGRAM_FAILURE)
    FLAUNAY_NAME(CL_KERNEL_ARG_INFO_NOT_AVAILABLE)
    FLAUNAY_NAME(CL_INVALID_VALUE)
    FLAUNAY_NAME(CL_INVALID_DEVICE_TYPE)
    FLAUNAY_NAME(CL_INVALID_PLATFORM)
    FLAUNAY_NAME(CL_INVALID_DEVICE)
    FLAUNAY_NAME(CL_INVALID_CONTEXT)
    FLAUNAY_NAME(CL_INVALID_QUEUE_PROPERTIES)
    FLAUNAY_NAME(CL_INVALID_COMMAND_QUEUE)
    FLAUNAY_NAME(CL_INVALID_HOST_PTR)
    FLAUNAY_NAME(CL_INVALID_MEM_OBJECT)
    FLAUNAY_NAME(CL_INVALID_BINARY)
    FLAUNAY_NAME(CL_INVALID_BUILD_OPTIONS)
    FLAUNAY_NAME(CL_INVALID_PROGRAM)
    FLAUNAY_NAME(CL_INVALID_PROGRAM_EXECUTABLE)
    FLAUNAY_NAME(CL_INVALID_KERNEL_NAME)
    FLAUNAY_NAME(CL_INVALID_KERNEL_DEFINITION)
    FLAUNAY_NAME(CL_INVALID_KERNEL)
    FLAUNAY_NAME(CL_INVALID_ARG_INDEX)
    FLAUNAY_NAME(CL_INVALID_ARG_VALUE)
    FLAUNAY_NAME(CL_INVALID_ARG_SIZE)
    FLAUNAY_NAME(CL_INVALID_KERNEL_ARGS)
    FLAUNAY_NAME(CL_INVALID_WORK_DIMENSION)
    FLAUNAY_NAME(CL_INVALID_WORK_GROUP_SIZE)
    FLAUNAY_NAME(CL_INVALID_WORK_ITEM_SIZE)
    FLAUNAY_NAME(CL_INVALID_GLOBAL_OFFSET)
    FLAUNAY_NAME(CL_INVALID_EVENT_WAIT_LIST)
    FLAUNAY_NAME(CL_INVALID_EVENT)
    FLAUNAY_NAME(CL_INVALID_OPERATION)
    FLAUNAY_NAME(CL_INVALID_BUFFER_SIZE)
    FLAUNAY_NAME(CL_INVALID_GLOBAL_WORK_SIZE)
    FLAUNAY_NAME(CL_INVALID_PROPERTY)
    FLAUNAY_NAME(CL_INVALID_COMPILER_OPTIONS)
    FLAUNAY_NAME(CL_INVALID_LINKER_OPTIONS)
#undef FLAUNAY_NAME
    case -1001:
      return "CL_PLATFORM_NOT_FOUND_KHR";
    default:
      return fmt::format("unknown OpenCL error {}", code);
  }
}

std::string error_advice(cl_int code) {
  switch (code) {
    case CL_MEM_OBJECT_ALLOCATION_FAILURE:
    case CL_OUT_OF_RESOURCES:
      return "the device is out of memory or resources: use fewer points, or another device (FLAUNAY_DEVICE)";
    case CL_INVALID_BUFFER_SIZE:
      return "an array is more than the device allows in one piece (CL_DEVICE_MAX_MEM_ALLOC_SIZE): use fewer "
             "points or queries, or another device (FLAUNAY_DEVICE)";
    case CL_OUT_OF_HOST_MEMORY:
      return "the host is out of memory: use fewer points";
    case CL_BUILD_PROGRAM_FAILURE:
    case CL_COMPILER_NOT_AVAILABLE:
      return "the driver could not compile the kernels, perhaps because memory or disk space lacks; if its "
             "words below do not tell, update it, or use another device (FLAUNAY_DEVICE)";
    case CL_INVALID_WORK_GROUP_SIZE:
      return "the device takes no work-group of this kernel: update its driver, or use another device "
             "(FLAUNAY_DEVICE)";
    case CL_DEVICE_NOT_AVAILABLE:
      return "the device is taken or gone: use another (FLAUNAY_DEVICE)";
    case -1001:
      return "install an OpenCL driver; on Debian: apt-get install pocl-opencl-icd";
    default:
      return "";
  }
}

void check_call(cl_int code, const char* call, const std::string& kernel) {
  if (code == CL_SUCCESS) return;
  std::string message = fmt::format("{} ({}) from {}", error_name(code), code, call);
  if (!kernel.empty()) message += fmt::format(", kernel {}", kernel);
  if (const std::string advice = error_advice(code); !advice.empty()) message += "; " + advice;
  const std::string text = call;
  throw DeviceError(message, code, text.substr(0, text.find('(')));
}

}  // namespace flaunay::host
