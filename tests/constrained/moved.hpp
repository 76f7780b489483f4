// Where one step of smoothing moves points, one after the other, by the definition in docs/refinement.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "constrained/refinement/bounds.hpp"
#include "constrained/refinement/refine.hpp"
#include "prove/exact.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing {

class Moves {
 public:
  Moves(const constrained::MeshToRefine& mesh, const constrained::RefinedMesh& refined,
        const Refinement& wanted)
      : refined_(refined),
        wanted_(wanted),
        squared_sine_(constrained::quality_bounds(std::max(20.0, wanted.min_angle)).squared_sine) {
    points_.assign(mesh.coordinates, mesh.coordinates + 2 * mesh.points);
    points_.insert(points_.end(), refined.added.begin(), refined.added.end());
    std::vector<std::map<std::int32_t, std::int32_t>> rings(points_.size() / 2);
    for (std::size_t c = 0; c < refined.triangles.size(); ++c) {
      const std::size_t t = c - c % 3;
      rings[corner(c)][corner(t + (c + 1) % 3)] = corner(t + (c + 2) % 3);
    }
    for (std::size_t k = 0; k < refined.added_edges.size(); ++k) {
      const auto v = static_cast<std::int32_t>(mesh.points + k);
      if (refined.added_edges[k] < 0) propose(v, rings[v]);
    }
    while (cancel()) {
    }
  }

  /// x and y of the points that were added, after the step.
  Coordinates added() const {
    Coordinates after = refined_.added;
    for (const auto& [v, p] : targets_) {
      std::copy(p.begin(), p.end(), after.end() - static_cast<std::ptrdiff_t>(points_.size()) + 2 * v);
    }
    return after;
  }
  std::size_t proposed() const { return proposed_; }
  std::size_t cancelled() const { return proposed_ - targets_.size(); }

 private:
  using Point = std::array<double, 2>;
  using Triangle = std::array<Point, 3>;

  std::int32_t corner(std::size_t c) const { return refined_.triangles[c]; }
  Point at(std::int32_t v) const {
    return {points_[2 * static_cast<std::size_t>(v)], points_[2 * static_cast<std::size_t>(v) + 1]};
  }
  static double cross(Point u, Point v) { return u[0] * v[1] - u[1] * v[0]; }
  static Point minus(Point p, Point q) { return {p[0] - q[0], p[1] - q[1]}; }
  static double square(Point p) { return p[0] * p[0] + p[1] * p[1]; }

  void propose(std::int32_t v, const std::map<std::int32_t, std::int32_t>& ring) {
    const Point here = at(v);
    const std::int32_t first = std::min_element(ring.begin(), ring.end(), [&](const auto& a, const auto& b) {
                                 return at(a.first) < at(b.first);
                               })->first;
    double x = 0, y = 0, weights = 0, reach = 0;
    std::int32_t a = first;
    do {
      const std::int32_t b = ring.at(a);
      const Point u = minus(at(a), here), w = minus(at(b), here);
      const double uu = square(u), ww = square(w), area = cross(u, w), weight = 1 / std::sqrt(area);
      x += (w[1] * uu - u[1] * ww) * (weight / area);
      y += (u[0] * ww - w[0] * uu) * (weight / area);
      weights += weight;
      reach = std::max(reach, uu);
      a = b;
    } while (a != first);
    Point step = {0.5 * x / weights, 0.5 * y / weights};
    for (int halving = 0; halving < 4; ++halving, step = {step[0] / 2, step[1] / 2}) {
      const Point target = {here[0] + step[0], here[1] + step[1]};
      const bool is_good =
          square(step) <= reach && std::all_of(ring.begin(), ring.end(), [&](const auto& e) {
            return may_become({here, at(e.first), at(e.second)}, {target, at(e.first), at(e.second)});
          });
      if (!is_good) continue;
      targets_[v] = target;
      ++proposed_;
      return;
    }
  }

  static Triangle ordered(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  }
  static double doubled_area(const Triangle& t) { return cross(minus(t[1], t[0]), minus(t[2], t[0])); }
  static double sine(const Triangle& t) {
    std::array<double, 3> sides = {square(minus(t[1], t[2])), square(minus(t[2], t[0])),
                                   square(minus(t[0], t[1]))};
    std::sort(sides.begin(), sides.end());
    return doubled_area(t) * doubled_area(t) / (sides[2] * sides[1]);
  }

  bool may_become(const Triangle& before, const Triangle& after) {
    const double *a = after[0].data(), *b = after[1].data(), *c = after[2].data();
    if (exact_.orient2d(a, b, c) <= 0) return false;
    const bool is_thin = exact_.compare_sine(a, b, c, squared_sine_) < 0 ||
                         exact_.compare_sine(b, c, a, squared_sine_) < 0 ||
                         exact_.compare_sine(c, a, b, squared_sine_) < 0;
    const bool is_large = wanted_.max_area > 0 && exact_.compare_area(a, b, c, wanted_.max_area) > 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::sqrt(square(minus(after[k], after[(k + 1) % 3]))) < wanted_.min_edge) return false;
    }
    return !(is_thin && sine(ordered(after)) < sine(ordered(before))) &&
           !(is_large && doubled_area(ordered(after)) > doubled_area(ordered(before)));
  }

  // All at once; returns whether some were.
  bool cancel() {
    std::set<std::int32_t> stay;
    for (std::size_t t = 0; t < refined_.triangles.size(); t += 3) {
      Triangle before, after;
      bool moves = false;
      for (std::size_t k = 0; k < 3; ++k) {
        before[k] = after[k] = at(corner(t + k));
        const auto found = targets_.find(corner(t + k));
        if (found == targets_.end()) continue;
        after[k] = found->second;
        moves = true;
      }
      if (!moves || may_become(before, after)) continue;
      for (std::size_t k = 0; k < 3; ++k) stay.insert(corner(t + k));
    }
    std::size_t cancelled = 0;
    for (const std::int32_t v : stay) cancelled += targets_.erase(v);
    return cancelled > 0;
  }

  const constrained::RefinedMesh& refined_;
  const Refinement& wanted_;
  double squared_sine_;
  Coordinates points_;
  ExactPredicates exact_;
  std::map<std::int32_t, Point> targets_;
  std::size_t proposed_ = 0;
};

}  // namespace flaunay::testing
