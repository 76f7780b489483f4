// Trees of cuts between chunks: every point has one leaf, in whose rectangle it lies.
#include "large/chunks/tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "large/chunks/scratch.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::chunks {
namespace {

using kernel::double2;
using testing::Coordinates;
using testing::make_fixture;

std::vector<double2> points_of(const Coordinates& coordinates) {
  std::vector<double2> points;
  for (std::size_t i = 0; i < coordinates.size(); i += 2)
    points.push_back({coordinates[i], coordinates[i + 1]});
  return points;
}

std::vector<std::size_t> leaves_of(const ChunkTree& tree, const Coordinates& coordinates) {
  std::vector<std::size_t> leaves(coordinates.size() / 2);
  tree.find_leaves(coordinates.data(), leaves.size(), leaves.data());
  return leaves;
}

void expect_inside(const ChunkTree& tree, const Coordinates& coordinates) {
  const std::vector<std::size_t> leaves = leaves_of(tree, coordinates);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    ASSERT_LT(leaves[i], tree.leaves());
    const kernel::vertex_box own = tree.rectangle(leaves[i], whole_plane());
    const double x = coordinates[2 * i], y = coordinates[2 * i + 1];
    EXPECT_TRUE(own.low.x <= x && x <= own.high.x && own.low.y <= y && y <= own.high.y) << "point " << i;
    // No point is strictly inside of another leaf's rectangle.
    for (std::size_t other = 0; other < tree.leaves(); ++other) {
      if (other == leaves[i]) continue;
      const kernel::vertex_box box = tree.rectangle(other, whole_plane());
      EXPECT_FALSE(box.low.x < x && x < box.high.x && box.low.y < y && y < box.high.y) << "point " << i;
    }
  }
}

TEST(ChunkTree, PutsEachPointIntoItsRectangle) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Coordinates coordinates = fixture.make(200, 3);
    for (const std::size_t leaves : {1, 2, 3, 7, 16}) {
      for (const Cuts cuts : {Cuts::at_medians, Cuts::in_gaps}) {
        expect_inside(ChunkTree::of_leaves(points_of(coordinates), leaves, cuts), coordinates);
      }
    }
  }
}

TEST(ChunkTree, HasEqualLeavesOfDistinctPoints) {
  const Coordinates coordinates = make_fixture("kuzmin", 7000, 1);
  for (const Cuts cuts : {Cuts::at_medians, Cuts::in_gaps}) {
    std::vector<std::size_t> counts(7, 0);
    for (const std::size_t leaf :
         leaves_of(ChunkTree::of_leaves(points_of(coordinates), 7, cuts), coordinates)) {
      ++counts[leaf];
    }
    const double most = cuts == Cuts::at_medians ? 1.01 : 1.6;
    for (const std::size_t count : counts) EXPECT_GE(count, 250u);
    EXPECT_LE(static_cast<double>(*std::max_element(counts.begin(), counts.end())), most * 1000 + 1);
  }
}

TEST(ChunkTree, AroundAPointTellsEqualPointsFromOthers) {
  const ChunkTree tree = ChunkTree::around({0.0, 2.0});
  const Coordinates coordinates = {0, 2, -0.0, 2, 0, 1, 0, 3, -1, 2, 1, 2, 0x1p-1074, 2, -0x1p-1074, 2};
  const std::vector<std::size_t> leaves = leaves_of(tree, coordinates);
  for (std::size_t i = 0; i < leaves.size(); ++i) EXPECT_EQ(leaves[i] == ChunkTree::kEqualLeaf, i < 2) << i;
  expect_inside(tree, coordinates);
}

TEST(ChunkWriters, GiveBackWhatTheyGot) {
  ScratchFile file("");
  for (const std::size_t buffer_bytes : {1, 100000}) {
    ChunkWriters writers(file, 3, buffer_bytes, true), open_writers(file, 3, buffer_bytes, true);
    ChunkPoints points;
    testing::FixtureRandom random(1);
    for (std::int64_t id = 0; id < 5000; ++id) {
      std::vector<OpenEdge> edges(static_cast<std::size_t>(random.integer(0, 9)));
      for (OpenEdge& edge : edges)
        edge = {random.integer(0, 1LL << 50), random.unit(), random.unit(), id, id % 2};
      points.add({random.unit(), random.unit()}, 3 * id, edges.data(), edges.size());
      points.values.push_back(random.unit());
    }
    // From the last to the first: reading sorts what is handed on.
    for (std::size_t i = points.size(); i-- > 0;) {
      const std::size_t j = points.size() - 1 - i;
      writers.add(i % 2, points.point(j), points.ids[j], points.values[j]);
      open_writers.add(i % 2, points, i);
    }
    const std::vector<StoredChunk> stored = writers.take(), open_stored = open_writers.take();
    ASSERT_EQ(stored.size(), 3u);
    EXPECT_EQ(stored[2].points, 0u);
    std::size_t read = 0;
    for (std::size_t chunk = 0; chunk < 2; ++chunk) {
      const ChunkPoints first = read_chunk(file, stored[chunk], true),
                        later = read_chunk(file, open_stored[chunk], false);
      EXPECT_EQ(first.size(), 2500u);
      EXPECT_TRUE(first.is_first_round());
      ASSERT_EQ(first.values.size(), 2500u);
      for (std::size_t k = 0; k < first.size(); ++k) {
        EXPECT_EQ(first.values[k], points.values[static_cast<std::size_t>(first.ids[k] / 3)]);
      }
      ASSERT_EQ(later.size(), 2500u);
      for (std::size_t k = 0; k < later.size(); ++k, ++read) {
        const auto i = static_cast<std::size_t>(later.ids[k] / 3);
        EXPECT_EQ(i, 2 * k + chunk);
        EXPECT_EQ(later.values.at(k), points.values[i]);
        ASSERT_EQ(later.edge_count(k), points.edge_count(i));
        for (std::size_t e = 0; e < later.edge_count(k); ++e) {
          const OpenEdge &found = later.edges[later.edge_offsets[k] + e],
                         &expected = points.edges[points.edge_offsets[i] + e];
          EXPECT_EQ(found.to, expected.to);
          EXPECT_EQ(found.x, expected.x);
          EXPECT_EQ(found.corner, expected.corner);
          EXPECT_EQ(found.begins, expected.begins);
        }
      }
    }
    EXPECT_EQ(read, points.size());
  }
}

}  // namespace
}  // namespace flaunay::chunks
