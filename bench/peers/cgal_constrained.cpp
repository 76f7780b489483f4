// CGAL's constrained Delaunay triangulations with the indices of points and triangles, in the fastest ways
// that we know.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "bench/peers/peer.hpp"

namespace flaunay::bench {
namespace {

constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();

struct VertexIndex {
  std::int32_t value = kNone;
};

struct FaceInfo {
  std::int32_t index = -1;
  std::int32_t depth = -1;  ///< number of constraints crossed from the outside; -1: not yet known
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<VertexIndex, Kernel>;
using Face = CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel,
                                                       CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Constrained =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex, Face>,
                                               CGAL::No_constraint_intersection_tag>;
using Point = Kernel::Point_2;
using FaceHandle = Constrained::Face_handle;
using VertexHandle = Constrained::Vertex_handle;

/// A set of an input.
struct Part {
  const ConstrainedInput& input;
  std::size_t first, last;                  ///< points
  std::size_t first_segment, last_segment;  ///< segments

  std::size_t end(std::size_t k) const { return static_cast<std::size_t>(input.segments[k]) - first; }
};

std::vector<Point> points_of(const Part& part) {
  std::vector<Point> points;
  points.reserve(part.last - part.first);
  const std::vector<double>& xy = part.input.points.coordinates;
  for (std::size_t i = part.first; i < part.last; ++i) points.emplace_back(xy[2 * i], xy[2 * i + 1]);
  return points;
}

/// CGAL does not say which vertex a point became; vertices are numbered as they come, which costs less than
/// to find out.
void insert_range(Constrained& triangulation, const Part& part) {
  const std::vector<Point> points = points_of(part);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  pairs.reserve(part.last_segment - part.first_segment);
  for (std::size_t s = part.first_segment; s < part.last_segment; ++s) {
    pairs.emplace_back(part.end(2 * s), part.end(2 * s + 1));
  }
  triangulation.insert_constraints(points.begin(), points.end(), pairs.begin(), pairs.end());
  auto index = static_cast<std::int32_t>(part.first);
  for (const VertexHandle vertex : triangulation.finite_vertex_handles()) vertex->info().value = index++;
}

void insert_sorted(Constrained& triangulation, const Part& part) {
  const std::vector<Point> points = points_of(part);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  using Map = CGAL::Pointer_property_map<Point>::const_type;
  using Traits = CGAL::Spatial_sort_traits_adapter_2<Kernel, Map>;
  CGAL::spatial_sort(order.begin(), order.end(), Traits(CGAL::make_property_map(points)));
  std::vector<VertexHandle> vertices(points.size());
  std::vector<std::uint32_t> rank(points.size());
  FaceHandle hint;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t i = order[k];
    const VertexHandle vertex = vertices[i] = triangulation.insert(points[i], hint);
    hint = vertex->face();
    rank[i] = static_cast<std::uint32_t>(k);
    vertex->info().value = std::min(vertex->info().value, static_cast<std::int32_t>(part.first + i));
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted;
  sorted.reserve(part.last_segment - part.first_segment);
  for (std::size_t s = part.first_segment; s < part.last_segment; ++s) {
    sorted.emplace_back(std::minmax(rank[part.end(2 * s)], rank[part.end(2 * s + 1)]));
  }
  std::sort(sorted.begin(), sorted.end());
  for (const auto& [a, b] : sorted) {
    const VertexHandle from = vertices[order[a]], to = vertices[order[b]];
    if (from != to) triangulation.insert_constraint(from, to);
  }
}

/// The depth of every face; an odd one is inside.
void find_depths(const Constrained& triangulation) {
  std::vector<FaceHandle> now{triangulation.infinite_face()}, next;
  for (std::int32_t depth = 0; !now.empty(); ++depth) {
    while (!now.empty()) {
      const FaceHandle face = now.back();
      now.pop_back();
      if (face->info().depth >= 0) continue;
      face->info().depth = depth;
      for (int k = 0; k < 3; ++k) {
        const FaceHandle other = face->neighbor(k);
        if (other->info().depth < 0) (face->is_constrained(k) ? next : now).push_back(other);
      }
    }
    std::swap(now, next);
  }
}

struct Arrays {
  std::vector<std::int32_t> triangles, neighbors;
  std::vector<std::uint8_t> constrained;
};

/// Appends triangles, neighbours, and which edges are constraints; inside: only of faces inside.
void append_faces(const Constrained& triangulation, bool inside, Arrays& arrays) {
  auto index = static_cast<std::int32_t>(arrays.triangles.size() / 3);
  const auto is_kept = [inside](FaceHandle face) { return !inside || face->info().depth % 2 == 1; };
  for (const FaceHandle face : triangulation.finite_face_handles()) {
    if (is_kept(face)) face->info().index = index++;
  }
  for (const FaceHandle face : triangulation.finite_face_handles()) {
    if (!is_kept(face)) continue;
    for (int corner = 0; corner < 3; ++corner) {
      arrays.triangles.push_back(face->vertex(corner)->info().value);
      arrays.neighbors.push_back(face->neighbor(corner)->info().index);
      arrays.constrained.push_back(face->is_constrained(corner));
    }
  }
}

Outcome run(const ConstrainedInput& input, CgalInsertion insertion, bool inside) {
  const Stopwatch watch;
  Arrays arrays;
  Constrained triangulation;
  for (std::size_t s = 0; s < input.points.sets(); ++s) {
    const Part part{input, input.points.offsets[s], input.points.offsets[s + 1], input.segment_offsets[s],
                    input.segment_offsets[s + 1]};
    triangulation.clear();
    (insertion == CgalInsertion::range ? insert_range : insert_sorted)(triangulation, part);
    if (inside) find_depths(triangulation);
    append_faces(triangulation, inside, arrays);
  }
  return {watch.seconds(), arrays.triangles.size() / 3};
}

const bool kBuilt = (run_cgal_constrained = run, true);

}  // namespace
}  // namespace flaunay::bench
