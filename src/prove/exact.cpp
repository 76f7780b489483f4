#include "prove/exact.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "arithmetic/language.h"

namespace flaunay {
namespace {

namespace mp = boost::multiprecision;
using kernel::WideLong;
// Integers of fixed size, without allocation: wide enough for all but wildly mixed magnitudes.
using Int512 =
    mp::number<mp::cpp_int_backend<512, 512, mp::signed_magnitude, mp::unchecked, void>, mp::et_off>;
using BigInt = mp::number<mp::cpp_int_backend<>, mp::et_off>;

/// Points as integer mantissas (at most 53 bits) times powers of two. A common factor 2^unit is taken out of
/// all: it is positive and leaves the sign of a homogeneous polynomial as it is.
template <int kPoints>
struct Scaled {
  std::int64_t mantissas[2 * kPoints];
  int shifts[2 * kPoints];                     // coordinate i is mantissas[i] * 2^(unit + shifts[i])
  int bits = 0;                                // |mantissas[i] * 2^shifts[i]| < 2^bits
  int unit = std::numeric_limits<int>::max();  // the exponent of the factor

  explicit Scaled(const double* const (&points)[kPoints]) {
    for (int i = 0; i < 2 * kPoints; ++i) {
      int exponent = 0;
      const double fraction = std::frexp(points[i / 2][i % 2], &exponent);  // right for subnormals too
      std::int64_t mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
      exponent -= 53;
      if (mantissa != 0) {
        const int zeros = __builtin_ctzll(static_cast<unsigned long long>(mantissa));
        mantissa /= std::int64_t{1} << zeros;
        exponent += zeros;
        unit = std::min(unit, exponent);
      }
      mantissas[i] = mantissa;
      shifts[i] = exponent;
    }
    if (unit == std::numeric_limits<int>::max()) unit = 0;
    for (int i = 0; i < 2 * kPoints; ++i) {
      if (mantissas[i] == 0) {
        shifts[i] = 0;
        continue;
      }
      shifts[i] -= unit;
      const auto size = static_cast<unsigned long long>(std::abs(mantissas[i]));
      bits = std::max(bits, 64 - __builtin_clzll(size) + shifts[i]);
    }
  }

  template <typename Integer>
  Integer coordinate(int i) const {
    // Shifts the magnitude: shifting a negative number is not defined for every integer type.
    const Integer magnitude = Integer(std::abs(mantissas[i])) << shifts[i];
    return mantissas[i] < 0 ? Integer(-magnitude) : magnitude;
  }

  /// Coordinate `axis` of point p, relative to the last point.
  template <typename Integer>
  Integer difference(int p, int axis) const {
    return coordinate<Integer>(2 * p + axis) - coordinate<Integer>(2 * (kPoints - 1) + axis);
  }
};

template <typename Integer>
int sign(const Integer& value) {
  return (value > 0) - (value < 0);
}

/// Needs 2 * bits + 3 bits and a sign: the differences are below 2^(bits + 1), the determinant below twice
/// the square of that.
template <typename Integer>
int orient2d_sign(const Scaled<3>& points) {
  const Integer acx = points.difference<Integer>(0, 0), acy = points.difference<Integer>(0, 1);
  const Integer bcx = points.difference<Integer>(1, 0), bcy = points.difference<Integer>(1, 1);
  return sign(Integer(acx * bcy - acy * bcx));
}

/// Needs 4 * bits + 8 bits and a sign: with differences below d = 2^(bits + 1), minors and lifts are below 2
/// d^2, and the determinant is below 12 d^4.
template <typename Integer>
int incircle_sign(const Scaled<4>& points) {
  const Integer adx = points.difference<Integer>(0, 0), ady = points.difference<Integer>(0, 1);
  const Integer bdx = points.difference<Integer>(1, 0), bdy = points.difference<Integer>(1, 1);
  const Integer cdx = points.difference<Integer>(2, 0), cdy = points.difference<Integer>(2, 1);
  const Integer a_lift = adx * adx + ady * ady;
  const Integer b_lift = bdx * bdx + bdy * bdy;
  const Integer c_lift = cdx * cdx + cdy * cdy;
  return sign(Integer(a_lift * (bdx * cdy - cdx * bdy) + b_lift * (cdx * ady - adx * cdy) +
                      c_lift * (adx * bdy - bdx * ady)));
}

/// Twice the area of the triangle of points i, j and k.
template <typename Integer>
Integer area(const Scaled<5>& points, int i, int j, int k) {
  const Integer x = points.difference<Integer>(k, 0), y = points.difference<Integer>(k, 1);
  return (points.difference<Integer>(i, 0) - x) * (points.difference<Integer>(j, 1) - y) -
         (points.difference<Integer>(i, 1) - y) * (points.difference<Integer>(j, 0) - x);
}

/// Points a0, a1, b0, b1, p. Needs 3 * bits + 5 bits and a sign: areas are below 2 d^2 with d = 2^(bits + 1),
/// and the sum is below 4 d^3.
template <typename Integer>
int crossing_sign(const Scaled<5>& points, int axis) {
  Integer at_a0 = area<Integer>(points, 2, 3, 0), at_a1 = area<Integer>(points, 2, 3, 1);
  if (at_a0 < 0) at_a0 = -at_a0;
  if (at_a1 < 0) at_a1 = -at_a1;
  return -sign(
      Integer(points.difference<Integer>(0, axis) * at_a1 + points.difference<Integer>(1, axis) * at_a0));
}

/// The lifts of weighted points as the last one of them sees them: integers in a common unit.
template <int kPoints>
struct Lifts {
  Scaled<kPoints> points;
  BigInt lift[kPoints - 1];

  // weights: 4.
  Lifts(const double* const (&given)[kPoints], const double* weights) : points(given) {
    const Scaled<2> of_weights({weights, weights + 2});
    const int shift = 2 * points.unit - of_weights.unit;
    for (int k = 0; k + 1 < kPoints; ++k) {
      const BigInt x = points.template difference<BigInt>(k, 0), y = points.template difference<BigInt>(k, 1);
      const BigInt square = x * x + y * y,
                   heavier = of_weights.coordinate<BigInt>(k) - of_weights.coordinate<BigInt>(kPoints - 1);
      const BigInt unit = BigInt(1) << std::abs(shift);
      lift[k] = shift > 0 ? BigInt(square * unit - heavier) : BigInt(square - heavier * unit);
    }
  }
};

/// An integer times a power of two.
struct Shifted {
  BigInt integer;
  int exponent;

  explicit Shifted(double value) {
    integer = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
    exponent -= 53;
  }
};

/// The sign of value * 2^exponent - number * factor.
int compare(BigInt value, int exponent, const Shifted& number, const BigInt& factor) {
  BigInt other = number.integer * factor;
  const int shift = exponent - number.exponent;
  (shift > 0 ? value : other) *= BigInt(1) << std::abs(shift);
  return sign(BigInt(value - other));
}

/// The vectors from a to b and c; their units are powers of two.
struct Vectors {
  Scaled<3> points;
  BigInt ux = points.difference<BigInt>(0, 0), uy = points.difference<BigInt>(0, 1);
  BigInt vx = points.difference<BigInt>(1, 0), vy = points.difference<BigInt>(1, 1);

  Vectors(const double* a, const double* b, const double* c) : points({b, c, a}) {}
  BigInt cross() const { return ux * vy - uy * vx; }
  BigInt dot() const { return ux * vx + uy * vy; }
  BigInt u() const { return ux * ux + uy * uy; }
  BigInt v() const { return vx * vx + vy * vy; }
};

}  // namespace

int ExactPredicates::exact_orient2d(const double* a, const double* b, const double* c) {
  const Scaled<3> points({a, b, c});
  if (2 * points.bits + 3 <= 127) return orient2d_sign<WideLong>(points);
  if (2 * points.bits + 3 <= 512) return orient2d_sign<Int512>(points);
  return orient2d_sign<BigInt>(points);
}

int ExactPredicates::exact_incircle(const double* a, const double* b, const double* c, const double* d) {
  const Scaled<4> points({a, b, c, d});
  if (4 * points.bits + 8 <= 127) return incircle_sign<WideLong>(points);
  if (4 * points.bits + 8 <= 512) return incircle_sign<Int512>(points);
  return incircle_sign<BigInt>(points);
}

int ExactPredicates::exact_power(const double* a, const double* b, const double* c, const double* d,
                                 const double* weights) {
  const Lifts<4> of({a, b, c, d}, weights);
  BigInt sum = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    sum += of.lift[k] * (of.points.difference<BigInt>(i, 0) * of.points.difference<BigInt>(j, 1) -
                         of.points.difference<BigInt>(j, 0) * of.points.difference<BigInt>(i, 1));
  }
  return sign(sum);
}

int ExactPredicates::exact_power_on_line(const double* a, const double* b, const double* c,
                                         const double* weights) {
  const double in_order[] = {weights[0], weights[2], weights[1], 0};
  const Lifts<3> of({a, c, b}, in_order);
  const int axis = a[0] == c[0] ? 1 : 0;
  const BigInt to_a = of.points.difference<BigInt>(0, axis), to_c = of.points.difference<BigInt>(1, axis);
  const int side = sign(BigInt(of.lift[0] * to_c - of.lift[1] * to_a));
  return to_c > 0 ? side : -side;
}

int ExactPredicates::exact_side_of_crossing(const double* a0, const double* a1, const double* b0,
                                            const double* b1, const double* p, int axis) {
  const Scaled<5> points({a0, a1, b0, b1, p});
  if (3 * points.bits + 5 <= 127) return crossing_sign<WideLong>(points, axis);
  if (3 * points.bits + 5 <= 512) return crossing_sign<Int512>(points, axis);
  return crossing_sign<BigInt>(points, axis);
}

int ExactPredicates::exact_compare_cosine(const double* a, const double* b, const double* c, double square) {
  const Vectors of(a, b, c);
  const BigInt dot = of.dot();
  return compare(dot * abs(dot), 0, Shifted(square), of.u() * of.v());
}

int ExactPredicates::exact_compare_sine(const double* a, const double* b, const double* c, double square) {
  const Vectors of(a, b, c);
  return compare(of.cross() * of.cross(), 0, Shifted(square), of.u() * of.v());
}

int ExactPredicates::exact_compare_area(const double* a, const double* b, const double* c, double area) {
  const Vectors of(a, b, c);
  return compare(of.cross(), 2 * of.points.unit, Shifted(area), 2);
}

int ExactPredicates::exact_compare_lengths(const double* a, const double* b, const double* c) {
  const Vectors of(a, b, c);
  return sign(BigInt(of.u() - of.v()));
}

}  // namespace flaunay
