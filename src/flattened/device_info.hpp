// What the library says of a device.
#pragma once

#include <boost/compute/device.hpp>

#include "flaunay/flaunay.hpp"

namespace flaunay::flattened {

/// All but the self test's result.
DeviceInfo describe(const boost::compute::device& device);

}  // namespace flaunay::flattened
