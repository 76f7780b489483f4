// The self test of a device's arithmetic; see kernels/call/self_test.cl.
#pragma once

#include <string>

#include "host/runtime.hpp"

namespace flaunay::call {

/// Runs the self test. Returns "" if exact predicates can rely on the device's arithmetic, otherwise what
/// failed. If nothing but fma is wrong, the runtime's kernels do without it from then on
/// (Tuning::split_products).
std::string self_test_failure(host::Runtime& runtime);

}  // namespace flaunay::call
