// Gradients at the points, given or estimated.
#pragma once

#include "derived/interpolate/interpolate.hpp"

namespace flaunay::interpolate {

/// Returns the gradients by vertex, in the units of the locator's points, allocated in the runtime's arena in
/// the caller's scope. Does not wait. Estimating takes O(n columns) per iteration; a vertex takes as many
/// steps in a row as it has neighbours. Temporary memory: 90 bytes per point, and 32 per number.
Buffer<cl_double2> at_vertices_of(host::Runtime& runtime, const Locator& locator, const Table& table,
                                  const Gradients& gradients);

/// The number of iterations that reach a tolerance.
std::size_t iterations_for(double tolerance);

}  // namespace flaunay::interpolate
