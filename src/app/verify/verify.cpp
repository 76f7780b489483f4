// Why the checks together are complete, for points that are not all collinear:
//
// 1. Every triangle is counter-clockwise, every directed edge occurs at most once, and the edges without a
// twin
//    form one convex counter-clockwise polygon. The sum of the triangles' oriented boundaries is then that
//    polygon, so every point in general position is covered as often as the polygon winds around it: once
//    inside, never outside. The triangles tile a convex polygon.
// 2. Every distinct point is a corner, so no point lies inside a triangle or on an edge that does not end
// there,
//    and the polygon is the convex hull. With 1: a triangulation of the points.
// 3. Every interior edge is locally Delaunay; by Delaunay's lemma ("Sur la sphère vide", 1934) the whole is.
#include "app/verify/verify.hpp"

#include "app/verify/checker.hpp"

namespace flaunay {
namespace {

using verification::Checker;
using verification::kNone;

class DelaunayChecker : public Checker {
 public:
  using Checker::Checker;

  VerifyReport run() {
    report_.ok = check_form() && check_coordinates() && check_indices();
    if (report_.ok) {
      sort_points();
      if (report_.triangles == 0) {
        report_.ok = check_collinear();
      } else {
        report_.ok = check_orientations() && check_representatives() && check_use_of_points() &&
                     match_half_edges() && check_boundary() && check_circles() && check_count();
      }
    }
    if (report_.ok && neighbors_ != nullptr) report_.ok = check_neighbors();
    report_.exact_evaluations = predicates_.exact_evaluations();
    return report_;
  }

 private:
  /// No triangles: right if and only if all points are collinear. (If there are triangles then the points are
  /// not collinear, or a triangle is degenerate.)
  bool check_collinear() {
    report_.hull_vertices = report_.distinct_points;
    if (report_.distinct_points < 3) return true;
    const std::size_t first = sorted_.front().index, last = sorted_.back().index;
    for (std::size_t i = 0; i < n_; ++i) {
      if (predicates_.orient2d(point(first), point(last), point(i)) != 0) {
        return fail("there are no triangles, but the points are not all collinear: {}, {}, {}",
                    describe_point(first), describe_point(last), describe_point(i));
      }
    }
    return true;
  }

  /// Of every group of duplicates one index must be used.
  bool check_use_of_points() {
    std::size_t smallest_unused = n_;
    for (std::size_t begin = 0, end = 0; begin < n_; begin = end) {
      bool is_used = false;
      std::size_t smallest = n_;
      for (end = begin; end == begin || (end < n_ && !starts_group(end)); ++end) {
        is_used = is_used || used_[sorted_[end].index] != 0;
        smallest = std::min(smallest, sorted_[end].index);
      }
      if (!is_used) smallest_unused = std::min(smallest_unused, smallest);
    }
    if (smallest_unused < n_) return fail("{} is in no triangle", describe_point(smallest_unused));
    return true;
  }

  /// The half-edges without twin must form one closed cycle, convex and counter-clockwise (points on its
  /// edges allowed): all turns left or straight on, lexicographically ascending up to the last point, then
  /// descending, so that it goes around once. (It encloses the sum of the triangles' areas, so it cannot be
  /// flat.)
  bool check_boundary() {
    std::vector<std::int64_t> outgoing(n_, kNone);
    std::size_t boundary_edges = 0;
    for (std::size_t h = 0; h < twins_.size(); ++h) {
      if (twins_[h] != kNone) continue;
      if (outgoing[origin(h)] != kNone) {
        return fail("the boundary touches itself at {}, a corner of {} and of triangle {}",
                    describe_point(origin(h)), describe_triangle(h / 3), outgoing[origin(h)] / 3);
      }
      outgoing[origin(h)] = static_cast<std::int64_t>(h);
      ++boundary_edges;
    }
    report_.hull_vertices = boundary_edges;

    // As many half-edges without twin end at a point as begin there, so following them leads back to the
    // start.
    std::size_t start = sorted_[0].index;
    for (std::size_t i = 0; i < n_ && sorted_[i].x == sorted_[0].x && sorted_[i].y == sorted_[0].y; ++i) {
      if (outgoing[sorted_[i].index] != kNone) start = sorted_[i].index;
    }
    if (outgoing[start] == kNone) {
      return fail("{} is the lexicographically smallest but not on the boundary",
                  describe_point(sorted_[0].index));
    }
    std::vector<std::size_t> cycle;
    std::vector<char> visited(n_, 0);
    for (std::size_t v = start; !visited[v]; v = target(static_cast<std::size_t>(outgoing[v]))) {
      visited[v] = 1;
      cycle.push_back(v);
    }
    for (std::size_t h = 0; cycle.size() < boundary_edges && h < twins_.size(); ++h) {
      if (twins_[h] == kNone && !visited[origin(h)]) {
        return fail(
            "the edge from point {} to point {} of {} has no triangle beyond it, but is not on the outer "
            "boundary: a hole, or a separate piece",
            origin(h), target(h), describe_triangle(h / 3));
      }
    }

    const auto following = [&cycle](std::size_t i) { return cycle[i + 1 == cycle.size() ? 0 : i + 1]; };
    for (std::size_t i = 0; i < cycle.size(); ++i) {
      const std::size_t before = cycle[i], at = following(i),
                        after = target(static_cast<std::size_t>(outgoing[at]));
      if (predicates_.orient2d(point(before), point(at), point(after)) < 0) {
        return fail("the boundary is not convex at {}, between {} and {}", describe_point(at),
                    describe_point(before), describe_point(after));
      }
    }
    const SortedPoint& last = sorted_.back();
    bool ascending = true;
    for (std::size_t i = 0; i < cycle.size(); ++i) {
      const double *at = point(cycle[i]), *after = point(following(i));
      if (at[0] == last.x && at[1] == last.y) ascending = false;
      const bool ascends = at[0] < after[0] || (at[0] == after[0] && at[1] < after[1]);
      if (ascends != ascending) {
        return fail("the boundary goes around more than once: it turns back at {}, before {}",
                    describe_point(cycle[i]), describe_point(following(i)));
      }
    }
    return true;
  }

  bool check_circles() {
    for (std::size_t h = 0; h < twins_.size(); ++h) {
      bool is_tie = false;
      // On the boundary, or checked from the other side.
      if (twins_[h] < static_cast<std::int64_t>(h)) continue;
      if (!check_circle(h, is_tie)) return false;
    }
    return true;
  }

  /// Euler's formula. Follows from the checks before; a safeguard against an error in them.
  bool check_count() {
    const std::size_t expected = 2 * report_.distinct_points - 2 - report_.hull_vertices;
    if (report_.triangles == expected) return true;
    return fail("there are {} triangles, but {} distinct points with {} on the boundary must have {}",
                report_.triangles, report_.distinct_points, report_.hull_vertices, expected);
  }
};

}  // namespace

VerifyReport verify(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& triangles) {
  return DelaunayChecker(coordinates, n, triangles, nullptr).run();
}

VerifyReport verify(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& triangles,
                    const std::vector<std::int32_t>& neighbors) {
  return DelaunayChecker(coordinates, n, triangles, &neighbors).run();
}

}  // namespace flaunay
