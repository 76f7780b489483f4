#include "bench/measuring/constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "flaunay/flaunay.hpp"

namespace flaunay::bench {
namespace {

/// In [-1, 1).
double random_sign(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

struct Place {
  double x, y;
};

Place operator+(Place a, Place b) { return {a.x + b.x, a.y + b.y}; }
Place operator*(double factor, Place a) { return {factor * a.x, factor * a.y}; }

Place place_of(const Input& points, std::size_t i) {
  return {points.coordinates[2 * i], points.coordinates[2 * i + 1]};
}

void add_point(ConstrainedInput& input, Place p) {
  append(input.points.coordinates, {p.x, p.y});
  ++input.points.n;
}

void add_segment(ConstrainedInput& input, std::size_t a, std::size_t b) {
  append(input.segments, {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)});
}

void end_set(ConstrainedInput& input) {
  input.points.offsets.push_back(input.points.n);
  input.segment_offsets.push_back(input.segment_count());
}

ConstrainedInput empty_input(const std::string& name) { return {{name, 0, {}, {0}}, {}, {0}}; }

// ---- Rough curves

/// Heights over equal steps: 0 at both ends, in (-1, 1), rough at every scale.
std::vector<double> rough_heights(std::size_t steps, std::mt19937_64& random) {
  constexpr double kFirst = 1, kRoughness = 0.65;
  std::vector<double> heights(steps + 1, 0.0);
  const auto displace = [&](const auto& self, std::size_t begin, std::size_t end, double amount) -> void {
    if (end - begin < 2) return;
    const std::size_t middle = (begin + end) / 2;
    heights[middle] = (heights[begin] + heights[end]) / 2 + amount * random_sign(random);
    self(self, begin, middle, amount * kRoughness);
    self(self, middle, end, amount * kRoughness);
  };
  displace(displace, 0, steps, kFirst);
  for (double& height : heights) height = std::tanh(height);
  return heights;
}

/// A closed curve about a place, which sees all of it, by its distances: no two segments of it cross.
void add_curve(ConstrainedInput& input, Place centre, const std::vector<double>& distances) {
  constexpr double kPi = 3.14159265358979323846;
  const std::size_t first = input.points.n, points = distances.size();
  for (std::size_t k = 0; k < points; ++k) {
    const double angle = 2 * kPi * static_cast<double>(k) / static_cast<double>(points);
    add_point(input, centre + distances[k] * Place{std::cos(angle), std::sin(angle)});
    add_segment(input, first + k, first + (k + 1) % points);
  }
  input.ring_offsets.push_back(input.points.n);
}

void add_ring(ConstrainedInput& input, Place centre, double radius, std::size_t points,
              std::mt19937_64& random) {
  constexpr double kVaries = 0.25;
  std::vector<double> distances = rough_heights(points, random);
  distances.pop_back();
  for (double& height : distances) height = radius * (1 + kVaries * height);
  add_curve(input, centre, distances);
}

/// Five waves, and steps that are off them by up to an eighth of their length.
void add_waves(ConstrainedInput& input, Place centre, double radius, std::size_t points,
               std::mt19937_64& random) {
  constexpr double kHeight = 0.25, kTwoPi = 6.28318530717958647692, kWaves = 5, kRough = 0.125;
  std::vector<double> distances;
  for (std::size_t k = 0; k < points; ++k) {
    const double step = 1 / static_cast<double>(points);
    const double wave = kHeight * std::sin(kWaves * kTwoPi * static_cast<double>(k) * step);
    distances.push_back(radius * (1 + wave + kRough * kTwoPi * step * random_sign(random)));
  }
  add_curve(input, centre, distances);
}

Place corner_of(std::size_t k, std::size_t side) {
  return {static_cast<double>(k % side), static_cast<double>(k / side)};
}

// ---- The map

constexpr std::size_t kBorderSteps = 100;

/// A border: a function's graph over the line between two corners. It stays closer to the line than a third
/// of the distance to the nearer corner, so that borders meet in corners only.
void add_border(ConstrainedInput& input, std::size_t from, std::size_t to, std::mt19937_64& random) {
  constexpr double kSteepest = 0.33;
  const Place a = place_of(input.points, from), b = place_of(input.points, to);
  const Place along = b + -1.0 * a, across{-along.y, along.x};
  const std::vector<double> heights = rough_heights(kBorderSteps, random);
  std::size_t before = from;
  for (std::size_t k = 1; k < kBorderSteps; ++k) {
    const double t = static_cast<double>(k) / kBorderSteps;
    add_point(input, a + t * along + (kSteepest * std::min(t, 1 - t) * heights[k]) * across);
    add_segment(input, before, input.points.n - 1);
    before = input.points.n - 1;
  }
  add_segment(input, before, to);
}

}  // namespace

ConstrainedInput short_segments(std::size_t n) {
  // A power of two, so that stretched points are on no side of an edge on which the points are not.
  constexpr double kStretch = 4;
  constexpr std::size_t kOneIn = 5;
  ConstrainedInput input{make_input("uniform", n), {}, {}};
  std::vector<double> stretched = input.points.coordinates;
  for (std::size_t i = 0; i < n; ++i) stretched[2 * i] *= kStretch;
  const std::vector<std::int32_t> corners = Triangulator("host").triangulate(stretched.data(), n).triangles;
  // Edges inside are in two triangles, once in each direction.
  for (std::size_t h = 0; h < corners.size(); ++h) {
    const std::size_t next = h % 3 == 2 ? h - 2 : h + 1;
    const auto a = static_cast<std::size_t>(corners[h]), b = static_cast<std::size_t>(corners[next]);
    if (a < b) add_segment(input, a, b);
  }
  std::mt19937_64 random(1);
  // Pairs of ends are shuffled as wholes.
  const std::size_t count = input.segment_count(), kept = std::min(count, n / kOneIn);
  for (std::size_t k = 0; k < kept; ++k) {
    const std::size_t other = k + random() % (count - k);
    for (std::size_t end = 0; end < 2; ++end)
      std::swap(input.segments[2 * k + end], input.segments[2 * other + end]);
  }
  input.segments.resize(2 * kept);
  input.segment_offsets = {0, kept};
  input.points.distribution = "short segments";
  return input;
}

ConstrainedInput map_of_cells(std::size_t n, bool on_integers) {
  constexpr double kJitter = 0.12, kGrid = 0x1p26;
  const std::size_t side = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(n) / (2.0 * kBorderSteps)))));
  ConstrainedInput input = empty_input(on_integers ? "map on integers" : "map");
  std::mt19937_64 random(2);
  const auto corner = [side](std::size_t row, std::size_t column) { return row * (side + 1) + column; };
  for (std::size_t k = 0; k < (side + 1) * (side + 1); ++k) {
    add_point(input, corner_of(k, side + 1) + kJitter * Place{random_sign(random), random_sign(random)});
  }
  for (std::size_t row = 0; row <= side; ++row) {
    for (std::size_t column = 0; column <= side; ++column) {
      if (column < side) add_border(input, corner(row, column), corner(row, column + 1), random);
      if (row < side) add_border(input, corner(row, column), corner(row + 1, column), random);
    }
  }
  if (on_integers) {
    for (double& x : input.points.coordinates) x = std::round(x * kGrid / static_cast<double>(side));
  }
  end_set(input);
  return input;
}

ConstrainedInput polygons_with_holes(std::size_t polygons, std::size_t points) {
  const std::size_t inner = points * 3 / 10;
  constexpr double kOuterRadius = 0.38, kInnerRadius = 0.2;
  ConstrainedInput input = empty_input(fmt::format("{} polygons of {} points", polygons, points));
  input.ring_offsets = input.polygon_offsets = {0};
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(polygons))));
  std::mt19937_64 random(4);
  for (std::size_t k = 0; k < polygons; ++k) {
    const Place centre = corner_of(k, side) + Place{0.5, 0.5};
    add_ring(input, centre, kOuterRadius, points - inner, random);
    add_ring(input, centre, kInnerRadius, inner, random);
    input.polygon_offsets.push_back(input.ring_offsets.size() - 1);
    end_set(input);
  }
  return input;
}

ConstrainedInput wavy_polygon(std::size_t n) {
  constexpr std::size_t kHolesOnASide = 3;
  constexpr double kDistance = 0.4, kRadius = 0.1;
  const std::size_t of_hole = n * 3 / 100;
  ConstrainedInput input = empty_input(fmt::format("a polygon of {} points", n));
  input.ring_offsets = {0};
  std::mt19937_64 random(5);
  add_waves(input, {0, 0}, 1, n - kHolesOnASide * kHolesOnASide * of_hole, random);
  for (std::size_t k = 0; k < kHolesOnASide * kHolesOnASide; ++k) {
    add_waves(input, kDistance * (corner_of(k, kHolesOnASide) + Place{-1, -1}), kRadius, of_hole, random);
  }
  input.polygon_offsets = {0, input.ring_offsets.size() - 1};
  end_set(input);
  return input;
}

ConstrainedInput square() {
  ConstrainedInput input = empty_input("a square");
  for (const Place corner : {Place{0, 0}, {1, 0}, {1, 1}, {0, 1}}) add_point(input, corner);
  input.segments = {0, 1, 1, 2, 2, 3, 3, 0};
  input.ring_offsets = {0, input.points.n};
  input.polygon_offsets = {0, 1};
  end_set(input);
  return input;
}

ConstrainedInput islands(std::size_t n) {
  constexpr std::size_t kPoints = 1000;
  ConstrainedInput input = polygons_with_holes(std::max<std::size_t>(1, n / kPoints), kPoints);
  // One set of all: no polygons.
  input.points.distribution = "islands";
  input.points.offsets = {0, input.points.n};
  input.segment_offsets = {0, input.segment_count()};
  input.ring_offsets.clear();
  input.polygon_offsets.clear();
  return input;
}

}  // namespace flaunay::bench
