// A triangulation of one or more sets in device memory.
#pragma once

#include <cstddef>
#include <vector>

#include "host/runtime.hpp"

namespace flaunay::points {

using host::Arena;
using host::Buffer;

/// Offsets or sizes, as kernels have them.
inline std::vector<cl_int> integers(const std::vector<std::size_t>& values) {
  return {values.begin(), values.end()};
}

/// The result of mode blocks, from which Voronoi diagrams and locators are made. Unwanted arrays have no
/// memory.
struct DeviceMesh {
  std::vector<std::size_t> point_offsets, triangle_offsets, hull_offsets;  ///< sets + 1
  Buffer<cl_double> coordinates{};  ///< 2 per input point, as the caller gave them; aligned to 8 bytes only
  /// The arrays of flaunay::Triangulation.
  Buffer<cl_int> triangles{}, neighbors{}, halfedges{}, hull{}, representatives{};

  std::size_t sets() const { return point_offsets.size() - 1; }
  std::size_t points() const { return point_offsets.back(); }
  std::size_t triangle_count() const { return triangle_offsets.back(); }
};

}  // namespace flaunay::points
