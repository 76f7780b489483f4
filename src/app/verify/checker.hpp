// What the checks of Delaunay triangulations and of constrained ones have in common.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "app/verify/exact.hpp"
#include "app/verify/verify.hpp"

namespace flaunay::verification {

constexpr std::int64_t kNone = -1;

/// Checks that are run one after the other; each returns false, with report_.problem set, at the first
/// violation. Loops go by triangle (or point) index, so that the first violation is the one with the smallest
/// index.
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

 protected:
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

  bool check_orientations() {
    for (std::size_t t = 0; t < report_.triangles; ++t) {
      const int turn = predicates_.orient2d(point(corners_[3 * t]), point(corners_[3 * t + 1]),
                                            point(corners_[3 * t + 2]));
      if (turn < 0) return fail("{} is clockwise", describe_triangle(t));
      if (turn == 0) return fail("{} is degenerate: its corners are collinear", describe_triangle(t));
    }
    return true;
  }

  /// Of every group of duplicates at most one index may be used, and the same in all triangles.
  bool check_representatives() {
    mark_used_points();
    for (std::size_t begin = 0, end = 0; begin < n_; begin = end) {
      std::size_t uses = 0;
      for (end = begin; end == begin || (end < n_ && !starts_group(end)); ++end) {
        uses += used_[sorted_[end].index];
      }
      if (uses > 1) return explain_two_representatives();
    }
    return true;
  }

  void mark_used_points() {
    used_.assign(n_, 0);
    for (const std::int32_t corner : corners_) used_[corner] = 1;
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

  /// The edge between two triangles must be locally Delaunay: the corner beyond it not inside the circle of
  /// the triangle on this side. is_tie: whether it is on the circle.
  bool check_circle(std::size_t h, bool& is_tie) {
    const std::size_t t = h / 3;
    const std::int32_t beyond = corners_[twins_[h]];
    const int side = predicates_.incircle(point(corners_[3 * t]), point(corners_[3 * t + 1]),
                                          point(corners_[3 * t + 2]), point(beyond));
    if (side > 0) {
      return fail("{} is not Delaunay: its circle contains {}, a corner of triangle {}", describe_triangle(t),
                  describe_point(beyond), twins_[h] / 3);
    }
    is_tie = side == 0;
    report_.cocircular_edges += side == 0;
    return true;
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
  std::vector<char> used_;           // by point: whether it is a corner
  std::vector<std::int64_t> twins_;  // of each half-edge: the one that runs the other way, or kNone
};

}  // namespace flaunay::verification
