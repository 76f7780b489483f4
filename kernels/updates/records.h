// Records of updates, in arrays that kernels and the host share.
#ifndef FLAUNAY_UPDATES_RECORDS_H
#define FLAUNAY_UPDATES_RECORDS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// A vertex that is inserted. corner: where its cavity begins; found: the vertex that is in its place already, or -1.
// spare: two rows for the new triangles, besides the `count` rows of the cavity. The constraint that it splits,
// or -1: its ends and its number. rank: the smallest goes first.
typedef struct {
  int vertex, corner, found, count, from, to, edge;
  uint rank;
  int spare[2];
} placed_vertex;
ASSERT_SIZE(placed_vertex, 40);

// A vertex that is removed. corner: one of its own, at which the tour around it begins; freed: the rows that are free
// then.
typedef struct {
  int vertex, corner;
  uint rank;
  int freed[2];
} removed_vertex;
ASSERT_SIZE(removed_vertex, 20);

// A row that a batch has changed: whether it held a triangle before, and its present contents.
typedef struct {
  int row, was_triangle, holds, corner[3];
} row_report;
ASSERT_SIZE(row_report, 24);

END_SHARED

#endif
