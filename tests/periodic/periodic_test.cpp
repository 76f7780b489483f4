// Triangulations on a torus against rational arithmetic and brute force.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "flaunay/neighbors.hpp"
#include "flaunay/verify.hpp"
#include "tests/support/errors.hpp"
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
  // Differences are below 8 in units of the scale.
  if (std::fabs(det) > 1e-10) return det > 0 ? 1 : -1;
  return in_circle(p[0].exact, p[1].exact, p[2].exact, d.exact);
}

bool precedes(const Place& a, const Place& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// Points on the ends of a cylinder; of those on both, twice.
std::size_t points_at_ends(const std::set<std::pair<double, double>>& points, const Period& period) {
  std::size_t count = 0;
  for (const bool is_x : {true, false}) {
    if (std::isfinite(is_x ? period.x : period.y)) continue;
    std::multiset<double> all;
    for (const auto& p : points) all.insert(is_x ? p.first : p.second);
    if (!all.empty()) count += all.count(*all.begin()) + all.count(*all.rbegin());
  }
  return count;
}

/// That triangles are counter-clockwise and empty among all images, that neighbours are right, and that
/// cocircular polygons are fans.
void expect_exact(const Triangulation& mesh, const Period& given, std::size_t n) {
  ASSERT_EQ("", verify(mesh.places.data(), mesh.point_offsets, mesh.space, mesh));
  const Period& period = mesh.space.period;
  const bool is_across = std::isfinite(given.x), is_up = std::isfinite(given.y);
  if (is_across) {
    ASSERT_NEAR(1, period.x / given.x, 0x1p-52);
  }
  if (is_up) {
    ASSERT_NEAR(1, period.y / given.y, given.shear == 0 ? 0x1p-52 : 0x1p-49);
  }
  const double shear = is_across ? std::remainder(given.shear, given.x) : 0;
  ASSERT_NEAR(0, std::remainder(period.shear - shear, given.x), is_across ? given.x * 0x1p-51 : 0);
  std::set<std::pair<double, double>> different;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = mesh.places[2 * i], y = mesh.places[2 * i + 1];
    ASSERT_TRUE((x >= 0 || !is_across) && x < period.x && (y >= 0 || !is_up) && y < period.y);
    ASSERT_EQ(different.insert({x, y}).second, mesh.representatives[i] == static_cast<std::int32_t>(i));
  }
  ASSERT_EQ(3 * (2 * different.size() - points_at_ends(different, given)), mesh.triangles.size());
  ASSERT_EQ(mesh.triangles.size(), mesh.neighbors.size());
  ASSERT_EQ(2 * mesh.triangles.size(), mesh.corner_offsets.size());
  const auto image = [&](std::size_t v, int across, int up) {
    Place place{mpq_class(mesh.places[2 * v]), mpq_class(mesh.places[2 * v + 1])};
    if (is_across) place.x += across * mpq_class(period.x) + up * mpq_class(period.shear);
    if (is_up) place.y += up * mpq_class(period.y);
    return place;
  };
  const auto corner = [&](std::size_t c) {
    return image(static_cast<std::size_t>(mesh.triangles[c]), mesh.corner_offsets[2 * c],
                 mesh.corner_offsets[2 * c + 1]);
  };
  const auto rounded = [](const Place& p) { return Near{p, p.x.get_d(), p.y.get_d()}; };
  std::vector<Near> images;
  double scale = std::max(is_across ? period.x : 0, is_up ? period.y : 0);
  for (const double x : mesh.places) scale = std::max(scale, std::fabs(x));
  for (std::size_t v = 0; v < n; ++v) {
    // Few points have circles that are wider than the period.
    const int most = (n < 20 ? 3 : 1) + (period.shear != 0 ? 2 : 0);
    for (int across = is_across ? -most : 0; across <= (is_across ? most : 0); ++across) {
      for (int up = is_up ? -most : 0; up <= (is_up ? most : 0); ++up)
        images.push_back(rounded(image(v, across, up)));
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Place p[] = {corner(t), corner(t + 1), corner(t + 2)};
    ASSERT_TRUE(mesh.corner_offsets[2 * t] == 0 && mesh.corner_offsets[2 * t + 1] == 0);
    ASSERT_TRUE(mesh.triangles[t] <= mesh.triangles[t + 1] && mesh.triangles[t] <= mesh.triangles[t + 2]);
    ASSERT_GT((p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x), 0);
    const Near near[] = {rounded(p[0]), rounded(p[1]), rounded(p[2])};
    for (const Near& point : images) ASSERT_LE(in_circle(near, point, scale), 0) << t / 3;
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.neighbors[t + k] < 0) {
        const Place &from = p[(k + 1) % 3], &to = p[(k + 2) % 3];
        ASSERT_TRUE((!is_across && from.x == to.x) || (!is_up && from.y == to.y)) << t / 3;
        continue;
      }
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
        const int across = mesh.corner_offsets[2 * b] - mesh.corner_offsets[2 * c],
                  up = mesh.corner_offsets[2 * b + 1] - mesh.corner_offsets[2 * c + 1];
        if (mesh.corner_offsets[2 * d] + across != mesh.corner_offsets[2 * a] ||
            mesh.corner_offsets[2 * d + 1] + up != mesh.corner_offsets[2 * a + 1])
          continue;
        is_joined = true;
        const Place opposite = image(static_cast<std::size_t>(mesh.triangles[other + j]),
                                     mesh.corner_offsets[2 * (other + j)] + across,
                                     mesh.corner_offsets[2 * (other + j) + 1] + up);
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
  if (!is_across || !is_up) return;
  double sum = 0;
  for (const double area : testing::triangulator().clipped_voronoi(mesh).areas) sum += area;
  EXPECT_NEAR(1, sum / (period.x * period.y), 1e-12);
}

Triangulation triangulated(const Numbers& points, const Period& period) {
  return testing::triangulator().triangulate(points.data(), points.size() / 2, Space::torus(period));
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
      expect_exact(triangulated(points, period), period, n);
    }
  }
  // Triangles over a gap, which need more images than points have.
  Numbers gap;
  const Numbers many = uniform(400, unit, 5);
  for (std::size_t i = 0; i < many.size(); i += 2) {
    const double x = many[i] - 0.5, y = many[i + 1] - 0.5;
    if (x * x + y * y > 0.04 && gap.size() < 400) gap.insert(gap.end(), {many[i], many[i + 1]});
  }
  expect_exact(triangulated(gap, unit), unit, gap.size() / 2);
}

/// Corners and their offsets.
std::set<std::array<int, 9>> sorted_triangles(const Triangulation& mesh) {
  std::set<std::array<int, 9>> all;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    std::array<int, 9> one;
    for (std::size_t k = 0; k < 3; ++k) one[k] = mesh.triangles[t + k];
    for (std::size_t k = 0; k < 6; ++k) one[3 + k] = mesh.corner_offsets[2 * t + k];
    all.insert(one);
  }
  return all;
}

TEST(Periodic, ShearedTrianglesAreThoseOfAllImages) {
  for (const Period& period :
       {Period{1, 1, 0.5}, {1, 1, -0.3}, {0.1, 0.3, 0.7}, {3, 1, 1.1}, {1, 7, 0.4}, {2, 1, 1e-9}}) {
    SCOPED_TRACE(::testing::Message() << period.x << " x " << period.y << ", " << period.shear);
    testing::FixtureRandom random(4);
    for (const std::size_t n : {1, 2, 3, 4, 5, 9, 14, 40, 120}) {
      SCOPED_TRACE(n);
      Numbers coarse;
      for (std::size_t i = 0; i < 2 * n; ++i)
        coarse.push_back(std::floor(4 * random.unit()) / 4 * (i % 2 == 0 ? period.x : period.y));
      expect_exact(triangulated(uniform(n, period, n), period), period, n);
      expect_exact(triangulated(coarse, period), period, n);
      if (HasFailure()) return;
    }
  }
}

/// Corners at most so many vectors away.
int most_offset(const Triangulation& mesh, std::size_t axis) {
  int most = 0;
  for (std::size_t c = axis; c < mesh.corner_offsets.size(); c += 2)
    most = std::max(most, std::abs(mesh.corner_offsets[c]));
  return most;
}

TEST(Periodic, ShearsMayBeReduced) {
  const Period period{0.75, 1.25, 0.3125};
  const Numbers points = uniform(200, period, 12);
  const Triangulation mesh = triangulated(points, period);
  EXPECT_EQ(0.3125, mesh.space.period.shear);
  for (const double times : {1.0, -1.0, 3.0, 1024.0}) {
    const Triangulation other = triangulated(points, {0.75, 1.25, 0.3125 + times * 0.75});
    EXPECT_EQ(mesh.space.period.shear, other.space.period.shear);
    EXPECT_EQ(mesh.places, other.places);
    EXPECT_EQ(mesh.triangles, other.triangles);
    EXPECT_EQ(mesh.corner_offsets, other.corner_offsets);
  }
  EXPECT_EQ(0.375, triangulated(points, {0.75, 1.25, -0.375}).space.period.shear);
  const Triangulation none = triangulated(points, {0.75, 1.25, 7.5});
  EXPECT_EQ(0, none.space.period.shear);
  EXPECT_EQ(triangulated(points, {0.75, 1.25}).triangles, none.triangles);
  // Of two boxes one above the other, which are a box without a shear.
  Numbers twice = points;
  for (std::size_t i = 0; i < points.size(); i += 2)
    twice.insert(twice.end(), {points[i] + 0.375, points[i + 1] + 1.25});
  std::multiset<std::array<double, 6>> half, whole;
  const auto sides = [](const Triangulation& of) {
    std::multiset<std::array<double, 6>> all;
    for (std::size_t t = 0; t < of.triangles.size(); t += 3) {
      std::array<std::array<double, 2>, 3> p{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = 2 * static_cast<std::size_t>(of.triangles[t + k]);
        const double across = of.corner_offsets[2 * (t + k)], up = of.corner_offsets[2 * (t + k) + 1];
        p[k] = {of.places[v] + across * of.space.period.x + up * of.space.period.shear,
                of.places[v + 1] + up * of.space.period.y};
      }
      std::rotate(p.begin(), std::min_element(p.begin(), p.end()), p.end());
      all.insert({p[1][0] - p[0][0], p[1][1] - p[0][1], p[2][0] - p[1][0], p[2][1] - p[1][1]});
    }
    return all;
  };
  half = sides(triangulated(points, {0.75, 1.25, 0.375}));
  for (const auto& triangle : std::multiset<std::array<double, 6>>(half)) half.insert(triangle);
  whole = sides(triangulated(twice, {0.75, 2.5}));
  ASSERT_EQ(half.size(), whole.size());
  for (auto a = half.begin(), b = whole.begin(); a != half.end(); ++a, ++b) {
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR((*a)[k], (*b)[k], 1e-12);
  }
}

TEST(Periodic, ShearedBoxesMayBeFlat) {
  int most = 0;
  for (const double shear : {1.0, 0.25, 20.0, 26.1, 32.0, 1e-12}) {
    for (const std::size_t n : {1, 2, 5, 30, 700}) {
      SCOPED_TRACE(shear);
      const Period period{64, 1, shear};
      const Triangulation mesh = triangulated(uniform(n, period, n), period);
      ASSERT_EQ("", verify(mesh.places.data(), mesh.point_offsets, mesh.space, mesh)) << n;
      ASSERT_EQ(6 * n, mesh.triangles.size());
      most = std::max(most, most_offset(mesh, 1));
      ASSERT_LE(most_offset(mesh, 1), 65);
      ASSERT_LE(most_offset(mesh, 0), 34);
    }
  }
  EXPECT_GE(most, 20);
  for (const Period& period : {Period{1, 1, 0.5}, {1, 1, 0.37}, {1, 9, 0.1}}) {
    for (std::size_t n = 1; n < 9; ++n) {
      const Triangulation mesh = triangulated(uniform(n, period, n), period);
      ASSERT_LE(std::max(most_offset(mesh, 0), most_offset(mesh, 1)), 2);
    }
  }
  // Of all magnitudes.
  for (const Period& period : {Period{0x1p-900, 0x1p-900, 0x1p-901},
                               {0x1p900, 0x1p900, -0x1.1p898},
                               {0x1p-895, 0x1p-900, 0x1p900},
                               {0x1p-900, 0x1p-870, 0x1.3p-901}}) {
    const Numbers points = uniform(60, period, 4);
    EXPECT_EQ("",
              verify(triangulated(points, period).places.data(), triangulated(points, period).point_offsets,
                     triangulated(points, period).space, triangulated(points, period)));
  }
}

TEST(Periodic, LatticesAreFans) {
  for (const int size : {5, 8, 12}) {
    Numbers points;
    for (int x = 0; x < size; ++x) {
      for (int y = 0; y < size; ++y) points.insert(points.end(), {x * 0.5, y * 1.0});
    }
    const Period period{size * 0.5, size * 1.0};
    expect_exact(triangulated(points, period), period, points.size() / 2);
    // Points given twice, and elsewhere.
    Numbers again = points;
    for (std::size_t i = 0; i < points.size(); i += 2) {
      again.insert(again.end(), {points[i] + 3 * period.x, points[i + 1] - 2 * period.y});
    }
    const Triangulation mesh = triangulated(again, period);
    EXPECT_EQ(sorted_triangles(triangulated(points, period)), sorted_triangles(mesh));
    EXPECT_EQ(0, mesh.representatives[points.size() / 2]);
  }
}

TEST(Periodic, FewPointsHaveAllTriangles) {
  const Triangulation one = triangulated({0.25, 7.5}, {1, 2});
  EXPECT_EQ((std::vector<std::int32_t>(6, 0)), one.triangles);
  EXPECT_EQ((std::vector<std::int32_t>{1, 1, 1, 0, 0, 0}), one.neighbors);
  testing::FixtureRandom random(4);
  for (std::size_t n = 1; n < 15; ++n) {
    for (const Period& period : {Period{}, {3, 0.7}, {1, 16}, {1.9999999999999998, 1.0000000000000002}}) {
      SCOPED_TRACE(n);
      expect_exact(triangulated(uniform(n, period, n), period), period, n);
      // With ties.
      Numbers coarse;
      for (std::size_t i = 0; i < 2 * n; ++i)
        coarse.push_back(std::floor(4 * random.unit()) / 4 * (i % 2 == 0 ? period.x : period.y));
      expect_exact(triangulated(coarse, period), period, n);
    }
  }
}

TEST(Periodic, CylindersHaveTwoEnds) {
  testing::FixtureRandom random(8);
  for (const std::size_t n : {1, 2, 3, 5, 9, 14, 200}) {
    for (const double length : {1.0, 0.7, 30.0, 1e-3}) {
      SCOPED_TRACE(n);
      Numbers points = uniform(n, {}, n), turned = points, coarse;
      for (const double x : points) coarse.push_back(std::floor(6 * x));
      for (std::size_t i = 0; i < n; ++i) std::swap(turned[2 * i], turned[2 * i + 1]);
      const Period across{length, HUGE_VAL}, up{HUGE_VAL, length};
      const Triangulation mesh = triangulated(points, across), other = triangulated(turned, up);
      expect_exact(mesh, across, n);
      expect_exact(other, up, n);
      EXPECT_EQ(mesh.triangles.size(), other.triangles.size());
      for (const Period& period : {across, up, Period{6, HUGE_VAL}, Period{HUGE_VAL, 3}})
        expect_exact(triangulated(coarse, period), period, n);
    }
  }
  EXPECT_TRUE(triangulated({0.5, 3, 0.25, 3, 0.75, 3}, {1, HUGE_VAL}).triangles.empty());
  // As high as the smallest double, and as the largest.
  const Triangulation low = triangulated({0, 0, 0, 0x1p-1074}, {0x1p-800, HUGE_VAL});
  EXPECT_EQ(2u, low.triangles.size() / 3);
  const Triangulation high = triangulated({0, -0x1p1023, 0, 0x1p1023}, {0x1p700, HUGE_VAL});
  EXPECT_EQ(2u, high.triangles.size() / 3);
  const Triangulation many = triangulated(uniform(50000, {}, 3), {1, HUGE_VAL});
  EXPECT_EQ(100000u - 2, many.triangles.size() / 3);
  EXPECT_LT(many.images, 20000u);
  EXPECT_EQ(2, std::count(many.neighbors.begin(), many.neighbors.end(), -1));
}

TEST(Periodic, ShiftsByPeriodsChangeNothing) {
  const Period period{0.75, 1.25};
  Numbers points = uniform(150, period, 9);
  for (double& x : points) x = std::ldexp(std::nearbyint(std::ldexp(x, 30)), -30);
  const Triangulation first = triangulated(points, period);
  for (std::size_t i = 0; i < points.size(); i += 2) {
    points[i] += 1000 * period.x;
    points[i + 1] -= 77 * period.y;
  }
  const Triangulation second = triangulated(points, period);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_EQ(first.corner_offsets, second.corner_offsets);
  EXPECT_EQ(first.places, second.places);
}

TEST(Periodic, ShiftsByShearedPeriodsChangeNothing) {
  const Period period{0.75, 1.25, 0.21875};
  Numbers points = uniform(150, period, 9);
  for (double& x : points) x = std::ldexp(std::nearbyint(std::ldexp(x, 30)), -30);
  const Triangulation first = triangulated(points, period);
  for (std::size_t i = 0; i < points.size(); i += 2) {
    const double up = static_cast<double>(i * 13 % 300) - 150;
    points[i] += 1000 * period.x + up * period.shear;
    points[i + 1] += up * period.y;
  }
  const Triangulation second = triangulated(points, period);
  EXPECT_EQ(first.triangles, second.triangles);
  EXPECT_EQ(first.corner_offsets, second.corner_offsets);
  EXPECT_EQ(first.places, second.places);
}

Place image_of(const Triangulation& mesh, std::size_t v, int across, int up) {
  Place place{mpq_class(mesh.places[2 * v]), mpq_class(mesh.places[2 * v + 1])};
  if (std::isfinite(mesh.space.period.x))
    place.x += across * mpq_class(mesh.space.period.x) + up * mpq_class(mesh.space.period.shear);
  if (std::isfinite(mesh.space.period.y)) place.y += up * mpq_class(mesh.space.period.y);
  return place;
}

/// The values at the corners of a triangle, interpolated at q; NaN if no image of the triangle contains it.
double value_in(const Triangulation& mesh, std::size_t t, const Place& q, const Numbers& values) {
  for (int across = -4; across <= 4; ++across) {
    for (int up = -4; up <= 4; ++up) {
      std::array<Place, 3> p;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t c = 3 * t + k;
        p[k] = image_of(mesh, static_cast<std::size_t>(mesh.triangles[c]),
                        across + mesh.corner_offsets[2 * c], up + mesh.corner_offsets[2 * c + 1]);
      }
      const auto area = [](const Place& a, const Place& b, const Place& c) {
        return mpq_class((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
      };
      const mpq_class parts[] = {area(p[1], p[2], q), area(p[2], p[0], q), area(p[0], p[1], q)};
      if (parts[0] < 0 || parts[1] < 0 || parts[2] < 0) continue;
      mpq_class sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += parts[k] * mpq_class(values[static_cast<std::size_t>(mesh.triangles[3 * t + k])]);
      return mpq_class(sum / area(p[0], p[1], p[2])).get_d();
    }
  }
  return std::nan("");
}

mpq_class distance_to(const Triangulation& mesh, std::size_t v, const Place& q) {
  mpq_class least = -1;
  const int most = mesh.space.period.shear == 0 ? 1 : 3;
  for (int across = -most; across <= most; ++across) {
    for (int up = -most; up <= most; ++up) {
      const Place p = image_of(mesh, v, across, up);
      const mpq_class square = (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
      if (least < 0 || square < least) least = square;
    }
  }
  return least;
}

/// queries: places.
void expect_answers(const Triangulation& mesh, const Numbers& queries) {
  Locator locator(testing::triangulator(), mesh);
  const std::size_t n = mesh.representatives.size(), m = queries.size() / 2;
  Numbers values, elsewhere = queries;
  for (std::size_t i = 0; i < n; ++i) values.push_back(static_cast<double>(mesh.representatives[i] * 7 % 13));
  for (std::size_t i = 0; i < m; ++i) {
    if (std::isfinite(mesh.space.period.x)) elsewhere[2 * i] -= 3 * mesh.space.period.x;
    if (std::isfinite(mesh.space.period.y)) {
      elsewhere[2 * i] += 2 * mesh.space.period.shear;
      elsewhere[2 * i + 1] += 2 * mesh.space.period.y;
    }
  }
  const auto triangles = locator.locate(queries.data(), m), points = locator.nearest(queries.data(), m);
  const Numbers found = locator.interpolate(values.data(), queries.data(), m);
  EXPECT_EQ(triangles, locator.locate(elsewhere.data(), m));
  EXPECT_EQ(points, locator.nearest(elsewhere.data(), m));
  InterpolationOptions smooth;
  smooth.method = Interpolation::clough_tocher;
  smooth.fill = -1;
  EXPECT_EQ(locator.interpolate(values.data(), queries.data(), m, smooth),
            locator.interpolate(values.data(), elsewhere.data(), m, smooth));
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i < n; ++i) {
    const double at = mesh.places[2 * i + (std::isfinite(mesh.space.period.y) ? 0 : 1)];
    low = std::min(low, at);
    high = std::max(high, at);
  }
  for (std::size_t i = 0; i < m; ++i) {
    const Place q{mpq_class(queries[2 * i]), mpq_class(queries[2 * i + 1])};
    if (triangles[i] < 0) {
      const double at = queries[2 * i + (std::isfinite(mesh.space.period.y) ? 0 : 1)];
      EXPECT_TRUE(mesh.triangles.empty() ||
                  (std::isinf(mesh.space.period.x + mesh.space.period.y) && (at < low || at > high)));
      EXPECT_TRUE(std::isnan(found[i]));
    } else {
      EXPECT_NEAR(value_in(mesh, static_cast<std::size_t>(triangles[i]), q, values), found[i], 1e-9) << i;
    }
    ASSERT_EQ(points[i], mesh.representatives[static_cast<std::size_t>(points[i])]);
    const mpq_class distance = distance_to(mesh, static_cast<std::size_t>(points[i]), q);
    for (std::size_t v = 0; v < n; ++v) ASSERT_LE(distance, distance_to(mesh, v, q)) << i;
  }
  // At points.
  if (!mesh.triangles.empty()) {
    EXPECT_EQ(values, locator.interpolate(values.data(), mesh.places.data(), n));
    EXPECT_EQ(values, locator.interpolate(values.data(), mesh.places.data(), n, smooth));
  }
  EXPECT_EQ(mesh.representatives, locator.nearest(mesh.places.data(), n));
}

TEST(Periodic, QueriesAreWrapped) {
  testing::FixtureRandom random(21);
  for (const std::size_t n : {1, 2, 3, 7, 30, 150}) {
    for (const Period& period :
         {Period{}, {0.75, 3}, {2, HUGE_VAL}, {HUGE_VAL, 4}, {1, 1, 0.5}, {2, 0.75, 0.6875}}) {
      for (const bool is_coarse : {false, true}) {
        SCOPED_TRACE(::testing::Message() << n << " points, " << period.x << " x " << period.y);
        const auto some = [&](std::size_t count, double least, double most) {
          Numbers places;
          for (std::size_t i = 0; i < 2 * count; ++i) {
            const double length = i % 2 == 0 ? period.x : period.y;
            const double share =
                std::floor(random.unit() * (is_coarse ? 8 : 1 << 20)) / (is_coarse ? 8 : 1 << 20);
            places.push_back(std::isfinite(length) ? share * length : least + (most - least) * share);
          }
          return places;
        };
        expect_answers(triangulated(some(n, 0, 1), period), some(30, -0.5, 1.5));
      }
    }
  }
  Locator none(testing::triangulator(), triangulated({}, {}));
  const Numbers query = {0.5, 0.5};
  EXPECT_EQ(-1, none.locate(query.data(), 1)[0]);
  EXPECT_EQ(-1, none.nearest(query.data(), 1)[0]);
  PointTree tree(testing::triangulator(), triangulated({}, {}));
  EXPECT_EQ((std::vector<std::int32_t>{-1, -1}), tree.nearest(query.data(), 1, {2}).points);
}

TEST(Periodic, QueriesOfManyPoints) {
  const Triangulation mesh = triangulated(uniform(20000, {}, 6), {});
  Locator locator(testing::triangulator(), mesh);
  Numbers centres, values(40000);
  for (std::size_t i = 0; i < 20000; ++i) values[2 * i] = values[2 * i + 1] = 0.1 * static_cast<double>(i);
  std::vector<std::int32_t> expected;
  for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
    double x = 0, y = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(mesh.triangles[3 * t + k]);
      x += (mesh.places[2 * v] + mesh.corner_offsets[6 * t + 2 * k]) / 3;
      y += (mesh.places[2 * v + 1] + mesh.corner_offsets[6 * t + 2 * k + 1]) / 3;
    }
    centres.insert(centres.end(), {x, y});
    expected.push_back(static_cast<std::int32_t>(t));
  }
  EXPECT_EQ(expected, locator.locate(centres.data(), expected.size()));
  InterpolationOptions options;
  options.columns = 2;
  const Numbers found = locator.interpolate(values.data(), centres.data(), expected.size(), options);
  for (std::size_t t = 0; t < expected.size(); ++t) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += 0.1 * mesh.triangles[3 * t + k] / 3;
    ASSERT_NEAR(sum, found[2 * t], 1e-6);
    ASSERT_EQ(found[2 * t], found[2 * t + 1]);
  }
}

/// Points in the plane with rows of values: first in their places, then moved by all vectors of the lattice
/// up to some.
struct Copies {
  Copies(const Triangulation& mesh, const Numbers& of_points, int most)
      : places(mesh.places), values(of_points) {
    const Period& period = mesh.space.period;
    const int most_across = std::isfinite(period.x) ? most : 0, most_up = std::isfinite(period.y) ? most : 0;
    for (int across = -most_across; across <= most_across; ++across) {
      for (int up = -most_up; up <= most_up; ++up) {
        if (across == 0 && up == 0) continue;
        for (std::size_t i = 0; i < mesh.places.size(); i += 2) {
          places.push_back(mesh.places[i] + (across == 0 ? 0 : across * period.x) + up * period.shear);
          places.push_back(mesh.places[i + 1] + (up == 0 ? 0 : up * period.y));
        }
        values.insert(values.end(), of_points.begin(), of_points.end());
      }
    }
  }
  Locator locator() const {
    Options options;
    options.neighbors = true;
    const std::size_t n = places.size() / 2;
    return {testing::triangulator(), places.data(), n,
            testing::triangulator().triangulate(places.data(), n, options)};
  }

  Numbers places, values;
};

TEST(Periodic, CloughTocherIsThatOfManyCopies) {
  for (const Period& period :
       {Period{1, 1}, {0.75, 3}, {1, 1, 0.5}, {2, 0.75, 0.6875}, {2, HUGE_VAL}, {HUGE_VAL, 0.5}}) {
    for (const std::size_t n : {1, 2, 3, 7, 40, 400}) {
      SCOPED_TRACE(::testing::Message() << n << " points, " << period.x << " x " << period.y);
      const Period box{std::isfinite(period.x) ? period.x : 1, std::isfinite(period.y) ? period.y : 1};
      // With places that copies have exactly, points given twice, and a gap over which triangles are large.
      Numbers points = uniform(n, box, n + 7), values;
      for (double& x : points) x = std::ldexp(std::nearbyint(std::ldexp(x, n == 7 ? 20 : 19)), -20);
      points.insert(points.end(), points.begin(), points.begin() + 2);
      const Triangulation mesh = triangulated(points, period);
      for (std::size_t i = 0; i < points.size(); ++i)
        values.push_back(static_cast<double>(mesh.representatives[i / 2] * (i % 2 == 0 ? 7 : 5) % 13));
      // Enough for the other gradients near the rim of the copies not to reach the middle. At the ends of a
      // cylinder edges are long.
      const bool is_torus = std::isfinite(period.x + period.y);
      const int most = n < 10 || !is_torus ? 24 : n < 100 ? 10 : 4;
      const Copies copies(mesh, values, most);
      Locator locator(testing::triangulator(), mesh), plane = copies.locator();
      InterpolationOptions wanted;
      wanted.method = Interpolation::clough_tocher;
      wanted.columns = 2;
      wanted.estimation.tolerance = 0;
      const auto expect_near = [](const Numbers& expected, const Numbers& found) {
        double largest = 1;
        for (const double x : found) largest = std::max(largest, std::isnan(x) ? 0 : std::fabs(x));
        for (std::size_t i = 0; i < found.size(); ++i) {
          ASSERT_EQ(std::isnan(expected[i]), std::isnan(found[i])) << i;
          if (!std::isnan(found[i])) {
            ASSERT_NEAR(expected[i], found[i], 1e-10 * largest) << i;
          }
        }
      };
      const Numbers queries = uniform(200, box, 3),
                    found = locator.interpolate(values.data(), queries.data(), 200, wanted);
      expect_near(plane.interpolate(copies.values.data(), queries.data(), 200, wanted), found);
      const Numbers gradients = locator.gradients(values.data(), 2, wanted.estimation);
      ASSERT_EQ(2 * values.size(), gradients.size());
      expect_near(plane.gradients(copies.values.data(), 2, wanted.estimation), gradients);
      // The same if they are given.
      wanted.gradients = gradients.data();
      wanted.fill = -1;
      const Numbers given = locator.interpolate(values.data(), queries.data(), 200, wanted);
      for (std::size_t i = 0; i < found.size(); ++i)
        ASSERT_EQ(std::isnan(found[i]) ? -1 : found[i], given[i]) << i;
    }
  }
}

TEST(Periodic, NaturalNeighborsAreThoseOfManyCopies) {
  for (const Period& given : {Period{1, 1},
                              {0.3, 0.7},
                              {1, 4},
                              {1, 1, 0.375},
                              {1, 0.5, 0.5},
                              {1, HUGE_VAL},
                              {HUGE_VAL, 0.7},
                              {0.3, HUGE_VAL}}) {
    const bool is_across = std::isfinite(given.x), is_up = std::isfinite(given.y);
    const Period period{is_across ? given.x : 1, is_up ? given.y : 1, given.shear};
    for (const std::size_t n : {40, 300}) {
      SCOPED_TRACE(n);
      Numbers points = uniform(n, period, n + 7);
      // Ties, points given twice, and a gap.
      for (std::size_t i = 0; i < n; i += 2)
        points[i] = std::floor(16 * points[i] / period.x) / 16 * period.x;
      points.insert(points.end(), points.begin(), points.begin() + 20);
      const Triangulation mesh = triangulated(points, given);
      Locator locator(testing::triangulator(), mesh);
      Numbers values, elsewhere, queries = uniform(100, period, 3);
      for (std::size_t i = 0; i < points.size() / 2; ++i) {
        values.push_back(static_cast<double>(mesh.representatives[i] * 7 % 13));
        values.push_back(static_cast<double>(mesh.representatives[i]));
      }
      const Copies copies(mesh, values, 2);
      Locator plane = copies.locator();
      for (std::size_t q = 0; q < queries.size(); q += 2)
        elsewhere.insert(elsewhere.end(),
                         {queries[q] - (is_across ? 3 : 0) * period.x + (is_up ? 2 : 0) * period.shear,
                          queries[q + 1] + (is_up ? 2 : 0) * period.y});
      InterpolationOptions wanted;
      wanted.columns = 2;
      for (const Interpolation method : {Interpolation::sibson, Interpolation::laplace}) {
        wanted.method = method;
        const Numbers found = locator.interpolate(values.data(), elsewhere.data(), 100, wanted);
        const Numbers expected = plane.interpolate(copies.values.data(), queries.data(), 100, wanted);
        const NaturalWeights weights = locator.natural_weights(elsewhere.data(), 100, method);
        for (std::size_t i = 0; i < expected.size(); ++i) {
          double sum = 0;
          for (std::size_t k = weights.offsets[i / 2]; k < weights.offsets[i / 2 + 1]; ++k)
            sum += weights.weights[k] * values[2 * static_cast<std::size_t>(weights.points[k]) + i % 2];
          if (!std::isnan(expected[i])) {
            ASSERT_NEAR(expected[i], found[i], 1e-9 * static_cast<double>(n)) << i;
            ASSERT_NEAR(expected[i], sum, 1e-9 * static_cast<double>(n)) << i;
          }
          ASSERT_EQ(std::isnan(expected[i]), std::isnan(found[i])) << i;
        }
      }
      for (const Interpolation method :
           {Interpolation::linear, Interpolation::nearest, Interpolation::sibson, Interpolation::laplace}) {
        wanted.method = method;
        EXPECT_EQ(values,
                  locator.interpolate(values.data(), mesh.places.data(), mesh.places.size() / 2, wanted));
      }
    }
  }
}

// Circles reach far beyond the ends, and are refused if they are too wide between these.
TEST(Periodic, NaturalNeighborsOfFewPointsOnCylinders) {
  testing::FixtureRandom random(5);
  std::size_t answered = 0, refused = 0;
  for (int k = 0; k < 200; ++k) {
    const auto n = static_cast<std::size_t>(random.integer(2, 9));
    const double height = std::ldexp(1, static_cast<int>(random.integer(-6, 1)));
    Numbers points, values, queries;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = random.unit(), y = random.unit() * height;
      points.insert(points.end(), {k % 2 == 0 ? x : y, k % 2 == 0 ? y : x});
      values.push_back(static_cast<double>(i * i));
    }
    for (std::size_t i = 0; i < 40; ++i) {
      const double x = random.unit(), y = random.unit() * height;
      queries.insert(queries.end(), {k % 2 == 0 ? x : y, k % 2 == 0 ? y : x});
    }
    const Triangulation mesh = triangulated(points, k % 2 == 0 ? Period{1, HUGE_VAL} : Period{HUGE_VAL, 1});
    const Copies copies(mesh, values, 9);
    Locator plane = copies.locator();
    InterpolationOptions wanted;
    wanted.method = k % 3 == 0 ? Interpolation::laplace : Interpolation::sibson;
    Locator locator(testing::triangulator(), mesh);
    Numbers found;
    try {
      found = locator.interpolate(values.data(), queries.data(), 40, wanted);
    } catch (const Error& error) {
      ASSERT_EQ(ErrorKind::input, error.kind());
      ++refused;
      continue;
    }
    ++answered;
    const Numbers expected = plane.interpolate(copies.values.data(), queries.data(), 40, wanted);
    for (std::size_t i = 0; i < 40; ++i) {
      ASSERT_EQ(std::isnan(expected[i]), std::isnan(found[i])) << k << " " << i;
      if (!std::isnan(expected[i])) {
        ASSERT_NEAR(expected[i], found[i], 1e-9) << k << " " << i;
      }
    }
  }
  EXPECT_GT(answered, 50u);
  EXPECT_GT(refused, 20u);
}

// Smooth functions are approximated in a higher order if gradients are given, and estimates converge. There
// is no kink at the border.
TEST(Periodic, CloughTocherConverges) {
  constexpr double kTurn = 6.283185307179586;
  const auto height = [&](double u, double v) {
    return std::sin(kTurn * u) * std::cos(kTurn * v) + std::sin(kTurn * (u + 2 * v)) / 2;
  };
  for (const Period& period : {Period{1, 1}, Period{2, 0.75, 0.6875}}) {
    double given_before = HUGE_VAL, before = HUGE_VAL;
    for (const std::size_t rows : {24, 48, 96}) {
      testing::FixtureRandom random(rows);
      Numbers points, values, slopes;
      const auto add = [&](Numbers& to, double u, double v) {
        to.insert(to.end(), {u * period.x + v * period.shear, v * period.y});
        return height(u, v);
      };
      for (std::size_t i = 0; i < rows * rows; ++i) {
        const double u = (static_cast<double>(i % rows) + random.unit()) / static_cast<double>(rows),
                     v = (static_cast<double>(i / rows) + random.unit()) / static_cast<double>(rows);
        values.push_back(add(points, u, v));
        const double du = kTurn *
                          (std::cos(kTurn * u) * std::cos(kTurn * v) + std::cos(kTurn * (u + 2 * v)) / 2),
                     dv = kTurn * (std::cos(kTurn * (u + 2 * v)) - std::sin(kTurn * u) * std::sin(kTurn * v));
        slopes.insert(slopes.end(), {du / period.x, (dv - du * period.shear / period.x) / period.y});
      }
      Locator locator(testing::triangulator(), triangulated(points, period));
      InterpolationOptions options;
      options.method = Interpolation::clough_tocher;
      Numbers queries, expected;
      for (int i = 0; i < 4000; ++i)
        expected.push_back(add(queries, random.unit() * 4 - 2, random.unit() * 4 - 2));
      const auto error = [&] {
        const Numbers found = locator.interpolate(values.data(), queries.data(), expected.size(), options);
        double most = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
          most = std::max(most, std::fabs(found[i] - expected[i]));
        return most;
      };
      const double estimated = error();
      // Three places each at the border: before it, on it, and behind it.
      Numbers near;
      constexpr double kStep = 0x1p-20;
      for (int i = 0; i < 300; ++i) {
        const double along = random.unit();
        for (const int side : {-1, 0, 1})
          add(near, i % 2 == 0 ? side * kStep : along, i % 2 == 0 ? along : side * kStep);
      }
      const Numbers across = locator.interpolate(values.data(), near.data(), near.size() / 2, options);
      for (std::size_t i = 0; i < across.size(); i += 3)
        EXPECT_LT(std::fabs(across[i] - 2 * across[i + 1] + across[i + 2]), 1e-2 * kStep) << i;
      options.gradients = slopes.data();
      const double given = error();
      EXPECT_LT(estimated, before / 2);
      EXPECT_LT(given, given_before / 6);
      before = estimated;
      given_before = given;
    }
    EXPECT_LT(before, 0.01);
    EXPECT_LT(given_before, 1e-4);
  }
}

TEST(Periodic, WhatCannotBeInterpolatedIsNamed) {
  const Numbers query = {0.5, 0.5}, values(30, 1.0);
  const auto interpolate = [&](const Numbers& points, const Period& period, Interpolation method) {
    InterpolationOptions options;
    options.method = method;
    Locator(testing::triangulator(), triangulated(points, period))
        .interpolate(values.data(), query.data(), 1, options);
  };
  const Numbers some = uniform(30, {}, 3), line = {0.1, 0.5, 0.6, 0.5, 0.3, 0.52};
  testing::expect_error(ErrorKind::input, "wider than", [&] {
    interpolate({0.1, 0, 0.2, 9}, {1, HUGE_VAL}, Interpolation::sibson);
  });
  interpolate({0.1, 0, 0.6, 0.25, 0.1, 0.5}, {1, HUGE_VAL}, Interpolation::sibson);
  testing::expect_error(ErrorKind::input, "wider than", [&] {
    interpolate(line, {1, 16}, Interpolation::laplace);
  });
  interpolate(line, {1, 16}, Interpolation::nearest);
}

TEST(Periodic, VerifyFindsWhatIsWrong) {
  for (const Period& period : {Period{}, {1, HUGE_VAL}, {1, 1, 0.375}}) {
    Numbers points = uniform(80, {}, 2);
    points.insert(points.end(), points.begin(), points.begin() + 2);
    const Triangulation right = triangulated(points, period);
    const auto problem_of = [&](const auto& change) {
      Triangulation wrong = right;
      change(wrong);
      return verify(wrong.places.data(), wrong.point_offsets, wrong.space, wrong);
    };
    EXPECT_EQ("", problem_of([](Triangulation&) {}));
    const auto expect_problem = [&](const char* part, const auto& change) {
      const std::string problem = problem_of(change);
      EXPECT_NE(std::string::npos, problem.find(part)) << problem << " has no " << part;
    };
    using Mesh = Triangulation;
    expect_problem("place 3 is not in the period", [](Mesh& mesh) { mesh.places[6] += 1; });
    expect_problem("place 3 is not", [](Mesh& mesh) { mesh.places[6] = 0x1p-60; });
    expect_problem("wrong representative", [](Mesh& mesh) { mesh.representatives[80] = 80; });
    expect_problem("another point represents",
                   [](Mesh& mesh) { std::replace(mesh.triangles.begin(), mesh.triangles.end(), 0, 80); });
    expect_problem("first corner", [](Mesh& mesh) { mesh.corner_offsets[0] = 1; });
    expect_problem("first corner", [](Mesh& mesh) { std::swap(mesh.triangles[0], mesh.triangles[1]); });
    expect_problem("counter-clockwise", [](Mesh& mesh) {
      std::swap(mesh.triangles[1], mesh.triangles[2]);
      std::swap_ranges(&mesh.corner_offsets[2], &mesh.corner_offsets[4], &mesh.corner_offsets[4]);
    });
    expect_problem("not neighbors of each other",
                   [](Mesh& mesh) { std::swap(mesh.neighbors[0], mesh.neighbors[1]); });
    expect_problem("has no neighbor", [](Mesh& mesh) {
      *std::find_if(mesh.neighbors.begin(), mesh.neighbors.end(), [](std::int32_t t) { return t >= 0; }) = -1;
    });
    expect_problem("triangles, not", [](Mesh& mesh) {
      mesh.triangles.resize(mesh.triangles.size() - 3);
      mesh.neighbors.resize(mesh.triangles.size());
      for (std::int32_t& t : mesh.neighbors)
        t = std::min(t, static_cast<std::int32_t>(mesh.triangles.size() / 3) - 1);
      mesh.corner_offsets.resize(2 * mesh.triangles.size());
      mesh.triangle_offsets[1] = mesh.triangles.size() / 3;
    });
    if (std::isfinite(period.y)) {
      expect_problem("not rounded", [](Mesh& mesh) { mesh.space.period.shear += 2; });
      EXPECT_NE("", problem_of([](Mesh& mesh) { mesh.space.period.shear = 0.25; }));
    }
    // A point moves into the circle of a triangle beside it.
    EXPECT_NE("", problem_of([](Mesh& mesh) { mesh.places[6] = mesh.places[6] < 0.5 ? 0.75 : 0.25; }));
  }
  // The other diagonal of a square.
  Triangulation square = triangulated({0, 0}, {});
  EXPECT_EQ("", verify(square.places.data(), square.point_offsets, square.space, square));
  square.corner_offsets = {0, 0, 0, 1, -1, 1, 0, 0, 1, 0, 0, 1};
  square.triangles.assign(6, 0);
  EXPECT_NE("", verify(square.places.data(), square.point_offsets, square.space, square));
}

// Against the diagram of nine copies in the plane.
TEST(Periodic, CellsAreThoseOfThePlane) {
  for (const std::size_t n : {1, 2, 3, 40, 700, 41, 6}) {
    const Period period{2, 0.75, n == 41 ? 0.3125 : n == 6 ? -0.875 : 0};
    SCOPED_TRACE(n);
    Numbers points = uniform(n, period, n);
    points.insert(points.end(), {points[0], points[1]});  // has no cell
    const Triangulation mesh = triangulated(points, period);
    const ClippedVoronoi cells = testing::triangulator().clipped_voronoi(mesh);
    Numbers copies;
    for (std::size_t i = 0; i < n; ++i)
      copies.insert(copies.end(), {mesh.places[2 * i], mesh.places[2 * i + 1]});
    for (int k = 0; k < 25; ++k) {
      for (std::size_t i = 0; i < n && k != 12; ++i) {
        copies.insert(copies.end(), {mesh.places[2 * i] + (k / 5 - 2) * period.x + (k % 5 - 2) * period.shear,
                                     mesh.places[2 * i + 1] + (k % 5 - 2) * period.y});
      }
    }
    const double box[] = {-9, -9, 9, -9, 9, 9, -9, 9};
    Triangulator& triangulator = testing::triangulator();
    Options options;
    options.neighbors = true;
    const ClippedVoronoi plane = triangulator.clipped_voronoi(
        copies.data(), copies.size() / 2, triangulator.triangulate(copies.data(), copies.size() / 2, options),
        box, 4);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(plane.areas[i], cells.areas[i], 1e-12) << i;
      for (std::size_t k = 2 * i; k < 2 * i + 2; ++k)
        EXPECT_NEAR(plane.centroids[k], cells.centroids[k], 1e-9) << i;
      // Each vertex is one of the plane's cell.
      for (int v = cells.offsets[i]; v < cells.offsets[i + 1]; ++v) {
        double nearest = HUGE_VAL;
        for (int w = plane.offsets[i]; w < plane.offsets[i + 1]; ++w) {
          nearest = std::min(nearest, std::hypot(plane.vertices[2 * static_cast<std::size_t>(w)] -
                                                     cells.vertices[2 * static_cast<std::size_t>(v)],
                                                 plane.vertices[2 * static_cast<std::size_t>(w) + 1] -
                                                     cells.vertices[2 * static_cast<std::size_t>(v) + 1]));
        }
        EXPECT_LT(nearest, 1e-9) << i;
      }
    }
    EXPECT_EQ(0, cells.areas[n]);
    EXPECT_EQ(cells.offsets[n], cells.offsets[n + 1]);
    EXPECT_TRUE(std::isnan(cells.centroids[2 * n]));
  }
}

TEST(Periodic, ErrorsSayWhatIsWrong) {
  const Numbers few = {0.5, 0.5, 0.2, 0.1};
  testing::expect_error(ErrorKind::input, "point 1 is not finite", [] {
    triangulated({1, 1, HUGE_VAL, 0}, {});
  });
  for (const Period& period :
       {Period{0, 1}, Period{1, -1}, Period{HUGE_VAL, HUGE_VAL}, Period{std::nan(""), 1}}) {
    testing::expect_error(ErrorKind::usage, "the period", [&] { triangulated(few, period); });
  }
  testing::expect_error(ErrorKind::usage, "cells on a cylinder", [&] {
    testing::triangulator().clipped_voronoi(triangulated(few, {1, HUGE_VAL}));
  });
  Triangulation mesh = triangulated(few, {});
  Locator locator(testing::triangulator(), mesh);
  const Numbers lost = {0, HUGE_VAL};
  testing::expect_error(ErrorKind::input, "query 0 is not finite", [&] { locator.nearest(lost.data(), 1); });
  testing::expect_error(ErrorKind::usage, "one set", [&] {
    PointTree(testing::triangulator(),
              testing::triangulator().triangulate(few.data(), {0, 1, 2}, Space::torus({})));
  });
  std::swap(mesh.triangles[1], mesh.triangles[2]);
  testing::expect_error(ErrorKind::usage, "not those of a triangulation",
                        [&] { Locator(testing::triangulator(), mesh); });
  testing::expect_error(ErrorKind::usage, "not those of a triangulation",
                        [&] { testing::triangulator().clipped_voronoi(mesh); });
  mesh.triangles[0] = 7;
  testing::expect_error(ErrorKind::usage, "not those of a triangulation",
                        [&] { Locator(testing::triangulator(), mesh); });
  testing::expect_error(ErrorKind::usage, "2^30", [&] { triangulated(few, {1, 0x1p31}); });
  testing::expect_error(ErrorKind::usage, "has no shear", [&] { triangulated(few, {1, HUGE_VAL, 0.5}); });
  testing::expect_error(ErrorKind::usage, "64 times", [&] { triangulated(few, {65, 1, 0.5}); });
  testing::expect_error(ErrorKind::usage, "not finite", [&] { triangulated(few, {1, 1, HUGE_VAL}); });
  EXPECT_EQ(
      "", verify(triangulated(few, {65, 1, 130}).places.data(), triangulated(few, {65, 1, 130}).point_offsets,
                 triangulated(few, {65, 1, 130}).space, triangulated(few, {65, 1, 130})));
  EXPECT_TRUE(triangulated({}, {}).triangles.empty());
}

TEST(Periodic, ManyPointsHaveTwiceAsManyTriangles) {
  const Triangulation mesh = triangulated(uniform(100000, {}, 3), {});
  EXPECT_EQ(200000u, mesh.triangles.size() / 3);
  EXPECT_LT(mesh.images, 15000u);
  double sum = 0;
  for (const double area : testing::triangulator().clipped_voronoi(mesh).areas) sum += area;
  EXPECT_NEAR(1, sum, 1e-10);
  // In a strip, whose triangles in the plane are images for the most part.
  Numbers strip = uniform(30000, {}, 4);
  for (std::size_t i = 0; i < strip.size(); i += 2) strip[i] /= 256;
  EXPECT_EQ("", verify(triangulated(strip, {}).places.data(), triangulated(strip, {}).point_offsets,
                       triangulated(strip, {}).space, triangulated(strip, {})));
}

}  // namespace
}  // namespace flaunay::periodic
