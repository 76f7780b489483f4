// Clipped Voronoi cells against twins in exact arithmetic, which know nothing of triangulations: a cell is
// the polygon cut by the bisectors with all other points.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include "derived/voronoi/clip.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "tests/locate/support.hpp"
#include "tests/support/errors.hpp"
#include "voronoi/centre_side.h"

namespace flaunay::locate {
namespace {

using kernel::double2;
using voronoi::checked_polygon;
using voronoi::ClipPolygon;

ClippedVoronoi clip(Runtime& runtime, const Case& input, const Coordinates& corners) {
  Arena::Scope scope(runtime.arena());
  const std::size_t n = input.size();
  const voronoi::ClippedBuffers result{guarded<cl_int>(runtime, n + 1), guarded<cl_double>(runtime, n),
                                       guarded<cl_double>(runtime, 2 * n)};
  // Not from the arena, in whose scope the call works.
  Buffer<cl_double> vertices;
  std::size_t count = 0;
  constexpr std::size_t kRoom = 64;
  voronoi::compute_clipped(
      runtime, upload_mesh(runtime, input), checked_polygon(corners.data(), corners.size() / 2), result,
      [&](std::size_t vertex_count) {
        count = vertex_count;
        const std::size_t room = 2 * vertex_count + kRoom;
        vertices = {host::allocate_memory(runtime.memory(), room * sizeof(double)), room};
        runtime.fill(vertices, room, 7.0);
        return vertices;
      });
  ClippedVoronoi found;
  found.vertices.resize(2 * count + kRoom);
  runtime.read(vertices, 0, found.vertices.size(), found.vertices.data());
  for (std::size_t i = 0; i < kRoom; ++i)
    EXPECT_EQ(found.vertices[2 * count + i], 7.0) << "written beyond the end";
  found.vertices.resize(2 * count);
  found.offsets = download(runtime, result.offsets, n + 1);
  found.areas = download(runtime, result.areas, n);
  found.centroids = download(runtime, result.centroids, 2 * n);
  return found;
}

// ---------------------------------------------------------------------------------------------------------------------
// The twin

using Place = std::pair<mpq_class, mpq_class>;

Place place(const double* p) { return {mpq_class(p[0]), mpq_class(p[1])}; }

/// Where a x + b y + c is positive is the left side.
struct Line {
  mpq_class a, b, c;
  mpq_class at(const Place& p) const { return a * p.first + b * p.second + c; }
};

Line line_through(const Place& v, const Place& w) {
  const mpq_class a = v.second - w.second, b = w.first - v.first;
  return {a, b, -a * v.first - b * v.second};
}

/// Positive where p is nearer.
Line bisector(const Place& p, const Place& q) {
  return {2 * (p.first - q.first), 2 * (p.second - q.second),
          q.first * q.first + q.second * q.second - p.first * p.first - p.second * p.second};
}

Place crossing(const Line& f, const Line& g) {
  const mpq_class whole = f.a * g.b - f.b * g.a;
  return {(f.b * g.c - f.c * g.b) / whole, (f.c * g.a - f.a * g.c) / whole};
}

/// Side i leads from corner i to the next one.
struct Cell {
  std::vector<Place> corners;
  std::vector<Line> sides;

  void cut(const Line& line) {
    std::vector<int> signs;
    for (const Place& corner : corners) signs.push_back(sgn(line.at(corner)));
    if (std::none_of(signs.begin(), signs.end(), [](int s) { return s < 0; })) return;
    Cell left;
    if (std::any_of(signs.begin(), signs.end(), [](int s) { return s > 0; })) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const int here = signs[i], next = signs[(i + 1) % corners.size()];
        if (here >= 0) left.add(corners[i], here == 0 && next < 0 ? line : sides[i]);
        if (here > 0 && next < 0) left.add(crossing(sides[i], line), line);
        if (here < 0 && next > 0) left.add(crossing(sides[i], line), sides[i]);
      }
    }
    *this = left;
  }
  void add(const Place& corner, const Line& side) {
    corners.push_back(corner);
    sides.push_back(side);
  }
};

Cell polygon_cell(const Coordinates& corners) {
  const std::size_t count = corners.size() / 2;
  Cell cell;
  for (std::size_t i = 0; i < count; ++i) {
    const Place at = place(&corners[2 * i]), next = place(&corners[2 * ((i + 1) % count)]);
    const Place before = place(&corners[2 * ((i + count - 1) % count)]);
    if (line_through(before, at).at(next) != 0) cell.add(at, line_through(at, next));
  }
  // Sides from corners that are left out are on the same line as those before.
  return cell;
}

/// Twice the area, and six times its product with the centroid relative to the first corner.
struct Measures {
  mpq_class twice, moment_x, moment_y;
};
Measures measures(const std::vector<Place>& corners) {
  Measures sum;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const mpq_class ax = corners[i].first - corners[0].first, ay = corners[i].second - corners[0].second;
    const mpq_class bx = corners[i + 1].first - corners[0].first,
                    by = corners[i + 1].second - corners[0].second;
    const mpq_class area = ax * by - ay * bx;
    sum.twice += area;
    sum.moment_x += area * (ax + bx);
    sum.moment_y += area * (ay + by);
  }
  return sum;
}

std::vector<Cell> cells_twin(const Case& input, const Coordinates& corners) {
  const Cell whole = polygon_cell(corners);
  const mpq_class area = measures(whole.corners).twice;
  std::vector<Cell> cells(input.size());
  for (std::size_t s = 0; s < input.sets(); ++s) {
    std::map<Place, std::size_t> distinct;
    for (std::size_t i = input.offsets[s]; i < input.offsets[s + 1]; ++i) {
      distinct.emplace(place(&input.points[2 * i]), i);
    }
    mpq_class sum = 0;
    for (const auto& [p, i] : distinct) {
      Cell& cell = cells[i] = whole;
      for (const auto& [q, j] : distinct) {
        if (i != j) cell.cut(bisector(p, q));
      }
      sum += measures(cell.corners).twice;
    }
    if (!distinct.empty()) {
      EXPECT_EQ(sum, area) << "the twin's cells do not tile the polygon";
    }
  }
  return cells;
}

// ---------------------------------------------------------------------------------------------------------------------
// Comparisons

mpq_class distance(const Place& a, const Place& b) {
  return abs(a.first - b.first) + abs(a.second - b.second);
}
mpq_class size_of(const Place& a) { return abs(a.first) + abs(a.second); }

mpq_class diameter(const std::vector<Place>& corners) {
  mpq_class most = 0;
  for (const Place& corner : corners) most = std::max(most, distance(corner, corners[0]));
  return most;
}

/// The stated errors: 2^-36 of the distance to the point, or 2^-45 of a clip edge, and last places.
bool is_near(const Place& found, const Place& expected, const Place& point, const mpq_class& clip_size) {
  const mpq_class allowed = distance(expected, point) * mpq_class(0x1p-35) + clip_size * mpq_class(0x1p-44) +
                            (size_of(expected) + size_of(point)) * mpq_class(0x1p-50) + mpq_class(0x1p-1070);
  return distance(found, expected) <= allowed;
}

/// Vertices that are the same place are the same bits, in whichever cell.
using SameBits = std::map<Place, std::pair<double, double>>;

/// The stated errors, of a cell with these corners: of the area some last places of the square of its extent,
/// and of the centroid as many of the extent, times the quotient of that square and the area.
void check_measures(const std::vector<Place>& corners, double area, const Place& centroid) {
  const Measures exact = measures(corners);
  const mpq_class extent = diameter(corners);
  // Beyond what doubles can hold.
  if (extent * extent > mpq_class(0x1p1020) || extent * extent < mpq_class(0x1p-960)) return;
  const mpq_class rounding = mpq_class(0x1p-50) * mpq_class(static_cast<double>(corners.size()));
  EXPECT_LE(abs(2 * mpq_class(area) - exact.twice), extent * extent * rounding);
  EXPECT_GE(area, 0);
  // Corners that are rounded may be on a line, or beyond.
  if (exact.twice <= 4 * extent * extent * rounding) return;
  const Place expected{corners[0].first + exact.moment_x / (3 * exact.twice),
                       corners[0].second + exact.moment_y / (3 * exact.twice)};
  EXPECT_LE(distance(centroid, expected), 4 * extent * rounding * extent * extent / exact.twice +
                                              (size_of(expected) + size_of(corners[0])) * mpq_class(0x1p-52));
}

void check_cell(std::size_t i, const Case& input, const Cell& expected, const ClippedVoronoi& found,
                const mpq_class& clip_size, SameBits& same_bits) {
  const auto first = static_cast<std::size_t>(found.offsets[i]),
             end = static_cast<std::size_t>(found.offsets[i + 1]);
  const std::size_t count = expected.corners.size();
  ASSERT_EQ(end - first, count) << "point " << i;
  if (count == 0) {
    EXPECT_EQ(found.areas[i], 0.0);
    EXPECT_TRUE(std::isnan(found.centroids[2 * i]) && std::isnan(found.centroids[2 * i + 1]));
    return;
  }
  std::vector<Place> places;
  for (std::size_t v = first; v < end; ++v) places.push_back(place(&found.vertices[2 * v]));
  // Which of the twin's corners is first.
  std::size_t turn = 0;
  const auto fits = [&](std::size_t by) {
    for (std::size_t k = 0; k < count; ++k) {
      if (!is_near(places[k], expected.corners[(k + by) % count], place(&input.points[2 * i]), clip_size))
        return false;
    }
    return true;
  };
  while (turn < count && !fits(turn)) ++turn;
  ASSERT_LT(turn, count) << "point " << i;
  // Where many corners are too near to be told apart, the order says nothing.
  bool is_clear = true;
  for (std::size_t other = turn + 1; other < count; ++other) is_clear = is_clear && !fits(other);
  for (std::size_t k = 0; k < count && is_clear; ++k) {
    const std::size_t v = first + k;
    const std::pair<double, double> bits{found.vertices[2 * v], found.vertices[2 * v + 1]};
    const auto [known, is_new] = same_bits.emplace(expected.corners[(k + turn) % count], bits);
    EXPECT_TRUE(is_new || known->second == bits)
        << "point " << i << ": a vertex of several cells is not the same in all";
  }
  check_measures(places, found.areas[i], place(&found.centroids[2 * i]));
}

void check_clipped(const Case& input, const Coordinates& corners,
                   const std::vector<std::string>& names = tunings()) {
  const std::vector<Cell> expected = cells_twin(input, corners);
  const mpq_class clip_size = diameter(polygon_cell(corners).corners);
  std::unique_ptr<ClippedVoronoi> first;
  for (const std::string& name : names) {
    SCOPED_TRACE("tuning " + name);
    const ClippedVoronoi found = clip(Runtimes::get(name), input, corners);
    if (first) {
      EXPECT_TRUE(same(found.offsets, first->offsets));
      EXPECT_TRUE(same(found.vertices, first->vertices));
      EXPECT_TRUE(same(found.areas, first->areas));
      continue;
    }
    ASSERT_EQ(found.offsets.front(), 0);
    ASSERT_EQ(static_cast<std::size_t>(found.offsets.back()), found.vertices.size() / 2);
    ASSERT_TRUE(std::is_sorted(found.offsets.begin(), found.offsets.end()));
    SameBits same_bits;
    for (std::size_t i = 0; i < input.size(); ++i)
      check_cell(i, input, expected[i], found, clip_size, same_bits);
    first = std::make_unique<ClippedVoronoi>(found);
  }
}

Coordinates box(double x0, double y0, double x1, double y1) { return {x0, y0, x1, y0, x1, y1, x0, y1}; }

/// A polygon of integers around (x, y): all primitive directions of at most this length, by angle.
Coordinates round_polygon(double x, double y, int reach, double scale) {
  std::vector<std::array<int, 2>> steps;
  for (int dx = -reach; dx <= reach; ++dx) {
    for (int dy = -reach; dy <= reach; ++dy) {
      if (std::gcd(dx, dy) == 1) steps.push_back({dx, dy});
    }
  }
  std::sort(steps.begin(), steps.end(),
            [](const auto& a, const auto& b) { return std::atan2(a[1], a[0]) < std::atan2(b[1], b[0]); });
  Coordinates corners;
  double at[2] = {x, y};
  for (const auto& step : steps) {
    corners.insert(corners.end(), {at[0], at[1]});
    at[0] += scale * step[0];
    at[1] += scale * step[1];
  }
  return corners;
}

struct Box {
  double low[2]{HUGE_VAL, HUGE_VAL}, high[2]{-HUGE_VAL, -HUGE_VAL};
};
Box bounds_of(const Coordinates& points) {
  Box bounds;
  for (std::size_t i = 0; i < points.size(); ++i) {
    bounds.low[i % 2] = std::min(bounds.low[i % 2], points[i]);
    bounds.high[i % 2] = std::max(bounds.high[i % 2], points[i]);
  }
  for (int k = 0; k < 2; ++k) {
    if (!(bounds.low[k] < bounds.high[k])) {
      bounds.high[k] = std::isfinite(bounds.low[k]) ? bounds.low[k] : 0;
      bounds.low[k] = bounds.high[k] - 1;
      bounds.high[k] += 1;
    }
  }
  return bounds;
}

/// Polygons of all kinds about these points.
std::vector<Coordinates> polygons_for(const Coordinates& points, std::uint64_t seed) {
  const Box bounds = bounds_of(points);
  const auto at = [&](double x, double y) {
    return std::array<double, 2>{bounds.low[0] * (1 - x) + bounds.high[0] * x,
                                 bounds.low[1] * (1 - y) + bounds.high[1] * y};
  };
  const auto box_of = [&](double x0, double y0, double x1, double y1) {
    const auto low = at(x0, y0), high = at(x1, y1);
    return box(low[0], low[1], high[0], high[1]);
  };
  std::vector<Coordinates> polygons{box_of(-0.25, -0.5, 1.5, 1.25), box_of(0, 0, 1, 1),
                                    box_of(0.25, 0.25, 0.5, 0.75), box_of(3, 3, 3.5, 4)};
  // A triangle with a corner on the points' box, and collinear corners.
  const auto a = at(0.5, 1.25), b = at(-0.25, 0), c = at(1.25, 0), m = at(0.5, 0);
  polygons.push_back({a[0], a[1], b[0], b[1], m[0], b[1], c[0], c[1]});
  // A triangle of three of the points.
  FixtureRandom random(seed);
  for (int tries = 0; tries < 20 && points.size() >= 6; ++tries) {
    const double* p[3];
    for (const double*& each : p)
      each = &points[2 * static_cast<std::size_t>(
                             random.integer(0, static_cast<std::int64_t>(points.size() / 2) - 1))];
    const mpq_class side = line_through(place(p[0]), place(p[1])).at(place(p[2]));
    if (side == 0) continue;
    if (side < 0) std::swap(p[1], p[2]);
    polygons.push_back({p[0][0], p[0][1], p[1][0], p[1][1], p[2][0], p[2][1]});
    break;
  }
  return polygons;
}

Case one_set(const Coordinates& points) {
  Case input;
  input.add(points, {});
  input.triangulate();
  return input;
}

Coordinates lattice(int width, int height) {
  Coordinates points;
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < height; ++y) points.insert(points.end(), {x * 1.0, y * 1.0});
  }
  return points;
}

TEST(SmallClip, ManySets) {
  const Case input = nested_case(7, 0);
  check_clipped(input, box(-1, -2, 3, 4));
  check_clipped(input, {0, 0, 2, -1, 3, 5});
}

TEST(SmallClip, Grid) { check_clipped(one_set(lattice(4, 3)), box(0.5, -1, 2.5, 2)); }

TEST(SmallClip, Uniform) { check_clipped(one_set(make_fixture("uniform", 30, 1)), box(0, 0, 1, 1)); }

/// Clip edges along Voronoi edges, through Voronoi vertices, through points; corners at both.
TEST(Clip, GridsCutAtEveryPlace) {
  const Case input = one_set(lattice(5, 4));
  for (int x = -1; x < 5; ++x) {
    for (int size = 1; size < 8; ++size) {
      SCOPED_TRACE(::testing::Message() << x << " " << size);
      check_clipped(input, box(0.5 * x, 0.5 * x, 0.5 * (x + size), 0.5 * (x + size) + 0.25));
      check_clipped(input, box(0.5 * x, 0.5, 0.5 * (x + size), 2.5));
      // Diamonds.
      const double c = 0.5 * x + 1, r = 0.5 * size;
      check_clipped(input, {c, c - r, c + r, c, c, c + r, c - r, c});
    }
  }
  check_clipped(input, round_polygon(0, -1, 2, 0.25));
}

/// Random triangles and quadrangles of half-integers about a few random integers.
TEST(Clip, SmallIntegers) {
  FixtureRandom random(2);
  for (int round = 0; round < 400; ++round) {
    SCOPED_TRACE(round);
    Coordinates points;
    const std::int64_t n = random.integer(1, 9), reach = random.integer(1, 4);
    for (std::int64_t i = 0; i < 2 * n; ++i)
      points.push_back(static_cast<double>(random.integer(-reach, reach)));
    Coordinates corners;
    do {
      corners.clear();
      for (int i = 0; i < 6; ++i) corners.push_back(0.5 * static_cast<double>(random.integer(-8, 8)));
    } while (line_through(place(&corners[0]), place(&corners[2])).at(place(&corners[4])) <= 0);
    check_clipped(one_set(points), corners, {"own"});
  }
}

TEST(Clip, EveryFixture) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Case input = one_set(fixture.make(25, 3));
    const std::vector<Coordinates> polygons = polygons_for(input.points, 4);
    for (std::size_t k = 0; k < polygons.size(); ++k) {
      SCOPED_TRACE(k);
      check_clipped(input, polygons[k]);
    }
  }
}

TEST(Clip, SetsOfAllKinds) {
  const Case input = nested_case(20, 0);
  for (const Coordinates& corners : polygons_for(input.points, 5)) check_clipped(input, corners);
}

TEST(Clip, PolygonsOfManyCorners) {
  const Case input = one_set(make_fixture("uniform", 60, 6));
  check_clipped(input, round_polygon(0.25, 0.0, 6, 0x1p-9));
  check_clipped(input, round_polygon(0.5, 0.5, 9, 0x1p-14));
  check_clipped(one_set({0.5, 0.5}), round_polygon(0.25, 0.0, 6, 0x1p-9));
}

TEST(Clip, FewPoints) {
  const Coordinates corners = {0, 0, 4, 0, 4, 3, 0, 3};
  for (const Coordinates& points :
       {Coordinates{}, Coordinates{9, 9}, Coordinates{1, 1, 1, 1, 1, 1}, Coordinates{0, 0, 4, 3},
        Coordinates{1, 0, 3, 0}, Coordinates{-5, 0, 5, 0}, Coordinates{-5, 1, -7, 1},
        Coordinates{0, 1, 0, 2, 0, 3, 0, 1, 0, 9}, Coordinates{0, 0, 1, 1, 2, 2, 3, 3, 4, 4}}) {
    check_clipped(one_set(points), corners);
  }
}

/// A hub, whose cell has as many corners as there are other points, and the same with ties.
TEST(Clip, Hubs) {
  for (const char* const name : {"star", "integer-star", "circle-few-inside"}) {
    SCOPED_TRACE(name);
    const Case input = one_set(make_fixture(name, 120, 7));
    const Box bounds = bounds_of(input.points);
    check_clipped(input, box(bounds.low[0], bounds.low[1], bounds.high[0] / 2, bounds.high[1] / 4));
  }
}

TEST(Clip, Magnitudes) {
  const Coordinates points = make_fixture("uniform", 30, 8);
  for (const double factor : {0x1p960, 0x1p-900, 0x1p300, 0x1p-300}) {
    SCOPED_TRACE(factor);
    check_clipped(one_set(testing::scaled(points, factor)),
                  testing::scaled(Coordinates{0.25, -0.5, 1.5, 0.25, 0.75, 1.25, 0, 0.5}, factor));
  }
}

/// A million corners of one cell must not take a million times a million steps.
TEST(Clip, ALargeHub) {
  const Case input = one_set(make_fixture("star", 20000, 9));
  const Coordinates corners = box(-0.25, -0.25, 0.125, 0.5);
  const ClippedVoronoi found = clip(Runtimes::get("own"), input, corners);
  double sum = 0;
  for (const double area : found.areas) sum += area;
  EXPECT_NEAR(sum, 0.375 * 0.75, 1e-12);
}

/// Numbers that are no triangulation: cells mean nothing, but they are disjoint parts of their array.
TEST(Clip, CellsFitWhateverTheMesh) {
  FixtureRandom random(10);
  for (int round = 0; round < 40; ++round) {
    Case input = one_set(make_fixture(round % 2 != 0 ? "grid" : "uniform", 40, 11));
    const auto corners = static_cast<std::int64_t>(input.mesh.triangles.size());
    const std::int64_t rarely = random.integer(0, 60);
    for (auto* const values : {&input.mesh.triangles, &input.mesh.neighbors, &input.mesh.hull}) {
      for (std::int32_t& value : *values) {
        if (random.integer(0, rarely) == 0)
          value = static_cast<std::int32_t>(random.integer(-2, corners / 3));
      }
    }
    const ClippedVoronoi found = clip(Runtimes::get("own"), input, box(0.25, 0.25, 4, 4.5));
    EXPECT_EQ(found.offsets.front(), 0);
    EXPECT_TRUE(std::is_sorted(found.offsets.begin(), found.offsets.end()));
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Predicates

int centre_side_twin(const double2 (&p)[3], double2 v, double2 w) {
  const auto at = [](double2 q) { return Place{mpq_class(q.x), mpq_class(q.y)}; };
  const Place centre = crossing(bisector(at(p[0]), at(p[1])), bisector(at(p[0]), at(p[2])));
  return sgn(line_through(at(v), at(w)).at(centre));
}

TEST(SmallCentreSide, AgreesWithRationals) {
  FixtureRandom random(12);
  std::size_t ties = 0, tested = 0;
  for (int round = 0; round < 6000; ++round) {
    double2 q[5];
    const int kind = round % 4;
    for (double2& each : q) {
      const auto number = [&]() -> double {
        if (kind == 0) return static_cast<double>(random.integer(-2, 2));
        if (kind == 1) return random.unit();
        if (kind == 2)
          return std::ldexp(static_cast<double>(random.integer(-1, 1)),
                            60 * static_cast<int>(random.integer(-4, 4)));
        return static_cast<double>(random.integer(-3, 3)) +
               0x1p-40 * static_cast<double>(random.integer(-1, 1));
      };
      each = {number(), number()};
    }
    const int turn = kernel::orient_exact(q[0], q[1], q[2]);
    if (turn == 0 || (q[3].x == q[4].x && q[3].y == q[4].y)) continue;
    if (turn < 0) std::swap(q[1], q[2]);
    const double2 triangle[3] = {q[0], q[1], q[2]};
    const kernel::centre_terms terms = kernel::centre_terms_of(q[0], q[1], q[2]);
    const int expected = centre_side_twin(triangle, q[3], q[4]);
    EXPECT_EQ(kernel::centre_side_exact(&terms, q[3], q[4]), expected) << round;
    EXPECT_EQ(kernel::centre_side(&terms, q[3], q[4], CENTRE_SIDE_BOUND), expected) << round;
    const double2 b[2] = {kernel::two_sum(q[1].x, -q[0].x), kernel::two_sum(q[1].y, -q[0].y)};
    const double2 c[2] = {kernel::two_sum(q[2].x, -q[0].x), kernel::two_sum(q[2].y, -q[0].y)};
    const double2 e[2] = {kernel::two_sum(q[4].x, -q[3].x), kernel::two_sum(q[4].y, -q[3].y)};
    const double2 f[2] = {kernel::two_sum(q[0].x, -q[3].x), kernel::two_sum(q[0].y, -q[3].y)};
    EXPECT_EQ(kernel::centre_side_by_expansions(b, c, e, f), expected) << round;
    if (kind == 0) {
      EXPECT_EQ(kernel::centre_side(&terms, q[3], q[4], 0.0), expected) << round;
    }
    ++tested;
    ties += expected == 0;
  }
  EXPECT_GT(ties, 50u);
  EXPECT_GT(tested, 4000u);
}

// ---------------------------------------------------------------------------------------------------------------------
// Polygons

TEST(SmallClipPolygon, LeavesOutCollinearCorners) {
  const Coordinates corners = {0, 0, 1, 0, 2, 0, 2, 2, 2, 3, 2, 4, 0, 4, 0, 1};
  EXPECT_EQ(checked_polygon(corners.data(), 8).corners, box(0, 0, 2, 4));
}

void expect_refused(const Coordinates& corners, const std::string& what) {
  testing::expect_error(ErrorKind::input, what, [&] { checked_polygon(corners.data(), corners.size() / 2); });
}

TEST(SmallClipPolygon, NamesTheCornerThatIsWrong) {
  expect_refused({0, 0, 1, 0}, "2 corners");
  expect_refused({0, 0, 1, 0, 1, NAN}, "not finite at corner 2");
  expect_refused({0, 0, 0, 1, 1, 1, 1, 0}, "turns right at corner 0");
  expect_refused({0, 0, 4, 0, 1, 1, 0, 4}, "turns right at corner 2");
  expect_refused({0, 0, 4, 0, 4, 4, 4, 4}, "corner 2 twice");
  expect_refused({0, 0, 4, 0, 2, 0}, "goes back at corner");
  expect_refused({0, 0, 1, 0x1p300, -0x1p-300, 5}, "too");
  Coordinates star;
  for (int k = 0; k < 5; ++k) {
    star.insert(star.end(), {std::cos(4 * M_PI / 5 * k), std::sin(4 * M_PI / 5 * k)});
  }
  expect_refused(star, "more than once");
  expect_refused(Coordinates(2 * 20000, 0.0), "16383");
  EXPECT_THROW(checked_polygon(nullptr, 4), Error);
}

TEST(SmallClipPolygon, RefusesMagnitudesThatDifferTooMuch) {
  const Case input = one_set({0, 0, 0x1p-400, 0, 0, 0x1p-400});
  testing::expect_error(ErrorKind::input, "too large",
                        [&] { clip(Runtimes::get("own"), input, box(0, 0, 0x1p200, 1)); });
}

// ---------------------------------------------------------------------------------------------------------------------
// Public calls

TEST(SmallRelax, IsClippingAndMoving) {
  const Coordinates corners = {0, 0, 1, 0.25, 1.25, 1, 0, 1};
  Coordinates points = make_fixture("uniform", 40, 13);
  points.insert(points.end(), {points[0], points[1], 77.0, 78.0, 0.5, 1.5});
  Triangulator& triangulator = testing::triangulator();
  const std::size_t n = points.size() / 2;
  const Coordinates relaxed = triangulator.relax(points.data(), n, corners.data(), 4, 3);
  Coordinates expected = points;
  for (int i = 0; i < 3; ++i) {
    const Triangulation mesh = triangulator.triangulate(expected.data(), n);
    const ClippedVoronoi cells = triangulator.clipped_voronoi(expected.data(), n, mesh, corners.data(), 4);
    for (std::size_t c = 0; c < 2 * n; ++c) {
      if (cells.offsets[c / 2] < cells.offsets[c / 2 + 1]) expected[c] = cells.centroids[c];
    }
  }
  EXPECT_TRUE(same(relaxed, expected));
  EXPECT_NE(relaxed[0], points[0]);
  EXPECT_TRUE(same(triangulator.relax(points.data(), n, corners.data(), 4, 0), points));
  EXPECT_TRUE(triangulator.relax(nullptr, 0, corners.data(), 4, 5).empty());
  EXPECT_THROW(triangulator.relax(points.data(), n, corners.data(), 2, 1), Error);
  const Triangulation mesh = triangulator.triangulate(points.data(), n);
  EXPECT_THROW(triangulator.clipped_voronoi(points.data(), n - 1, mesh, corners.data(), 4), Error);
}

}  // namespace
}  // namespace flaunay::locate
