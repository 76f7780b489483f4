// Why the checks together are complete: triangles are joined at all edges but those on the ends of a
// cylinder, and are counter-clockwise. So they are a surface that lies on the torus or the cylinder without
// folds at edges, and covers it as many times as their area says: once. All edges are locally Delaunay, and
// at ties canonical, so the triangulation is that of its corners; and their number says that no point is
// missing, since each missing point has two triangles less, or one less on an end. (What `fold` takes out of
// the plane has such edges, since those of the plane are such, and images of what lies beyond an edge there
// lie beyond it.)
#include "derived/periodic/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "derived/periodic/torus.hpp"
#include "geometry/for_each.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/predicates.hpp"
#include "geometry/problem.hpp"

namespace flaunay::periodic {
namespace {

using geometry::Point;
using geometry::Problem;
using geometry::require;

class Checker {
 public:
  Checker(host::Runtime& runtime, const PeriodicTriangulation& mesh)
      : runtime_(runtime), mesh_(mesh), period_{mesh.period.x, mesh.period.y}, scaled_period_(period_) {}

  void run() {
    check_places();
    scale();
    for (std::size_t s = 0; s + 1 < mesh_.point_offsets.size(); ++s) check_set(s);
  }

 private:
  static std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }
  bool repeats(std::size_t axis) const { return std::isfinite(period_[axis]); }

  void check_places() const {
    require(rounded(mesh_.period) == period_, "the period is not rounded");
    const std::size_t n = mesh_.representatives.size();
    const std::vector<double> places = to_places(runtime_, mesh_.places.data(), n, period_, "place");
    const auto wrong = std::mismatch(places.begin(), places.end(), mesh_.places.begin()).first;
    require(wrong == places.end(), "place {} is not in the period, or not rounded",
            (wrong - places.begin()) / 2);
  }

  // So that predicates neither overflow nor underflow, also for differences of images.
  void scale() {
    std::vector<double> all = mesh_.places;
    for (const double length : period_) all.push_back(std::isfinite(length) ? 2 * length : 0);
    const geometry::Scaling scaling = geometry::scaling_for(all.data(), 0, all.size() / 2,
                                                            geometry::inspect(all.data(), 0, all.size() / 2));
    predicates_.bounds = scaling.bounds;
    for (double& x : all) x = kernel::scaled(x, scaling.powers());
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (repeats(axis)) scaled_period_[axis] = all[all.size() - 2 + axis] / 2;
    }
    all.resize(all.size() - 2);
    places_ = std::move(all);
  }

  Image corner(std::size_t c) const {
    return {mesh_.triangles[c], {mesh_.offsets[2 * c], mesh_.offsets[2 * c + 1]}};
  }
  // Relative to the origin's image in a direction that has a period. No edge of a Delaunay triangulation is
  // longer than that, so what is rounded is wrong anyway.
  Point place(const Image& image, const Image& origin) const {
    double at[2];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      at[axis] = places_[2 * index(image.point) + axis];
      if (!repeats(axis)) continue;
      at[axis] = at[axis] - places_[2 * index(origin.point) + axis] +
                 (image.at[axis] - origin.at[axis]) * scaled_period_[axis];
      require(std::fabs(at[axis]) <= scaled_period_[axis], "points {} and {} are too far apart", origin.point,
              image.point);
    }
    return {at[0], at[1]};
  }

  void check_set(std::size_t s) {
    const std::size_t first = mesh_.point_offsets[s], last = mesh_.point_offsets[s + 1];
    const std::size_t begin = mesh_.triangle_offsets[s], end = mesh_.triangle_offsets[s + 1];
    check_representatives(first, last);
    const Box box = box_of(places_, first, last, scaled_period_);
    std::size_t expected = 0;
    for (std::size_t i = first; i < last; ++i) {
      if (index(mesh_.representatives[i]) != i) continue;
      expected += 2;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double x = places_[2 * i + axis];
        if (!repeats(axis)) expected -= static_cast<std::size_t>(x == box.low[axis]) + (x == box.high[axis]);
      }
    }
    require(end - begin == expected, "set {} has {} triangles, not {}", s, end - begin, expected);
    std::vector<double> areas(end - begin);
    geometry::for_each(runtime_, end - begin, [&](std::size_t t) {
      areas[t] = check_triangle(begin + t, first, last, begin, end, box);
    });
    const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
    require(expected == 0 || std::fabs(area - 1) < 0.5, "the triangles of set {} have {} times its area", s,
            area);
  }

  void check_representatives(std::size_t first, std::size_t last) const {
    std::vector<std::size_t> order(last - first);
    std::iota(order.begin(), order.end(), first);
    const auto at = [&](std::size_t i) { return std::pair(places_[2 * i], places_[2 * i + 1]); };
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(at(a), a) < std::pair(at(b), b); });
    std::size_t smallest = first;
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k == 0 || at(order[k - 1]) != at(order[k])) smallest = order[k];
      require(index(mesh_.representatives[order[k]]) == smallest, "point {} has a wrong representative",
              order[k]);
    }
  }

  /// Returns its share of the box's area, rounded.
  double check_triangle(std::size_t t, std::size_t first, std::size_t last, std::size_t begin,
                        std::size_t end, const Box& box) const {
    const Image images[] = {corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)};
    for (const Image& image : images) {
      const std::size_t v = index(image.point);
      require(v >= first && v < last && index(mesh_.representatives[v]) == v,
              "triangle {} has a corner {} of another set, or that another point represents", t, v);
    }
    require(images[0].at == Pair<int>{} && images[0] < images[1] && images[0] < images[2],
            "triangle {} does not begin with its first corner", t);
    const Point p[] = {place(images[0], images[0]), place(images[1], images[0]), place(images[2], images[0])};
    require(predicates_.orient(p[0], p[1], p[2]) > 0, "triangle {} is not counter-clockwise", t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Image &a = images[k], &b = images[(k + 1) % 3], &c = images[(k + 2) % 3];
      const std::int32_t other = mesh_.neighbors[3 * t + k];
      if (other < 0) {
        require(is_end(box, b, c), "triangle {} has no neighbor at edge {}", t, k);
        continue;
      }
      require(index(other) >= begin && index(other) < end, "triangle {} has a neighbor of another set", t);
      const Image d = opposite(t, index(other), b, c);
      const int circle = predicates_.circle(place(a, b), place(b, b), place(c, b), place(d, b));
      const int sign = circle != 0 ? circle
                                   : kernel::canonical_tie(place(a, b), place(b, b), place(c, b), place(d, b),
                                                           predicates_.bounds.circle);
      require(sign < 0, "the edge between the triangles {} and {} is not Delaunay, or not canonical", t,
              other);
    }
    const auto share = [&](double x, std::size_t axis) { return x / (box.high[axis] - box.low[axis]); };
    return (share(p[1].x - p[0].x, 0) * share(p[2].y - p[0].y, 1) -
            share(p[1].y - p[0].y, 1) * share(p[2].x - p[0].x, 0)) /
           2;
  }

  bool is_end(const Box& box, const Image& a, const Image& b) const {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double x = places_[2 * index(a.point) + axis], y = places_[2 * index(b.point) + axis];
      if (!repeats(axis) && x == y && (x == box.low[axis] || x == box.high[axis])) return true;
    }
    return false;
  }

  /// The corner of a neighbour opposite to the edge from a to b, as it lies beside that.
  Image opposite(std::size_t t, std::size_t other, const Image& a, const Image& b) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (index(mesh_.neighbors[3 * other + k]) != t) continue;
      const Image from = corner(3 * other + (k + 1) % 3), to = corner(3 * other + (k + 2) % 3);
      if (from.point != b.point || to.point != a.point) continue;
      const Pair<int> step{b.at[0] - from.at[0], b.at[1] - from.at[1]};
      if (Pair<int>{to.at[0] + step[0], to.at[1] + step[1]} != a.at) continue;
      Image d = corner(3 * other + k);
      d.at = {d.at[0] + step[0], d.at[1] + step[1]};
      return d;
    }
    throw Problem{fmt::format("the neighbors {} and {} have no edge in common", t, other)};
  }

  host::Runtime& runtime_;
  const PeriodicTriangulation& mesh_;
  Pair<double> period_, scaled_period_;
  std::vector<double> places_;  // scaled
  geometry::Predicates predicates_;
};

}  // namespace

std::string find_problem(host::Runtime& runtime, const PeriodicTriangulation& mesh) {
  return geometry::problem_in([&] { Checker(runtime, mesh).run(); });
}

}  // namespace flaunay::periodic
