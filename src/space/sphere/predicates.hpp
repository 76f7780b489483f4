// Exact decisions about places on the sphere.
#pragma once

#include "space/sphere/places.hpp"

namespace flaunay::sphere {

/// The determinant of the vectors (x, y, 1 - x^2 - y^2) of three places, and (0, 0, -1) of the pole, computed
/// exactly and rounded.
double determinant(Point a, Point b, Point c);

/// 1 if the arcs of great circles from a to b and from b to c turn left, as seen from outside; -1 if they
/// turn right, 0 if the three lie on one great circle. The determinant's sign.
int turn(Point a, Point b, Point c);

/// 1 if q lies within the circle through a, b and c, which turn left as seen from within the cap that counts;
/// -1 if it lies outside, 0 if it lies on the circle. None is q.
int in_cap(Point a, Point b, Point c, Point q);

/// 1 if a is nearer to q than b is, -1 if it is farther, 0 if both are equally far.
int nearer(Point q, Point a, Point b);

/// Whether a comes before b in the canonical order: the pole first, then by x, then by y.
inline bool comes_first(Point a, Point b) {
  return !is_pole(b) && (is_pole(a) || kernel::comes_before(a, b) != 0);
}

}  // namespace flaunay::sphere
