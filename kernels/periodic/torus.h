// Places on a torus or a cylinder, and which images of points are triangulated with them.
#ifndef FLAUNAY_PERIODIC_TORUS_H
#define FLAUNAY_PERIODIC_TORUS_H

#include "arithmetic/language.h"
#include "periodic/records.h"

BEGIN_SHARED

// The remainder of x >= period when the period is subtracted as often as possible; without a rounding, on every device.
// step: 0, or what is added to *steps each time, modulo whole < 2^52.
static inline double remaining(double x, double period, uint64 step, uint64 whole, uint64* steps) {
  const uint64 leading = (uint64)1 << 52, x_bits = as_ulong(x), bits = as_ulong(period);
  const uint64 divisor = (bits & (leading - 1)) | leading;
  uint64 rest = (x_bits & (leading - 1)) | leading;
  *steps = rest < divisor ? 0 : step;
  rest %= divisor;
  // A rest has 53 bits.
  for (int left = (int)(x_bits >> 52) - (int)(bits >> 52); left > 0; left -= 11) {
    const int shift = min(left, 11);
    rest <<= shift;
    if (step > 0) *steps = ((*steps << shift) + rest / divisor * step) % whole;
    rest %= divisor;
  }
  return convert_double(as_long(rest)) * (as_double(bits & ~(leading - 1)) * 0x1p-52);
}

// x or 0, without a branch, which could often not be predicted.
static inline double if_so(int is_so, double x) { return as_double(as_ulong(x) & (0 - (uint64)is_so)); }

// x in [-period / 2, period / 2], rounded to a unit.
static inline double in_units(double x, double whole) { return copysign((fabs(x) + whole) - whole, x); }

// The place of a coordinate in [0, period), rounded to a unit; not finite if x is not. With a shear, *along becomes how
// far the periods between both move a point along x, in units: more than -1 and less than 1 period.
static inline double place_along(double x, int axis, const periodic_lattice* lattice, int64* along) {
  const double period = lattice->period[axis];
  if (!(period < INFINITY)) return x + 0.0;
  const double middle = period / 2.0;
  const int64 step = axis == 1 ? lattice->across[1] : 0;
  uint64 passed = 0;
  int periods = 0;
  double rest;
  if (x >= 0.0 && x < period) {
    periods = x >= middle;
    rest = x - if_so(periods, period);
  } else {
    rest = fabs(x);
    if (!(rest < INFINITY)) return rest;
    // All that follows is without a rounding, until a place is found.
    if (rest >= period) {
      rest = remaining(rest, period, as_ulong(step < 0 ? step + lattice->across[0] : step),
                       as_ulong(lattice->across[0]), &passed);
    }
    if (rest > middle) {
      rest -= period;
      periods = 1;
    }
    if (x < 0.0) {
      rest = -rest;
      periods = -periods;
      passed = 0 - passed;
    }
    // Halfway between both ends, the lower one.
    if (!(rest < middle)) {
      rest -= period;
      ++periods;
    }
  }
  rest = in_units(rest, lattice->whole[axis]);
  if (step != 0) *along = (as_long(passed) + (periods - (rest < 0.0)) * step) % lattice->across[0];
  return rest + if_so(rest < 0.0, period);
}

static inline int is_sheared(const periodic_lattice* lattice) { return lattice->across[1] != 0; }
// The unit of x.
static inline double unit_across(const periodic_lattice* lattice) { return lattice->whole[0] * 0x1p-52; }

// The place of a point.
static inline double2 place_in(double2 p, const periodic_lattice* lattice) {
  int64 along = 0;
  const double x = place_along(p.x, 0, lattice, &along), y = place_along(p.y, 1, lattice, &along);
  if (!is_sheared(lattice)) return VECTOR(double2, x, y);
  const double period = lattice->period[0], place = x - convert_double(along) * unit_across(lattice);
  return VECTOR(double2, place < 0.0 ? place + period : place < period ? place : place - period, y);
}

// An image of a point, which is moved by so many vectors of the lattice from its place. Images have the order of
// (point, across, up). Points have less than 44 bits.
static inline uint64 image_of(int64 point, int across, int up) {
  return as_ulong(point) << 20 | (uint64)(across + 512) << 10 | (uint64)(up + 512);
}
static inline int64 point_of(uint64 image) { return as_long(image >> 20); }
static inline int vectors_across(uint64 image) { return (int)(image >> 10 & 1023) - 512; }
static inline int vectors_up(uint64 image) { return (int)(image & 1023) - 512; }
static inline int is_in_place(uint64 image) { return (image & 0xfffff) == 0x80200; }
// The image when `to` is in its place.
static inline uint64 image_beside(uint64 image, uint64 to) {
  return image_of(point_of(image), vectors_across(image) - vectors_across(to), vectors_up(image) - vectors_up(to));
}

// The image of a triangle in the plane is kept whose smallest corner is the point itself. Rows begin with
// the corner of the smallest number, and points come before images: such a corner is the first one.
static inline int is_kept(uint64 first, uint64 second, uint64 third) {
  return is_in_place(first) && first < second && first < third;
}

// The point or image at a place of the plane. Places below `own` are those of the points with these numbers.
static inline uint64 image_at(int v, int own, GLOBAL const uint64* images) {
  return v < own ? image_of(v, 0, 0) : images[v];
}

// How far an image is moved along x, in units.
static inline int64 units_across(int across, int up, const periodic_lattice* lattice) {
  return across * lattice->across[0] + up * lattice->across[1];
}

// A place moved by vectors of the lattice; without a rounding, if it is within reach of the box.
static inline double2 moved(double2 p, int across, int up, const periodic_lattice* lattice) {
  return VECTOR(double2, p.x + convert_double(units_across(across, up, lattice)) * unit_across(lattice),
                up == 0 ? p.y : p.y + (double)up * lattice->period[1]);
}

static inline int is_near_end(double x, int axis, const periodic_lattice* lattice, const periodic_box* box) {
  return !(lattice->period[axis] < INFINITY) &&
         (x <= box->low[axis] + box->margin || x >= box->high[axis] - box->margin);
}

// How many ends of a cylinder a place is on; on both, if all are there.
static inline int ends_at(double x, int axis, const periodic_lattice* lattice, const periodic_box* box) {
  return lattice->period[axis] < INFINITY ? 0 : (x == box->low[axis]) + (x == box->high[axis]);
}

// How many vectors images are away: from low to high, along x and up.
typedef struct {
  int low[2], high[2];
} image_range;

static inline double least_of(double a, double b) { return b < a ? b : a; }

// Among these are all images of a point within the margin around the box, and itself; without a shear no others. Near
// an end of the direction without a period, the nearest points may be a whole period away.
static inline image_range images_around(double2 p, const periodic_lattice* lattice, const periodic_box* box) {
  const double at[2] = {p.x, p.y};
  image_range range = {{0, 0}, {0, 0}};
  if (is_sheared(lattice)) {
    const double up = lattice->period[1], across = lattice->period[0];
    const double above = least_of(box->margin, lattice->reach[1]), beside = least_of(box->margin, lattice->reach[0]);
    range.low[1] = max(-lattice->most[1], -1 - (int)((p.y + above) / up));
    range.high[1] = min(lattice->most[1], 1 + (int)((up - p.y + above) / up));
    const double shear = convert_double(lattice->across[1]) / convert_double(lattice->across[0]);
    const double first = shear * range.low[1], last = shear * range.high[1];
    range.low[0] = max(-lattice->most[0], -1 - (int)((p.x + beside) / across + (first < last ? last : first)));
    range.high[0] = min(lattice->most[0], 1 + (int)((across - p.x + beside) / across - least_of(first, last)));
    return range;
  }
  const int all = is_near_end(p.x, 0, lattice, box) || is_near_end(p.y, 1, lattice, box);
  for (int axis = 0; axis < 2; ++axis) {
    const double period = lattice->period[axis];
    if (!(period < INFINITY)) continue;
    if (all || at[axis] >= period - box->margin) range.low[axis] = -1;
    if (all || at[axis] <= box->margin) range.high[axis] = 1;
  }
  return range;
}

static inline int is_within(double x, int axis, const periodic_lattice* lattice, const periodic_box* box) {
  const double period = lattice->period[axis], margin = least_of(box->margin, lattice->reach[axis]);
  return x < 0.0 ? x + period >= period - margin : x - period <= margin;
}

// Whether one in the range is an image within the margin.
static inline int is_image(double2 p, int across, int up, const periodic_lattice* lattice, const periodic_box* box) {
  if (across == 0 && up == 0) return 0;
  if (!is_sheared(lattice)) return 1;
  const int64 units = units_across(across, up, lattice), most = 2 * lattice->across[0];
  if (units < -most || units > most) return 0;
  const double2 image = moved(p, across, up, lattice);
  return is_within(image.x, 0, lattice, box) && is_within(image.y, 1, lattice, box);
}

END_SHARED

#endif
