// The host's twin of the stage `prune`: drops what cannot be on a region's hull.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recursive/counter.hpp"
#include "recursive/line.hpp"

namespace flaunay::recursive {

/// What prune says of a point.
enum class Kept : std::uint8_t {
  no,       ///< not on the hull
  yes,      ///< below the path, or with keep_on on it
  on_path,  ///< a vertex of the path
};

/// A point against a path.
struct Held {
  Kept kept = Kept::no;
  std::size_t chord = 0;  ///< of what is kept: the vertex whose chord to the next one it is below
  double depth = 0;       ///< how far, rounded
};

/// All of a region's points against a path.
struct Pruned {
  std::vector<Held> internal, corners;
};

/// Prunes by the chords of one path.
class Prune {
 public:
  /// path: at least its two ends. keep_on: keep also what lies on the path, and of the column of its last
  /// vertex all.
  Prune(const Predicates& predicates, const Line& line, const Path& path, bool keep_on, Counter& counter);

  /// A search for every kBucket internal points and for each corner, and a depth for those that are near
  /// enough to the line. points: taken to be projected, but for corners.
  Pruned run(const HullPoints& points);

 private:
  void make_bands();
  std::vector<Held> sorted(const std::vector<HullPoint>& points);
  std::vector<Held> unsorted(const std::vector<HullPoint>& points);
  bool is_above_band(const HullPoint& p, std::size_t low);
  std::size_t walk(std::size_t low, double u);
  Held held_against(const HullPoint& p, std::size_t low);

  const Predicates& predicates_;
  const Line& line_;
  const Path& path_;
  bool keep_on_;
  Counter& counter_;
  std::vector<double> bands_;  // by path vertex: what rises above is not below the chord to the next
};

/// Consecutive points of which one is a candidate.
constexpr std::size_t kBucket = 16;

/// A hull by prune, and what came of it.
struct PrunedHull {
  Path path;
  std::vector<Kept> corners;
  std::size_t survivors = 0;
  int rounds = 0;  ///< of quickhull on the survivors
};

/// The strict lower hull: what is below the chords of a path over candidates, one a bucket, is all that
/// quickhull has to look at, from that path on. The candidates' own path is found in the same way while they
/// are many. statistics: candidates and their rounds are added. points: taken to be projected, but for
/// corners.
PrunedHull pruned_hull(const Predicates& predicates, const HullPoints& points, Counter& counter,
                       LevelStatistics& statistics);

/// The last vertex with u no greater than the given one; the first if there is none. Takes
/// search_comparisons(path.size()), which the caller counts.
std::size_t search_path(const Path& path, double u);

/// Those that are flagged Kept::yes.
std::vector<HullPoint> pick(const std::vector<HullPoint>& points, const std::vector<Held>& held);

}  // namespace flaunay::recursive
