// The stage `divide`: the edge rings of blocks and of what is merged from them.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/blocks/support.hpp"
#include "tests/support/ingest_twin.hpp"

namespace flaunay::blocks {

void check_rings(Call& call, const Coordinates& coordinates, const Offsets& offsets, const Blocks& blocks,
                 const Rings& rings, const std::vector<cl_int>& representatives, HostRings& g, Met& met) {
  SCOPED_TRACE("rings");
  const std::size_t n = offsets.back();
  EXPECT_TRUE(same(representatives, testing::ingest_twin(coordinates, offsets).representatives));
  const HostRings before = g;
  g.vertices = call.read(blocks.vertices, n);
  g.source = call.read(blocks.source, n);
  ASSERT_EQ(rings.edges.size(), testing::kEdgesPerPoint * n);
  g.edges = call.read(rings.edges, rings.edges.size());
  g.vertex_edge = call.read(rings.vertex_edge, n);
  g.block_ends.clear();
  for (const auto& block : call.read(rings.solved, blocks.count)) g.block_ends.push_back(block.ends);
  g.distinct = rings.distinct;
  for (std::size_t b = 0; b < blocks.count; ++b) {
    ASSERT_EQ(testing::broken_vertices(g, b, before), "");
  }
  for (std::size_t s = 0; s < g.sets(); ++s) {
    RingCheck check(g, s);
    ASSERT_EQ(check.run(), "") << "set " << s;
    const auto size = offsets[s + 1] - offsets[s];
    if (size > kReferencePoints) continue;
    std::vector<std::int32_t> expected =
        testing::flat_triangles(testing::reference_delaunay(coordinates.data() + 2 * offsets[s], size));
    for (std::int32_t& i : expected) i += static_cast<std::int32_t>(offsets[s]);
    ASSERT_TRUE(same(testing::flat_triangles(testing::sorted_triangles(check.triangles())), expected))
        << "set " << s;
    met.flat += expected.empty();
  }
  for (std::size_t i = 0; i < n; ++i) met.duplicates += representatives[i] != static_cast<cl_int>(i);
}

/// Two triangles over a square, by hand, in a block with room for more.
HostRings square_rings() {
  HostRings g;
  g.set_blocks = {0, 1};
  g.offsets = {0, 4};
  g.spans = {1};
  g.vertices = {{{0, 0}}, {{4, 0}}, {{4, 4}}, {{0, 4}}};
  g.source = {0, 1, 2, 3};
  g.distinct = {4};
  // Vertices 0 to 3 counter-clockwise, edges 2k from k to k + 1, and 8 from 0 to 2.
  g.edges = {{1, 8, 7}, {0, 2, 2}, {2, 1, 1}, {1, 4, 9}, {3, 9, 3},
             {2, 6, 6}, {0, 5, 5}, {3, 0, 8}, {2, 7, 0}, {0, 3, 4}};
  for (cl_int e = 10; e < 24; ++e) g.edges.push_back({-1, e % 2 == 0 && e < 22 ? e + 2 : -1, e});
  g.vertex_edge = {0, 2, 4, 6};
  g.block_ends = {{0, 2, 1, 3}};
  return g;
}

namespace {}  // namespace

}  // namespace flaunay::blocks
