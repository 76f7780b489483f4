// The public call that splits segments where they cross: its indices, over several sets, against what
// splitting and constraining return.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "constrained/crossings/split.hpp"
#include "flaunay/constrained.hpp"
#include "tests/constrained/check.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

TEST(SmallSplitCall, SeveralSets) {
  FixtureRandom random(1);
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE(round);
    Coordinates points;
    std::vector<std::size_t> offsets = {0};
    Segments segments;
    for (int s = 0; s < 4; ++s) {
      const auto n = static_cast<std::size_t>(random.integer(0, 20));
      const Coordinates set = random_integer_points(n, 9, static_cast<std::uint64_t>(10 * round + s));
      for (const std::int32_t v : random_segments(random, n, 12)) {
        segments.push_back(static_cast<std::int32_t>(offsets.back()) + v);
      }
      points.insert(points.end(), set.begin(), set.end());
      offsets.push_back(points.size() / 2);
    }
    Constraints constraints;
    constraints.segments = segments.data();
    constraints.segment_count = segments.size() / 2;
    ConstrainedOptions options;
    options.crossings = Crossings::split;
    const ConstrainedTriangulation result =
        triangulator().constrained(points.data(), offsets, constraints, options);

    const constrained::Split split = constrained::split(points.data(), offsets, segments);
    const constrained::AllPoints all = constrained::join_added(points.data(), offsets, split);
    const Triangulation delaunay = triangulator().triangulate(all.coordinates.data(), all.offsets, Options{});
    EXPECT_EQ(result.added_points, split.added_points);
    EXPECT_EQ(result.added_offsets, split.added_offsets);
    EXPECT_EQ(result.piece_offsets, split.piece_offsets);
    const auto placed = [&all](Segments indices) {
      for (std::int32_t& v : indices) v = all.place.at(static_cast<std::size_t>(v));
      return indices;
    };
    ConstrainedTriangulation found;
    found.triangles = placed(result.triangles);
    found.neighbors = result.neighbors;
    found.constrained = result.constrained;
    found.constraint_edges = placed(result.constraint_edges);
    found.piece_edges = result.piece_edges;
    const auto edges = expected_edges(all.coordinates, all.offsets, delaunay, placed(split.pieces));
    expect_edges(edges, found);
    expect_canonical(all.coordinates, delaunay, found);
    EXPECT_EQ(placed(result.hull), delaunay.hull);
    EXPECT_EQ(result.triangle_offsets, delaunay.triangle_offsets);
    for (std::size_t i = 0; i < result.representatives.size(); ++i) {
      EXPECT_EQ(all.place[result.representatives[i]], delaunay.representatives[all.place[i]]);
    }
    Segments owners(result.constraint_edges.size() / 2, -1);
    for (std::int32_t s = static_cast<std::int32_t>(segments.size()) / 2 - 1; s >= 0; --s) {
      for (std::int32_t p = result.piece_offsets[s]; p < result.piece_offsets[s + 1]; ++p) {
        for (std::int32_t e = result.piece_edges[2 * p]; e < result.piece_edges[2 * p + 1]; ++e)
          owners[e] = s;
      }
    }
    EXPECT_EQ(result.edge_segments, owners);
    if (HasFailure()) return;
  }
}

TEST(SmallSplitCall, CrossingsAreAnErrorUnlessTheyAreSplit) {
  const Coordinates points = {0, 0, 2, 2, 0, 2, 2, 0};
  const Segments segments = {0, 1, 2, 3};
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = 2;
  ConstrainedOptions options;
  EXPECT_THROW(triangulator().constrained(points.data(), 4, constraints, options), Error);
  options.crossings = Crossings::split;
  options.halfedges = true;
  options.neighbors = false;
  const ConstrainedTriangulation result = triangulator().constrained(points.data(), 4, constraints, options);
  EXPECT_EQ(result.added_points, (Coordinates{1, 1}));
  EXPECT_EQ(result.triangles.size(), 12u);
  EXPECT_EQ(result.halfedges.size(), 12u);
  EXPECT_TRUE(result.neighbors.empty());
  EXPECT_EQ(result.edge_segments, (Segments{0, 1, 0, 1}));
  EXPECT_EQ(result.piece_offsets, (Segments{0, 2, 4}));
}

}  // namespace
}  // namespace flaunay::testing
