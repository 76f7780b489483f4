// The twins' own predicates against the references.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <vector>

#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

TEST(SmallTwins, PredicatesAreTheReferences) {
  FixtureRandom random(25);
  std::array<int, 3> turns{}, circles{};
  for (const double factor : {1.0, 0x1.3p-20, 1e-3, 1 + 0x1p-40}) {
    for (int round = 0; round < 300; ++round) {
      std::vector<cl_double2> places;
      for (int i = 0; i < 4; ++i) {
        places.push_back({{factor * static_cast<double>(random.integer(-3, 3)),
                           factor * static_cast<double>(random.integer(-3, 3))}});
      }
      const ExactPoints points(places);
      const double* p[4];
      for (std::size_t i = 0; i < 4; ++i) p[i] = places[i].s;
      const int turn = testing::reference_orient2d(p[0], p[1], p[2]);
      const int circle = testing::reference_incircle(p[0], p[1], p[2], p[3]);
      EXPECT_EQ(points.orient(0, 1, 2), turn);
      EXPECT_EQ(points.in_circle(0, 1, 2, 3), circle);
      ++turns[static_cast<std::size_t>(turn + 1)];
      ++circles[static_cast<std::size_t>(circle + 1)];
      // Below the chord of a and b, in the projection: nearer to a point of the line than to a and b, which
      // is inside a circle centred on it. With c the mirror image of a that circle is one through a, b, c.
      const Frame frame{0, places[2].s[0]};
      const cl_double2 a = places[0], b = places[1];
      const cl_double2 mirror{{2 * frame.q - a.s[0], a.s[1]}};
      if (!(a.s[1] < b.s[1]) || a.s[0] == frame.q || mirror.s[0] + a.s[0] != 2 * frame.q) continue;
      const std::vector<cl_double2> with{a, b, places[3], {{frame.q, 0.0}}};
      const int turned = testing::reference_orient2d(a.s, b.s, mirror.s);
      const int inside = testing::reference_incircle(a.s, b.s, mirror.s, places[3].s) * turned;
      if (turned != 0 && places[3].s[1] > a.s[1] && places[3].s[1] < b.s[1]) {
        EXPECT_EQ(ExactPoints(with).depth_sign(frame, 0, 1, 2), inside);
      }
    }
  }
  for (const int some : turns) EXPECT_GT(some, 50);
  for (const int some : circles) EXPECT_GT(some, 50);
}

}  // namespace
}  // namespace flaunay::flattened
