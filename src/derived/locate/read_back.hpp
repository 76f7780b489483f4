// Triangulations that are read back from locators.
#pragma once

#include "derived/locate/locator.hpp"

namespace flaunay::locate {

/// Brings the mesh of a locator in fixed point to the arena of another runtime. Points that are neither
/// corners nor on the hull, which are equal to others, are taken for the first vertex of their set's hull:
/// answers do not depend on them. Waits 6 times. O(n).
points::DeviceMesh read_back(host::Runtime& from, const Locator& locator, host::Runtime& to);

}  // namespace flaunay::locate
