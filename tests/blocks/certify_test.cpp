// What rounds of blocks decide by blocks/certify.h and blocks/open_sectors.h, as the host reads them, against
// rational numbers and against sorting by angle.
#include "blocks/certify.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "arithmetic/records.h"
#include "blocks/open_sectors.h"
#include "blocks/records.h"
#include "tests/support/fixtures.hpp"

namespace flaunay::blocks {
namespace {

using kernel::block_frame;
using kernel::double2;
using testing::FixtureRandom;
using Rational = mpq_class;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The parts of the box around all points that lie on or beyond a side of the rectangle.
std::vector<kernel::vertex_box> boxes_beyond(const block_frame& frame) {
  const kernel::vertex_box &r = frame.rectangle, &all = frame.all;
  std::vector<kernel::vertex_box> beyond;
  if (all.low.x <= r.low.x) beyond.push_back({all.low, {r.low.x, all.high.y}});
  if (all.high.x >= r.high.x) beyond.push_back({{r.high.x, all.low.y}, all.high});
  if (all.low.y <= r.low.y) beyond.push_back({all.low, {all.high.x, r.low.y}});
  if (all.high.y >= r.high.y) beyond.push_back({{all.low.x, r.high.y}, all.high});
  return beyond;
}

Rational squared(const Rational& value) { return value * value; }

/// How far x is from an interval.
Rational distance(const Rational& x, double low, double high) {
  if (x < low) return low - x;
  if (x > high) return x - high;
  return 0;
}

Rational cross(double2 a, double2 b, double2 c) {
  const Rational ax = a.x, ay = a.y;
  return (b.x - ax) * (c.y - ay) - (b.y - ay) * (c.x - ax);
}

/// Whether the closed circle of a triangle holds no place that a point of another block may have.
bool circle_is_free(const block_frame& frame, double2 a, double2 b, double2 c) {
  const Rational doubled = 2 * cross(a, b, c);
  const auto beyond = boxes_beyond(frame);
  if (beyond.empty()) return true;
  if (doubled == 0) return false;
  const Rational px = b.x - Rational(a.x), py = b.y - Rational(a.y);
  const Rational qx = c.x - Rational(a.x), qy = c.y - Rational(a.y);
  const Rational pp = px * px + py * py, qq = qx * qx + qy * qy;
  const Rational x = (qy * pp - py * qq) / doubled, y = (px * qq - qx * pp) / doubled;
  const Rational radius = x * x + y * y;
  return std::all_of(beyond.begin(), beyond.end(), [&](const kernel::vertex_box& box) {
    return squared(distance(x + a.x, box.low.x, box.high.x)) +
               squared(distance(y + a.y, box.low.y, box.high.y)) >
           radius;
  });
}

/// Whether no such place is right of the line from a to b, and the segment is within the rectangle.
bool half_plane_is_free(const block_frame& frame, double2 a, double2 b) {
  const kernel::vertex_box& r = frame.rectangle;
  for (const double2 p : {a, b}) {
    if (!(r.low.x < p.x && p.x < r.high.x && r.low.y < p.y && p.y < r.high.y)) return false;
  }
  for (const kernel::vertex_box& box : boxes_beyond(frame)) {
    for (const double x : {box.low.x, box.high.x}) {
      for (const double y : {box.low.y, box.high.y}) {
        if (cross(a, b, {x, y}) < 0) return false;
      }
    }
  }
  return true;
}

/// A frame with random sides, some of them infinite, around points that are in it.
block_frame frame_around(const std::vector<double2>& points, double reach, FixtureRandom& random) {
  block_frame frame{};
  frame.rectangle = {{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  for (const double2 p : points) {
    frame.rectangle.low = {std::min(frame.rectangle.low.x, p.x), std::min(frame.rectangle.low.y, p.y)};
    frame.rectangle.high = {std::max(frame.rectangle.high.x, p.x), std::max(frame.rectangle.high.y, p.y)};
  }
  frame.all = frame.rectangle;
  const auto move = [&](double& side, double& outer, double sign) {
    side += sign * reach * random.unit();
    outer = side + sign * reach * random.unit();
    if (random.integer(0, 4) == 0) outer = side;  // points just on the side
    if (random.integer(0, 2) == 0) side = sign * kInfinity;
  };
  move(frame.rectangle.low.x, frame.all.low.x, -1);
  move(frame.rectangle.low.y, frame.all.low.y, -1);
  move(frame.rectangle.high.x, frame.all.high.x, 1);
  move(frame.rectangle.high.y, frame.all.high.y, 1);
  return frame;
}

/// What the checks met: how often they were sure, and how often they could have been.
struct Sure {
  std::size_t said = 0, free = 0;
};

void check(const block_frame& frame, double2 a, double2 b, double2 c, Sure& circles, Sure& half_planes) {
  const bool circle = kernel::is_circle_inside(&frame, a, b, c) != 0;
  const bool is_free = circle_is_free(frame, a, b, c);
  EXPECT_TRUE(is_free || !circle) << a.x << " " << a.y << " " << b.x << " " << b.y << " " << c.x << " "
                                  << c.y;
  circles.said += circle;
  circles.free += is_free;
  const bool half_plane = kernel::is_half_plane_inside(&frame, a, b) != 0;
  const bool is_outside_free = half_plane_is_free(frame, a, b);
  EXPECT_TRUE(is_outside_free || !half_plane) << a.x << " " << a.y << " " << b.x << " " << b.y;
  half_planes.said += half_plane;
  half_planes.free += is_outside_free;
}

/// Three points: uniform, of a small grid, or nearly on a line.
std::vector<double2> three_points(int kind, FixtureRandom& random) {
  std::vector<double2> points;
  for (int k = 0; k < 3; ++k) {
    const double x = random.unit();
    if (kind == 0) points.push_back({x, random.unit()});
    if (kind == 1) {
      const auto column = static_cast<double>(random.integer(0, 8));
      points.push_back({column, static_cast<double>(random.integer(0, 8))});
    }
    if (kind == 2)
      points.push_back({x, 0.3 * x + std::ldexp(random.unit(), -static_cast<int>(random.integer(0, 60)))});
  }
  return points;
}

TEST(SmallCertify, IsNeverWrong) {
  FixtureRandom random(1);
  Sure circles, half_planes;
  for (int trial = 0; trial < 60000; ++trial) {
    std::vector<double2> p = three_points(trial % 3, random);
    const int exponent = static_cast<int>(trial % 5 == 0   ? 0
                                          : trial % 5 == 1 ? 245
                                          : trial % 5 == 2 ? -190
                                                           : random.integer(-190, 245));
    const double scale = std::ldexp(1, exponent);
    const double aspect = trial % 7 == 0 ? std::ldexp(1, -static_cast<int>(random.integer(0, 60))) : 1;
    for (double2& point : p) point = {point.x * scale, point.y * scale * aspect};
    const double reach = scale * std::ldexp(1, static_cast<int>(random.integer(-3, 3)));
    check(frame_around(p, reach, random), p[0], p[1], p[2], circles, half_planes);
    if (::testing::Test::HasFailure()) return;
  }
  // Nor is it much too careful.
  EXPECT_GT(circles.said, 5000u);
  EXPECT_GT(100 * circles.said, 95 * circles.free);
  EXPECT_GT(half_planes.said, 1000u);
  EXPECT_GT(100 * half_planes.said, 80 * half_planes.free);  // not of equal points
}

/// Sides that touch a circle, or lie as close to it as doubles can.
TEST(SmallCertify, SidesThatTouchACircle) {
  FixtureRandom random(2);
  const double2 places[] = {{5, 0},  {4, 3},  {3, 4},   {0, 5},  {-3, 4},
                            {-4, 3}, {-5, 0}, {-4, -3}, {0, -5}, {4, -3}};
  Sure circles, half_planes;
  for (int trial = 0; trial < 20000; ++trial) {
    double2 p[3];
    for (double2& point : p) point = places[random.integer(0, 9)];
    block_frame frame{};
    double side = 5;
    const std::int64_t steps = random.integer(-40, 400);
    for (std::int64_t k = 0; k < std::abs(steps); ++k) side = std::nextafter(side, steps < 0 ? 0 : 9);
    frame.rectangle = {{-kInfinity, -kInfinity}, {kInfinity, kInfinity}};
    frame.all = {{-9, -9}, {9, 9}};
    double* const sides[] = {&frame.rectangle.low.x, &frame.rectangle.low.y, &frame.rectangle.high.x,
                             &frame.rectangle.high.y};
    const auto k = static_cast<std::size_t>(random.integer(0, 3));
    *sides[k] = k < 2 ? -side : side;
    check(frame, p[0], p[1], p[2], circles, half_planes);
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(circles.said, 500u);
  EXPECT_GT(circles.free, circles.said);  // within the bound for errors it is not sure
}

TEST(SmallCertify, TrianglesWellInside) {
  FixtureRandom random(3);
  for (int trial = 0; trial < 20000; ++trial) {
    const std::vector<double2> p = three_points(0, random);
    const double px = p[1].x - p[0].x, py = p[1].y - p[0].y, qx = p[2].x - p[0].x, qy = p[2].y - p[0].y;
    const double doubled = 2 * (px * qy - py * qx);
    if (std::fabs(doubled) < 1e-3) continue;
    const double pp = px * px + py * py, qq = qx * qx + qy * qy;
    const double x = (qy * pp - py * qq) / doubled, y = (px * qq - qx * pp) / doubled;
    const double reach = std::hypot(x, y) * (1 + 1e-9);
    block_frame frame{};
    frame.rectangle = {{p[0].x + x - reach, p[0].y + y - reach}, {p[0].x + x + reach, p[0].y + y + reach}};
    frame.all = {{-1e3, -1e3}, {1e3, 1e3}};
    ASSERT_TRUE(kernel::is_circle_inside(&frame, p[0], p[1], p[2]));
  }
}

/// Points a few units in the last place apart are told as well as others: what counts is how far they are
/// from each other, not from the origin.
TEST(SmallCertify, PointsFarFromTheOrigin) {
  FixtureRandom random(5);
  Sure circles, half_planes;
  for (int trial = 0; trial < 20000; ++trial) {
    const double far = trial % 2 == 0 ? 1 : -0x1p30, unit = trial % 2 == 0 ? 0x1p-52 : 0x1p-22;
    std::vector<double2> points;
    for (int k = 0; k < 3; ++k) {
      const double x = far + unit * static_cast<double>(random.integer(0, 50));
      points.push_back({x, far - unit * static_cast<double>(random.integer(0, 50))});
    }
    check(frame_around(points, 100 * unit, random), points[0], points[1], points[2], circles, half_planes);
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(circles.said, 2000u);
  // Many a side touches a circle of such points.
  EXPECT_GT(100 * circles.said, 90 * circles.free);
}

TEST(SmallCertify, WithoutOtherBlocksAllIsFinal) {
  block_frame frame{};
  frame.rectangle = {{-kInfinity, -kInfinity}, {kInfinity, kInfinity}};
  frame.all = {{0, 0}, {1, 1}};
  EXPECT_FALSE(kernel::has_other_frames(&frame));
  EXPECT_TRUE(kernel::is_circle_inside(&frame, {0, 0}, {0.5, 0}, {1, 0}));  // though there is none
  EXPECT_TRUE(kernel::is_half_plane_inside(&frame, {0, 0}, {0, 1}));
  frame.rectangle.high.x = 1;
  EXPECT_TRUE(kernel::has_other_frames(&frame));
  EXPECT_FALSE(kernel::is_circle_inside(&frame, {0, 0}, {0.5, 0}, {1, 0}));
  EXPECT_FALSE(kernel::is_half_plane_inside(&frame, {0, 0}, {1, 1}));
  EXPECT_FALSE(kernel::is_half_plane_inside(&frame, {0, 0}, {0, 1}));
  EXPECT_TRUE(kernel::is_half_plane_inside(&frame, {0, 1}, {0, 0}));
}

// -----------------------------------------------------------------------------------------------------------
// Open sectors

struct Direction {
  std::int64_t x, y;
};

__extension__ using Wide = __int128;
int turn(Direction a, Direction b) {
  const Wide left = Wide{a.x} * b.y, right = Wide{a.y} * b.x;
  return left > right ? 1 : left < right ? -1 : 0;
}
bool are_same(Direction a, Direction b) { return turn(a, b) == 0 && Wide{a.x} * b.x + Wide{a.y} * b.y > 0; }
/// Of a direction counter-clockwise from `from`: 0 the same, 1 less than half a turn, 2 half a turn, 3 more.
int part_of(Direction from, Direction d) {
  const int side = turn(from, d);
  return side > 0 ? 1 : side < 0 ? 3 : are_same(from, d) ? 0 : 2;
}
bool comes_first_around(Direction from, Direction a, Direction b) {
  const int at_a = part_of(from, a), at_b = part_of(from, b);
  return at_a != at_b ? at_a < at_b : turn(a, b) > 0;
}

Direction random_direction(std::int64_t reach, bool along_a_line, FixtureRandom& random) {
  Direction d{0, 0};
  while (d.x == 0 && d.y == 0) {
    d = {random.integer(-reach, reach), random.integer(-reach, reach)};
    if (along_a_line) d = {3 * d.x + random.integer(-1, 1), 2 * d.x + random.integer(-1, 1)};
  }
  return d;
}

/// The star of a vertex: its neighbours counter-clockwise, and which sectors are open. On the hull the last
/// neighbour's sector is its ghost, and one more is that of the first neighbour.
struct Star {
  bool is_on_hull = false;
  std::vector<Direction> neighbors;
  std::vector<bool> is_open;

  /// False if there is no such star: each sector but the outside is less than half a turn.
  bool make(Direction first, std::vector<Direction> directions, bool on_hull, FixtureRandom& random) {
    is_on_hull = on_hull;
    directions.push_back(first);
    std::sort(directions.begin(), directions.end(),
              [&](Direction a, Direction b) { return comes_first_around(first, a, b); });
    for (const Direction d : directions) {
      if (on_hull && part_of(first, d) == 3) continue;
      if (neighbors.empty() || !are_same(neighbors.back(), d)) neighbors.push_back(d);
    }
    const std::size_t m = neighbors.size();
    if (m < (on_hull ? 2u : 3u)) return false;
    for (std::size_t k = 0; k + (on_hull ? 1 : 0) < m; ++k) {
      if (turn(neighbors[k], neighbors[(k + 1) % m]) <= 0) return false;
    }
    const std::int64_t rarely = random.integer(1, 4);
    for (std::size_t k = 0; k < m + (on_hull ? 1 : 0); ++k) is_open.push_back(random.integer(0, rarely) == 0);
    return true;
  }

  std::size_t sector_of(Direction d) const {
    std::size_t sector = 0;
    for (std::size_t k = 1; k < neighbors.size(); ++k) {
      if (!comes_first_around(neighbors[0], d, neighbors[k])) sector = k;
    }
    return sector;
  }
};

/// NO_VERTEX, as an open edge has it for the ray to infinity.
constexpr int kRay = -1;

struct MetSectors {
  std::size_t open = 0, emitted = 0, undecided = 0, last = 0, rays = 0;
};

/// Asks about all neighbours and some more directions.
void check_star(const Star& star, const std::vector<Direction>& more, double2 centre, MetSectors& met) {
  std::vector<double2> points;
  const auto place = [&](Direction d) {
    return double2{centre.x + static_cast<double>(d.x), centre.y + static_cast<double>(d.y)};
  };
  const std::size_t m = star.neighbors.size(), sectors = star.is_open.size();
  std::vector<kernel::open_edge> edges{{0, 0, 1}};  // another vertex's
  for (std::size_t k = 0; k < sectors; ++k) {
    const bool before = star.is_open[(k + sectors - 1) % sectors];
    if (before == star.is_open[k]) continue;
    const int to = k < m ? static_cast<int>(k) : kRay;
    edges.push_back({to, 0, star.is_open[k]});
    met.rays += to == kRay;
  }
  const int end = static_cast<int>(edges.size());
  if (end > 1) std::rotate(edges.begin() + 1, edges.begin() + 1 + (end - 1) / 2, edges.end());
  edges.push_back({1, 0, 1});
  for (const Direction d : star.neighbors) points.push_back(place(d));
  const auto ask = [&](Direction d, int vertex, bool is_last) {
    const kernel::direction query{centre, place(d), vertex, is_last};
    const bool is_open = end == 1 || star.is_open[star.sector_of(d)];
    const int exact = kernel::begins_open(&query, edges.data(), 1, end, points.data(), ORIENT_BOUND, 1);
    const int filtered = kernel::begins_open(&query, edges.data(), 1, end, points.data(), ORIENT_BOUND, 0);
    ASSERT_EQ(exact, is_open) << "vertex " << vertex << " of " << m
                              << (star.is_on_hull ? " on the hull" : "");
    ASSERT_TRUE(filtered == UNDECIDED || filtered == is_open);
    (is_open ? met.open : met.emitted) += 1;
    met.undecided += filtered == UNDECIDED;
    met.last += is_last;
  };
  for (std::size_t k = 0; k < m; ++k) {
    ask(star.neighbors[k], static_cast<int>(k), star.is_on_hull && k + 1 == m);
    if (::testing::Test::HasFatalFailure()) return;
  }
  for (const Direction d : more) {
    const bool is_there = std::any_of(star.neighbors.begin(), star.neighbors.end(),
                                      [&](Direction w) { return are_same(w, d); });
    if (is_there) continue;
    if (star.is_on_hull && star.sector_of(d) + 1 >= m) continue;  // outside
    ask(d, static_cast<int>(m), false);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(SmallOpenSectors, AreThoseByAngles) {
  FixtureRandom random(4);
  MetSectors met;
  std::size_t stars = 0;
  for (int trial = 0; trial < 60000; ++trial) {
    const std::int64_t reach = trial % 3 == 0 ? 2 : trial % 3 == 1 ? 1000 : std::int64_t{1} << 40;
    const bool along_a_line = trial % 4 == 0;
    std::vector<Direction> directions, more;
    for (std::int64_t k = random.integer(1, 9); k > 0; --k) {
      directions.push_back(random_direction(reach, along_a_line, random));
    }
    const Direction first = random_direction(reach, along_a_line, random);
    // Opposite neighbours: a vertex within an edge of the hull.
    if (trial % 5 == 0) directions.push_back({-2 * first.x, -2 * first.y});
    for (int k = 0; k < 6; ++k) more.push_back(random_direction(reach, along_a_line, random));
    Star star;
    if (!star.make(first, directions, trial % 2 == 0, random)) continue;
    ++stars;
    const double2 centre{static_cast<double>(random.integer(-reach, reach)),
                         static_cast<double>(random.integer(-reach, reach))};
    check_star(star, more, centre, met);
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(stars, 10000u);
  EXPECT_GT(met.open, 10000u);
  EXPECT_GT(met.emitted, 10000u);
  EXPECT_GT(met.undecided, 100u);
  EXPECT_GT(met.last, 1000u);
  EXPECT_GT(met.rays, 1000u);
}

}  // namespace
}  // namespace flaunay::blocks
