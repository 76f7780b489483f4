#include "recursive/lower_hull.hpp"

#include <algorithm>

#include "recursive/quickhull.hpp"

namespace flaunay::recursive {
namespace {

LowerHull by_prune(const Predicates& predicates, const HullPoints& points, Counter& counter,
                   LevelStatistics& statistics) {
  const Path chords =
      chord_path(predicates, points.line, points.first, points.last, points.internal, counter, statistics);
  Prune prune(predicates, points.line, chords, false, counter);
  std::vector<HullPoint> survivors = pick(points.internal, prune.sorted(points.internal));
  LowerHull hull;
  hull.corners = prune.unsorted(points.corners);
  const std::vector<HullPoint> border = pick(points.corners, hull.corners);
  survivors.insert(survivors.end(), border.begin(), border.end());
  statistics.survivors += survivors.size();
  int rounds = 0;
  Quickhull quickhull(predicates, points.line, counter);
  hull.path = quickhull.run(points.first, points.last, survivors, kMostQuickhullRounds, rounds);
  quickhull.strict(hull.path);
  statistics.hull_rounds = std::max(statistics.hull_rounds, rounds);
  return hull;
}

Path by_quickhull(const Predicates& predicates, const HullPoints& points, std::size_t balanced_from,
                  Counter& counter, LevelStatistics& statistics) {
  std::vector<HullPoint> all = points.internal;
  all.insert(all.end(), points.corners.begin(), points.corners.end());
  int rounds = 0;
  Quickhull quickhull(predicates, points.line, counter);
  Path path = quickhull.run(points.first, points.last, all, balanced_from, rounds);
  quickhull.strict(path);
  statistics.hull_rounds = std::max(statistics.hull_rounds, rounds);
  return path;
}

// Andrew's scan (1979) from left to right, of points ascending in u.
Path by_monotone_chain(const Predicates& predicates, const HullPoints& points, Counter& counter) {
  const auto before = [&counter](const HullPoint& a, const HullPoint& b) {
    counter.arithmetic();
    return a.u() < b.u();
  };
  std::vector<HullPoint> internal = points.internal;
  if (!internal.empty() && internal.front().u() > internal.back().u()) {
    std::reverse(internal.begin(), internal.end());
  }
  std::vector<HullPoint> corners = points.corners;
  std::sort(corners.begin(), corners.end(), before);
  std::vector<HullPoint> all(internal.size() + corners.size());
  std::merge(internal.begin(), internal.end(), corners.begin(), corners.end(), all.begin(), before);

  const Line& line = points.line;
  const auto is_below = [&](const HullPoint& a, const HullPoint& b, const HullPoint& p) {
    counter.depth();
    return predicates.depth(a.place, b.place, p.place, line.q, line.planar()).sign > 0;
  };
  Path path(1, points.first);
  for (const HullPoint& p : all) {
    counter.arithmetic();
    if (p.u() == path.back().u()) {
      // Of one column only the lowest counts.
      if (p.id == path.back().id) continue;
      counter.arithmetic(4);
      if (!line.is_lower(p.place, path.back().place)) continue;
      path.pop_back();
    }
    while (path.size() > 1 && !is_below(path[path.size() - 2], p, path.back())) path.pop_back();
    path.push_back(p);
  }
  counter.sequential();
  return path;
}

}  // namespace

LowerHull lower_hull(const Predicates& predicates, const HullPoints& points, Hull variant, Counter& counter,
                     LevelStatistics& statistics) {
  if (variant == Hull::prune) return by_prune(predicates, points, counter, statistics);
  LowerHull hull;
  hull.corners.assign(points.corners.size(), Kept::yes);
  if (variant == Hull::monotone_chain) {
    hull.path = by_monotone_chain(predicates, points, counter);
  } else {
    const std::size_t balanced_from = variant == Hull::balanced ? kRoundsBeforeBalance : kMostQuickhullRounds;
    hull.path = by_quickhull(predicates, points, balanced_from, counter, statistics);
  }
  return hull;
}

}  // namespace flaunay::recursive
