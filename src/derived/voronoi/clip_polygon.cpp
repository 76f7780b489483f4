#include "derived/voronoi/clip_polygon.hpp"

#include <fmt/format.h>

#include "arithmetic/records.h"
#include "geometry/arguments.hpp"
#include "geometry/predicates.hpp"
#include "points/codes.h"
#include "voronoi/codes.h"

namespace flaunay::voronoi {

using geometry::Magnitudes;
using geometry::Point;
using geometry::operator==;

namespace {

template <typename... Arguments>
Error bad(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  return Error(ErrorKind::input,
               "the clip polygon " + fmt::format(text, std::forward<Arguments>(arguments)...));
}

std::vector<Point> scaled_corners(const double* corners, std::size_t count,
                                  const geometry::Scaling& scaling) {
  std::vector<Point> scaled;
  scaled.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    scaled.push_back(kernel::scaled_point(static_cast<int>(i), corners, scaling.powers()));
  }
  return scaled;
}

// Whether the polygon turns left at corner b, between a and c; not so if it goes straight on.
bool turns_left(const geometry::Predicates& predicates, Point a, Point b, Point c, std::size_t i) {
  if (b == c) throw bad("has corner {} twice in a row", i);
  const int turn = predicates.orient(a, b, c);
  if (turn < 0) throw bad("turns right at corner {}: it must be convex and counter-clockwise", i);
  if (turn == 0 && kernel::comes_before(a, b) != kernel::comes_before(b, c)) {
    throw bad("goes back at corner {}: it must be convex", i);
  }
  return turn > 0;
}

}  // namespace

ClipPolygon checked_polygon(const double* corners, std::size_t count) {
  check_array(corners, count, "corners of the clip polygon");
  if (count < 3) throw bad("has {} corners, and needs three", count);
  if (count > kernel::STRICTLY_INSIDE) {
    throw bad("has {} corners; corner {} is one too many", count, kernel::STRICTLY_INSIDE);
  }
  ClipPolygon polygon;
  polygon.magnitudes = geometry::inspect(corners, 0, count);
  if (polygon.magnitudes.bad != kernel::NO_BAD) {
    const auto i = static_cast<std::size_t>(polygon.magnitudes.bad);
    throw bad("is not finite at corner {}: ({}, {})", i, corners[2 * i], corners[2 * i + 1]);
  }
  polygon.corners.assign(corners, corners + 2 * count);
  const geometry::Scaling scaling = scaling_with(polygon, {});
  polygon.corners.clear();
  const geometry::Predicates predicates{scaling.bounds};
  const std::vector<Point> at = scaled_corners(corners, count, scaling);
  bool has_begun = false;
  for (std::size_t i = 0; i < count; ++i) {
    const Point before = at[(i + count - 1) % count], next = at[(i + 1) % count];
    if (turns_left(predicates, before, at[i], next, i)) {
      polygon.corners.insert(polygon.corners.end(), {corners[2 * i] + 0.0, corners[2 * i + 1] + 0.0});
    }
    // Around a convex polygon, once, there is one corner that comes before both neighbours.
    if (kernel::comes_before(at[i], before) && kernel::comes_before(at[i], next)) {
      if (has_begun) throw bad("goes around more than once, by corner {}: it must be convex", i);
      has_begun = true;
    }
  }
  return polygon;
}

geometry::Scaling scaling_with(const ClipPolygon& polygon, const Magnitudes& points) {
  const Magnitudes both = geometry::joined(polygon.magnitudes, points);
  if (!geometry::differ_too_much(both)) return geometry::scaling_for(both);
  const geometry::RangeEnds ends =
      geometry::find_ends(polygon.corners.data(), 0, polygon.size(), polygon.magnitudes);
  const bool is_fine =
      points.lowest - polygon.magnitudes.lowest > polygon.magnitudes.largest - points.largest;
  const geometry::NamedCoordinate& named = is_fine ? ends.finest : ends.largest;
  throw bad(
      "is too {} to be exact at its corner with {} = {:.17g}: the bits of points and corners together "
      "span {} binary places, {} are supported",
      is_fine ? "fine" : "large", named.is_y ? "y" : "x", named.value, geometry::bits_of(both),
      kernel::MOST_BITS);
}

}  // namespace flaunay::voronoi
