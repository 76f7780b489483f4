// Other triangulators, each behind one function in a file of its own. They serve the benchmark only, never
// the library.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bench/measuring/constraints.hpp"
#include "bench/measuring/triangulators.hpp"

namespace flaunay::bench {

struct Peer {
  std::string name, description;  ///< what it is and what its time includes
  Outcome (*run)(const Input&);   ///< all but CGAL's take one set
};

/// The peers that this build has. An object of the type below in each peer's file adds the peer.
inline std::vector<Peer>& all_peers() {
  static std::vector<Peer> peers;
  return peers;
}
struct BuiltPeer {
  explicit BuiltPeer(const Peer& peer) { all_peers().push_back(peer); }
};

// ---- CGAL's answers to the queries of flaunay's Locator

/// Where CGAL's walk to a query begins.
enum class Start {
  last_face,         ///< where the query before ended, in the order given
  last_face_sorted,  ///< the same, queries spatially sorted before; that is part of the time
  hierarchy,         ///< where Triangulation_hierarchy_2 says, in the order given
};

/// The corners, in ascending order, of the triangle that a query lies in.
using Corners = std::array<std::int32_t, 3>;
constexpr Corners kOutside{-1, -1, -1};

inline Corners sorted_corners(const std::int32_t* triangle) {
  Corners corners{triangle[0], triangle[1], triangle[2]};
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// CGAL's triangulation of some points. Answers come in the order of the queries; each function returns the
/// seconds from queries in memory to indices in memory.
class CgalQueries {
 public:
  virtual ~CgalQueries() = default;
  virtual std::size_t triangles() const = 0;
  virtual double locate(const std::vector<double>& queries, std::vector<Corners>& corners) const = 0;
  virtual double nearest(const std::vector<double>& queries, std::vector<std::int32_t>& points) const = 0;
  /// Sibson's interpolation of one value per point by natural_neighbor_coordinates_2; NaN outside of the
  /// hull.
  virtual double natural(const std::vector<double>& queries, const std::vector<double>& values,
                         std::vector<double>& results) const = 0;
  /// Circumcentres and cells; the sum of the cells' corners.
  virtual double voronoi(std::size_t& corners) const = 0;
};

// Both are null if this build is without CGAL.

inline std::unique_ptr<CgalQueries> (*make_cgal_queries)(const std::vector<double>& coordinates,
                                                         Start start) = nullptr;

/// CGAL's Constrained_Delaunay_triangulation_2 with the same predicates and segments that must not cross, by
/// its insertion of points and pairs of indices, the sets of an input in a loop; to triangles and neighbours
/// in arrays. For polygons, only the triangles inside, found by crossing edges from the outside, as CGAL's
/// manual does.
inline Outcome (*run_cgal_constrained)(const ConstrainedInput& input) = nullptr;

// ---- Points on a sphere

/// CGAL's Delaunay_triangulation_on_sphere_2 of directions, x y z each, projected to the sphere as its
/// traits do, and sorted: the seconds, and the number of triangles. Null if this build is without CGAL.
inline Outcome (*run_cgal_on_sphere)(const std::vector<double>& directions) = nullptr;

// ---- Points on a torus

/// CGAL's Periodic_2_Delaunay_triangulation_2 of points in the unit square, sorted: the seconds, and the
/// number of triangles. Null if this build is without CGAL.
inline Outcome (*run_cgal_periodic)(const std::vector<double>& coordinates) = nullptr;

// ---- Weighted points

/// CGAL's Regular_triangulation_2 of points with weights, which it sorts: the seconds, and the number of
/// triangles. Null if this build is without CGAL.
inline Outcome (*run_cgal_weighted)(const std::vector<double>& points,
                                    const std::vector<double>& weights) = nullptr;

// ---- Refined meshes

/// The goals of refinement: a smallest angle in degrees, and a largest area; 0 for any.
struct Wanted {
  double min_angle, max_area;
};

/// A refined mesh of all sets of an input, for looking at, and the times until there was one.
struct Refined {
  double seconds = 0, processor_seconds = 0;
  std::vector<double> coordinates;      ///< x and y per point
  std::vector<std::int32_t> triangles;  ///< three points each
};

/// For each set of polygons a place in each of their holes, which are seen from the mean of their points.
inline std::vector<std::vector<double>> places_in_holes(const ConstrainedInput& input) {
  std::vector<std::vector<double>> places;
  for (std::size_t p = 0; p + 1 < input.polygon_offsets.size(); ++p) {
    places.emplace_back();
    for (std::size_t ring = input.polygon_offsets[p] + 1; ring < input.polygon_offsets[p + 1]; ++ring) {
      double sums[2] = {0, 0};
      const std::size_t first = input.ring_offsets[ring], last = input.ring_offsets[ring + 1];
      for (std::size_t i = 2 * first; i < 2 * last; ++i) sums[i % 2] += input.points.coordinates[i];
      for (const double sum : sums) places.back().push_back(sum / static_cast<double>(last - first));
    }
  }
  places.resize(input.points.sets());
  return places;
}

// From points, segments and places in holes to meshes, the sets of an input in a loop; of points without
// segments, their hull is meshed. Null if this build is without them.

/// CGAL's Delaunay_mesher_2 on a Constrained_Delaunay_triangulation_2; it knows no areas.
inline Refined (*refine_by_cgal)(const ConstrainedInput& input, const Wanted& wanted) = nullptr;
/// Triangle 1.6.
inline Refined (*refine_by_triangle)(const ConstrainedInput& input, const Wanted& wanted) = nullptr;

}  // namespace flaunay::bench
