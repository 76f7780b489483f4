// The description of a device.
#pragma once

#include <boost/compute/device.hpp>

#include "flaunay/flaunay.hpp"

namespace flaunay::call {

/// Describes a device, without the result of the self test.
DeviceInfo describe(const boost::compute::device& device);

}  // namespace flaunay::call
