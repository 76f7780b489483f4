// Points on a device as the kernels of predicates take them: scaled, or in fixed point.
#pragma once

#include <vector>

#include "points/inspect.hpp"
#include "tests/support/device.hpp"

namespace flaunay::testing {

struct ScaledPoints {
  host::Buffer<cl_double> coordinates;
  geometry::Bounds bounds;
};

/// Uploads one set of points, which must fit.
inline ScaledPoints upload_points(host::Runtime& runtime, const std::vector<double>& coordinates) {
  const std::size_t n = coordinates.size() / 2;
  const points::UniformPoints uniform = *points::make_uniform(runtime, upload(runtime, coordinates), {0, n});
  return {points::scaled(runtime, uniform.coordinates, n, uniform.scaling.shift), uniform.scaling.bounds};
}

}  // namespace flaunay::testing
