// Voronoi diagrams against twins in exact arithmetic.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include "derived/voronoi/voronoi.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/locate/support.hpp"

namespace flaunay::locate {

Voronoi dual(Runtime& runtime, const Case& input) {
  Arena::Scope scope(runtime.arena());
  const std::size_t n = input.size(), triangles = input.mesh.triangles.size() / 3;
  const voronoi::Buffers result{guarded<cl_double>(runtime, 2 * triangles), guarded<cl_int>(runtime, n + 1),
                                guarded<cl_int>(runtime, 3 * triangles), guarded<cl_uchar>(runtime, n)};
  voronoi::compute(runtime, upload_mesh(runtime, input), result);
  return {download(runtime, result.circumcentres, 2 * triangles),
          download(runtime, result.cell_offsets, n + 1), download(runtime, result.cells, 3 * triangles),
          download(runtime, result.unbounded, n)};
}

namespace {

/// The triangles around each vertex, by looking at all of them.
void check_cells(const Case& input, const Voronoi& found) {
  std::vector<cl_int> offsets{0}, cells;
  const auto& triangles = input.mesh.triangles;
  std::map<std::int32_t, std::vector<std::size_t>> corners;
  for (std::size_t c = 0; c < triangles.size(); ++c) corners[triangles[c]].push_back(c);
  for (std::size_t i = 0; i < input.size(); ++i) {
    const std::vector<std::size_t>& around = corners[static_cast<std::int32_t>(i)];
    if (!around.empty()) {
      std::size_t c = around.front();
      for (const std::size_t other : around) {
        // The edge that leaves the point is opposite to the corner before.
        if (input.mesh.neighbors[other / 3 * 3 + (other + 2) % 3] < 0) c = other;
      }
      for (std::size_t steps = 0; steps < around.size(); ++steps) {
        const std::size_t t = c / 3;
        cells.push_back(static_cast<cl_int>(t));
        const std::int32_t before = triangles[3 * t + (c % 3 + 2) % 3];
        for (const std::size_t other : around) {
          if (triangles[other / 3 * 3 + (other % 3 + 1) % 3] == before) c = other;
        }
      }
    }
    offsets.push_back(static_cast<cl_int>(cells.size()));
  }
  EXPECT_TRUE(same(found.cell_offsets, offsets));
  EXPECT_TRUE(same(found.cells, cells));
  std::vector<std::uint8_t> unbounded(input.size(), 0);
  for (const std::int32_t v : input.mesh.hull) unbounded[static_cast<std::size_t>(v)] = 1;
  EXPECT_TRUE(same(found.unbounded, unbounded));
}

/// The exact centre, relative to a.
std::pair<mpq_class, mpq_class> centre_twin(const double* a, const double* b, const double* c) {
  const mpq_class bx = mpq_class(b[0]) - mpq_class(a[0]), by = mpq_class(b[1]) - mpq_class(a[1]);
  const mpq_class cx = mpq_class(c[0]) - mpq_class(a[0]), cy = mpq_class(c[1]) - mpq_class(a[1]);
  const mpq_class whole = 2 * (bx * cy - by * cx), bb = bx * bx + by * by, cc = cx * cx + cy * cy;
  return {(cy * bb - by * cc) / whole, (bx * cc - cx * bb) / whole};
}

void check_circumcentres(const Case& input, const std::vector<double>& centres) {
  // Centres that are so far away that cells there are thinner than rounding may be joined to others. Half of
  // the extent, which may be too large for a double.
  double reach = 0;
  for (std::size_t i = 0; i < input.points.size(); ++i)
    reach = std::max(reach, std::fabs(input.points[i] / 2 - input.points[i % 2] / 2));
  for (std::size_t t = 0; t < input.mesh.triangles.size() / 3; ++t) {
    const double* const a = input.point(input.corner(t, 0));
    const auto [x, y] = centre_twin(a, input.point(input.corner(t, 1)), input.point(input.corner(t, 2)));
    const mpq_class expected[2] = {x + mpq_class(a[0]), y + mpq_class(a[1])};
    const mpq_class radius = abs(x) + abs(y);
    for (std::size_t k = 0; k < 2; ++k) {
      const mpq_class allowed =
          radius * mpq_class(0x1p-36) + (abs(expected[k]) + abs(mpq_class(a[k]))) * mpq_class(0x1p-50);
      // Too far for a double.
      if (abs(expected[k]) > mpq_class(0x1p1022)) continue;
      ASSERT_TRUE(std::isfinite(centres[2 * t + k])) << t;
      if (radius > mpq_class(reach) * mpq_class(0x1p31)) continue;
      ASSERT_LE(abs(mpq_class(centres[2 * t + k]) - expected[k]), allowed + mpq_class(0x1p-1070)) << t;
    }
  }
}

void check_dual(const Case& input, const std::vector<std::string>& names = tunings()) {
  std::unique_ptr<Voronoi> first;
  for (const std::string& name : names) {
    SCOPED_TRACE("tuning " + name);
    const Voronoi found = dual(Runtimes::get(name), input);
    check_cells(input, found);
    if (first) {
      EXPECT_TRUE(same(found.circumcentres, first->circumcentres));
    } else {
      check_circumcentres(input, found.circumcentres);
      first = std::make_unique<Voronoi>(found);
    }
  }
}

TEST(SmallVoronoi, NestedSets) {
  const Case input = nested_case(9, 2);
  check_dual(input);
}

TEST(SmallVoronoi, ASetWithATree) {
  const Case input = make_case(make_fixture("uniform", 300, 6), 3, 7);
  check_dual(input);
}

TEST(SmallVoronoi, Grid) {
  const Case input = make_case(make_fixture("grid", 25, 8), 8, 9);
  check_dual(input);
}

TEST(SmallVoronoi, NothingAtAll) {
  for (const Offsets& offsets : {Offsets{0}, Offsets{0, 0}, Offsets{0, 0, 0}}) {
    Case input;
    input.offsets = input.query_offsets = offsets;
    input.triangulate();
    check_dual(input);
  }
}

TEST(Voronoi, EveryFixture) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Case input = make_case(fixture.make(330, 11), 30, 12);
    check_dual(input);
  }
}

TEST(Voronoi, ManySets) {
  const Case input = nested_case(100, 12);
  check_dual(input);
}

/// Cocircular triangles have the same centre, to the last bit.
TEST(Voronoi, CellsOfAGrid) {
  Case input;
  Coordinates points;
  for (int x = 0; x < 7; ++x) {
    for (int y = 0; y < 7; ++y) points.insert(points.end(), {x * 1.0, y * 1.0});
  }
  input.add(points, {});
  input.triangulate();
  const Voronoi found = dual(Runtimes::get("own"), input);
  for (const double c : found.circumcentres) EXPECT_EQ(c - std::floor(c), 0.5);
}

/// Magnitudes of all kinds.
TEST(Voronoi, Magnitudes) {
  const Coordinates points = make_fixture("uniform", 60, 13);
  for (const double factor : {0x1p960, 0x1p-900, 0x1p300, 0x1p-300, 1.0}) {
    SCOPED_TRACE(factor);
    check_dual(make_case(testing::scaled(points, factor), 6, 14));
  }
  Coordinates overflowing = points;
  for (double& c : overflowing) c = (c - 0.5) * 0x1.fp1023 * 2;
  check_dual(make_case(overflowing, 0, 15));
}

/// No scaling is right for all sets.
TEST(Voronoi, SetsOfEveryScale) {
  Case input;
  for (const double factor : {0x1p960, 0x1p-900, 1.0, 0x1p-300}) {
    input.add(testing::scaled(make_fixture("uniform", 40, 16), factor), {});
    input.add(testing::scaled(make_fixture("integer-circle", 40, 17), factor), {});
  }
  input.triangulate();
  check_dual(input);
}

/// Points at wrong places: cells mean nothing, but there are some.
TEST(SmallVoronoi, WalksEndWhateverThePoints) {
  Case input = make_case(make_fixture("uniform", 80, 18), 0, 19);
  FixtureRandom random(20);
  for (double& c : input.points) c = random.unit();
  dual(Runtimes::get("own"), input);
}

/// A vertex that all triangles have, in a row order that is the worst for walks: from the middle to both
/// sides.
TEST(Voronoi, AFan) {
  Case input;
  Coordinates points{0, -1000};
  for (int i = 0; i < 400; ++i) points.insert(points.end(), {i - 200.0, 0.0});
  input.add(points, {});
  input.triangulate();
  check_dual(input);
}

/// Numbers that are no triangulation at all: cells mean nothing, but they are disjoint parts of their array.
/// (A vertex that has several cells then gets any of them.)
TEST(Voronoi, CellsFitWhateverTheMesh) {
  FixtureRandom random(21);
  for (int round = 0; round < 30; ++round) {
    Case input = make_case(make_fixture("uniform", 40, 22), 0, 23);
    const auto corners = static_cast<std::int64_t>(input.mesh.triangles.size());
    // From a few wrong numbers to nothing but such.
    const std::int64_t rarely = random.integer(0, 60);
    for (auto* const values : {&input.mesh.triangles, &input.mesh.neighbors}) {
      for (std::int32_t& value : *values) {
        if (random.integer(0, rarely) == 0)
          value = static_cast<std::int32_t>(random.integer(-2, corners / 3));
      }
    }
    for (const std::string& name : tunings()) {
      const Voronoi found = dual(Runtimes::get(name), input);
      EXPECT_EQ(found.cell_offsets.front(), 0);
      EXPECT_TRUE(std::is_sorted(found.cell_offsets.begin(), found.cell_offsets.end()));
      EXPECT_LE(found.cell_offsets.back(), corners);
      for (std::int32_t i = 0; i < found.cell_offsets.back(); ++i) {
        const std::int32_t cell = found.cells[static_cast<std::size_t>(i)];
        EXPECT_TRUE(0 <= cell && cell < corners / 3) << cell;
      }
    }
  }
}

}  // namespace

}  // namespace flaunay::locate
