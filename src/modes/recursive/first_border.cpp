#include "modes/recursive/first_border.hpp"

#include <algorithm>

#include "modes/recursive/lower_hull.hpp"

namespace flaunay::recursive {
using namespace geometry;
using namespace statistics;

namespace {

using Ids = std::vector<std::int32_t>;

// The points on the lower hull and its edges, among the points from `first` to `last` of a planar frame,
// which are in the order of u.
std::vector<HullPoint> planar_hull(const Predicates& predicates, const HullPoints& points, Hull variant,
                                   OperationCounts& work) {
  Counter counter;
  LevelStatistics ignored;
  // The last vertex was found by a search.
  counter.arithmetic(search_comparisons(points.internal.size()));
  counter.critical_path(search_comparisons(points.internal.size()));
  const LowerHull hull = lower_hull(predicates, points, variant, counter, ignored);
  Prune prune(predicates, points.line, hull.path, true, counter);
  const std::vector<Held> held = prune.run(points).internal;
  std::vector<HullPoint> on_hull;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (held[i].kept == Kept::yes) on_hull.push_back(points.internal[i]);
  }
  add_beside(work, counter.counts());
  return on_hull;
}

}  // namespace

Border first_border(const PointSets& sets, std::int32_t low, std::int32_t high, Hull variant,
                    OperationCounts& work) {
  if (low == high) return {};
  const auto x_of = [&](std::int32_t id) { return sets.points[id].x; };
  // The end of the first column, and the beginning of the last one.
  const auto begin = sets.points.begin() + low, end = sets.points.begin() + high;
  const auto behind_first =
      std::upper_bound(begin, end, x_of(low), [](double x, Point p) { return x < p.x; });
  const auto last = std::lower_bound(begin, end, x_of(high - 1), [](Point p, double x) { return p.x < x; });
  const auto last_of_first = low + static_cast<std::int32_t>(behind_first - begin) - 1;
  const auto first_of_last = low + static_cast<std::int32_t>(last - begin);

  const Line below{kernel::AXIS_PLANAR_LOWER, sets.points[low].y};
  const Line above{kernel::AXIS_PLANAR_UPPER, -sets.points[high - 1].y};
  const auto placed = [&](const Line& line, std::int32_t id) {
    return line.at(id, line.place(sets.points[id]));
  };
  HullPoints lower{below, placed(below, low), placed(below, first_of_last), {}, {}};
  HullPoints upper{above, placed(above, high - 1), placed(above, last_of_first), {}, {}};
  for (std::int32_t id = low; id < high; ++id) lower.internal.push_back(placed(below, id));
  for (std::int32_t id = high; id-- > low;) upper.internal.push_back(placed(above, id));

  const std::vector<HullPoint> there = planar_hull(sets.predicates, lower, variant, work);
  const std::vector<HullPoint> back = planar_hull(sets.predicates, upper, variant, work);
  const auto count = static_cast<std::size_t>(high - low);
  if (there.size() == count && back.size() == count) return {};
  // The first and the last point are on both hulls, so they are taken from one only.
  Ids cycle;
  for (const HullPoint& p : there) cycle.push_back(p.id);
  for (std::size_t k = 1; k + 1 < back.size(); ++k) cycle.push_back(back[k].id);
  Border border;
  for (std::size_t k = 0; k < cycle.size(); ++k) {
    border.push_back(
        {cycle[k == 0 ? cycle.size() - 1 : k - 1], cycle[k], cycle[k + 1 == cycle.size() ? 0 : k + 1]});
  }
  return border;
}

}  // namespace flaunay::recursive
