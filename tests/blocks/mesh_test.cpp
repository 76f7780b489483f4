// The stage `mesh`: triangles, neighbours and hulls from edge rings.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/blocks/support.hpp"
#include "tests/support/errors.hpp"

namespace flaunay::blocks {
namespace {

// As callers do it.
void run_mesh(Call& call, const Blocks& blocks, const Rings& rings, bool neighbors, Triangulation& result) {
  Runtime& runtime = call.runtime;
  host::Arena::Scope scope(runtime.arena());
  MeshSizes sizes = count_mesh(call.work, blocks, rings);
  const std::size_t rows = 3 * sizes.triangles();
  result.triangles.assign(rows, -7);
  result.neighbors.assign(neighbors ? rows : 0, -7);
  result.halfedges.assign(neighbors ? rows : 0, -7);
  result.hull.assign(sizes.hull_vertices(), -7);
  DeviceMesh buffers;
  buffers.triangles = runtime.output(result.triangles);
  if (neighbors) buffers.neighbors = runtime.output(result.neighbors);
  if (neighbors) buffers.halfedges = runtime.output(result.halfedges);
  buffers.hull = runtime.output(result.hull);
  write_mesh(call.work, blocks, rings, sizes, buffers);
  runtime.fetch_later(buffers.triangles, result.triangles);
  runtime.fetch_later(buffers.neighbors, result.neighbors);
  runtime.fetch_later(buffers.halfedges, result.halfedges);
  runtime.fetch_later(buffers.hull, result.hull);
  runtime.finish();
  result.triangle_offsets = sizes.triangle_offsets;
  result.hull_offsets = sizes.hull_offsets;
  result.statistics.duplicates = blocks.points - sizes.vertices;
}

}  // namespace

void check_mesh(Call& call, const Blocks& blocks, const Rings& rings, bool neighbors, const HostRings& g,
                Triangulation& result, Met& met) {
  SCOPED_TRACE(neighbors ? "mesh with neighbours" : "mesh without neighbours");
  const MeshTwin twin(g);
  call.runtime.write(rings.edges, 0, g.edges.size(), g.edges.data());
  run_mesh(call, blocks, rings, neighbors, result);
  EXPECT_TRUE(same(result.triangle_offsets, twin.triangle_offsets));
  EXPECT_TRUE(same(result.hull_offsets, twin.hull_offsets));
  EXPECT_TRUE(same(result.triangles, twin.triangles));
  EXPECT_TRUE(same(result.hull, twin.hull));
  EXPECT_TRUE(same(result.neighbors,
                   neighbors ? testing::reference_neighbors(twin.triangles) : std::vector<std::int32_t>()));
  EXPECT_TRUE(same(result.halfedges,
                   neighbors ? testing::reference_halfedges(twin.triangles) : std::vector<std::int32_t>()));
  EXPECT_EQ(result.statistics.duplicates, blocks.points - twin.vertices);
  // The rings stay as they are, but for what says that the outside is on an edge's left and, with neighbours,
  // the places of opposite corners.
  const auto edges = call.read(rings.edges, g.edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    ASSERT_EQ(edges[e].to, g.edges[e].to) << "edge " << e;
    if (edges[e].to == testing::kNone) continue;
    const cl_int next = g.edges[e].next;
    const bool is_outside = twin.outside[e];
    ASSERT_EQ(edges[e].next, is_outside ? ~next : next) << "edge " << e;
    const cl_int place = edges[e].previous;
    if (!neighbors || is_outside) {
      ASSERT_EQ(place, g.edges[e].previous) << "edge " << e;
      continue;
    }
    ASSERT_TRUE(place >= 0 && place < static_cast<cl_int>(result.triangles.size())) << "edge " << e;
    const auto id = [&](cl_int edge) { return g.source[g.edges[edge].to]; };
    const cl_int *const row = &result.triangles[place / 3 * 3], corner = place % 3;
    ASSERT_EQ(row[corner], id(next)) << "edge " << e;
    ASSERT_EQ(row[(corner + 1) % 3], id(static_cast<cl_int>(e) ^ 1)) << "edge " << e;
    ASSERT_EQ(row[(corner + 2) % 3], id(static_cast<cl_int>(e))) << "edge " << e;
  }
  met.triangles += twin.triangles.size() / 3;
}

namespace {

TEST(SmallMesh, NumbersThatDoNotFitAreReported) {
  Runtime& runtime = Runtimes::get("own");
  const Coordinates coordinates = make_fixture("uniform", 10, 21);
  Call call(runtime);
  Triangulation result;
  result.representatives.resize(10);
  const auto representatives = runtime.output(result.representatives);
  const Blocks blocks =
      *make_blocks(call.work, runtime.view(coordinates.data(), 20), {0, 10}, representatives);
  Rings rings = divide(call.work, blocks, representatives);
  await_rings(call.work, blocks, rings);
  const auto edges = call.read(rings.edges, rings.edges.size());
  run_mesh(call, blocks, rings, true, result);
  const cl_int right = rings.distinct[0];
  for (const cl_int wrong : {right - 1, right + 1}) {
    rings.distinct[0] = wrong;
    runtime.write(rings.edges, 0, edges.size(), edges.data());
    testing::expect_error(ErrorKind::internal, {"triangles instead of"},
                          [&] { run_mesh(call, blocks, rings, true, result); });
  }
}

/// Edges that merges removed stay as they were but for what says so; divide() happens to use all of them
/// again.
TEST(SmallMesh, RemovedEdgesAreNoTriangles) {
  Runtime& runtime = Runtimes::get("own");
  HostRings g = square_rings();
  for (const cl_int e : {11, 13}) g.edges[static_cast<std::size_t>(e)].previous = e + 1;
  ASSERT_EQ(RingCheck(g, 0).run(), "");
  Call call(runtime);
  Blocks blocks;
  blocks.sets = blocks.count = 1;
  blocks.points = g.vertices.size();
  blocks.set_blocks = g.set_blocks;
  blocks.offsets = g.offsets;
  blocks.device_set_blocks = testing::upload(runtime, g.set_blocks);
  blocks.device_offsets = testing::upload(runtime, g.offsets);
  blocks.vertices = testing::upload(runtime, g.vertices);
  blocks.source = testing::upload(runtime, g.source);
  Rings rings;
  rings.edges = call.work.persistent.allocate<kernel::ring_edge>(g.edges.size());
  runtime.write(rings.edges, 0, g.edges.size(), g.edges.data());
  rings.vertex_edge = testing::upload(runtime, g.vertex_edge);
  rings.solved = testing::upload(runtime, std::vector<kernel::solved_block>{{g.block_ends[0], {}}});
  rings.distinct = g.distinct;
  Met met;
  Triangulation result;
  check_mesh(call, blocks, rings, true, g, result, met);
  EXPECT_EQ(met.triangles, 2u);
}

}  // namespace

}  // namespace flaunay::blocks
