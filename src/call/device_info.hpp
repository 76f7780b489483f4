// The description of a device.
#pragma once

#include <boost/compute/device.hpp>
#include <cstddef>

#include "flaunay/flaunay.hpp"
#include "host/system_memory.hpp"

namespace flaunay::call {

/// Describes a device, without the result of the self test.
DeviceInfo describe(const boost::compute::device& device);

/// The memory that calls on the device can use now, and what limits it. Of a device that shares the host's
/// memory it is at most what the system leaves to this process. held: bytes that the caller has allocated
/// already.
host::MemoryLeft usable_memory(const boost::compute::device& device, std::size_t held = 0);

}  // namespace flaunay::call
