// CGAL's triangulations, plain and constrained, with the indices of points and triangles, made in the fastest
// ways that we know.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_hierarchy_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/natural_neighbor_coordinates_2.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "bench/peers/peer.hpp"

namespace flaunay::bench {
namespace {

struct VertexIndex {
  std::int32_t value = std::numeric_limits<std::int32_t>::max();
};

/// Infinite faces keep -1: what lies beyond the hull.
struct FaceIndex {
  std::int32_t index = -1;
};

struct FaceInfo : FaceIndex {
  std::int32_t depth = -1;  ///< number of constraints crossed from the outside; -1: not yet known
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
using Point = Kernel::Point_2;
using IndexedPoint = std::pair<Point, std::int32_t>;

/// Points [first, last) of x0 y0 x1 y1 ... with their indices, in place of what was there.
void copy_points(const std::vector<double>& coordinates, std::size_t first, std::size_t last,
                 std::vector<IndexedPoint>& points) {
  points.clear();
  points.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) {
    const double* const at = &coordinates[2 * i];
    points.emplace_back(Point(at[0], at[1]), static_cast<std::int32_t>(i));
  }
}

void sort_spatially(std::vector<IndexedPoint>& points) {
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
void append_faces(const Triangulation& triangulation, Mesh& mesh) {
  using FaceHandle = typename Triangulation::Face_handle;
  const std::size_t first = mesh.triangles.size() / 3;
  auto index = static_cast<std::int32_t>(first);
  for (const FaceHandle face : triangulation.finite_face_handles()) face->info().index = index++;
  mesh.triangles.resize(3 * static_cast<std::size_t>(index));
  mesh.neighbors.resize(3 * static_cast<std::size_t>(index));
  std::size_t at = 3 * first;
  for (const FaceHandle face : triangulation.finite_face_handles()) {
    for (int corner = 0; corner < 3; ++corner, ++at) {
      mesh.triangles[at] = face->vertex(corner)->info().value;
      mesh.neighbors[at] = face->neighbor(corner)->info().index;
    }
  }
}

// ---- Queries

constexpr std::int32_t kIndexOnEdge = -2;

template <typename Triangulation>
struct Indexed {
  using FaceHandle = typename Triangulation::Face_handle;

  explicit Indexed(const std::vector<double>& coordinates) {
    std::vector<IndexedPoint> points;
    copy_points(coordinates, 0, coordinates.size() / 2, points);
    insert(triangulation, points);
    append_faces(triangulation, mesh);
  }

  /// Runs answer(query, hint), which gives an answer and the next hint, for all queries; the seconds.
  template <typename Value, typename Answer>
  double answer_all(Start start, const std::vector<double>& coordinates, std::vector<Value>& indices,
                    const Answer& answer) const {
    const Stopwatch watch;
    std::vector<IndexedPoint> queries;
    copy_points(coordinates, 0, coordinates.size() / 2, queries);
    if (start == Start::last_face_sorted) sort_spatially(queries);
    indices.resize(queries.size());
    FaceHandle hint;
    for (const IndexedPoint& query : queries) {
      // Without a hint a hierarchy begins at its top.
      if (start == Start::hierarchy) hint = {};
      indices[static_cast<std::size_t>(query.second)] = answer(query.first, hint);
    }
    return watch.seconds();
  }

  double locate(Start start, const std::vector<double>& queries, std::vector<Corners>& corners) const {
    std::vector<std::int32_t> faces;
    const double seconds = answer_all(start, queries, faces, [&](const Point& query, FaceHandle& hint) {
      typename Triangulation::Locate_type place;
      int corner;
      hint = triangulation.locate(query, place, corner, hint);
      const bool several = place == Triangulation::EDGE || place == Triangulation::VERTEX;
      return several ? kIndexOnEdge : hint->info().index;
    });
    corners.clear();
    for (const std::int32_t face : faces) {
      corners.push_back(face == kIndexOnEdge ? kOnEdge
                        : face < 0           ? kOutside
                                   : sorted_corners(&mesh.triangles[3 * static_cast<std::size_t>(face)]));
    }
    return seconds;
  }

  double nearest(Start start, const std::vector<double>& queries, std::vector<std::int32_t>& points) const {
    return answer_all(start, queries, points, [&](const Point& query, FaceHandle& hint) {
      const auto vertex = triangulation.nearest_vertex(query, hint);
      hint = vertex->face();
      return vertex->info().value;
    });
  }

  double natural(Start start, const std::vector<double>& queries, const std::vector<double>& values,
                 std::vector<double>& results) const {
    using Weight = std::pair<typename Triangulation::Vertex_handle, double>;
    std::vector<Weight> weights;
    return answer_all(start, queries, results, [&](const Point& query, FaceHandle& hint) {
      weights.clear();
      const auto found = CGAL::natural_neighbor_coordinates_2(
          triangulation, query, std::back_inserter(weights), CGAL::Identity<Weight>(), hint);
      if (!found.third) return std::numeric_limits<double>::quiet_NaN();
      hint = weights.front().first->face();
      double sum = 0;
      for (const auto& [vertex, weight] : weights) {
        sum += weight * values[static_cast<std::size_t>(vertex->info().value)];
      }
      return sum / found.second;
    });
  }

  Triangulation triangulation;
  Mesh mesh;
};

class Queries : public CgalQueries {
 public:
  explicit Queries(const std::vector<double>& coordinates)
      : coordinates_(coordinates), plain_(coordinates), with_hierarchy_(coordinates) {}

  std::size_t triangles() const override { return plain_.mesh.triangles.size() / 3; }

  double locate(Start start, const std::vector<double>& queries,
                std::vector<Corners>& corners) const override {
    return start == Start::hierarchy ? with_hierarchy_.locate(start, queries, corners)
                                     : plain_.locate(start, queries, corners);
  }

  double nearest(Start start, const std::vector<double>& queries,
                 std::vector<std::int32_t>& points) const override {
    return start == Start::hierarchy ? with_hierarchy_.nearest(start, queries, points)
                                     : plain_.nearest(start, queries, points);
  }

  double natural(Start start, const std::vector<double>& queries, const std::vector<double>& values,
                 std::vector<double>& results) const override {
    return start == Start::hierarchy ? with_hierarchy_.natural(start, queries, values, results)
                                     : plain_.natural(start, queries, values, results);
  }

  double voronoi(std::vector<std::int32_t>& cell_sizes) const override;

  bool equally_far(const double* query, std::int32_t a, std::int32_t b) const override {
    const auto point = [&](std::int32_t i) {
      const double* const at = &coordinates_[2 * static_cast<std::size_t>(i)];
      return Point(at[0], at[1]);
    };
    return CGAL::compare_distance_to_point(Point(query[0], query[1]), point(a), point(b)) == CGAL::EQUAL;
  }

 private:
  std::vector<double> coordinates_;
  Indexed<Delaunay> plain_;
  Indexed<Hierarchy> with_hierarchy_;
};

double Queries::voronoi(std::vector<std::int32_t>& cell_sizes) const {
  const Delaunay& triangulation = plain_.triangulation;
  const Stopwatch watch;
  std::vector<double> circumcentres;
  std::vector<std::int32_t> points, cell_offsets{0}, cells;
  circumcentres.reserve(2 * triangulation.number_of_faces());
  for (const auto face : triangulation.finite_face_handles()) {
    const Point centre = triangulation.dual(face);
    circumcentres.push_back(centre.x());
    circumcentres.push_back(centre.y());
  }
  points.reserve(triangulation.number_of_vertices());
  cell_offsets.reserve(triangulation.number_of_vertices() + 1);
  cells.reserve(3 * triangulation.number_of_faces());
  for (const auto vertex : triangulation.finite_vertex_handles()) {
    const auto first = triangulation.incident_faces(vertex);
    auto face = first;
    do {
      if (face->info().index >= 0) cells.push_back(face->info().index);
    } while (++face != first);
    points.push_back(vertex->info().value);
    cell_offsets.push_back(static_cast<std::int32_t>(cells.size()));
  }
  const double seconds = watch.seconds();
  cell_sizes.assign(coordinates_.size() / 2, 0);
  for (std::size_t v = 0; v < points.size(); ++v) {
    cell_sizes[static_cast<std::size_t>(points[v])] = cell_offsets[v + 1] - cell_offsets[v];
  }
  return seconds;
}

Outcome run_cgal(const Input& input) {
  const Stopwatch watch;
  Mesh mesh;
  std::vector<IndexedPoint> points;
  Delaunay triangulation;
  for (std::size_t s = 0; s < input.sets(); ++s) {
    copy_points(input.coordinates, input.offsets[s], input.offsets[s + 1], points);
    triangulation.clear();
    insert(triangulation, points);
    append_faces(triangulation, mesh);
  }
  return {watch.seconds(), mesh.triangles.size() / 3};
}

// ---- Constrained triangulations

using ConstrainedFace =
    CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Constrained =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel,
                                               CGAL::Triangulation_data_structure_2<Vertex, ConstrainedFace>,
                                               CGAL::No_constraint_intersection_tag>;
using FaceHandle = Constrained::Face_handle;
using VertexHandle = Constrained::Vertex_handle;

/// A set of an input.
struct Part {
  const ConstrainedInput& input;
  std::size_t first, last;                  ///< points
  std::size_t first_segment, last_segment;  ///< segments

  std::size_t end(std::size_t k) const { return static_cast<std::size_t>(input.segments[k]) - first; }
};

/// CGAL does not say which vertex a point became; vertices are numbered as they come, which costs less than
/// to find out.
void insert_range(Constrained& triangulation, const Part& part) {
  std::vector<Point> points;
  points.reserve(part.last - part.first);
  const std::vector<double>& xy = part.input.points.coordinates;
  for (std::size_t i = part.first; i < part.last; ++i) points.emplace_back(xy[2 * i], xy[2 * i + 1]);
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
  std::vector<IndexedPoint> points;
  copy_points(part.input.points.coordinates, part.first, part.last, points);
  sort_spatially(points);
  std::vector<VertexHandle> vertices;  // in spatial order
  vertices.reserve(points.size());
  std::vector<std::uint32_t> rank(points.size());
  FaceHandle hint;
  for (const auto& [point, index] : points) {
    rank[static_cast<std::size_t>(index) - part.first] = static_cast<std::uint32_t>(vertices.size());
    const VertexHandle vertex = vertices.emplace_back(triangulation.insert(point, hint));
    hint = vertex->face();
    vertex->info().value = std::min(vertex->info().value, index);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted;
  sorted.reserve(part.last_segment - part.first_segment);
  for (std::size_t s = part.first_segment; s < part.last_segment; ++s) {
    sorted.emplace_back(std::minmax(rank[part.end(2 * s)], rank[part.end(2 * s + 1)]));
  }
  std::sort(sorted.begin(), sorted.end());
  for (const auto& [a, b] : sorted) {
    if (vertices[a] != vertices[b]) triangulation.insert_constraint(vertices[a], vertices[b]);
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

struct MeshWithMarks : Mesh {
  std::vector<std::uint8_t> constrained;
};

/// Appends triangles, neighbours, and which edges are constraints; inside: only of faces inside.
void append_faces(const Constrained& triangulation, bool inside, MeshWithMarks& arrays) {
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

Outcome run_constrained(const ConstrainedInput& input, CgalInsertion insertion, bool inside) {
  const Stopwatch watch;
  MeshWithMarks arrays;
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

const BuiltPeer kBuilt(kCgal, run_cgal);

std::unique_ptr<CgalQueries> make_queries(const std::vector<double>& coordinates) {
  return std::make_unique<Queries>(coordinates);
}

const bool kBuiltOthers = (make_cgal_queries = make_queries, run_cgal_constrained = run_constrained, true);

}  // namespace
}  // namespace flaunay::bench
