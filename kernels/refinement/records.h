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

// The goals of a refinement, and other values that are the same for all triangles; docs/refinement.md.
typedef struct {
  double squared_sine;    // of the smallest angle
  double off_centre;      // how far off-centres are from the shortest edge
  double squared_cosine;  // of the angle under which a point encroaches an edge; 0: conforming
  double area;            // the largest, or 0
  double min_edge;        // squared
  double long_edge;       // six times as long, squared; infinite if rounding could matter
  double coarse;          // new coordinates below it are multiples of its last binary place
  int area_kind;
  int has_apexes;          // whether there are any
  int has_given;           // whether triangles of one region may have different areas, by the mesh that was given
  int vertices;            // of the input
  int least_class, spare;  // see tier_of
} refinement_rules;
ASSERT_SIZE(refinement_rules, 80);

// A phase. Triangles that are too large act if they exceed their largest area by the factor `level`, or in a
// scaffold if their circumradius exceeds their leaf's. room: of the lists of each work-item; most: the most
// points that a block inserts; steps: of each block in a launch.
typedef struct {
  double level;
  int is_whole, segments_only, is_scaffold, blocks, first_block, most, room, row_room, vertex_room, steps;
} refinement_phase;
ASSERT_SIZE(refinement_phase, 48);

// A node of the tree of cuts: places below a cut along an axis, 0 or 1, belong to the node `child`, the others to the
// one after it. A leaf has the axis -1 and its number for a child.
typedef struct {
  double at;
  int axis, child;
} block_cut;
ASSERT_SIZE(block_cut, 16);

// A task of a block: a row as it was when it had this count of changes, and the task for it. next: the place of
// the next task of its class, or the next free place, plus 1; 0 at the end.
typedef struct {
  int row, changed, task, next;
} block_task;
ASSERT_SIZE(block_task, 16);

// A task with which a block begins: a row, its key, the task and its class. turn: for an order of the tasks of
// one row.
typedef struct {
  uint64 key;
  int row, task, tier, turn;
} first_task;
ASSERT_SIZE(first_task, 24);

// A side of a cavity that is dug: the two ends of the edge, seen from the point, the squares of their distances and
// their cross product. edge: the row inside times 4, with the number of the corner opposite; from: the first end.
typedef struct {
  double bx, by, bl, cx, cy, cl, bc;
  int edge, from;
} dug_side;
ASSERT_SIZE(dug_side, 64);

// The progress of a work-item in its block, so that it can go on when there is more room. block: less than 0
// without one. free_task: the first free place in the list of tasks, plus 1; used_tasks: how many places were
// used. retry: a row that waits for the splits of constraints that it wants. rows and vertices: the rest of the
// last chunks. low and high: the block's leaf, from the first ones on and below the second ones.
typedef struct {
  uint64 classes[32];
  double low[2], high[2];
  uint groups;
  int block, inserted, used_tasks, free_task, free_count, retry, retry_changed, retry_class, retry_inserted,
      retry_aside, retry_reason, row, row_end, vertex, vertex_end;
} block_state;
ASSERT_SIZE(block_state, 352);

// A side of a cavity: the vertex at its beginning, the row beyond it and which corner there is opposite,
// whether it must stay, and the parent of the row inside. Also a row of the new triangles, unrelated to the
// side.
typedef struct {
  int from, outside, facing, edge, parent, row;
} star_side;
ASSERT_SIZE(star_side, 24);

END_SHARED

#endif
