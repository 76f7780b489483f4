// Other triangulators, each behind one function in a file of its own. They serve the benchmark only, never
// the library.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/measuring/constraints.hpp"
#include "bench/measuring/contest.hpp"

namespace flaunay::bench {

struct Peer {
  std::string name;
  std::string description;                 ///< what it is and what its time includes
  Outcome (*run)(const Input&) = nullptr;  ///< null if this build is without it; all but CGAL's take one set
};

/// All of them, also those that this build is without.
std::vector<Peer>& all_peers();

/// An object of this type in the file of a peer says that this build has it.
struct BuiltPeer {
  BuiltPeer(const std::string& name, Outcome (*run)(const Input&));
};

/// What became of a peer in a process of its own.
struct Trial {
  std::size_t bytes_peak = 0;  ///< most resident memory during the run, less what was resident before
  std::string failure;         ///< empty if it went well
};

/// Runs a peer once in a child process, which is ended after `limit` seconds; see ask_child.
Trial try_peer(const std::function<Outcome(const Input&)>& run, const Input& input, double limit);

// ---- CGAL's answers to what flaunay's Locator answers

/// Where CGAL's walk to a query begins.
enum class Start {
  last_face,         ///< where the query before ended, in the order given
  last_face_sorted,  ///< the same, queries spatially sorted before; that is part of the time
  hierarchy,         ///< where Triangulation_hierarchy_2 says, in the order given
};

/// The corners, in ascending order, of the triangle that a query lies in; or one of the following.
using Corners = std::array<std::int32_t, 3>;
constexpr Corners kOutside{-1, -1, -1};
constexpr Corners kOnEdge{-2, -2, -2};  ///< or on a vertex: in several triangles

Corners sorted_corners(const std::int32_t* triangle);

/// CGAL's triangulation of some points, plain and with a hierarchy. Answers come in the order of the queries;
/// each function returns the seconds from queries in memory to indices in memory.
class CgalQueries {
 public:
  virtual ~CgalQueries() = default;
  virtual std::size_t triangles() const = 0;
  virtual double locate(Start start, const std::vector<double>& queries,
                        std::vector<Corners>& corners) const = 0;
  virtual double nearest(Start start, const std::vector<double>& queries,
                         std::vector<std::int32_t>& points) const = 0;
  /// Sibson's interpolation of one value per point by natural_neighbor_coordinates_2; NaN outside of the
  /// hull.
  virtual double natural(Start start, const std::vector<double>& queries, const std::vector<double>& values,
                         std::vector<double>& results) const = 0;
  /// Circumcentres and cells; how many corners the cell of each point has.
  virtual double voronoi(std::vector<std::int32_t>& cell_sizes) const = 0;
  /// Whether two points are equally far from a query, exactly.
  virtual bool equally_far(const double* query, std::int32_t a, std::int32_t b) const = 0;
};

// Both are null if this build is without CGAL.

inline std::unique_ptr<CgalQueries> (*make_cgal_queries)(const std::vector<double>& coordinates) = nullptr;

/// CGAL's Constrained_Delaunay_triangulation_2 with the same predicates and segments that must not cross, the
/// sets of an input in a loop; to triangles and neighbours in arrays.
enum class CgalInsertion {
  range,   ///< by CGAL's own insertion of points and pairs of indices
  sorted,  ///< points in spatial order, then the segments in the order of their first points
};
/// inside: of polygons, only the triangles inside, found by crossing edges from the outside, as CGAL's manual
/// has it.
inline Outcome (*run_cgal_constrained)(const ConstrainedInput& input, CgalInsertion insertion,
                                       bool inside) = nullptr;

}  // namespace flaunay::bench
