// Boxes, images and seams of a torus or a cylinder, which kernels and the host share.
#ifndef FLAUNAY_PERIODIC_RECORDS_H
#define FLAUNAY_PERIODIC_RECORDS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// A direction, x or y. The period is infinite if there is none. whole: 2^52 units, of which places are multiples.
typedef struct {
  double period, whole;
} periodic_axis;
ASSERT_SIZE(periodic_axis, 16);

typedef struct {
  periodic_axis x, y;
} periodic_axes;
ASSERT_SIZE(periodic_axes, 32);

// The box of a set, in x and in y: where there is a period from 0 to that, otherwise as its points have it. Images
// within the margin around it are triangulated.
typedef struct {
  double period[2], low[2], high[2], margin;
} periodic_box;
ASSERT_SIZE(periodic_box, 56);

// A set that is triangulated in the plane. first: its first point among those of all sets. has_ends: whether there is a
// direction without a period.
typedef struct {
  periodic_box box;
  int first, has_ends;
} unrolled_set;
ASSERT_SIZE(unrolled_set, 64);

// An edge of a triangle that is kept: a seam if none beyond it is. All four are images, see torus.h.
typedef struct {
  double ends[4];    // x and y in the plane: of `from`, of `to`
  uint from, to;     // counter-clockwise
  uint own, beyond;  // opposite to the edge, in both triangles; NO_IMAGE if there is no other one
  int at, is_seam;   // at: 3 t + the corner opposite. Edges within what is kept are none.
} seam_record;
ASSERT_SIZE(seam_record, 56);
INTEGER_CONSTANT(NO_SEAM, -1);
#define NO_IMAGE 0xffffffffu

// Instead of what is added to numbers of rows, for sets whose rows are not written.
INTEGER_CONSTANT(NOT_WRITTEN, -0x7fffffff);

END_SHARED

#endif
