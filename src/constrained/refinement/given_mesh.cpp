#include "constrained/refinement/given_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "constrained/edges_by_ends.hpp"
#include "geometry/arguments.hpp"
#include "mesh/corners.hpp"
#include "mesh/join_sides.hpp"
#include "mesh/rows.hpp"

namespace flaunay::constrained {
namespace {

using Ids = std::vector<std::int32_t>;
using geometry::Point;

// Leaves out triangles of a result.
void leave_only(const std::vector<bool>& is_left, ConstrainedTriangulation& result) {
  const Ids numbers = mesh::numbers_of_kept(is_left);
  std::size_t t = 0, count = 0;
  for (std::size_t& end : result.triangle_offsets) {
    for (; t < end; ++t) count += is_left[t] ? 1 : 0;
    end = count;
  }
  mesh::keep(is_left, 3, result.triangles);
  mesh::keep(is_left, 3, result.neighbors);
  mesh::keep(is_left, 3, result.constrained);
  for (std::int32_t& neighbor : result.neighbors) neighbor = neighbor < 0 ? neighbor : numbers[neighbor];
  mesh::keep(is_left, 1, result.depths);
  mesh::keep(is_left, 1, result.regions);
  mesh::renumber_labels(result.regions);
}

}  // namespace

GivenMesh::GivenMesh(const double* coordinates, std::size_t n, const Constraints& constraints,
                     const ConstrainedOptions& options)
    : given_(options.refinement.mesh),
      options_(options),
      constraints_(constraints),
      triangles_(given_.triangles, given_.triangles + 3 * given_.count) {
  check(n);
  scaling_ = geometry::scaling_for(coordinates, 0, n, geometry::inspect(coordinates, 0, n));
  points_.reserve(n);
  for (std::size_t v = 0; v < n; ++v) points_.push_back(point(coordinates, static_cast<std::int32_t>(v)));
  turn_left();
  find_neighbors();
  add_segments(constraints);
}

void GivenMesh::check(std::size_t n) {
  expect(options_.outside == Outside::keep, "a mesh that is refined says itself what is outside");
  expect(
      given_.attributes == nullptr || constraints_.seed_attributes == nullptr || constraints_.seed_count == 0,
      "attributes are those of a mesh or those of seeds, not both");
  for (const std::int32_t v : triangles_) {
    expect(v >= 0 && static_cast<std::size_t>(v) < n, "a triangle of the mesh has a corner that is no point");
  }
}

Point GivenMesh::point(const double* coordinates, std::int32_t v) const {
  const double* const p = coordinates + 2 * static_cast<std::size_t>(v);
  return {std::ldexp(p[0], scaling_.shift), std::ldexp(p[1], scaling_.shift)};
}

void GivenMesh::turn_left() {
  const geometry::Predicates predicates{scaling_.bounds};
  for (std::size_t c = 0; c < triangles_.size(); c += 3) {
    const int turn =
        predicates.orient(points_[triangles_[c]], points_[triangles_[c + 1]], points_[triangles_[c + 2]]);
    if (turn == 0) {
      throw Error(ErrorKind::input,
                  fmt::format("triangle {} of the mesh that is to be refined has no area", c / 3));
    }
    if (turn < 0) std::swap(triangles_[c + 1], triangles_[c + 2]);
  }
}

void GivenMesh::find_neighbors() {
  neighbors_.assign(triangles_.size(), -1);
  if (const auto twice = mesh::join_sides(triangles_, neighbors_)) {
    throw Error(ErrorKind::input,
                fmt::format("triangles {} and {} of the mesh that is to be refined lie on each other",
                            twice->first / 3, twice->second / 3));
  }
  first_corner_.assign(points_.size() + 1, 0);
  for (const std::int32_t v : triangles_) ++first_corner_[static_cast<std::size_t>(v) + 1];
  std::partial_sum(first_corner_.begin(), first_corner_.end(), first_corner_.begin());
  Ids next(first_corner_.begin(), first_corner_.end() - 1);
  corners_at_.resize(triangles_.size());
  for (std::size_t c = 0; c < triangles_.size(); ++c) {
    corners_at_[next[triangles_[c]]++] = static_cast<std::int32_t>(c);
  }
}

void GivenMesh::add_segments(const Constraints& constraints) {
  segments_.assign(constraints.segments, constraints.segments + 2 * constraints.segment_count);
  for (std::size_t c = 0; c < triangles_.size(); ++c) {
    const auto t = static_cast<std::int32_t>(c / 3), beyond = neighbors_[c];
    if (beyond >= 0 && (beyond < t || have_same_attributes(t, beyond))) continue;
    const auto [from, to] = mesh::edge_opposite(triangles_, c);
    segments_.insert(segments_.end(), {from, to});
    border_.push_back(static_cast<std::int32_t>(c));
  }
  constraints_.segments = segments_.data();
  constraints_.segment_count = segments_.size() / 2;
  if (constraints.segment_markers != nullptr) {
    markers_.assign(constraints.segment_markers, constraints.segment_markers + constraints.segment_count);
    markers_.resize(constraints_.segment_count, 0);
    constraints_.segment_markers = markers_.data();
  }
  const std::uint8_t*& kept = options_.refinement.kept_segments;
  if (kept != nullptr) {
    kept_.assign(kept, kept + constraints.segment_count);
    kept_.resize(constraints_.segment_count, 0);
    kept = kept_.data();
  }
}

// For each triangle of a result one of the mesh in the same region, or -1: from the border on, regions are
// filled.
Ids GivenMesh::labels_of(const double* coordinates, const ConstrainedTriangulation& result) const {
  // The triangles on both sides of each constraint edge: its left one, and its right one.
  Ids beside(result.constraint_edges.size(), -1);
  const EdgesByEnds edges(result.constraint_edges, result.representatives.size());
  const auto edge_at = [&](std::size_t c) {
    const auto [from, to] = mesh::edge_opposite(result.triangles, c);
    return static_cast<std::size_t>(edges.number(from, to));
  };
  for (std::size_t c = 0; c < result.triangles.size(); ++c) {
    if (result.constrained[c] == 0) continue;
    const std::size_t left = 2 * edge_at(c);
    const bool is_forward = result.constraint_edges[left] == mesh::edge_opposite(result.triangles, c).first;
    beside[is_forward ? left : left + 1] = static_cast<std::int32_t>(c / 3);
  }
  Ids labels(result.triangles.size() / 3, -1), open;
  const auto label = [&](std::int32_t t, std::int32_t of) {
    if (labels[t] < 0) {
      labels[t] = of;
      open.push_back(t);
    } else if (!have_same_attributes(labels[t], of)) {
      throw Error(ErrorKind::input,
                  fmt::format("triangles {} and {} of the mesh that is to be refined lie on each other",
                              labels[t], of));
    }
  };
  std::vector<bool> is_border(beside.size() / 2, false);
  const std::size_t first = constraints_.segment_count - border_.size();
  for (std::size_t i = 0; i < border_.size(); ++i) {
    const auto c = static_cast<std::size_t>(border_[i]);
    // Edges run from the lexicographically smaller end of the segment.
    const auto [from, to] = mesh::edge_opposite(triangles_, c);
    const bool is_turned = kernel::comes_before(point(coordinates, to), point(coordinates, from));
    for (std::int32_t p = result.piece_offsets[first + i]; p < result.piece_offsets[first + i + 1]; ++p) {
      for (std::int32_t e = result.piece_edges[2 * p]; e < result.piece_edges[2 * p + 1]; ++e) {
        is_border[e] = true;
        const std::int32_t left = beside[is_turned ? 2 * e + 1 : 2 * e],
                           right = beside[is_turned ? 2 * e : 2 * e + 1];
        if (left >= 0) label(left, border_[i] / 3);
        if (right >= 0 && neighbors_[c] >= 0) label(right, neighbors_[c]);
      }
    }
  }
  while (!open.empty()) {
    const auto t = static_cast<std::size_t>(open.back());
    open.pop_back();
    for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
      if (result.neighbors[c] < 0) continue;
      if (result.constrained[c] != 0 && is_border[edge_at(c)]) continue;
      label(result.neighbors[c], labels[t]);
    }
  }
  return labels;
}

// Walks on the straight line from a vertex to a place. Returns the triangle there, or -1 if no triangle at
// the vertex is on that side.
std::int32_t GivenMesh::triangle_with(Point place, std::int32_t vertex) const {
  const geometry::Predicates predicates{scaling_.bounds};
  const Point from = points_[vertex];
  for (std::int32_t i = first_corner_[vertex]; i < first_corner_[vertex + 1]; ++i) {
    auto corner = static_cast<std::size_t>(corners_at_[i]);
    auto [a, b] = mesh::edge_opposite(triangles_, corner);
    if (predicates.orient(from, points_[a], place) < 0 || predicates.orient(from, place, points_[b]) <= 0)
      continue;
    for (std::size_t steps = 0; steps < given_.count; ++steps) {
      const std::int32_t beyond = neighbors_[corner];
      if (beyond < 0 || predicates.orient(points_[a], points_[b], place) >= 0) break;
      // The next side of the line is at the corner beyond.
      corner = 3 * static_cast<std::size_t>(beyond);
      while (triangles_[corner] == a || triangles_[corner] == b) ++corner;
      const std::int32_t apex = triangles_[corner];
      const bool is_left = predicates.orient(from, place, points_[apex]) > 0;
      const std::int32_t gone = is_left ? b : a;
      (is_left ? b : a) = apex;
      corner = 3 * static_cast<std::size_t>(beyond);
      while (triangles_[corner] != gone) ++corner;
    }
    return static_cast<std::int32_t>(corner / 3);
  }
  return -1;
}

// The area given for the triangle that contains the centroid of another one.
double GivenMesh::area_for(const double* coordinates, const std::int32_t* corners) const {
  std::array<std::pair<Point, std::int32_t>, 3> ordered;
  for (std::size_t k = 0; k < 3; ++k) ordered[k] = {point(coordinates, corners[k]), corners[k]};
  std::sort(ordered.begin(), ordered.end(),
            [](const auto& p, const auto& q) { return kernel::comes_before(p.first, q.first) != 0; });
  const auto& [p, q, r] = ordered;
  const Point centroid = {(p.first.x + q.first.x + r.first.x) / 3, (p.first.y + q.first.y + r.first.y) / 3};
  for (const auto& [place, v] : ordered) {
    // Points that splitting added are no corners of the mesh.
    if (static_cast<std::size_t>(v) >= points_.size()) continue;
    const std::int32_t t = triangle_with(centroid, v);
    if (t >= 0) return given_.areas[t];
  }
  return 0;
}

std::vector<double> GivenMesh::leave(const double* coordinates, ConstrainedTriangulation& result,
                                     Ids& seeds) const {
  Ids labels = labels_of(coordinates, result);
  std::vector<bool> is_left;
  for (const std::int32_t label : labels) is_left.push_back(label >= 0);
  mesh::keep(is_left, 1, result.triangle_attributes);
  mesh::keep(is_left, 1, seeds);
  mesh::keep(is_left, 1, labels);
  leave_only(is_left, result);
  std::vector<double> areas;
  if (given_.areas != nullptr) {
    for (std::size_t t = 0; t < labels.size(); ++t)
      areas.push_back(area_for(coordinates, &result.triangles[3 * t]));
  }
  if (given_.attributes != nullptr) {
    for (const std::int32_t label : labels) result.triangle_attributes.push_back(given_.attributes[label]);
  }
  return areas;
}

}  // namespace flaunay::constrained
