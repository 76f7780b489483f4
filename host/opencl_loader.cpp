// The OpenCL functions that flaunay calls. They load the ICD loader, libOpenCL, when they are first called
// and pass the call on. So programs start without it and can run on machines that have no OpenCL, where no
// platform is found.
#include <CL/cl.h>
#include <dlfcn.h>

#include <tuple>
#include <type_traits>

namespace {

template <typename Function>
struct Signature;
template <typename R, typename... P>
struct Signature<R(P...)> {
  using Result = R;
  template <std::size_t k>
  using Parameter = std::tuple_element_t<k, std::tuple<P...>>;
  // Stands in for a function that no library has. Nothing but clGetPlatformIDs can be called then, as
  // everything else needs a platform.
  static R missing(P...) {
    if constexpr (std::is_same_v<R, cl_int>) return -1001;  // CL_PLATFORM_NOT_FOUND_KHR
    if constexpr (!std::is_same_v<R, cl_int>) return nullptr;
  }
};

// A library that was loaded before comes first: it may have been put there to watch the calls.
template <typename Function>
Function* find(const char* name) {
  static void* const library = [] {
    void* const versioned = dlopen("libOpenCL.so.1", RTLD_LAZY | RTLD_GLOBAL);
    return versioned != nullptr ? versioned : dlopen("libOpenCL.so", RTLD_LAZY | RTLD_GLOBAL);
  }();
  void* found = dlsym(RTLD_DEFAULT, name);
  if (found == nullptr && library != nullptr) found = dlsym(library, name);
  return found != nullptr ? reinterpret_cast<Function*>(found) : &Signature<Function>::missing;
}

}  // namespace

#define RESULT(name) Signature<decltype(name)>::Result CL_API_CALL
#define PARAMETER(name, k) Signature<decltype(name)>::Parameter<k> p##k
#define PASS_ON(name, ...)                                     \
  {                                                            \
    static auto* const function = find<decltype(name)>(#name); \
    return function(__VA_ARGS__);                              \
  }
#define PARAMETERS_1(name) PARAMETER(name, 0)
#define PARAMETERS_2(name) PARAMETERS_1(name), PARAMETER(name, 1)
#define PARAMETERS_3(name) PARAMETERS_1(name), PARAMETER(name, 1), PARAMETER(name, 2)
#define PARAMETERS_4(name) PARAMETERS_3(name), PARAMETER(name, 3)
#define PARAMETERS_5(name) PARAMETERS_4(name), PARAMETER(name, 4)
#define PARAMETERS_6(name) PARAMETERS_5(name), PARAMETER(name, 5)
#define PARAMETERS_7(name) PARAMETERS_6(name), PARAMETER(name, 6)
#define PARAMETERS_9(name) PARAMETERS_7(name), PARAMETER(name, 7), PARAMETER(name, 8)
#define PARAMETERS_10(name) PARAMETERS_9(name), PARAMETER(name, 9)
#define FUNCTION_1(name) RESULT(name) name(PARAMETERS_1(name)) PASS_ON(name, p0)
#define FUNCTION_2(name) RESULT(name) name(PARAMETERS_2(name)) PASS_ON(name, p0, p1)
#define FUNCTION_3(name) RESULT(name) name(PARAMETERS_3(name)) PASS_ON(name, p0, p1, p2)
#define FUNCTION_4(name) RESULT(name) name(PARAMETERS_4(name)) PASS_ON(name, p0, p1, p2, p3)
#define FUNCTION_5(name) RESULT(name) name(PARAMETERS_5(name)) PASS_ON(name, p0, p1, p2, p3, p4)
#define FUNCTION_6(name) RESULT(name) name(PARAMETERS_6(name)) PASS_ON(name, p0, p1, p2, p3, p4, p5)
#define FUNCTION_7(name) RESULT(name) name(PARAMETERS_7(name)) PASS_ON(name, p0, p1, p2, p3, p4, p5, p6)
#define FUNCTION_9(name) \
  RESULT(name) name(PARAMETERS_9(name)) PASS_ON(name, p0, p1, p2, p3, p4, p5, p6, p7, p8)
#define FUNCTION_10(name) \
  RESULT(name) name(PARAMETERS_10(name)) PASS_ON(name, p0, p1, p2, p3, p4, p5, p6, p7, p8, p9)

// By the number of parameters.
extern "C" {
FUNCTION_1(clFinish)
FUNCTION_1(clFlush)
FUNCTION_1(clReleaseCommandQueue)
FUNCTION_1(clReleaseContext)
FUNCTION_1(clReleaseDevice)
FUNCTION_1(clReleaseEvent)
FUNCTION_1(clReleaseKernel)
FUNCTION_1(clReleaseMemObject)
FUNCTION_1(clReleaseProgram)
FUNCTION_1(clRetainCommandQueue)
FUNCTION_1(clRetainContext)
FUNCTION_1(clRetainDevice)
FUNCTION_1(clRetainEvent)
FUNCTION_1(clRetainKernel)
FUNCTION_1(clRetainMemObject)
FUNCTION_1(clRetainProgram)
FUNCTION_2(clWaitForEvents)
FUNCTION_3(clCreateKernel)
FUNCTION_3(clGetPlatformIDs)
FUNCTION_3(clSetMemObjectDestructorCallback)
FUNCTION_4(clCreateCommandQueue)
FUNCTION_4(clEnqueueBarrierWithWaitList)
FUNCTION_4(clEnqueueMarkerWithWaitList)
FUNCTION_4(clSetKernelArg)
FUNCTION_5(clCreateBuffer)
FUNCTION_5(clCreateProgramWithSource)
FUNCTION_5(clCreateSubBuffer)
FUNCTION_5(clGetCommandQueueInfo)
FUNCTION_5(clGetContextInfo)
FUNCTION_5(clGetDeviceIDs)
FUNCTION_5(clGetDeviceInfo)
FUNCTION_5(clGetEventInfo)
FUNCTION_5(clGetEventProfilingInfo)
FUNCTION_5(clGetKernelInfo)
FUNCTION_5(clGetMemObjectInfo)
FUNCTION_5(clGetPlatformInfo)
FUNCTION_5(clGetProgramInfo)
FUNCTION_6(clBuildProgram)
FUNCTION_6(clCreateContext)
FUNCTION_6(clEnqueueUnmapMemObject)
FUNCTION_6(clGetKernelWorkGroupInfo)
FUNCTION_6(clGetProgramBuildInfo)
FUNCTION_7(clCreateProgramWithBinary)
FUNCTION_9(clEnqueueCopyBuffer)
FUNCTION_9(clEnqueueFillBuffer)
FUNCTION_9(clEnqueueNDRangeKernel)
FUNCTION_9(clEnqueueReadBuffer)
FUNCTION_9(clEnqueueWriteBuffer)
FUNCTION_10(clEnqueueMapBuffer)
}
