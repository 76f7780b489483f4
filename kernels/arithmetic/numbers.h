// The numbers that points and predicates are made of, for devices with double precision and for those without it. This
// is all in which the two differ, beside exact predicates (exact_doubles.h and exact_integers.h of predicates).
//
// coordinate is a coordinate, real is what filters compute with:
//                        coordinate                                        real
//   with FIXED_POINT     long, below 2^COORDINATE_BITS in magnitude        float
//   otherwise            double, as predicates/bounds.h limits them        double
// coordinate2 and real2 are two of them. coordinate_pair and real_pair are two in one register, on which predicates
// compute side by side; in OpenCL C the same.
//
// In fixed point, differences of coordinates are exact; as real numbers they are rounded, and multiples of UNIT, so
// that products of four of them neither overflow nor, unless points almost coincide, underflow. docs/exactness.md
// derives the bounds for both.
#ifndef FLAUNAY_NUMBERS_H
#define FLAUNAY_NUMBERS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Bounds of filters have the same type in both. The bounds in predicates/bounds.h are rounded up.
typedef float filter_bound;

// The bits of the caller's numbers.
#ifdef __cplusplus
using double_bits [[gnu::may_alias]] = uint64;
using float_bits [[gnu::may_alias]] = uint;
#else
typedef uint64 double_bits;
typedef uint float_bits;
#endif

// The bits of coordinates in fixed point, without the sign.
INTEGER_CONSTANT(COORDINATE_BITS, 62);

#ifdef FIXED_POINT

typedef int64 coordinate;
typedef float real;
#ifdef __cplusplus
using coordinate2 = long2;
using real2 = float2;
using coordinate_pair = long2;
using real_pair [[gnu::vector_size(8)]] = float;
using real_bits = int;
#else
typedef long2 coordinate2;
typedef float2 real2;
typedef long2 coordinate_pair;
typedef float2 real_pair;
#endif
// A constant of type real.
#define REAL(number) number##f

// Differences are below 2^(COORDINATE_BITS + 1), and below 2^30 as multiples of UNIT.
#define UNIT REAL(0x1p-33)
// More than underflow can add to the error of a sum of products of four differences.
#define UNDERFLOW_ERROR REAL(0x1p-110)
// Beyond all coordinates.
#define COORDINATE_LARGEST 0x7fffffffffffffffL

// An exact difference as a real number, rounded once. Converting halves of 32 bits would take more
// instructions, even where these are faster.
static inline real real_of(int64 difference) { return convert_float(difference) * UNIT; }

static inline real difference(coordinate a, coordinate b) { return real_of(a - b); }
static inline real2 difference2(coordinate2 a, coordinate2 b) {
  return VECTOR(real2, real_of(a.x - b.x), real_of(a.y - b.y));
}

// The difference as a double would round it, to 53 bits, ties to even: on all devices the same. For coordinates that
// are doubles, of at most 53 bits: their differences do not reach 2^63 when rounded.
static inline coordinate rounded_difference(coordinate a, coordinate b) {
  const int64 exact = a - b;
  const uint64 magnitude = as_ulong(exact < 0 ? -exact : exact);
  const int dropped = 11 - (int)clz(magnitude);
  if (dropped <= 0) return exact;
  const uint64 tie = (uint64)1 << (dropped - 1), kept = magnitude >> dropped, rest = magnitude & (2 * tie - 1);
  const int is_up = rest > tie || (rest == tie && (kept & 1) != 0);
  const int64 rounded = as_long((kept + (uint64)is_up) << dropped);
  return exact < 0 ? -rounded : rounded;
}

#else

typedef double coordinate;
typedef double real;
#ifdef __cplusplus
using coordinate2 = double2;
using real2 = double2;
using coordinate_pair [[gnu::vector_size(16)]] = double;
using real_pair [[gnu::vector_size(16)]] = double;
using real_bits = int64;
#else
typedef double2 coordinate2;
typedef double2 real2;
typedef double2 coordinate_pair;
typedef double2 real_pair;
#endif
#define REAL(number) number
#define UNDERFLOW_ERROR 0
#define COORDINATE_LARGEST INFINITY

static inline real difference(coordinate a, coordinate b) { return a - b; }
static inline real2 difference2(coordinate2 a, coordinate2 b) { return a - b; }
static inline coordinate rounded_difference(coordinate a, coordinate b) { return a - b; }

#endif

// Pairs. A struct of two numbers would do in C++, but compilers keep its members apart.
#ifdef __cplusplus
inline coordinate_pair load_pair(const coordinate2* from) {
  coordinate_pair p;
  std::memcpy(&p, from, sizeof p);
  return p;
}
#ifdef FIXED_POINT
inline coordinate2 as_point(coordinate_pair p) { return p; }
inline coordinate_pair as_pair(coordinate2 p) { return p; }
inline real_pair pair_difference(coordinate_pair a, coordinate_pair b) {
  return real_pair{difference(a.x, b.x), difference(a.y, b.y)};
}
#else
inline coordinate2 as_point(coordinate_pair p) { return {p[0], p[1]}; }
inline coordinate_pair as_pair(coordinate2 p) { return coordinate_pair{p.x, p.y}; }
inline real_pair pair_difference(coordinate_pair a, coordinate_pair b) { return a - b; }
#endif
inline real low(real_pair p) { return p[0]; }
inline real high(real_pair p) { return p[1]; }
inline real_pair swapped(real_pair p) { return real_pair{p[1], p[0]}; }
inline real_pair lows(real_pair p, real_pair q) { return real_pair{p[0], q[0]}; }
inline real_pair highs(real_pair p, real_pair q) { return real_pair{p[1], q[1]}; }
constexpr real_bits SIGN_BIT = std::numeric_limits<real_bits>::min();
using real_bits_pair [[gnu::vector_size(2 * sizeof(real_bits))]] = real_bits;
inline real_pair high_negated(real_pair p) {
  return reinterpret_cast<real_pair>(reinterpret_cast<real_bits_pair>(p) ^ real_bits_pair{0, SIGN_BIT});
}
inline real_pair magnitudes(real_pair p) {
  return reinterpret_cast<real_pair>(reinterpret_cast<real_bits_pair>(p) & ~SIGN_BIT);
}
#else
#define load_pair(from) (*(from))  // in global or local memory
static inline coordinate2 as_point(coordinate_pair p) { return p; }
static inline coordinate_pair as_pair(coordinate2 p) { return p; }
static inline real_pair pair_difference(coordinate_pair a, coordinate_pair b) { return difference2(a, b); }
static inline real low(real_pair p) { return p.x; }
static inline real high(real_pair p) { return p.y; }
static inline real_pair swapped(real_pair p) { return p.yx; }
static inline real_pair lows(real_pair p, real_pair q) { return (real_pair)(p.x, q.x); }
static inline real_pair highs(real_pair p, real_pair q) { return (real_pair)(p.y, q.y); }
static inline real_pair high_negated(real_pair p) { return (real_pair)(p.x, -p.y); }
static inline real_pair magnitudes(real_pair p) { return fabs(p); }
#endif

// The error of a sum of products of four differences, whose magnitudes have this sum. Products of two do not underflow.
static inline real error_within(filter_bound bound, real magnitude) {
#ifdef FIXED_POINT
  return bound * magnitude + UNDERFLOW_ERROR;
#else
  return bound * magnitude;
#endif
}

END_SHARED

#endif
