// Polygons: what is inside of them, by exact crossing numbers, as sets of their own and in a map.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "flaunay/constrained.hpp"
#include "prove/constrained_proof.hpp"
#include "tests/constrained/domains.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

// Rings with their own points.
struct Rings {
  Coordinates coordinates;
  std::vector<std::size_t> rings = {0}, polygons = {0};
  // Whether it is known which rings are borders.
  bool has_parts = false;
  std::vector<std::size_t> borders = {};

  void add_ring(const Coordinates& ring, bool is_border = false) {
    if (is_border || polygons.back() == rings.size() - 1) borders.push_back(rings.size() - 1);
    coordinates.insert(coordinates.end(), ring.begin(), ring.end());
    rings.push_back(coordinates.size() / 2);
  }
  void end_polygon() { polygons.push_back(rings.size() - 1); }
  void add(const std::vector<Coordinates>& polygon) {
    for (const Coordinates& ring : polygon) add_ring(ring);
    end_polygon();
  }
  Polygons view() const { return {coordinates.data(), rings, polygons, parts()}; }
  std::vector<std::size_t> parts() const {
    std::vector<std::size_t> offsets;
    if (!has_parts) return offsets;
    offsets = borders;
    if (offsets.empty()) offsets.push_back(0);
    if (offsets.back() != rings.size() - 1) offsets.push_back(rings.size() - 1);
    return offsets;
  }
  std::size_t count() const { return polygons.size() - 1; }

  Segments segments() const {
    Segments all;
    for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
      for (std::size_t i = rings[r]; i < rings[r + 1]; ++i) {
        all.push_back(static_cast<std::int32_t>(i));
        all.push_back(static_cast<std::int32_t>(i + 1 < rings[r + 1] ? i + 1 : rings[r]));
      }
    }
    return all;
  }
  // How a polygon goes around a place on none of its segments.
  Around around(std::size_t polygon, const RationalPlace& place) const {
    return testing::around(coordinates, segments(), rings[polygons[polygon]], rings[polygons[polygon + 1]],
                           place);
  }
  // By the definition in docs/constrained.md.
  bool is_in(std::size_t polygon, const RationalPlace& place, FillRule rule) const {
    const auto is_around = [rule](const Around& found) {
      return rule == FillRule::winding ? found.winding != 0 : found.crossings % 2 != 0;
    };
    if (!has_parts) return is_around(around(polygon, place));
    bool is_in_part = false;
    for (std::size_t r = polygons[polygon]; r < polygons[polygon + 1]; ++r) {
      const bool is_here = is_around(testing::around(coordinates, segments(), rings[r], rings[r + 1], place));
      if (std::binary_search(borders.begin(), borders.end(), r)) {
        if (is_in_part) return true;
        is_in_part = is_here;
      } else if (is_here) {
        is_in_part = false;
      }
    }
    return is_in_part;
  }
  // Of a polygon that is a set.
  std::int32_t depth(std::size_t polygon, const RationalPlace& place, FillRule rule) const {
    if (has_parts || rule == FillRule::even_odd) return is_in(polygon, place, rule) ? 1 : 0;
    return around(polygon, place).winding;
  }
};

PolygonOptions options_of(FillRule rule, Outside outside = Outside::holes, bool map = false) {
  PolygonOptions options;
  options.fill_rule = rule;
  options.outside = outside;
  options.labels = true;
  options.map = map;
  return options;
}

using Row = std::vector<std::int32_t>;
Row row_at(const std::vector<std::int32_t>& triangles, std::size_t t) {
  return {triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]};
}

// Each polygon a set: what is left must be just those of all its triangles whose middle is inside.
void expect_right_sets(const Rings& input) {
  for (const FillRule rule : {FillRule::even_odd, FillRule::winding}) {
    SCOPED_TRACE(static_cast<int>(rule));
    const ConstrainedTriangulation all =
        triangulator().polygons(input.view(), options_of(rule, Outside::keep));
    const ConstrainedTriangulation found = triangulator().polygons(input.view(), options_of(rule));
    ASSERT_EQ(all.triangle_offsets.size(), input.count() + 1);
    std::vector<std::int32_t> triangles;
    std::vector<std::size_t> offsets = {0};
    for (std::size_t p = 0; p < input.count(); ++p) {
      for (std::size_t t = all.triangle_offsets[p]; t < all.triangle_offsets[p + 1]; ++t) {
        const RationalPlace place = centroid(input.coordinates, &all.triangles[3 * t]);
        EXPECT_EQ(all.depths[t], input.depth(p, place, rule));
        if (!input.is_in(p, place, rule)) continue;
        triangles.insert(triangles.end(), &all.triangles[3 * t], &all.triangles[3 * t] + 3);
      }
      offsets.push_back(triangles.size() / 3);
    }
    EXPECT_EQ(found.triangles, triangles);
    EXPECT_EQ(found.triangle_offsets, offsets);
    EXPECT_EQ(found.neighbors, reference_neighbors(triangles));
    EXPECT_EQ(found.hull, all.hull);
    EXPECT_TRUE(found.polygons.empty());
  }
}

// Segments with rings are a map, too, and the verifier reads rings as the library does.
void expect_right_by_the_verifier(const Rings& input, FillRule rule, const ConstrainedTriangulation& all,
                                  const ConstrainedTriangulation& found) {
  const Segments segments = input.segments();
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  constraints.rings = {input.rings, input.parts(), input.polygons};
  ConstrainedOptions options;
  options.labels = true;
  options.fill_rule = rule;
  VerifyConstraints checked;
  checked.segments = &segments;
  checked.fill_rule = rule;
  checked.rings = &constraints.rings;
  for (const Outside outside : {Outside::keep, Outside::holes}) {
    const ConstrainedTriangulation& expected = outside == Outside::keep ? all : found;
    checked.outside = options.outside = outside;
    checked.depths = &expected.depths;
    const std::size_t points = input.coordinates.size() / 2;
    const ConstrainedTriangulation mesh =
        triangulator().constrained(input.coordinates.data(), points, constraints, options);
    EXPECT_EQ(mesh.triangles, expected.triangles);
    EXPECT_EQ(mesh.depths, expected.depths);
    EXPECT_TRUE(mesh.polygons.empty());
    const VerifyReport report = verify_constrained(input.coordinates.data(), points, expected.triangles,
                                                   &expected.neighbors, checked);
    EXPECT_TRUE(report.ok) << report.problem;
    if (expected.depths.empty()) continue;
    std::vector<std::int32_t> wrong = expected.depths;
    ++wrong.back();
    checked.depths = &wrong;
    EXPECT_FALSE(
        verify_constrained(input.coordinates.data(), points, expected.triangles, nullptr, checked).ok);
  }
}

// All in one map: each triangle is in the first polygon that its middle is in.
void expect_right_map(const Rings& input) {
  for (const FillRule rule : {FillRule::even_odd, FillRule::winding}) {
    SCOPED_TRACE(static_cast<int>(rule));
    const ConstrainedTriangulation all =
        triangulator().polygons(input.view(), options_of(rule, Outside::keep, true));
    const ConstrainedTriangulation found =
        triangulator().polygons(input.view(), options_of(rule, Outside::holes, true));
    std::vector<std::int32_t> triangles, polygons, depths;
    bool overlap = false;
    for (std::size_t t = 0; t < all.triangles.size() / 3; ++t) {
      const RationalPlace place = centroid(input.coordinates, &all.triangles[3 * t]);
      std::int32_t first = -1, count = 0;
      for (std::size_t p = 0; p < input.count(); ++p) {
        if (!input.is_in(p, place, rule)) continue;
        if (first < 0) first = static_cast<std::int32_t>(p);
        ++count;
      }
      EXPECT_EQ(all.polygons[t], first);
      EXPECT_EQ(all.depths[t], count);
      overlap |= count > 1;
      if (first < 0) continue;
      triangles.insert(triangles.end(), &all.triangles[3 * t], &all.triangles[3 * t] + 3);
      polygons.push_back(first);
      depths.push_back(count);
    }
    EXPECT_EQ(found.triangles, triangles);
    EXPECT_EQ(found.polygons, polygons);
    EXPECT_EQ(found.depths, depths);
    EXPECT_EQ(found.neighbors, reference_neighbors(triangles));
    EXPECT_EQ(found.triangle_offsets, (std::vector<std::size_t>{0, triangles.size() / 3}));
    if (input.has_parts) expect_right_by_the_verifier(input, rule, all, found);
    PolygonOptions strict = options_of(rule, Outside::holes, true);
    strict.overlaps = Overlaps::error;
    if (overlap) {
      EXPECT_THROW(triangulator().polygons(input.view(), strict), Error);
    } else {
      EXPECT_EQ(triangulator().polygons(input.view(), strict).triangles, triangles);
    }
  }
}

// Polygons of triangles of one triangulation as rings: inner edges are there twice, and polygons overlap.
Rings random_polygons(FixtureRandom& random, std::uint64_t round, int most) {
  const auto n = static_cast<std::size_t>(random.integer(3, 14));
  const Coordinates points = random_integer_points(n, static_cast<int>(random.integer(2, 7)), round);
  const Triangulation mesh = delaunay_of(points, {0, n});
  Rings rings;
  rings.has_parts = random.integer(0, 1) != 0;
  for (std::int64_t p = random.integer(0, most); p > 0; --p) {
    for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
      if (random.integer(0, 2) != 0) continue;
      Coordinates ring;
      const bool is_turned = random.integer(0, 1) != 0;
      const std::int64_t corners = random.integer(3, 4);
      for (std::int64_t k = 0; k < corners; ++k) {
        const std::int64_t at = is_turned ? 3 * corners - k : k;
        const auto v = static_cast<std::size_t>(mesh.triangles[3 * t + static_cast<std::size_t>(at % 3)]);
        // The fourth is the first one again.
        ring.insert(ring.end(), {points[2 * v], points[2 * v + 1]});
      }
      if (is_turned && corners == 4)
        ring = {ring[0], ring[1], ring[2], ring[3], ring[4], ring[5], ring[0], ring[1]};
      rings.add_ring(ring, random.integer(0, 1) != 0);
    }
    if (random.integer(0, 3) == 0) rings.add_ring({});
    if (random.integer(0, 3) == 0) rings.add_ring({points[0], points[1]});
    if (random.integer(0, 3) == 0) rings.add_ring({points[0], points[1], points[0], points[1]});
    rings.end_polygon();
  }
  return rings;
}

TEST(SmallPolygons, RandomSets) {
  FixtureRandom random(1);
  for (std::uint64_t round = 0; round < 60; ++round) {
    expect_right_sets(random_polygons(random, round, 6));
    if (HasFailure()) return;
  }
}

TEST(SmallPolygons, RandomMaps) {
  FixtureRandom random(2);
  for (std::uint64_t round = 0; round < 100; ++round) {
    expect_right_map(random_polygons(random, round, 4));
    if (HasFailure()) return;
  }
}

double area_of(const Rings& input, const ConstrainedTriangulation& mesh, std::int32_t polygon = -1) {
  double doubled = 0;
  for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
    if (polygon >= 0 && mesh.polygons[t] != polygon) continue;
    const double* p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = &input.coordinates[2 * static_cast<std::size_t>(mesh.triangles[3 * t + k])];
    }
    doubled += (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
  }
  return doubled / 2;
}

Coordinates square(double low, double high) { return {low, low, high, low, high, high, low, high}; }

TEST(SmallPolygons, Shapes) {
  const auto area = [](const Rings& input, const PolygonOptions& options) {
    return area_of(input, triangulator().polygons(input.view(), options));
  };
  // An island in a lake, whose rings have any direction.
  Rings lake;
  lake.add({square(0, 10), square(2, 8), square(4, 6)});
  EXPECT_EQ(area(lake, {}), 100 - 36 + 4);
  EXPECT_EQ(area(lake, options_of(FillRule::nesting)), 100 - 36 + 4);
  EXPECT_EQ(area(lake, options_of(FillRule::nesting, Outside::hull)), 100);
  EXPECT_EQ(area(lake, options_of(FillRule::winding)), 100);
  // A hole that goes the other way around.
  Rings turned;
  turned.add({square(0, 10), {2, 2, 2, 8, 8, 8, 8, 2}});
  EXPECT_EQ(area(turned, options_of(FillRule::winding)), 64);
  // Holes that touch each other and the outer ring at a point, and one with a common side.
  Rings touching;
  touching.add({square(0, 10), {5, 0, 6, 1, 5, 2, 4, 1}, {5, 2, 6, 3, 5, 4, 4, 3}, {0, 6, 2, 6, 2, 8, 0, 8}});
  EXPECT_EQ(area(touching, {}), 100 - 2 - 2 - 4);
  // A ring that touches itself at a point, and one that goes back along a segment.
  Rings itself;
  itself.add({{0, 0, 4, 0, 2, 2, 4, 4, 0, 4, 2, 2}});
  itself.add({{0, 0, 4, 0, 4, 4, 6, 4, 4, 4, 0, 4}});
  EXPECT_EQ(area(itself, {}), 8 + 16);
  // Twice the same ring: even-odd has nothing left, and around it is twice as often.
  Rings twice;
  twice.add({square(0, 4), square(0, 4)});
  EXPECT_EQ(area(twice, {}), 0);
  EXPECT_EQ(area(twice, options_of(FillRule::winding)), 16);
  // Rings without area.
  Rings flat;
  flat.add({{}, {1, 1}, {1, 1, 2, 2}, {0, 0, 1, 1, 2, 2, 3, 3}, {5, 5, 5, 5, 5, 5}});
  flat.add({});
  EXPECT_TRUE(triangulator().polygons(flat.view()).triangles.empty());
  EXPECT_EQ(triangulator().polygons(flat.view()).triangle_offsets, (std::vector<std::size_t>{0, 0, 0}));
  flat.add({square(0, 1), {0, 0, 1, 1}});
  EXPECT_EQ(area(flat, {}), 1);
  Rings none;
  EXPECT_EQ(triangulator().polygons(none.view()).triangle_offsets, (std::vector<std::size_t>{0}));
  EXPECT_EQ(triangulator()
                .polygons(none.view(), options_of(FillRule::even_odd, Outside::holes, true))
                .triangle_offsets,
            (std::vector<std::size_t>{0, 0}));
}

// Parts are what is inside of their border and of none of their holes, whatever the directions of rings.
TEST(SmallPolygons, PartsAndTheirHoles) {
  const auto turned = [](const Coordinates& ring) {
    Coordinates result;
    for (std::size_t i = ring.size(); i > 0; i -= 2) result.insert(result.end(), {ring[i - 2], ring[i - 1]});
    return result;
  };
  // Parts of polygons, and how large the polygon is.
  struct Polygon {
    std::vector<std::vector<Coordinates>> parts;
    double area;
  };
  const Coordinates large = square(0, 10), hole = square(2, 8), inner = square(4, 6), apart = square(20, 30);
  const Coordinates eight = {0, 0, 2, 2, 4, 0, 4, 4, 2, 2, 0, 4};
  const std::vector<Polygon> cases = {
      {{{large, hole}}, 64},          {{{large, hole, hole}}, 64},
      {{{large, hole, inner}}, 64},   {{{large, square(12, 14)}}, 100},
      {{{large, large}}, 0},          {{{large}, {hole}}, 100},
      {{{large, hole}, {inner}}, 68}, {{{large, square(22, 24)}, {apart}}, 200},
      {{{large}, {large}}, 100},      {{{eight}}, 8},
      {{{large, eight}}, 92},         {{{large, hole}, {square(2, 8), inner}}, 96},
  };
  for (std::size_t c = 0; c < cases.size(); ++c) {
    for (unsigned directions = 0; directions < 16; ++directions) {
      for (const FillRule rule : {FillRule::even_odd, FillRule::winding}) {
        for (const bool map : {false, true}) {
          Rings input;
          input.has_parts = true;
          unsigned ring = 0;
          for (const std::vector<Coordinates>& part : cases[c].parts) {
            bool is_border = true;
            for (const Coordinates& corners : part) {
              input.add_ring((directions >> ring++ & 1) != 0 ? turned(corners) : corners, is_border);
              is_border = false;
            }
          }
          input.end_polygon();
          const PolygonOptions options = options_of(rule, Outside::holes, map);
          const ConstrainedTriangulation mesh = triangulator().polygons(input.view(), options);
          EXPECT_EQ(area_of(input, mesh), cases[c].area) << c << ", directions " << directions;
          for (const std::int32_t depth : mesh.depths) EXPECT_EQ(depth, 1);
        }
      }
    }
  }
}

// Whether a place is so near to a segment that rounded crossings may have moved it to the other side.
bool is_near(const Rings& input, const Segments& segments, const RationalPlace& place) {
  for (std::size_t s = 0; s < segments.size(); s += 2) {
    const double* a = &input.coordinates[2 * static_cast<std::size_t>(segments[s])];
    const double* b = &input.coordinates[2 * static_cast<std::size_t>(segments[s + 1])];
    if (a[0] == b[0] && a[1] == b[1]) continue;
    const mpq_class area =
        (mpq_class(b[0]) - a[0]) * (place.y - a[1]) - (mpq_class(b[1]) - a[1]) * (place.x - a[0]);
    if (abs(area) < 1e-9) return true;
  }
  return false;
}

TEST(SmallPolygons, CrossingsThatAreSplit) {
  FixtureRandom random(4);
  std::size_t all = 0, checked = 0;
  for (int round = 0; round < 40; ++round) {
    Rings input;
    input.has_parts = random.integer(0, 1) != 0;
    for (std::int64_t p = random.integer(1, 3); p > 0; --p) {
      std::vector<Coordinates> rings;
      for (std::int64_t r = random.integer(1, 2); r > 0; --r) {
        rings.push_back(random_integer_points(static_cast<std::size_t>(random.integer(3, 7)), 9,
                                              static_cast<std::uint64_t>(100 * round + 10 * p + r)));
      }
      input.add(rings);
    }
    const Segments segments = input.segments();
    for (const bool map : {false, true}) {
      for (const FillRule rule : {FillRule::even_odd, FillRule::winding}) {
        PolygonOptions options = options_of(rule, Outside::keep, map);
        options.crossings = Crossings::split;
        const ConstrainedTriangulation mesh = triangulator().polygons(input.view(), options);
        Coordinates points = input.coordinates;
        points.insert(points.end(), mesh.added_points.begin(), mesh.added_points.end());
        for (std::size_t t = 0, set = 0; t < mesh.triangles.size() / 3; ++t) {
          while (mesh.triangle_offsets[set + 1] <= t) ++set;
          const RationalPlace place = centroid(points, &mesh.triangles[3 * t]);
          if (is_near(input, segments, place)) continue;
          ++checked;
          std::int32_t count = 0, first = -1;
          for (std::size_t p = input.count(); p-- > 0;) {
            if (!input.is_in(p, place, rule)) continue;
            first = static_cast<std::int32_t>(p);
            ++count;
          }
          if (map) {
            ASSERT_EQ(mesh.polygons[t], first);
            ASSERT_EQ(mesh.depths[t], count);
          } else {
            ASSERT_EQ(mesh.depths[t], input.depth(set, place, rule));
          }
        }
        all += mesh.triangles.size() / 3;
        options.outside = Outside::holes;
        const ConstrainedTriangulation left = triangulator().polygons(input.view(), options);
        const auto is_inside = [&](std::int32_t depth) { return depth != 0; };
        EXPECT_EQ(static_cast<std::ptrdiff_t>(left.triangles.size() / 3),
                  std::count_if(mesh.depths.begin(), mesh.depths.end(), is_inside));
        EXPECT_EQ(left.added_points, mesh.added_points);
      }
    }
  }
  EXPECT_GT(10 * checked, 8 * all);
}

TEST(SmallPolygons, SharedBordersOfMaps) {
  // Two squares side by side, of which one has a point more on the border; a third one lies in the first.
  Rings map;
  map.add({{0, 0, 4, 0, 4, 4, 0, 4}});
  map.add({{4, 0, 8, 0, 8, 4, 4, 4, 4, 1}});
  map.add({{1, 1, 2, 1, 2, 2, 1, 2}});
  PolygonOptions options = options_of(FillRule::even_odd, Outside::holes, true);
  ConstrainedTriangulation mesh = triangulator().polygons(map.view(), options);
  EXPECT_EQ(area_of(map, mesh, 0), 16);
  EXPECT_EQ(area_of(map, mesh, 1), 16);
  EXPECT_EQ(area_of(map, mesh), 32);
  // Over the common border triangles are neighbours.
  int across = 0;
  for (std::size_t c = 0; c < mesh.neighbors.size(); ++c) {
    across +=
        mesh.neighbors[c] >= 0 && mesh.polygons[c / 3] == 0 && mesh.polygons[mesh.neighbors[c]] == 1 ? 1 : 0;
  }
  EXPECT_EQ(across, 2);
  options.overlaps = Overlaps::error;
  try {
    triangulator().polygons(map.view(), options);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(std::string(error.what()).rfind("polygons 0 and 2 overlap, at the triangle of points ", 0), 0u)
        << error.what();
  }
  // As a hole of the first polygon it is no overlap.
  map.coordinates.insert(map.coordinates.begin() + 8, {1, 1, 2, 1, 2, 2, 1, 2});
  map.rings = {0, 4, 8, 13, 17};
  map.polygons = {0, 2, 3, 4};
  mesh = triangulator().polygons(map.view(), options);
  EXPECT_EQ(area_of(map, mesh, 0), 15);
  EXPECT_EQ(area_of(map, mesh, 2), 1);
}

TEST(SmallPolygons, Errors) {
  const auto message = [](const Rings& input, const PolygonOptions& options, ErrorKind kind) -> std::string {
    try {
      triangulator().polygons(input.view(), options);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind);
      return error.what();
    }
    return "no error";
  };
  Rings bow;
  bow.add({square(0, 1)});
  bow.add({{0, 0, 4, 4, 4, 0, 0, 4}});
  EXPECT_EQ(message(bow, {}, ErrorKind::input),
            "polygon 1: segments 4 (points 4 and 5) and 6 (points 6 and 7) cross near (2, 2)");
  Rings pair;
  pair.add({{0, 0, 4, 0, 4, 4, 0, 4}});
  pair.add({{2, 1, 6, 1, 6, 3, 2, 3}});
  EXPECT_EQ(message(pair, {}, ErrorKind::input), "no error");
  EXPECT_EQ(message(pair, options_of(FillRule::even_odd, Outside::holes, true), ErrorKind::input),
            "polygons 0 and 1: segments 1 (points 1 and 2) and 4 (points 4 and 5) cross near (4, 1)");
  EXPECT_EQ(message(pair, options_of(FillRule::nesting, Outside::holes, true), ErrorKind::usage),
            "the polygons of a map need the fill rule even-odd or winding");
  pair.has_parts = true;
  EXPECT_EQ(message(pair, options_of(FillRule::nesting), ErrorKind::input), "no error");
  pair.borders = {0};
  EXPECT_EQ(message(pair, {}, ErrorKind::usage), "a polygon does not begin with a part");
  pair.borders = {1};
  EXPECT_EQ(message(pair, {}, ErrorKind::usage),
            "the offsets of rings, parts and polygons must begin with 0 and not decrease");
  pair.borders = {0, 1, 2, 3};
  EXPECT_NE(message(pair, {}, ErrorKind::usage), "no error");
  pair.has_parts = false;
  pair.polygons.back() = 1;
  EXPECT_EQ(message(pair, {}, ErrorKind::usage),
            "the offsets of polygons do not end with the number of rings");
  pair.polygons = {};
  EXPECT_EQ(message(pair, {}, ErrorKind::usage),
            "polygons need offsets of rings and of polygons, which begin with 0");
  pair.polygons = {0, 2, 1, 2};
  EXPECT_NE(message(pair, {}, ErrorKind::usage), "no error");
}

// Options that change which arrays there are.
TEST(SmallPolygons, Arrays) {
  Rings input;
  input.add({square(0, 10), square(2, 8)});
  PolygonOptions options;
  ConstrainedTriangulation mesh = triangulator().polygons(input.view(), options);
  EXPECT_TRUE(mesh.depths.empty() && mesh.regions.empty() && mesh.halfedges.empty());
  EXPECT_EQ(mesh.neighbors.size(), mesh.triangles.size());
  EXPECT_EQ(mesh.constrained.size(), mesh.triangles.size());
  EXPECT_EQ(mesh.statistics.triangles, mesh.triangles.size() / 3);
  options.neighbors = false;
  options.halfedges = true;
  mesh = triangulator().polygons(input.view(), options);
  EXPECT_TRUE(mesh.neighbors.empty());
  ASSERT_EQ(mesh.halfedges.size(), mesh.triangles.size());
  for (std::size_t h = 0; h < mesh.halfedges.size(); ++h) {
    const std::int32_t twin = mesh.halfedges[h];
    if (twin >= 0) {
      EXPECT_EQ(mesh.halfedges[twin], static_cast<std::int32_t>(h));
    }
  }
}

// Many polygons in one call are what each of them is on its own.
TEST(Polygons, ManyAreAsEach) {
  FixtureRandom random(3);
  Rings all;
  std::vector<Rings> each;
  for (int p = 0; p < 300; ++p) {
    Rings one;
    std::vector<Coordinates> rings;
    const std::int64_t corners = random.integer(3, 60);
    for (const double size : {2.0, 0.9}) {
      Coordinates ring;
      for (std::int64_t i = 0; i < corners; ++i) {
        const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(corners);
        const double radius = size * (1 + random.unit());
        ring.insert(ring.end(), {radius * std::cos(angle) + p, radius * std::sin(angle)});
      }
      rings.push_back(ring);
    }
    // Not if they cross.
    one.add(rings);
    try {
      triangulator().polygons(one.view());
    } catch (const Error&) {
      continue;
    }
    all.add(rings);
    each.push_back(one);
  }
  ASSERT_GT(each.size(), 50u);
  const ConstrainedTriangulation mesh = triangulator().polygons(all.view(), options_of(FillRule::even_odd));
  std::size_t t = 0;
  std::int32_t regions = 0, point = 0;
  for (std::size_t p = 0; p < each.size(); ++p) {
    const ConstrainedTriangulation own =
        triangulator().polygons(each[p].view(), options_of(FillRule::even_odd));
    ASSERT_EQ(mesh.triangle_offsets[p], t);
    for (std::size_t i = 0; i < own.triangles.size() / 3; ++i, ++t) {
      Row row = row_at(own.triangles, i);
      for (std::int32_t& v : row) v += point;
      ASSERT_EQ(row_at(mesh.triangles, t), row);
      ASSERT_EQ(mesh.regions[t], own.regions[i] + regions);
    }
    if (!own.regions.empty()) regions += 1 + *std::max_element(own.regions.begin(), own.regions.end());
    point += static_cast<std::int32_t>(each[p].coordinates.size() / 2);
  }
  EXPECT_EQ(mesh.triangles.size() / 3, t);
}

}  // namespace
}  // namespace flaunay::testing
