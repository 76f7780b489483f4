// Makes cavities triangles again, for the insertion of constraints. With CAVITIES_STOP, nothing is evaluated exactly: a
// cavity is given up at a circle that floating point cannot decide, and can be filled again from the beginning, since
// nothing that is read is written.
#ifndef FLAUNAY_CAVITIES_H
#define FLAUNAY_CAVITIES_H

#include "arithmetic/language.h"
#include "constrained/codes.h"
#include "constrained/limits.h"
#include "constrained/records.h"
#include "constrained/segment_walks.h"
#include "predicates/planar.h"

BEGIN_SHARED

// Outcomes of a constraint that stays blocked, and of one whose cavity constrained/fill_filtered.cl has filled
// already; see constrained/codes.h for other outcomes.
#define CONSTRAINT_BLOCKED 3
#define CONSTRAINT_FILLED 4

// The arrays of rows that are replaced. new_corners: per old corner opposite to a side, the new one.
typedef struct {
  GLOBAL int* triangles;
  GLOBAL int* neighbors;
  GLOBAL uint* claims;
  GLOBAL uchar* flags;
  GLOBAL uchar* changed;
  GLOBAL int* new_corners;
  uint mark;
} replaced_rows;

// Writes a new row, all but its neighbours.
static inline void put_row(int row, int a, int b, int c, uint flags, const replaced_rows* rows) {
  rows->triangles[3 * row] = a;
  rows->triangles[3 * row + 1] = b;
  rows->triangles[3 * row + 2] = c;
  rows->flags[row] = (uchar)flags;
  rows->changed[row] = 1;
  rows->claims[row] = rows->mark;
}

// The edge opposite to a new corner is the side at an entry. Returns its flag.
static inline uint put_side(int corner, GLOBAL const chain_entry* entry, const replaced_rows* rows) {
  rows->new_corners[entry->corner] = corner;
  return entry->side & 1u ? edge_flag(corner) : 0u;
}

static inline void join(int corner, int other, const replaced_rows* rows) {
  rows->neighbors[corner] = other / 3;
  rows->neighbors[other] = corner / 3;
}

// A new row (i, k, j) of a chain has the chord (j, k) opposite to its first corner, (i, j) opposite to its second, and
// its base opposite to its third one.
#define BASE_CORNER 2

#ifdef CAVITIES_STOP
static inline int side_of_circle(coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d, filter_bound bound) {
  const int sign = circle_filtered(a, b, c, d, bound);
  return sign != 0 ? sign : UNDECIDED;
}
#else
#define side_of_circle circle_canonical
#endif

// The circles through the chord's ends and one of the vertices between are nested: the smallest. -1 if it is undecided.
static inline int apex_of(int i, int k, GLOBAL const chain_entry* chain, GLOBAL const coordinate* points,
                          filter_bound bound) {
  int best = i + 1;
  for (int j = best + 1; j < k; ++j) {
    const int sign = side_of_circle(vload2(chain[i].vertex, points), vload2(chain[k].vertex, points),
                                    vload2(chain[best].vertex, points), vload2(chain[j].vertex, points), bound);
    if (sign == UNDECIDED) return -1;
    if (sign > 0) best = j;
  }
  return best;
}

// Gift-wraps a chain of `size` entries into the rows of the entries from row_entry on. Returns whether it could.
static inline int fill_chain(int size, GLOBAL const chain_entry* chain, GLOBAL const chain_entry* row_entry,
                             GLOBAL const coordinate* points, filter_bound bound, const replaced_rows* rows) {
  int chords[SHORT_CHAINS], beyond[SHORT_CHAINS];
  int open = 1;
  chords[0] = size - 1;
  beyond[0] = -1;
  while (open > 0) {
    --open;
    const int i = chords[open] >> 16, k = chords[open] & 0xffff, outer = beyond[open];
    const int j = apex_of(i, k, chain, points, bound), row = row_entry++->row, corner = 3 * row;
    uint flags = 0;
    if (j < 0) return 0;
    if (outer < 0) {
      flags = edge_flag(corner + BASE_CORNER);
    } else {
      join(corner + BASE_CORNER, outer, rows);
    }
    if (k - j > 1) {
      chords[open] = j << 16 | k;
      beyond[open++] = corner;
    } else {
      flags |= put_side(corner, &chain[j], rows);
    }
    if (j - i > 1) {
      chords[open] = i << 16 | j;
      beyond[open++] = corner + 1;
    } else {
      flags |= put_side(corner + 1, &chain[i], rows);
    }
    put_row(row, chain[i].vertex, chain[k].vertex, chain[j].vertex, flags, rows);
  }
  return 1;
}

// Fills the cavity of a constraint; returns whether it could. left: how many entries, the first, are on its
// left.
static inline int fill_cavity(constraint_walk walk, int left, GLOBAL const chain_entry* entries,
                              GLOBAL const coordinate* points, filter_bound bound, const replaced_rows* rows) {
  if (walk.rows == 0) {
    const int row = walk.corner / 3, beyond = rows->neighbors[walk.corner];
    rows->flags[row] |= (uchar)edge_flag(walk.corner);
    rows->claims[row] = UNCLAIMED;
    if (beyond >= 0) {
      rows->flags[beyond] |= (uchar)edge_flag(corner_with(beyond, row, rows->neighbors));
      rows->claims[beyond] = UNCLAIMED;
    }
    return 1;
  }
  if (!fill_chain(left, entries, entries, points, bound, rows) ||
      !fill_chain(walk.rows + 4 - left, entries + left, entries + left - 2, points, bound, rows))
    return 0;
  join(3 * entries[0].row + BASE_CORNER, 3 * entries[left - 2].row + BASE_CORNER, rows);
  return 1;
}

END_SHARED

#endif
