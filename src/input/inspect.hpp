// The magnitudes of points in device memory.
#pragma once

#include "host/runtime.hpp"
#include "input/magnitudes.hpp"

namespace flaunay {

/// How to scale n points, x0 y0 x1 y1... Waits once. Throws Error(input), naming the point, if one is not
/// finite or if magnitudes differ too much; only then do points come to the host. Temporary: 12 bytes. O(n).
Scaling inspect(host::Runtime& runtime, const host::Buffer<cl_double>& input, std::size_t n);

}  // namespace flaunay
