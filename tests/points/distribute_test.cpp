// The stage `distribute`: points in blocks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "launchers/points/distribute_tiles.cl.hpp"
#include "tests/points/support.hpp"
#include "tests/support/errors.hpp"
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
    return testing::error_of(ErrorKind::input, [&] {
      *make_blocks(call.work, runtime.view(coordinates.data(), coordinates.size()),
                   {0, coordinates.size() / 2}, output);
    });
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
  const Blocks blocks = *make_blocks(call.work, input, sets.offsets, representatives);
  check_blocks(call, sets.coordinates, sets.offsets, blocks, representatives, g, met);
}

Coordinates first_of(const Coordinates& points, std::size_t count) {
  return Coordinates(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(2 * count));
}

TEST(SmallDistribute, ByTiles) {
  under_tiles("tiles", [](Runtime& runtime) {
    for (const auto& [name, points] : awkward(30, 41)) {
      SCOPED_TRACE(name);
      Nested sets;
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

/// There are such groups if the device runs a kernel in smaller groups than it was told.
TEST(SmallDistribute, GroupsBehindTheLastTileDoNothing) {
  Runtime& runtime = Runtimes::get("tiles");
  if (runtime.is_native()) GTEST_SKIP() << "native kernels have no work-groups";
  const Arena::Scope scope(runtime.arena());
  // Four sets of a block each, in tiles of 4 points: 2 digits of one bit.
  const std::size_t n = 7, size = 4, tiles = 2, groups = 5, group = 3;
  Coordinates coordinates;
  for (std::size_t i = 0; i < n; ++i) coordinates.insert(coordinates.end(), {0.5 * i, -1.0 * i});
  const auto input = testing::upload(runtime, coordinates);
  const std::vector<cl_int> offsets{0, 2, 2, 5};
  const auto set_offsets = testing::upload(runtime, offsets);
  const auto sets = testing::upload(
      runtime, std::vector<kernel::set_of_blocks>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  const auto nodes = testing::guarded<kernel::cut_node>(runtime, 1);
  const auto found = testing::guarded<cl_int>(runtime, n);
  const auto representatives = testing::guarded<cl_int>(runtime, n);
  const auto table = testing::guarded<cl_uint>(runtime, 2 * tiles);
  runtime.launch(groups * group, group, n,
                 kernels::count_tile_blocks{.size = size,
                                            .set_count = offsets.size(),
                                            .set_offsets = set_offsets,
                                            .sets = sets,
                                            .input = input,
                                            .nodes = nodes,
                                            .bits = 1,
                                            .block_of_point = found,
                                            .representatives = representatives,
                                            .table = table});
  EXPECT_EQ(testing::download(runtime, found, n), (std::vector<cl_int>{0, 0, 2, 2, 2, 3, 3}));
  EXPECT_EQ(testing::download(runtime, representatives, n), (std::vector<cl_int>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(testing::download(runtime, table, 2 * tiles), (std::vector<cl_uint>{4, 1, 0, 2}));
  // By the higher digit, from blocks in another order.
  const std::vector<cl_int> blocks{2, 0, 2, 0, 2, 3, 3}, indices{6, 5, 4, 3, 2, 1, 0};
  const auto keys = testing::upload(runtime, blocks);
  runtime.launch(groups * group, group, n,
                 kernels::count_digits{.size = size, .shift = 1, .bits = 1, .blocks = keys, .table = table});
  EXPECT_EQ(testing::download(runtime, table, 2 * tiles), (std::vector<cl_uint>{2, 0, 2, 3}));
  const auto scanned = testing::upload(runtime, std::vector<cl_uint>{0, 2, 2, 4});
  const auto moved = testing::guarded<cl_int>(runtime, n), source = testing::guarded<cl_int>(runtime, n);
  const auto points = testing::guarded<cl_double2>(runtime, n);
  const auto starts = testing::guarded<cl_int>(runtime, 3);
  const auto move = [&](bool is_first) {
    runtime.launch(groups * group, group, n,
                   kernels::move_tiles{.size = size,
                                       .shift = 1,
                                       .bits = 1,
                                       .is_first = is_first,
                                       .blocks = keys,
                                       .indices = testing::upload(runtime, indices),
                                       .scanned = scanned,
                                       .input = input,
                                       .scale = kernel::scaling{2, 1, 1},
                                       .block_count = 2,
                                       .offsets = starts,
                                       .moved_blocks = moved,
                                       .points = points,
                                       .source = source});
  };
  move(false);
  EXPECT_EQ(testing::download(runtime, moved, n), (std::vector<cl_int>{0, 0, 2, 2, 2, 3, 3}));
  const std::vector<cl_int> order{5, 3, 6, 4, 2, 1, 0};
  EXPECT_EQ(testing::download(runtime, source, n), order);
  const auto scaled = testing::download(runtime, points, n);
  for (std::size_t k = 0; k < n; ++k) {
    EXPECT_EQ(scaled[k].s[0], order[k]);
    EXPECT_EQ(scaled[k].s[1], -2 * order[k]);
  }
  // By the only digit, all points in their order.
  move(true);
  EXPECT_EQ(testing::download(runtime, source, n), (std::vector<cl_int>{1, 3, 0, 2, 4, 5, 6}));
  EXPECT_EQ(testing::download(runtime, starts, 3), (std::vector<cl_int>{0, 2, 7}));
}

}  // namespace

}  // namespace flaunay::points
