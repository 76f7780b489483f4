// Answers queries on a triangulation: the containing triangle, the nearest point.
#pragma once

#include <memory>

#include "derived/locate/levels.hpp"
#include "launchers/locate/locate.cl.hpp"
#include "locate/records.h"
#include "mesh/records.h"
#include "points/cut_tree.hpp"
#include "points/device_mesh.hpp"
#include "points/query_range.hpp"
#include "points/records.h"

namespace flaunay::locate {

/// The search structure of a triangulation in device memory, about 80 bytes per point. In fixed point,
/// coordinates are 64-bit integers.
struct Locator {
  std::size_t sets = 0;
  std::vector<std::size_t> point_offsets{};  ///< of the caller's points
  points::PointRange range{};
  /// The vertices of triangles, in the order of their first triangles: coordinates, indices of points, first
  /// triangles, and the squared distances to their nearest neighbours (the upper half of a double, or in
  /// fixed point a float).
  host::Buffer<cl_double2> points{};
  host::Buffer<cl_int> source{}, first_triangle{}, clearances{};
  /// On a torus or a cylinder, by vertex the one for the same point within the period. All its triangles are
  /// there; at the rim, images lack some. Empty in the plane.
  host::Buffer<cl_int> in_place{};
  host::Buffer<kernel::face> faces{};  ///< triangles, as numbers of vertices
  host::Buffer<cl_double2> hull_points{};
  host::Buffer<cl_int> hull{};
  host::Buffer<kernel::mesh_set> records{};  ///< one per set
  host::Buffer<kernel::cut_node> nodes{};    ///< the nodes of all trees
  host::Buffer<cl_int> starts{};             ///< per leaf of all trees: where walks begin
  host::Buffer<cl_int> first_vertices{};     ///< the first vertex of each set, and the number of all
  std::size_t most_triangles = 0;            ///< of one set
  bool has_clearances = false;               ///< measured only when queries for nearest points come
  /// For a mesh with constraints, which has one set: the triangles before `kept` are its own, and the others
  /// fill it up to the convex hull. visible: its own faces, without neighbours beyond constraints and its
  /// border.
  bool is_constrained = false;
  std::size_t kept = 0;
  host::Buffer<kernel::face> visible{};
  /// For the search for nearest points. Levels are made when a query first needs them.
  Levels levels{};
  Triangulate triangulate = nullptr;         ///< makes the levels of samples
  std::shared_ptr<const Locator> samples{};  ///< the locator of the levels' samples, each of them a set

  bool has_images() const { return in_place.size() > 0; }
  operator kernels::walked_mesh() const {
    return {.points = points, .faces = faces, .first_triangle = first_triangle};
  }
};

/// Makes a locator. Its buffers come from `own`, which must exist as long as the locator. Throws Error(input)
/// if the indices are not a triangulation with neighbours, and for points that are not accepted for
/// triangulation. Waits about 6 times, and once more for several sets. O(n log n).
geometry::Fitted<Locator> make_locator(host::Runtime& runtime, host::Arena& own,
                                       const points::DeviceMesh& mesh, Triangulate triangulate);

/// Makes a locator one of a mesh with constraints. constrained: three per triangle that is kept, whether the
/// edge opposite to the corner is a constraint; there are no queries for nearest points then. Waits once.
void constrain(host::Runtime& runtime, host::Arena& own, const std::vector<cl_uchar>& constrained,
               Locator& locator);

/// Makes a locator without trees, of points that are scaled already. Not for queries of callers.
Locator make_walk_locator(host::Runtime& runtime, host::Arena& own, const points::DeviceMesh& mesh);

/// Computes the clearances, which the search for nearest points needs. Does not wait.
void measure_clearances(host::Runtime& runtime, Locator& locator);

// Queries are m points, x0 y0 x1 y1 ..., with the alignment of doubles; set s has queries [query_offsets[s],
// query_offsets[s + 1]). Each call waits 2 times, or 3 if sets need different scalings, to check that all
// queries are finite, and neither too fine nor too far away for exact arithmetic with the points; otherwise
// it throws Error(input), which names a query. Then it enqueues the rest. Many queries are sorted by the
// leaves of the trees first, which takes one more wait. Temporary memory: 24 m bytes, or 32 m if queries are
// sorted.

/// Finds for each query the triangle that contains it, the smallest one if there are several; -1 outside of
/// the hull.
geometry::Fitted<geometry::Done> locate(host::Runtime& runtime, const Locator& locator,
                                        const host::Buffer<cl_double>& queries, std::size_t m,
                                        const std::vector<std::size_t>& query_offsets,
                                        const host::Buffer<cl_int>& triangles);

/// Finds for each query the nearest point, the lexicographically first one if there are several, as the index
/// of its representative; -1 if the set is empty. About O(log n) steps per query, except at a vertex with
/// very many neighbours that are no fan and are all about as near. If a query is far to walk to, makes the
/// locator's levels; until there are levels, waits once more. The first call measures the clearances, and
/// waits once more for that.
geometry::Fitted<geometry::Done> nearest(host::Runtime& runtime, Locator& locator,
                                         const host::Buffer<cl_double>& queries, std::size_t m,
                                         const std::vector<std::size_t>& query_offsets,
                                         const host::Buffer<cl_int>& points);

/// The queries of one call, in the order in which kernels answer them, with their triangles.
struct LocatedQueries {
  float orient_bound = 0;  ///< of the queries' orientations, see predicates/bounds.h
  cl_int sets = 0;
  host::Buffer<kernel::query_frame> frames{};  ///< by set
  host::Buffer<cl_int> query_offsets{};        ///< by set; not filled if there is one set
  host::Buffer<cl_int> order{};                ///< per place, the number of its query
  host::Buffer<cl_double2> placed{};           ///< per place, the scaled query
  host::Buffer<cl_int> found{};                ///< per place, the triangle; less than 0 outside of the hull

  operator kernels::placed_queries() const {
    return {.sets = sets, .query_offsets = query_offsets, .frames = frames, .order = order, .placed = placed};
  }
};

/// Finds the triangle of each query with doubles, for kernels that continue from there. The result is
/// allocated in the runtime's arena, in the caller's scope. limits: of these kernels' predicates.
LocatedQueries locate_by_place(host::Runtime& runtime, const Locator& locator,
                               const host::Buffer<cl_double>& queries, std::size_t m,
                               const std::vector<std::size_t>& query_offsets,
                               const points::QueryLimits& limits = points::kOrientLimits);

}  // namespace flaunay::locate
