// Mode blocks for points and results in device memory.
#pragma once

#include "call/engine.hpp"
#include "flaunay/device_memory.hpp"

namespace flaunay::call {

/// Implements Triangulator::triangulate for device memory.
void triangulate(Engine& self, const DevicePoints& points, DeviceTriangulation& result, const Parts& parts,
                 const Enqueue& enqueue);

}  // namespace flaunay::call
