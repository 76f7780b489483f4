// From points on a torus or a cylinder to points in the plane, and from triangles of these back.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "flaunay/periodic.hpp"
#include "geometry/predicates.hpp"
#include "host/runtime.hpp"
#include "periodic/records.h"

namespace flaunay::periodic {

/// Of x and of y.
template <typename T>
using Pair = std::array<T, 2>;

/// The periods, rounded to multiples of their units.
Pair<double> rounded(const Period& period);

/// The periods with their units.
kernel::periodic_axes axes_of(const Pair<double>& period);

/// Takes points into the periods, rounded to multiples of their units. The result is the same on every
/// machine. Throws Error(input), with what: the name of a point, for one that is not finite. O(n).
std::vector<double> to_places(host::Runtime& runtime, const double* points, std::size_t n,
                              const Pair<double>& period, const char* what);

/// The box of one set, and a margin around it.
using Box = kernel::periodic_box;
inline bool repeats(const Box& box, std::size_t axis) { return std::isfinite(box.period[axis]); }
/// Whether a point and all its neighbours are within the margin, whatever the points are.
bool is_whole(const Box& box);
/// Without a margin.
Box box_of(const std::vector<double>& places, std::size_t first, std::size_t last,
           const Pair<double>& period);

/// How wide the gaps of so many uniform points may be, with some to spare.
double first_margin(const Box& box, std::size_t n);
/// By what a margin grows that was too small.
constexpr double kWider = 4;
/// Widens the margin of set s. Throws Error(internal) if its box is whole.
void widen(Box& box, std::size_t s);

/// Throws Error(input) for more points and images than can be triangulated in one call.
void check_size(std::size_t points_and_images);

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
  Unrolled(host::Runtime* runtime, std::vector<double> places, const Box& box);
  /// The places again. Images are no longer there.
  std::vector<double> take_places();

  const Box& box() const { return box_; }
  /// x and y of all: the points in their order, and then images.
  const std::vector<double>& coordinates() const { return coordinates_; }
  std::size_t points() const { return points_; }
  std::size_t images() const { return images_.size(); }
  bool is_whole() const { return periodic::is_whole(box_); }
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
  Box box_{};
  std::size_t points_ = 0;
  std::vector<double> coordinates_;
  std::vector<Image> images_;
};

/// Triangles of a set, numbered from 0, as points are.
struct Triangles {
  std::vector<std::int32_t> corners, neighbors;
  std::vector<std::int8_t> offsets;
};

/// An edge of a triangle in the plane that is kept, with none beyond it that is.
struct BorderEdge {
  Image from, to;        // counter-clockwise
  Image own, beyond;     // opposite corners of both triangles; point -1 if there is none beyond
  geometry::Point a, b;  // the ends' places in the plane
  std::int32_t at;       // 3 t + the corner opposite
};

/// Joins the triangles that are kept of a set at these edges: for each corner opposite to one, the triangle
/// beyond. Nothing if they are not the canonical Delaunay triangulation, so that the margin was too small.
/// expected: how many are kept, which is as many as there must be. O(e log e) for e edges.
std::optional<std::vector<cl_int2>> join(const Box& box, const std::vector<BorderEdge>& edges,
                                         std::size_t expected);

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
