// Whether a triangle of a block's triangulation is one of all points: its circumcircle holds no point of another block.
// This is decided by floating point with a bound for its errors. If it is in doubt, the answer is no, and a later round
// asks again.
#ifndef FLAUNAY_CERTIFY_H
#define FLAUNAY_CERTIFY_H

#include "shared/bounds.h"
#include "shared/language.h"
#include "shared/records.h"

BEGIN_SHARED

#define FRAME_SIDES 4

// What lies beyond side k of the rectangle, within the box around all points. Returns 0 if there is nothing.
static inline int beyond_side(const block_frame* frame, int k, vertex_box* beyond) {
  *beyond = frame->all;
  if (k == 0) beyond->high.x = frame->rectangle.low.x;
  if (k == 1) beyond->low.x = frame->rectangle.high.x;
  if (k == 2) beyond->high.y = frame->rectangle.low.y;
  if (k == 3) beyond->low.y = frame->rectangle.high.y;
  return beyond->low.x <= beyond->high.x && beyond->low.y <= beyond->high.y;
}

static inline int has_other_blocks(const block_frame* frame) {
  vertex_box beyond;
  int any = 0;
  for (int k = 0; k < FRAME_SIDES; ++k) any |= beyond_side(frame, k, &beyond);
  return any;
}

// A circle through `origin`. Of its centre, as seen from there, the coordinates are wrong by at most `error`. Seen from
// the input's origin, which may be far away, they would be wrong by more than points differ.
typedef struct {
  double2 origin;
  double x, y, error;
} circle_found;

// Of the triangle a, b, c. Returns 0 if the points are too close to a line. Differences are exact to within ROUNDOFF,
// u, relatively. With d the doubled area, whose error is below 4 u m for the sum m of its terms' magnitudes, the centre
// is n / 2d from a; n is a difference of two products of three, each exact to within 8 u.
static inline int circle_through(double2 a, double2 b, double2 c, circle_found* circle) {
  const double px = b.x - a.x, py = b.y - a.y, qx = c.x - a.x, qy = c.y - a.y;
  const double left = px * qy, right = py * qx;
  const double doubled = left - right;
  const double doubt = 4.0 * ROUNDOFF * (fabs(left) + fabs(right));
  if (!(fabs(doubled) > 4.0 * doubt)) return 0;
  const double pp = px * px + py * py, qq = qx * qx + qy * qy;
  const double scale = 0.5 / doubled;
  circle->x = (qy * pp - py * qq) * scale;
  circle->y = (px * qq - qx * pp) * scale;
  const double terms = (fabs(qy) + fabs(qx)) * pp + (fabs(py) + fabs(px)) * qq;
  const double extent = fabs(circle->x) + fabs(circle->y);
  circle->origin = a;
  circle->error =
      32.0 * ROUNDOFF * terms * fabs(scale) + 4.0 * extent * (doubt * 2.0 * fabs(scale)) + 4.0 * ROUNDOFF * extent;
  return 1;
}

// The least distance to the interval from x, as seen from the origin, less what errors can make of it.
static inline double gap_to(double x, double origin, double low, double high, double error) {
  const double to_low = low - origin, to_high = high - origin;
  const double below = to_low - x, above = x - to_high;
  const double gap = below > above ? below : above;
  const double sure = gap - error - 4.0 * ROUNDOFF * (fabs(x) + fabs(below > above ? to_low : to_high));
  return sure > 0.0 ? sure : 0.0;
}

// Whether no point of another block is inside of the closed circle or on it.
static inline int is_circle_inside(const block_frame* frame, double2 a, double2 b, double2 c) {
  circle_found circle;
  if (!has_other_blocks(frame)) return 1;
  if (!circle_through(a, b, c, &circle)) return 0;
  const double extent = fabs(circle.x) + fabs(circle.y);
  const double squared = circle.x * circle.x + circle.y * circle.y;
  const double most = (squared + (3.0 * extent + 2.0 * circle.error) * circle.error) * (1.0 + 16.0 * ROUNDOFF);
  for (int k = 0; k < FRAME_SIDES; ++k) {
    vertex_box beyond;
    if (beyond_side(frame, k, &beyond)) {
      const double x = gap_to(circle.x, circle.origin.x, beyond.low.x, beyond.high.x, circle.error);
      const double y = gap_to(circle.y, circle.origin.y, beyond.low.y, beyond.high.y, circle.error);
      if (!(x * x + y * y > most)) return 0;
    }
  }
  return 1;
}

// Whether point p is for certain left of the line from a to b or on it.
static inline int is_not_right(double2 a, double2 b, double2 p) {
  const double left = (a.x - p.x) * (b.y - p.y);
  const double right = (a.y - p.y) * (b.x - p.x);
  return left - right >= ORIENT_BOUND * (fabs(left) + fabs(right));
}

// Whether no point of another block is right of the line from a to b or on the segment.
static inline int is_half_plane_inside(const block_frame* frame, double2 a, double2 b) {
  const vertex_box r = frame->rectangle;
  int inside = r.low.x < a.x && a.x < r.high.x && r.low.y < a.y && a.y < r.high.y && r.low.x < b.x && b.x < r.high.x &&
               r.low.y < b.y && b.y < r.high.y;
  for (int k = 0; inside && k < FRAME_SIDES; ++k) {
    vertex_box beyond;
    if (beyond_side(frame, k, &beyond)) {
      inside = is_not_right(a, b, beyond.low) && is_not_right(a, b, beyond.high) &&
               is_not_right(a, b, VECTOR(double2, beyond.low.x, beyond.high.y)) &&
               is_not_right(a, b, VECTOR(double2, beyond.high.x, beyond.low.y));
    }
  }
  return inside;
}

END_SHARED

#endif
