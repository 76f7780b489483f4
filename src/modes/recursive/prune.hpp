// The stage `prune` on the host: discards points that cannot be on a region's hull.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "modes/recursive/line.hpp"
#include "statistics/counter.hpp"

namespace flaunay::recursive {

/// The result of prune for a point.
enum class Kept : std::uint8_t {
  no,       ///< it is not on the hull
  yes,      ///< it is below the path, or with keep_on on the path
  on_path,  ///< it is a vertex of the path
};

/// A point compared with a path.
struct Held {
  Kept kept = Kept::no;
  std::size_t chord = 0;  ///< for kept points: the vertex at which the chord above the point begins
  double depth = 0;       ///< for kept points: the depth below that chord, rounded
};

/// All points of a region, compared with a path.
struct Pruned {
  std::vector<Held> internal, corners;
};

/// Prunes by the chords of one path.
class Prune {
 public:
  /// path: has at least its two ends. keep_on: also keep points on the path, and all points with the u of its
  /// last vertex.
  Prune(const geometry::Predicates& predicates, const Line& line, const Path& path, bool keep_on,
        statistics::Counter& counter);

  /// Compares all points with the path. Takes a search per kernel::BUCKET internal points and per corner, and
  /// computes depths for the points that are near enough to the line. The projections of internal points must
  /// be known; they are not counted.
  Pruned run(const HullPoints& points);

 private:
  void make_bands();
  std::vector<Held> sorted(const std::vector<HullPoint>& points);
  std::vector<Held> unsorted(const std::vector<HullPoint>& points);
  bool is_above_band(const HullPoint& p, std::size_t low);
  std::size_t walk(std::size_t low, double u);
  Held held_against(const HullPoint& p, std::size_t low);

  const geometry::Predicates& predicates_;
  const Line& line_;
  const Path& path_;
  bool keep_on_;
  statistics::Counter& counter_;
  std::vector<double> bands_;  // per path vertex: higher points are not below the chord to the next vertex
};

struct LowerHull {
  Path path;
  std::vector<Kept> corners;  ///< Kept::no for corners that are known not to be on the path
};

/// Computes the strict lower hull. Takes one candidate per bucket and computes the path of the candidates, in
/// the same way as long as they are many. Quickhull then refines that path by the points below its chords.
/// statistics: receives the numbers of candidates, survivors and rounds. The projections of internal points
/// must be known; they are not counted.
LowerHull pruned_hull(const geometry::Predicates& predicates, const HullPoints& points,
                      statistics::Counter& counter, statistics::LevelStatistics& statistics);

/// The last vertex whose u is not greater than the given one; the first vertex if all are greater. Takes
/// search_comparisons(path.size()) comparisons, which the caller counts.
std::size_t search_path(const Path& path, double u);

}  // namespace flaunay::recursive
