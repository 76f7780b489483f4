#include "tests/fuzz/segments.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "tests/constrained/domains.hpp"
#include "tests/constrained/nasty.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/fuzz/degenerate.hpp"

namespace flaunay::fuzz {
namespace {

using testing::FixtureRandom;
using testing::Plane;
using testing::Segments;

bool once_in(FixtureRandom& random, std::int64_t times) { return random.integer(1, times) == 1; }

std::int32_t any_point(FixtureRandom& random, const Coordinates& points) {
  return static_cast<std::int32_t>(random.integer(0, std::ssize(points) / 2 - 1));
}

/// Those that cross no earlier one, but at a point.
Segments without_crossings(const Coordinates& points, const Segments& segments) {
  Plane plane(points);
  const auto n = static_cast<std::int32_t>(points.size() / 2);
  Segments kept;
  for (std::size_t s = 0; s < segments.size(); s += 2) {
    const std::int32_t a = segments[s], b = segments[s + 1];
    bool crosses = false;
    for (std::size_t t = 0; t < kept.size() && !crosses; t += 2) {
      const std::int32_t c = kept[t], d = kept[t + 1];
      crosses = plane.cross(a, b, c, d);
      for (std::int32_t v = 0; v < n && crosses; ++v)
        crosses = plane.orient(a, b, v) != 0 || plane.orient(c, d, v) != 0;
    }
    if (!crosses) kept.insert(kept.end(), {a, b});
  }
  return kept;
}

/// Between points of few lines through two points.
Segments along_lines(FixtureRandom& random, const Coordinates& points) {
  Plane plane(points);
  const auto n = static_cast<std::int32_t>(points.size() / 2);
  Segments segments;
  for (auto lines = random.integer(1, 4); lines > 0; --lines) {
    const std::int32_t a = any_point(random, points), b = any_point(random, points);
    std::vector<std::int32_t> on;
    for (std::int32_t v = 0; v < n; ++v) {
      if (plane.orient(a, b, v) == 0) on.push_back(v);
    }
    for (auto left = random.integer(1, 6); left > 0; --left) {
      for (int end = 0; end < 2; ++end) {
        segments.push_back(on[static_cast<std::size_t>(random.integer(0, std::ssize(on) - 1))]);
      }
    }
  }
  return segments;
}

/// From one point to any others.
Segments star(FixtureRandom& random, const Coordinates& points) {
  Segments segments;
  const std::int32_t centre = any_point(random, points);
  for (auto left = random.integer(1, std::ssize(points)); left > 0; --left) {
    segments.insert(segments.end(), {centre, any_point(random, points)});
    if (once_in(random, 2)) std::swap(segments.back(), segments[segments.size() - 2]);
  }
  return segments;
}

Segments edges_of_another(FixtureRandom& random, const Coordinates& points) {
  const double factor = std::ldexp(1, static_cast<int>(random.integer(-8, 8)));
  const int one_in = static_cast<int>(random.integer(1, 4));
  try {
    return testing::edges_of_stretched(points, factor, one_in,
                                       static_cast<std::uint64_t>(random.integer(0, 1000)));
  } catch (const Error&) {  // out of the range of magnitudes
    return {};
  }
}

Segments any_segments(FixtureRandom& random, const Coordinates& points) {
  constexpr std::int64_t kMostToCompare = 60;
  const std::int64_t n = std::ssize(points) / 2;
  if (n == 0) return {};
  const auto count =
      static_cast<std::size_t>(random.integer(1, std::min<std::int64_t>(n, 3 * kMostToCompare)));
  const Segments any = testing::random_segments(random, points.size() / 2, count);
  const std::int64_t kind = random.integer(1, 10);
  if (kind == 1 && n <= kMostToCompare) return any;
  if (kind == 2)
    return Segments(any.begin(),
                    any.begin() + static_cast<std::ptrdiff_t>(2 * std::min<std::size_t>(count, 3)));
  if (n > kMostToCompare || kind >= 8) return edges_of_another(random, points);
  if (kind <= 4) return without_crossings(points, any);
  if (kind == 5) return star(random, points);
  Segments lines = along_lines(random, points);
  if (kind == 6) lines.insert(lines.end(), any.begin(), any.end());
  return without_crossings(points, lines);
}

SegmentSet any_nasty(FixtureRandom& random) {
  const auto& all = testing::nasty_segments();
  const auto& nasty = all[static_cast<std::size_t>(random.integer(0, std::ssize(all) - 1))];
  testing::SegmentInput input =
      nasty.make(static_cast<int>(random.integer(3, once_in(random, 20) ? 2000 : 60)),
                 static_cast<std::uint64_t>(random.integer(0, 1'000'000)));
  if (once_in(random, 4)) input = testing::turned(std::move(input));
  return {std::move(input.points), std::move(input.segments)};
}

/// Segments between points that are rounded onto few lines, so that they cross where little tells them apart.
SegmentSet on_rounded_lines(FixtureRandom& random) {
  SegmentSet set;
  const auto count = random.integer(4, 24);
  const auto lines = random.integer(1, 3);
  const double step = once_in(random, 3) ? 1e-13 : 1 / static_cast<double>(random.integer(1, 9));
  for (std::int64_t i = 0; i < count; ++i) {
    const auto line = static_cast<double>(random.integer(1, lines));
    const double x = step * static_cast<double>(random.integer(0, 2 * count));
    set.points.insert(set.points.end(), {x, line * x / 3});
  }
  set.segments = testing::random_segments(random, static_cast<std::size_t>(count),
                                          static_cast<std::size_t>(random.integer(2, count)));
  return set;
}

/// Equal points, other magnitudes, of which some round points to multiples of the smallest double, or points
/// moved.
void change(FixtureRandom& random, SegmentSet& set) {
  if (once_in(random, 6)) {
    const testing::SegmentInput twice = testing::duplicated(
        {set.points, set.segments}, static_cast<std::uint64_t>(random.integer(0, 1'000'000)));
    set = {twice.points, twice.segments};
  }
  if (once_in(random, 5)) {
    const int exponent = once_in(random, 2) ? -1074 : static_cast<int>(random.integer(-1074, 970));
    Coordinates scaled = set.points;
    for (double& x : scaled) x = std::ldexp(x, exponent);
    if (std::all_of(scaled.begin(), scaled.end(), [](double value) { return std::isfinite(value); }))
      set.points = scaled;
  }
  if (once_in(random, 5)) {
    const Coordinates moved =
        testing::perturbed(set.points, static_cast<std::uint64_t>(random.integer(0, 1'000'000)));
    if (std::all_of(moved.begin(), moved.end(), [](double value) { return std::isfinite(value); }))
      set.points = moved;
  }
}

}  // namespace

SegmentBatch degenerate_segments(FixtureRandom& random) {
  SegmentBatch batch;
  if (once_in(random, 5)) {
    for (auto left = random.integer(1, 4); left > 0; --left) {
      batch.push_back(once_in(random, 3) ? on_rounded_lines(random) : any_nasty(random));
    }
  } else {
    for (const Coordinates& points : degenerate_batch(random)) {
      batch.push_back({points, any_segments(random, points)});
    }
  }
  for (SegmentSet& set : batch) change(random, set);
  return batch;
}

SegmentBatch closed_curves(FixtureRandom& random) {
  SegmentBatch batch;
  for (const Coordinates& points : degenerate_batch(random)) {
    Coordinates stretched = points;
    const double factor = std::ldexp(1, static_cast<int>(random.integer(-4, 4)));
    for (std::size_t i = 0; i < stretched.size(); i += 2) stretched[i] *= factor;
    const int one_in = static_cast<int>(random.integer(1, 10));
    batch.push_back({points, {}});
    try {
      const Triangulation other = testing::delaunay_of(stretched, {0, points.size() / 2});
      batch.back().segments = testing::random_curves(other, random, one_in);
    } catch (const Error&) {  // out of the range of magnitudes
    }
  }
  return batch;
}

}  // namespace flaunay::fuzz
