// The stage `halve`: the points of blocks sorted, without duplicates, and cut in halves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

#include "blocks/codes.h"
#include "blocks/halving.h"
#include "blocks/limits.h"
#include "launchers/blocks/halve_large.cl.hpp"
#include "tests/blocks/support.hpp"

namespace flaunay::blocks {

using testing::download;
using testing::guarded;

std::size_t BlockPoints::largest() const {
  std::size_t most = 0;
  for (std::size_t b = 0; b < count(); ++b) most = std::max(most, size(b));
  return most;
}

std::vector<cl_int> BlockPoints::sources() const {
  std::vector<cl_int> all;
  for (std::size_t i = 0; i < points(); ++i) all.push_back(source(i));
  return all;
}

std::vector<std::pair<std::string, BlockPoints>> nasty_blocks(std::size_t n, std::uint64_t seed) {
  std::vector<std::pair<std::string, BlockPoints>> all;
  for (const auto& [name, points] : awkward(n, seed)) {
    if (name == "huge" || name == "overflowing" || name == "tiny") continue;  // these need to be scaled
    BlockPoints blocks;
    blocks.add(points);
    all.emplace_back(name, blocks);
  }
  FixtureRandom random(seed);
  for (const char* const name : {"uniform", "circle", "integer-circle", "collinear", "rotated-grid"}) {
    BlockPoints blocks;
    for (const std::size_t size : {n, n / 2, n / 3}) blocks.add(make_fixture(name, size, seed));
    all.emplace_back(name, blocks);
  }
  BlockPoints tiny;
  for (std::size_t i = 0; i < n; ++i) {
    tiny.add(coarse(static_cast<std::size_t>(random.integer(0, 9)), 4, 4, random));
  }
  tiny.add_places_behind(7);
  all.emplace_back("tiny blocks", tiny);
  BlockPoints mixed;
  mixed.add({});
  mixed.add({0.5, 0.25});
  mixed.add({0.5, 0.25});
  mixed.add(coarse(n, 2, 2, random));
  mixed.add({});
  mixed.add({});
  mixed.add(make_fixture("uniform", n, seed));
  mixed.add(Coordinates(2 * n, 1.5));
  mixed.add({1, 2});
  mixed.add({});
  mixed.add_places_behind(1);
  all.emplace_back("blocks of all sizes", mixed);
  BlockPoints empty;
  empty.add({});
  empty.add_places_behind(1);
  all.emplace_back("an empty block", empty);
  return all;
}

DeviceBlocks::DeviceBlocks(Call& call, const BlockPoints& points) {
  Runtime& runtime = call.runtime;
  const std::size_t n = points.points();
  blocks = {points.count(),
            n,
            points.largest(),
            testing::upload(runtime, points.offsets),
            testing::upload(runtime, points.vertices),
            testing::upload(runtime, points.sources())};
  std::vector<cl_int> own(n);
  std::iota(own.begin(), own.end(), 0);
  representatives = testing::upload(runtime, own);
  rings.edges = guarded<kernel::ring_edge>(runtime, kernel::EDGES_PER_VERTEX * n);
  rings.vertex_edge = guarded<cl_int>(runtime, n);
  rings.solved = guarded<kernel::solved_block>(runtime, points.count());
  rings.device_distinct = guarded<cl_int>(runtime, points.count());
  rings.device_account = testing::upload(runtime, std::vector<cl_uint>(kernel::RINGS_NUMBERS, 0));
}

void with_groups(std::size_t capacity, const std::function<void(Runtime&)>& check) {
  if (testing::tests_native()) GTEST_SKIP() << "the host solves blocks one by one";
  Runtime& runtime = Runtimes::get("groups");
  for (const std::size_t group : testing::kGroupsToTest) {
    SCOPED_TRACE("groups of " + std::to_string(group));
    Tuning tuning = tuning_of(runtime);
    tuning.blocks_in_parallel = 1;
    tuning.map_group = tuning.block_group = tuning.halve_group = tuning.sewing_group = group;
    tuning.merge_items = 500;
    tuning.seam_points = 8;
    tuning.block_points = capacity;
    tuning.large_blocks = 1;
    runtime.set_sizes(std::make_shared<Tuning>(tuning));
    check(runtime);
  }
}

namespace {

/// The axes of the cuts of a block whose vertices are in the order of leaves.
std::map<std::size_t, int> axes_twin(const std::vector<cl_double2>& vertices) {
  std::map<std::size_t, int> axes;
  const auto count = static_cast<int>(vertices.size());
  for (int d = 0; d < kernel::halving_depth(count); ++d) {
    for (int j = 0; j < 1 << d; ++j) {
      const std::vector<cl_double2> part(vertices.begin() + kernel::part_begin(count, d, j),
                                         vertices.begin() + kernel::part_begin(count, d, j + 1));
      axes[(std::size_t{1} << d) + static_cast<std::size_t>(j)] =
          testing::interquartile_range(part, 1) > testing::interquartile_range(part, 0);
    }
  }
  return axes;
}

cl_int block_twin(const BlockPoints& points, std::size_t place) {
  for (std::size_t b = 0; b < points.count(); ++b) {
    if (points.first(b) <= place && place < points.first(b + 1)) return static_cast<cl_int>(b);
  }
  return -1;
}

void check_halve(Runtime& runtime, const BlockPoints& points) {
  Call call(runtime);
  const DeviceBlocks on_device(call, points);
  const std::size_t n = points.points();
  const HalvedBlocks halved = halve(call.work, on_device.blocks, on_device.representatives, on_device.rings);
  HostRings g, before;
  g.offsets = points.offsets;
  before.vertices = points.vertices;
  before.source.resize(n);
  std::iota(before.source.begin(), before.source.end(), 0);  // the first of equal points
  g.vertices = download(runtime, on_device.blocks.vertices, n);
  const std::vector<cl_int> source = download(runtime, on_device.blocks.source, n);
  for (const cl_int s : source) g.source.push_back(points.source(static_cast<std::size_t>(s)));
  g.distinct = download(runtime, on_device.rings.device_distinct, points.count());
  const std::vector<cl_int> representatives = download(runtime, on_device.representatives, n);
  const std::vector<cl_int> block_of_place = call.read(halved.block_of_place, n);
  const std::vector<cl_uchar> axes = call.read(halved.axes, n);
  const auto solved = download(runtime, on_device.rings.solved, points.count());
  for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(block_of_place[i], block_twin(points, i));
  for (std::size_t b = 0; b < points.count(); ++b) {
    ASSERT_EQ(testing::broken_vertices(g, b, before), "");
    const auto first = g.vertices.begin() + points.offsets[b];
    for (const auto& [node, axis] : axes_twin({first, first + g.distinct[b]})) {
      ASSERT_EQ(axes[points.first(b) + node], axis) << "cut " << node << " of block " << b;
    }
    if (points.size(b) == 0) {
      ASSERT_EQ(solved[b].ends.first_x, -1);
      ASSERT_EQ(solved[b].unused.first, -1);
    }
    std::map<std::pair<double, double>, cl_int> first_of;
    for (std::size_t i = points.first(b); i < points.first(b + 1); ++i) {
      const cl_double2& p = points.vertices[i];
      const cl_int expected = first_of.insert({{p.s[0], p.s[1]}, points.source(i)}).first->second;
      ASSERT_EQ(representatives[static_cast<std::size_t>(points.source(i))], expected);
    }
  }
}

TEST(SmallHalve, NastyBlocks) {
  with_groups(10, [](Runtime& runtime) {
    for (const auto& [name, points] : nasty_blocks(14, 30)) {
      SCOPED_TRACE(name);
      check_halve(runtime, points);
    }
  });
}

TEST(Halve, NastyBlocks) {
  with_groups(700, [](Runtime& runtime) {
    for (const std::size_t n : {100, 701, 1500}) {
      for (const auto& [name, points] : nasty_blocks(n, n)) {
        SCOPED_TRACE(name);
        check_halve(runtime, points);
      }
    }
  });
}

TEST(Halve, SizesAboutTilesAndGroups) {
  with_groups(2000, [](Runtime& runtime) {
    BlockPoints points;
    FixtureRandom random(31);
    for (std::size_t size = 0; size < 70; ++size) points.add(make_fixture("uniform", size, size));
    for (const std::size_t size : {127, 128, 129, 255, 256, 257, 511, 513}) {
      points.add(make_fixture("uniform", size, size));
      points.add(coarse(size, 10, 10, random));
    }
    check_halve(runtime, points);
  });
}

/// Blocks that just fit local memory or do not, and points that keys of 32 bits do not tell apart.
TEST(Halve, SizesAboutLocalMemory) {
  with_groups(100000, [](Runtime& runtime) {
    BlockPoints points;
    FixtureRandom random(36);
    const std::size_t most = tuning_of(runtime).local_bytes / kernel::LOCAL_BYTES_PER_BLOCK_POINT;
    for (const std::size_t size : {most - 1, most, most + 1}) {
      points.add(make_fixture("uniform", size, size));
      points.add(coarse(size, 100, 30, random));
    }
    points.add(Coordinates(2 * (most + 1), 0.5));
    Coordinates far{0, 0};
    for (int i = 0; i < 500; ++i) {
      for (const double at : {0x1p20, -0x1p20})
        far.push_back(at + 0x1p-20 * static_cast<double>(random.integer(0, 300)));
    }
    points.add(far);
    check_halve(runtime, points);
  });
}

/// Blocks that are larger than the host has guessed get no vertices, and nothing is written about their
/// points: the numbers of these are not those of representatives.
TEST(Halve, BlocksThatAreLargerThanGuessed) {
  with_groups(50, [](Runtime& runtime) {
    FixtureRandom random(37);
    BlockPoints points;
    for (const std::size_t size : {20, 60, 300, 40}) points.add(coarse(size, 4, 60, random));
    Call call(runtime);
    DeviceBlocks on_device(call, points);
    on_device.blocks.largest = 70;
    const std::size_t n = points.points();
    const std::vector<cl_int> before = download(runtime, on_device.representatives, n);
    halve(call.work, on_device.blocks, on_device.representatives, on_device.rings);
    const std::vector<cl_int> after = download(runtime, on_device.representatives, n),
                              distinct = download(runtime, on_device.rings.device_distinct, 4);
    EXPECT_EQ(distinct[2], 0);
    for (const std::size_t b : {0u, 1u, 3u}) EXPECT_GT(distinct[b], 0);
    for (std::size_t i = points.first(2); i < points.first(3); ++i) {
      const auto own = static_cast<std::size_t>(points.source(i));
      ASSERT_EQ(after[own], before[own]);
    }
  });
}

/// Blocks of which a work-item does one each, alone or among some that are larger, or large.
TEST(SmallHalve, TinyBlocks) {
  with_groups(30, [](Runtime& runtime) {
    FixtureRandom random(35);
    for (const std::size_t others : {0, 1, 3}) {
      for (const std::int64_t width : {2, 4, 1000}) {
        BlockPoints points;
        for (std::size_t b = 0; b < 120; ++b) {
          const auto size = static_cast<std::size_t>(random.integer(0, others == 0 ? 8 : 5));
          points.add(coarse(size, width, width, random));
          if (others > b / 40 && b % 40 == 17)
            points.add(coarse(9 + 11 * (b / 40) * (b / 40), width, 30, random));
        }
        if (others == 3) points.add_places_behind(5);
        check_halve(runtime, points);
        if (HasFatalFailure()) return;
      }
    }
  });
}

/// The sort of large blocks pass by pass, beside a block that is not large.
TEST(Halve, RunsOfLargeBlocks) {
  with_groups(50, [](Runtime& runtime) {
    Call call(runtime);
    BlockPoints points;
    FixtureRandom random(32);
    points.add(coarse(300, 8, 8, random));
    points.add(make_fixture("uniform", 50, 33));
    points.add(make_fixture("uniform", 51, 34));
    const std::size_t n = points.points();
    const DeviceBlocks on_device(call, points);
    std::vector<cl_int> expected(n, -9), block_of_place(n);
    for (std::size_t i = 0; i < n; ++i) block_of_place[i] = block_twin(points, i);
    const auto device_block_of_place = testing::upload(runtime, block_of_place);
    auto order = testing::upload(runtime, expected), merged = testing::upload(runtime, expected);
    const auto sort_runs = [&](std::size_t width) {
      for (const std::size_t b : {std::size_t{0}, std::size_t{2}}) {
        const cl_double2* const block = &points.vertices[points.first(b)];
        cl_int* const places = &expected[points.first(b)];
        for (std::size_t begin = 0; begin < points.size(b); begin += width) {
          const std::size_t end = std::min(points.size(b), begin + width);
          std::stable_sort(places + begin, places + end, [block](cl_int i, cl_int j) {
            return testing::comes_first(block[i], block[j], 0);
          });
        }
      }
    };
    for (const std::size_t b : {std::size_t{0}, std::size_t{2}}) {
      std::iota(&expected[points.first(b)], &expected[points.first(b)] + points.size(b), 0);
    }
    runtime.map(n, kernels::sort_large_tiles{.capacity = 50,
                                             .offsets = on_device.blocks.offsets,
                                             .block_of_place = device_block_of_place,
                                             .points = on_device.blocks.vertices,
                                             .order = order});
    sort_runs(kernel::SORTED_TILE);
    ASSERT_TRUE(same(download(runtime, order, n), expected));
    for (std::size_t width = kernel::SORTED_TILE; width < points.largest(); width *= 2) {
      runtime.map(n, kernels::merge_large_runs{.capacity = 50,
                                               .width = width,
                                               .offsets = on_device.blocks.offsets,
                                               .block_of_place = device_block_of_place,
                                               .points = on_device.blocks.vertices,
                                               .order = order,
                                               .merged = merged});
      std::swap(order, merged);
      sort_runs(2 * width);
      ASSERT_TRUE(same(download(runtime, order, n), expected)) << "runs of " << 2 * width;
    }
    const auto flags = guarded<cl_uint>(runtime, n);
    runtime.map(n, kernels::flag_distinct{.capacity = 50,
                                          .offsets = on_device.blocks.offsets,
                                          .block_of_place = device_block_of_place,
                                          .points = on_device.blocks.vertices,
                                          .order = order,
                                          .flags = flags});
    const std::vector<cl_uint> found = download(runtime, flags, n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto b = static_cast<std::size_t>(block_of_place[i]);
      const cl_double2* const block = &points.vertices[points.first(b)];
      const bool is_first = i == points.first(b);
      const bool is_new =
          b != 1 && (is_first || testing::comes_first(block[expected[i - 1]], block[expected[i]], 0));
      ASSERT_EQ(found[i], is_new ? 1u : 0u) << i;
    }
  });
}

}  // namespace

}  // namespace flaunay::blocks
