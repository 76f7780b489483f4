// Mode blocks for points and results in device memory.
#pragma once

#include "call/implementation.hpp"
#include "flaunay/device_memory.hpp"

namespace flaunay::call {

/// Implements Triangulator::triangulate for device memory. What the device cannot compute in fixed point is
/// computed with its doubles, or if it has none, on the host.
void triangulate(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                 const Parts& parts, const Enqueue& enqueue);
/// The same, by this engine alone, which throws geometry::TooWideForFixedPoint for what it cannot compute in
/// fixed point.
void triangulate_on(Engine& engine, const DevicePoints& points, DeviceTriangulation& result,
                    const Parts& parts, const Enqueue& enqueue);

}  // namespace flaunay::call
