// Triangulations on a torus against rational arithmetic and brute force.
#include "flaunay/periodic.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "tests/support/fixtures.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::periodic {
namespace {

using Numbers = std::vector<double>;

struct Place {
  mpq_class x, y;
};

/// A place, and its coordinates rounded, which tell most that is far from deciding.
struct Near {
  Place exact;
  double x, y;
};

int in_circle(const Place& a, const Place& b, const Place& c, const Place& d) {
  const auto row = [&](const Place& p) {
    const mpq_class x = p.x - d.x, y = p.y - d.y;
    return std::array<mpq_class, 3>{x, y, x * x + y * y};
  };
  const auto p = row(a), q = row(b), r = row(c);
  const mpq_class det = p[2] * (q[0] * r[1] - q[1] * r[0]) - q[2] * (p[0] * r[1] - p[1] * r[0]) +
                        r[2] * (p[0] * q[1] - p[1] * q[0]);
  return sgn(det);
}

int in_circle(const Near* p, const Near& d, double scale) {
  double x[3], y[3], squares[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = (p[k].x - d.x) / scale;
    y[k] = (p[k].y - d.y) / scale;
    squares[k] = x[k] * x[k] + y[k] * y[k];
  }
  const double det = squares[2] * (x[0] * y[1] - x[1] * y[0]) + squares[0] * (x[1] * y[2] - x[2] * y[1]) +
                     squares[1] * (x[2] * y[0] - x[0] * y[2]);
  // Differences are below 4 in units of the period.
  if (std::fabs(det) > 1e-12) return det > 0 ? 1 : -1;
  return in_circle(p[0].exact, p[1].exact, p[2].exact, d.exact);
}

bool precedes(const Place& a, const Place& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// That triangles are counter-clockwise and empty among all images, that neighbours are right, and that
/// cocircular polygons are fans.
void expect_torus(const PeriodicTriangulation& mesh, const Period& period, std::size_t n) {
  std::set<std::pair<double, double>> different;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = mesh.places[2 * i], y = mesh.places[2 * i + 1];
    ASSERT_TRUE(x >= 0 && x < period.x && y >= 0 && y < period.y);
    ASSERT_EQ(different.insert({x, y}).second, mesh.representatives[i] == static_cast<std::int32_t>(i));
  }
  ASSERT_EQ(6 * different.size(), mesh.triangles.size());
  ASSERT_EQ(mesh.triangles.size(), mesh.neighbors.size());
  ASSERT_EQ(2 * mesh.triangles.size(), mesh.offsets.size());
  const auto image = [&](std::size_t v, int across, int up) {
    return Place{mpq_class(mesh.places[2 * v]) + across * mpq_class(period.x),
                 mpq_class(mesh.places[2 * v + 1]) + up * mpq_class(period.y)};
  };
  const auto corner = [&](std::size_t c) {
    return image(static_cast<std::size_t>(mesh.triangles[c]), mesh.offsets[2 * c], mesh.offsets[2 * c + 1]);
  };
  const auto rounded = [](const Place& p) { return Near{p, p.x.get_d(), p.y.get_d()}; };
  std::vector<Near> images;
  for (std::size_t v = 0; v < n; ++v) {
    for (int across = -1; across <= 1; ++across) {
      for (int up = -1; up <= 1; ++up) images.push_back(rounded(image(v, across, up)));
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Place p[] = {corner(t), corner(t + 1), corner(t + 2)};
    ASSERT_TRUE(mesh.offsets[2 * t] == 0 && mesh.offsets[2 * t + 1] == 0);
    ASSERT_TRUE(mesh.triangles[t] < mesh.triangles[t + 1] && mesh.triangles[t] < mesh.triangles[t + 2]);
    ASSERT_GT((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x), 0);
    const Near near[] = {rounded(p[0]), rounded(p[1]), rounded(p[2])};
    for (const Near& point : images)
      ASSERT_LE(in_circle(near, point, std::max(period.x, period.y)), 0) << t / 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto other = 3 * static_cast<std::size_t>(mesh.neighbors[t + k]);
      ASSERT_LT(other, mesh.triangles.size());
      const std::size_t a = t + (k + 1) % 3, b = t + (k + 2) % 3;
      bool is_joined = false;
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t c = other + (j + 1) % 3, d = other + (j + 2) % 3;
        if (static_cast<std::size_t>(mesh.neighbors[other + j]) != t / 3 ||
            mesh.triangles[c] != mesh.triangles[b] || mesh.triangles[d] != mesh.triangles[a])
          continue;
        // The other triangle as it lies beside this one.
        const int across = mesh.offsets[2 * b] - mesh.offsets[2 * c],
                  up = mesh.offsets[2 * b + 1] - mesh.offsets[2 * c + 1];
        if (mesh.offsets[2 * d] + across != mesh.offsets[2 * a] ||
            mesh.offsets[2 * d + 1] + up != mesh.offsets[2 * a + 1])
          continue;
        is_joined = true;
        const Place opposite =
            image(static_cast<std::size_t>(mesh.triangles[other + j]), mesh.offsets[2 * (other + j)] + across,
                  mesh.offsets[2 * (other + j) + 1] + up);
        if (in_circle(p[0], p[1], p[2], opposite) != 0) continue;
        const Place* const ends[] = {&p[(k + 1) % 3], &p[(k + 2) % 3]};
        const auto is_first = [&](const Place& e) {
          return !precedes(p[k], e) && !precedes(opposite, e) && !precedes(*ends[0], e) &&
                 !precedes(*ends[1], e);
        };
        EXPECT_TRUE(is_first(*ends[0]) || is_first(*ends[1])) << t / 3;
      }
      ASSERT_TRUE(is_joined) << t / 3 << " " << k;
    }
  }
  double sum = 0;
  for (const double area : periodic_cell_areas(mesh, period)) sum += area;
  EXPECT_NEAR(1, sum / (period.x * period.y), 1e-12);
}

PeriodicTriangulation triangulated(const Numbers& points, const Period& period) {
  return triangulate_periodic(testing::triangulator(), points.data(), points.size() / 2, period);
}

Numbers uniform(std::size_t n, const Period& period, std::uint64_t seed) {
  testing::FixtureRandom random(seed);
  Numbers points;
  for (std::size_t i = 0; i < n; ++i)
    points.insert(points.end(), {random.unit() * period.x, random.unit() * period.y});
  return points;
}

TEST(Periodic, TrianglesAreThoseOfAllImages) {
  const Period unit, odd{0.1, 0.3}, far{0x1.fffffffffffffp20, 0x1.0000000000001p20};
  for (const Period& period : {unit, odd, far}) {
    SCOPED_TRACE(period.x);
    for (const std::size_t n : {150, 200}) {
      const Numbers points = uniform(n, period, n);
      expect_torus(triangulated(points, period), period, n);
    }
  }
  // Triangles over a gap, which need more images than points have.
  Numbers gap;
  const Numbers many = uniform(400, unit, 5);
  for (std::size_t i = 0; i < many.size(); i += 2) {
    const double x = many[i] - 0.5, y = many[i + 1] - 0.5;
    if (x * x + y * y > 0.04 && gap.size() < 400) gap.insert(gap.end(), {many[i], many[i + 1]});
  }
  expect_torus(triangulated(gap, unit), unit, gap.size() / 2);
}

/// Corners and their offsets.
std::set<std::array<int, 9>> sorted_triangles(const PeriodicTriangulation& mesh) {
  std::set<std::array<int, 9>> all;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    std::array<int, 9> one;
    for (std::size_t k = 0; k < 3; ++k) one[k] = mesh.triangles[t + k];
    for (std::size_t k = 0; k < 6; ++k) one[3 + k] = mesh.offsets[2 * t + k];
    all.insert(one);
  }
  return all;
}

TEST(Periodic, LatticesAreFans) {
  for (const int size : {5, 8, 12}) {
    Numbers points;
    for (int x = 0; x < size; ++x) {
      for (int y = 0; y < size; ++y) points.insert(points.end(), {x * 0.5, y * 1.0});
    }
    const Period period{size * 0.5, size * 1.0};
    expect_torus(triangulated(points, period), period, points.size() / 2);
    // Points given twice, and elsewhere.
    Numbers again = points;
    for (std::size_t i = 0; i < points.size(); i += 2) {
      again.insert(again.end(), {points[i] + 3 * period.x, points[i + 1] - 2 * period.y});
    }
    const PeriodicTriangulation mesh = triangulated(again, period);
    EXPECT_EQ(sorted_triangles(triangulated(points, period)), sorted_triangles(mesh));
    EXPECT_EQ(0, mesh.representatives[points.size() / 2]);
  }
}

TEST(Periodic, ShiftsByPeriodsChangeNothing) {
  const Period period{0.75, 1.25};
  Numbers points = uniform(150, period, 9);
  for (double& x : points) x = std::ldexp(std::nearbyint(std::ldexp(x, 30)), -30);
  const PeriodicTriangulation first = triangulated(points, period);
  for (std::size_t i = 0; i < points.size(); i += 2) {
    points[i] += 1000 * period.x;
    points[i + 1] -= 77 * period.y;
  }
  const PeriodicTriangulation second = triangulated(points, period);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_EQ(first.offsets, second.offsets);
  EXPECT_EQ(first.places, second.places);
}

TEST(Periodic, ManySetsAreEachAsAlone) {
  const Period period{2, 2};
  Numbers points;
  std::vector<std::size_t> offsets = {0, 0};
  std::vector<PeriodicTriangulation> alone;
  for (const std::size_t n : {150, 300, 200}) {
    const Numbers set = uniform(n, period, n + 1);
    alone.push_back(triangulated(set, period));
    points.insert(points.end(), set.begin(), set.end());
    offsets.push_back(points.size() / 2);
  }
  const PeriodicTriangulation all =
      triangulate_periodic(testing::triangulator(), points.data(), offsets, period);
  EXPECT_EQ(0u, all.triangle_offsets[1]);
  for (std::size_t s = 0; s < alone.size(); ++s) {
    const std::size_t first = 3 * all.triangle_offsets[s + 1];
    ASSERT_EQ(alone[s].triangles.size(), 3 * all.triangle_offsets[s + 2] - first);
    for (std::size_t c = 0; c < alone[s].triangles.size(); ++c) {
      ASSERT_EQ(alone[s].triangles[c] + static_cast<std::int32_t>(offsets[s + 1]), all.triangles[first + c]);
      ASSERT_EQ(alone[s].neighbors[c] + static_cast<std::int32_t>(first / 3), all.neighbors[first + c]);
      ASSERT_EQ(alone[s].offsets[2 * c], all.offsets[2 * (first + c)]);
    }
  }
}

template <typename Work>
void expect_refusal(ErrorKind kind, const char* part, const Work& work) {
  try {
    work();
    FAIL() << "no error: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(kind, error.kind());
    EXPECT_NE(std::string::npos, std::string(error.what()).find(part)) << error.what();
  }
}

TEST(Periodic, ErrorsSayWhatIsWrong) {
  const Numbers few = {0.5, 0.5, 0.2, 0.1};
  expect_refusal(ErrorKind::input, "the 2 different points of set 0 leave an empty circle",
                 [&] { triangulated(few, {}); });
  expect_refusal(ErrorKind::input, "point 1 is not finite", [] { triangulated({1, 1, HUGE_VAL, 0}, {}); });
  for (const Period& period : {Period{0, 1}, Period{1, -1}, Period{HUGE_VAL, 1}, Period{std::nan(""), 1}}) {
    expect_refusal(ErrorKind::usage, "the period", [&] { triangulated(few, period); });
  }
  expect_refusal(ErrorKind::usage, "2^30", [&] { triangulated(few, {1, 0x1p31}); });
  EXPECT_TRUE(triangulated({}, {}).triangles.empty());
}

TEST(Periodic, ManyPointsHaveTwiceAsManyTriangles) {
  const PeriodicTriangulation mesh = triangulated(uniform(100000, {}, 3), {});
  EXPECT_EQ(200000u, mesh.triangles.size() / 3);
  EXPECT_LT(mesh.images, 15000u);
  double sum = 0;
  for (const double area : periodic_cell_areas(mesh, {})) sum += area;
  EXPECT_NEAR(1, sum, 1e-10);
}

}  // namespace
}  // namespace flaunay::periodic
