// Records of locators, in arrays that kernels and the host share.
#ifndef FLAUNAY_LOCATE_RECORDS_H
#define FLAUNAY_LOCATE_RECORDS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// A set of a locator: where its tree's nodes begin, the tree's depth, where its leaves' starts begin, its number of
// triangles, and where its hull begins and ends.
typedef struct {
  int nodes, depth, starts, triangles, hull, hull_end;
} mesh_set;
ASSERT_SIZE(mesh_set, 24);

// For a triangle in the fan of a cocircular polygon, unless it is the last one, counter-clockwise about the
// fan's first vertex: that vertex, and the last triangle. For other triangles: -1 and the triangle itself.
typedef struct {
  int vertex, last;
} fan_part;
ASSERT_SIZE(fan_part, 8);

// Options of find_triangles. are_placed: whether queries have been placed and sorted by keys; otherwise they go
// down the trees in the given order, and the kernel places them. is_answer: whether results are by query, with
// -1 outside of the hull; otherwise they are by place, as walks end. Walks in sets of long_from triangles or
// more are given up after most_steps.
typedef struct {
  int are_placed, is_answer, long_from, most_steps;
} walk_options;
ASSERT_SIZE(walk_options, 16);

END_SHARED

#endif
