// The stage `merge`: the regions that paths make of regions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

/// The two children of a region (left, right), which is cut by the line of `frame` and by `path`, the ids by
/// u. Throws std::logic_error where it meets what cannot be.
std::array<Region, 2> merge_twin(const ExactPoints& points, const Region& region, const Frame& frame,
                                 const std::vector<int>& path, MergeCounts& counts) {
  constexpr int kDown = -1, kUp = -2;  // of compare_angles
  std::array<Region, 2> children;
  std::map<int, std::size_t> place;
  for (std::size_t k = 0; k < path.size(); ++k) place[path[k]] = k;
  const auto side_of = [&](int id) {
    const int side = points.side(frame, id);
    if (side == 0) throw std::logic_error("a point on the line is not on the path");
    return side < 0 ? 0 : 1;
  };

  for (const bool by_y : {false, true}) {
    for (const int id : by_y ? region.y_list : region.x_list) {
      if (place.count(id) != 0) continue;
      Region& child = children[side_of(id)];
      (by_y ? child.y_list : child.x_list).push_back(id);
    }
  }
  const std::set<int> internal(region.x_list.begin(), region.x_list.end());
  for (std::size_t k = 0; k < path.size(); ++k) {
    if (internal.count(path[k]) == 0) continue;
    if (k == 0 || k + 1 == path.size()) throw std::logic_error("an internal point at the path's end");
    children[0].corners.push_back({path[k - 1], path[k], path[k + 1]});
    children[1].corners.push_back({path[k + 1], path[k], path[k - 1]});
  }

  std::map<int, int> corners_of;
  for (const Corner& corner : region.corners) {
    const int m = corner.vertex;
    if (++corners_of[m] == 2) ++counts.pinch_points;
    const auto found = place.find(m);
    if (found == place.end()) {
      children[side_of(m)].corners.push_back(corner);
      continue;
    }
    const std::size_t k = found->second;
    const int previous = k > 0 ? path[k - 1] : kDown;
    const int next = k + 1 < path.size() ? path[k + 1] : kUp;
    const int after = corner.after;
    // The distinct directions among the four, counter-clockwise from `after`, each with its point.
    std::vector<int> around;
    for (const int id : {after, corner.before, previous, next}) {
      const auto same = std::find_if(around.begin(), around.end(), [&](int other) {
        return points.compare_angles(frame, m, after, id, other) == 0;
      });
      if (same == around.end()) {
        around.push_back(id);
      } else if (*same < 0) {
        *same = id;
      } else if (id >= 0 && *same != id) {
        throw std::logic_error("two edges of one direction");
      }
    }
    std::sort(around.begin(), around.end(),
              [&](int f, int g) { return points.compare_angles(frame, m, after, f, g) < 0; });
    const int size = static_cast<int>(around.size());
    const auto index_of = [&](int id) {
      return static_cast<int>(
          std::find_if(around.begin(), around.end(),
                       [&](int other) { return points.compare_angles(frame, m, after, id, other) == 0; }) -
          around.begin());
    };
    const int before_at = index_of(corner.before), previous_at = index_of(previous), next_at = index_of(next);
    if (before_at == 0) throw std::logic_error("an empty wedge");
    counts.path_leaves_region +=
        (previous >= 0 && previous_at > before_at) || (next >= 0 && next_at > before_at);
    counts.path_on_border +=
        previous == corner.before || next == corner.before || previous == after || next == after;
    // Every arc between neighbouring directions is in the wedge or not, and left of the path
    // (counter-clockwise from `next` to `previous`) or right of it.
    for (int arc = 0; arc < before_at; ++arc) {
      const bool left = (arc - next_at + size) % size < (previous_at - next_at + size) % size;
      if (around[arc] < 0 || around[arc + 1] < 0) throw std::logic_error("a line's end in a wedge");
      children[left ? 0 : 1].corners.push_back({around[arc + 1], m, around[arc]});
    }
    ++counts.corners_by_parts[static_cast<std::size_t>(before_at)];
  }
  return children;
}

}  // namespace

Regions check_merge(Call& call, const ExactPoints& points, PointTable& table, const Level& level,
                    const std::vector<Region>& regions, const CutLevel& cut, const Paths& paths, Level& next,
                    RetiredRegions& retired, Met& met) {
  Regions expected;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (Region& child : merge_twin(points, regions[r], cut.frames[r], cut.paths[r], met.merge)) {
      expected.add(std::move(child));
    }
  }
  const std::size_t undecided = call.undecided();
  merge(call.work, table, level, paths, next, retired);
  met.undecided_merge += call.undecided() - undecided;
  Regions found = download(call, next, retired);
  const auto are_same = [&] { ASSERT_TRUE(same_regions(found, expected)); };
  are_same();
  return found;
}

namespace {

TEST(Merge, ManySets) {
  Met met;
  under_each_tuning([&](Runtime& runtime) {
    FixtureRandom random(10);
    for (const int values : {3, 10, 1000}) {
      SCOPED_TRACE(values);
      const auto offsets = random_offsets(300, 30, random);
      check_levels(runtime, coarse_points(offsets.back(), values, random), offsets, {}, met);
    }
  });
  EXPECT_GT(met.merge.pinch_points, 0u);
  EXPECT_GT(met.merge.corners_by_parts[3], 0u);
  EXPECT_GT(met.equal_projections, 0u);
}

}  // namespace

}  // namespace flaunay::flattened
