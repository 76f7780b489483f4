// Cut trees of the device against their twin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "launchers/points/cut_tree_tiles.cl.hpp"
#include "tests/points/support.hpp"

namespace flaunay::points {
namespace {

TEST(SmallCutTree, AxisIsThatOfTheLongerInterquartileRange) {
  const auto axis_of = [](const auto& all) { return testing::tree_twin(all, 1).nodes[1].axis; };
  // A few far points do not count: the range between the quarters does.
  std::vector<cl_double2> samples{{{-1000, 1}}, {{1000, 2}}};
  for (int i = 0; i < 14; ++i) samples.push_back({{i * 0.25, static_cast<double>(i)}});
  EXPECT_EQ(axis_of(samples), 1);
  for (cl_double2& p : samples) std::swap(p.s[0], p.s[1]);
  EXPECT_EQ(axis_of(samples), 0);
  std::vector<cl_double2> square{{{0, 0}}, {{1, 1}}, {{2, 2}}, {{3, 3}}};
  EXPECT_EQ(axis_of(square), 0);
}

TEST(SmallCutTree, SamplesComeFromEqualParts) {
  for (const int depth : {1, 3, 6}) {
    const std::size_t samples = testing::samples_for(depth);
    for (const std::size_t n :
         {std::size_t{2}, samples - 1, samples, samples + 1, 10 * samples + 7, 1000 * samples}) {
      const std::vector<cl_int> indices = sample_indices(n, depth);
      ASSERT_EQ(indices.size(), samples);
      EXPECT_EQ(indices, sample_indices(n, depth));
      std::size_t late = 0;
      for (std::size_t k = 0; k < samples; ++k) {
        const std::size_t begin = k * n / samples, end = (k + 1) * n / samples;
        const auto index = static_cast<std::size_t>(indices[k]);
        ASSERT_LT(index, n);
        ASSERT_GE(index, begin);
        ASSERT_LT(index, std::max(end, begin + 1));
        late += index - begin >= (end - begin + 1) / 2;
      }
      // Drawn anywhere in their part.
      if (n < 1000 * samples) continue;
      EXPECT_GT(late, samples / 4);
      EXPECT_LT(late, samples * 3 / 4);
    }
  }
}

/// The points of each leaf of so many samples, sorted.
using Leaf = std::vector<std::pair<double, double>>;
std::vector<Leaf> leaves_of(const std::vector<cl_double2>& samples, std::size_t size) {
  std::vector<Leaf> leaves(samples.size() / size);
  for (std::size_t i = 0; i < samples.size(); ++i)
    leaves[i / size].emplace_back(samples[i].s[0], samples[i].s[1]);
  for (Leaf& leaf : leaves) std::sort(leaf.begin(), leaf.end());
  return leaves;
}

/// What the device made of all sets.
struct HostTrees {
  std::vector<kernel::cut_node> nodes;
  std::vector<cl_double2> samples;
  std::vector<cl_int> orders;
  std::size_t first_sample = 0, first_node = 0;  ///< of the set at hand
};

/// A set's tree against the twin of the same samples.
void check_device_tree(const Coordinates& coordinates, int depth, std::size_t samples_per_leaf,
                       const HostTrees& found) {
  std::vector<cl_double2> expected, samples;
  for (const cl_int i : spread_indices(coordinates.size() / 2, samples_per_leaf << depth)) {
    expected.push_back(point_of(coordinates, static_cast<std::size_t>(i)));
    samples.push_back(found.samples[found.first_sample + samples.size()]);
  }
  EXPECT_TRUE(same(samples, expected));
  const TreeTwin tree = testing::tree_twin(expected, depth);
  for (std::size_t k = 1; k < tree.nodes.size(); ++k) {
    const kernel::cut_node& node = found.nodes[found.first_node + k];
    const kernel::cut_node twin = testing::node_of(tree.nodes[k].pivot, tree.nodes[k].axis);
    ASSERT_TRUE(node.major == twin.major && node.minor == twin.minor && node.turn == twin.turn)
        << "node " << k;
  }
  expected.clear();
  for (const auto& leaf : tree.leaves) expected.insert(expected.end(), leaf.begin(), leaf.end());
  for (const std::size_t order : {std::size_t{0}, found.samples.size()}) {
    std::vector<cl_double2> by_leaf;
    std::vector<bool> is_there(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto sample = static_cast<std::size_t>(found.orders[order + found.first_sample + i]);
      ASSERT_GE(sample, found.first_sample);
      ASSERT_LT(sample, found.first_sample + samples.size());
      ASSERT_FALSE(is_there[sample - found.first_sample]) << "sample " << sample << " is there twice";
      is_there[sample - found.first_sample] = true;
      by_leaf.push_back(found.samples[sample]);
    }
    EXPECT_TRUE(leaves_of(by_leaf, samples_per_leaf) == leaves_of(expected, samples_per_leaf));
  }
}

/// Returns the number of launches.
std::size_t check_device_trees(Runtime& runtime, const std::vector<std::pair<Coordinates, int>>& sets,
                               std::size_t samples_per_leaf) {
  const Arena::Scope scope(runtime.arena());
  // Points before and behind, which no tree is to see.
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
  const std::size_t before = runtime.accounts().launches;
  const auto samples = trees.draw(input);
  const auto orders = trees.cut(samples.points, nodes);
  const std::size_t launches = runtime.accounts().launches - before;
  HostTrees found{testing::download(runtime, nodes, trees.nodes()), std::vector<cl_double2>(trees.samples()),
                  std::vector<cl_int>(2 * trees.samples())};
  runtime.read(samples.points, 0, found.samples.size(), found.samples.data());
  std::vector<cl_int> indices(trees.samples());
  runtime.read(samples.indices, 0, indices.size(), indices.data());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const cl_double2 drawn = point_of(all, static_cast<std::size_t>(indices[i]));
    EXPECT_TRUE(drawn.s[0] == found.samples[i].s[0] && drawn.s[1] == found.samples[i].s[1]) << i;
  }
  runtime.read(orders, 0, found.orders.size(), found.orders.data());
  for (std::size_t s = 0; s < sets.size(); ++s) {
    SCOPED_TRACE("set " + std::to_string(s));
    const auto& [coordinates, depth] = sets[s];
    check_device_tree(coordinates, depth, samples_per_leaf, found);
    if (::testing::Test::HasFatalFailure()) return launches;
    found.first_sample += samples_per_leaf << depth;
    found.first_node += std::size_t{1} << depth;
  }
  EXPECT_EQ(found.first_sample, trees.samples());
  EXPECT_EQ(found.first_node, trees.nodes());
  return launches;
}

/// Sets of many kinds, depths in no order, some of a single leaf, of fewer points than samples and of more.
std::vector<std::pair<Coordinates, int>> sets_of_all_depths(std::size_t points,
                                                            const std::vector<int>& depths) {
  std::vector<std::pair<Coordinates, int>> sets;
  std::size_t k = 0;
  for (const auto& [name, coordinates] : awkward(points, 31)) {
    sets.emplace_back(coordinates, depths[k % depths.size()]);
    sets.emplace_back(make_fixture("uniform", 1 + 3 * k, 32), 0);
    sets.emplace_back(make_fixture("uniform", 5 * points, k), depths[(k + 1) % depths.size()]);
    ++k;
  }
  return sets;
}

// Where no node is larger than a chunk: draw, sort, cut.
constexpr std::size_t kLeastLaunches = 3;

TEST(SmallCutTrees, AreThoseOfTheHost) {
  under_each_tuning([](Runtime& runtime) {
    for (const std::size_t samples_per_leaf : {1, 3, 16}) {
      SCOPED_TRACE(std::to_string(samples_per_leaf) + " samples a leaf");
      check_device_trees(runtime, {{make_fixture("uniform", 40, 1), 1}}, samples_per_leaf);
      check_device_trees(runtime, sets_of_all_depths(9, {1, 4, 2}), samples_per_leaf);
    }
  });
}

TEST(CutTrees, AreThoseOfTheHost) {
  under_each_tuning([](Runtime& runtime) {
    // Of so many samples, nodes are larger than a chunk.
    for (const auto& [samples_per_leaf, depth] : {std::pair<std::size_t, int>{1, 12}, {16, 9}}) {
      SCOPED_TRACE(std::to_string(samples_per_leaf) + " samples a leaf");
      check_device_trees(runtime, sets_of_all_depths(1000, {5, 1, 9, 0, 3}), samples_per_leaf);
      for (const auto& [name, points] : awkward(10000, 33)) {
        SCOPED_TRACE(name);
        EXPECT_GT(check_device_trees(runtime, {{points, depth}}, samples_per_leaf), kLeastLaunches + 1);
      }
      for (const testing::Fixture& fixture : testing::all_fixtures()) {
        SCOPED_TRACE(fixture.name);
        check_device_trees(runtime, {{fixture.make(3000, 34), 7}}, samples_per_leaf);
      }
    }
  });
}

TEST(SmallCutTrees, OfTilesAreThoseOfTheHost) {
  under_tiles("tiles", [](Runtime& runtime) {
    check_device_trees(runtime, {{make_fixture("uniform", 40, 1), 6}}, 1);
    check_device_trees(runtime, {{make_fixture("grid", 9, 1), 0}, {make_fixture("uniform", 40, 2), 3}}, 3);
    for (const auto& [name, points] : awkward(20, 35)) {
      SCOPED_TRACE(name);
      check_device_trees(runtime, {{points, 4}}, 1);
    }
  });
}

TEST(CutTrees, OfTilesAreThoseOfTheHost) {
  under_each_group_of_tiles([](Runtime& runtime) {
    check_device_trees(runtime, sets_of_all_depths(1000, {5, 1, 9, 0, 3}), 16);
    check_device_trees(runtime, sets_of_all_depths(500, {11, 1, 13}), 1);
    check_device_trees(runtime, sets_of_all_depths(100, {11, 0, 4}), 3);
    check_device_trees(runtime, sets_of_all_depths(9, {1, 6, 2}), 3);
  });
}

/// There are such groups if the device runs a kernel in smaller groups than it was told.
TEST(SmallCutTrees, GroupsBehindTheLastTileDoNothing) {
  Runtime& runtime = Runtimes::get("tiles");
  if (runtime.is_native()) GTEST_SKIP() << "native kernels have no work-groups";
  const Arena::Scope scope(runtime.arena());
  // One tree with leaves of 2 samples, in two tiles of 4.
  const cl_int m = 8;
  const std::size_t tiles = 2, groups = 5, group = 3;
  std::vector<cl_double2> samples;
  for (cl_int i = 0; i < m; ++i) samples.push_back({{static_cast<double>(i * 5 % m), 0.1 * i}});
  const auto points = testing::upload(runtime, samples);
  const auto trees = testing::upload(runtime, std::vector<kernel::sampled_tree>{{0, m, 2, 4, 0, 0, m}});
  const auto zero = testing::upload(runtime, std::vector<cl_int>{0});
  const auto order = testing::guarded<cl_int>(runtime, 2 * m),
             sorted = testing::guarded<cl_int>(runtime, 2 * m);
  const auto ranks = testing::guarded<cl_int>(runtime, 2 * m),
             spare = testing::guarded<cl_int>(runtime, 2 * m);
  const auto nodes = testing::guarded<kernel::cut_node>(runtime, 4);
  const auto counts = testing::guarded<cl_uint>(runtime, tiles);
  const kernels::sampled_chunks chunks{
      .tree_count = 1, .first_chunks = zero, .trees = trees, .all_samples = m, .samples = points};
  runtime.launch(
      2 * groups * group, group,
      kernels::sort_tiles{.tiles = tiles, .sampled_chunks = chunks, .order = order, .ranks = ranks});
  EXPECT_EQ(testing::download(runtime, order, 2 * m),
            (std::vector<cl_int>{0, 2, 1, 3, 5, 7, 4, 6, 0, 1, 2, 3, 4, 5, 6, 7}));
  runtime.map(2 * samples.size(), kernels::merge_tiles{.tree_count = 1,
                                                       .first_samples = zero,
                                                       .trees = trees,
                                                       .all_samples = m,
                                                       .widenings = 0,
                                                       .samples = points,
                                                       .from = order,
                                                       .to = sorted,
                                                       .ranks = ranks});
  EXPECT_EQ(testing::download(runtime, sorted, 2 * m),
            (std::vector<cl_int>{0, 5, 2, 7, 4, 1, 6, 3, 0, 1, 2, 3, 4, 5, 6, 7}));
  runtime.launch(groups * group, group,
                 kernels::count_tiles{.tiles = tiles,
                                      .sampled_chunks = chunks,
                                      .level = 0,
                                      .order = sorted,
                                      .ranks = ranks,
                                      .nodes = nodes,
                                      .counts = counts});
  EXPECT_EQ(testing::download(runtime, counts, tiles), (std::vector<cl_uint>{2, 2}));
  runtime.launch(groups * group, group,
                 kernels::split_tiles{.tiles = tiles,
                                      .sampled_chunks = chunks,
                                      .level = 0,
                                      .counts = counts,
                                      .from = sorted,
                                      .ranks = ranks,
                                      .to = spare});
  EXPECT_EQ(testing::download(runtime, spare, 2 * m),
            (std::vector<cl_int>{0, 5, 2, 7, 4, 1, 6, 3, 0, 2, 5, 7, 1, 3, 4, 6}));
  runtime.launch(groups * group, group,
                 kernels::cut_tiles{.tiles = tiles,
                                    .sampled_chunks = chunks,
                                    .sorted = sorted,
                                    .ranks = ranks,
                                    .from = spare,
                                    .nodes = nodes,
                                    .order = order});
  EXPECT_EQ(testing::download(runtime, order, 2 * m),
            (std::vector<cl_int>{0, 5, 2, 7, 4, 1, 6, 3, 0, 5, 2, 7, 1, 4, 3, 6}));
  const auto found = testing::download(runtime, nodes, 4);
  const TreeTwin twin = testing::tree_twin(samples, 2);
  for (std::size_t k = 1; k < found.size(); ++k) {
    EXPECT_EQ(testing::decoded(found[k]).axis, twin.nodes[k].axis) << k;
    for (const int c : {0, 1})
      EXPECT_EQ(testing::decoded(found[k]).pivot.s[c], twin.nodes[k].pivot.s[c]) << k;
  }
}

/// A million points have trees of 512 leaves, 16 million of 8,192.
TEST(CutTrees, OfTilesTakeFewLaunches) {
  Runtime& runtime = Runtimes::get("tiles:256");
  if (runtime.is_native()) GTEST_SKIP() << "native kernels have no work-groups";
  EXPECT_LE(check_device_trees(runtime, {{make_fixture("uniform", 20000, 1), 9}}, 16), 10u);
  EXPECT_LE(check_device_trees(runtime, {{make_fixture("uniform", 40000, 2), 13}}, 16), 20u);
}

TEST(CutTrees, ManySetsTakeNoMoreLaunchesThanOne) {
  under_each_tuning([](Runtime& runtime) {
    std::vector<std::pair<Coordinates, int>> sets;
    for (std::size_t k = 0; k < 300; ++k) {
      sets.emplace_back(make_fixture("uniform", 100 + k, k), k % 7 == 0 ? 0 : 2);
    }
    sets.emplace_back(make_fixture("uniform", 2000, 5), 6);
    const std::size_t together = check_device_trees(runtime, sets, 16);
    // But for the scans of more counts.
    EXPECT_LE(together, 2 * check_device_trees(runtime, {sets.back()}, 16) + 20);
  });
}

}  // namespace
}  // namespace flaunay::points
