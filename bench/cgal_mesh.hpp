// CGAL's triangulations with the indices of points and triangles, made in the fastest way that we know. For
// the sources that are compiled only where CGAL was found.
#pragma once

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_hierarchy_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace flaunay::bench::cgal {

struct VertexIndex {
  std::int32_t value = std::numeric_limits<std::int32_t>::max();
};

/// Infinite faces keep -1: what lies beyond the hull.
struct FaceIndex {
  std::int32_t value = -1;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<VertexIndex, Kernel>;
using Face = CGAL::Triangulation_face_base_with_info_2<FaceIndex, Kernel>;
template <typename VertexBase>
using DelaunayOf =
    CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, Face>>;
using Delaunay = DelaunayOf<Vertex>;
using Hierarchy =
    CGAL::Triangulation_hierarchy_2<DelaunayOf<CGAL::Triangulation_hierarchy_vertex_base_2<Vertex>>>;
using IndexedPoint = std::pair<Kernel::Point_2, std::int32_t>;

/// Points [first, last) of x0 y0 x1 y1 ... with their indices, in place of what was there.
inline void copy_points(const std::vector<double>& coordinates, std::size_t first, std::size_t last,
                        std::vector<IndexedPoint>& points) {
  points.clear();
  points.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) {
    const double* const at = &coordinates[2 * i];
    points.emplace_back(Kernel::Point_2(at[0], at[1]), static_cast<std::int32_t>(i));
  }
}

inline void sort_spatially(std::vector<IndexedPoint>& points) {
  using Traits = CGAL::Spatial_sort_traits_adapter_2<Kernel, CGAL::First_of_pair_property_map<IndexedPoint>>;
  CGAL::spatial_sort(points.begin(), points.end(), Traits());
}

/// What CGAL's own insertion of a range of points does, and as fast, with the points' indices beside them.
/// Its insertion of points with information, which sorts indices, takes 1.4 times as long.
template <typename Triangulation>
void insert(Triangulation& triangulation, std::vector<IndexedPoint>& points) {
  sort_spatially(points);
  typename Triangulation::Face_handle hint;
  for (const IndexedPoint& point : points) {
    const typename Triangulation::Vertex_handle vertex = triangulation.insert(point.first, hint);
    hint = vertex->face();
    vertex->info().value = std::min(vertex->info().value, point.second);
  }
}

struct Mesh {
  std::vector<std::int32_t> triangles, neighbors;
};

/// Appends triangles and neighbours to those of the sets before; faces get their indices.
template <typename Triangulation>
void append(const Triangulation& triangulation, Mesh& mesh) {
  using FaceHandle = typename Triangulation::Face_handle;
  const std::size_t first = mesh.triangles.size() / 3;
  auto index = static_cast<std::int32_t>(first);
  for (const FaceHandle face : triangulation.finite_face_handles()) face->info().value = index++;
  mesh.triangles.resize(3 * static_cast<std::size_t>(index));
  mesh.neighbors.resize(3 * static_cast<std::size_t>(index));
  std::size_t at = 3 * first;
  for (const FaceHandle face : triangulation.finite_face_handles()) {
    for (int corner = 0; corner < 3; ++corner, ++at) {
      mesh.triangles[at] = face->vertex(corner)->info().value;
      mesh.neighbors[at] = face->neighbor(corner)->info().value;
    }
  }
}

}  // namespace flaunay::bench::cgal
