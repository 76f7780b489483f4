// Insertion of segments as the library has it, natively.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "constrained/insertion/insert.hpp"
#include "host/runtime.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::testing {

inline constrained::Result insert(const std::vector<double>& points, const std::vector<std::size_t>& offsets,
                                  Triangulation delaunay, const std::vector<std::int32_t>& segments) {
  static host::Runtime runtime(native_tuning());
  return constrained::constrain(runtime, points.data(), offsets, delaunay, segments);
}

}  // namespace flaunay::testing
