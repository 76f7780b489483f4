// The start-up check of a device's arithmetic; see kernels/selftest.cl.
#pragma once

#include <string>

#include "host/runtime.hpp"

namespace flaunay::flattened {

/// Empty if the device's arithmetic is what exactness needs, else what failed.
std::string self_test_failure(host::Runtime& runtime);

}  // namespace flaunay::flattened
