// The magnitudes of points in device memory.
#pragma once

#include "geometry/magnitudes.hpp"
#include "host/runtime.hpp"

namespace flaunay::points {

/// Finds the magnitudes of n points, x0 y0 x1 y1 ... Waits once. Temporary memory: 12 bytes. O(n).
geometry::Magnitudes inspect(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n);

/// The magnitudes of each of several sets. offsets: sets + 1. Temporary memory: 16 bytes a set.
std::vector<geometry::Magnitudes> inspect_sets(host::Runtime& runtime, const host::Buffer<cl_double>& points,
                                               const std::vector<std::size_t>& offsets);

/// Points whose sets have the same scaling.
struct UniformPoints {
  host::Buffer<cl_double> coordinates;
  geometry::Scaling scaling;
  /// The powers of two by which the caller's points were multiplied, including the scaling: one for all sets,
  /// or one per set.
  std::vector<int> shifts;
  /// The magnitudes of the caller's points by set, if that took no pass of its own; otherwise empty.
  std::vector<geometry::Magnitudes> by_set;
};

/// Chooses the scaling of sets of points. If the magnitudes of sets differ too much for one, the points are a
/// copy in the runtime's arena in which each set is scaled by its own; otherwise they are those given. Throws
/// Error(input), which names a point, if one is not finite or if magnitudes differ too much in a set; points
/// are copied to the host only in that case. Waits once, for such a copy twice, and not at all for few points
/// that are in host memory, too. host_points: these, or null. O(n).
geometry::Fitted<UniformPoints> make_uniform(host::Runtime& runtime, const host::Buffer<cl_double>& points,
                                             const std::vector<std::size_t>& offsets,
                                             const double* host_points = nullptr);

/// Returns n points as they are, or if the shift is not 0, a copy in the runtime's arena, multiplied by
/// 2^shift. Does not wait. O(n).
host::Buffer<cl_double> scaled(host::Runtime& runtime, const host::Buffer<cl_double>& points, std::size_t n,
                               int shift);

/// Converts n points from `first` on to double precision, which is exact. narrow: x0 y0 x1 y1 ... Does not
/// wait. O(n).
void widen(host::Runtime& runtime, const host::Buffer<cl_float>& narrow, std::size_t first, std::size_t n,
           const host::Buffer<cl_double>& wide);

}  // namespace flaunay::points
