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

// Of a triangle in the fan of a cocircular polygon, unless it is the last one, counter-clockwise about the fan's first
// vertex: that vertex, and the last triangle. Of others: -1 and the triangle itself.
typedef struct {
  int vertex, last;
} fan_part;
ASSERT_SIZE(fan_part, 8);

// How find_triangles works. are_placed: whether there are keys, in their order, and placed queries; else queries go
// down the trees, and their order and places are those that they have. is_answer: whether what is found is by query,
// with -1 outside of the hull; else it is by place, as walks end. Walks in sets of long_from triangles or more are
// given up after most_steps.
typedef struct {
  int are_placed, is_answer, long_from, most_steps;
} walk_options;
ASSERT_SIZE(walk_options, 16);

END_SHARED

#endif
