// The bounds of a refinement, as numbers that kernels compare.
#pragma once

#include <cstddef>

namespace flaunay::constrained {

/// A smallest angle theta. Squares are multiples of 2^-56, as kernels/predicates/quality.h needs them. All
/// are the same bits on every platform: + - * / and square roots, which are correctly rounded, make them.
struct QualityBounds {
  double squared_sine = 0;  ///< of theta
  /// How far an off-centre is from the middle of an edge at most, in terms of the edge's length; 0 if
  /// theta is 0.
  double off_centre = 0;
  /// A subsegment is encroached by points that see it under at least 180 - 2 theta degrees, with theta not
  /// below 20: the squared cosine of that angle.
  double squared_cosine = 0;
};

/// Throws Error(usage) unless the angle is from 0 to 34 degrees.
QualityBounds quality_bounds(double min_angle);

/// Throws Error(usage) unless all largest areas are 0, for any, or more. what: the things that have them, in
/// the singular.
void check_areas(const double* areas, std::size_t count, const char* what);

}  // namespace flaunay::constrained
