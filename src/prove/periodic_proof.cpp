// Why the checks together are complete: triangles are joined at all edges but those on the ends of a
// cylinder, and are counter-clockwise. So they are a surface that lies on the torus or the cylinder without
// folds at edges, and covers it as many times as their area says: once. All edges are locally Delaunay, and
// at ties canonical, so this is the triangulation of its corners. The number of triangles shows that no point
// is missing: each missing point means two triangles less, or one less on an end. (Triangles that `fold`
// takes out of the plane have such edges: the plane's edges are Delaunay and canonical there, and images of
// the triangle beyond an edge lie beyond its image.)
//
// With weights, all edges are convex when they are lifted, so this is the lower hull of its corners. Each of
// these is listed as visible, and their number shows that each visible point is a corner. All other points
// are on or above a triangle that has them inside or on its border. (The corners of triangles that `fold`
// takes are within the margin, so all images of points within such a triangle are triangulated, too: none is
// below it.)
#include "prove/periodic_proof.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/magnitudes.hpp"
#include "prove/exact.hpp"
#include "prove/rows.hpp"
#include "space/periodic/torus.hpp"

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
  PeriodicProof(const Triangulation& mesh, const double* weights)
      : RowsProof({mesh.triangles, mesh.neighbors, mesh.representatives, mesh.point_offsets,
                   mesh.triangle_offsets}),
        mesh_(mesh),
        weights_(weights),
        lattice_(periodic::lattice_of(mesh.space.period)) {}

  void run() {
    check_places();
    scale();
    for (std::size_t s = 0; s < sets(); ++s) check_set(s);
  }

 private:
  bool repeats(std::size_t axis) const { return periodic::repeats(lattice_, axis); }

  void check_places() const {
    const Period &given = mesh_.space.period, rounded = periodic::period_of(lattice_);
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
    if (weights_ != nullptr) scaled_weights_.assign(weights_, weights_ + mesh_.representatives.size());
    const Period& period = mesh_.space.period;
    for (const double length : {period.x, period.y}) {
      const double most = period.shear == 0 ? length : 2 * std::max(period.x, period.y);
      places_.push_back(std::isfinite(length) ? 2 * most : 0);
    }
    const geometry::Scaling scaling = geometry::scaling_for(
        places_.data(), 0, places_.size() / 2, geometry::inspect(places_.data(), 0, places_.size() / 2));
    for (double& x : places_) x = std::ldexp(x, scaling.shift);
    for (double& weight : scaled_weights_) weight = std::ldexp(weight, 2 * scaling.shift);
    places_.resize(places_.size() - 2);
    const auto scaled = [&](double x) { return std::ldexp(x, scaling.shift); };
    lattice_ = periodic::lattice_of({scaled(period.x), scaled(period.y), scaled(period.shear)});
  }

  Image corner(std::size_t c) const {
    return {mesh_.triangles[c], {mesh_.corner_offsets[2 * c], mesh_.corner_offsets[2 * c + 1]}};
  }
  // Relative to the origin's image in a direction that has a period. No edge of a Delaunay triangulation is
  // longer than neighbors can be apart, so a mesh with rounded differences is wrong anyway.
  TorusPlace place(const Image& image, const Image& origin) const {
    const TorusPlace at = difference(image, origin);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      require(!repeats(axis) || std::fabs(at[axis]) <= lattice_.reach[axis],
              "points {} and {} are too far apart", origin.point, image.point);
    }
    return at;
  }
  /// The same, without a rounding up to twice as far.
  TorusPlace difference(const Image& image, const Image& origin) const {
    const geometry::Point step =
        kernel::moved({0, 0}, image.at[0] - origin.at[0], image.at[1] - origin.at[1], &lattice_);
    const TorusPlace steps{step.x, step.y};
    TorusPlace at;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      at[axis] = places_[2 * index(image.point) + axis];
      if (!repeats(axis)) continue;
      at[axis] = at[axis] - places_[2 * index(origin.point) + axis] + steps[axis];
    }
    return at;
  }

  void check_set(std::size_t s) {
    enter(s);
    check_representatives([&](std::size_t i) {
      return std::array<double, 3>{places_[2 * i], places_[2 * i + 1], weight(i)};
    });
    const Box box = periodic::box_of(places_.data(), first_, last_, lattice_);
    std::size_t expected = 0;
    for (std::size_t i = first_; i < last_; ++i) {
      if (!represents_itself(i) || is_hidden(i)) continue;
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
    if (weights_ == nullptr) return;
    std::vector<std::int32_t> visible, hidden;
    for (std::size_t i = first_; i < last_; ++i) {
      if (represents_itself(i)) (is_hidden(i) ? hidden : visible).push_back(static_cast<std::int32_t>(i));
    }
    for (const std::int32_t i : mesh_.hidden) {
      require(represents_itself(index(i)), "point {} is listed as hidden, but another one represents it", i);
    }
    if (expected == 0) {
      check_circle(visible, hidden);
    } else {
      check_hidden(hidden);
    }
  }

  double weight(std::size_t i) const { return weights_ == nullptr ? 0 : scaled_weights_[i]; }
  bool is_hidden(std::size_t i) const {
    return std::binary_search(mesh_.hidden.begin(), mesh_.hidden.end(), static_cast<std::int32_t>(i));
  }
  static Image in_place(std::int32_t i) { return {i, {}}; }

  /// Whether the last place is below the triangle of the others.
  bool is_below(const std::array<Image, 4>& images, const std::array<TorusPlace, 4>& p) {
    std::array<double, 4> weights{};
    for (std::size_t k = 0; k < 4; ++k) weights[k] = weight(index(images[k].point));
    return prove::is_below(predicates_, {p[0].data(), p[1].data(), p[2].data(), p[3].data()}, weights);
  }

  /// Hidden points are not below the triangles that have them inside or on their borders.
  void check_hidden(std::vector<std::int32_t>& points) {
    sort_along_strips(places_.data(), points);
    std::size_t t = begin_;
    for (const std::int32_t p : points) {
      const Image image = find(t, p);
      std::array<Image, 4> images{corner(3 * t), corner(3 * t + 1), corner(3 * t + 2), image};
      std::array<TorusPlace, 4> places;
      for (std::size_t k = 0; k < 4; ++k) places[k] = difference(images[k], image);
      const auto same = std::find(places.begin(), places.begin() + 3, places[3]);
      const auto at = static_cast<std::size_t>(same - places.begin());
      require(at < 3 ? weight(index(images[at].point)) > weight(index(p)) : !is_below(images, places),
              "point {} is listed as hidden, but lies below triangle {}", p, t);
    }
  }

  bool is_before(std::int32_t a, std::int32_t b) const {
    return comes_before(&places_[2 * index(a)], &places_[2 * index(b)]);
  }

  /// Makes t a triangle that has an image of point p inside or on its border, and returns that image. From
  /// the image nearest to t, walks over edges that it lies beyond (see PlanarProof); where differences would
  /// be rounded, tries all triangles.
  Image find(std::size_t& t, std::int32_t p) {
    Image image = nearest(p, corner(3 * t));
    for (std::size_t k = 0; k < 3;) {
      const Side side = side_of(image, 3 * t + k);
      if (side == Side::far) return search(t, p);
      if (side == Side::inside) {
        ++k;
        continue;
      }
      const std::size_t c = 3 * t + k;
      require(mesh_.neighbors[c] >= 0, "point {} is listed as hidden, but lies beyond an end", p);
      const Image b = corner(after(c)), e = corner(after(after(c)));
      const std::size_t d = across(c, [&](std::size_t at) {
        return to(at) == from(c) && moved(corner(after(at)), step_to(b, at)) == e;
      });
      const Vectors step = step_to(b, d);
      image = moved(image, {-step[0], -step[1]});
      t = d / 3;
      k = 0;
    }
    return image;
  }

  Image search(std::size_t& t, std::int32_t p) {
    for (t = begin_; t < end_; ++t) {
      for (int across = -2; across <= 2; ++across) {
        for (int up = -2; up <= 2; ++up) {
          const Image image = moved(nearest(p, corner(3 * t)), {across, up});
          bool is_inside = true;
          for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) is_inside &= side_of(image, c) == Side::inside;
          if (is_inside) return image;
        }
      }
    }
    violate("point {} is listed as hidden, but in no triangle", p);
  }

  /// Where an image lies of the edge opposite to a corner, whose triangle is where offsets have it.
  enum class Side { inside, beyond, far };
  Side side_of(const Image& image, std::size_t c) {
    const TorusPlace from = difference(corner(after(c)), image),
                     to = difference(corner(after(after(c))), image);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double most = 2 * lattice_.reach[axis];
      if (repeats(axis) && !(std::fabs(from[axis]) <= most && std::fabs(to[axis]) <= most)) return Side::far;
    }
    const TorusPlace own = difference(image, image);
    return predicates_.orient2d(from.data(), to.data(), own.data()) >= 0 ? Side::inside : Side::beyond;
  }

  /// The image of a point that is nearest to a corner, along y and then along x.
  Image nearest(std::int32_t p, const Image& to) const {
    Image image = in_place(p);
    for (const std::size_t axis : {1, 0}) {
      const double length = lattice_.period[axis];
      if (repeats(axis))
        image.at[axis] -= static_cast<int>(std::nearbyint(difference(image, to)[axis] / length));
    }
    return image;
  }

  /// Points on a circle: each visible one lies below the line of the lifts beside it, and each hidden one on
  /// or above the line over its place.
  void check_circle(std::vector<std::int32_t>& visible, const std::vector<std::int32_t>& hidden) {
    require(first_ == last_ || !visible.empty(), "all points of a set are listed as hidden");
    std::sort(visible.begin(), visible.end(),
              [&](std::int32_t a, std::int32_t b) { return is_before(a, b); });
    const Vectors once = {repeats(0) ? 1 : 0, repeats(1) ? 1 : 0};
    // The visible point that is number k, or an image of it.
    const auto at = [&](std::size_t k) -> Image {
      const std::size_t count = visible.size();
      const int times = static_cast<int>(k / count) - 1;
      return {visible[k % count], {times * once[0], times * once[1]}};
    };
    const auto line = [&](const Image& a, const Image& b, const Image& c) {
      const TorusPlace p = difference(a, b), q = difference(b, b), r = difference(c, b);
      const double weights[] = {weight(index(a.point)), weight(index(b.point)), weight(index(c.point))};
      return predicates_.power_on_line(p.data(), q.data(), r.data(), weights);
    };
    for (std::size_t k = visible.size(); k < 2 * visible.size(); ++k) {
      require(line(at(k - 1), at(k), at(k + 1)) > 0, "point {} is hidden", at(k).point);
    }
    for (const std::int32_t p : hidden) {
      const auto found = std::lower_bound(visible.begin(), visible.end(), p,
                                          [&](std::int32_t a, std::int32_t b) { return is_before(a, b); });
      const auto k = visible.size() + static_cast<std::size_t>(found - visible.begin());
      const bool is_same = found != visible.end() && !is_before(p, *found);
      require(is_same ? weight(index(*found)) > weight(index(p)) : line(at(k - 1), in_place(p), at(k)) <= 0,
              "point {} is listed as hidden, but is not", p);
    }
  }

  /// Returns its share of the box's area, rounded.
  double check_triangle(std::size_t t, const Box& box) {
    const Image images[] = {corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)};
    for (const Image& image : images) {
      check_vertex(static_cast<std::int32_t>(image.point), t);
      require(!is_hidden(index(image.point)), "triangle {} has a hidden corner, {}", t, image.point);
    }
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
    require(!is_below({a, b, e, opposite}, {place(a, b), place(b, b), place(e, b), place(opposite, b)}),
            "the edge between the triangles {} and {} is not {}", c / 3, other / 3,
            weights_ == nullptr ? "Delaunay, or not canonical" : "regular");
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

  const Triangulation& mesh_;
  const double* weights_;
  std::vector<double> scaled_weights_;
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

std::string find_problem(const Triangulation& mesh, const double* weights) {
  return problem_in([&] { PeriodicProof(mesh, weights).run(); });
}

}  // namespace flaunay::prove
