#include "peer_queries.hpp"

#include <algorithm>

#include "flaunay/flaunay.hpp"
#if FLAUNAY_BENCH_CGAL
#include "cgal_mesh.hpp"
#include "timing.hpp"
#endif

namespace flaunay::bench {

std::string to_string(Start start) {
  switch (start) {
    case Start::last_face:
      return "last face";
    case Start::last_face_sorted:
      return "sorted, last face";
    case Start::hierarchy:
      return "hierarchy";
  }
  return "";
}

Corners sorted_corners(const std::int32_t* triangle) {
  Corners corners{triangle[0], triangle[1], triangle[2]};
  std::sort(corners.begin(), corners.end());
  return corners;
}

#if FLAUNAY_BENCH_CGAL

namespace {

constexpr std::int32_t kIndexOnEdge = -2;

template <typename Triangulation>
struct Indexed {
  explicit Indexed(const std::vector<double>& coordinates) {
    std::vector<cgal::IndexedPoint> points;
    cgal::copy_points(coordinates, 0, coordinates.size() / 2, points);
    cgal::insert(triangulation, points);
    cgal::append(triangulation, mesh);
  }
  Triangulation triangulation;
  cgal::Mesh mesh;
};

/// Runs answer(query, hint), which gives an index and the next hint, for all queries; the seconds.
template <typename Triangulation, typename Answer>
double answer_all(Start start, const std::vector<double>& coordinates, std::vector<std::int32_t>& indices,
                  const Answer& answer) {
  const Stopwatch watch;
  std::vector<cgal::IndexedPoint> queries;
  cgal::copy_points(coordinates, 0, coordinates.size() / 2, queries);
  if (start == Start::last_face_sorted) cgal::sort_spatially(queries);
  indices.resize(queries.size());
  typename Triangulation::Face_handle hint;
  for (const cgal::IndexedPoint& query : queries) {
    // Without a hint a hierarchy begins at its top.
    if (start == Start::hierarchy) hint = {};
    indices[static_cast<std::size_t>(query.second)] = answer(query.first, hint);
  }
  return watch.seconds();
}

template <typename Triangulation>
double locate_in(const Triangulation& triangulation, Start start, const std::vector<double>& queries,
                 std::vector<std::int32_t>& faces) {
  using FaceHandle = typename Triangulation::Face_handle;
  return answer_all<Triangulation>(
      start, queries, faces, [&](const cgal::Kernel::Point_2& query, FaceHandle& hint) {
        typename Triangulation::Locate_type place;
        int corner;
        hint = triangulation.locate(query, place, corner, hint);
        const bool several = place == Triangulation::EDGE || place == Triangulation::VERTEX;
        return several ? kIndexOnEdge : hint->info().value;
      });
}

template <typename Triangulation>
double nearest_in(const Triangulation& triangulation, Start start, const std::vector<double>& queries,
                  std::vector<std::int32_t>& points) {
  using FaceHandle = typename Triangulation::Face_handle;
  return answer_all<Triangulation>(start, queries, points,
                                   [&](const cgal::Kernel::Point_2& query, FaceHandle& hint) {
                                     const auto vertex = triangulation.nearest_vertex(query, hint);
                                     hint = vertex->face();
                                     return vertex->info().value;
                                   });
}

Corners corners_of(const cgal::Mesh& mesh, std::int32_t face) {
  if (face == kIndexOnEdge) return kOnEdge;
  return face < 0 ? kOutside : sorted_corners(&mesh.triangles[3 * static_cast<std::size_t>(face)]);
}

}  // namespace

struct CgalQueries::Implementation {
  explicit Implementation(const std::vector<double>& points)
      : coordinates(points), plain(points), with_hierarchy(points) {}
  std::vector<double> coordinates;
  Indexed<cgal::Delaunay> plain;
  Indexed<cgal::Hierarchy> with_hierarchy;
};

bool CgalQueries::is_there() { return true; }

CgalQueries::CgalQueries(const std::vector<double>& coordinates)
    : implementation_(std::make_unique<Implementation>(coordinates)) {}

std::size_t CgalQueries::triangles() const { return implementation_->plain.mesh.triangles.size() / 3; }

Located CgalQueries::locate(Start start, const std::vector<double>& queries) const {
  const auto& [coordinates, plain, with_hierarchy] = *implementation_;
  const bool by_hierarchy = start == Start::hierarchy;
  std::vector<std::int32_t> faces;
  Located located;
  located.seconds = by_hierarchy ? locate_in(with_hierarchy.triangulation, start, queries, faces)
                                 : locate_in(plain.triangulation, start, queries, faces);
  const cgal::Mesh& mesh = by_hierarchy ? with_hierarchy.mesh : plain.mesh;
  for (const std::int32_t face : faces) located.corners.push_back(corners_of(mesh, face));
  return located;
}

NearestPoints CgalQueries::nearest(Start start, const std::vector<double>& queries) const {
  const auto& [coordinates, plain, with_hierarchy] = *implementation_;
  NearestPoints nearest;
  nearest.seconds = start == Start::hierarchy
                        ? nearest_in(with_hierarchy.triangulation, start, queries, nearest.points)
                        : nearest_in(plain.triangulation, start, queries, nearest.points);
  return nearest;
}

CgalVoronoi CgalQueries::voronoi() const {
  const cgal::Delaunay& triangulation = implementation_->plain.triangulation;
  const Stopwatch watch;
  CgalVoronoi dual;
  dual.circumcentres.reserve(2 * triangulation.number_of_faces());
  for (const auto face : triangulation.finite_face_handles()) {
    const cgal::Kernel::Point_2 centre = triangulation.dual(face);
    dual.circumcentres.push_back(centre.x());
    dual.circumcentres.push_back(centre.y());
  }
  dual.points.reserve(triangulation.number_of_vertices());
  dual.cell_offsets.reserve(triangulation.number_of_vertices() + 1);
  dual.cells.reserve(3 * triangulation.number_of_faces());
  dual.cell_offsets.push_back(0);
  for (const auto vertex : triangulation.finite_vertex_handles()) {
    const auto first = triangulation.incident_faces(vertex);
    auto face = first;
    do {
      if (face->info().value >= 0) dual.cells.push_back(face->info().value);
    } while (++face != first);
    dual.points.push_back(vertex->info().value);
    dual.cell_offsets.push_back(static_cast<std::int32_t>(dual.cells.size()));
  }
  dual.seconds = watch.seconds();
  return dual;
}

bool CgalQueries::equally_far(const double* query, std::int32_t a, std::int32_t b) const {
  const auto point = [&](std::int32_t i) {
    const double* const at = &implementation_->coordinates[2 * static_cast<std::size_t>(i)];
    return cgal::Kernel::Point_2(at[0], at[1]);
  };
  return CGAL::compare_distance_to_point(cgal::Kernel::Point_2(query[0], query[1]), point(a), point(b)) ==
         CGAL::EQUAL;
}

#else

struct CgalQueries::Implementation {};
bool CgalQueries::is_there() { return false; }
CgalQueries::CgalQueries(const std::vector<double>&) { throw Error(ErrorKind::usage, "built without CGAL"); }
std::size_t CgalQueries::triangles() const { return 0; }
Located CgalQueries::locate(Start, const std::vector<double>&) const { return {}; }
NearestPoints CgalQueries::nearest(Start, const std::vector<double>&) const { return {}; }
CgalVoronoi CgalQueries::voronoi() const { return {}; }
bool CgalQueries::equally_far(const double*, std::int32_t, std::int32_t) const { return false; }

#endif

CgalQueries::~CgalQueries() = default;
CgalQueries::CgalQueries(CgalQueries&&) noexcept = default;
CgalQueries& CgalQueries::operator=(CgalQueries&&) noexcept = default;

}  // namespace flaunay::bench
