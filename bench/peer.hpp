// Other triangulators, each behind one function. They serve the benchmark only, never the library.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "contest.hpp"
#include "inputs.hpp"

namespace flaunay::bench {

struct Peer {
  std::string name;
  std::string description;                 ///< what it is and what its time includes
  Outcome (*run)(const Input&) = nullptr;  ///< null if this build is without it; all but CGAL's take one set
};

/// All of them, also those that this build is without.
const std::vector<Peer>& all_peers();

/// To triangles and neighbours in arrays, as flaunay; the sets of an input in a loop.
Outcome run_cgal(const Input& input);
Outcome run_qhull(const Input& input);
Outcome run_gts(const Input& input);

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

/// Null if this build is without CGAL.
std::unique_ptr<CgalQueries> make_cgal_queries(const std::vector<double>& coordinates);

}  // namespace flaunay::bench
