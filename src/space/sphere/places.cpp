#include "space/sphere/places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <numeric>

#include "geometry/arguments.hpp"
#include "geometry/sort.hpp"
#include "launchers/sphere/places.cl.hpp"

namespace flaunay::sphere {
namespace {

template <typename T>
struct KernelOf {
  using Places = kernels::places_of_doubles;
};
template <>
struct KernelOf<cl_float> {
  using Places = kernels::places_of_floats;
};

}  // namespace

Direction direction_of(Point place) {
  if (is_pole(place)) return {0, 0, -1};
  const double square = place.x * place.x + place.y * place.y, factor = 2 / (1 + square);
  return {place.x * factor, place.y * factor, (1 - square) / (1 + square)};
}

void write_direction(const Direction& d, SphereCoordinates coordinates, double* to) {
  if (coordinates == SphereCoordinates::directions) {
    std::copy_n(std::begin({d.x, d.y, d.z}), 3, to);
  } else {
    constexpr double kDegrees = 180 / std::numbers::pi;
    to[0] = std::atan2(d.y, d.x) * kDegrees;
    to[1] = std::clamp(std::atan2(d.z, std::hypot(d.x, d.y)) * kDegrees, -90.0, 90.0);
  }
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

template <typename T>
bool find_places(host::Runtime& runtime, const host::Buffer<T>& points, std::size_t first, std::size_t n,
                 SphereCoordinates coordinates, const host::Buffer<cl_double>& places, const char* what) {
  host::Arena::Scope scope(runtime.arena());
  const std::size_t width = width_of(coordinates);
  const auto none = static_cast<cl_int>(n);
  const auto firsts = runtime.arena().allocate<cl_int>(2);
  runtime.fill(firsts, 2, none);
  runtime.map(n, typename KernelOf<T>::Places{.width = static_cast<cl_int>(width),
                                              .first = first,
                                              .points = points,
                                              .places = places.template as<cl_double2>(),
                                              .found = firsts});
  cl_int found[2] = {};
  runtime.read(firsts, 0, 2, found);
  if (found[0] < none) {
    const auto wrong = static_cast<std::size_t>(found[0]);
    T numbers[3] = {};
    runtime.read(points, first + wrong * width, width, numbers);
    const double wide[3] = {numbers[0], numbers[1], numbers[2]};
    refuse(wide, wrong, coordinates, what);
  }
  return found[1] < none;
}
template bool find_places(host::Runtime&, const host::Buffer<cl_double>&, std::size_t, std::size_t,
                          SphereCoordinates, const host::Buffer<cl_double>&, const char*);
template bool find_places(host::Runtime&, const host::Buffer<cl_float>&, std::size_t, std::size_t,
                          SphereCoordinates, const host::Buffer<cl_double>&, const char*);

std::vector<double> to_places(host::Runtime& runtime, const double* points, std::size_t n, const Space& space,
                              const char* what) {
  check_enumerator(space.coordinates);
  const SphereCoordinates coordinates = space.coordinates;
  host::Arena::Scope scope(runtime.arena());
  std::vector<double> places;
  runtime.resize(places, 2 * n);
  const auto output = runtime.output(places);
  find_places(runtime, runtime.view(points, n * width_of(coordinates)), 0, n, coordinates, output, what);
  runtime.fetch_later(output, places);
  return places;
}

std::vector<std::int32_t> order_along_curve(host::Runtime& runtime, const std::vector<double>& places,
                                            const std::vector<std::size_t>& offsets) {
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
  if (offsets.size() == 2) return order;
  std::vector<std::int32_t> by_set(order.size());
  std::vector<std::size_t> ends = offsets;
  for (const std::int32_t i : order) {
    const auto next = std::upper_bound(offsets.begin(), offsets.end(), static_cast<std::size_t>(i));
    by_set[ends[static_cast<std::size_t>(next - offsets.begin()) - 1]++] = i;
  }
  return by_set;
}

}  // namespace flaunay::sphere
