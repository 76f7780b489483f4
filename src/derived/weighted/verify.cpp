// Why the checks together are complete: triangles are counter-clockwise and joined at all edges but those of
// a convex polygon, so they cover it once. By the power test, which has no ties, all edges are convex when
// they are lifted; so the triangles are the lower hull of their corners, and none of these is hidden. All
// other points are within triangles, and above them.
#include "derived/weighted/verify.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>

#include "arithmetic/coordinates.h"
#include "geometry/predicates.hpp"
#include "geometry/problem.hpp"
#include "predicates/power.h"

namespace flaunay::weighted {
namespace {

using geometry::Point;
using geometry::require;
using geometry::operator==;
using Ids = std::vector<std::int32_t>;

class Checker {
 public:
  explicit Checker(const Claim& claim)
      : claim_(claim),
        mesh_(claim.mesh),
        scalings_(
            geometry::set_scalings(claim.points, claim.offsets, [&](std::size_t first, std::size_t last) {
              return geometry::inspect(claim.points, first, last);
            })) {
    predicates_.bounds = scalings_.bounds;
  }

  void check_set(std::size_t s) {
    enter(s);
    check_representatives();
    begin_ = mesh_.triangle_offsets[s];
    end_ = mesh_.triangle_offsets[s + 1];
    const Ids hull(mesh_.hull.begin() + static_cast<std::ptrdiff_t>(mesh_.hull_offsets[s]),
                   mesh_.hull.begin() + static_cast<std::ptrdiff_t>(mesh_.hull_offsets[s + 1]));
    for (const std::int32_t v : hull) check_vertex(v, "the hull");
    check_use(hull);
    if (begin_ == end_) {
      check_line(hull);
      return;
    }
    const std::size_t open = check_hull(hull);
    for (std::size_t t = begin_; t < end_; ++t) check_triangle(t);
    require(open == hull.size(), "set {} has {} edges without a neighbor, but {} hull vertices", s, open,
            hull.size());
  }

  void check_hidden(std::size_t s, const Ids& hiding) {
    enter(s);
    const auto from = std::lower_bound(mesh_.hidden.begin(), mesh_.hidden.end(), first_);
    for (auto at = from; at != mesh_.hidden.end() && static_cast<std::size_t>(*at) < last_; ++at) {
      const std::int32_t t = hiding[static_cast<std::size_t>(at - mesh_.hidden.begin())];
      if (t < 0) {
        // On the line of a set without triangles: checked with it.
        require(mesh_.triangle_offsets[s] == mesh_.triangle_offsets[s + 1], "point {} is in no triangle",
                *at);
        continue;
      }
      const std::int32_t* const corners = &mesh_.triangles[3 * static_cast<std::size_t>(t)];
      for (int k = 0; k < 3; ++k) {
        require(predicates_.orient(place(corners[k]), place(corners[(k + 1) % 3]), place(*at)) >= 0,
                "point {} is not in triangle {}", *at, t);
      }
      require(is_hidden_by(corners, *at), "point {} is listed as hidden, but lies below triangle {}", *at, t);
    }
  }

 private:
  void enter(std::size_t s) {
    first_ = claim_.offsets[s];
    last_ = claim_.offsets[s + 1];
    scale_ = kernel::scale_of(scalings_.shift(s));
  }
  Point place(std::int32_t i) const { return kernel::scaled_point(i, claim_.points, scale_); }
  kernel::weighted_point weighted(std::int32_t i) const {
    return {place(i), kernel::scaled(kernel::scaled(claim_.weights[i], scale_), scale_)};
  }
  bool is_hidden(std::int32_t i) const {
    return std::binary_search(mesh_.hidden.begin(), mesh_.hidden.end(), i);
  }

  void check_vertex(std::int32_t v, const char* where) const {
    require(v >= 0 && static_cast<std::size_t>(v) >= first_ && static_cast<std::size_t>(v) < last_ &&
                mesh_.representatives[static_cast<std::size_t>(v)] == v && !is_hidden(v),
            "{} has point {}, which is of another set, hidden, or represented by another", where, v);
  }

  void check_representatives() const {
    std::map<std::array<double, 3>, std::int32_t> smallest;
    for (std::size_t i = first_; i < last_; ++i) {
      const std::array<double, 3> key = {claim_.points[2 * i], claim_.points[2 * i + 1], claim_.weights[i]};
      const auto own = static_cast<std::int32_t>(i);
      require(mesh_.representatives[i] == smallest.insert({key, own}).first->second,
              "point {} has a wrong representative", i);
    }
  }

  /// Each point is a vertex, hidden, or represented by another.
  void check_use(const Ids& hull) const {
    std::vector<std::uint8_t> is_used(last_ - first_, 0);
    for (std::size_t c = 3 * begin_; c < 3 * end_; ++c) {
      check_vertex(mesh_.triangles[c], "a triangle");
      is_used[static_cast<std::size_t>(mesh_.triangles[c]) - first_] = 1;
    }
    for (const std::int32_t v : hull) is_used[static_cast<std::size_t>(v) - first_] = 1;
    for (std::size_t i = first_; i < last_; ++i) {
      const auto own = static_cast<std::int32_t>(i);
      require(is_used[i - first_] != 0 || is_hidden(own) || mesh_.representatives[i] != own,
              "point {} is neither a vertex nor hidden", i);
    }
  }

  /// That the hull is a convex polygon that goes around once; returns how many edges have no neighbor.
  std::size_t check_hull(const Ids& hull) const {
    const auto before = [&](std::int32_t a, std::int32_t b) {
      return kernel::comes_before(place(a), place(b)) != 0;
    };
    std::size_t turns = 0;
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const std::int32_t a = hull[k], b = hull[(k + 1) % hull.size()], c = hull[(k + 2) % hull.size()];
      require(predicates_.orient(place(a), place(b), place(c)) >= 0, "the hull is not convex at point {}", b);
      turns += before(a, b) != before(b, c);
    }
    require(turns == 2, "the hull of the set from point {} on goes around more than once", first_);
    std::size_t open = 0;
    std::map<std::int32_t, std::int32_t> next;
    for (std::size_t k = 0; k < hull.size(); ++k) next[hull[k]] = hull[(k + 1) % hull.size()];
    for (std::size_t c = 3 * begin_; c < 3 * end_; ++c) {
      if (mesh_.neighbors[c] >= 0) continue;
      const std::size_t t = c - c % 3;
      const std::int32_t from = mesh_.triangles[t + (c + 1) % 3], to = mesh_.triangles[t + (c + 2) % 3];
      const auto found = next.find(from);
      require(found != next.end() && found->second == to, "triangle {} has no neighbor at an edge inside",
              t / 3);
      ++open;
    }
    return open;
  }

  void check_triangle(std::size_t t) const {
    const std::int32_t* const v = &mesh_.triangles[3 * t];
    require(v[0] < v[1] && v[0] < v[2], "triangle {} does not begin with its smallest index", t);
    require(predicates_.orient(place(v[0]), place(v[1]), place(v[2])) > 0,
            "triangle {} is not counter-clockwise", t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t other = mesh_.neighbors[3 * t + k];
      if (other < 0) continue;
      require(static_cast<std::size_t>(other) >= begin_ && static_cast<std::size_t>(other) < end_,
              "triangle {} has a neighbor of another set", t);
      const std::int32_t* const w = &mesh_.triangles[3 * static_cast<std::size_t>(other)];
      std::size_t m = 0;
      while (m < 3 && !(w[(m + 1) % 3] == v[(k + 2) % 3] && w[(m + 2) % 3] == v[(k + 1) % 3])) ++m;
      require(
          m < 3 && mesh_.neighbors[3 * static_cast<std::size_t>(other) + m] == static_cast<std::int32_t>(t),
          "triangles {} and {} are not neighbors of each other", t, other);
      require(!is_below(v, w[m]), "the edge between triangles {} and {} is not regular", t, other);
    }
  }

  bool is_below(const std::int32_t* t, std::int32_t p) const {
    return kernel::power_undecided(weighted(t[0]), weighted(t[1]), weighted(t[2]), weighted(p),
                                   predicates_.bounds) > 0;
  }
  bool is_hidden_by(const std::int32_t* t, std::int32_t p) const {
    for (int k = 0; k < 3; ++k) {
      if (place(t[k]) == place(p)) return claim_.weights[t[k]] > claim_.weights[p];
    }
    return !is_below(t, p);
  }

  /// A set without triangles: its vertices in their order, the lower hull above their line.
  void check_line(const Ids& hull) const {
    for (std::size_t k = 0; k + 1 < hull.size(); ++k) {
      require(kernel::comes_before(place(hull[k]), place(hull[k + 1])) != 0,
              "the hull is not in order at point {}", hull[k + 1]);
      require(k == 0 ||
                  !kernel::is_hidden_between(weighted(hull[k - 1]), weighted(hull[k]), weighted(hull[k + 1])),
              "point {} is hidden", hull[k]);
    }
    for (std::size_t i = first_; i < last_; ++i) {
      const auto p = static_cast<std::int32_t>(i);
      require(!hull.empty() && predicates_.orient(place(hull.front()), place(hull.back()), place(p)) == 0,
              "there are no triangles, but point {} is not on the line of the others", i);
      if (!is_hidden(p)) continue;
      const auto beyond = std::lower_bound(hull.begin(), hull.end(), p, [&](std::int32_t a, std::int32_t b) {
        return kernel::comes_before(place(a), place(b)) != 0;
      });
      require(beyond != hull.end(), "point {} is listed as hidden, but beyond the hull", i);
      const bool is_same = place(*beyond) == place(p);
      require(is_same
                  ? claim_.weights[*beyond] > claim_.weights[i]
                  : beyond != hull.begin() && kernel::is_hidden_between(weighted(*(beyond - 1)), weighted(p),
                                                                        weighted(*beyond)) != 0,
              "point {} is not hidden", i);
    }
  }

  const Claim& claim_;
  const WeightedTriangulation& mesh_;
  geometry::SetScalings scalings_;
  geometry::Predicates predicates_;
  kernel::scaling scale_{1, 1, 1};
  std::size_t first_ = 0, last_ = 0, begin_ = 0, end_ = 0;
};

template <typename Check>
std::string problem_in_sets(const Claim& claim, const Check& check) {
  return geometry::problem_in([&] {
    Checker checker(claim);
    for (std::size_t s = 0; s + 1 < claim.offsets.size(); ++s) check(checker, s);
  });
}

}  // namespace

std::string find_problem(const Claim& claim) {
  return problem_in_sets(claim, [](Checker& checker, std::size_t s) { checker.check_set(s); });
}

std::string find_problem_of_hidden(const Claim& claim, const Ids& hiding) {
  return problem_in_sets(claim, [&](Checker& checker, std::size_t s) { checker.check_hidden(s, hiding); });
}

}  // namespace flaunay::weighted
