// The stage `distribute`: points in blocks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "tests/points/support.hpp"
#include "tests/support/ingest_twin.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::points {

void check_blocks(Call& call, const Coordinates& coordinates, const Offsets& offsets, const Blocks& blocks,
                  const Buffer<cl_int>& representatives, HostRings& g, Met& met) {
  SCOPED_TRACE("blocks");
  const testing::IngestTwin ingest = testing::ingest_twin(coordinates, offsets);
  const std::size_t n = offsets.back();
  const BlocksTwin twin(coordinates, offsets, tuning_of(call.runtime).block_points, ingest.shift,
                        sample_indices);
  EXPECT_EQ(blocks.sets, offsets.size() - 1);
  EXPECT_EQ(blocks.points, n);
  ASSERT_TRUE(same(blocks.set_blocks, twin.set_blocks));
  ASSERT_TRUE(same(blocks.offsets, twin.offsets));
  ASSERT_EQ(blocks.count, twin.offsets.size() - 1);
  EXPECT_TRUE(same(call.read(blocks.device_set_blocks, blocks.set_blocks.size()), twin.set_blocks));
  EXPECT_TRUE(same(call.read(blocks.device_offsets, blocks.offsets.size()), twin.offsets));
  EXPECT_TRUE(same(call.read(blocks.source, n), twin.source));
  EXPECT_TRUE(same(call.read(blocks.vertices, n), twin.vertices));
  std::vector<cl_int> identity(n);
  std::iota(identity.begin(), identity.end(), 0);
  EXPECT_TRUE(same(call.read(representatives, n), identity));
  EXPECT_EQ(testing::broken_nodes(call.read(blocks.device_nodes, blocks.device_nodes.size()), twin.trees),
            "");
  EXPECT_EQ(testing::broken_merges(blocks, twin.trees, g.spans), "");
  const auto merges = call.read(blocks.device_merges, blocks.merges.size());
  for (std::size_t m = 0; m < merges.size(); ++m) {
    EXPECT_TRUE(merges[m].low == blocks.merges[m].low && merges[m].high == blocks.merges[m].high &&
                merges[m].node == blocks.merges[m].node)
        << "merge " << m << " on the device";
  }
  EXPECT_EQ(call.work.bounds.orient == 0, ingest.bits <= 25);
  EXPECT_EQ(call.work.bounds.circle == 0, ingest.bits <= 11);
  g.set_blocks = twin.set_blocks;
  g.offsets = twin.offsets;
  g.vertices = twin.vertices;
  g.source = twin.source;
  met.merges += merges.size();
  for (std::size_t b = 0; b < blocks.count; ++b) {
    const auto size = static_cast<std::size_t>(blocks.offsets[b + 1] - blocks.offsets[b]);
    met.empty_blocks += size == 0;
    met.large_blocks += size > 4 * tuning_of(call.runtime).block_points;
  }
}

namespace {

TEST(SmallDistribute, BadInputIsRefused) {
  Runtime& runtime = Runtimes::get("own");
  const auto message = [&](const Coordinates& coordinates) {
    Call call(runtime);
    std::vector<cl_int> representatives(coordinates.size() / 2);
    const auto output = runtime.output(representatives);
    try {
      make_blocks(call.work, runtime.view(coordinates.data(), coordinates.size()),
                  {0, coordinates.size() / 2}, output);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message({0, 0, 1, 0, 0, std::nan(""), HUGE_VAL, 0}).find("point 2 is not finite"),
            std::string::npos);
  EXPECT_NE(message({0, 0, -HUGE_VAL, 0, 0, 1, 1, 1}).find("point 1 is not finite"), std::string::npos);
  EXPECT_NE(message({0x1p300, 0, 1, 0x1p-300, 0, 1}).find("magnitudes differ too much"), std::string::npos);
}

/// Blocks of these sets, made by tiles, against their twin.
void check_blocks_of_tiles(Runtime& runtime, const Nested& sets) {
  Call call(runtime);
  HostRings g;
  Met met;
  const std::size_t n = sets.offsets.back();
  const auto representatives = call.work.persistent.allocate<cl_int>(n);
  const auto input = testing::upload(runtime, sets.coordinates);
  const Blocks blocks = make_blocks(call.work, input, sets.offsets, representatives);
  check_blocks(call, sets.coordinates, sets.offsets, blocks, representatives, g, met);
}

Coordinates first_of(const Coordinates& points, std::size_t count) {
  return Coordinates(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(2 * count));
}

TEST(SmallDistribute, ByTiles) {
  under_each_group_of_tiles([](Runtime& runtime) {
    for (const auto& [name, points] : awkward(60, 41)) {
      SCOPED_TRACE(name);
      Nested sets;
      sets.add(points);
      check_blocks_of_tiles(runtime, sets);
      sets.add({});
      sets.add(first_of(points, 7));
      sets.add(points);
      sets.add({});
      check_blocks_of_tiles(runtime, sets);
    }
  });
}

/// Blocks' numbers of one digit and of two, tiles that end within sets, and sets without a tree among others.
TEST(Distribute, ByTiles) {
  under_each_group_of_tiles([](Runtime& runtime) {
    for (const std::size_t n : {2047, 2048, 2049, 9000, 30000}) {
      SCOPED_TRACE(std::to_string(n) + " points");
      Nested sets;
      sets.add(make_fixture("uniform", n, n));
      check_blocks_of_tiles(runtime, sets);
    }
    for (const auto& [name, points] : awkward(5000, 43)) {
      SCOPED_TRACE(name);
      Nested sets;
      for (std::size_t s = 0; s < 50; ++s) sets.add(first_of(points, s % 13));
      sets.add(points);
      sets.add(first_of(points, 700));
      check_blocks_of_tiles(runtime, sets);
    }
  });
}

}  // namespace

}  // namespace flaunay::points
