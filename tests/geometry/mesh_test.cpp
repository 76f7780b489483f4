// The canonical result, from the triangles of any Delaunay triangulation.
#include "geometry/mesh.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/point_sets.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"

namespace flaunay::testing {
namespace {

TEST(Canonicalize, AnyChoiceAmongCocircularPoints) {
  FixtureRandom random(8);
  for (int round = 0; round < 200; ++round) {
    // A full grid, the triangles' diagonals at random: all of them Delaunay.
    const auto width = random.integer(2, 6), height = random.integer(2, 6);
    Coordinates points;
    for (std::int64_t x = 0; x < width; ++x) {
      for (std::int64_t y = 0; y < height; ++y) fixtures_detail::add(points, x, y);
    }
    std::vector<std::int32_t> triangles;
    for (std::int64_t x = 0; x + 1 < width; ++x) {
      for (std::int64_t y = 0; y + 1 < height; ++y) {
        const auto a = static_cast<std::int32_t>(x * height + y), d = a + 1;
        const auto b = static_cast<std::int32_t>(a + height), c = b + 1;
        if (random.integer(0, 1)) {
          triangles.insert(triangles.end(), {a, b, c, c, d, a});
        } else {
          triangles.insert(triangles.end(), {d, a, b, b, c, d});
        }
      }
    }
    const auto sets = geometry::ingest(points.data(), {0, points.size() / 2});
    const Triangulation result = geometry::finish(sets, triangles, {}, {});
    EXPECT_EQ(sorted_triangles(result.triangles), reference_delaunay(points));
    EXPECT_EQ(result.neighbors, reference_neighbors(result.triangles));
  }
}

TEST(Canonicalize, RefusesWhatIsNotDelaunay) {
  const Coordinates points = {0, 0, 4, 0, 4, 3, 1, 3};
  const auto sets = geometry::ingest(points.data(), {0, 4});
  // Ids in (x, y) order: (0, 0), (1, 3), (4, 0), (4, 3).
  EXPECT_NO_THROW(geometry::finish(sets, {0, 2, 1, 2, 3, 1}, {}, {}));
  EXPECT_THROW(geometry::finish(sets, {0, 2, 3, 3, 1, 0}, {}, {}), Error);
  EXPECT_THROW(geometry::finish(sets, {0, 2, 1, 2, 3, 1, 2, 3, 1}, {}, {}), Error);
}

}  // namespace
}  // namespace flaunay::testing
