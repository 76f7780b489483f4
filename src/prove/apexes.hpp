// Where constraints meet at less than 60 degrees.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <vector>

#include "prove/exact.hpp"

namespace flaunay::prove {

/// Places of points that refinement has put on edges and rounded, in units in which the largest coordinate is
/// about 1, so that their squares are doubles.
class RoundedPlaces {
 public:
  explicit RoundedPlaces(double largest = 0)
      : scale_(largest > 0 ? -std::ilogb(largest) : 0),
        off_(std::ldexp(largest, scale_) * 0x1p-50 + std::ldexp(1.5, scale_ + kLeastExponent)) {}

  /// How far points may be off the straight line through others that are on one edge with them: each is two
  /// units in the last place of the largest coordinate off at most, or half the smallest double on each axis.
  double off() const { return off_; }
  /// Whether p is as near to the line through a and b.
  bool are_straight(const double* a, const double* b, const double* p) const {
    const Vector ab(*this, a, b), ap(*this, a, p);
    return std::fabs(ab.x * ap.y - ab.y * ap.x) <= off_ * std::hypot(ab.x, ab.y);
  }
  double distance(const double* a, const double* b) const {
    const Vector ab(*this, a, b);
    return std::hypot(ab.x, ab.y);
  }

 private:
  struct Vector {
    double x, y;
    Vector(const RoundedPlaces& places, const double* from, const double* to)
        : x(std::ldexp(to[0], places.scale_) - std::ldexp(from[0], places.scale_)),
          y(std::ldexp(to[1], places.scale_) - std::ldexp(from[1], places.scale_)) {}
  };

  static constexpr int kLeastExponent = -1074;  // of the smallest double

  int scale_;
  double off_;
};

/// Constraints meet at less than 60 degrees if their squared cosine is above this, which is 3e-8 degrees
/// less: so corners of 60 degrees that are rounded do not.
constexpr double kSharp = 0.25 + 0x1p-31;

/// Constraint edges that go on straight, but for the rounding of their points, are one chain.
class Apexes {
 public:
  /// edges: 2 points per edge, each edge once.
  Apexes(const double* coordinates, std::size_t points, const std::vector<std::int32_t>& edges,
         ExactPredicates& predicates)
      : coordinates_(coordinates),
        predicates_(predicates),
        first_edge_(points + 1, 0),
        chains_(edges.size() / 2) {
    for (const std::int32_t v : edges) ++first_edge_[static_cast<std::size_t>(v) + 1];
    std::partial_sum(first_edge_.begin(), first_edge_.end(), first_edge_.begin());
    edges_at_.resize(edges.size());
    double largest = 0;
    std::vector<std::size_t> next(first_edge_.begin(), first_edge_.end() - 1);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      edges_at_[next[edges[i]]++] = {static_cast<std::int32_t>(i / 2), edges[i ^ 1]};
      largest = std::max({largest, std::fabs(point(edges[i])[0]), std::fabs(point(edges[i])[1])});
    }
    places_ = RoundedPlaces(largest);
    std::iota(chains_.begin(), chains_.end(), 0);
    for (std::size_t v = 0; v < points; ++v) join_at(static_cast<std::int32_t>(v));
    junctions_.resize(chains_.size());
    for (std::size_t v = 0; v < points; ++v) {
      const std::vector<std::int32_t> chains = chains_at(static_cast<std::int32_t>(v));
      if (chains.size() < 2) continue;
      for (const std::int32_t chain : chains) junctions_[chain].push_back(static_cast<std::int32_t>(v));
    }
  }

  /// Whether p and q are equally far from a point where chains that they are on meet at less than 60 degrees,
  /// with triangles all the way between. are_triangles_between(apex, a, b): whether there are, from the edge
  /// to a counter-clockwise to that to b.
  template <typename AreTrianglesBetween>
  bool are_shells(std::int32_t p, std::int32_t q, const AreTrianglesBetween& are_triangles_between) {
    for (const std::int32_t of_p : chains_at(p)) {
      for (const std::int32_t of_q : chains_at(q)) {
        if (of_p == of_q) continue;
        std::vector<std::int32_t> common;
        std::set_intersection(junctions_[of_p].begin(), junctions_[of_p].end(), junctions_[of_q].begin(),
                              junctions_[of_q].end(), std::back_inserter(common));
        for (const std::int32_t apex : common) {
          if (apex == p || apex == q || !is_as_far(apex, p, q) ||
              predicates_.compare_cosine(point(apex), point(p), point(q), kSharp) <= 0) {
            continue;
          }
          const std::int32_t to_p = next_towards(apex, of_p, p), to_q = next_towards(apex, of_q, q);
          const bool is_turned = predicates_.orient2d(point(apex), point(p), point(q)) < 0;
          if (to_p != apex && to_q != apex &&
              are_triangles_between(apex, is_turned ? to_q : to_p, is_turned ? to_p : to_q)) {
            return true;
          }
        }
      }
    }
    return false;
  }

 private:
  struct EdgeAt {
    std::int32_t edge, other;
  };

  const double* point(std::int32_t v) const { return coordinates_ + 2 * static_cast<std::size_t>(v); }
  /// Points on constraints are rounded, so their distances are a little more apart than the tolerance of
  /// 1e-3.
  bool is_as_far(std::int32_t apex, std::int32_t p, std::int32_t q) const {
    const double of_p = places_.distance(point(apex), point(p)),
                 of_q = places_.distance(point(apex), point(q));
    return std::max(of_p, of_q) <= 1.0011 * std::min(of_p, of_q) + places_.off();
  }
  /// Where the edge of a chain from one of its points in the direction of another one ends.
  std::int32_t next_towards(std::int32_t v, std::int32_t chain, std::int32_t goal) {
    std::int32_t next = v;
    for (std::size_t i = first_edge_[v]; i < first_edge_[v + 1]; ++i) {
      const bool is_ahead =
          predicates_.compare_cosine(point(v), point(goal), point(edges_at_[i].other), 0) > 0;
      if (is_ahead && chain_of(edges_at_[i].edge) == chain) next = edges_at_[i].other;
    }
    return next;
  }
  bool is_straight(std::int32_t a, std::int32_t v, std::int32_t b) {
    return places_.are_straight(point(a), point(b), point(v)) &&
           predicates_.compare_cosine(point(v), point(a), point(b), 0) < 0;
  }
  void join_at(std::int32_t v) {
    for (std::size_t i = first_edge_[v]; i < first_edge_[v + 1]; ++i) {
      for (std::size_t k = i + 1; k < first_edge_[v + 1]; ++k) {
        if (is_straight(edges_at_[i].other, v, edges_at_[k].other)) {
          chains_[chain_of(edges_at_[i].edge)] = chain_of(edges_at_[k].edge);
        }
      }
    }
  }
  std::int32_t chain_of(std::int32_t edge) {
    while (chains_[edge] != edge) edge = chains_[edge] = chains_[chains_[edge]];
    return edge;
  }
  std::vector<std::int32_t> chains_at(std::int32_t v) {
    std::vector<std::int32_t> chains;
    for (std::size_t i = first_edge_[v]; i < first_edge_[v + 1]; ++i) {
      chains.push_back(chain_of(edges_at_[i].edge));
    }
    std::sort(chains.begin(), chains.end());
    chains.erase(std::unique(chains.begin(), chains.end()), chains.end());
    return chains;
  }

  const double* coordinates_;
  ExactPredicates& predicates_;
  RoundedPlaces places_;
  std::vector<std::size_t> first_edge_;  // by point
  std::vector<EdgeAt> edges_at_;
  std::vector<std::int32_t> chains_;                  // by edge: union and find
  std::vector<std::vector<std::int32_t>> junctions_;  // by chain: points that are on others, too; ascending
};

}  // namespace flaunay::prove
