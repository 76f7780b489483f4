#include "host/opencl/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/compute/platform.hpp>
#include <cctype>
#include <cerrno>
#include <cstdlib>

#ifdef __linux__
#include <unistd.h>
#endif

#include "host/error.hpp"
#include "host/memory/system_memory.hpp"
#include "host/opencl/pocl.hpp"

namespace flaunay::host {
namespace {

// Files that drivers of GPUs make in /dev: Linux's own drivers, AMD's, NVIDIA's (on desktops and on boards),
// the driver of Linux in Windows, ARM's, Qualcomm's, Imagination's and Vivante's.
constexpr const char* kGpuFiles[] = {"dri", "kfd",   "nvidiactl", "nvidia-caps", "nvhost-gpu", "nvgpu",
                                     "dxg", "mali0", "kgsl-3d0",  "pvrsrvkm",    "pvr_sync",   "galcore"};

}  // namespace

bool has_fp64(const boost::compute::device& device) {
  // Before OpenCL 1.2, devices without fp64 may answer CL_INVALID_VALUE.
  cl_device_fp_config config = 0;
  return clGetDeviceInfo(device.id(), CL_DEVICE_DOUBLE_FP_CONFIG, sizeof config, &config, nullptr) ==
             CL_SUCCESS &&
         config != 0;
}

bool shares_host_memory(const boost::compute::device& device) {
  return (device.type() & CL_DEVICE_TYPE_CPU) != 0 ||
         device.get_info<cl_bool>(CL_DEVICE_HOST_UNIFIED_MEMORY) != CL_FALSE;
}

std::string wanted_device(const std::string& given) {
  const char* const environment = std::getenv("FLAUNAY_DEVICE");
  return given.empty() && environment != nullptr ? environment : given;
}

bool may_have_gpu([[maybe_unused]] const std::string& folder) {
#ifdef __linux__
  for (const char* const drivers : {"OCL_ICD_VENDORS", "OCL_ICD_FILENAMES", "OPENCL_VENDOR_PATH"}) {
    if (std::getenv(drivers) != nullptr) return true;
  }
  for (const char* const file : kGpuFiles) {
    const bool is_missing =
        ::access((folder + "/" + file).c_str(), F_OK) != 0 && (errno == ENOENT || errno == ENOTDIR);
    if (!is_missing) return true;
  }
  return false;
#else
  return true;
#endif
}

#ifdef FLAUNAY_WITHOUT_OPENCL
std::vector<boost::compute::device> all_devices() {
  throw DeviceError("this build of flaunay does not use OpenCL devices");
}
std::optional<boost::compute::device> find_gpu() { return {}; }
boost::compute::device best_device() { all_devices(); }
boost::compute::device find_device(const std::string& /*requested*/) { all_devices(); }
#else
namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string listing(const std::vector<boost::compute::device>& devices) {
  std::string text;
  for (std::size_t k = 0; k < devices.size(); ++k) {
    text += fmt::format("{}#{} {} ({})", k ? ", " : "", k, devices[k].name(), devices[k].platform().name());
  }
  return text;
}

bool is_gpu(const boost::compute::device& device) { return (device.type() & CL_DEVICE_TYPE_GPU) != 0; }

// The first of the best devices: GPUs are better than others, and of both those with fp64 are.
const boost::compute::device& preferred(const std::vector<boost::compute::device>& devices) {
  const auto rank = [](const auto& device) { return 2 * is_gpu(device) + has_fp64(device); };
  return *std::max_element(devices.begin(), devices.end(),
                           [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

// The loader skips a driver that does not fit into the address space, without a word.
std::string hint_of_address_space() {
  constexpr std::size_t kSpaceForDriver = 1024 * kMebibyte;
  const MemoryLeft left = address_space_left();
  if (left.bytes >= kSpaceForDriver) return "";
  return fmt::format(". A driver may not have been loaded because {} leaves only {}: raise it", left.limit,
                     mebibytes(left.bytes));
}

}  // namespace

std::vector<boost::compute::device> all_devices() {
  require_space_to_load_pocl();
  cl_uint platform_count = 0;
  const cl_int code = clGetPlatformIDs(0, nullptr, &platform_count);
  if (code != CL_SUCCESS || platform_count == 0) {
    throw DeviceError(
        std::string(
            "no OpenCL platform found: install a driver. On Debian, for the CPU: apt-get install "
            "pocl-opencl-icd; "
            "for a GPU: its vendor's OpenCL driver (nvidia-opencl-icd, rocm-opencl-icd, intel-opencl-icd). "
            "If one is installed, see that /etc/OpenCL/vendors (or OCL_ICD_VENDORS) names it") +
            hint_of_address_space(),
        code == CL_SUCCESS ? -1001 : code, "clGetPlatformIDs");
  }
  std::vector<cl_platform_id> platforms(platform_count);
  FLAUNAY_CL(clGetPlatformIDs(platform_count, platforms.data(), nullptr));
  std::vector<boost::compute::device> devices;
  for (const cl_platform_id platform : platforms) {
    const bool needs_folder = is_pocl(platform);
    if (needs_folder) require_space_for_pocl();
    cl_uint device_count = 0;
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &device_count) != CL_SUCCESS) {
      // PoCL has no device if it cannot make its folder, and does not say why.
      if (needs_folder) require_pocl_folder();
      continue;
    }
    std::vector<cl_device_id> ids(device_count);
    FLAUNAY_CL(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, device_count, ids.data(), nullptr));
    for (const cl_device_id id : ids) devices.emplace_back(id);
  }
  return devices;
}

static std::vector<boost::compute::device> some_devices() {
  std::vector<boost::compute::device> devices = all_devices();
  if (devices.empty()) {
    throw DeviceError("OpenCL platforms are installed, but none has a device; see clinfo");
  }
  return devices;
}

std::optional<boost::compute::device> find_gpu() {
  if (!may_have_gpu()) return {};
  try {
    const std::vector<boost::compute::device> devices = all_devices();
    if (devices.empty()) return {};
    const auto& device = preferred(devices);
    if (is_gpu(device)) return device;
  } catch (const DeviceError&) {
    // No OpenCL.
  }
  return {};
}

boost::compute::device best_device() { return preferred(some_devices()); }

boost::compute::device find_device(const std::string& requested) {
  const std::vector<boost::compute::device> devices = some_devices();
  const std::string wanted = wanted_device(requested);
  const std::string origin = requested.empty() ? " (FLAUNAY_DEVICE)" : "";
  if (wanted.empty()) return preferred(devices);
  if (wanted[0] == '#') {
    std::size_t index = 0;
    for (const char c : wanted.substr(1)) {
      if (!std::isdigit(static_cast<unsigned char>(c)) || index > devices.size())
        index = devices.size();
      else
        index = 10 * index + static_cast<std::size_t>(c - '0');
    }
    if (wanted.size() > 1 && index < devices.size()) return devices[index];
  } else {
    for (const auto& device : devices) {
      if (lower_case(device.name()).find(lower_case(wanted)) != std::string::npos ||
          lower_case(device.platform().name()).find(lower_case(wanted)) != std::string::npos) {
        return device;
      }
    }
  }
  throw DeviceError(fmt::format("no device matches '{}'{}; there are: {}", wanted, origin, listing(devices)));
}

#endif

}  // namespace flaunay::host
