// Finding and describing OpenCL devices.
#pragma once

#include <boost/compute/device.hpp>
#include <optional>
#include <string>
#include <vector>

// In a build without OpenCL, such functions always throw, and the compiler leaves out the code after a call.
#ifdef FLAUNAY_WITHOUT_OPENCL
#define NEEDS_OPENCL [[noreturn]]
#else
#define NEEDS_OPENCL
#endif

namespace flaunay::host {

/// Whether this build can use OpenCL.
#ifdef FLAUNAY_WITHOUT_OPENCL
constexpr bool kCanUseOpenCl = false;
#else
constexpr bool kCanUseOpenCl = true;
#endif

/// Lists every device of every platform, platforms in the loader's order. Throws DeviceError, which says what
/// to install, if there is no platform.
NEEDS_OPENCL std::vector<boost::compute::device> all_devices();

/// The name that stands for the host itself, without OpenCL.
constexpr const char* kHostName = "host";

/// The name of a device as given, or, if that is empty, as the environment variable FLAUNAY_DEVICE says;
/// empty if neither names one.
std::string wanted_device(const std::string& given);

/// Finds the first GPU with fp64, otherwise the first GPU. Returns nothing if no GPU or no OpenCL is found.
std::optional<boost::compute::device> find_gpu();

/// Whether this system may have a GPU, as far as its device files in `folder` tell. Loading OpenCL to look
/// for one takes longer than triangulating ten thousand points. Always true if the environment chooses
/// OpenCL's drivers (OCL_ICD_VENDORS, OCL_ICD_FILENAMES, OPENCL_VENDOR_PATH).
bool may_have_gpu(const std::string& folder = "/dev");

/// The first GPU with fp64, else the first GPU, else the first device with fp64, else the first one. Throws
/// DeviceError if no device is found.
NEEDS_OPENCL boost::compute::device best_device();

/// Finds a device. wanted: "" (the environment variable FLAUNAY_DEVICE if set, else that of best_device),
/// "#k" (the k-th of all_devices), or a part of a device's or platform's name in upper or lower case. Throws
/// DeviceError, which lists the devices, if none matches.
NEEDS_OPENCL boost::compute::device find_device(const std::string& wanted);

bool has_fp64(const boost::compute::device& device);

/// Whether the memory of the device is that of the host: a CPU, or a GPU without memory of its own.
bool shares_host_memory(const boost::compute::device& device);

}  // namespace flaunay::host

#undef NEEDS_OPENCL
