// The stage `merge`: blocks that are solved by halves, all at once. RingCheck says what must hold of each;
// that halves have the vertices and representatives that they should have is tested in halve_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <set>
#include <vector>

#include "blocks/codes.h"
#include "blocks/halving.h"
#include "blocks/limits.h"
#include "blocks/parts.hpp"
#include "blocks/records.h"
#include "blocks/seams.h"
#include "launchers/blocks/merge.cl.hpp"
#include "launchers/blocks/seams.cl.hpp"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "predicates/bounds.h"
#include "prove/exact.hpp"
#include "tests/blocks/support.hpp"

namespace flaunay::blocks {
namespace {

using testing::download;
using testing::kNone;

/// What solving blocks leaves behind.
struct Solution {
  HostRings g;  ///< each block is a set
  std::vector<kernel::solved_block> solved;
  std::vector<cl_uint> account;

  Solution(Call& call, const BlockPoints& points, const DeviceBlocks& on_device) {
    const std::size_t n = points.points();
    Runtime& runtime = call.runtime;
    g.set_blocks.resize(points.count() + 1);
    std::iota(g.set_blocks.begin(), g.set_blocks.end(), 0);
    g.spans.assign(g.set_blocks.begin() + 1, g.set_blocks.end());
    g.offsets = points.offsets;
    g.vertices = download(runtime, on_device.blocks.vertices, n);
    g.source = download(runtime, on_device.blocks.source, n);
    g.edges = download(runtime, on_device.rings.edges, kernel::EDGES_PER_VERTEX * n);
    g.vertex_edge = download(runtime, on_device.rings.vertex_edge, n);
    g.distinct = download(runtime, on_device.rings.device_distinct, points.count());
    solved = download(runtime, on_device.rings.solved, points.count());
    for (const kernel::solved_block& block : solved) g.block_ends.push_back(block.ends);
    account = download(runtime, on_device.rings.device_account, std::size_t{kernel::RINGS_NUMBERS});
    // Places without a vertex may have any numbers.
    for (std::size_t v = 0; v < n; ++v) {
      if (g.vertex_edge[v] == kNone) g.vertices[v] = {};
    }
  }

  /// The neighbours of a vertex in their order, from the one that its edge leads to.
  std::vector<cl_int> ring(cl_int v) const {
    std::vector<cl_int> ring;
    const cl_int start = g.edge_of(v);
    if (start == kNone) return ring;
    cl_int e = start;
    do {
      ring.push_back(g.to(e));
      e = g.edge(e).next;
    } while (e != start && ring.size() <= g.vertices.size());
    return ring;
  }

  /// The edges between two triangles whose vertices are on one circle, each counted twice.
  std::size_t ties() const {
    ExactPredicates exact;
    std::size_t ties = 0;
    for (cl_int v = 0; v < g.offsets.back(); ++v) {
      const std::vector<cl_int> around = ring(v);
      for (std::size_t k = 0; k < around.size(); ++k) {
        const cl_int right = around[k], middle = around[(k + 1) % around.size()],
                     left = around[(k + 2) % around.size()];
        const double *const p = g.point(v).s, *const r = g.point(right).s, *const m = g.point(middle).s,
                            *const l = g.point(left).s;
        ties += exact.orient2d(p, r, m) > 0 && exact.orient2d(p, m, l) > 0 && exact.incircle(p, r, m, l) == 0;
      }
    }
    return ties;
  }

  /// What is wrong with the edges of a block that are not in use, or "".
  std::string broken_free_list(std::size_t b) const {
    const cl_int first = kernel::EDGES_PER_VERTEX * g.offsets[b];
    const cl_int end = kernel::EDGES_PER_VERTEX * g.offsets[b + 1];
    std::set<cl_int> free;
    for (cl_int e = first; e < end; e += 2) {
      if (g.used(e) != g.used(e ^ 1)) return "an edge is half used";
      if (!g.used(e)) free.insert(e);
    }
    const kernel::free_edges list = solved[b].unused;
    if (free.empty()) return list.first == kNone && list.last == kNone ? "" : "a list of no edges";
    for (cl_int e = list.first; e != kNone; e = g.edge(e).next) {
      if (free.erase(e) == 0) return "an edge is in the list and should not";
      if ((e == list.last) != (g.edge(e).next == kNone)) return "the list has another end";
    }
    return free.empty() ? "" : "an edge is not in the list";
  }
};

void check_merge_as_tuned(Runtime& runtime, const BlockPoints& points, Bounds bounds, Met& met) {
  Call call(runtime);
  call.work.bounds = bounds;
  const DeviceBlocks on_device(call, points);
  solve_in_parallel(call.work, on_device.blocks, on_device.representatives, on_device.rings);
  const Solution found(call, points, on_device);
  const bool is_coarse = bounds.circle == 0;  // so that merges break ties at once
  // Which predicates are undecided depends on the order of merges. But ties of the result must be known.
  if (!is_coarse && found.account[kernel::RINGS_TIES] == 0) {
    ASSERT_EQ(found.ties(), 0u);
  }
  met.ties += found.account[kernel::RINGS_TIES];
  for (std::size_t b = 0; b < points.count(); ++b) {
    RingCheck check(found.g, b, is_coarse);
    ASSERT_EQ(check.run(), "") << "block " << b;
    ASSERT_EQ(found.broken_free_list(b), "") << "block " << b;
    met.triangles += check.triangles().size() / 3;
  }
}

void set_local_vertices(Runtime& runtime, std::size_t vertices, std::size_t star_points = 0) {
  Tuning tuning = tuning_of(runtime);
  tuning.local_vertices = vertices;
  tuning.star_points = star_points;
  tuning.merge_items = vertices > 0 ? 1 << 20 : 500;  // so that small blocks are there, too
  runtime.set_sizes(std::make_shared<Tuning>(tuning));
}

/// In global memory, and from parts in local memory on, small and large ones; and what stars leave. PoCL
/// takes ten seconds to compile these for a size of groups, so they have few.
void check_merge(Runtime& runtime, const BlockPoints& points, Bounds bounds, Met& met) {
  const std::size_t group = tuning_of(runtime).halve_group;
  for (const auto& [vertices, star_points] :
       {std::pair{0, 0}, {16, 0}, {static_cast<int>(kernel::LOCAL_VERTICES), 0}, {16, 1 << 20}}) {
    if (vertices > 0 && group != 2 && (group != 256 || star_points > 0)) continue;
    SCOPED_TRACE("vertices in local memory: " + std::to_string(vertices) +
                 (star_points > 0 ? ", after stars" : ""));
    set_local_vertices(runtime, vertices, star_points);
    check_merge_as_tuned(runtime, points, bounds, met);
  }
}

const Bounds kUsualBounds{HULL_DEPTH_BOUND, ORIENT_BOUND, CIRCLE_BOUND};
/// No filter decides anything.
const Bounds kNoBounds{2, 2, 2};

TEST(SmallMerge, NastyBlocks) {
  with_groups(10, [](Runtime& runtime) {
    Met met;
    for (const auto& [name, points] : nasty_blocks(14, 40)) {
      SCOPED_TRACE(name);
      check_merge(runtime, points, kUsualBounds, met);
    }
    EXPECT_GT(met.triangles, 100u);
    EXPECT_GT(met.ties, 10u);
  });
}

TEST(Merge, NastyBlocks) {
  with_groups(700, [](Runtime& runtime) {
    Met met;
    for (const std::size_t n : {60, 701, 1500}) {
      for (const auto& [name, points] : nasty_blocks(n, n)) {
        SCOPED_TRACE(name);
        check_merge(runtime, points, kUsualBounds, met);
      }
    }
    EXPECT_GT(met.ties, 1000u);
  });
}

/// Each leaf and each merge stops, at its first predicate.
TEST(Merge, NothingIsDecidedByFilters) {
  with_groups(700, [](Runtime& runtime) {
    Met met;
    for (const auto& [name, points] : nasty_blocks(200, 41)) {
      SCOPED_TRACE(name);
      check_merge(runtime, points, kNoBounds, met);
    }
  });
}

/// Ties are broken at once, and nothing stops.
TEST(Merge, CoarseCoordinates) {
  with_groups(700, [](Runtime& runtime) {
    Met met;
    FixtureRandom random(42);
    for (const std::int64_t width : {3, 16, 60}) {
      BlockPoints points;
      for (const std::size_t n : {1000, 30, 7}) points.add(coarse(n, width, 2 * width, random));
      check_merge(runtime, points, {0, 0, 0}, met);
    }
    EXPECT_EQ(met.ties, 0u);
    EXPECT_GT(met.triangles, 2000u);
  });
}

TEST(Merge, AllSizesOfSmallBlocks) {
  with_groups(100, [](Runtime& runtime) {
    BlockPoints points;
    FixtureRandom random(43);
    for (std::size_t n = 0; n < 90; ++n) {
      points.add(make_fixture("uniform", n, n));
      points.add(coarse(n, 5, 5, random));
    }
    Met met;
    check_merge(runtime, points, kUsualBounds, met);
  });
}

/// Points between the arms of a parabola that opens along an axis, or against it: more than a half is as wide
/// as all of it.
Coordinates trumpet(std::size_t n, int direction, std::uint64_t seed) {
  FixtureRandom random(seed);
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const double along = (direction & 1 ? -1 : 1) * random.unit();
    const double across = (2 * random.unit() - 1) * along * along;
    points.push_back(direction & 2 ? across : along);
    points.push_back(direction & 2 ? along : across);
  }
  return points;
}

/// Seams that begin and end at the same vertex of one side, all of whose others are between the tangents.
TEST(Merge, SeamsAroundASide) {
  with_groups(1 << 20, [](Runtime& runtime) {
    BlockPoints points;
    for (std::size_t n = 8; n < 200; n += 3) {
      for (int direction = 0; direction < 4; ++direction) points.add(trumpet(n, direction, n));
    }
    Met met;
    check_merge(runtime, points, kUsualBounds, met);
    EXPECT_GT(met.triangles, 10000u);
  });
}

/// A block whose two halves, of the height below the last one, are still to be merged, and their seam's
/// walks. The coordinates are so coarse that nothing stops.
struct WalkedSeam {
  static constexpr std::size_t kPoints = 60, kPairs = kernel::PAIRS_PER_VERTEX * kPoints;

  explicit WalkedSeam(Call& device_call)
      : call(device_call), points(spread_points()), on_device(device_call, points) {
    Runtime& runtime = call.runtime;
    call.work.bounds = {0, 0, 0};
    halved = halve(call.work, on_device.blocks, on_device.representatives, on_device.rings);
    parts = runtime.arena().allocate<kernel::solved_block>(kPoints);
    const auto states = runtime.arena().allocate<cl_int>(kPoints);
    const auto& [blocks, representatives, rings] = on_device;
    for (int height = 0; height < kHeight; ++height) {
      const std::size_t cells = (kPoints + (2u << height) - 1) / (2u << height);
      runtime.map(cells,
                  kernels::merge_parts{.spread = 1,
                                       .places_of_parts = places_of_parts(blocks, halved, rings, height),
                                       .bounds = call.work.bounds,
                                       .rings_of_parts = own_rings(),
                                       .states = states,
                                       .account = rings.device_account});
    }
    crossings = runtime.arena().allocate<cl_int2>(2 * kernel::CROSSINGS_PER_VERTEX * kPoints);
    removals = runtime.arena().allocate<cl_int>(2 * kernel::CROSSINGS_PER_VERTEX * kPoints);
    is_removed = testing::upload(runtime, std::vector<cl_uchar>(2 * kPairs, 0));
    walks = testing::guarded<kernel::seam_walk>(runtime, 2);
    runtime.map(2, kernels::walk_seams{.spread = 1,
                                       .places_of_parts = places_of_parts(blocks, halved, rings, kHeight),
                                       .bounds = call.work.bounds,
                                       .rings_of_parts = own_rings(),
                                       .crossings = crossings,
                                       .removals = removals,
                                       .is_removed = is_removed,
                                       .walks = walks,
                                       .account = rings.device_account});
  }
  kernels::rings_of_parts own_rings() const {
    return {.points = on_device.blocks.vertices,
            .edges = on_device.rings.edges,
            .vertex_edge = on_device.rings.vertex_edge,
            .parts = parts,
            .solved = on_device.rings.solved};
  }
  /// Distinct points of a grid.
  static BlockPoints spread_points() {
    Coordinates grid;
    for (std::size_t i = 0; i < kPoints; ++i) {
      grid.push_back(static_cast<double>(i % 8));
      grid.push_back(static_cast<double>(i / 8));
    }
    BlockPoints points;
    points.add(grid);
    return points;
  }
  /// With groups as the runtime has them. up: the upward walk.
  Solution sewn(const kernel::seam_walk& up) {
    Runtime& runtime = call.runtime;
    const auto& [blocks, representatives, rings] = on_device;
    std::vector<kernel::seam_walk> both = download(runtime, walks, 2);
    both[0] = up;
    const std::size_t group = tuning_of(runtime).sewing_group;
    runtime.launch(group, group,
                   kernels::sew_seams{.cells = 1,
                                      .places_of_parts = places_of_parts(blocks, halved, rings, kHeight),
                                      .rings_of_parts = own_rings(),
                                      .crossings = crossings,
                                      .walks = testing::upload(runtime, both),
                                      .removals = removals,
                                      .is_removed = is_removed,
                                      .account = rings.device_account});
    return {call, points, on_device};
  }

  static const int kHeight;
  Call& call;
  BlockPoints points;
  DeviceBlocks on_device;
  HalvedBlocks halved;
  Buffer<kernel::solved_block> parts{};
  Buffer<cl_int2> crossings{};
  Buffer<cl_int> removals{};
  Buffer<cl_uchar> is_removed{};
  Buffer<kernel::seam_walk> walks{};
};
const int WalkedSeam::kHeight = kernel::halving_depth(kPoints);

/// Halves whose walks do not meet, or have no result, stay as they are, and the account says that there are
/// some.
TEST(SmallMerge, WalksThatDoNotMeet) {
  with_groups(1 << 20, [](Runtime& runtime) {
    for (const std::string change : {"none", "too short", "without a result"}) {
      SCOPED_TRACE(change);
      Call call(runtime);
      WalkedSeam seam(call);
      const Solution before(call, seam.points, seam.on_device);
      kernel::seam_walk up = download(runtime, seam.walks, 2)[0];
      ASSERT_GT(up.crossings, 2);
      if (change == "too short") up.crossings = 1;
      if (change == "without a result") up.outcome = kernel::WALK_HAS_STOPPED;
      const Solution after = seam.sewn(up);
      EXPECT_EQ(after.account[kernel::RINGS_BROKEN], change == "none" ? 0u : 1u);
      EXPECT_EQ(after.broken_free_list(0), "");
      const std::vector<cl_uchar> marks = download(runtime, seam.is_removed, 2 * WalkedSeam::kPairs);
      EXPECT_EQ(std::count(marks.begin(), marks.end(), 0), std::ptrdiff_t{2 * WalkedSeam::kPairs});
      std::size_t changed = 0;
      for (cl_int v = 0; v < static_cast<cl_int>(WalkedSeam::kPoints); ++v) {
        changed += before.ring(v) != after.ring(v);
      }
      EXPECT_EQ(changed > 0, change == "none") << changed;
      Rings rings = seam.on_device.rings;
      Blocks blocks;
      blocks.count = 1;
      if (change == "none") {
        EXPECT_NO_THROW(await_rings(call.work, blocks, rings));
      } else {
        EXPECT_THROW(await_rings(call.work, blocks, rings), Error);
      }
    }
  });
}

/// A vertex amid so many others.
Coordinates hub(int others) {
  Coordinates points{0, 0};
  for (int i = 0; i < others; ++i) {
    const double angle = 6.28 * i / others, radius = 1 + 0.001 * i;
    points.insert(points.end(), {radius * std::cos(angle), radius * std::sin(angle)});
  }
  return points;
}

/// Blocks that are solved by stars, without merges: with a last tile of one vertex, with vertices to which
/// too many are near, since others of their tile are far away, and with the largest star. The last block has
/// a larger one.
TEST(Merge, StarsOfLargeUnits) {
  with_groups(700, [](Runtime& runtime) {
    if (tuning_of(runtime).halve_group < 64) return;
    set_local_vertices(runtime, 0, 1 << 20);
    BlockPoints points;
    for (const std::size_t n : {17, 513, 1025, 2048}) points.add(make_fixture("uniform", n, n));
    Coordinates cluster = make_fixture("uniform", 700, 45);
    for (const double far : {300, 400, 500}) cluster.insert(cluster.end(), {far, far * far});
    points.add(cluster);
    points.add(hub(kernel::MOST_STAR - 1));
    points.add(hub(kernel::MOST_STAR));
    Call call(runtime);
    call.work.bounds = kUsualBounds;
    const DeviceBlocks on_device(call, points);
    const auto& [blocks, representatives, rings] = on_device;
    PartsOfBlocks parts;
    parts.halved = halve(call.work, blocks, representatives, rings);
    parts.ends = runtime.arena().allocate<kernel::solved_block>(points.points());
    merge_halves(call.work, blocks, parts, rings, 0, -1);
    const Solution found(call, points, on_device);
    EXPECT_EQ(found.account[kernel::RINGS_BROKEN], 0u);
    std::vector<cl_int> left(points.points());
    runtime.read(parts.halved.block_of_place, 0, left.size(), left.data());
    for (std::size_t b = 0; b < points.count(); ++b) {
      SCOPED_TRACE("block " + std::to_string(b));
      const bool is_solved = b + 1 < points.count();
      ASSERT_EQ(left[points.first(b)], is_solved ? -1 : static_cast<cl_int>(b));
      if (!is_solved) continue;
      RingCheck check(found.g, b, false);
      ASSERT_EQ(check.run(), "");
      ASSERT_EQ(found.broken_free_list(b), "");
    }
  });
}

/// What a GPU is asked to do: see solve_in_parallel.
TEST(Merge, LaunchesAreFew) {
  with_groups(1 << 20, [](Runtime& runtime) {
    BlockPoints points;
    for (int b = 0; b < 4; ++b) points.add(make_fixture("uniform", 2048, 44));
    for (const std::size_t vertices : {0, 512}) {
      if (vertices > 0 && tuning_of(runtime).halve_group != 256) continue;
      set_local_vertices(runtime, vertices);
      Call call(runtime);
      call.work.bounds = kUsualBounds;
      const DeviceBlocks on_device(call, points);
      const std::size_t launches = runtime.accounts().launches, waits = runtime.accounts().waits;
      solve_in_parallel(call.work, on_device.blocks, on_device.representatives, on_device.rings);
      // From height 2 on, with 8 points, merges are from both ends, and they begin with a fill, unless local
      // memory has all up to height 7.
      EXPECT_EQ(runtime.accounts().launches - launches, 1u + (vertices == 0 ? 2 * 2 + 1 + 3 * 8 : 2 + 3 * 2));
      EXPECT_EQ(runtime.accounts().waits, waits);
    }
  });
}

}  // namespace

}  // namespace flaunay::blocks
