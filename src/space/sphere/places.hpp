// Points of the unit sphere as places in a plane, and directions of these.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "geometry/for_each.hpp"
#include "geometry/predicates.hpp"

namespace flaunay::sphere {

using geometry::for_each;
using geometry::Point;

inline bool is_pole(Point place) { return std::isinf(place.x); }
inline Point pole() { return {HUGE_VAL, HUGE_VAL}; }
inline Point place_at(const std::vector<double>& places, std::size_t i) {
  return {places[2 * i], places[2 * i + 1]};
}

/// A vector in space.
struct Direction {
  double x, y, z;
};
inline Direction operator-(const Direction& a, const Direction& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline double dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Direction cross(const Direction& a, const Direction& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The unit vector of a place, rounded.
Direction direction_of(Point place);

/// The angle between two unit vectors, in radians, rounded.
inline double angle_between(const Direction& a, const Direction& b) {
  const Direction difference = a - b, sum = {a.x + b.x, a.y + b.y, a.z + b.z};
  return 2 * std::atan2(std::sqrt(dot(difference, difference)), std::sqrt(dot(sum, sum)));
}

/// The number of coordinates of a point.
constexpr std::size_t width_of(SphereCoordinates coordinates) {
  return coordinates == SphereCoordinates::directions ? 3 : 2;
}
/// Writes a unit vector by its coordinates; degrees are rounded.
void write_direction(const Direction& d, SphereCoordinates coordinates, double* to);

/// Throws Error(input) for what is no point. what: its name.
[[noreturn]] void refuse(const double* p, std::size_t i, SphereCoordinates coordinates, const char* what);

/// Computes x and y per point, as sphere/places.h says, of n points from the number `first` of the array on.
/// Returns whether the south pole is among them. Throws Error(input) for those that are none. Waits once.
/// O(n).
template <typename T>
bool find_places(host::Runtime& runtime, const host::Buffer<T>& points, std::size_t first, std::size_t n,
                 SphereCoordinates coordinates, const host::Buffer<cl_double>& places, const char* what);
/// Computes places of points in host memory, natively.
std::vector<double> to_places(host::Runtime& runtime, const double* points, std::size_t n, const Space& space,
                              const char* what);

/// Returns the numbers of places of sets in an order in which those of near points of the sphere are near
/// each other: one set after the other, each along a curve that fills the octahedron to which the sphere is
/// unfolded. O(n log s) for s sets.
std::vector<std::int32_t> order_along_curve(host::Runtime& runtime, const std::vector<double>& places,
                                            const std::vector<std::size_t>& offsets);

}  // namespace flaunay::sphere
