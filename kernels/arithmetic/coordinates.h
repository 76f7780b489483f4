// Coordinates as they come from the input.
#ifndef FLAUNAY_COORDINATES_H
#define FLAUNAY_COORDINATES_H

#include "arithmetic/bit_account.h"
#include "arithmetic/language.h"
#include "arithmetic/numbers.h"
#include "arithmetic/records.h"

BEGIN_SHARED

#ifdef FIXED_POINT

// An unsigned number in the order of the coordinates, and back.
static inline uint64 orderable(coordinate x) { return as_ulong(x) ^ 0x8000000000000000UL; }
static inline coordinate from_orderable(uint64 key) { return as_long(key ^ 0x8000000000000000UL); }

// A coordinate of the caller's, by the bits of the double, times 2^shift.
static inline coordinate scaled_bits(uint64 bits, int shift) { return fixed_point(bits, shift); }

// The bits of the double that is this integer, which must have at most 53 bits from the first to the last that is set.
static inline uint64 double_bits_of(coordinate x) {
  if (x == 0) return 0;
  const uint64 magnitude = as_ulong(x < 0 ? -x : x);
  const int leading = (int)clz(magnitude), exponent = 63 - leading;
  const uint64 mantissa = leading >= 11 ? magnitude << (leading - 11) : magnitude >> (11 - leading);
  return (x < 0 ? (uint64)1 << 63 : 0) | (uint64)(1023 + exponent) << 52 | (mantissa & MANTISSA_BITS);
}

// Scaled already.
static inline coordinate scaled(coordinate x, scaling scale) { return x; }
static inline coordinate2 scaled_point(int i, GLOBAL const coordinate* input, scaling scale) {
  return vload2(i, input);
}

#else

// An unsigned number in the order of the coordinates, and back; -0 counts as +0.
static inline uint64 orderable(coordinate x) {
  const uint64 bits = as_ulong(x + 0.0);
  return bits >> 63 ? ~bits : bits | 0x8000000000000000UL;
}
static inline coordinate from_orderable(uint64 key) { return as_double(key >> 63 ? key ^ 0x8000000000000000UL : ~key); }

static inline uint64 double_bits_of(coordinate x) { return as_ulong(x); }

INTEGER_CONSTANT(DOUBLE_BITS, 53);  // of a normal number

static inline double power_of_two(int exponent) { return as_double((uint64)(1023 + exponent) << 52); }

// The scale 2^shift, by factors that are doubles.
static inline scaling scale_of(int shift) {
  const int first = shift / 3, second = (shift - first) / 2;
  const scaling scale = {power_of_two(first), power_of_two(second), power_of_two(shift - first - second)};
  return scale;
}

// Exact by the host's choice of the scale.
static inline coordinate scaled(coordinate x, scaling scale) { return ((x * scale.s0) * scale.s1) * scale.s2; }

// A coordinate of the caller's, by the bits of the double, times 2^shift; without negative zeros.
static inline coordinate scaled_bits(uint64 bits, int shift) { return scaled(as_double(bits), scale_of(shift)) + 0.0; }

// Point i of the input, scaled, without negative zeros.
static inline coordinate2 scaled_point(int i, GLOBAL const coordinate* input, scaling scale) {
  const coordinate2 p = vload2(i, input);
  return VECTOR(coordinate2, scaled(p.x, scale) + 0.0, scaled(p.y, scale) + 0.0);
}

#endif

END_SHARED

#endif
