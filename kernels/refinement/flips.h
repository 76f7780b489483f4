// An edge that is replaced by the other diagonal of the two triangles beside it.
#ifndef FLAUNAY_FLIPS_H
#define FLAUNAY_FLIPS_H

#include "refinement/cavities.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// The two rows beside a flipped edge, its corner in each, and the neighbours beyond the sides that change rows.
typedef struct {
  int row, k, beyond, j, from_row, from_beyond;
} flip_place;

static inline flip_place place_of_flip(GLOBAL const mesh_row* rows, int corner) {
  flip_place place;
  place.row = row_of(corner);
  place.k = corner - 3 * place.row;
  place.beyond = rows[place.row].neighbor[place.k];
  place.j = number_facing(&rows[place.beyond], place.row);
  place.from_row = rows[place.row].neighbor[next_corner(place.k)];
  place.from_beyond = rows[place.beyond].neighbor[next_corner(place.j)];
  return place;
}

// Rows (c, a, b) and (d, b, a) become (c, a, d) and (d, b, c). facing_row, facing_beyond: the numbers of the corners of
// from_row and from_beyond, if these are there, that face them.
static inline void flip_rows(GLOBAL mesh_row* rows, flip_place at, int facing_row, int facing_beyond) {
  const mesh_row a = rows[at.row], b = rows[at.beyond];
  const int a1 = next_corner(at.k), a2 = corner_before(at.k), b1 = next_corner(at.j), b2 = corner_before(at.j);
  const mesh_row made_of_a = {{a.corner[at.k], a.corner[a1], b.corner[at.j]},
                              {b.neighbor[b1], at.beyond, a.neighbor[a2]},
                              {b.edge[b1], NO_EDGE_THERE, a.edge[a2]},
                              a.parent,
                              0};
  const mesh_row made_of_b = {{b.corner[at.j], b.corner[b1], a.corner[at.k]},
                              {a.neighbor[a1], at.row, b.neighbor[b2]},
                              {a.edge[a1], NO_EDGE_THERE, b.edge[b2]},
                              b.parent,
                              0};
  rows[at.row] = made_of_a;
  rows[at.beyond] = made_of_b;
  if (at.from_row >= 0) rows[at.from_row].neighbor[facing_row] = at.beyond;
  if (at.from_beyond >= 0) rows[at.from_beyond].neighbor[facing_beyond] = at.row;
}

END_SHARED

#endif

#endif
