// Points claim the rows of their cavities; points that hold all of theirs list the rows and the sides. The
// claim of a row is an atomic minimum.
#ifndef FLAUNAY_CLAIMED_CAVITIES_H
#define FLAUNAY_CLAIMED_CAVITIES_H

#include "refinement/cavities.h"
#include "refinement/ranks.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// Tours a cavity, or one side of it, and claims its rows. Returns the number of its sides.
static inline int claim_tour(const seen_mesh* mesh, int start, int end, double2 p, uint claim,
                             GLOBAL volatile uint* claims) {
  int sides = 0;
  cavity_tour tour;
  start_tour(&tour, start, end);
  for (int next = ~row_of(end); next != NO_MORE; next = next_in_tour(&tour, mesh, p)) {
    if (next < 0) {
      atomic_min(&claims[~next], claim);
    } else {
      ++sides;
    }
  }
  return sides;
}

// The part of a cavity that was found so far.
typedef struct {
  int rows, sides, holds;
} gathered;

// Tours the rows that a point holds, and lists them and the sides. visits: per row the last claim that met it so.
static inline gathered gather_tour(const seen_mesh* mesh, int start, int end, uint claim, GLOBAL const uint* claims,
                                   GLOBAL uint* visits, GLOBAL star_side* sides, gathered found) {
  int row = row_of(end), k;
  found.holds = claims[row] == claim;
  if (!found.holds) return found;
  visits[row] = claim;
  sides[found.rows++].row = row;
  row = row_of(start);
  k = start - 3 * row;
  do {
    GLOBAL const mesh_row* const at = &mesh->rows[row];
    const int beyond = at->neighbor[k], edge = at->edge[k];
    const uint other = beyond < 0 ? UNCLAIMED_ROW : claims[beyond];
    if (other < claim) {
      found.holds = 0;
      return found;
    }
    if (other == claim && edge < 0) {
      if (visits[beyond] != claim) {
        visits[beyond] = claim;
        sides[found.rows++].row = beyond;
      }
      k = next_corner(number_facing(&mesh->rows[beyond], row));
      row = beyond;
    } else {
      GLOBAL star_side* const side = &sides[found.sides++];
      side->from = at->corner[next_corner(k)];
      side->outside = beyond;
      side->facing = beyond < 0 ? 0 : number_facing(&mesh->rows[beyond], row);
      side->edge = edge;
      side->parent = at->parent;
      k = next_corner(k);
    }
  } while (3 * row + k != end);
  return found;
}

// Writes the triangle between a vertex and a side of its star, but for what it inherits. after, before: the rows beside
// it. edge: the edge that the vertex is on, between vertices a and b, or NO_EDGE_THERE.
static inline void write_star_row(GLOBAL mesh_row* row, int vertex, star_side side, int to, int after, int before,
                                  int edge, int a, int b) {
  row->corner[0] = vertex;
  row->corner[1] = side.from;
  row->corner[2] = to;
  row->neighbor[0] = side.outside;
  row->neighbor[1] = after;
  row->neighbor[2] = before;
  row->edge[0] = side.edge;
  row->edge[1] = ((to == a) | (to == b)) ? edge : NO_EDGE_THERE;
  row->edge[2] = ((side.from == a) | (side.from == b)) ? edge : NO_EDGE_THERE;
}

END_SHARED

#endif

#endif
