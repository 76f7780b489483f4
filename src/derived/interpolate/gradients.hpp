// Gradients at the points.
#pragma once

#include "derived/interpolate/interpolate.hpp"

namespace flaunay::interpolate {

/// Estimates the gradients by vertex, in the units of the locator's points, allocated in the runtime's arena
/// in the caller's scope. Does not wait. O(n columns) per iteration; a vertex takes as many steps in a row as
/// it has neighbours. Temporary memory: 90 bytes per point, and 32 per number.
Buffer<cl_double2> estimate(host::Runtime& runtime, const Locator& locator, const Table& table,
                            const Gradients& wanted);

/// Powers of two, per set, between the caller's units and the units of the locator's points. sign: 1 for
/// slopes in the caller's units, -1 for the other way, 0 for ones.
Buffer<kernel::scaling> slope_scales(host::Runtime& runtime, const Locator& locator, int sign);

/// The number of iterations that reach a tolerance.
std::size_t iterations_for(double tolerance);

}  // namespace flaunay::interpolate
