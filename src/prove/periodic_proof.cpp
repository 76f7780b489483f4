// Why the checks together are complete: triangles are joined at all edges but those on the ends of a
// cylinder, and are counter-clockwise. So they are a surface that lies on the torus or the cylinder without
// folds at edges, and covers it as many times as their area says: once. All edges are locally Delaunay, and
// at ties canonical, so this is the triangulation of its corners. The number of triangles shows that no point
// is missing: each missing point means two triangles less, or one less on an end. (Triangles that `fold`
// takes out of the plane have such edges: the plane's edges are Delaunay and canonical there, and images of
// the triangle beyond an edge lie beyond its image.)
#include "prove/periodic_proof.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "derived/periodic/torus.hpp"
#include "geometry/magnitudes.hpp"
#include "prove/exact.hpp"
#include "prove/rows.hpp"

namespace flaunay::prove {
namespace {

using periodic::Box;
using TorusPlace = std::array<double, 2>;
using Vectors = std::array<int, 2>;

// A point moved by vectors of the lattice.
struct Image {
  std::int64_t point;
  Vectors at;
};
bool operator==(const Image& a, const Image& b) { return a.point == b.point && a.at == b.at; }
bool operator<(const Image& a, const Image& b) {
  return a.point < b.point || (a.point == b.point && a.at < b.at);
}

class PeriodicProof : RowsProof {
 public:
  explicit PeriodicProof(const PeriodicTriangulation& mesh)
      : RowsProof({mesh.triangles, mesh.neighbors, mesh.representatives, mesh.point_offsets,
                   mesh.triangle_offsets}),
        mesh_(mesh),
        lattice_(periodic::lattice_of(mesh.period)) {}

  void run() {
    check_places();
    scale();
    for (std::size_t s = 0; s < sets(); ++s) check_set(s);
  }

 private:
  bool repeats(std::size_t axis) const { return periodic::repeats(lattice_, axis); }

  void check_places() const {
    const Period &given = mesh_.period, rounded = periodic::period_of(lattice_);
    require(rounded.x == given.x && rounded.y == given.y && rounded.shear == given.shear,
            "the period is not rounded");
    std::vector<double> places(mesh_.places.size());
    periodic::take_into(lattice_, mesh_.places.data(), places.size() / 2, 0, "place", places.data());
    const auto wrong = std::mismatch(places.begin(), places.end(), mesh_.places.begin()).first;
    require(wrong == places.end(), "place {} is not in the period, or not rounded",
            (wrong - places.begin()) / 2);
  }

  // Scales by a power of two, so that differences of images do not overflow.
  void scale() {
    places_ = mesh_.places;
    const Period& period = mesh_.period;
    for (const double length : {period.x, period.y}) {
      const double most = period.shear == 0 ? length : 2 * std::max(period.x, period.y);
      places_.push_back(std::isfinite(length) ? 2 * most : 0);
    }
    const geometry::Scaling scaling = geometry::scaling_for(
        places_.data(), 0, places_.size() / 2, geometry::inspect(places_.data(), 0, places_.size() / 2));
    for (double& x : places_) x = std::ldexp(x, scaling.shift);
    places_.resize(places_.size() - 2);
    const auto scaled = [&](double x) { return std::ldexp(x, scaling.shift); };
    lattice_ = periodic::lattice_of({scaled(period.x), scaled(period.y), scaled(period.shear)});
  }

  Image corner(std::size_t c) const {
    return {mesh_.triangles[c], {mesh_.offsets[2 * c], mesh_.offsets[2 * c + 1]}};
  }
  // Relative to the origin's image in a direction that has a period. No edge of a Delaunay triangulation is
  // longer than neighbors can be apart, so a mesh with rounded differences is wrong anyway.
  TorusPlace place(const Image& image, const Image& origin) const {
    const geometry::Point step =
        kernel::moved({0, 0}, image.at[0] - origin.at[0], image.at[1] - origin.at[1], &lattice_);
    const TorusPlace steps{step.x, step.y};
    TorusPlace at;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      at[axis] = places_[2 * index(image.point) + axis];
      if (!repeats(axis)) continue;
      at[axis] = at[axis] - places_[2 * index(origin.point) + axis] + steps[axis];
      require(std::fabs(at[axis]) <= lattice_.reach[axis], "points {} and {} are too far apart", origin.point,
              image.point);
    }
    return at;
  }

  void check_set(std::size_t s) {
    enter(s);
    check_representatives([&](std::size_t i) { return std::pair(places_[2 * i], places_[2 * i + 1]); });
    const Box box = periodic::box_of(places_.data(), first_, last_, lattice_);
    std::size_t expected = 0;
    for (std::size_t i = first_; i < last_; ++i) {
      if (!represents_itself(i)) continue;
      expected += 2;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double x = places_[2 * i + axis];
        if (!repeats(axis)) expected -= static_cast<std::size_t>(x == box.low[axis]) + (x == box.high[axis]);
      }
    }
    require(end_ - begin_ == expected, "set {} has {} triangles, not {}", s, end_ - begin_, expected);
    double area = 0;
    for (std::size_t t = begin_; t < end_; ++t) area += check_triangle(t, box);
    require(expected == 0 || std::fabs(area - 1) < 0.5, "the triangles of set {} have {} times its area", s,
            area);
  }

  /// Returns its share of the box's area, rounded.
  double check_triangle(std::size_t t, const Box& box) {
    const Image images[] = {corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)};
    for (const Image& image : images) check_vertex(static_cast<std::int32_t>(image.point), t);
    require(images[0].at == Vectors{} && images[0] < images[1] && images[0] < images[2],
            "triangle {} does not begin with its first corner", t);
    const TorusPlace p[] = {place(images[0], images[0]), place(images[1], images[0]),
                            place(images[2], images[0])};
    require(predicates_.orient2d(p[0].data(), p[1].data(), p[2].data()) > 0,
            "triangle {} is not counter-clockwise", t);
    for (std::size_t k = 0; k < 3; ++k) check_edge(3 * t + k, box);
    const auto share = [&](int i, std::size_t axis) {
      return (p[i][axis] - p[0][axis]) / (box.high[axis] - box.low[axis]);
    };
    return (share(1, 0) * share(2, 1) - share(1, 1) * share(2, 0)) / 2;
  }

  void check_edge(std::size_t c, const Box& box) {
    const Image a = corner(c), b = corner(after(c)), e = corner(after(after(c)));
    if (mesh_.neighbors[c] < 0) {
      require(is_end(box, b, e), "triangle {} has no neighbor at edge {}", c / 3, c % 3);
      return;
    }
    const std::size_t other = across(
        c, [&](std::size_t d) { return to(d) == from(c) && moved(corner(after(d)), step_to(b, d)) == e; });
    const Image opposite = moved(corner(other), step_to(b, other));
    const TorusPlace pa = place(a, b), pb = place(b, b), pe = place(e, b), pd = place(opposite, b);
    const int circle = predicates_.incircle(pa.data(), pb.data(), pe.data(), pd.data());
    require(circle < 0 || (circle == 0 && is_of_fan(pb.data(), pe.data(), pa.data(), pd.data())),
            "the edge between the triangles {} and {} is not Delaunay, or not canonical", c / 3, other / 3);
  }

  /// The number of vectors by which a triangle must move so that the edge opposite to its corner d ends at b.
  Vectors step_to(const Image& b, std::size_t d) const {
    const Image end = corner(after(after(d)));
    return {b.at[0] - end.at[0], b.at[1] - end.at[1]};
  }
  static Image moved(const Image& image, const Vectors& step) {
    return {image.point, {image.at[0] + step[0], image.at[1] + step[1]}};
  }

  bool is_end(const Box& box, const Image& a, const Image& b) const {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double x = places_[2 * index(a.point) + axis], y = places_[2 * index(b.point) + axis];
      if (!repeats(axis) && x == y && (x == box.low[axis] || x == box.high[axis])) return true;
    }
    return false;
  }

  const PeriodicTriangulation& mesh_;
  periodic::Lattice lattice_;   // after check_places scaled
  std::vector<double> places_;  // scaled
  ExactPredicates predicates_;
};

}  // namespace

std::vector<std::int32_t> neighbors_of(const std::vector<std::int32_t>& triangles,
                                       const std::vector<std::int8_t>& offsets) {
  // The key of a half-edge: its ends, and the number of periods from one to the other.
  using Key = std::array<std::int32_t, 4>;
  const auto key = [&](std::size_t from, std::size_t to) {
    return Key{triangles[from], triangles[to], offsets[2 * to] - offsets[2 * from],
               offsets[2 * to + 1] - offsets[2 * from + 1]};
  };
  std::vector<std::pair<Key, std::int32_t>> edges(triangles.size());
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    edges[c] = {key(t + (c + 1) % 3, t + (c + 2) % 3), static_cast<std::int32_t>(c / 3)};
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::int32_t> neighbors(triangles.size(), -1);
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    const Key back = key(t + (c + 2) % 3, t + (c + 1) % 3);
    const auto found = std::lower_bound(edges.begin(), edges.end(), std::pair(back, 0));
    if (found != edges.end() && found->first == back) neighbors[c] = found->second;
  }
  return neighbors;
}

std::string find_problem(const PeriodicTriangulation& mesh) {
  return problem_in([&] { PeriodicProof(mesh).run(); });
}

}  // namespace flaunay::prove
