// Queries and the points that they are held against, scaled for exact predicates: see query_frame in points/records.h.
#ifndef FLAUNAY_QUERY_FRAMES_H
#define FLAUNAY_QUERY_FRAMES_H

#include "arithmetic/coordinates.h"
#include "arithmetic/language.h"
#include "points/records.h"

BEGIN_SHARED

#ifdef FIXED_POINT

// A point of the locator as queries are scaled: by 2^unit, which is exact by the host's choice.
static inline coordinate shifted(coordinate x, coordinate unit) {
  return unit >= 0 ? as_long(as_ulong(x) << unit) : x >> -unit;
}
static inline coordinate2 in_frame(coordinate2 p, coordinate unit) {
  return VECTOR(coordinate2, shifted(p.x, unit), shifted(p.y, unit));
}

// The place of the grid nearest to a coordinate of the caller's, by the bits of the double, times 2^shift: mostly the
// coordinate itself, otherwise a place towards 0, or the last one of the grid.
#define LAST_PLACE (((int64)1 << COORDINATE_BITS) - 1)
static inline coordinate grid_place(uint64 bits, int shift) {
  const uint64 mantissa = mantissa_of(bits & MAGNITUDE_BITS);
  const int up = unit_of(bits & MAGNITUDE_BITS) + shift;
  int64 place = LAST_PLACE;
  if (up <= 0) {
    place = up > -64 ? as_long(mantissa >> -up) : 0;
  } else if (mantissa == 0 || up <= COORDINATE_BITS - 64 + (int)clz(mantissa)) {
    place = as_long(mantissa << (up & 63));
  }
  return bits >> 63 ? -place : place;
}

static inline coordinate2 grid_point(int i, GLOBAL const coordinate* queries, int shift) {
  const coordinate2 bits = vload2(i, queries);
  return VECTOR(coordinate2, grid_place(as_ulong(bits.x), shift), grid_place(as_ulong(bits.y), shift));
}

// Query i of the caller's, scaled; if it is not on the grid, the place nearest to it.
static inline coordinate2 placed_query(int i, GLOBAL const coordinate* queries, query_frame frame) {
  return grid_point(i, queries, frame.shift);
}

// Query i as the points are that trees are made of.
static inline coordinate2 query_in_tree(int i, GLOBAL const coordinate* queries, query_frame frame) {
  return grid_point(i, queries, frame.shift - (int)frame.unit);
}

#else

static inline coordinate2 in_frame(coordinate2 p, coordinate unit) {
  return VECTOR(coordinate2, unit * p.x, unit * p.y);
}

static inline coordinate2 placed_query(int i, GLOBAL const coordinate* queries, query_frame frame) {
  return scaled_point(i, queries, frame.scale);
}

// Trees are made of points as the caller gave them.
static inline coordinate2 query_in_tree(int i, GLOBAL const coordinate* queries, query_frame frame) {
  (void)frame;
  return vload2(i, queries);
}

#endif

END_SHARED

#endif
