#include "large/chunks/breaklines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/arguments.hpp"
#include "geometry/predicates.hpp"
#include "mesh/corners.hpp"
#include "mesh/rows.hpp"

namespace flaunay::chunks {
namespace {

using Ids = std::vector<std::int32_t>;

// Triangles that a thread takes at once.
constexpr std::size_t kTrianglesAtOnce = 1 << 16;

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

// Whether the line from p to q has a point inside of a triangle: nothing separates them, neither the line
// nor a side.
bool crosses(const geometry::Predicates& predicates, geometry::Point p, geometry::Point q,
             const std::array<geometry::Point, 3>& corners) {
  int left = 0, right = 0;
  for (const geometry::Point& corner : corners) {
    const int turn = predicates.orient(p, q, corner);
    left += turn > 0;
    right += turn < 0;
  }
  if (left == 0 || right == 0) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const geometry::Point &a = corners[k], &b = corners[(k + 1) % 3];
    if (predicates.orient(a, b, p) <= 0 && predicates.orient(a, b, q) <= 0) return false;
  }
  return true;
}

// Sides of triangles, each with its triangle on the left.
using Sides = std::vector<std::pair<std::int32_t, std::int32_t>>;

// The sides whose reverse is not a side of any triangle.
Sides border_of(const Ids& triangles) {
  Sides sides;
  for (std::size_t c = 0; c < triangles.size(); ++c) sides.push_back(mesh::edge_opposite(triangles, c));
  std::sort(sides.begin(), sides.end());
  Sides border;
  std::copy_if(sides.begin(), sides.end(), std::back_inserter(border), [&](const auto& side) {
    return !std::binary_search(sides.begin(), sides.end(), std::pair(side.second, side.first));
  });
  return border;
}

// Which triangles of a mesh lie inside of a border, and which of their sides are on it.
struct Inside {
  std::vector<char> triangles, sides;

  Inside(const ConstrainedTriangulation& mesh, const Sides& border)
      : triangles(mesh.triangles.size() / 3, 0), sides(mesh.triangles.size(), 0) {
    Ids found;
    for (std::size_t c = 0; c < sides.size(); ++c) {
      if (mesh.constrained[c] == 0) continue;
      const std::size_t t = c / 3;
      const auto [a, b] = mesh::edge_opposite(mesh.triangles, c);
      const bool is_left = std::binary_search(border.begin(), border.end(), std::pair(a, b));
      sides[c] = is_left || std::binary_search(border.begin(), border.end(), std::pair(b, a));
      if (is_left && std::exchange(triangles[t], 1) == 0) found.push_back(static_cast<std::int32_t>(t));
    }
    while (!found.empty()) {
      const std::size_t t = at(found.back());
      found.pop_back();
      for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
        if (sides[c] == 0 && mesh.neighbors[c] >= 0 &&
            std::exchange(triangles[at(mesh.neighbors[c])], 1) == 0)
          found.push_back(mesh.neighbors[c]);
      }
    }
  }
};

// Leaves some triangles. Sides between these and others become open.
void leave(const std::vector<char>& is_left, const std::vector<char>& is_open, ChunkSurface& surface) {
  const Ids rows = mesh::numbers_of_kept(is_left);
  std::size_t count = 0;
  surface.open.clear();
  for (std::size_t t = 0; t < rows.size(); ++t) {
    if (rows[t] < 0) continue;
    ++count;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t beyond = surface.neighbors[3 * t + k];
      const bool is_inner = (is_open.empty() || is_open[3 * t + k] == 0) && beyond >= 0 &&
                            rows[at(beyond)] >= 0 && at(beyond) != t;
      const std::size_t to = 3 * at(rows[t]) + k;
      surface.triangles[to] = surface.triangles[3 * t + k];
      surface.neighbors[to] = is_inner ? rows[at(beyond)] : rows[t];
      if (!is_inner) surface.open.push_back(static_cast<std::int32_t>(to));
    }
  }
  surface.triangles.resize(3 * count);
  surface.neighbors.resize(3 * count);
}

}  // namespace

void PointsWithLines::read(std::uint64_t first, std::size_t count, double* coordinates) {
  const std::size_t of_lines =
      first < lines_.points ? std::min<std::size_t>(count, lines_.points - first) : 0;
  if (of_lines > 0) std::copy_n(lines_.coordinates + 2 * first, 2 * of_lines, coordinates);
  if (count == of_lines) return;
  others_.read(first + of_lines - lines_.points, count - of_lines, coordinates + 2 * of_lines);
}

void PointsWithLines::read_values(std::uint64_t first, std::size_t count, double* values) {
  const std::size_t of_lines =
      first < lines_.points ? std::min<std::size_t>(count, lines_.points - first) : 0;
  if (of_lines > 0) std::copy_n(lines_.values + first, of_lines, values);
  if (count == of_lines) return;
  others_.read_values(first + of_lines - lines_.points, count - of_lines, values + of_lines);
}

CrossedTriangles::CrossedTriangles(const Breaklines& lines) : lines_(lines) {
  check_array(lines.coordinates, lines.points, "points of breaklines");
  check_array(lines.values, lines.points, "values of breaklines");
  check_array(lines.segments, lines.segment_count, "segments of breaklines", kMostIndexed / 2);
  double high = -std::numeric_limits<double>::infinity(), heights = 0;
  low_ = -high;
  for (std::size_t s = 0; s < lines.segment_count; ++s) {
    const std::int32_t v = lines.segments[2 * s], w = lines.segments[2 * s + 1];
    expect(v >= 0 && w >= 0 && at(v) < lines.points && at(w) < lines.points,
           "a segment of breaklines ends at none of their points");
    const double *const p = lines.coordinates + 2 * at(v), *const q = lines.coordinates + 2 * at(w);
    boxes_.push_back(
        {std::min(p[0], q[0]), std::min(p[1], q[1]), std::max(p[0], q[0]), std::max(p[1], q[1])});
    low_ = std::min(low_, boxes_.back().low_y);
    high = std::max(high, boxes_.back().high_y);
    heights += boxes_.back().high_y - boxes_.back().low_y;
  }
  // The number of bands is chosen so that a segment is in about four.
  constexpr double kBands = 4;
  const auto count = static_cast<double>(boxes_.size());
  bands_.resize(
      heights > 0 ? static_cast<std::size_t>(std::clamp(kBands * count * (high - low_) / heights, 1.0, count))
                  : 1);
  bands_by_ = high > low_ ? static_cast<double>(bands_.size()) / (high - low_) : 0;
  for (std::size_t s = 0; s < boxes_.size(); ++s) {
    for (std::size_t k = band_of(boxes_[s].low_y); k <= band_of(boxes_[s].high_y); ++k) {
      bands_[k].push_back(static_cast<std::uint32_t>(s));
    }
  }
  magnitudes_ = geometry::inspect(lines.coordinates, 0, lines.points);
}

std::size_t CrossedTriangles::band_of(double y) const {
  return static_cast<std::size_t>(
      std::clamp((y - low_) * bands_by_, 0.0, static_cast<double>(bands_.size() - 1)));
}

// Visits segments whose boxes meet a box, until it has visited one for which visit() is true.
template <typename Visit>
void CrossedTriangles::for_each_near(const Box& box, const Visit& visit) const {
  const std::size_t last = band_of(box.high_y);
  for (std::size_t k = band_of(box.low_y); k <= last; ++k) {
    for (const std::uint32_t s : bands_[k]) {
      const Box& other = boxes_[s];
      if (other.low_x > box.high_x || other.high_x < box.low_x || other.low_y > box.high_y ||
          other.high_y < box.low_y)
        continue;
      if (visit(s)) return;
    }
  }
}

void CrossedTriangles::take_from(host::Runtime& runtime, ChunkSurface& surface) {
  if (lines_.segment_count == 0) return;
  const std::size_t n = surface.coordinates.size() / 2, count = surface.triangles.size() / 3;
  const geometry::Scaling scaling = geometry::scaling_for(
      geometry::joined(magnitudes_, geometry::inspect(surface.coordinates.data(), 0, n)));
  const geometry::Predicates predicates{scaling.bounds};
  const auto scaled = [&](std::int32_t i, const double* coordinates) {
    return kernel::scaled_point(i, coordinates, scaling.powers());
  };
  std::vector<char> is_left(count, 1);
  runtime.share((count + kTrianglesAtOnce - 1) / kTrianglesAtOnce, [&](std::size_t run) {
    for (std::size_t t = run * kTrianglesAtOnce; t < std::min(count, (run + 1) * kTrianglesAtOnce); ++t) {
      const std::int32_t* const v = &surface.triangles[3 * t];
      std::array<const double*, 3> p{};
      for (std::size_t k = 0; k < 3; ++k) p[k] = &surface.coordinates[2 * at(v[k])];
      const auto [low_x, high_x] = std::minmax({p[0][0], p[1][0], p[2][0]});
      const auto [low_y, high_y] = std::minmax({p[0][1], p[1][1], p[2][1]});
      for_each_near({low_x, low_y, high_x, high_y}, [&](std::uint32_t s) {
        const std::array<geometry::Point, 3> corners = {scaled(v[0], surface.coordinates.data()),
                                                        scaled(v[1], surface.coordinates.data()),
                                                        scaled(v[2], surface.coordinates.data())};
        if (crosses(predicates, scaled(lines_.segments[2 * s], lines_.coordinates),
                    scaled(lines_.segments[2 * s + 1], lines_.coordinates), corners))
          is_left[t] = 0;
        return is_left[t] == 0;
      });
    }
  });
  bool is_changed = false;
  for (std::size_t t = 0; t < count; ++t) {
    if (is_left[t] != 0) continue;
    is_changed = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = at(surface.triangles[3 * t + k]);
      coordinates_.insert(coordinates_.end(), {surface.coordinates[2 * v], surface.coordinates[2 * v + 1]});
      values_.push_back(surface.values[v]);
    }
  }
  if (is_changed) leave(is_left, {}, surface);
}

ChunkSurface CrossedTriangles::triangulated(
    const std::function<ConstrainedTriangulation(const std::vector<double>&, const Constraints&)>& constrain)
    const {
  ChunkSurface surface;
  if (values_.empty()) return surface;
  surface.coordinates.assign(lines_.coordinates, lines_.coordinates + 2 * lines_.points);
  surface.coordinates.insert(surface.coordinates.end(), coordinates_.begin(), coordinates_.end());
  surface.values.assign(lines_.values, lines_.values + lines_.points);
  surface.values.insert(surface.values.end(), values_.begin(), values_.end());
  const std::size_t n = surface.values.size();
  expect(n <= std::numeric_limits<std::int32_t>::max() / 2, "breaklines cross too many triangles");
  // The border joins representatives of corners, since each triangle has corners of its own.
  const Ids representatives = constrain(surface.coordinates, {}).representatives;
  const Ids corners(representatives.begin() + static_cast<std::ptrdiff_t>(lines_.points),
                    representatives.end());
  const Sides border = border_of(corners);
  Ids segments(lines_.segments, lines_.segments + 2 * lines_.segment_count);
  for (const auto& [a, b] : border) segments.insert(segments.end(), {a, b});
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  ConstrainedTriangulation mesh = constrain(surface.coordinates, constraints);
  const Inside inside(mesh, border);
  surface.triangles = std::move(mesh.triangles);
  surface.neighbors = std::move(mesh.neighbors);
  leave(inside.triangles, inside.sides, surface);
  return surface;
}

}  // namespace flaunay::chunks
