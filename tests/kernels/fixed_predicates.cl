// The predicates in fixed point on arrays of cases, one case a work-item, for fixed_kernels_test.cpp. Without
// double precision, whatever the device has.
#ifndef FIXED_POINT
#define FIXED_POINT
#endif

#include "arithmetic/bit_account.h"
#include "blocks/certify.h"
#include "blocks/records.h"
#include "blocks/seams.h"
#include "predicates/planar.h"

#define NOT_ASKED 3

// Cases of four points, a, b, c, d, and FIXED_SIGNS signs of each: of the filters, of the exact predicates,
// and of those that filters leave to circle_undecided.
kernel void fixed_signs(int n, global const long* restrict cases, global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    const coordinate2 a = vload2(4 * i, cases), b = vload2(4 * i + 1, cases);
    const coordinate2 c = vload2(4 * i + 2, cases), d = vload2(4 * i + 3, cases);
    const int circle = circle_filtered(a, b, c, d, CIRCLE_BOUND);
    const int compared = angle_compared(angle_at(d, a, b), angle_at(c, a, b), ANGLE_BOUND);
    global char* const of = signs + 8 * i;
    of[0] = orient_filtered(a, b, c, ORIENT_BOUND);
    of[1] = angle_side(angle_at(c, a, b), ORIENT_BOUND);
    of[2] = circle;
    of[3] = compared;
    of[4] = orient_exact(a, b, c);
    of[5] = cross_sign(a, b, c, d);
    of[6] = circle_exact(a, b, c, d);
    of[7] = circle == UNDECIDED || compared == UNDECIDED ? circle_undecided(a, b, c, d, ANGLE_BOUND)
                                                         : (char)NOT_ASKED;
  }
}

// Cases of two numbers: their difference as a double rounds it, and the bits of it as a float.
kernel void fixed_differences(int n, global const long* restrict cases, global long* restrict rounded,
                              global uint* restrict floats) {
  const int i = get_global_id(0);
  if (i < n) {
    rounded[i] = rounded_difference(cases[2 * i], cases[2 * i + 1]);
    floats[i] = as_uint(difference(cases[2 * i], cases[2 * i + 1]));
  }
}

// The bits of floats, as those of doubles; and times 2^shift, as integers.
kernel void fixed_numbers(int n, global const uint* restrict floats, global const int* restrict shifts,
                          global ulong* restrict doubles, global long* restrict integers) {
  const int i = get_global_id(0);
  if (i < n) {
    doubles[i] = widened_bits(floats[i]);
    integers[i] = fixed_point(doubles[i], shifts[i]);
  }
}

// Cases of three points, the low and the high corner of a rectangle, and those of the box around all points:
// whether the circle and the half-plane of the first two are within.
kernel void fixed_certificates(int n, global const long* restrict cases, global char* restrict answers) {
  const int i = get_global_id(0);
  if (i < n) {
    const coordinate2 a = vload2(7 * i, cases), b = vload2(7 * i + 1, cases), c = vload2(7 * i + 2, cases);
    block_frame frame;
    frame.rectangle.low = vload2(7 * i + 3, cases);
    frame.rectangle.high = vload2(7 * i + 4, cases);
    frame.all.low = vload2(7 * i + 5, cases);
    frame.all.high = vload2(7 * i + 6, cases);
    answers[2 * i] = is_circle_inside(&frame, a, b, c);
    answers[2 * i + 1] = is_half_plane_inside(&frame, a, b);
  }
}
