#include "modes/recursive/lower_hull.hpp"

#include <algorithm>

#include "flattened/limits.h"
#include "geometry/sort.hpp"
#include "modes/recursive/quickhull.hpp"

namespace flaunay::recursive {
using namespace geometry;
using namespace statistics;

namespace {

// Counts the projections of points. Internal points are projected first; corners only when they are needed.
void count_projections(const std::vector<HullPoint>& points, Counter& counter) {
  counter.arithmetic(kernel::PROJECT_OPERATIONS * points.size());
}

Path by_quickhull(const Predicates& predicates, const HullPoints& points, std::size_t balanced_from,
                  Counter& counter, LevelStatistics& statistics) {
  std::vector<HullPoint> all = points.internal;
  all.insert(all.end(), points.corners.begin(), points.corners.end());
  statistics.survivors = all.size();
  count_projections(points.corners, counter);
  counter.arithmetic(2 * kernel::PROJECT_OPERATIONS);
  Quickhull quickhull(predicates, points.line, balanced_from, counter);
  Path path = quickhull.run(points.first, points.last, all, statistics.hull_rounds);
  quickhull.strict(path);
  return path;
}

// Andrew's scan (1979) over points in ascending order of u.
Path by_monotone_chain(const Predicates& predicates, const HullPoints& points, Counter& counter) {
  const auto before = [](const HullPoint& a, const HullPoint& b) { return a.u() < b.u(); };
  std::vector<HullPoint> internal = points.internal;
  if (!internal.empty() && internal.front().u() > internal.back().u()) {
    std::reverse(internal.begin(), internal.end());
  }
  std::vector<HullPoint> corners = points.corners;
  std::stable_sort(corners.begin(), corners.end(), before);
  std::vector<HullPoint> all(internal.size() + corners.size());
  std::merge(internal.begin(), internal.end(), corners.begin(), corners.end(), all.begin(), before);
  count_projections(corners, counter);
  counter.arithmetic(comparisons_to_sort(corners.size()) + all.size());

  const Line& line = points.line;
  const auto is_below = [&](const HullPoint& a, const HullPoint& b, const HullPoint& p) {
    counter.depth();
    return line.depth(predicates, a, b, p).sign > 0;
  };
  Path path(1, points.first);
  for (const HullPoint& p : all) {
    counter.arithmetic();
    if (p.u() == path.back().u()) {
      // Among points of equal u, only the lowest can be a vertex.
      if (p.id == path.back().id) continue;
      counter.arithmetic(kernel::LOWER_OPERATIONS);
      if (!line.is_lower(p, path.back())) continue;
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
  LevelStatistics own;
  LowerHull hull;
  count_projections(points.internal, counter);
  counter.critical_path(kernel::PROJECT_OPERATIONS);
  if (variant == Hull::prune) {
    hull = pruned_hull(predicates, points, counter, own);
  } else {
    hull.corners.assign(points.corners.size(), Kept::yes);
    const std::size_t balanced_from =
        variant == Hull::balanced ? kernel::ROUNDS_BEFORE_BALANCE : kernel::MOST_QUICKHULL_ROUNDS;
    hull.path = variant == Hull::monotone_chain
                    ? by_monotone_chain(predicates, points, counter)
                    : by_quickhull(predicates, points, balanced_from, counter, own);
  }
  add_part(statistics, own);
  return hull;
}

}  // namespace flaunay::recursive
