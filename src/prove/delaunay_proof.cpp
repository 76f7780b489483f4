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
#include "prove/delaunay_proof.hpp"

#include "prove/checker.hpp"

namespace flaunay {
namespace {

using prove::Checker;
using prove::is_same_place;
using prove::kNone;
using prove::Vertex;
using prove::violate;

class DelaunayChecker : public Checker {
 public:
  using Checker::Checker;

  VerifyReport run() {
    prove::run_checks(report_, [this] {
      check_form();
      check_coordinates();
      check_indices();
      sort_points();
      if (report_.triangles == 0) {
        check_collinear();
        return;
      }
      check_orientations();
      check_representatives();
      check_use_of_points();
      match_half_edges();
      check_boundary();
      check_circles();
      prove::check_count(report_);
      check_neighbors();
    });
    report_.exact_evaluations = predicates_.exact_evaluations();
    return report_;
  }

 private:
  /// No triangles: right if and only if all points are collinear. (If there are triangles then the points are
  /// not collinear, or a triangle is degenerate.)
  void check_collinear() {
    report_.hull_vertices = report_.distinct_points;
    if (report_.distinct_points < 3) return;
    const Vertex &first = sorted_.front(), &last = sorted_.back();
    for (std::size_t i = 0; i < n_; ++i) {
      if (predicates_.orient2d(first.at, last.at, point(i)) != 0) {
        violate("there are no triangles, but the points are not all collinear: {}, {}, {}", describe(first),
                describe(last), describe_point(i));
      }
    }
  }

  /// One index of every group of duplicates must be used.
  void check_use_of_points() const {
    std::size_t smallest_unused = n_;
    for (std::size_t begin = 0, end = 0; begin < n_; begin = end) {
      bool is_used = false;
      for (end = begin; end == begin || (end < n_ && !starts_group(end)); ++end) {
        is_used = is_used || used_[sorted_[end].id] != 0;
      }
      // The first of a group has its smallest index.
      if (!is_used) smallest_unused = std::min<std::size_t>(smallest_unused, sorted_[begin].id);
    }
    if (smallest_unused < n_) violate("{} is in no triangle", describe_point(smallest_unused));
  }

  /// The half-edges without twin must form one closed cycle, convex and counter-clockwise (points on its
  /// edges allowed): all turns left or straight on, lexicographically ascending up to the last point, then
  /// descending, so that it goes around once. (It encloses the sum of the triangles' areas, so it cannot be
  /// flat.)
  void check_boundary() {
    std::vector<std::int64_t> outgoing(n_, kNone);
    std::size_t boundary_edges = 0;
    for (std::size_t h = 0; h < twins_.size(); ++h) {
      if (twins_[h] != kNone) continue;
      if (outgoing[origin(h)] != kNone) {
        violate("the boundary touches itself at {}, a corner of {} and of triangle {}",
                describe_point(origin(h)), describe_row(h / 3), outgoing[origin(h)] / 3);
      }
      outgoing[origin(h)] = static_cast<std::int64_t>(h);
      ++boundary_edges;
    }
    report_.hull_vertices = boundary_edges;

    // As many half-edges without twin end at a point as begin there, so following them leads back to the
    // start.
    std::size_t start = sorted_[0].id;
    for (std::size_t i = 0; i < n_ && is_same_place(sorted_[i], sorted_[0]); ++i) {
      if (outgoing[sorted_[i].id] != kNone) start = sorted_[i].id;
    }
    if (outgoing[start] == kNone) {
      violate("{} is the lexicographically smallest but not on the boundary", describe(sorted_[0]));
    }
    std::vector<std::size_t> cycle;
    std::vector<char> visited(n_, 0);
    for (std::size_t v = start; !visited[v]; v = target(static_cast<std::size_t>(outgoing[v]))) {
      visited[v] = 1;
      cycle.push_back(v);
    }
    for (std::size_t h = 0; cycle.size() < boundary_edges && h < twins_.size(); ++h) {
      if (twins_[h] == kNone && !visited[origin(h)]) {
        violate(
            "the edge from point {} to point {} of {} has no triangle beyond it, but is not on the outer "
            "boundary: a hole, or a separate piece",
            origin(h), target(h), describe_row(h / 3));
      }
    }

    const auto following = [&cycle](std::size_t i) { return cycle[i + 1 == cycle.size() ? 0 : i + 1]; };
    for (std::size_t i = 0; i < cycle.size(); ++i) {
      const std::size_t before = cycle[i], at = following(i),
                        after = target(static_cast<std::size_t>(outgoing[at]));
      if (predicates_.orient2d(point(before), point(at), point(after)) < 0) {
        violate("the boundary is not convex at {}, between {} and {}", describe_point(at),
                describe_point(before), describe_point(after));
      }
    }
    bool ascending = true;
    for (std::size_t i = 0; i < cycle.size(); ++i) {
      const Vertex at = vertex(cycle[i]), after = vertex(following(i));
      if (is_same_place(at, sorted_.back())) ascending = false;
      if (is_before(at, after) != ascending) {
        violate("the boundary goes around more than once: it turns back at {}, before {}", describe(at),
                describe(after));
      }
    }
  }

  void check_circles() {
    for (std::size_t h = 0; h < twins_.size(); ++h) {
      // Smaller twins: on the boundary, or checked from the other side.
      if (twins_[h] > static_cast<std::int64_t>(h)) check_circle(h);
    }
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
