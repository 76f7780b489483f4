// The arrays of the results as tables, one row per array: for programs that treat all arrays alike, such as
// bindings to other languages and writers of files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "flaunay/constrained.hpp"
#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.hpp"

/// The arrays of flaunay::Triangulation, in the order of the bits of flaunay_part. A row is X(type of the
/// elements, name, of what there is one row per thing, elements per row, by what it is asked for, a line for
/// users). flaunay_mesh and flaunay_constrained_arrays have the counts of these things. An array is computed
/// always or on request, by the member of its name in flaunay::Options.
#define FLAUNAY_TRIANGULATION_ARRAYS(X)                                                               \
  X(std::int32_t, triangles, triangle, 3, always, "Triangles, 3 point indices per row")               \
  X(std::int32_t, neighbors, triangle, 3, on_request,                                                 \
    "Neighbours, the triangle opposite to each vertex, -1 on the hull")                               \
  X(std::int32_t, halfedges, halfedge, 1, on_request, "Halfedges, the opposite ones, -1 on the hull") \
  X(std::int32_t, hull, hull, 1, always, "Hull, counter-clockwise")                                   \
  X(std::int32_t, representatives, point, 1, always,                                                  \
    "Duplicates, for each point the smallest index of an equal point")                                \
  X(double, areas, triangle, 1, on_request, "Areas of triangles")

/// The arrays that triangulations in chunks have, in the order of flaunay::MeshArray: X(name).
#define FLAUNAY_MESH_ARRAYS(X) X(triangles) X(neighbors) X(hull) X(representatives) X(areas)

/// The arrays that flaunay::ConstrainedTriangulation has besides. A row is as above, but the line for users
/// is empty for arrays that the command does not write to files. An array is computed always, or if there is
/// what it is computed from: labels, a map, or a member of flaunay::Constraints.
#define FLAUNAY_CONSTRAINED_ARRAYS(X)                                                                   \
  X(double, added_points, added, 2, always, "")                                                         \
  X(std::size_t, added_offsets, set_offset, 1, always, "")                                              \
  X(std::int32_t, constraint_edges, constraint, 2, always, "Constraint edges, 2 point indices per row") \
  X(std::int32_t, edge_segments, constraint, 1, always,                                                 \
    "For each constraint edge the smallest number of a segment that has it")                            \
  X(std::int32_t, piece_offsets, segment_offset, 1, always, "")                                         \
  X(std::int32_t, piece_edges, piece, 2, always, "")                                                    \
  X(std::uint8_t, constrained, triangle, 3, always, "")                                                 \
  X(std::int32_t, depths, triangle, 1, labels, "For each triangle its depth by --fill")                 \
  X(std::int32_t, regions, triangle, 1, labels, "For each triangle the number of its region")           \
  X(std::int32_t, polygons, triangle, 1, map,                                                           \
    "GeoJSON: for each triangle the number of its polygon, -1 for none")                                \
  X(std::int32_t, edge_markers, constraint, 1, segment_markers,                                         \
    ".poly: for each constraint edge the marker of its segment")                                        \
  X(std::int32_t, vertex_markers, point, 1, point_markers,                                              \
    ".poly: for each point its marker, and for added ones that of their segment")                       \
  X(double, triangle_attributes, triangle, 1, seeds, ".poly: for each triangle the attribute of its region")

/// The arrays of flaunay::Voronoi, in the order of the bits of flaunay_voronoi_part: X(type, name, rows,
/// elements per row).
#define FLAUNAY_VORONOI_ARRAYS(X)                \
  X(double, circumcentres, triangle, 2)          \
  X(std::int32_t, cell_offsets, point_offset, 1) \
  X(std::int32_t, cells, corner, 1)              \
  X(std::uint8_t, unbounded, point, 1)

/// The arrays of flaunay::ClippedVoronoi, in the order of the bits of flaunay_clipped_voronoi_part: as above.
#define FLAUNAY_CLIPPED_VORONOI_ARRAYS(X)   \
  X(double, vertices, vertex, 2)            \
  X(std::int32_t, offsets, point_offset, 1) \
  X(double, areas, point, 1)                \
  X(double, centroids, point, 2)

/// The arrays that flaunay::Triangulation has besides, in other spaces than the plane or with weights: as
/// above. They follow those of FLAUNAY_TRIANGULATION_ARRAYS in the order of the bits of
/// flaunay_part.
#define FLAUNAY_SPACE_ARRAYS(X)               \
  X(double, places, point, 2)                 \
  X(std::int8_t, corner_offsets, triangle, 6) \
  X(std::int32_t, hidden, hidden, 1)

/// The arrays that flaunay::DeviceTriangulation has besides, of constraints and of triangulations that
/// change: as above. They follow in the order of the bits of flaunay_part.
#define FLAUNAY_DEVICE_ARRAYS(X)                   \
  X(std::uint8_t, constrained, triangle, 3)        \
  X(std::int32_t, piece_edges, segment, 2)         \
  X(std::int32_t, constraint_edges, constraint, 2) \
  X(double, coordinates, point, 2)

namespace flaunay {

/// The things for each of which an array of a triangulation has a row.
enum class RowOf { triangle, halfedge, hull, point };

/// The largest number of rows for n points.
constexpr std::size_t most_rows(RowOf row, std::size_t n) {
  return row == RowOf::triangle ? 2 * n : row == RowOf::halfedge ? 6 * n : n;
}

/// One array of a triangulation with elements of type T.
template <typename T>
struct TriangulationArray {
  using Element = T;                          ///< the type of its elements
  const char* name;                           ///< the name of all the members below
  RowOf row;                                  ///< of what it has one row per thing
  std::size_t columns;                        ///< elements per row; 1: it has one dimension
  const char* text;                           ///< a line for users
  std::vector<T> Triangulation::*values;      ///< the array in host memory
  bool Options::*option;                      ///< the option that asks for it; null: it is computed always
  DeviceBuffer DeviceTriangulation::*buffer;  ///< the array in device memory
  bool Parts::*part;                          ///< what asks for it in device memory
};

#define FLAUNAY_OPTION_always(name) nullptr
#define FLAUNAY_OPTION_on_request(name) &Options::name
#define FLAUNAY_ROW(type, name, row, columns, asked, text) \
  TriangulationArray<type>{#name,                          \
                           RowOf::row,                     \
                           columns,                        \
                           text,                           \
                           &Triangulation::name,           \
                           FLAUNAY_OPTION_##asked(name),   \
                           &DeviceTriangulation::name,     \
                           &Parts::name},
/// FLAUNAY_TRIANGULATION_ARRAYS as a tuple.
inline constexpr std::tuple kTriangulationArrays{FLAUNAY_TRIANGULATION_ARRAYS(FLAUNAY_ROW)};
#undef FLAUNAY_ROW
#undef FLAUNAY_OPTION_on_request
#undef FLAUNAY_OPTION_always

/// The number of arrays of a triangulation.
inline constexpr std::size_t kTriangulationArrayCount = std::tuple_size_v<decltype(kTriangulationArrays)>;

/// The input or option that asks for an array of a constrained triangulation.
enum class AskedBy { always, labels, map, segment_markers, point_markers, seeds };

/// One array that constrained triangulations have besides, with elements of type T.
template <typename T>
struct ConstrainedArray {
  using Element = T;                                 ///< the type of its elements
  const char* name;                                  ///< the name of the member below
  std::size_t columns;                               ///< elements per row; 1: it has one dimension
  AskedBy asked;                                     ///< by what it is asked for
  const char* text;                                  ///< a line for users; "": it has no file
  std::vector<T> ConstrainedTriangulation::*values;  ///< the array
};

#define FLAUNAY_ROW(type, name, row, columns, asked, text) \
  ConstrainedArray<type>{#name, columns, AskedBy::asked, text, &ConstrainedTriangulation::name},
/// FLAUNAY_CONSTRAINED_ARRAYS as a tuple.
inline constexpr std::tuple kConstrainedArrays{FLAUNAY_CONSTRAINED_ARRAYS(FLAUNAY_ROW)};
#undef FLAUNAY_ROW

/// Calls visit(array, k) for the k-th array of a table.
template <typename Table, typename Visit>
constexpr void for_each_array(const Table& table, const Visit& visit) {
  std::apply(
      [&visit](const auto&... arrays) {
        std::size_t k = 0;
        (visit(arrays, k++), ...);
      },
      table);
}
/// The arrays of a triangulation.
template <typename Visit>
constexpr void for_each_array(const Visit& visit) {
  for_each_array(kTriangulationArrays, visit);
}

/// The place of an array in the table, by its name.
constexpr std::size_t array_index(std::string_view name) {
  std::size_t found = kTriangulationArrayCount;
  for_each_array([&](const auto& array, std::size_t k) {
    if (array.name == name) found = k;
  });
  return found;
}

#define FLAUNAY_INDEX(name) array_index(#name),
/// For each MeshArray its place in the table.
inline constexpr std::array kMeshArrayIndices = {FLAUNAY_MESH_ARRAYS(FLAUNAY_INDEX)};
#undef FLAUNAY_INDEX

/// Calls visit(array) for the one that has this number in the order of MeshArray.
template <typename Visit>
constexpr void visit_mesh_array(std::size_t number, const Visit& visit) {
  for_each_array([&](const auto& array, std::size_t k) {
    if (k == kMeshArrayIndices[number]) visit(array);
  });
}

}  // namespace flaunay
