// Points of the sphere to places in the plane (sphere/places.h), with one work-item per point in one pass. `found` gets
// the first point that is none, and the first one at the south pole, if they are below what it has.

#include "sphere/places.h"

#ifndef FIXED_POINT

// width: 3 for directions, 2 for degrees.
static inline void write_place(int i, int width, double x, double y, double z, global double2* places,
                               global volatile int* found) {
  const int is_wrong = width == 3 ? is_no_direction(x, y, z) : are_no_degrees(x, y);
  if (is_wrong) {
    atomic_min(&found[0], i);
    return;
  }
  const double2 place = width == 3 ? place_of_direction(x, y, z) : place_of_degrees(x, y);
  places[i] = place;
  if (place.x > FARTHEST_PLACE) atomic_min(&found[1], i);
}

// points: from the number `first` on.
kernel void places_of_doubles(int n, int width, uint64 first, global const double* restrict points,
                              global double2* restrict places, global volatile int* found) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* const p = points + first + (uint64)width * i;
    write_place(i, width, p[0], p[1], width == 3 ? p[2] : 0, places, found);
  }
}

kernel void places_of_floats(int n, int width, uint64 first, global const float* restrict points,
                             global double2* restrict places, global volatile int* found) {
  const int i = get_global_id(0);
  if (i < n) {
    global const float* const p = points + first + (uint64)width * i;
    write_place(i, width, p[0], p[1], width == 3 ? p[2] : 0, places, found);
  }
}

#endif
