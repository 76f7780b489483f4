#include "derived/sphere/places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "geometry/sort.hpp"
#include "sphere/places.h"

namespace flaunay::sphere {
namespace {

bool is_wrong(const double* p, SphereCoordinates coordinates) {
  return coordinates == SphereCoordinates::degrees ? kernel::are_no_degrees(p[0], p[1])
                                                   : kernel::is_no_direction(p[0], p[1], p[2]);
}

}  // namespace

Direction direction_of(Point place) {
  if (is_pole(place)) return {0, 0, -1};
  const double square = place.x * place.x + place.y * place.y, factor = 2 / (1 + square);
  return {place.x * factor, place.y * factor, (1 - square) / (1 + square)};
}

void refuse(const double* p, std::size_t i, SphereCoordinates coordinates, const char* what) {
  if (!std::all_of(p, p + width_of(coordinates), [](double x) { return std::isfinite(x); })) {
    throw Error(ErrorKind::input, fmt::format("{} {} is not finite", what, i));
  }
  if (coordinates == SphereCoordinates::degrees) {
    throw Error(ErrorKind::input,
                fmt::format("{} {}: the latitude {} is not between -90 and 90", what, i, p[1]));
  }
  throw Error(ErrorKind::input, fmt::format("{} {} is the vector 0, which has no direction", what, i));
}

std::vector<double> to_places(host::Runtime& runtime, const double* points, std::size_t n,
                              SphereCoordinates coordinates, const char* what) {
  std::vector<double> places;
  runtime.resize(places, 2 * n);
  const std::size_t width = width_of(coordinates);
  for_each(runtime, n, [&](std::size_t i) {
    const double* const p = points + width * i;
    if (is_wrong(p, coordinates)) refuse(p, i, coordinates, what);
    const Point place = coordinates == SphereCoordinates::directions
                            ? kernel::place_of_direction(p[0], p[1], p[2])
                            : kernel::place_of_degrees(p[0], p[1]);
    places[2 * i] = place.x;
    places[2 * i + 1] = place.y;
  });
  return places;
}

std::vector<std::int32_t> order_along_curve(host::Runtime& runtime, const std::vector<double>& places) {
  // The lower half of the octahedron is folded out over the corners of the upper one's square.
  std::vector<Point> unfolded(places.size() / 2);
  for_each(runtime, unfolded.size(), [&](std::size_t i) {
    const Direction d = direction_of(place_at(places, i));
    const double length = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
    const double x = d.x / length, y = d.y / length;
    unfolded[i] = d.z >= 0 ? Point{x, y}
                           : Point{std::copysign(1 - std::fabs(y), x), std::copysign(1 - std::fabs(x), y)};
  });
  std::vector<std::int32_t> order(unfolded.size());
  std::iota(order.begin(), order.end(), 0);
  geometry::sort_by_place(order, [&](std::int32_t i) { return unfolded[static_cast<std::size_t>(i)]; });
  return order;
}

}  // namespace flaunay::sphere
