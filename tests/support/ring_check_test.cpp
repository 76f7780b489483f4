// What RingCheck says when something of the rings is changed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <set>
#include <vector>

#include "tests/blocks/support.hpp"

namespace flaunay::blocks {
namespace {

/// What RingCheck says when something of the rings is changed.
TEST(SmallTwins, RingCheckFindsWhatIsBroken) {
  const HostRings g = square_rings();
  RingCheck unchanged(g, 0);
  ASSERT_EQ(unchanged.run(), "");
  EXPECT_EQ(unchanged.triangles(), (std::vector<std::int32_t>{0, 1, 2, 2, 3, 0}));
  const MeshTwin mesh(g);
  EXPECT_EQ(mesh.triangles, (std::vector<std::int32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(mesh.hull, (std::vector<std::int32_t>{0, 1, 2, 3}));
  for (std::size_t e = 0; e < mesh.outside.size(); ++e)
    EXPECT_EQ(mesh.outside[e], e == 1 || e == 3 || e == 5 || e == 7);

  const auto found = [&](const std::function<void(HostRings&)>& change) {
    HostRings changed = g;
    change(changed);
    return RingCheck(changed, 0).run();
  };
  EXPECT_EQ(found([](HostRings& h) { h.edges[1].to = -1; }), "edge 0 is half used");
  EXPECT_EQ(found([](HostRings& h) { h.edges[11].previous = 24; }), "edge 11 is before none");
  EXPECT_EQ(found([](HostRings& h) { h.edges[0].previous = 8; }), "the edge after 7 does not point back");
  EXPECT_EQ(found([](HostRings& h) { h.edges[1].next = 4; }), "edge 1 is in the ring of another vertex");
  EXPECT_EQ(found([](HostRings& h) { h.edges[14].next = -1; }), "2 free lists");
  EXPECT_EQ(found([](HostRings& h) { h.edges[14].next = 4; }), "2 free lists");
  EXPECT_EQ(found([](HostRings& h) { h.vertex_edge[1] = 3; }), "vertex 1 has the edge of another");
  EXPECT_EQ(found([](HostRings& h) { h.vertex_edge[1] = 1; }), "the hull's corner 1 has another edge");
  EXPECT_EQ(found([](HostRings& h) { h.block_ends[0].last_x = 1; }), "end 1 of block 0");
  EXPECT_EQ(found([](HostRings& h) {
              h.edges[0].next = 7, h.edges[7].next = 8, h.edges[8].next = 0;
              h.edges[0].previous = 8, h.edges[7].previous = 0, h.edges[8].previous = 7;
            }),
            "the ring of vertex 0 turns 2 times");
  EXPECT_EQ(found([](HostRings& h) { h.vertices[0] = {{4, 1}}; }).substr(0, 8), "the ring");
  // A corner inwards: the other diagonal, whatever its circles.
  EXPECT_EQ(found([](HostRings& h) { h.vertices[0] = {{0.5, 0.5}}; }).substr(0, 3), "end");
  EXPECT_EQ(found([](HostRings& h) { h.vertices[2] = {{5, 3}}; }), "vertex 1 is in the circle across edge 8");
  // On one circle, but numbered so that the diagonal misses the first.
  EXPECT_EQ(found([](HostRings& h) {
              std::rotate(h.vertices.begin(), h.vertices.begin() + 1, h.vertices.end());
              h.block_ends[0] = {3, 1, 0, 2};
            }),
            "edge 8 is not the canonical diagonal");
}

}  // namespace
}  // namespace flaunay::blocks
