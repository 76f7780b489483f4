// From points on a torus or a cylinder to points in the plane, and from triangles of these back.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "geometry/predicates.hpp"
#include "host/runtime.hpp"
#include "periodic/records.h"
#include "periodic/torus.h"

namespace flaunay::periodic {

/// The lattice of images. Its vectors are rounded to multiples of their units, with the shear in
/// (-x / 2, x / 2]; rounded periods remain as they are.
using Lattice = kernel::periodic_lattice;
Lattice lattice_of(const Period& period);
/// The rounded period.
Period period_of(const Lattice& lattice);
inline bool repeats(const Lattice& lattice, std::size_t axis) { return std::isfinite(lattice.period[axis]); }

/// Takes points into the periods, rounded to multiples of their units. The result is the same on every
/// machine. Throws Error(input) for one that is not finite, with what: the name of a point. first: the number
/// of the first one. places: may be the points. O(n).
void take_into(const Lattice& lattice, const double* points, std::size_t n, std::uint64_t first,
               const char* what, double* places);
/// As a vector.
std::vector<double> to_places(host::Runtime& runtime, const double* points, std::size_t n,
                              const Lattice& lattice, const char* what);

/// The box of one set, and a margin around it. All images of points within the margin are triangulated in the
/// plane, and those of points within the margin of an end of the direction that has no period. No coordinate
/// is farther away than Lattice::reach, so no image is rounded.
struct Box : kernel::periodic_box {
  Lattice lattice{};
};
/// Whether a point and all its neighbours are within the margin, whatever the points are.
bool is_whole(const Box& box);
/// The box of no points, without a margin.
Box box_of(const Lattice& lattice);
/// Widens a box to n more places.
void extend(Box& box, const double* places, std::size_t n);
/// Without a margin.
Box box_of(const double* places, std::size_t first, std::size_t last, const Lattice& lattice);

/// How wide the gaps of so many uniform points may be, with some to spare.
double first_margin(const Box& box, std::size_t n);
/// The factor by which a margin grows that was too small.
constexpr double kWider = 4;
/// Widens the margin of set s. Throws Error(internal) if its box is whole.
void widen(Box& box, std::size_t s);

/// Throws Error(input) for more points and images than can be triangulated in one call.
void check_size(std::size_t points_and_images);

/// Calls visit(image, place) for each image of a point that has place p, in ascending order.
template <typename Visit>
void for_each_image(const Box& box, std::int64_t point, geometry::Point p, const Visit& visit) {
  const kernel::image_range to = kernel::images_around(p, &box.lattice, &box);
  for (int across = to.low[0]; across <= to.high[0]; ++across) {
    for (int up = to.low[1]; up <= to.high[1]; ++up) {
      if (kernel::is_image(p, across, up, &box.lattice, &box) != 0)
        visit(kernel::image_of(point, across, up), kernel::moved(p, across, up, &box.lattice));
    }
  }
}

/// The edges at which triangles that are kept end in the plane. There they are joined to each other.
class Seams {
 public:
  explicit Seams(const Box& box) : box_(box) {}

  void add(const kernel::seam_record& seam);
  /// The triangles of so many different points.
  std::uint64_t expected(std::uint64_t points) const;
  /// Whether so many triangles that are kept, as many as expected, are the canonical Delaunay triangulation;
  /// otherwise the margin was too small. Each edge where one of them ends must have been added. O(s log s).
  bool match(std::uint64_t triangles);
  /// Calls link(at, t) for each edge: entry `at` of `neighbors` is triangle t. After match.
  template <typename Link>
  void for_each_link(const Link& link) const {
    for (std::size_t i = 0; i < edges_.size(); ++i) link(edges_[i].at, edges_[i ^ 1].at / 3);
  }

 private:
  // Images as of a seam, from the same end, which is in its place, for both triangles.
  struct Edge {
    std::uint64_t from, to, own, beyond;
    std::int64_t at;
  };

  Box box_;
  std::vector<Edge> edges_;
  std::uint64_t ends_ = 0;  // edges on the ends of a cylinder
  bool is_torn_ = false;
  double area_ = 0;  // in units of the box's
};

/// Sets of points as they are triangulated in the plane: of each first its points, then their images.
struct Plane {
  std::vector<Box> boxes{};
  std::vector<std::size_t> offsets{};   ///< where sets begin
  std::vector<double> coordinates{};    ///< x and y of all
  std::size_t own = 0;                  ///< places below this number are those of points with these numbers
  std::vector<std::uint64_t> images{};  ///< what is at the other places

  std::size_t places() const { return coordinates.size() / 2; }
  geometry::Point place(std::int32_t v) const {
    const std::size_t at = 2 * static_cast<std::size_t>(v);
    return {coordinates[at], coordinates[at + 1]};
  }
  /// The point or image at a place; points are numbered from 0.
  std::uint64_t image(std::int32_t v) const {
    const auto i = static_cast<std::size_t>(v);
    return i < own ? kernel::image_of(v, 0, 0) : images[i - own];
  }
};

/// About the width, for each set, of the widest circle without points, and on a cylinder of those with
/// centres between its ends; not less. boxes: of all points. O(t).
std::vector<double> widest_gaps(host::Runtime& runtime, const Triangulation& mesh,
                                const std::vector<Box>& boxes);

/// For each triangle in the plane that touches the box, the one that it is an image of; -1 for others. Of a
/// whole plane it is also -1 for those that are images of none, which lie outside. narrow: the sets whose
/// margin is too small: a part of the box is outside of the hull, or a triangle there is the image of none or
/// longer than the margin; also those with a whole plane in which a triangle has no image. O(t).
std::vector<std::int32_t> originals(host::Runtime& runtime, const Plane& plane, const Triangulation& planar,
                                    const Triangulation& mesh, std::vector<std::size_t>& narrow);

}  // namespace flaunay::periodic
