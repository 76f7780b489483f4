// Boxes, images and seams of a torus or a cylinder, which kernels and the host share.
#ifndef FLAUNAY_PERIODIC_RECORDS_H
#define FLAUNAY_PERIODIC_RECORDS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// The lattice of a point's images, which has the vectors (period[0], 0) and (shear, period[1]).
typedef struct {
  double period[2];  // of x and of y; infinite if there is none
  double whole[2];   // 2^52 units, of which places are multiples
  double reach[2];   // along x and y, how far a point's neighbors can be away
  int64 across[2];   // period[0] and the shear, in units
  int most[2];       // so many vectors an image is away at most
} periodic_lattice;
ASSERT_SIZE(periodic_lattice, 72);

// The box of a set, in x and in y: where there is a period from 0 to that, otherwise as its points have it. Images
// within the margin around it are triangulated.
typedef struct {
  double low[2], high[2], margin;
} periodic_box;
ASSERT_SIZE(periodic_box, 40);

// A set that is triangulated in the plane. first: its first point among those of all sets. has_ends: whether there is a
// direction without a period.
typedef struct {
  periodic_box box;
  int first, has_ends;
} unrolled_set;
ASSERT_SIZE(unrolled_set, 48);

// An edge of a triangle that is kept, where the one beyond is not. All four are images, see torus.h.
typedef struct {
  double ends[4];      // x and y in the plane: of `from`, of `to`
  uint64 from, to;     // counter-clockwise
  uint64 own, beyond;  // opposite to the edge, in both triangles; beyond: NO_IMAGE if there is no other one
  int64 at;            // 3 t + the corner opposite
} seam_record;
ASSERT_SIZE(seam_record, 72);
INTEGER_CONSTANT(NO_SEAM, -1);
#define NO_IMAGE 0xffffffffffffffff

// Instead of what is added to numbers of rows, for sets whose rows are not written.
INTEGER_CONSTANT(NOT_WRITTEN, -0x7fffffff);

END_SHARED

#endif
