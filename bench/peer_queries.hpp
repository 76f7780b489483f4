// CGAL's answers to what flaunay's Locator answers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace flaunay::bench {

/// Where CGAL's walk to a query begins.
enum class Start {
  last_face,         ///< where the query before ended, in the order given
  last_face_sorted,  ///< the same, queries spatially sorted before; that is part of the time
  hierarchy,         ///< where Triangulation_hierarchy_2 says, in the order given
};
std::string to_string(Start start);

/// The corners, in ascending order, of the triangle that a query lies in; or one of the following.
using Corners = std::array<std::int32_t, 3>;
constexpr Corners kOutside{-1, -1, -1};
constexpr Corners kOnEdge{-2, -2, -2};  ///< or on a vertex: in several triangles

Corners sorted_corners(const std::int32_t* triangle);

/// Answers in the order of the queries. Seconds are from queries in memory to indices in memory.
struct Located {
  double seconds = 0;
  std::vector<Corners> corners;
};
struct NearestPoints {
  double seconds = 0;
  std::vector<std::int32_t> points;
};

/// The dual of its triangulation: cell_offsets and cells as in flaunay's Voronoi, the cells' points beside
/// them.
struct CgalVoronoi {
  double seconds = 0;
  std::vector<double> circumcentres;
  std::vector<std::int32_t> points, cell_offsets, cells;
};

/// CGAL's triangulation of some points, twice: plain and with a hierarchy.
class CgalQueries {
 public:
  /// Whether this build has CGAL.
  static bool is_there();
  explicit CgalQueries(const std::vector<double>& coordinates);
  ~CgalQueries();
  CgalQueries(CgalQueries&&) noexcept;
  CgalQueries& operator=(CgalQueries&&) noexcept;

  std::size_t triangles() const;
  Located locate(Start start, const std::vector<double>& queries) const;
  NearestPoints nearest(Start start, const std::vector<double>& queries) const;
  CgalVoronoi voronoi() const;
  /// Whether two points are equally far from a query, exactly.
  bool equally_far(const double* query, std::int32_t a, std::int32_t b) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flaunay::bench
