// From points on a torus or a cylinder to points in the plane, and from triangles of these back.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/periodic.hpp"
#include "geometry/predicates.hpp"
#include "host/runtime.hpp"

namespace flaunay::periodic {

/// Of x and of y.
template <typename T>
using Pair = std::array<T, 2>;

/// The periods, rounded to multiples of their units.
Pair<double> rounded(const Period& period);

/// Takes points into the periods, rounded to multiples of their units. The result is the same on every
/// machine. Throws Error(input), with what: the name of a point, for one that is not finite. O(n).
std::vector<double> to_places(host::Runtime& runtime, const double* points, std::size_t n,
                              const Pair<double>& period, const char* what);

/// The box of one set: where there is a period from 0 to that, otherwise as its points have it.
struct Box {
  Pair<double> low{}, high{};
  Pair<double> period{};

  bool repeats(std::size_t axis) const { return std::isfinite(period[axis]); }
};
Box box_of(const std::vector<double>& places, std::size_t first, std::size_t last,
           const Pair<double>& period);

/// How wide the gaps of so many uniform points may be, with some to spare.
double first_margin(const Box& box, std::size_t n);

/// An image of a point, so many periods away from its place.
struct Image {
  std::int32_t point;
  Pair<int> at;
};
inline bool operator==(const Image& a, const Image& b) { return a.point == b.point && a.at == b.at; }
inline bool operator<(const Image& a, const Image& b) {
  return a.point < b.point || (a.point == b.point && a.at < b.at);
}

/// The points of a set as they are triangulated in the plane, with all images within a margin around the box,
/// and those of points within the margin of an end of the direction that has no period. No coordinate is
/// farther away than two periods, so no image is rounded.
class Unrolled {
 public:
  /// No points.
  Unrolled() = default;
  /// runtime: its threads are used; null for this one alone. places: of the set's points. O(n).
  Unrolled(host::Runtime* runtime, std::vector<double> places, const Box& box, double margin);
  /// The places again. Images are no longer there.
  std::vector<double> take_places();

  const Box& box() const { return box_; }
  double margin() const { return margin_; }
  /// x and y of all: the points in their order, and then images.
  const std::vector<double>& coordinates() const { return coordinates_; }
  std::size_t points() const { return points_; }
  std::size_t images() const { return images_.size(); }
  /// Whether a point and all its neighbours are there, whatever the points are.
  bool is_whole() const;
  geometry::Point place(std::int32_t v) const {
    const std::size_t at = 2 * static_cast<std::size_t>(v);
    return {coordinates_[at], coordinates_[at + 1]};
  }
  /// What is at a place; points are numbered from 0.
  Image image(std::int32_t v) const {
    const auto i = static_cast<std::size_t>(v);
    return i < points_ ? Image{v, {}} : images_[i - points_];
  }

 private:
  bool is_near_end(double x, std::size_t axis) const;
  Pair<int> images_along(double x, std::size_t axis, bool all) const;

  Box box_;
  double margin_ = 0;
  std::size_t points_ = 0;
  std::vector<double> coordinates_;
  std::vector<Image> images_;
};

/// Triangles of a set, numbered from 0, as points are.
struct Triangles {
  std::vector<std::int32_t> corners, neighbors;
  std::vector<std::int8_t> offsets;
};

/// Turns the triangles of a plane, which have no offsets yet, into those of the torus or the cylinder: of all
/// images of a triangle one is kept. representatives: of the set's points, numbered from 0. Returns whether
/// they are the canonical Delaunay triangulation; otherwise the margin was too small, and they are
/// unspecified. runtime: as of Unrolled. O(t).
bool fold(host::Runtime* runtime, const Unrolled& plane, const std::vector<std::int32_t>& representatives,
          Triangles& triangles);

/// Whether all that lies in the box lies in the hull, by some distance. O(h).
bool is_box_inside(const Unrolled& plane, const std::vector<std::int32_t>& hull);

/// For each triangle in the plane that touches the box, the one that it is an image of; -1 for others. Empty
/// if one of them is the image of none, or longer than the margin. Of a whole plane it is -1 for those that
/// are images of none, which lie outside, and the result is empty if some triangle has no image. O(t).
std::vector<std::int32_t> originals(host::Runtime& runtime, const Unrolled& plane,
                                    const std::vector<std::int32_t>& corners,
                                    const PeriodicTriangulation& mesh);

}  // namespace flaunay::periodic
