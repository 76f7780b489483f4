// Exact signs of geometric predicates on the host, for any finite doubles. On purpose they share no
// text with the kernels' (kernels/arithmetic, kernels/predicates), so that an error there cannot hide itself
// from the check.
#pragma once

#include <cmath>
#include <cstddef>

namespace flaunay {

/// orient2d and incircle with exact signs, whatever the magnitudes (subnormal to 1.8e308). A floating-point
/// filter decides nearly always; exact integers decide the rest, and are counted. Points are pointers to x,
/// y.
///
/// The filters are Shewchuk's stage A ("Adaptive Precision Floating-Point Arithmetic and Fast Robust
/// Geometric Predicates", 1997, sections 4.2 and 4.4), whose bounds, (3 + 16 eps) eps and (10 + 96 eps) eps
/// with eps = 2^-53, hold as long as nothing overflows or underflows. Ours are 4 eps and 11 eps; the extra
/// (nearly one) eps pays for underflow:
///
/// - A difference of doubles never underflows inexactly. A product may be off by a further u = 2^-1075.
/// - orient2d: two products, so 2 u in all, which eps * magnitude exceeds if magnitude >= 2^-900.
/// - incircle: differences are at most 2^250 in magnitude if the lifts sum to at most 2^500, which is asked
/// for.
///   Then each minor is off by at most 2 u and multiplied by a lift of at most 2^500, each lift is off by at
///   most 2 u and multiplied by a minor of at most 2^501, and the last product adds u: for three terms less
///   than 2^505 u = 2^-570 in all, which eps * magnitude exceeds if magnitude >= 2^-500. (The magnitude
///   itself is off by no more, and is multiplied by 11 eps.)
/// - Overflow makes the bound infinite or not a number in orient2d, and the comparison false; in incircle the
///   limit on the lifts rules it out.
///
/// Needs -ffp-contract=off: a fused product would not have the rounding that the bounds assume.
class ExactPredicates {
 public:
  /// +1 if a, b, c turn left (counter-clockwise), -1 if they turn right, 0 if they are collinear.
  int orient2d(const double* a, const double* b, const double* c) {
    const Area area(a, b, c);
    if (area.magnitude >= 0x1p-900 && std::fabs(area.value) > 4 * kEpsilon * area.magnitude) {
      return area.value > 0 ? 1 : -1;
    }
    ++exact_evaluations_;
    return exact_orient2d(a, b, c);
  }

  /// For a, b, c counter-clockwise: +1 if d is inside their circle, -1 if it is outside, 0 if it is on it.
  /// For a, b, c clockwise the sign is the opposite.
  int incircle(const double* a, const double* b, const double* c, const double* d) {
    const double adx = a[0] - d[0], ady = a[1] - d[1];
    const double bdx = b[0] - d[0], bdy = b[1] - d[1];
    const double cdx = c[0] - d[0], cdy = c[1] - d[1];
    const double bdxcdy = bdx * cdy, cdxbdy = cdx * bdy;
    const double cdxady = cdx * ady, adxcdy = adx * cdy;
    const double adxbdy = adx * bdy, bdxady = bdx * ady;
    const double a_lift = adx * adx + ady * ady;
    const double b_lift = bdx * bdx + bdy * bdy;
    const double c_lift = cdx * cdx + cdy * cdy;
    const double determinant =
        a_lift * (bdxcdy - cdxbdy) + b_lift * (cdxady - adxcdy) + c_lift * (adxbdy - bdxady);
    const double magnitude = (std::fabs(bdxcdy) + std::fabs(cdxbdy)) * a_lift +
                             (std::fabs(cdxady) + std::fabs(adxcdy)) * b_lift +
                             (std::fabs(adxbdy) + std::fabs(bdxady)) * c_lift;
    if (a_lift + b_lift + c_lift <= 0x1p500 && magnitude >= 0x1p-500 &&
        std::fabs(determinant) > 11 * kEpsilon * magnitude) {
      return determinant > 0 ? 1 : -1;
    }
    ++exact_evaluations_;
    return exact_incircle(a, b, c, d);
  }

  /// For weighted points, whose lifts are x^2 + y^2 - weight, and a, b, c counter-clockwise: +1 if the lift
  /// of d is below the plane through the other three lifts, -1 if it is above, 0 if it is on it. Without
  /// weights (null), that is `incircle`. weights: of a, b, c, d.
  ///
  /// The bound: a lift has an error below 5 eps of its magnitude, a minor one of 4 eps, their product adds
  /// one, and the sum of three two. We take 16 for these 12 eps and the error that underflow adds (as above).
  int power(const double* a, const double* b, const double* c, const double* d, const double* weights) {
    if (weights == nullptr) return incircle(a, b, c, d);
    const double* const from[] = {a, b, c};
    double x[3], y[3], lift[3], lift_magnitude[3], determinant = 0, magnitude = 0;
    for (int k = 0; k < 3; ++k) {
      x[k] = from[k][0] - d[0];
      y[k] = from[k][1] - d[1];
      const double square = x[k] * x[k] + y[k] * y[k], heavier = weights[k] - weights[3];
      lift[k] = square - heavier;
      lift_magnitude[k] = square + std::fabs(heavier);
    }
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      determinant += lift[k] * (x[i] * y[j] - x[j] * y[i]);
      magnitude += lift_magnitude[k] * (std::fabs(x[i] * y[j]) + std::fabs(x[j] * y[i]));
    }
    if (lift_magnitude[0] + lift_magnitude[1] + lift_magnitude[2] <= 0x1p500 && magnitude >= 0x1p-500 &&
        std::fabs(determinant) > 16 * kEpsilon * magnitude) {
      return determinant > 0 ? 1 : -1;
    }
    ++exact_evaluations_;
    return exact_power(a, b, c, d, weights);
  }

  /// For weighted points on a line, b between a and c: +1 if the lift of b is below the line through the
  /// others', -1 if it is above, 0 if it is on it.
  int power_on_line(const double* a, const double* b, const double* c, const double* weights) {
    ++exact_evaluations_;
    return exact_power_on_line(a, b, c, weights);
  }

  /// Compares p with the place where the segments a0-a1 and b0-b1 cross, in lexicographic order: +1 if p
  /// comes after it, -1 if before, 0 if it is there. The ends of both are strictly on different sides of the
  /// other.
  ///
  /// On an axis, the place minus p is the mean of a0 - p and a1 - p, with the areas that b spans with the
  /// other end as weights. Four roundings of each product come to less than 9 eps of the magnitudes' product,
  /// for which we take 16 eps, which also pays for underflow as above.
  int compare_with_crossing(const double* a0, const double* a1, const double* b0, const double* b1,
                            const double* p) {
    for (int axis = 0; axis < 2; ++axis) {
      const int side = side_of_crossing(a0, a1, b0, b1, p, axis);
      if (side != 0) return side;
    }
    return 0;
  }

  /// Compares c |c| with a number, where c is the cosine of the angle between ab and ac: +1 if it is greater.
  int compare_cosine(const double* a, const double* b, const double* c, double square) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - a[0], vy = c[1] - a[1];
    const double dot = ux * vx + uy * vy;
    return compare_squares(dot * std::fabs(dot), ux * ux + uy * uy, vx * vx + vy * vy, square,
                           [&] { return exact_compare_cosine(a, b, c, square); });
  }

  /// Compares the squared sine of that angle with a number.
  int compare_sine(const double* a, const double* b, const double* c, double square) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - a[0], vy = c[1] - a[1];
    const double cross = ux * vy - uy * vx;
    return compare_squares(cross * cross, ux * ux + uy * uy, vx * vx + vy * vy, square,
                           [&] { return exact_compare_sine(a, b, c, square); });
  }

  /// Compares the area of a counter-clockwise triangle with a number: +1 if it is larger.
  int compare_area(const double* a, const double* b, const double* c, double area) {
    const Area twice(a, b, c);
    const double excess = twice.value - 2 * area;
    // Between them is a rounding that leaves the sign right.
    if (twice.magnitude >= 0x1p-900 && std::fabs(excess) > 5 * kEpsilon * twice.magnitude) {
      return excess > 0 ? 1 : -1;
    }
    ++exact_evaluations_;
    return exact_compare_area(a, b, c, area);
  }

  /// Compares the lengths of ab and ac: +1 if ab is longer.
  int compare_lengths(const double* a, const double* b, const double* c) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], vx = c[0] - a[0], vy = c[1] - a[1];
    const double ab = ux * ux + uy * uy, ac = vx * vx + vy * vy;
    if (ab >= 0x1p-900 && ac >= 0x1p-900 && std::fabs(ab - ac) > 6 * kEpsilon * (ab + ac)) {
      return ab > ac ? 1 : -1;
    }
    ++exact_evaluations_;
    return exact_compare_lengths(a, b, c);
  }

  /// How many calls floating point could not decide.
  std::size_t exact_evaluations() const { return exact_evaluations_; }

 private:
  static constexpr double kEpsilon = 0x1p-53;  // half a unit in the last place of 1, as in Shewchuk's paper

  /// Compares value, the square of a product of two vectors, with `square`, at most 1, times these squared
  /// lengths.
  ///
  /// The product has an error below 4.1 eps of the lengths, so its square one of 9.3 eps of their squares'
  /// product; the other side of the comparison has ten roundings. We take 24 eps, and nothing overflows or
  /// underflows.
  template <typename Exactly>
  int compare_squares(double value, double u, double v, double square, const Exactly& exactly) {
    const double lengths = u * v, excess = value - square * lengths;
    if (lengths >= 0x1p-900 && u >= 0x1p-900 && v >= 0x1p-900 && lengths <= 0x1p900 &&
        std::fabs(excess) > 24 * kEpsilon * lengths) {
      return excess > 0 ? 1 : -1;
    }
    ++exact_evaluations_;
    return exactly();
  }

  int side_of_crossing(const double* a0, const double* a1, const double* b0, const double* b1,
                       const double* p, int axis) {
    const Area at_a0(b0, b1, a0), at_a1(b0, b1, a1);
    const double before = (p[axis] - a0[axis]) * std::fabs(at_a1.value);
    const double after = (p[axis] - a1[axis]) * std::fabs(at_a0.value);
    const double magnitude =
        std::fabs(p[axis] - a0[axis]) * at_a1.magnitude + std::fabs(p[axis] - a1[axis]) * at_a0.magnitude;
    if (at_a0.magnitude >= 0x1p-900 && at_a1.magnitude >= 0x1p-900 && magnitude >= 0x1p-900 &&
        std::fabs(before + after) > 16 * kEpsilon * magnitude) {
      return before + after > 0 ? 1 : -1;
    }
    ++exact_evaluations_;
    return exact_side_of_crossing(a0, a1, b0, b1, p, axis);
  }

  /// Twice the area of a triangle, rounded, and the magnitude that bounds its error.
  struct Area {
    double value, magnitude;
    Area(const double* a, const double* b, const double* c) {
      const double left = (a[0] - c[0]) * (b[1] - c[1]), right = (a[1] - c[1]) * (b[0] - c[0]);
      value = left - right;
      magnitude = std::fabs(left) + std::fabs(right);
    }
  };

  static int exact_orient2d(const double* a, const double* b, const double* c);
  static int exact_incircle(const double* a, const double* b, const double* c, const double* d);
  static int exact_power(const double* a, const double* b, const double* c, const double* d,
                         const double* weights);
  static int exact_power_on_line(const double* a, const double* b, const double* c, const double* weights);
  static int exact_side_of_crossing(const double* a0, const double* a1, const double* b0, const double* b1,
                                    const double* p, int axis);
  static int exact_compare_cosine(const double* a, const double* b, const double* c, double square);
  static int exact_compare_sine(const double* a, const double* b, const double* c, double square);
  static int exact_compare_area(const double* a, const double* b, const double* c, double area);
  static int exact_compare_lengths(const double* a, const double* b, const double* c);

  std::size_t exact_evaluations_ = 0;
};

/// The lexicographic order, by x and then by y.
inline bool comes_before(const double* a, const double* b) {
  return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1];
}

/// Two triangles on one circle meet at the edge from a to b, with c and d opposite to it. Returns whether the
/// edge begins or ends at the lexicographically smallest of the four, as all edges of the canonical fan do.
inline bool is_of_fan(const double* a, const double* b, const double* c, const double* d) {
  const double* const first = comes_before(a, b) ? a : b;
  return comes_before(first, c) && comes_before(first, d);
}

}  // namespace flaunay
