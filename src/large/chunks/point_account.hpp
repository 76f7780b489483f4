// Properties of all points that must be known before the first of them is triangulated.
#pragma once

#include <cstddef>

#include "arithmetic/records.h"
#include "geometry/magnitudes.hpp"
#include "host/native/threads.hpp"

namespace flaunay::chunks {

/// The box that has no point.
kernel::vertex_box no_box();

/// The smallest box that has both.
kernel::vertex_box joined(const kernel::vertex_box& a, const kernel::vertex_box& b);

/// The magnitudes of points, and the box around them.
struct PointAccount {
  geometry::Magnitudes magnitudes;
  kernel::vertex_box box = no_box();
};

/// The account of n points, computed by several threads. If a point is not finite, `magnitudes.bad` is set,
/// and the rest may lack points.
PointAccount account_of(host::Threads& threads, const double* coordinates, std::size_t n);

/// The account of two sets of points together.
PointAccount joined(const PointAccount& a, const PointAccount& b);

}  // namespace flaunay::chunks
