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
#include "verify/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "verify/exact.hpp"

namespace flaunay {
namespace {

constexpr std::int64_t kNone = -1;

/// Runs the checks one after the other; each returns false, with report_.problem set, at the first violation.
/// Loops go by triangle (or point) index, so that the first violation is the one with the smallest index.
///
/// Half-edge 3 t + k is the side of triangle t opposite to its corner k: from corner k + 1 to corner k + 2.
class Checker {
 public:
  Checker(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& triangles,
          const std::vector<std::int32_t>* neighbors)
      : coordinates_(coordinates), n_(n), corners_(triangles), neighbors_(neighbors) {
    report_.points = n;
    report_.triangles = triangles.size() / 3;
  }

  VerifyReport run() {
    report_.ok = check_form() && check_coordinates() && check_indices();
    if (report_.ok) {
      sort_points();
      if (report_.triangles == 0) {
        report_.ok = check_collinear();
      } else {
        report_.ok = check_orientations() && check_use_of_points() && match_half_edges() &&
                     check_boundary() && check_circles() && check_count();
      }
    }
    if (report_.ok && neighbors_ != nullptr) report_.ok = check_neighbors();
    report_.exact_evaluations = predicates_.exact_evaluations();
    return report_;
  }

 private:
  struct SortedPoint {
    double x, y;
    std::size_t index;
    bool operator<(const SortedPoint& other) const {
      if (x != other.x) return x < other.x;
      if (y != other.y) return y < other.y;
      return index < other.index;
    }
  };

  const double* point(std::size_t i) const { return coordinates_ + 2 * i; }
  static std::size_t successor(std::size_t half_edge) {
    return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
  }
  std::int32_t origin(std::size_t half_edge) const { return corners_[successor(half_edge)]; }
  std::int32_t target(std::size_t half_edge) const { return corners_[successor(successor(half_edge))]; }

  std::string describe_place(std::size_t i) const {
    return fmt::format("({}, {})", point(i)[0], point(i)[1]);
  }
  std::string describe_point(std::size_t i) const {
    return fmt::format("point {} at {}", i, describe_place(i));
  }
  std::string describe_triangle(std::size_t t) const {
    const std::int32_t a = corners_[3 * t], b = corners_[3 * t + 1], c = corners_[3 * t + 2];
    return fmt::format("triangle {} with points {}, {}, {} at {}, {}, {}", t, a, b, c, describe_place(a),
                       describe_place(b), describe_place(c));
  }

  template <typename... Arguments>
  bool fail(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    report_.problem = fmt::format(text, std::forward<Arguments>(arguments)...);
    return false;
  }

  bool check_form() {
    if (corners_.size() % 3 != 0) {
      return fail("the triangles are {} indices, which is not a multiple of 3", corners_.size());
    }
    if (report_.triangles >= std::size_t{1} << 32) {
      return fail("there are {} triangles, more than 32-bit indices of points allow", report_.triangles);
    }
    if (neighbors_ != nullptr && neighbors_->size() != corners_.size()) {
      return fail("there are {} neighbors, but there should be 3 for each of the {} triangles",
                  neighbors_->size(), report_.triangles);
    }
    return true;
  }

  bool check_coordinates() {
    for (std::size_t i = 0; i < n_; ++i) {
      if (!std::isfinite(point(i)[0]) || !std::isfinite(point(i)[1])) {
        return fail("{} is not finite", describe_point(i));
      }
    }
    return true;
  }

  bool check_indices() {
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (corners_[i] < 0 || static_cast<std::size_t>(corners_[i]) >= n_) {
        return fail("triangle {} has a corner {}, which is not the index of one of the {} points", i / 3,
                    corners_[i], n_);
      }
    }
    return true;
  }

  /// Sorts the points lexicographically, duplicates side by side.
  void sort_points() {
    sorted_.resize(n_);
    for (std::size_t i = 0; i < n_; ++i) sorted_[i] = {point(i)[0], point(i)[1], i};
    std::sort(sorted_.begin(), sorted_.end());
    for (std::size_t i = 0; i < n_; ++i) report_.distinct_points += starts_group(i);
  }

  /// Whether the i-th point in order is the first at its place.
  bool starts_group(std::size_t i) const {
    return i == 0 || sorted_[i].x != sorted_[i - 1].x || sorted_[i].y != sorted_[i - 1].y;
  }

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

  bool check_orientations() {
    for (std::size_t t = 0; t < report_.triangles; ++t) {
      const int turn = predicates_.orient2d(point(corners_[3 * t]), point(corners_[3 * t + 1]),
                                            point(corners_[3 * t + 2]));
      if (turn < 0) return fail("{} is clockwise", describe_triangle(t));
      if (turn == 0) return fail("{} is degenerate: its corners are collinear", describe_triangle(t));
    }
    return true;
  }

  /// Of every group of duplicates exactly one index must be used, and the same in all triangles.
  bool check_use_of_points() {
    std::vector<char> used(n_, 0);
    for (const std::int32_t corner : corners_) used[corner] = 1;
    bool two_representatives = false;
    std::size_t smallest_unused = n_;
    for (std::size_t begin = 0, end = 0; begin < n_; begin = end) {
      std::size_t uses = 0, smallest = n_;
      for (end = begin; end == begin || (end < n_ && !starts_group(end)); ++end) {
        uses += used[sorted_[end].index];
        smallest = std::min(smallest, sorted_[end].index);
      }
      if (uses == 0) smallest_unused = std::min(smallest_unused, smallest);
      if (uses > 1) two_representatives = true;
    }
    if (two_representatives) return explain_two_representatives();
    if (smallest_unused < n_) return fail("{} is in no triangle", describe_point(smallest_unused));
    return true;
  }

  bool explain_two_representatives() {
    std::vector<std::size_t> group(n_);
    for (std::size_t i = 0, begin = 0; i < n_; ++i) {
      if (starts_group(i)) begin = i;
      group[sorted_[i].index] = begin;
    }
    std::vector<std::int64_t> first_use(n_,
                                        kNone);  // of each group: where its first use is among the corners
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      std::int64_t& use = first_use[group[corners_[i]]];
      if (use == kNone) use = static_cast<std::int64_t>(i);
      if (corners_[use] != corners_[i]) {
        return fail("{} uses point {}, but triangle {} uses its duplicate, point {}",
                    describe_triangle(i / 3), corners_[i], use / 3, corners_[use]);
      }
    }
    return true;  // not reached: the caller found a group with two used indices
  }

  /// Finds the twin of every half-edge; a directed edge must not occur twice.
  ///
  /// Half-edges are collected by their smaller end point (counting sort), and sorted there by the other end,
  /// direction and triangle. These and the triangle identify a half-edge and fit into 31 + 1 + 32 bits.
  bool match_half_edges() {
    std::vector<std::size_t> begins(n_ + 1, 0);
    for (std::size_t h = 0; h < corners_.size(); ++h) ++begins[std::min(origin(h), target(h))];
    std::size_t sum = 0;
    for (std::size_t& begin : begins) {
      const std::size_t count = begin;
      begin = sum;
      sum += count;
    }
    std::vector<std::uint64_t> keys(corners_.size());
    for (std::size_t h = 0; h < corners_.size(); ++h) {
      const std::int32_t smaller = std::min(origin(h), target(h)), larger = std::max(origin(h), target(h));
      const std::uint64_t downward = origin(h) == larger ? 1 : 0;
      keys[begins[smaller]++] = static_cast<std::uint64_t>(larger) << 33 | downward << 32 | h / 3;
    }

    twins_.assign(corners_.size(), kNone);
    std::size_t repeated = corners_.size();  // the first half-edge that repeats one of a triangle before
    std::size_t begin = 0;
    for (std::size_t v = 0; v < n_; ++v) {
      const std::size_t end = begins[v];  // filling moved it there
      std::sort(keys.begin() + begin, keys.begin() + end);
      for (std::size_t i = begin; i + 1 < end; ++i) {
        if (keys[i] >> 32 == keys[i + 1] >> 32) {
          repeated = std::min(repeated, half_edge_of(keys[i + 1], v));
        } else if (keys[i] >> 33 == keys[i + 1] >> 33) {
          const std::size_t upward = half_edge_of(keys[i], v), downward = half_edge_of(keys[i + 1], v);
          twins_[upward] = static_cast<std::int64_t>(downward);
          twins_[downward] = static_cast<std::int64_t>(upward);
        }
      }
      begin = end;
    }
    if (repeated < corners_.size()) return explain_repeated(repeated);
    return true;
  }

  /// The half-edge that has this key among those whose smaller end point is v.
  std::size_t half_edge_of(std::uint64_t key, std::size_t v) const {
    const std::size_t t = key & 0xffffffffu;
    const bool downward = (key >> 32 & 1) != 0;
    for (std::size_t h = 3 * t; h < 3 * t + 2; ++h) {
      if (static_cast<std::size_t>(downward ? target(h) : origin(h)) == v) return h;
    }
    return 3 * t + 2;
  }

  bool explain_repeated(std::size_t half_edge) {
    for (std::size_t h = 0; h < half_edge; ++h) {
      if (origin(h) == origin(half_edge) && target(h) == target(half_edge)) {
        return fail("{} has the edge from point {} to point {}, which {} has too",
                    describe_triangle(half_edge / 3), origin(half_edge), target(half_edge),
                    describe_triangle(h / 3));
      }
    }
    return true;  // not reached: the caller found an earlier one
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

  /// Every interior edge must be locally Delaunay: the corner beyond it not inside the triangle's circle.
  bool check_circles() {
    for (std::size_t h = 0; h < twins_.size(); ++h) {
      if (twins_[h] < static_cast<std::int64_t>(h))
        continue;  // on the boundary, or checked from the other side
      const std::size_t t = h / 3;
      const std::int32_t beyond = corners_[twins_[h]];
      const int side = predicates_.incircle(point(corners_[3 * t]), point(corners_[3 * t + 1]),
                                            point(corners_[3 * t + 2]), point(beyond));
      if (side > 0) {
        return fail("{} is not Delaunay: its circle contains {}, a corner of triangle {}",
                    describe_triangle(t), describe_point(beyond), twins_[h] / 3);
      }
      report_.cocircular_edges += side == 0;
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

  bool check_neighbors() {
    for (std::size_t h = 0; h < twins_.size(); ++h) {
      const std::int64_t expected = twins_[h] == kNone ? kNone : twins_[h] / 3;
      if ((*neighbors_)[h] != expected) {
        return fail("{} has neighbor {} opposite to point {}, but it should be {}", describe_triangle(h / 3),
                    (*neighbors_)[h], corners_[h], expected);
      }
    }
    return true;
  }

  const double* coordinates_;
  std::size_t n_;
  const std::vector<std::int32_t>& corners_;
  const std::vector<std::int32_t>* neighbors_;
  VerifyReport report_;
  ExactPredicates predicates_;
  std::vector<SortedPoint> sorted_;
  std::vector<std::int64_t> twins_;  // of each half-edge: the one that runs the other way, or kNone
};

}  // namespace

VerifyReport verify(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& triangles) {
  return Checker(coordinates, n, triangles, nullptr).run();
}

VerifyReport verify(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& triangles,
                    const std::vector<std::int32_t>& neighbors) {
  return Checker(coordinates, n, triangles, &neighbors).run();
}

}  // namespace flaunay
