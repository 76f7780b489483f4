// The magnitudes of points in device memory.
#pragma once

#include "host/runtime.hpp"
#include "input/magnitudes.hpp"

namespace flaunay {

/// Of n points, x0 y0 x1 y1... Waits once. Temporary: 12 bytes. O(n).
Magnitudes inspect(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n);

/// How to scale points of these magnitudes. Throws Error(input), naming the point, if one is not finite or if
/// magnitudes differ too much; only then do points come to the host.
Scaling scaling_for(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n,
                    const Magnitudes& magnitudes);

}  // namespace flaunay
