#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "peer.hpp"
#include "timing.hpp"

namespace flaunay::bench {
namespace {

struct VertexIndex {
  std::int32_t value = std::numeric_limits<std::int32_t>::max();
};

/// Infinite faces keep -1: what lies beyond the hull.
struct FaceIndex {
  std::int32_t value = -1;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Structure =
    CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<VertexIndex, Kernel>,
                                         CGAL::Triangulation_face_base_with_info_2<FaceIndex, Kernel>>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, Structure>;
using IndexedPoint = std::pair<Kernel::Point_2, std::int32_t>;

struct Mesh {
  std::vector<std::int32_t> triangles, neighbors;
};

/// What CGAL's own insertion of a range of points does, and as fast, with the points' indices beside them.
/// Its insertion of points with information, which sorts indices, takes 1.4 times as long.
void insert(Delaunay& triangulation, std::vector<IndexedPoint>& points) {
  using Traits = CGAL::Spatial_sort_traits_adapter_2<Kernel, CGAL::First_of_pair_property_map<IndexedPoint>>;
  CGAL::spatial_sort(points.begin(), points.end(), Traits());
  Delaunay::Face_handle hint;
  for (const IndexedPoint& point : points) {
    const Delaunay::Vertex_handle vertex = triangulation.insert(point.first, hint);
    hint = vertex->face();
    vertex->info().value = std::min(vertex->info().value, point.second);
  }
}

/// Appends triangles and neighbours to those of the sets before.
void append(const Delaunay& triangulation, Mesh& mesh) {
  const std::size_t first = mesh.triangles.size() / 3;
  auto index = static_cast<std::int32_t>(first);
  for (const Delaunay::Face_handle face : triangulation.finite_face_handles()) face->info().value = index++;
  mesh.triangles.resize(3 * static_cast<std::size_t>(index));
  mesh.neighbors.resize(3 * static_cast<std::size_t>(index));
  std::size_t at = 3 * first;
  for (const Delaunay::Face_handle face : triangulation.finite_face_handles()) {
    for (int corner = 0; corner < 3; ++corner, ++at) {
      mesh.triangles[at] = face->vertex(corner)->info().value;
      mesh.neighbors[at] = face->neighbor(corner)->info().value;
    }
  }
}

}  // namespace

Outcome run_cgal(const Input& input) {
  const Stopwatch watch;
  Mesh mesh;
  std::vector<IndexedPoint> points;
  Delaunay triangulation;
  for (std::size_t s = 0; s + 1 < input.offsets.size(); ++s) {
    points.clear();
    points.reserve(input.offsets[s + 1] - input.offsets[s]);
    for (std::size_t i = input.offsets[s]; i < input.offsets[s + 1]; ++i) {
      const double* const at = &input.points.coordinates[2 * i];
      points.emplace_back(Kernel::Point_2(at[0], at[1]), static_cast<std::int32_t>(i));
    }
    triangulation.clear();
    insert(triangulation, points);
    append(triangulation, mesh);
  }
  return {watch.seconds(), mesh.triangles.size() / 3};
}

}  // namespace flaunay::bench
