// From points on a torus to points in the plane, and from triangles of these back to the torus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/periodic.hpp"

namespace flaunay::periodic {

/// A place in [0, period), rounded to a multiple of the period's last bit. The same on every machine.
double wrapped(double x, double period);

/// The points of one set as they are triangulated in the plane: around 0, in [-period / 2, period / 2), with
/// images up to a margin beyond. No image is rounded, since it is a multiple of the period's last bit and no
/// larger than the period.
struct Unrolled {
  std::vector<double> coordinates;
  std::vector<std::int32_t> points;   ///< per place in the plane, the point that it is an image of
  std::vector<std::int8_t> image_of;  ///< x and y per place in the plane, in periods
  std::size_t originals = 0;          ///< come first, in their order
};

/// The points [first, last) of a set, and their images. margin: at most half the smaller period. O(n).
Unrolled unroll(const std::vector<double>& places, std::size_t first, std::size_t last, const Period& period,
                double margin);

/// How wide the gaps of so many uniform points may be, with some to spare.
double first_margin(std::size_t n, const Period& period);

/// The triangles of a set on the torus, from those in the plane, where `planar` has its set at [set, set +
/// 1).
struct Selected {
  std::vector<std::int32_t> triangles, neighbors;
  std::vector<std::int8_t> offsets;
  bool is_complete = false;  ///< all circles are less wide than the margin, and no triangle is missing
};
/// plane_first: the set's first place in the plane's numbering. vertices: different points of the set. O(t).
Selected select(const Unrolled& plane, const Triangulation& planar, std::size_t set, std::size_t plane_first,
                double margin, std::size_t vertices);

}  // namespace flaunay::periodic
