// Points of the unit sphere as places in a plane: the stereographic projection from the south pole. The host and
// kernels compute by this text, from operations that IEEE 754 rounds correctly, so that places are the same everywhere.
#ifndef FLAUNAY_SPHERE_PLACES_H
#define FLAUNAY_SPHERE_PLACES_H

#include "arithmetic/exact_arithmetic.h"
#include "arithmetic/language.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// Places are multiples of 2^-65, and below 2^62: what would be farther is the south pole, whose place is infinite.
#define FARTHEST_PLACE 0x1p62

// Doubles from 2^-13 on are multiples of the finest place. Smaller numbers are rounded to multiples of twice that by
// adding and subtracting 3 of these.
#define FINE_PLACE 0x1p-13
static inline double rounded_coordinate(double x) {
  return fabs(x) >= FINE_PLACE ? x : (x + 3 * FINE_PLACE) - 3 * FINE_PLACE + 0.0;  // no -0
}

static inline double2 rounded_place(double x, double y) {
  // Not so either if they are not finite.
  const int is_near = fabs(x) < FARTHEST_PLACE && fabs(y) < FARTHEST_PLACE;
  return is_near ? VECTOR(double2, rounded_coordinate(x), rounded_coordinate(y)) : VECTOR(double2, HUGE_VAL, HUGE_VAL);
}

static inline int is_no_direction(double x, double y, double z) {
  const int is_finite = fabs(x) < HUGE_VAL && fabs(y) < HUGE_VAL && fabs(z) < HUGE_VAL;
  return !is_finite || (x == 0 && y == 0 && z == 0);
}
static inline int are_no_degrees(double longitude, double latitude) {
  return !(fabs(longitude) < HUGE_VAL && fabs(latitude) <= 90);
}

// The place of a vector whose squares neither overflow nor vanish.
static inline double2 place_of_vector(double x, double y, double z) {
  const double across = x * x + y * y, length = sqrt(across + z * z);
  // In the south without a difference of nearly equal numbers. Without a branch, as half of all points are there.
  const double above = z >= 0 ? 1 : length - z, below = z >= 0 ? length + z : across;
  const double factor = above / below;
  return rounded_place(x * factor, y * factor);
}

static inline double2 place_of_direction(double x, double y, double z) {
  // Not by fmax, which C++ calls.
  const double across = fabs(x) > fabs(y) ? fabs(x) : fabs(y), most = across > fabs(z) ? across : fabs(z);
  if (most > 0x1p-200 && most < 0x1p200) return place_of_vector(x, y, z);
  const int exponent = -ilogb(most);
  return place_of_vector(ldexp(x, exponent), ldexp(y, exponent), ldexp(z, exponent));
}

typedef struct {
  double sine, cosine;
} turn_ratios;

// Sine and cosine of at most 45 degrees, with errors of about an ulp: Taylor's series of the rounded number of radians,
// and what was rounded away.
#define TAYLOR_TERMS 9
#define RADIANS_HIGH 0x1.1df46a2529d39p-6  // pi / 180
#define RADIANS_LOW 0x1.5c1d8becdd291p-62
static inline turn_ratios small_turn(double degrees) {
  const double2 radians = two_product(degrees, RADIANS_HIGH);
  const double x = radians.x, tail = radians.y + degrees * RADIANS_LOW, square = x * x;
  double sine = 0, cosine = 0;  // what is missing from 1, relative to the first term
  for (int k = 2 * TAYLOR_TERMS; k > 0; k -= 2) {
    sine = (1 - sine) * square / (k * (k + 1.0));
    cosine = (1 - cosine) * square / (k * (k - 1.0));
  }
  sine = x - x * sine;
  cosine = 1 - cosine;
  const turn_ratios turn = {sine + tail * cosine, cosine - tail * sine};
  return turn;
}

// Sine and cosine of any angle; exact at multiples of 90 degrees.
static inline turn_ratios turn_of(double degrees) {
  const double turned = remainder(degrees, 360.0);
  const double quarters = rint(turned / 90);  // -2 to 2
  const turn_ratios rest = small_turn(turned - 90 * quarters);
  const int quarter = (int)quarters & 3;
  turn_ratios turn = rest;
  if (quarter & 1) {
    turn.sine = rest.cosine;
    turn.cosine = -rest.sine;
  }
  if (quarter & 2) {
    turn.sine = -turn.sine;
    turn.cosine = -turn.cosine;
  }
  return turn;
}

static inline double2 place_of_degrees(double longitude, double latitude) {
  const turn_ratios across = turn_of(longitude), up = turn_of(latitude);
  const double radius = latitude >= 0 ? up.cosine / (1 + up.sine) : (1 - up.sine) / up.cosine;
  return rounded_place(radius * across.cosine, radius * across.sine);
}

END_SHARED

#endif

#endif
