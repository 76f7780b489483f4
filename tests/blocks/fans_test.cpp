// The stage `fans`, on sets that consist of polygons of cocircular points. RingCheck, its twin, knows the
// edges that the canonical triangulation has.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/blocks/support.hpp"

namespace flaunay::blocks {
namespace {

// Exact products, whose many bits make ties undecided.
constexpr double kFine = 1 + 0x1p-30;

void add_point(double x, double y, Coordinates& points) {
  points.insert(points.end(), {x * kFine, y * kFine});
}

/// All integer points of the circle with this radius.
void add_circle(int radius, double x, double y, Coordinates& points) {
  for (int i = -radius; i <= radius; ++i) {
    const int square = radius * radius - i * i;
    const int j = static_cast<int>(std::lround(std::sqrt(square)));
    if (j * j != square) continue;
    add_point(x + i, y + j, points);
    if (j != 0) add_point(x + i, y - j, points);
  }
}

/// Polygons alone, around a point, around each other, and side by side with vertices and sides in common.
Nested polygons(int radius, int count) {
  Nested all;
  Coordinates points;
  add_circle(radius, 3, -2, points);
  all.add(points);
  add_point(4, -1, points);
  all.add(points);
  points.clear();
  for (int k = 1; k <= count; ++k) add_circle(k * radius, 0, 0, points);
  all.add(points);
  points.clear();
  for (int k = 0; k < count; ++k) add_circle(radius, 2 * k * radius, 0, points);
  all.add(points);
  points.clear();
  for (int i = 0; i <= count; ++i) {
    for (int j = 0; j <= count; ++j) add_point(5 * i - 3 * j, 3 * i + 5 * j, points);
  }
  all.add(points);
  return all;
}

TEST(SmallFans, OfPolygons) {
  under_each_tuning([](Runtime& runtime) {
    const Nested sets = polygons(5, 2);
    Met met;
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.ties, 20u);
  });
}

TEST(Fans, OfPolygons) {
  under_each_tuning([](Runtime& runtime) {
    const Nested sets = polygons(65 * 17, 6);
    Met met;
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.ties, 1000u);
    // One set that many blocks share.
    check_stages(runtime, make_fixture("integer-star", 4000, 1), met);
  });
}

/// A set that is divided, but has no fans yet.
struct Divided {
  Call call;
  Triangulation result;
  Blocks blocks;
  Rings rings;

  Divided(Runtime& runtime, const Coordinates& coordinates) : call(runtime) {
    const std::size_t n = coordinates.size() / 2;
    result.representatives.resize(n);
    const auto representatives = runtime.output(result.representatives);
    const auto input = runtime.view(coordinates.data(), coordinates.size());
    blocks = *make_blocks(call.work, input, {0, n}, representatives);
    rings = divide(call.work, blocks, representatives);
    await_rings(call.work, blocks, rings);
  }
};

/// Merges by single work-items leave ties only in polygons of five points and more, others all.
TEST(SmallFans, ThatMergesLeave) {
  under_each_tuning([](Runtime& runtime) {
    const bool leaves_all = tuning_of(runtime).blocks_in_parallel != 0;
    Coordinates lattice, circle;
    for (int k = 0; k < 36; ++k) add_point(5 * (k / 6) - 3 * (k % 6), 3 * (k / 6) + 5 * (k % 6), lattice);
    add_circle(65, 0, 0, circle);
    const Divided quadrilaterals(runtime, lattice), polygon(runtime, circle);
    EXPECT_GT(quadrilaterals.rings.ties, 5u);
    EXPECT_EQ(quadrilaterals.rings.ties_left, leaves_all ? quadrilaterals.rings.ties : 0);
    EXPECT_GT(polygon.rings.ties_left, 0u);
  });
}

/// In one launch, by a work-group per block, as by passes over all pairs of edges.
TEST(SmallFans, OfBlocksAreThoseOfAllPasses) {
  under_each_tuning([](Runtime& runtime) {
    Coordinates points;
    for (int k = 0; k < 36; ++k) add_point(5 * (k / 6) - 3 * (k % 6), 3 * (k / 6) + 5 * (k % 6), points);
    add_circle(65, 200, 0, points);
    const std::size_t n = points.size() / 2;
    std::vector<kernel::ring_edge> edges[2];
    std::vector<cl_int> vertex_edge[2];
    for (const bool by_block : {false, true}) {
      Call call(runtime);
      std::vector<cl_int> representatives(n);
      const auto output = runtime.output(representatives);
      const auto input = runtime.view(points.data(), points.size());
      const Blocks blocks = *make_blocks(call.work, input, {0, n}, output);
      const Rings rings = solve(call.work, blocks, output, make_account(call.work));
      (by_block ? make_fans_of_blocks : make_fans)(call.work, blocks, rings);
      edges[by_block] = call.read(rings.edges, rings.edges.size());
      vertex_edge[by_block] = call.read(rings.vertex_edge, n);
    }
    // Where merges have made quadrilaterals, other passes take their diagonals for edges that stay.
    if (tuning_of(runtime).blocks_in_parallel != 0) {
      EXPECT_EQ(vertex_edge[0], vertex_edge[1]);
    }
    for (std::size_t e = 0; e < edges[0].size(); ++e) {
      if (edges[0][e].to < 0) continue;
      EXPECT_EQ(edges[0][e].to, edges[1][e].to);
      EXPECT_EQ(edges[0][e].next, edges[1][e].next);
      EXPECT_EQ(edges[0][e].previous, edges[1][e].previous);
    }
  });
}

/// Nothing changes where no points are cocircular.
TEST(SmallFans, OfNoPolygons) {
  Runtime& runtime = Runtimes::get("own");
  Divided divided(runtime, make_fixture("uniform", 40, 2));
  auto& [call, result, blocks, rings] = divided;
  EXPECT_EQ(rings.ties, 0u);
  const auto before = call.read(rings.edges, rings.edges.size());
  make_fans(call.work, blocks, rings);
  const auto after = call.read(rings.edges, rings.edges.size());
  for (std::size_t e = 0; e < before.size(); ++e) {
    EXPECT_EQ(before[e].to, after[e].to);
    EXPECT_EQ(before[e].next, after[e].next);
    EXPECT_EQ(before[e].previous, after[e].previous);
  }
}

}  // namespace
}  // namespace flaunay::blocks
