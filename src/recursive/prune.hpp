// The host's twin of the stage `prune`: drops what cannot be on a region's hull.
#pragma once

#include <cstdint>
#include <vector>

#include "recursive/counter.hpp"
#include "recursive/line.hpp"

namespace flaunay::recursive {

/// What prune says of a point.
enum class Kept : std::uint8_t {
  no,   ///< not on the hull
  yes,  ///< it may be
  end,  ///< it is one of the two ends
};

/// Prunes by the chords of one path.
class Prune {
 public:
  /// path: at least its two ends. keep_on: keep also what lies on the path, and of the column of its last
  /// vertex all.
  Prune(const Predicates& predicates, const Line& line, const Path& path, bool keep_on, Counter& counter);

  /// points sorted along the line, either way. A search for every kBucket of them at least, and a depth for
  /// those that are near enough to the line.
  std::vector<Kept> sorted(const std::vector<HullPoint>& points);
  /// points in any order. A search for each.
  std::vector<Kept> unsorted(const std::vector<HullPoint>& points);

 private:
  void make_bands();
  bool is_above_band(const HullPoint& p, std::size_t low);
  std::size_t walk(std::size_t low, double u);
  Kept held_against(const HullPoint& p, std::size_t low);

  const Predicates& predicates_;
  const Line& line_;
  const Path& path_;
  bool keep_on_;
  Counter& counter_;
  std::vector<double> bands_;  // by path vertex: what rises above is not below the chord to the next
};

/// Consecutive points of which one is a candidate.
constexpr std::size_t kBucket = 16;

/// A path over points sorted along the line, good enough to prune by: quickhull of the points nearest to the
/// line in each bucket, which are pruned in the same way while they are many.
Path chord_path(const Predicates& predicates, const Line& line, const HullPoint& first, const HullPoint& last,
                const std::vector<HullPoint>& points, Counter& counter, LevelStatistics& statistics);

/// The last vertex with u no greater than the given one; the first if there is none.
std::size_t search_path(const Path& path, double u, Counter& counter);

/// Those that are flagged Kept::yes.
std::vector<HullPoint> pick(const std::vector<HullPoint>& points, const std::vector<Kept>& kept);

}  // namespace flaunay::recursive
