// The arrays of a triangulation as a table, one row per array. The C interface loops over it, so that a new
// array is a new row here and not a line in each of its functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/device_memory.hpp"

namespace flaunay::call {

/// The elements to which the rows of an array belong.
enum class RowOf { triangle, halfedge, hull_vertex, point };

/// One array of int32: the members that hold it and the members that ask for it.
struct ResultArray {
  const char* name;  ///< the name of all the members below
  RowOf row;
  std::vector<std::int32_t> Triangulation::*values;
  bool Options::*option;  ///< null: computed always
  DeviceBuffer DeviceTriangulation::*buffer;
  bool Parts::*part;
};

/// Row k is bit k of flaunay_part.
constexpr std::array<ResultArray, 5> kResultArrays = {{
    {"triangles", RowOf::triangle, &Triangulation::triangles, nullptr, &DeviceTriangulation::triangles,
     &Parts::triangles},
    {"neighbors", RowOf::triangle, &Triangulation::neighbors, &Options::neighbors,
     &DeviceTriangulation::neighbors, &Parts::neighbors},
    {"halfedges", RowOf::halfedge, &Triangulation::halfedges, &Options::halfedges,
     &DeviceTriangulation::halfedges, &Parts::halfedges},
    {"hull", RowOf::hull_vertex, &Triangulation::hull, nullptr, &DeviceTriangulation::hull, &Parts::hull},
    {"representatives", RowOf::point, &Triangulation::representatives, nullptr,
     &DeviceTriangulation::representatives, &Parts::representatives},
}};

/// Entries per row: a triangle has three corners and three neighbours.
constexpr std::size_t columns(RowOf row) { return row == RowOf::triangle ? 3 : 1; }

/// The number of rows that the last call wrote.
inline std::size_t rows(const DeviceTriangulation& result, RowOf row) {
  const std::size_t triangles = result.triangle_offsets.empty() ? 0 : result.triangle_offsets.back();
  switch (row) {
    case RowOf::triangle:
      return triangles;
    case RowOf::halfedge:
      return 3 * triangles;
    case RowOf::hull_vertex:
      return result.hull_offsets.empty() ? 0 : result.hull_offsets.back();
    case RowOf::point:
      return result.points;
  }
  return 0;
}

}  // namespace flaunay::call
