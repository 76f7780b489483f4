// The description of a device.
#pragma once

#include <boost/compute/device.hpp>
#include <cstddef>

#include "flaunay/flaunay.hpp"
#include "host/memory/system_memory.hpp"
#include "host/runtime.hpp"

namespace flaunay::call {

/// Describes a device, without the result of the self test.
DeviceInfo describe(const boost::compute::device& device);
/// Describes the device of a runtime that has passed the self test, or the host if kernels run natively.
DeviceInfo describe(const host::Runtime& runtime);

/// The memory that calls on the device can use now, and what limits it. Of a device that shares the host's
/// memory it is at most what the system leaves to this process. held: bytes that the caller has allocated
/// already.
host::MemoryLeft usable_memory(const boost::compute::device& device, std::size_t held = 0);
/// The memory for calls of a runtime, which may be on the host.
host::MemoryLeft usable_memory(const host::Runtime& runtime, std::size_t held);

}  // namespace flaunay::call
