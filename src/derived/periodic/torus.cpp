#include "derived/periodic/torus.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/predicates.hpp"

namespace flaunay::periodic {
namespace {

using geometry::Point;

// The difference of the numbers of periods of two corners, and these corners: on a torus, an edge of a
// triangle.
struct Edge {
  std::int32_t low, high;
  int across, up;
  std::int32_t at;  // 3 t + the corner opposite
};

auto key(const Edge& e) { return std::tuple(e.low, e.high, e.across, e.up); }

// An upper bound of the width of the circle through three points whose differences are exact or have one
// rounding; infinite if that cannot tell a slender triangle from a line.
double most_width(Point a, Point b, Point c) {
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y, dx = c.x - b.x, dy = c.y - b.y;
  const double left = bx * cy, right = by * cx;
  const double area = (left - right) - ORIENT_BOUND * (std::fabs(left) + std::fabs(right));
  if (!(area > 0)) return HUGE_VAL;
  constexpr double kSpare = 1 + 0x1p-40;  // for all roundings
  return kSpare * std::sqrt((bx * bx + by * by) * (cx * cx + cy * cy)) * std::sqrt(dx * dx + dy * dy) / area;
}

}  // namespace

double wrapped(double x, double period) {
  const double unit = std::ldexp(1.0, std::ilogb(period) - 52);
  // Without a rounding, as std::remainder is.
  const double rest = x < 0 || x >= period ? std::remainder(x, period) : x < period / 2 ? x : x - period;
  double place = std::nearbyint(rest / unit) * unit;
  if (place < 0) place += period;
  return place < period ? place + 0.0 : 0.0;
}

double first_margin(std::size_t n, const Period& period) {
  constexpr double kSpare = 3, kPi = 3.14159265358979;
  const double count = static_cast<double>(n) + 2;
  const double radius = std::sqrt(period.x * period.y * std::log(count) / (kPi * count));
  return std::min(kSpare * radius, std::min(period.x, period.y) / 2);
}

Unrolled unroll(const std::vector<double>& places, std::size_t first, std::size_t last, const Period& period,
                double margin) {
  Unrolled plane;
  plane.originals = last - first;
  plane.coordinates.reserve(2 * plane.originals);
  plane.points.reserve(plane.originals);
  plane.image_of.reserve(2 * plane.originals);
  const auto is_low = [](double x, double length) { return x < length / 2; };
  const auto add = [&](double x, double y, std::size_t i, int across, int up) {
    plane.coordinates.push_back(x);
    plane.coordinates.push_back(y);
    plane.points.push_back(static_cast<std::int32_t>(i));
    plane.image_of.push_back(static_cast<std::int8_t>(across));
    plane.image_of.push_back(static_cast<std::int8_t>(up));
  };
  const double low_x = -period.x / 2 - margin, high_x = period.x / 2 + margin;
  const double low_y = -period.y / 2 - margin, high_y = period.y / 2 + margin;
  for (const bool originals : {true, false}) {
    for (std::size_t i = first; i < last; ++i) {
      // The image around 0.
      const int left = is_low(places[2 * i], period.x) ? 0 : -1,
                below = is_low(places[2 * i + 1], period.y) ? 0 : -1;
      const double x = places[2 * i] + left * period.x, y = places[2 * i + 1] + below * period.y;
      if (originals) {
        add(x, y, i, left, below);
        continue;
      }
      const bool is_inside =
          x < low_x + period.x && x > high_x - period.x && y < low_y + period.y && y > high_y - period.y;
      for (int across = -1; across <= 1 && !is_inside; ++across) {
        for (int up = -1; up <= 1; ++up) {
          const double image_x = x + across * period.x, image_y = y + up * period.y;
          const bool is_near = image_x >= low_x && image_x <= high_x && image_y >= low_y && image_y <= high_y;
          if ((across != 0 || up != 0) && is_near) add(image_x, image_y, i, left + across, below + up);
        }
      }
    }
  }
  return plane;
}

Selected select(const Unrolled& plane, const Triangulation& planar, std::size_t set, std::size_t plane_first,
                double margin, std::size_t vertices) {
  const std::size_t begin = planar.triangle_offsets[set], end = planar.triangle_offsets[set + 1];
  const auto in_plane = [&](std::size_t t, std::size_t k) {
    return static_cast<std::size_t>(planar.triangles[3 * t + k]) - plane_first;
  };
  const auto place = [&](std::size_t v) {
    return Point{plane.coordinates[2 * v], plane.coordinates[2 * v + 1]};
  };
  Selected result;
  // Of all images of a triangle the one whose corner of the smallest index is the point itself.
  std::vector<std::int32_t> number(end - begin, -1);
  std::vector<std::size_t> chosen;
  chosen.reserve(2 * vertices);
  for (std::size_t t = begin; t < end; ++t) {
    std::size_t first = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (plane.points[in_plane(t, k)] < plane.points[in_plane(t, first)]) first = k;
    }
    if (in_plane(t, first) >= plane.originals) continue;
    if (!(most_width(place(in_plane(t, 0)), place(in_plane(t, 1)), place(in_plane(t, 2))) < margin))
      return result;
    number[t - begin] = static_cast<std::int32_t>(chosen.size());
    chosen.push_back(3 * t + first);
  }
  if (chosen.size() != 2 * vertices) return result;
  result.triangles.reserve(3 * chosen.size());
  result.neighbors.reserve(3 * chosen.size());
  result.offsets.reserve(6 * chosen.size());
  std::vector<Edge> open;
  for (const std::size_t from : chosen) {
    const std::size_t t = from / 3, first = in_plane(t, from % 3);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t c = 3 * t + (from + k) % 3;  // 3 t is a multiple of 3
      const std::size_t v = in_plane(t, c % 3);
      result.triangles.push_back(plane.points[v]);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        result.offsets.push_back(
            static_cast<std::int8_t>(plane.image_of[2 * v + axis] - plane.image_of[2 * first + axis]));
      }
      const std::int32_t beyond = planar.neighbors[c];
      const std::int32_t other = beyond < 0 ? -1 : number[static_cast<std::size_t>(beyond) - begin];
      result.neighbors.push_back(other);
      if (other >= 0) continue;
      const std::size_t a = in_plane(t, (c + 1) % 3), b = in_plane(t, (c + 2) % 3);
      Edge edge{plane.points[a], plane.points[b], plane.image_of[2 * b] - plane.image_of[2 * a],
                plane.image_of[2 * b + 1] - plane.image_of[2 * a + 1],
                static_cast<std::int32_t>(result.neighbors.size() - 1)};
      if (edge.low > edge.high) {
        std::swap(edge.low, edge.high);
        edge.across = -edge.across;
        edge.up = -edge.up;
      }
      open.push_back(edge);
    }
  }
  std::sort(open.begin(), open.end(), [](const Edge& a, const Edge& b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < open.size(); i += 2) {
    if (i + 1 == open.size() || key(open[i]) != key(open[i + 1])) return result;
    result.neighbors[static_cast<std::size_t>(open[i].at)] = open[i + 1].at / 3;
    result.neighbors[static_cast<std::size_t>(open[i + 1].at)] = open[i].at / 3;
  }
  result.is_complete = true;
  return result;
}

}  // namespace flaunay::periodic
