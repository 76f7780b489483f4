// The magnitudes of points in device memory.
#pragma once

#include "geometry/magnitudes.hpp"
#include "host/runtime.hpp"

namespace flaunay::points {

using namespace geometry;

/// Finds the magnitudes of n points, x0 y0 x1 y1 ... Waits once. Temporary memory: 12 bytes. O(n).
Magnitudes inspect(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n);

/// Finds the magnitudes and leaves them on the device, for kernels to read, in an array of the runtime's
/// arena. Does not wait. O(n).
host::Buffer<cl_int> inspect_later(host::Runtime& runtime, const host::Buffer<cl_double>& points,
                                   std::size_t n);

/// Chooses the scaling of points with these magnitudes. Throws Error(input), which names a point, if one is
/// not finite or if magnitudes differ too much; points are copied to the host only in that case.
Scaling scaling_for(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n,
                    const Magnitudes& magnitudes);

/// Converts n points from `first` on to double precision, which is exact. narrow: x0 y0 x1 y1 ... Does not
/// wait. O(n).
void widen(host::Runtime& runtime, const host::Buffer<cl_float>& narrow, std::size_t first, std::size_t n,
           const host::Buffer<cl_double>& wide);

}  // namespace flaunay::points
