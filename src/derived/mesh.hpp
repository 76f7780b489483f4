// What is derived from a triangulation works on this: a triangulation on the device, of one or more sets.
#pragma once

#include <cstddef>
#include <vector>

#include "host/runtime.hpp"

namespace flaunay::derived {

using host::Arena;
using host::Buffer;

struct Mesh {
  std::vector<std::size_t> point_offsets, triangle_offsets, hull_offsets;  ///< sets + 1
  Buffer<cl_double> coordinates{};  ///< 2 per input point, as given; aligned as elements only
  /// As in Triangulation.
  Buffer<cl_int> triangles{}, neighbors{}, hull{}, representatives{};

  std::size_t sets() const { return point_offsets.size() - 1; }
  std::size_t points() const { return point_offsets.back(); }
  std::size_t triangle_count() const { return triangle_offsets.back(); }
};

}  // namespace flaunay::derived
