// Which triangles at a vertex are still missing. The directions around a vertex are divided into sectors that emitted
// triangles cover and sectors that are open; open edges are their boundaries. A vertex without open edges is all open,
// because vertices around which nothing is missing are not asked.
//
// The hull counts as triangles too (ghosts): each of its edges has one, which reaches to infinity. At a vertex of the
// hull, the ray to infinity is the edge that two ghosts share.
#ifndef FLAUNAY_OPEN_SECTORS_H
#define FLAUNAY_OPEN_SECTORS_H

#include "arithmetic/language.h"
#include "blocks/records.h"
#include "predicates/planar.h"

BEGIN_SHARED

// States of an edge's left side that are not the place of an emitted triangle's corner.
INTEGER_CONSTANT(OPEN, -1);        // a triangle that is not emitted
INTEGER_CONSTANT(GHOST, -2);       // the outside, final
INTEGER_CONSTANT(OPEN_GHOST, -3);  // the outside of this block's triangulation
static inline int is_final(int state) { return state >= 0 || state == GHOST; }
static inline int is_ghost(int state) { return state == GHOST || state == OPEN_GHOST; }

// A direction from a vertex. The question is whether the face beside it, counter-clockwise, is open: a
// triangle, or the outside if this is the last edge at a vertex of the hull.
typedef struct {
  coordinate2 from, to;
  int vertex, is_last;
} direction;

static inline int side_seen(coordinate2 a, coordinate2 b, coordinate2 c, filter_bound bound, int exactly) {
  const int sign = orient_filtered(a, b, c, bound);
  return sign == UNDECIDED && exactly ? orient_exact(a, b, c) : sign;
}

// Where clockwise from a direction an edge is met, coarsely: smaller numbers first. At a vertex of the hull, all edges
// lie within half a turn, and the outside is met between those clockwise from the direction and the others.
#define MET_CLOCKWISE 0
#define MET_OPPOSITE_OF_LAST 1
#define MET_OUTSIDE 2
#define MET_OPPOSITE 3
#define MET_LATE 4
static inline int where_met(const direction* d, int side) {
  return side < 0 ? MET_CLOCKWISE : side > 0 ? MET_LATE : d->is_last ? MET_OPPOSITE_OF_LAST : MET_OPPOSITE;
}

// 1 if the face counter-clockwise beside a direction is open, 0 if not, UNDECIDED, but not if `exactly`. edges:
// the open edges of the vertex, [begin, end); points: of all vertices.
static inline int begins_open(const direction* d, GLOBAL const open_edge* edges, int begin, int end,
                              GLOBAL const coordinate2* points, filter_bound bound, int exactly) {
  int open = 1, met = MET_LATE + 1;
  coordinate2 nearest = d->to;
  for (int k = begin; k < end; ++k) {
    const open_edge edge = edges[k];
    if (edge.to == d->vertex) return edge.begins;
    int here = MET_OUTSIDE;
    coordinate2 to = d->to;
    if (edge.to >= 0) {
      to = points[edge.to];
      const int side = side_seen(d->from, d->to, to, bound, exactly);
      if (side == UNDECIDED) return UNDECIDED;
      here = where_met(d, side);
    }
    int is_nearer = here < met;
    if (here == met) {
      const int side = side_seen(d->from, to, nearest, bound, exactly);
      if (side == UNDECIDED) return UNDECIDED;
      is_nearer = side < 0;
    }
    if (is_nearer) {
      met = here;
      nearest = to;
      open = edge.begins;
    }
  }
  return open;
}

END_SHARED

#endif
