#include "tests/constrained/sequential/insert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>
#include <utility>

#include "constrained/crossings/segment_set.hpp"
#include "geometry/magnitudes.hpp"
#include "mesh/barycentric.h"
#include "tests/constrained/sequential/constraints.hpp"
#include "tests/constrained/sequential/mesh.hpp"

namespace flaunay::sequential {
using namespace geometry;

namespace {

using Ids = std::vector<std::int32_t>;

struct ScaledPoints {
  std::vector<Point> points;
  Predicates predicates;
  SetScalings scalings;
};

ScaledPoints scale_points(const double* coordinates, const std::vector<std::size_t>& offsets) {
  ScaledPoints scaled;
  scaled.scalings = set_scalings(coordinates, offsets, [coordinates](std::size_t first, std::size_t last) {
    return inspect(coordinates, first, last);
  });
  scaled.predicates.bounds = scaled.scalings.bounds;
  scaled.points.resize(offsets.back());
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    const int shift = scaled.scalings.shift(s);
    for (std::size_t i = offsets[s]; i < offsets[s + 1]; ++i) {
      // Adding 0 turns -0 into 0.
      scaled.points[i] = {std::ldexp(coordinates[2 * i], shift) + 0.0,
                          std::ldexp(coordinates[2 * i + 1], shift) + 0.0};
    }
  }
  return scaled;
}

// A segment between distinct points, the lexicographically smaller one first.
struct Segment {
  std::int32_t from, to;
  std::int32_t index;      // the smallest one of the input
  std::int32_t edge = -1;  // any of its edges
};

// From its lexicographically smaller end to the other one.
Segment oriented(const ScaledPoints& scaled, const Ids& representatives, const Ids& segments,
                 std::int32_t index) {
  const auto s = 2 * static_cast<std::size_t>(index);
  std::int32_t from = representatives[segments[s]], to = representatives[segments[s + 1]];
  if (kernel::comes_before(scaled.points[to], scaled.points[from])) std::swap(from, to);
  return {from, to, index};
}

// Segments without those of length zero, each once. unique_of: per segment of the input, its place here, or
// -1.
std::vector<Segment> unique_segments(const ScaledPoints& scaled, const Ids& representatives,
                                     const Ids& segments, Ids& unique_of) {
  std::vector<Segment> all;
  unique_of.assign(segments.size() / 2, -1);
  for (std::size_t s = 0; s < unique_of.size(); ++s) {
    if (representatives[segments[2 * s]] == representatives[segments[2 * s + 1]]) continue;
    all.push_back(oriented(scaled, representatives, segments, static_cast<std::int32_t>(s)));
  }
  std::sort(all.begin(), all.end(), [](const Segment& a, const Segment& b) {
    return std::tie(a.from, a.to, a.index) < std::tie(b.from, b.to, b.index);
  });
  std::vector<Segment> unique;
  for (const Segment& segment : all) {
    if (unique.empty() || unique.back().from != segment.from || unique.back().to != segment.to) {
      unique.push_back(segment);
    }
    unique_of[segment.index] = static_cast<std::int32_t>(unique.size()) - 1;
  }
  return unique;
}

// A random order in rounds, the last of which has half of the segments, the one before a quarter, and so on;
// in a round, segments are in the order of the triangles at their first ends, which is one of place (Amenta,
// Choi and Rote 2003). The random numbers are always the same.
Ids random_order(const std::vector<Segment>& segments, const Ids& triangles) {
  Ids row(triangles.empty() ? 0 : 1 + *std::max_element(triangles.begin(), triangles.end()), 0);
  for (std::size_t c = 0; c < triangles.size(); ++c) row[triangles[c]] = static_cast<std::int32_t>(c / 3);
  struct Placed {
    std::int32_t round, row, segment;
  };
  std::vector<Placed> placed;
  placed.reserve(segments.size());
  std::mt19937 random;
  for (const Segment& segment : segments) {
    // The number of leading zeros of a random number.
    std::int32_t round = 0;
    for (auto bits = random(); round > -32 && bits < 1u << 31; bits <<= 1) --round;
    const auto from = static_cast<std::size_t>(segment.from);
    placed.push_back({round, from < row.size() ? row[from] : 0, static_cast<std::int32_t>(placed.size())});
  }
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return std::tie(a.round, a.row, a.segment) < std::tie(b.round, b.row, b.segment);
  });
  Ids order(placed.size());
  std::transform(placed.begin(), placed.end(), order.begin(), [](const Placed& p) { return p.segment; });
  return order;
}

// The edges of sets without triangles: between points that follow each other on the line. Empty if all sets
// have some.
struct Lines {
  Ids next, constraints;  // per point: the next one; the constraint between them
};

Lines lines_of(std::size_t points, const Triangulation& delaunay) {
  Lines lines;
  for (std::size_t s = 0; s + 1 < delaunay.triangle_offsets.size(); ++s) {
    if (delaunay.triangle_offsets[s] != delaunay.triangle_offsets[s + 1]) continue;
    if (lines.next.empty()) {
      lines.next.assign(points, -1);
      lines.constraints.assign(points, -1);
    }
    for (std::size_t k = delaunay.hull_offsets[s] + 1; k < delaunay.hull_offsets[s + 1]; ++k) {
      lines.next[delaunay.hull[k - 1]] = delaunay.hull[k];
    }
  }
  return lines;
}

// Inserts segments into a triangulation.
class Inserter {
 public:
  Inserter(const ScaledPoints& scaled, const Triangulation& delaunay)
      : points_(scaled.points.data()),
        mesh_(scaled.predicates, points_, scaled.points.size(), delaunay),
        constraints_(points_),
        lines_(lines_of(scaled.points.size(), delaunay)) {}

  // Makes a segment a chain of constraints. Returns false, with a part of it done, if it crosses a
  // constraint.
  bool insert(Segment& segment) {
    // What is left of it, and the edges before and after that.
    std::int32_t from = segment.from, to = segment.to, before = -1, after = -1;
    while (from != to) {
      bool at_end = false;
      const std::int32_t edge = insert_piece(from, to, segment.index, at_end);
      if (edge < 0) return false;
      segment.edge = edge;
      // The rest of the edge's chain lies on the segment, too, as far as that goes.
      if (at_end) {
        constraints_.link(edge, after);
        after = constraints_.first_of_chain(edge);
        const std::int32_t v = constraints_.from(after);
        to = comes_before(from, v) ? v : from;
      } else {
        constraints_.link(before, edge);
        before = constraints_.last_of_chain(edge);
        const std::int32_t v = constraints_.to(before);
        from = comes_before(v, to) ? v : to;
      }
    }
    if (before >= 0 && after >= 0) constraints_.link(before, after);
    return true;
  }

  // The smallest index of the segments whose constraints a segment crosses.
  std::int32_t first_crossed(const Segment& segment) {
    std::int32_t first = segment.index;
    for (std::int32_t v = segment.from; v != segment.to;) {
      const Departure departure = mesh_.depart_from(v, segment.to);
      crossed_.clear();
      v = departure.vertex >= 0 ? departure.vertex
                                : mesh_.follow(v, segment.to, departure.halfedge, cavity_, crossed_);
      for (const std::int32_t edge : crossed_) first = std::min(first, constraints_.owner(edge));
    }
    return first;
  }

  const ConstrainedMesh& mesh() const { return mesh_; }
  Constraints& constraints() { return constraints_; }

 private:
  bool comes_before(std::int32_t u, std::int32_t v) const {
    return kernel::comes_before(points_[u], points_[v]);
  }

  // Makes the part of a segment between an end and the next vertex on it a constraint. at_end: whether that
  // is the second end. Returns the constraint, which may be there already, or -1 if the part crosses one.
  std::int32_t insert_piece(std::int32_t from, std::int32_t to, std::int32_t owner, bool& at_end) {
    if (!mesh_.has_triangles(from)) {
      std::int32_t& constraint = lines_.constraints[from];
      if (constraint < 0) constraint = constraints_.add(from, lines_.next[from], owner);
      return constraint;
    }
    Departure departure;
    at_end = mesh_.depart(from, to, departure);
    const std::int32_t start = at_end ? to : from;
    if (departure.vertex >= 0) {
      std::int32_t constraint = mesh_.constraint(departure.halfedge);
      if (constraint < 0) {
        constraint = constraints_.add(start, departure.vertex, owner);
        mesh_.constrain(departure.halfedge, constraint);
      }
      return constraint;
    }
    crossed_.clear();
    const std::int32_t v = mesh_.follow(start, at_end ? from : to, departure.halfedge, cavity_, crossed_);
    if (!crossed_.empty()) return -1;
    const std::int32_t constraint = constraints_.add(start, v, owner);
    mesh_.retriangulate(cavity_, constraint);
    return constraint;
  }

  const Point* points_;
  ConstrainedMesh mesh_;
  Constraints constraints_;
  Lines lines_;
  Cavity cavity_;
  Ids crossed_;
};

// Where two segments cross, rounded: at the ratio of the exact distances of the first one's ends from the
// second.
Point crossing(const ScaledPoints& scaled, int shift, const Segment& first, const Segment& second) {
  const Point a = scaled.points[first.from], b = scaled.points[first.to];
  const Point c = scaled.points[second.from], d = scaled.points[second.to];
  const double before = std::fabs(kernel::area_exact(c, d, a)),
               after = std::fabs(kernel::area_exact(c, d, b));
  const double ratio = before / (before + after);
  return {std::ldexp(a.x + ratio * (b.x - a.x), -shift), std::ldexp(a.y + ratio * (b.y - a.y), -shift)};
}

[[noreturn]] void throw_crossing(const ScaledPoints& scaled, int shift, const Ids& segments,
                                 const Segment& first, const Segment& second) {
  const Point place = crossing(scaled, shift, first, second);
  throw Error(
      ErrorKind::input,
      fmt::format("segments {} (points {} and {}) and {} (points {} and {}) cross near ({:.17g}, {:.17g})",
                  second.index, segments[2 * second.index], segments[2 * second.index + 1], first.index,
                  segments[2 * first.index], segments[2 * first.index + 1], place.x, place.y));
}

// Of segments that cross, names the first one that crosses an earlier one.
[[noreturn]] void report_crossing(const ScaledPoints& scaled, const std::vector<std::size_t>& offsets,
                                  const Triangulation& delaunay, const Ids& segments,
                                  std::vector<Segment> unique) {
  std::sort(unique.begin(), unique.end(),
            [](const Segment& a, const Segment& b) { return a.index < b.index; });
  Inserter inserter(scaled, delaunay);
  for (Segment& segment : unique) {
    if (inserter.insert(segment)) continue;
    const std::int32_t index = inserter.first_crossed(segment);
    const auto other = std::find_if(unique.begin(), unique.end(),
                                    [index](const Segment& candidate) { return candidate.index == index; });
    throw_crossing(scaled, scaled.scalings.shift(constrained::set_of(offsets, segment.from)), segments,
                   segment, *other);
  }
  throw Error(ErrorKind::internal, "segments cross in one order only; please report the input");
}

}  // namespace

Result constrain(const double* coordinates, const std::vector<std::size_t>& offsets,
                 const Triangulation& delaunay, const Ids& segments) {
  check_offsets(offsets);
  check_points(coordinates, offsets.back());
  constrained::check_segments(offsets, segments);
  const ScaledPoints scaled = scale_points(coordinates, offsets);
  Ids unique_of;
  std::vector<Segment> unique = unique_segments(scaled, delaunay.representatives, segments, unique_of);

  Inserter inserter(scaled, delaunay);
  for (const std::int32_t u : random_order(unique, delaunay.triangles)) {
    if (!inserter.insert(unique[u])) report_crossing(scaled, offsets, delaunay, segments, std::move(unique));
  }

  Result result;
  inserter.mesh().write(result.triangles, result.neighbors, result.constrained);
  Constraints& constraints = inserter.constraints();
  constraints.sort();
  result.constraint_edges = constraints.sorted_edges();
  result.piece_edges.assign(segments.size(), 0);
  for (std::size_t s = 0; s < unique_of.size(); ++s) {
    if (unique_of[s] < 0) continue;
    const Segment& segment = unique[unique_of[s]];
    result.piece_edges[2 * s] = constraints.number_from(segment.edge, segment.from);
    result.piece_edges[2 * s + 1] = constraints.number_from(segment.edge, segment.to);
  }
  result.large_polygons = inserter.mesh().polygons().insertions();
  result.repeated_polygons = inserter.mesh().polygons().repetitions();
  return result;
}

}  // namespace flaunay::sequential
