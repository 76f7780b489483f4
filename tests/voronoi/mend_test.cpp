// Rounded polygons of cells that were mended: sets for themselves, and tiling. python/tests/test_cells.py has
// their validity by GEOS.
#include "derived/voronoi/mend.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/same.hpp"
#include "tests/support/shared_triangulator.hpp"
#include "voronoi/plain_polygon.h"

namespace flaunay::voronoi {
namespace {

using testing::Coordinates;
using testing::FixtureRandom;
using testing::same;

Coordinates turned(const Coordinates& points, double angle) {
  Coordinates result;
  for (std::size_t i = 0; i < points.size(); i += 2) {
    result.push_back(std::cos(angle) * points[i] - std::sin(angle) * points[i + 1]);
    result.push_back(std::sin(angle) * points[i] + std::cos(angle) * points[i + 1]);
  }
  return result;
}

Coordinates ring(std::size_t n, double radius, double x, double y) {
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(n);
    points.insert(points.end(), {radius * std::cos(angle) + x, radius * std::sin(angle) + y});
  }
  return points;
}

/// Sets of points at the same places, of a turned lattice and of a ring: most have not all of them. One has
/// larger coordinates.
struct Sets {
  Coordinates points;
  std::vector<std::size_t> offsets{0};

  Sets() {
    Coordinates lattice;
    for (int i = 0; i < 49; ++i) lattice.insert(lattice.end(), {i / 7 / 8.0 + 0.1, i % 7 / 8.0 - 0.2});
    Coordinates places = turned(lattice, 0.3);
    const Coordinates circle = ring(30, 0.25, 0.5, 0.5);
    places.insert(places.end(), circle.begin(), circle.end());
    FixtureRandom random(1);
    for (int s = 0; s < 12; ++s) {
      for (std::size_t i = 0; i < places.size(); i += 2) {
        if (s == 0 || random.integer(0, 3) > 0) points.insert(points.end(), {places[i], places[i + 1]});
      }
      if (s == 5) points.insert(points.end(), {1e5, -1e6, 1e5, 1e6, -1e6, 1});
      offsets.push_back(points.size() / 2);
    }
  }
};

Coordinates part(const Coordinates& values, std::size_t first, std::size_t end) {
  return {values.begin() + static_cast<std::ptrdiff_t>(2 * first),
          values.begin() + static_cast<std::ptrdiff_t>(2 * end)};
}

void expect_same_cells(const ClippedVoronoi& all, std::size_t first, std::size_t end,
                       const ClippedVoronoi& alone) {
  const auto at = [&](std::size_t i) { return static_cast<std::size_t>(all.offsets[i]); };
  EXPECT_TRUE(same(part(all.vertices, at(first), at(end)), alone.vertices));
  for (std::size_t i = first; i <= end; ++i)
    EXPECT_EQ(all.offsets[i] - all.offsets[first], alone.offsets[i - first]);
}

TEST(SmallMend, PolygonsThatGoAroundTwiceAreNotPlain) {
  for (const int rounds : {1, 2}) {
    std::vector<double> corners;
    for (int k = 0; k < 5; ++k) {
      const double angle = 2 * M_PI * k * rounds / 5;
      corners.insert(corners.end(), {std::cos(angle), std::sin(angle)});
    }
    EXPECT_EQ(kernel::is_plain_polygon(kernel::double2{0, 0}, 0, 5, corners.data()), rounds == 1 ? 1 : 0);
  }
}

TEST(SmallMend, ASetDependsOnNoOther) {
  const Sets sets;
  const Coordinates box = {-1, -1, 2, -1, 2, 2, -1, 2};
  const Period period{1, 1};
  Triangulator& triangulator = testing::triangulator();
  const Triangulation mesh = triangulator.triangulate(sets.points.data(), sets.offsets);
  const std::size_t n = sets.offsets.back();
  const ClippedVoronoi cells = triangulator.clipped_voronoi(sets.points.data(), n, mesh, box.data(), 4);
  const Voronoi dual = triangulator.voronoi(sets.points.data(), n, mesh);
  const ClippedVoronoi torus = triangulator.clipped_voronoi(
      triangulator.triangulate(sets.points.data(), sets.offsets, Space::torus(period)));
  for (std::size_t s = 0; s + 1 < sets.offsets.size(); ++s) {
    SCOPED_TRACE(s);
    const std::size_t first = sets.offsets[s], end = sets.offsets[s + 1];
    const Coordinates points = part(sets.points, first, end);
    const Triangulation own = triangulator.triangulate(points.data(), end - first);
    expect_same_cells(cells, first, end,
                      triangulator.clipped_voronoi(points.data(), end - first, own, box.data(), 4));
    EXPECT_TRUE(same(part(dual.circumcentres, mesh.triangle_offsets[s], mesh.triangle_offsets[s + 1]),
                     triangulator.voronoi(points.data(), end - first, own).circumcentres));
    expect_same_cells(torus, first, end,
                      triangulator.clipped_voronoi(
                          triangulator.triangulate(points.data(), end - first, Space::torus(period))));
  }
}

/// Each edge of a cell is one of another, in the opposite direction, or on the box.
void expect_tiling(const ClippedVoronoi& cells, double x0, double y0, double x1, double y1) {
  std::map<std::array<double, 4>, int> edges;
  for (std::size_t i = 0; i + 1 < cells.offsets.size(); ++i) {
    const std::int32_t begin = cells.offsets[i], end = cells.offsets[i + 1];
    EXPECT_LT(begin, end) << "cell " << i << " is empty";
    for (std::int32_t k = begin; k < end; ++k) {
      const double* const a = &cells.vertices[2 * static_cast<std::size_t>(k)];
      const double* const b = &cells.vertices[2 * static_cast<std::size_t>(k + 1 < end ? k + 1 : begin)];
      ++edges[{a[0], a[1], b[0], b[1]}];
      --edges[{b[0], b[1], a[0], a[1]}];
    }
  }
  for (const auto& [edge, count] : edges) {
    const auto [ax, ay, bx, by] = edge;
    if (count == 0 || (ax == bx && (ax == x0 || ax == x1)) || (ay == by && (ay == y0 || ay == y1))) continue;
    ADD_FAILURE() << "an edge from (" << ax << ", " << ay << ") to (" << bx << ", " << by
                  << ") of one cell alone";
  }
}

// Cells that are long and thin, whose corners nearly coincide, and of which none may be lost.
TEST(Mend, RingsFarFromTheOriginAreCovered) {
  for (const auto& [count, radius, x, y] :
       {std::array<double, 4>{30, 0.01, -1.8e9, 9.5e9}, std::array<double, 4>{300, 1, -1.8e9, 9.5e9},
        std::array<double, 4>{1000, 0.01, 5e5, 5e6}, std::array<double, 4>{3000, 1, 1e7, 1e7}}) {
    SCOPED_TRACE(count);
    const auto n = static_cast<std::size_t>(count);
    const Coordinates points = ring(n, radius, x, y);
    const double x0 = x - 2 * radius, y0 = y - 2 * radius, x1 = x + 2 * radius, y1 = y + 2 * radius;
    const Coordinates box = {x0, y0, x1, y0, x1, y1, x0, y1};
    Triangulator& triangulator = testing::triangulator();
    const ClippedVoronoi cells = triangulator.clipped_voronoi(
        points.data(), n, triangulator.triangulate(points.data(), n), box.data(), 4);
    expect_tiling(cells, x0, y0, x1, y1);
  }
}

}  // namespace
}  // namespace flaunay::voronoi
