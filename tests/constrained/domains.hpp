// What is inside of closed curves, by its definition, in rational numbers.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/constrained/check.hpp"
#include "tests/constrained/native.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing {

/// The constrained triangulation with everything that domains need, of one or several sets.
inline ConstrainedTriangulation constrained_of(const Coordinates& points,
                                               const std::vector<std::size_t>& offsets,
                                               const Segments& segments) {
  return insert(points, offsets, delaunay_of(points, offsets), segments);
}

struct RationalPlace {
  mpq_class x, y;
};

inline RationalPlace centroid(const Coordinates& points, const std::int32_t* triangle) {
  RationalPlace sum;
  for (int k = 0; k < 3; ++k) {
    sum.x += mpq_class(points[2 * static_cast<std::size_t>(triangle[k])]);
    sum.y += mpq_class(points[2 * static_cast<std::size_t>(triangle[k]) + 1]);
  }
  return {sum.x / 3, sum.y / 3};
}

/// How the segments [first, last) go around a place on none of them.
struct Around {
  int winding = 0;
  int crossings = 0;  ///< of a ray from the place to the right
};

inline Around around(const Coordinates& points, const Segments& segments, std::size_t first, std::size_t last,
                     const RationalPlace& place) {
  Around found;
  for (std::size_t s = first; s < last; ++s) {
    const double* a = &points[2 * static_cast<std::size_t>(segments[2 * s])];
    const double* b = &points[2 * static_cast<std::size_t>(segments[2 * s + 1])];
    const bool is_below = a[1] <= place.y, ends_below = b[1] <= place.y;
    if (is_below == ends_below) continue;
    const mpq_class area =
        (mpq_class(b[0]) - a[0]) * (place.y - a[1]) - (mpq_class(b[1]) - a[1]) * (place.x - a[0]);
    // To the left of a segment that goes up, or to the right of one that goes down.
    if (is_below ? area > 0 : area < 0) {
      found.winding += is_below ? 1 : -1;
      ++found.crossings;
    }
  }
  return found;
}

/// Closed curves along the edges of a triangulation: the borders of some of its triangles, in any direction,
/// some of them several times.
inline Segments random_curves(const Triangulation& mesh, FixtureRandom& random, int one_in) {
  Segments curves;
  for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
    if (random.integer(1, one_in) > 1) continue;
    const bool is_turned = random.integer(0, 1) != 0;
    for (std::int64_t times = random.integer(0, 5) == 0 ? 2 : 1; times > 0; --times) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t a = mesh.triangles[3 * t + k], b = mesh.triangles[3 * t + (k + 1) % 3];
        curves.insert(curves.end(), {is_turned ? b : a, is_turned ? a : b});
      }
    }
  }
  return curves;
}

}  // namespace flaunay::testing
