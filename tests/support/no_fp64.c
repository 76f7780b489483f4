/* To be preloaded: devices say that they have no double precision. */
#define _GNU_SOURCE
#include <CL/cl.h>
#include <dlfcn.h>
#include <string.h>

typedef cl_int(CL_API_CALL* device_query)(cl_device_id, cl_device_info, size_t, void*, size_t*);

cl_int CL_API_CALL clGetDeviceInfo(cl_device_id device, cl_device_info name, size_t size, void* value,
                                   size_t* size_needed) {
  /* A program that loads OpenCL as it runs has it behind nothing. */
  static void* loader = NULL;
  if (loader == NULL) loader = dlopen("libOpenCL.so.1", RTLD_LAZY);
  /* ISO C has no cast from what dlsym returns to a function. */
  void* found = dlsym(loader, "clGetDeviceInfo");
  device_query query = NULL;
  memcpy(&query, &found, sizeof query);
  const cl_int code = query(device, name, size, value, size_needed);
  if (code == CL_SUCCESS && name == CL_DEVICE_DOUBLE_FP_CONFIG && value != NULL) memset(value, 0, size);
  return code;
}
