// The stage `neighbors`: half-edges in pairs.
#include <gtest/gtest.h>

#include <vector>

#include "tests/flattened/support.hpp"
#include "tests/support/neighbors_twin.hpp"

namespace flaunay::flattened {
namespace {

void check_match(Runtime& runtime, const std::vector<cl_int>& triangles) {
  Call call(runtime);
  const auto uploaded = testing::upload(runtime, triangles);
  const auto twins = testing::guarded<cl_int>(runtime, triangles.size());
  match_edges(call.work, uploaded, triangles.size() / 3, twins);
  EXPECT_TRUE(same(testing::download(runtime, twins, triangles.size()), testing::twins_twin(triangles)));
}

TEST(SmallMatchEdges, FewTriangles) {
  under_each_tuning([](Runtime& runtime) {
    check_match(runtime, {});
    check_match(runtime, {4, 2, 7});
    check_match(runtime, {0, 1, 2, 2, 1, 3, 0, 2, 3});
    // A closed surface: every edge has a twin.
    check_match(runtime, {0, 1, 2, 0, 2, 3, 0, 3, 1, 3, 2, 1});
  });
}

TEST(MatchEdges, RandomMeshesAndAHub) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(15);
    for (const char* const name : {"uniform", "grid", "integer-star", "small-integers"}) {
      SCOPED_TRACE(name);
      const TriangleSet mesh = testing::reference_delaunay(make_fixture(name, 250, 16));
      check_match(runtime, scrambled(mesh, 250, random));
      check_match(runtime, scrambled(mesh, 1 << 28, random));
    }
    constexpr int kSpokes = 10000;
    for (const int hub : {0, kSpokes, 1 << 28}) {
      TriangleSet star;
      for (int i = 0; i < kSpokes; ++i) {
        star.push_back({hub, hub == 0 ? 1 + i : i, hub == 0 ? 1 + (i + 1) % kSpokes : (i + 1) % kSpokes});
      }
      check_match(runtime, testing::flat_triangles(star));
      check_match(runtime, scrambled(star, 20000, random));
    }
  });
}

}  // namespace
}  // namespace flaunay::flattened
