// Calls of the library with which devices are tested, on small inputs that have every kind of degeneracy.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "app/conformance/arrays.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::conformance {

struct Call {
  std::string name;
  /// Makes the call on the triangulator's device, and adds its results. n: the approximate number of points.
  std::function<void(Triangulator& triangulator, std::size_t n, Arrays& results)> make;
};

/// All of them.
const std::vector<Call>& calls();

}  // namespace flaunay::conformance
