// Finding and describing OpenCL devices.
#pragma once

#include <boost/compute/device.hpp>
#include <string>
#include <vector>

namespace flaunay::host {

/// Lists every device of every platform, platforms in the loader's order. Throws DeviceError, which says what
/// to install, if there is no platform.
std::vector<boost::compute::device> all_devices();

/// Finds a device. wanted: "" (the environment variable FLAUNAY_DEVICE if set, else the first GPU with fp64,
/// else the first device with fp64), "#k" (the k-th of all_devices), or a part of a device's or platform's
/// name in upper or lower case. Throws DeviceError, which lists the devices, if none matches.
boost::compute::device find_device(const std::string& wanted);

bool has_fp64(const boost::compute::device& device);

/// Whether the memory of the device is that of the host: a CPU, or a GPU without memory of its own.
bool shares_host_memory(const boost::compute::device& device);

}  // namespace flaunay::host
