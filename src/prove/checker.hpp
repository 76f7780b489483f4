// Checks that the proofs of Delaunay triangulations and of constrained ones share.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "prove/delaunay_proof.hpp"
#include "prove/describe.hpp"
#include "prove/exact.hpp"
#include "prove/half_edges.hpp"

namespace flaunay::prove {

constexpr std::int64_t kNone = -1;

/// Checks that are run one after the other; the first violation ends them. Loops go by triangle (or point)
/// index, so that it is the one with the smallest index.
class Checker {
 public:
  Checker(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& triangles,
          const std::vector<std::int32_t>* neighbors)
      : coordinates_(coordinates), n_(n), corners_(triangles), neighbors_(neighbors) {
    report_.points = n;
    report_.triangles = triangles.size() / 3;
  }

 protected:
  const double* point(std::size_t i) const { return coordinates_ + 2 * i; }
  Vertex vertex(std::size_t i) const { return {i, {point(i)[0], point(i)[1]}}; }
  std::int32_t origin(std::size_t half_edge) const { return half_edges_.origin(half_edge); }
  std::int32_t target(std::size_t half_edge) const { return half_edges_.target(half_edge); }

  std::string describe_point(std::size_t i) const { return describe(vertex(i)); }
  std::string describe_row(std::size_t t) const {
    return describe_triangle(t, vertex(corners_[3 * t]), vertex(corners_[3 * t + 1]),
                             vertex(corners_[3 * t + 2]));
  }

  void check_form() const {
    if (corners_.size() % 3 != 0) {
      violate("the triangles are {} indices, which is not a multiple of 3", corners_.size());
    }
    if (report_.triangles >= std::uint64_t{1} << 32) {
      violate("there are {} triangles, more than 32-bit indices of points allow", report_.triangles);
    }
    if (neighbors_ != nullptr && neighbors_->size() != corners_.size()) {
      violate("there are {} neighbors, but there should be 3 for each of the {} triangles",
              neighbors_->size(), report_.triangles);
    }
  }

  void check_coordinates() const {
    for (std::size_t i = 0; i < n_; ++i) {
      if (!std::isfinite(point(i)[0]) || !std::isfinite(point(i)[1])) {
        violate("{} is not finite", describe_point(i));
      }
    }
  }

  void check_indices() const {
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (corners_[i] < 0 || static_cast<std::size_t>(corners_[i]) >= n_) {
        violate("triangle {} has a corner {}, which is not the index of one of the {} points", i / 3,
                corners_[i], n_);
      }
    }
  }

  /// Sorts the points lexicographically, duplicates side by side.
  void sort_points() {
    sorted_.resize(n_);
    for (std::size_t i = 0; i < n_; ++i) sorted_[i] = vertex(i);
    std::sort(sorted_.begin(), sorted_.end(), [](const Vertex& a, const Vertex& b) {
      return is_same_place(a, b) ? a.id < b.id : is_before(a, b);
    });
    for (std::size_t i = 0; i < n_; ++i) report_.distinct_points += starts_group(i);
  }

  /// Whether the i-th point in order is the first at its place.
  bool starts_group(std::size_t i) const { return i == 0 || !is_same_place(sorted_[i], sorted_[i - 1]); }

  void check_orientations() {
    for (std::size_t t = 0; t < report_.triangles; ++t) {
      const int turn = predicates_.orient2d(point(corners_[3 * t]), point(corners_[3 * t + 1]),
                                            point(corners_[3 * t + 2]));
      if (turn < 0) violate("{} is clockwise", describe_row(t));
      if (turn == 0) violate("{} is degenerate: its corners are collinear", describe_row(t));
    }
  }

  /// All triangles must use the same index, at most one, of each group of duplicates.
  void check_representatives() {
    used_.assign(n_, 0);
    for (const std::int32_t corner : corners_) used_[corner] = 1;
    for (std::size_t begin = 0, end = 0; begin < n_; begin = end) {
      std::size_t uses = 0;
      for (end = begin; end == begin || (end < n_ && !starts_group(end)); ++end) {
        uses += used_[sorted_[end].id];
      }
      if (uses > 1) explain_two_representatives();
    }
  }

  void explain_two_representatives() const {
    std::vector<std::size_t> group(n_);
    for (std::size_t i = 0, begin = 0; i < n_; ++i) {
      if (starts_group(i)) begin = i;
      group[sorted_[i].id] = begin;
    }
    std::vector<std::int64_t> first_use(n_, kNone);  // of each group, among the corners
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      std::int64_t& use = first_use[group[corners_[i]]];
      if (use == kNone) use = static_cast<std::int64_t>(i);
      if (corners_[use] != corners_[i]) {
        violate("{} uses point {}, but triangle {} uses its duplicate, point {}", describe_row(i / 3),
                corners_[i], use / 3, corners_[use]);
      }
    }
  }

  /// Finds the twin of every half-edge; a directed edge must not occur twice.
  void match_half_edges() {
    const auto count = static_cast<std::int64_t>(corners_.size());
    std::vector<std::int64_t> begins(n_ + 1);
    std::vector<std::uint64_t> keys(corners_.size());
    twins_.resize(corners_.size());
    const std::int64_t repeated = half_edges_.match(count, n_, begins.data(), keys.data(), twins_.data());
    if (repeated == count) return;
    violate("{} has the edge from point {} to point {}, which {} has too", describe_row(repeated / 3),
            origin(repeated), target(repeated), describe_row(half_edges_.first_like(repeated) / 3));
  }

  /// The edge between two triangles must be locally Delaunay: the corner beyond it not inside the circle of
  /// the triangle on this side. Returns whether it is on the circle.
  bool check_circle(std::size_t h) {
    const std::size_t t = h / 3;
    const std::int32_t beyond = corners_[twins_[h]];
    const int side = predicates_.incircle(point(corners_[3 * t]), point(corners_[3 * t + 1]),
                                          point(corners_[3 * t + 2]), point(beyond));
    if (side > 0) {
      violate("{} is not Delaunay: its circle contains {}, a corner of triangle {}", describe_row(t),
              describe_point(beyond), twins_[h] / 3);
    }
    report_.cocircular_edges += side == 0;
    return side == 0;
  }

  void check_neighbors() const {
    for (std::size_t h = 0; neighbors_ != nullptr && h < twins_.size(); ++h) {
      const std::int64_t expected = twins_[h] == kNone ? kNone : twins_[h] / 3;
      if ((*neighbors_)[h] != expected) {
        violate("{} has neighbor {} opposite to point {}, but it should be {}", describe_row(h / 3),
                (*neighbors_)[h], corners_[h], expected);
      }
    }
  }

  const double* coordinates_;
  std::size_t n_;
  const std::vector<std::int32_t>& corners_;
  const std::vector<std::int32_t>* neighbors_;
  HalfEdges<std::int32_t, std::int64_t> half_edges_{corners_.data()};
  VerifyReport report_;
  ExactPredicates predicates_;
  std::vector<Vertex> sorted_;
  std::vector<char> used_;           // by point: whether it is a corner
  std::vector<std::int64_t> twins_;  // of each half-edge: the one that runs the other way, or kNone
};

}  // namespace flaunay::prove
