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

/// Infinite faces keep -1, the outside of the hull.
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

/// Points [first, last) of x0 y0 x1 y1 ... with their indices, replacing the contents of `points`.
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

/// Does the same as CGAL's insertion of a range of points, as fast, but keeps the points' indices. CGAL's
/// insertion of points with information, which sorts indices, takes 1.4 times as long.
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
  std::vector<std::uint8_t> constrained;  ///< of constrained triangulations
};

/// Appends the triangles, neighbours and, if any, constraints of kept faces to the arrays of the sets before.
/// Kept faces get their indices.
template <typename Triangulation, typename IsKept>
void append_faces(const Triangulation& triangulation, Mesh& mesh, const IsKept& is_kept) {
  const std::size_t first = mesh.triangles.size() / 3;
  auto index = static_cast<std::int32_t>(first);
  for (const auto face : triangulation.finite_face_handles()) {
    if (is_kept(face)) face->info().index = index++;
  }
  mesh.triangles.resize(3 * static_cast<std::size_t>(index));
  mesh.neighbors.resize(3 * static_cast<std::size_t>(index));
  std::size_t at = 3 * first;
  for (const auto face : triangulation.finite_face_handles()) {
    if (!is_kept(face)) continue;
    for (int corner = 0; corner < 3; ++corner, ++at) {
      mesh.triangles[at] = face->vertex(corner)->info().value;
      mesh.neighbors[at] = face->neighbor(corner)->info().index;
      if constexpr (requires { face->is_constrained(corner); }) {
        mesh.constrained.push_back(face->is_constrained(corner));
      }
    }
  }
}

constexpr auto kAll = [](const auto&) { return true; };

// ---- Queries

template <typename Triangulation>
class Queries : public CgalQueries {
  using FaceHandle = typename Triangulation::Face_handle;

 public:
  Queries(const std::vector<double>& coordinates, Start start) : start_(start) {
    std::vector<IndexedPoint> points;
    copy_points(coordinates, 0, coordinates.size() / 2, points);
    insert(triangulation_, points);
    append_faces(triangulation_, mesh_, kAll);
  }

  std::size_t triangles() const override { return mesh_.triangles.size() / 3; }

  double locate(const std::vector<double>& queries, std::vector<Corners>& corners) const override {
    std::vector<std::int32_t> faces;
    const double seconds = answer_all(queries, faces, [&](const Point& query, FaceHandle& hint) {
      hint = triangulation_.locate(query, hint);
      return hint->info().index;
    });
    corners.clear();
    for (const std::int32_t face : faces) {
      corners.push_back(face < 0 ? kOutside
                                 : sorted_corners(&mesh_.triangles[3 * static_cast<std::size_t>(face)]));
    }
    return seconds;
  }

  double nearest(const std::vector<double>& queries, std::vector<std::int32_t>& points) const override {
    return answer_all(queries, points, [&](const Point& query, FaceHandle& hint) {
      const auto vertex = triangulation_.nearest_vertex(query, hint);
      hint = vertex->face();
      return vertex->info().value;
    });
  }

  double natural(const std::vector<double>& queries, const std::vector<double>& values,
                 std::vector<double>& results) const override {
    using Weight = std::pair<typename Triangulation::Vertex_handle, double>;
    std::vector<Weight> weights;
    return answer_all(queries, results, [&](const Point& query, FaceHandle& hint) {
      weights.clear();
      const auto found = CGAL::natural_neighbor_coordinates_2(
          triangulation_, query, std::back_inserter(weights), CGAL::Identity<Weight>(), hint);
      if (!found.third) return std::numeric_limits<double>::quiet_NaN();
      hint = weights.front().first->face();
      double sum = 0;
      for (const auto& [vertex, weight] : weights) {
        sum += weight * values[static_cast<std::size_t>(vertex->info().value)];
      }
      return sum / found.second;
    });
  }

  double voronoi(std::size_t& corners) const override {
    const Stopwatch watch;
    std::vector<double> circumcentres;
    std::vector<std::int32_t> points, cell_offsets{0}, cells;
    circumcentres.reserve(2 * triangulation_.number_of_faces());
    for (const auto face : triangulation_.finite_face_handles()) {
      const Point centre = triangulation_.dual(face);
      circumcentres.push_back(centre.x());
      circumcentres.push_back(centre.y());
    }
    points.reserve(triangulation_.number_of_vertices());
    cell_offsets.reserve(triangulation_.number_of_vertices() + 1);
    cells.reserve(3 * triangulation_.number_of_faces());
    for (const auto vertex : triangulation_.finite_vertex_handles()) {
      const auto first = triangulation_.incident_faces(vertex);
      auto face = first;
      do {
        if (face->info().index >= 0) cells.push_back(face->info().index);
      } while (++face != first);
      points.push_back(vertex->info().value);
      cell_offsets.push_back(static_cast<std::int32_t>(cells.size()));
    }
    const double seconds = watch.seconds();
    corners = cells.size();
    return seconds;
  }

 private:
  /// Runs answer(query, hint), which gives an answer and the next hint, for all queries; the seconds.
  template <typename Value, typename Answer>
  double answer_all(const std::vector<double>& coordinates, std::vector<Value>& answers,
                    const Answer& answer) const {
    const Stopwatch watch;
    std::vector<IndexedPoint> queries;
    copy_points(coordinates, 0, coordinates.size() / 2, queries);
    if (start_ == Start::last_face_sorted) sort_spatially(queries);
    answers.resize(queries.size());
    FaceHandle hint;
    for (const IndexedPoint& query : queries) {
      // Without a hint a hierarchy begins at its top.
      if (start_ == Start::hierarchy) hint = {};
      answers[static_cast<std::size_t>(query.second)] = answer(query.first, hint);
    }
    return watch.seconds();
  }

  Start start_;
  Triangulation triangulation_;
  Mesh mesh_;
};

Outcome run_cgal(const Input& input) {
  const Stopwatch watch;
  Mesh mesh;
  std::vector<IndexedPoint> points;
  Delaunay triangulation;
  for (std::size_t s = 0; s < input.sets(); ++s) {
    copy_points(input.coordinates, input.offsets[s], input.offsets[s + 1], points);
    triangulation.clear();
    insert(triangulation, points);
    append_faces(triangulation, mesh, kAll);
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

/// Inserts a set of an input. CGAL does not say which vertex a point became; vertices are numbered as they
/// come, which costs less than to find out.
void insert(Constrained& triangulation, const ConstrainedInput& input, std::size_t set) {
  const std::size_t first = input.points.offsets[set], last = input.points.offsets[set + 1];
  std::vector<Point> points;
  points.reserve(last - first);
  const std::vector<double>& xy = input.points.coordinates;
  for (std::size_t i = first; i < last; ++i) points.emplace_back(xy[2 * i], xy[2 * i + 1]);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  pairs.reserve(input.segment_offsets[set + 1] - input.segment_offsets[set]);
  const auto end = [&](std::size_t k) { return static_cast<std::size_t>(input.segments[k]) - first; };
  for (std::size_t s = input.segment_offsets[set]; s < input.segment_offsets[set + 1]; ++s) {
    pairs.emplace_back(end(2 * s), end(2 * s + 1));
  }
  triangulation.insert_constraints(points.begin(), points.end(), pairs.begin(), pairs.end());
  auto index = static_cast<std::int32_t>(first);
  for (const VertexHandle vertex : triangulation.finite_vertex_handles()) vertex->info().value = index++;
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

Outcome run_constrained(const ConstrainedInput& input) {
  const bool inside = input.has_polygons();
  const Stopwatch watch;
  Mesh mesh;
  Constrained triangulation;
  for (std::size_t set = 0; set < input.points.sets(); ++set) {
    triangulation.clear();
    insert(triangulation, input, set);
    if (inside) find_depths(triangulation);
    append_faces(triangulation, mesh,
                 [inside](FaceHandle face) { return !inside || face->info().depth % 2 == 1; });
  }
  return {watch.seconds(), mesh.triangles.size() / 3};
}

const BuiltPeer kBuilt(
    {kCgal,
     "CGAL's Delaunay_triangulation_2 with Exact_predicates_inexact_constructions_kernel, exact, one "
     "thread: copying the points, sorting them spatially with their indices, inserting them, writing "
     "triangles and neighbours into arrays",
     run_cgal});

std::unique_ptr<CgalQueries> make_queries(const std::vector<double>& coordinates, Start start) {
  if (start == Start::hierarchy) return std::make_unique<Queries<Hierarchy>>(coordinates, start);
  return std::make_unique<Queries<Delaunay>>(coordinates, start);
}

const bool kBuiltOthers = (make_cgal_queries = make_queries, run_cgal_constrained = run_constrained, true);

}  // namespace
}  // namespace flaunay::bench
