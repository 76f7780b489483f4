// Places on a torus or a cylinder, and which images of points are triangulated with them.
#ifndef FLAUNAY_PERIODIC_TORUS_H
#define FLAUNAY_PERIODIC_TORUS_H

#include "arithmetic/language.h"
#include "periodic/records.h"

BEGIN_SHARED

// What remains of x >= period when the period is subtracted as often as possible; without a rounding, on every device.
static inline double remaining(double x, double period) {
  const uint64 leading = (uint64)1 << 52, x_bits = as_ulong(x), bits = as_ulong(period);
  const uint64 divisor = (bits & (leading - 1)) | leading;
  uint64 rest = ((x_bits & (leading - 1)) | leading) % divisor;
  // A rest has 53 bits.
  for (int steps = (int)(x_bits >> 52) - (int)(bits >> 52); steps > 0; steps -= 11) {
    rest = (rest << min(steps, 11)) % divisor;
  }
  return convert_double(as_long(rest)) * (as_double(bits & ~(leading - 1)) * 0x1p-52);
}

// x or 0, without a branch, which could often not be predicted.
static inline double if_so(int is_so, double x) { return as_double(as_ulong(x) & (0 - (uint64)is_so)); }

// Of x in [-period / 2, period / 2].
static inline double place_near(double x, periodic_axis axis) {
  const double place = copysign((fabs(x) + axis.whole) - axis.whole, x);
  return place + if_so(place < 0.0, axis.period);
}

// The place of x in [0, period), rounded to a unit; not finite if x is not.
static inline double place_of(double x, periodic_axis axis) {
  if (!(axis.period < INFINITY)) return x + 0.0;
  const double middle = axis.period / 2.0;
  if (x >= 0.0 && x < axis.period) return place_near(x - if_so(x >= middle, axis.period), axis);
  double rest = fabs(x);
  if (!(rest < INFINITY)) return rest;
  // All that follows is without a rounding, until a place is found.
  if (rest >= axis.period) rest = remaining(rest, axis.period);
  if (rest > middle) rest -= axis.period;
  if (x < 0.0) rest = -rest;
  // Of both ends, the lower one.
  return place_near(rest < middle ? rest : rest - axis.period, axis);
}

// An image of a point, so many periods away from its place: -1, 0 or 1. Images have the order of (point, across, up).
static inline uint image_of(int point, int across, int up) { return 9 * (uint)point + (uint)(3 * across + up + 4); }
static inline int point_of(uint image) { return (int)(image / 9); }
static inline int periods_across(uint image) { return (int)(image % 9 / 3) - 1; }
static inline int periods_up(uint image) { return (int)(image % 3) - 1; }
static inline int is_in_place(uint image) { return image % 9 == 4; }

// What is at a place of the plane. Places below `own` are those of the points with these numbers.
static inline uint image_at(int v, int own, GLOBAL const uint* images) {
  return v < own ? image_of(v, 0, 0) : images[v];
}

// How many periods images are away: from low to high, in x and in y.
typedef struct {
  int low[2], high[2];
} image_range;

static inline int is_near_end(double x, const periodic_box* box, int axis) {
  return !(box->period[axis] < INFINITY) && (x <= box->low[axis] + box->margin || x >= box->high[axis] - box->margin);
}

// How many ends of a cylinder a place is on; on both, if all are there.
static inline int ends_at(double x, const periodic_box* box, int axis) {
  return box->period[axis] < INFINITY ? 0 : (x == box->low[axis]) + (x == box->high[axis]);
}

// The images of a point within the margin around the box, and itself. Near an end of the direction without a period,
// the nearest points may be a whole period away.
static inline image_range images_around(double x, double y, const periodic_box* box) {
  const double at[2] = {x, y};
  const int all = is_near_end(x, box, 0) || is_near_end(y, box, 1);
  image_range range = {{0, 0}, {0, 0}};
  for (int axis = 0; axis < 2; ++axis) {
    const double period = box->period[axis];
    if (!(period < INFINITY)) continue;
    if (all || at[axis] >= period - box->margin) range.low[axis] = -1;
    if (all || at[axis] <= box->margin) range.high[axis] = 1;
  }
  return range;
}

// How many periods x is moved by, without a rounding.
static inline double moved(double x, int periods, double period) {
  return periods == 0 ? x : x + (double)periods * period;
}

END_SHARED

#endif
