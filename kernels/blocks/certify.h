// Whether a triangle of the points in a frame is one of all points: its circumcircle holds no point of another frame.
// This is decided by floating point with a bound for its errors. If it is in doubt, the answer is no, and a later round
// asks again.
#ifndef FLAUNAY_CERTIFY_H
#define FLAUNAY_CERTIFY_H

#include "arithmetic/language.h"
#include "arithmetic/numbers.h"
#include "arithmetic/records.h"
#include "blocks/records.h"
#include "predicates/bounds.h"

BEGIN_SHARED

#define FRAME_SIDES 4

// The area beyond side k of the rectangle, within the box around all points. Returns 0 if it is empty.
static inline int beyond_side(const block_frame* frame, int k, vertex_box* beyond) {
  *beyond = frame->all;
  if (k == 0) beyond->high.x = frame->rectangle.low.x;
  if (k == 1) beyond->low.x = frame->rectangle.high.x;
  if (k == 2) beyond->high.y = frame->rectangle.low.y;
  if (k == 3) beyond->low.y = frame->rectangle.high.y;
  return beyond->low.x <= beyond->high.x && beyond->low.y <= beyond->high.y;
}

static inline int has_other_frames(const block_frame* frame) {
  vertex_box beyond;
  int any = 0;
  for (int k = 0; k < FRAME_SIDES; ++k) any |= beyond_side(frame, k, &beyond);
  return any;
}

// A circle through `origin`. x and y are its centre relative to `origin`, with errors of at most `error`.
// Relative to the input's origin, which may be far away, the errors could exceed distances of points.
typedef struct {
  coordinate2 origin;
  real x, y, error;
} circle_found;

// Finds the circle through a, b, c. Returns 0 if they are too close to a line. Differences have relative errors
// below u, ROUNDOFF. With d the doubled area, whose error is below 4 u m for the sum m of its terms'
// magnitudes, the centre is n / 2d from a; n is a difference of two products of three, with errors below 8 u.
static inline int circle_through(coordinate2 a, coordinate2 b, coordinate2 c, circle_found* circle) {
  const real2 p = difference2(b, a), q = difference2(c, a);
  const real left = p.x * q.y, right = p.y * q.x;
  const real doubled = left - right;
  const real doubt = 4 * ROUNDOFF * (fabs(left) + fabs(right));
  if (!(fabs(doubled) > 4 * doubt)) return 0;
  const real pp = p.x * p.x + p.y * p.y, qq = q.x * q.x + q.y * q.y;
  const real scale = REAL(0.5) / doubled;
  circle->x = (q.y * pp - p.y * qq) * scale;
  circle->y = (p.x * qq - q.x * pp) * scale;
  const real terms = (fabs(q.y) + fabs(q.x)) * pp + (fabs(p.y) + fabs(p.x)) * qq;
  const real extent = fabs(circle->x) + fabs(circle->y);
  circle->origin = a;
  circle->error = 32 * ROUNDOFF * terms * fabs(scale) + 4 * extent * (doubt * 2 * fabs(scale)) + 4 * ROUNDOFF * extent;
  return 1;
}

// The least distance from x, relative to the origin, to the interval, minus the largest possible error.
static inline real gap_to(real x, coordinate origin, coordinate low, coordinate high, real error) {
  const real to_low = difference(low, origin), to_high = difference(high, origin);
  const real below = to_low - x, above = x - to_high;
  const real gap = below > above ? below : above;
  const real sure = gap - error - 6 * ROUNDOFF * (fabs(x) + fabs(below > above ? to_low : to_high));
  return sure > 0 ? sure : 0;
}

// Whether no point of another frame is inside of the closed circle or on it.
static inline int is_circle_inside(const block_frame* frame, coordinate2 a, coordinate2 b, coordinate2 c) {
  circle_found circle;
  if (!has_other_frames(frame)) return 1;
  if (!circle_through(a, b, c, &circle)) return 0;
  const real extent = fabs(circle.x) + fabs(circle.y);
  const real squared = circle.x * circle.x + circle.y * circle.y;
  const real most = (squared + (3 * extent + 2 * circle.error) * circle.error) * (1 + 16 * ROUNDOFF) + UNDERFLOW_ERROR;
  for (int k = 0; k < FRAME_SIDES; ++k) {
    vertex_box beyond;
    if (beyond_side(frame, k, &beyond)) {
      const real x = gap_to(circle.x, circle.origin.x, beyond.low.x, beyond.high.x, circle.error);
      const real y = gap_to(circle.y, circle.origin.y, beyond.low.y, beyond.high.y, circle.error);
      if (!(x * x + y * y > most)) return 0;
    }
  }
  return 1;
}

// Whether point p is for certain left of the line from a to b or on it.
static inline int is_not_right(coordinate2 a, coordinate2 b, coordinate2 p) {
  const real2 pa = difference2(a, p), pb = difference2(b, p);
  const real left = pa.x * pb.y, right = pa.y * pb.x;
  return left - right >= ORIENT_BOUND * (fabs(left) + fabs(right));
}

// Whether no point of another frame is right of the line from a to b or on the segment.
static inline int is_half_plane_inside(const block_frame* frame, coordinate2 a, coordinate2 b) {
  const vertex_box r = frame->rectangle;
  int inside = r.low.x < a.x && a.x < r.high.x && r.low.y < a.y && a.y < r.high.y && r.low.x < b.x && b.x < r.high.x &&
               r.low.y < b.y && b.y < r.high.y;
  for (int k = 0; inside && k < FRAME_SIDES; ++k) {
    vertex_box beyond;
    if (beyond_side(frame, k, &beyond)) {
      inside = is_not_right(a, b, beyond.low) && is_not_right(a, b, beyond.high) &&
               is_not_right(a, b, VECTOR(coordinate2, beyond.low.x, beyond.high.y)) &&
               is_not_right(a, b, VECTOR(coordinate2, beyond.high.x, beyond.low.y));
    }
  }
  return inside;
}

END_SHARED

#endif
