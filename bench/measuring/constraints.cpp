#include "bench/measuring/constraints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

namespace flaunay::bench {
namespace {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// In [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// In [-1, 1).
  double sign() { return 2 * unit() - 1; }
  std::size_t below(std::size_t count) { return engine_() % count; }

 private:
  std::mt19937_64 engine_;
};

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

// ---- Short segments

/// Things by the cells of a grid over the unit square.
template <typename Thing>
class Grid {
 public:
  explicit Grid(double cell) : side_(std::max<std::size_t>(1, static_cast<std::size_t>(1 / cell))) {
    cells_.resize(side_ * side_);
  }
  std::vector<Thing>& at(Place p) { return cells_[index(p.y) * side_ + index(p.x)]; }
  /// Whether all things in the cell of a place and in those around it have a property.
  template <typename Property>
  bool all_near(Place p, const Property& property) const {
    const std::size_t row = index(p.y), column = index(p.x);
    for (std::size_t r = row - (row > 0); r <= std::min(row + 1, side_ - 1); ++r) {
      for (std::size_t c = column - (column > 0); c <= std::min(column + 1, side_ - 1); ++c) {
        const std::vector<Thing>& cell = cells_[r * side_ + c];
        if (!std::all_of(cell.begin(), cell.end(), property)) return false;
      }
    }
    return true;
  }

 private:
  std::size_t index(double x) const {
    return std::min(side_ - 1, static_cast<std::size_t>(std::max(0.0, x * static_cast<double>(side_))));
  }
  std::size_t side_;
  std::vector<std::vector<Thing>> cells_;
};

using Segment = std::pair<std::size_t, std::size_t>;

/// Random points are nowhere near a line through two others, so that rounding does not matter.
bool meet(const Input& points, Segment s, Segment t) {
  const auto [a, b] = s;
  const auto [p, q] = t;
  if (a == p || a == q || b == p || b == q) return a + b == p + q;
  const auto side_of = [&](std::size_t i, std::size_t j, std::size_t k) {
    const Place u = place_of(points, i), v = place_of(points, j), w = place_of(points, k);
    return (v.x - u.x) * (w.y - u.y) - (v.y - u.y) * (w.x - u.x);
  };
  return side_of(a, b, p) * side_of(a, b, q) <= 0 && side_of(p, q, a) * side_of(p, q, b) <= 0;
}

// ---- Rough curves

/// Heights over equal steps: 0 at both ends, in (-1, 1), rough at every scale.
std::vector<double> rough_heights(std::size_t steps, Random& random) {
  constexpr double kFirst = 1, kRoughness = 0.65;
  std::vector<double> heights(steps + 1, 0.0);
  const auto displace = [&](const auto& self, std::size_t begin, std::size_t end, double amount) -> void {
    if (end - begin < 2) return;
    const std::size_t middle = (begin + end) / 2;
    heights[middle] = (heights[begin] + heights[end]) / 2 + amount * random.sign();
    self(self, begin, middle, amount * kRoughness);
    self(self, middle, end, amount * kRoughness);
  };
  displace(displace, 0, steps, kFirst);
  for (double& height : heights) height = std::tanh(height);
  return heights;
}

/// A closed curve about a place, which sees all of it: no two segments of it cross.
void add_ring(ConstrainedInput& input, Place centre, double radius, std::size_t points, Random& random) {
  constexpr double kVaries = 0.25, kPi = 3.14159265358979323846;
  const std::size_t first = input.points.n;
  const std::vector<double> heights = rough_heights(points, random);
  for (std::size_t k = 0; k < points; ++k) {
    const double angle = 2 * kPi * static_cast<double>(k) / static_cast<double>(points);
    const double distance = radius * (1 + kVaries * heights[k]);
    add_point(input, centre + distance * Place{std::cos(angle), std::sin(angle)});
    add_segment(input, first + k, first + (k + 1) % points);
  }
  input.ring_offsets.push_back(input.points.n);
}

constexpr double kOuterRadius = 0.38, kInnerRadius = 0.2;

/// A ring and a hole in it, inside of the unit square at a corner.
void add_polygon(ConstrainedInput& input, Place corner, std::size_t outer, std::size_t inner,
                 Random& random) {
  const Place centre = corner + Place{0.5, 0.5};
  add_ring(input, centre, kOuterRadius, outer, random);
  add_ring(input, centre, kInnerRadius, inner, random);
  input.polygon_offsets.push_back(input.ring_offsets.size() - 1);
}

Place corner_of(std::size_t k, std::size_t side) {
  return {static_cast<double>(k % side), static_cast<double>(k / side)};
}

std::size_t side_for(std::size_t cells) {
  return static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(cells))));
}

// ---- The map

constexpr std::size_t kBorderSteps = 100;

/// A border: a function's graph over the line between two corners. It stays closer to the line than a third
/// of the distance to the nearer corner, so that borders meet in corners only.
void add_border(ConstrainedInput& input, std::size_t from, std::size_t to, Random& random) {
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
  constexpr std::size_t kOneIn = 5, kTriesEach = 100;
  ConstrainedInput input{make_input("uniform", n), {}, {}};
  const double longest = 3 / std::sqrt(static_cast<double>(n));
  // Cells are as long as the longest segment, so that only segments of neighbouring cells can meet. Segments
  // are where their middles are.
  Grid<std::size_t> points(longest);
  Grid<Segment> segments(longest);
  for (std::size_t i = 0; i < n; ++i) points.at(place_of(input.points, i)).push_back(i);
  Random random(1);
  for (std::size_t tries = 0; tries < kTriesEach * n && input.segment_count() < n / kOneIn; ++tries) {
    const std::size_t a = random.below(n);
    const Place p = place_of(input.points, a);
    const std::vector<std::size_t>& near = points.at(p);
    const std::size_t b = near[random.below(near.size())];
    const Place q = place_of(input.points, b), middle = 0.5 * (p + q);
    const auto is_free = [&](const Segment& other) { return !meet(input.points, {a, b}, other); };
    if (a == b || std::hypot(p.x - q.x, p.y - q.y) >= longest || !segments.all_near(middle, is_free))
      continue;
    segments.at(middle).emplace_back(a, b);
    add_segment(input, a, b);
  }
  input.segment_offsets = {0, input.segment_count()};
  input.points.distribution = "short segments";
  return input;
}

ConstrainedInput map_of_cells(std::size_t n, bool on_integers) {
  constexpr double kJitter = 0.12, kGrid = 0x1p26;
  const std::size_t side = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(n) / (2.0 * kBorderSteps)))));
  ConstrainedInput input = empty_input(on_integers ? "map on integers" : "map");
  Random random(2);
  const auto corner = [side](std::size_t row, std::size_t column) { return row * (side + 1) + column; };
  for (std::size_t k = 0; k < (side + 1) * (side + 1); ++k) {
    add_point(input, corner_of(k, side + 1) + kJitter * Place{random.sign(), random.sign()});
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

ConstrainedInput islands(std::size_t n) {
  constexpr std::size_t kCoast = 800, kLake = 200;
  const std::size_t count = std::max<std::size_t>(1, n / (kCoast + kLake)), side = side_for(count);
  ConstrainedInput input = empty_input("islands");
  Random random(3);
  for (std::size_t k = 0; k < count; ++k) add_polygon(input, corner_of(k, side), kCoast, kLake, random);
  end_set(input);
  // One set of all: no polygons.
  input.ring_offsets.clear();
  input.polygon_offsets.clear();
  return input;
}

ConstrainedInput polygons_with_holes(std::size_t polygons, std::size_t points) {
  const std::size_t inner = points * 3 / 10;
  ConstrainedInput input = empty_input(fmt::format("{} polygons of {} points", polygons, points));
  input.ring_offsets = input.polygon_offsets = {0};
  Random random(4);
  for (std::size_t k = 0; k < polygons; ++k) {
    add_polygon(input, corner_of(k, side_for(polygons)), points - inner, inner, random);
    end_set(input);
  }
  return input;
}

}  // namespace flaunay::bench
