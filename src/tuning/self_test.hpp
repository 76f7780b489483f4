// The self test of a device's arithmetic; see kernels/call/self_test.cl.
#pragma once

#include <string>

#include "host/runtime.hpp"

namespace flaunay::tuning {

/// Runs the self test. Returns "" if exact predicates can rely on the device's arithmetic, otherwise the
/// check that failed. If nothing but fma is wrong, the runtime's kernels do without it from then on
/// (Capabilities::split_products).
std::string self_test_failure(host::Runtime& runtime);

/// Runs the self test. If the doubles of a device fail it, its kernels compute in fixed point from then on
/// (Capabilities::fixed_point), for which it is run again. Returns "" or the check that failed.
std::string make_exact(host::Runtime& runtime);

}  // namespace flaunay::tuning
