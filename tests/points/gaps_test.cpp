// Cut trees of points along earlier cuts (kernels/points/gaps.cl) against a plain twin, node by node.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "launchers/points/gaps.cl.hpp"
#include "points/cut_tree.h"
#include "points/limits.h"
#include "tests/points/support.hpp"

namespace flaunay::points {
namespace {

using Samples = std::vector<cl_double2>;

/// What the twin met.
struct MetGaps {
  std::size_t gaps = 0, medians = 0, empty = 0, thinned = 0, along[2] = {0, 0};
};

/// How many levels a group cuts, of how many samples.
struct Groups {
  int levels;
  std::size_t capacity;
};

Groups groups_of(const Tuning& tuning, std::size_t samples_per_leaf) {
  Groups groups{1, tuning.sample_tile};
  while (groups.levels < kernel::GAP_LEVELS && samples_per_leaf << (groups.levels + 1) <= groups.capacity)
    ++groups.levels;
  return groups;
}

/// A tree of samples, as gaps.cl describes it.
class GapTwin {
 public:
  GapTwin(const Samples& samples, int depth, const Groups& groups, MetGaps& met)
      : nodes(std::size_t{1} << depth), all_(samples.size()), groups_(groups), met_(met) {
    cut_levels(1, 0, samples);
  }

  std::vector<kernel::cut_node> nodes;

 private:
  struct Gap {
    double extent = 0;
    std::size_t first = 0;
    int axis = 0;
  };

  static double at(const cl_double2& p, int axis) { return p.s[axis] + 0.0; }

  static Samples sorted_along(Samples samples, int axis) {
    std::stable_sort(samples.begin(), samples.end(),
                     [axis](const auto& p, const auto& q) { return comes_first(p, q, axis); });
    return samples;
  }

  static Gap widest_gap(const Samples* sorted, std::size_t half_size) {
    const auto size = static_cast<long>(sorted[0].size());
    const auto width = std::max(1L, static_cast<long>(std::sqrt(static_cast<float>(size))));
    // The smallest part that may be made, from what both parts may have at least and at most.
    const double half = static_cast<double>(half_size);
    const long wanted = std::max({static_cast<long>(0.3 * static_cast<double>(size)),
                                  static_cast<long>(0.5 * half), size - static_cast<long>(1.4 * half)});
    const long least = std::clamp(wanted, 1L, std::max(1L, size / 2));
    const long most = std::max(least, size - least);
    Gap gap;
    for (const int axis : {0, 1}) {
      for (long first = 0; first + width < size; ++first) {
        const long middle = first + width / 2;
        if (middle < least || middle > most) continue;
        const double extent = at(sorted[axis][first + width], axis) - at(sorted[axis][first], axis);
        if (extent > gap.extent) gap = {extent, static_cast<std::size_t>(first), axis};
      }
    }
    return gap;
  }

  /// A group's levels: as many of the node's samples as there is room for, evenly.
  void cut_levels(std::size_t node, int level, const Samples& samples) {
    if (node >= nodes.size()) return;
    Samples tile(std::min(samples.size(), groups_.capacity));
    for (std::size_t i = 0; i < tile.size(); ++i) tile[i] = samples[i * samples.size() / tile.size()];
    met_.thinned += tile.size() < samples.size();
    const std::size_t equal = (all_ >> level) * tile.size() / std::max<std::size_t>(1, samples.size());
    cut(node, level, 0, equal, tile, samples);
  }

  static Samples side_of(Samples samples, const kernel::cut_node& node, bool is_high) {
    const auto other = [&](const cl_double2& p) {
      const kernel::point_keys keys = kernel::keys_of({p.s[0], p.s[1]});
      return (kernel::goes_high(&keys, &node) != 0) != is_high;
    };
    samples.erase(std::remove_if(samples.begin(), samples.end(), other), samples.end());
    return samples;
  }

  /// tile: the samples by which the node is cut; samples: all of the node. equal: as many as it would have in
  /// the tile if all leaves were equal.
  void cut(std::size_t node, int level, int depth, std::size_t equal, const Samples& tile,
           const Samples& samples) {
    if (node >= nodes.size()) return;
    if (depth == groups_.levels) return cut_levels(node, level, samples);
    if (tile.empty()) {
      ++met_.empty;
      nodes[node] = testing::node_of({{0, 0}}, 0);
    } else {
      const Samples sorted[2] = {sorted_along(tile, 0), sorted_along(tile, 1)};
      const Gap gap = widest_gap(sorted, equal / 2);
      const Samples& along = sorted[gap.axis];
      nodes[node] = testing::node_of(along[along.size() / 2], gap.axis);
      if (gap.extent > 0) {
        const double begin = at(along[gap.first], gap.axis), middle = begin + 0.5 * gap.extent;
        nodes[node].major = geometry::sort_key((middle > begin ? middle : begin + gap.extent) + 0.0);
        nodes[node].minor = 0;
        ++met_.along[gap.axis];
        ++met_.gaps;
      } else {
        ++met_.medians;
      }
    }
    for (const bool is_high : {false, true}) {
      cut(2 * node + is_high, level + 1, depth + 1, equal / 2, side_of(tile, nodes[node], is_high),
          side_of(samples, nodes[node], is_high));
    }
  }

  std::size_t all_;
  Groups groups_;
  MetGaps& met_;
};

void check_gap_trees(Runtime& runtime, const std::vector<std::pair<Coordinates, int>>& sets,
                     std::size_t samples_per_leaf, MetGaps& met) {
  const Arena::Scope scope(runtime.arena());
  Coordinates all{NAN, NAN};
  std::vector<SetToCut> to_cut;
  for (const auto& [coordinates, depth] : sets) {
    to_cut.push_back({depth, all.size() / 2, coordinates.size() / 2});
    append(all, coordinates);
    append(all, {NAN, NAN});
  }
  const auto input = testing::upload(runtime, all);
  const CutTrees trees(runtime, to_cut, samples_per_leaf);
  const auto nodes = testing::guarded<kernel::cut_node>(runtime, trees.nodes());
  trees.cut_at_gaps(trees.draw(input).points, nodes);
  const std::vector<kernel::cut_node> found = testing::download(runtime, nodes, trees.nodes());
  std::size_t first = 0;
  for (const auto& [coordinates, depth] : sets) {
    Samples samples;
    for (const cl_int i : spread_indices(coordinates.size() / 2, samples_per_leaf << depth)) {
      samples.push_back(point_of(coordinates, static_cast<std::size_t>(i)));
    }
    const GapTwin twin(samples, depth, groups_of(tuning_of(runtime), samples_per_leaf), met);
    for (std::size_t k = 1; k < twin.nodes.size(); ++k) {
      const kernel::cut_node &node = found[first + k], &expected = twin.nodes[k];
      ASSERT_TRUE(node.major == expected.major && node.minor == expected.minor && node.turn == expected.turn)
          << "node " << k << " of a tree of depth " << depth << " from node " << first;
    }
    first += twin.nodes.size();
  }
}

/// Points within a narrow strip along each line of a coarse grid, as an earlier tree's cuts leave them.
Coordinates along_cuts(std::size_t n, std::uint64_t seed) {
  FixtureRandom random(seed);
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const double line = static_cast<double>(random.integer(0, 3)) + 0.1 * random.unit(),
                 along = 4 * random.unit();
    append(points, i % 2 == 0 ? Coordinates{line, along} : Coordinates{along, line});
  }
  return points;
}

std::vector<std::pair<Coordinates, int>> gap_sets(std::size_t n, const std::vector<int>& depths) {
  std::vector<std::pair<Coordinates, int>> sets;
  std::size_t k = 0;
  const auto add = [&](const Coordinates& points) { sets.emplace_back(points, depths[k++ % depths.size()]); };
  for (const auto& [name, points] : awkward(n, 50)) {
    // Extents overflow unless points are scaled, as they are when rounds cut them.
    if (name != "overflowing" && name != "huge") add(points);
  }
  add(along_cuts(n, 51));
  add(along_cuts(3 * n, 52));
  add({1, 2, 3, 4});
  add({0.5, -0.5});
  add(testing::perturbed(make_fixture("grid", n, 53), 54));
  return sets;
}

TEST(SmallGaps, AreThoseOfTheTwin) {
  under_tiles("tiles", [](Runtime& runtime) {
    MetGaps met;
    check_gap_trees(runtime, {{along_cuts(40, 55), 3}}, 4, met);
    check_gap_trees(runtime, {{along_cuts(9, 56), 0}, {Coordinates(20, 1.5), 2}, {along_cuts(30, 57), 1}}, 3,
                    met);
    check_gap_trees(runtime, gap_sets(9, {2, 1, 3}), 1, met);
    EXPECT_GT(met.gaps, 10u);
    EXPECT_GT(met.medians, 3u);
  });
}

/// There are such groups if the device runs a kernel in smaller groups than it was told.
TEST(SmallGaps, GroupsBehindTheLastDoNothing) {
  under_tiles("tiles", [](Runtime& runtime) {
    const Arena::Scope scope(runtime.arena());
    // A tree with leaves of 3 samples, cut level by level.
    const cl_int m = 12, depth = 2;
    const std::size_t group = 3;
    const Samples samples = points_of(along_cuts(m, 59));
    const auto from = testing::upload(runtime, samples);
    const auto trees = testing::upload(runtime, std::vector<kernel::sampled_tree>{{0, m, 3, m, 0, 0, m}});
    const auto zero = testing::upload(runtime, std::vector<cl_int>{0});
    const auto to = testing::guarded<cl_double2>(runtime, m);
    const auto ranges = testing::guarded<cl_int2>(runtime, 1 << depth);
    const auto nodes = testing::guarded<kernel::cut_node>(runtime, 1 << depth);
    const std::size_t capacity = tuning_of(runtime).sample_tile;
    MetGaps met;
    const GapTwin twin(samples, depth, {1, capacity}, met);
    for (cl_int level = 0; level < depth; ++level) {
      const std::size_t groups = std::size_t{1} << level;
      runtime.launch((groups + 3) * group, group,
                     kernels::cut_at_gaps{.groups = groups,
                                          .level = level,
                                          .levels = 1,
                                          .capacity = capacity,
                                          .tree_count = 1,
                                          .first_groups = zero,
                                          .trees = trees,
                                          .from = from,
                                          .to = to,
                                          .ranges = ranges,
                                          .nodes = nodes});
      const auto found = testing::download(runtime, nodes, 1 << depth);
      for (std::size_t k = 1; k < found.size(); ++k) {
        const bool is_cut = k < 2 * groups;
        EXPECT_EQ(found[k].major == twin.nodes[k].major && found[k].minor == twin.nodes[k].minor, is_cut)
            << k;
      }
    }
    testing::download(runtime, to, m);
    testing::download(runtime, ranges, 1 << depth);
  });
}

TEST(Gaps, AreThoseOfTheTwin) {
  if (testing::tests_native()) GTEST_SKIP() << "native kernels have no work-groups";
  MetGaps met;
  under_each_group_of_tiles([&](Runtime& runtime) {
    check_gap_trees(runtime, gap_sets(1000, {5, 1, 8, 0, 3}), 64, met);
    check_gap_trees(runtime, gap_sets(300, {4, 7, 2}), 5, met);
    check_gap_trees(runtime, {{along_cuts(30000, 58), 9}}, 64, met);
    for (const std::size_t samples : {1, 2, 3})
      check_gap_trees(runtime, gap_sets(90, {6, 3, 5}), samples, met);
  });
  EXPECT_GT(met.along[0], 100u);
  EXPECT_GT(met.along[1], 100u);
  EXPECT_GT(met.medians, 100u);
  EXPECT_GT(met.empty, 0u);
  EXPECT_GT(met.thinned, 100u);
}

}  // namespace
}  // namespace flaunay::points
