// The OpenCL functions that flaunay calls. They load the ICD loader, libOpenCL, when they are first called
// and pass the call on. So programs start without it and can run on machines that have no OpenCL, where no
// platform is found. If drivers are installed without the loader, calls go where it would pass them on.
#include "host/opencl/loader.hpp"

#include <CL/cl.h>
#include <CL/cl_icd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <string>
#include <system_error>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/system/library.hpp"

namespace {

template <typename Function>
struct Signature;
template <typename R, typename... P>
struct Signature<R(P...)> {
  using Result = R;
  template <std::size_t k>
  using Parameter = std::tuple_element_t<k, std::tuple<P...>>;
};

// The result of a function if there is no OpenCL.
template <typename Result>
Result missing() {
  if constexpr (std::is_same_v<Result, cl_int>) return -1001;  // CL_PLATFORM_NOT_FOUND_KHR
  if constexpr (!std::is_same_v<Result, cl_int>) return nullptr;
}

namespace fs = std::filesystem;
namespace system = flaunay::system;

// A library that was loaded before comes first: it may have been put there to watch the calls.
template <typename Function>
Function* find(const char* name) {
  static void* const library = system::open_opencl();
  system::AnyFunction* found = system::find_among_loaded(name);
  if (found == nullptr && library != nullptr) found = system::find_function(library, name);
  return reinterpret_cast<Function*>(found);
}

// The driver's functions for an object, which every object of OpenCL has in its first word (cl_khr_icd); null
// for no object.
template <typename Object>
const cl_icd_dispatch* functions_of(Object* object) {
  return object != nullptr ? *reinterpret_cast<const cl_icd_dispatch* const*>(object) : nullptr;
}

// Where the arguments of a function have such an object.
template <typename Object, typename... Others>
const cl_icd_dispatch* functions_for(Object* object, Others...) {
  return functions_of(object);
}
const cl_icd_dispatch* functions_for(cl_uint count, const cl_event* events) {
  return count > 0 && events != nullptr ? functions_of(*events) : nullptr;
}
template <typename... Others>
const cl_icd_dispatch* functions_for(const cl_context_properties*, cl_uint count, const cl_device_id* devices,
                                     Others...) {
  return count > 0 && devices != nullptr ? functions_of(*devices) : nullptr;
}

using Platforms = std::vector<cl_platform_id>;

// The platforms of a driver; none if it cannot be loaded or is not a driver.
Platforms platforms_of(const std::string& driver) {
  using Find = void*(CL_API_CALL*)(const char*);
  void* const library = system::open_library(driver);
  if (library == nullptr) return {};
  const auto find_extension =
      reinterpret_cast<Find>(system::find_function(library, "clGetExtensionFunctionAddress"));
  if (find_extension == nullptr) return {};
  const auto list = reinterpret_cast<decltype(&clGetPlatformIDs)>(find_extension("clIcdGetPlatformIDsKHR"));
  cl_uint count = 0;
  if (list == nullptr || list(0, nullptr, &count) != CL_SUCCESS) return {};
  Platforms found(count);
  return list(count, found.data(), nullptr) == CL_SUCCESS ? found : Platforms();
}

Platforms installed_platforms() {
  if (const auto list = find<decltype(clGetPlatformIDs)>("clGetPlatformIDs")) {
    cl_uint count = 0;
    if (list(0, nullptr, &count) != CL_SUCCESS) return {};
    Platforms found(count);
    return list(count, found.data(), nullptr) == CL_SUCCESS ? found : Platforms();
  }
  Platforms all;
  for (const std::string& driver : flaunay::host::installed_drivers()) {
    const Platforms found = platforms_of(driver);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

std::string name_of(cl_platform_id platform) {
  std::size_t bytes = 0;
  const auto* const functions = functions_of(platform);
  if (functions->clGetPlatformInfo(platform, CL_PLATFORM_NAME, 0, nullptr, &bytes) != CL_SUCCESS) return "";
  std::string name(bytes, '\0');
  functions->clGetPlatformInfo(platform, CL_PLATFORM_NAME, bytes, name.data(), nullptr);
  return name.c_str();
}

struct AddedDriver {
  std::string platform, path;
  bool is_loaded = false;
  Platforms platforms;
};

std::mutex added_mutex;
std::vector<AddedDriver>& added_drivers() {
  // Never destroyed, since destructors of other objects may call OpenCL.
  static auto& drivers = *new std::vector<AddedDriver>();
  return drivers;
}

Platforms all_platforms() {
  Platforms all = installed_platforms();
  const std::lock_guard lock(added_mutex);
  for (AddedDriver& driver : added_drivers()) {
    const auto is_it = [&](cl_platform_id platform) { return name_of(platform) == driver.platform; };
    if (std::any_of(all.begin(), all.end(), is_it)) continue;
    if (!std::exchange(driver.is_loaded, true)) driver.platforms = platforms_of(driver.path);
    all.insert(all.end(), driver.platforms.begin(), driver.platforms.end());
  }
  return all;
}

}  // namespace

namespace flaunay::host {

std::vector<std::string> installed_drivers() {
  const char* given = std::getenv("OCL_ICD_VENDORS");
  if (given == nullptr) given = std::getenv("OPENCL_VENDOR_PATH");
  const fs::path place = given != nullptr ? given : "/etc/OpenCL/vendors";
  std::vector<fs::path> files;
  std::error_code error;
  if (fs::is_directory(place, error)) {
    for (fs::directory_iterator entry(place, error), end; !error && entry != end; entry.increment(error)) {
      files.push_back(entry->path());
    }
  } else {
    files.push_back(place);
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> drivers;
  for (const fs::path& file : files) {
    std::string driver;
    if (file.extension() == ".icd" && std::getline(std::ifstream(file), driver)) drivers.push_back(driver);
  }
  return drivers;
}

void add_driver(const std::string& platform, const std::string& path) {
  const std::lock_guard lock(added_mutex);
  for (const AddedDriver& driver : added_drivers()) {
    if (driver.path == path) return;
  }
  added_drivers().push_back({platform, path, false, {}});
}

}  // namespace flaunay::host

#define RESULT(name) Signature<decltype(name)>::Result CL_API_CALL
#define PARAMETER(name, k) Signature<decltype(name)>::Parameter<k> p##k
#define PASS_ON(name, ...)                                               \
  {                                                                      \
    static auto* const function = find<decltype(name)>(#name);           \
    if (function != nullptr) return function(__VA_ARGS__);               \
    const cl_icd_dispatch* const functions = functions_for(__VA_ARGS__); \
    if (functions != nullptr) return functions->name(__VA_ARGS__);       \
    return missing<Signature<decltype(name)>::Result>();                 \
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

// Forwarding functions, by the number of parameters.
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

cl_int CL_API_CALL clGetPlatformIDs(cl_uint capacity, cl_platform_id* places, cl_uint* count) {
  try {
    const Platforms all = all_platforms();
    if (count != nullptr) *count = static_cast<cl_uint>(all.size());
    if (places != nullptr) std::copy_n(all.begin(), std::min<std::size_t>(capacity, all.size()), places);
    return all.empty() ? -1001 : CL_SUCCESS;  // CL_PLATFORM_NOT_FOUND_KHR
  } catch (...) {
    return CL_OUT_OF_HOST_MEMORY;
  }
}
}
