#include "derived/sphere/places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "arithmetic/exact_arithmetic.h"
#include "geometry/sort.hpp"

namespace flaunay::sphere {
namespace {

// Doubles from here on are multiples of the finest place. Smaller numbers are rounded to multiples of twice
// that by adding and subtracting 3 of these.
constexpr double kFine = 1.0 / (1 << 13);
static_assert(kFinestExponent == -13 - 52);

double rounded(double x) {
  return std::fabs(x) >= kFine ? x : (x + 3 * kFine) - 3 * kFine + 0.0;  // no -0
}

Point rounded_place(double x, double y) {
  const double most = std::ldexp(1.0, kLargestExponent);
  // Also if they are not finite.
  if (!(std::fabs(x) < most && std::fabs(y) < most)) return pole();
  return {rounded(x), rounded(y)};
}

// Of a vector whose squares neither overflow nor vanish.
Point place_of_vector(double x, double y, double z) {
  const double across = x * x + y * y, length = std::sqrt(across + z * z);
  // In the south without a difference of nearly equal numbers. Without a branch, as half of all points are
  // there.
  const double above = z >= 0 ? 1 : length - z, below = z >= 0 ? length + z : across;
  const double factor = above / below;
  return rounded_place(x * factor, y * factor);
}

Point place_of_direction(const double* p) {
  const double most = std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
  if (most > 0x1p-200 && most < 0x1p200) return place_of_vector(p[0], p[1], p[2]);
  const int exponent = -std::ilogb(most);
  return place_of_vector(std::ldexp(p[0], exponent), std::ldexp(p[1], exponent), std::ldexp(p[2], exponent));
}

struct Turn {
  double sine, cosine;
};

// Of an angle of at most 45 degrees, with errors of about an ulp: Taylor's series of the rounded number of
// radians, and what was rounded away.
Turn small_turn(double degrees) {
  constexpr double kHigh = 0x1.1df46a2529d39p-6, kLow = 0x1.5c1d8becdd291p-62;  // pi / 180
  constexpr int kTerms = 9;
  const kernel::double2 radians = kernel::two_product(degrees, kHigh);
  const double x = radians.x, tail = radians.y + degrees * kLow, square = x * x;
  double sine = 0, cosine = 0;  // what is missing from 1, relative to the first term
  for (int k = 2 * kTerms; k > 0; k -= 2) {
    sine = (1 - sine) * square / (k * (k + 1.0));
    cosine = (1 - cosine) * square / (k * (k - 1.0));
  }
  sine = x - x * sine;
  cosine = 1 - cosine;
  return {sine + tail * cosine, cosine - tail * sine};
}

// Of any angle; exact at multiples of 90 degrees.
Turn turn_of(double degrees) {
  const double turned = std::remainder(degrees, 360.0);
  const double quarters = std::nearbyint(turned / 90);  // -2 to 2
  const Turn rest = small_turn(turned - 90 * quarters);
  switch (static_cast<int>(quarters) & 3) {
    case 0:
      return rest;
    case 1:
      return {rest.cosine, -rest.sine};
    case 2:
      return {-rest.sine, -rest.cosine};
    default:
      return {-rest.cosine, rest.sine};
  }
}

Point place_of_degrees(const double* p) {
  const Turn longitude = turn_of(p[0]), latitude = turn_of(p[1]);
  const double radius =
      p[1] >= 0 ? latitude.cosine / (1 + latitude.sine) : (1 - latitude.sine) / latitude.cosine;
  return rounded_place(radius * longitude.cosine, radius * longitude.sine);
}

// Whether a point is none.
bool is_wrong(const double* p, SphereCoordinates coordinates) {
  if (coordinates == SphereCoordinates::degrees) return !(std::isfinite(p[0]) && std::fabs(p[1]) <= 90);
  const bool is_zero = p[0] == 0 && p[1] == 0 && p[2] == 0;
  return is_zero || !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
}

[[noreturn]] void refuse(const double* p, std::size_t i, SphereCoordinates coordinates, const char* what) {
  if (!std::all_of(p, p + width_of(coordinates), [](double x) { return std::isfinite(x); })) {
    throw Error(ErrorKind::input, fmt::format("{} {} is not finite", what, i));
  }
  if (coordinates == SphereCoordinates::degrees) {
    throw Error(ErrorKind::input,
                fmt::format("{} {}: the latitude {} is not between -90 and 90", what, i, p[1]));
  }
  throw Error(ErrorKind::input, fmt::format("{} {} is the vector 0, which has no direction", what, i));
}

}  // namespace

Direction direction_of(Point place) {
  if (is_pole(place)) return {0, 0, -1};
  const double square = place.x * place.x + place.y * place.y, factor = 2 / (1 + square);
  return {place.x * factor, place.y * factor, (1 - square) / (1 + square)};
}

std::vector<double> to_places(host::Runtime& runtime, const double* points, std::size_t n,
                              SphereCoordinates coordinates, const char* what) {
  std::vector<double> places;
  runtime.resize(places, 2 * n);
  const std::size_t width = width_of(coordinates);
  for_each(runtime, n, [&](std::size_t i) {
    const double* const p = points + width * i;
    if (is_wrong(p, coordinates)) refuse(p, i, coordinates, what);
    const Point place =
        coordinates == SphereCoordinates::directions ? place_of_direction(p) : place_of_degrees(p);
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
