// Records of refinement, in arrays that kernels and the host share.
#ifndef FLAUNAY_REFINEMENT_RECORDS_H
#define FLAUNAY_REFINEMENT_RECORDS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// A triangle. Corners are counter-clockwise; of a triangle that was made by inserting a point, that is the first one.
// neighbor and edge are opposite to the corners. edge: an edge that must stay, see codes.h. parent: the triangle of the
// mesh that is refined from which this one comes. changed: the step that made it, or one beside it.
typedef struct {
  int corner[3], neighbor[3], edge[3], parent, changed;
} mesh_row;
ASSERT_SIZE(mesh_row, 44);

// Where a vertex is on an edge that must stay: the part of its length from its first end, and the nominal distance from
// the apex, a vertex where edges meet at a sharp angle inside of the mesh. Without an edge or an apex: -1. A vertex
// that is an apex has itself, at a distance of 0; another one of the input that is the far end of an edge with an apex,
// that apex.
typedef struct {
  double part, distance;
  int edge, apex;
} edge_place;
ASSERT_SIZE(edge_place, 24);

// What is asked for, and what else is the same for all triangles; docs/refinement.md.
typedef struct {
  double squared_sine;                   // of the smallest angle
  double off_centre;                     // how far off-centres are from the shortest edge
  double squared_cosine;                 // of the angle under which a point encroaches an edge; 0: conforming
  double area;                           // the largest, or 0
  double min_edge;                       // squared
  double long_edge;                      // six times as long, squared; infinite if rounding could matter
  double coarse;                         // new coordinates below it are multiples of its last binary place
  int area_kind, rule, waits, vertices;  // vertices: those of the input
} refinement_rules;
ASSERT_SIZE(refinement_rules, 72);

// A point that is to mend a triangle. start: the corner at which a tour of its cavity begins. hit: the corner opposite
// to the constraint that is in the way, or -1. count: rows in the cavity; splits: constraints that it encroaches.
typedef struct {
  double x, y;
  int row, start, hit, count, splits, spare;
} proposal;
ASSERT_SIZE(proposal, 40);

// A point that is inserted: its vertex; where its cavity begins, and the proposal that knows its rows, or -1; the ends
// of the constraint that it splits, or -1. rank: the smallest goes first. count: rows in the cavity; seen: the step
// before which they were found.
typedef struct {
  int vertex, corner, known;
  uint rank;
  int from, to, count, first_row, seen;
} insertion;
ASSERT_SIZE(insertion, 36);

// A side of a cavity: the vertex at its beginning, what is beyond it and which corner there is opposite, whether it
// must stay, and the parent of the row inside. Also one of the rows of the new triangles, which has nothing to do with
// it.
typedef struct {
  int from, outside, facing, edge, parent, row;
} star_side;
ASSERT_SIZE(star_side, 24);

END_SHARED

#endif
