#include "modes/recursive/run.hpp"

#include <algorithm>
#include <utility>

#include "geometry/sort.hpp"
#include "modes/recursive/border_merge.hpp"
#include "modes/recursive/endgame.hpp"
#include "modes/recursive/first_border.hpp"
#include "modes/recursive/lower_hull.hpp"
#include "operations/counters.h"

namespace flaunay::recursive {
using namespace geometry;
using namespace statistics;

namespace {

using Ids = std::vector<std::int32_t>;

// A region, which is a union of Delaunay triangles: its internal points in both orders, and its border.
struct Region {
  Ids by_x, by_y;
  Border border;
};

// The level to which work before the first cut is counted.
constexpr int kStart = -1;

class Recursion {
 public:
  Recursion(const PointSets& sets, const research::Options& options, const SolveRegion& solve_large,
            research::Triangulation& result)
      : sets_(sets),
        predicates_(sets.predicates),
        points_(sets.points),
        options_(options),
        solve_large_(solve_large),
        result_(result),
        on_border_(sets.points.size(), 0) {}

  Ids run() {
    for (std::size_t s = 0; s + 1 < sets_.set_offsets.size(); ++s) {
      Region region = whole_set(sets_.set_offsets[s], sets_.set_offsets[s + 1]);
      if (!region.border.empty()) divide(std::move(region), 0);
    }
    if (options_.count) result_.work = std::move(work_);
    return std::move(triangles_);
  }

 private:
  // Figure 1 of the paper. No merge follows: all work is done on the way down.
  void divide(Region region, int level) {
    if (region.by_x.empty()) {
      finish(region.border, level - 1);
      return;
    }
    note_region(region, level);
    const Line line = cut(region, level);
    const LowerHull hull = dividing_path(region, line, level);
    std::array<Region, 2> parts = split(region, line, hull, level);
    region = Region();
    for (Region& part : parts) {
      if (!part.border.empty()) divide(std::move(part), level + 1);
    }
  }

  Region whole_set(std::int32_t low, std::int32_t high);
  Line cut(const Region& region, int level);
  LowerHull dividing_path(const Region& region, const Line& line, int level);
  std::array<Region, 2> split(const Region& region, const Line& line, const LowerHull& hull, int level);
  void finish(const Border& border, int level);

  void note_region(const Region& region, int level);
  LevelStatistics& level_statistics(int level) { return result_.levels[level]; }
  void note_work(Component component, int level, const OperationCounts& counts) {
    add_beside(part_of(level == kStart ? work_.start : work_.levels[level], component), counts);
  }

  const PointSets& sets_;
  const Predicates& predicates_;
  const std::vector<Point>& points_;
  const research::Options& options_;
  const SolveRegion& solve_large_;
  research::Triangulation& result_;
  Work work_;
  std::vector<char> on_border_;  // per id: whether the point is on the border of a region
  Ids triangles_;
};

Region Recursion::whole_set(std::int32_t low, std::int32_t high) {
  OperationCounts hull;
  Counter sorting;
  Region region;
  region.border = first_border(sets_, low, high, options_.hull, hull);
  note_work(Component::hull, kStart, hull);
  for (const Corner& corner : region.border) on_border_[corner.vertex] = 1;
  const auto count = static_cast<std::size_t>(high - low);
  sorting.arithmetic(comparisons_to_sort(count));
  sorting.critical_path(depth_of_sort(count));
  note_work(Component::cut, kStart, sorting.counts());
  if (region.border.empty()) return region;
  std::vector<Keyed> by_y;
  for (std::int32_t id = low; id < high; ++id) {
    by_y.push_back({sort_key(points_[id].y), id});
    if (!on_border_[id]) region.by_x.push_back(id);
  }
  sort_by_key(by_y);
  for (const Keyed& point : by_y) {
    if (!on_border_[point.index]) region.by_y.push_back(point.index);
  }
  return region;
}

// Cuts at the median, across the longer interquartile range, which keeps regions round and borders short.
Line Recursion::cut(const Region& region, int level) {
  const std::size_t count = region.by_x.size();
  const auto x = [&](std::size_t k) { return points_[region.by_x[k]].x; };
  const auto y = [&](std::size_t k) { return points_[region.by_y[k]].y; };
  int axis = level % 2 == 0 ? kernel::AXIS_X : kernel::AXIS_Y;
  if (options_.cut == Cut::interquartile) {
    const std::size_t lower = count / 4, upper = 3 * count / 4;
    axis = y(upper) - y(lower) > x(upper) - x(lower) ? kernel::AXIS_Y : kernel::AXIS_X;
    Counter counter;
    counter.arithmetic(kernel::CUT_OPERATIONS);
    counter.sequential();
    note_work(Component::cut, level, counter.counts());
  }
  return {axis, axis == kernel::AXIS_X ? x(count / 2) : y(count / 2)};
}

// The lower hull of the points projected to the paraboloid over the line's middle and from there along the
// line: a path of Delaunay edges that separates left from right.
LowerHull Recursion::dividing_path(const Region& region, const Line& line, int level) {
  Counter counter;
  HullPoints points{line, {}, {}, {}, {}};
  for (const std::int32_t id : line.axis == kernel::AXIS_X ? region.by_y : region.by_x) {
    points.internal.push_back(line.at(id, line.place(points_[id])));
  }
  for (const Corner& corner : region.border) {
    points.corners.push_back(line.at(corner.vertex, line.place(points_[corner.vertex])));
  }
  const auto comes_before = [&](const HullPoint& a, const HullPoint& b) {
    return a.u() != b.u() ? a.u() < b.u() : line.is_lower(a, b);
  };
  points.first = points.last = points.corners[0];
  for (const HullPoint& p : points.corners) {
    if (comes_before(p, points.first)) points.first = p;
    if (p.u() != points.last.u() ? p.u() > points.last.u() : line.is_lower(p, points.last)) points.last = p;
  }
  counter.arithmetic(2 * (points.corners.size() - 1));
  counter.critical_path(log2_ceiling(points.corners.size()));
  LowerHull hull = lower_hull(predicates_, points, options_.hull, counter, level_statistics(level));
  level_statistics(level).path_vertices += hull.path.size();
  note_work(Component::hull, level, counter.counts());
  return hull;
}

// The path becomes a border of both parts. Points that are not on it lie on the same side of the path as of
// the line.
std::array<Region, 2> Recursion::split(const Region& region, const Line& line, const LowerHull& hull,
                                       int level) {
  std::vector<char> is_internal;
  for (const HullPoint& vertex : hull.path) {
    is_internal.push_back(!on_border_[vertex.id]);
    on_border_[vertex.id] = 1;
  }
  Counter merge_counter, split_counter;
  SplitBorder borders =
      merge_border(predicates_, points_, line, region.border, hull, is_internal, merge_counter);
  note_work(Component::merge, level, merge_counter.counts());

  std::array<Region, 2> parts;
  for (int side = 0; side < 2; ++side) parts[side].border = std::move(borders[side]);
  const auto side_of = [&](std::int32_t id) {
    const double s = line.place(points_[id]).x;
    if (s == line.q) {
      throw Error(ErrorKind::internal, "a point on a cut line is not on its path; please report the input");
    }
    return s < line.q ? 0 : 1;
  };
  for (const std::int32_t id : region.by_x) {
    if (on_border_[id]) continue;
    parts[side_of(id)].by_x.push_back(id);
    split_counter.arithmetic();
  }
  for (const std::int32_t id : region.by_y) {
    if (!on_border_[id]) parts[side_of(id)].by_y.push_back(id);
  }
  split_counter.critical_path(1 + scan_depth(region.by_x.size()));
  note_work(Component::split, level, split_counter.counts());
  return parts;
}

void Recursion::finish(const Border& border, int level) {
  Counter counter;
  end_game(predicates_, points_, border, solve_large_, triangles_, counter);
  note_work(Component::endgame, level, counter.counts());
  const std::size_t size = std::min<std::size_t>(border.size(), kernel::MOST_COUNTED_SIZE);
  if (work_.endgame_sizes.size() <= size) work_.endgame_sizes.resize(size + 1);
  ++work_.endgame_sizes[size];
}

void Recursion::note_region(const Region& region, int level) {
  if (result_.levels.size() == static_cast<std::size_t>(level)) {
    result_.levels.emplace_back();
    work_.levels.emplace_back();
  }
  LevelStatistics& now = level_statistics(level);
  ++now.regions;
  now.internal_points += region.by_x.size();
  now.corners += region.border.size();
  now.largest_region = std::max(now.largest_region, region.by_x.size());
}

}  // namespace

Ids run(const PointSets& sets, const research::Options& options, const SolveRegion& solve_large,
        research::Triangulation& result) {
  return Recursion(sets, options, solve_large, result).run();
}

}  // namespace flaunay::recursive
