// What the calls on device memory share.
#pragma once

#include "bindings.hpp"

namespace flaunay::python {

/// A triangulation in device memory, with the triangulator that made it.
struct DeviceResult {
  std::shared_ptr<SharedTriangulator> triangulator;
  DeviceTriangulation triangulation;
};

/// The event is the caller's to release.
Enqueue to_enqueue(std::uintptr_t queue, const std::vector<std::uintptr_t>& wait_for, cl_event* event);

}  // namespace flaunay::python
