// Gradients at the points.
#pragma once

#include <cmath>

#include "derived/interpolate/interpolate.hpp"
#include "geometry/arguments.hpp"

namespace flaunay::interpolate {

/// Estimates the gradients by vertex, in the units of the locator's points, allocated in the runtime's arena
/// in the caller's scope. Does not wait. O(n columns) per iteration; a vertex takes as many steps in a row as
/// it has neighbours. Temporary memory: 90 bytes per point, and 32 per number.
Buffer<cl_double2> estimate(host::Runtime& runtime, const Locator& locator, const Table& table,
                            const Gradients& wanted);

/// Powers of two, per set, between the caller's units and the units of the locator's points. sign: 1 for
/// slopes in the caller's units, -1 for the other way, 0 for ones.
Buffer<kernel::scaling> slope_scales(host::Runtime& runtime, const Locator& locator, int sign);

/// Throws Error(usage) for a tolerance that is not a number.
inline void check(const GradientOptions& options) {
  expect(!std::isnan(options.tolerance), "the tolerance of gradients is not a number");
}

/// The number of iterations that reach a tolerance.
std::size_t iterations_for(double tolerance);

/// The eigenvalues of the system for gradients lie in [1 - kRadius, 1 + kRadius].
constexpr double kRadius = 0.5;

/// Calls step(is_first, factor) for all iterations but the one that starts: the next approximation is nearer
/// by this factor to what is locally best than the one before the last, which at the first step is 0.
template <typename Step>
void improve(std::size_t iterations, const Step& step) {
  double factor = 1 / (1 - kRadius * kRadius / 2);
  for (std::size_t i = 1; i < iterations; ++i) {
    step(i == 1, factor);
    factor = 1 / (1 - factor * kRadius * kRadius / 4);
  }
}

}  // namespace flaunay::interpolate
