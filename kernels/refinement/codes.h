// Codes that kernels write for each other and for the host.
#ifndef FLAUNAY_REFINEMENT_CODES_H
#define FLAUNAY_REFINEMENT_CODES_H

#include "arithmetic/language.h"

BEGIN_SHARED

// In mesh_row::edge: no edge that must stay. Otherwise the number of one, with these bits.
INTEGER_CONSTANT(NO_EDGE_THERE, -1);
INTEGER_CONSTANT(EDGE_KEPT, 1 << 30);    // the user wants it to stay as it is
INTEGER_CONSTANT(EDGE_FROZEN, 1 << 29);  // rounding does not allow to split this part of it
INTEGER_CONSTANT(EDGE_NUMBER, (1 << 29) - 1);

// Why a triangle stays bad, with the numbers of flaunay::Excuse.
INTEGER_CONSTANT(EXCUSED_NOT, 0);
INTEGER_CONSTANT(EXCUSED_INPUT_ANGLE, 1);
INTEGER_CONSTANT(EXCUSED_NEAR_APEX, 2);
INTEGER_CONSTANT(EXCUSED_MIN_EDGE, 3);
INTEGER_CONSTANT(EXCUSED_KEPT, 4);
INTEGER_CONSTANT(EXCUSED_FROZEN, 5);
INTEGER_CONSTANT(EXCUSED_LIMIT, 6);

// Outcomes of a triangle or a constraint that a block takes up: one of these, or a reason why nothing is done.
INTEGER_CONSTANT(TASK_DONE, 0);
INTEGER_CONSTANT(TASK_ASIDE, 16);   // until the next phase, since it concerns triangles of other blocks
INTEGER_CONSTANT(TASK_SPLITS, 17);  // constraints are split first
INTEGER_CONSTANT(TASK_FULL, 18);    // the lists of the work-item are too small
// The task for a row: mend it; split the constraint opposite to a corner, whose number is the task, since an
// angle encroaches it; or TASK_WANTED plus that number, since the point of a bad triangle encroaches it.
INTEGER_CONSTANT(TASK_MEND, -1);
INTEGER_CONSTANT(TASK_WANTED, 4);
// The state of a row: why it was refused, one of EXCUSED_; and its pending tasks.
INTEGER_CONSTANT(ROW_REFUSED, 7);
INTEGER_CONSTANT(ROW_BAD, 8);
INTEGER_CONSTANT(ROW_SPLITS, 16);  // for corner 0, and so on
INTEGER_CONSTANT(ROW_ALL_SPLITS, 112);
INTEGER_CONSTANT(ROW_NEW, 128);  // not tested yet for the area that is asked for there
// Kinds of rows for the final order.
INTEGER_CONSTANT(ROW_KEPT, 1);
INTEGER_CONSTANT(ROW_MADE, 2);
// Why a launch ends before all blocks are done.
INTEGER_CONSTANT(NEEDS_ROWS, 1);
INTEGER_CONSTANT(NEEDS_ROOM, 2);
INTEGER_CONSTANT(NEEDS_STEPS, 4);
// Counters of a phase: blocks taken, rows and vertices in chunks, the needs of a launch.
INTEGER_CONSTANT(COUNT_BLOCKS, 0);
INTEGER_CONSTANT(COUNT_ROWS, 1);
INTEGER_CONSTANT(COUNT_VERTICES, 2);
INTEGER_CONSTANT(COUNT_NEEDS, 3);
INTEGER_CONSTANT(COUNTERS_OF_PHASE, 4);

// Outcomes of a point that is inserted into a triangulation that changes.
INTEGER_CONSTANT(POINT_WAITS, 0);
INTEGER_CONSTANT(POINT_INSERTED, 1);
INTEGER_CONSTANT(POINT_DROPPED, 2);  // there is a point in its place, or its constraint cannot be split there

// The elements for which areas are given.
INTEGER_CONSTANT(AREAS_NONE, 0);
INTEGER_CONSTANT(AREAS_BY_PARENT, 1);
INTEGER_CONSTANT(AREAS_BY_ROW, 2);

// The state of a vertex: it moves, it never did, or the pass in which its move was cancelled, from 1 on.
INTEGER_CONSTANT(MOVES, 0x7fffffff);
INTEGER_CONSTANT(STAYS, 0);
// The star of a vertex without triangles.
INTEGER_CONSTANT(NO_STAR, 0x7fffffff);

// A row that was not claimed. Claims are above the last ones of all steps before.
#define UNCLAIMED_ROW 0xffffffffu
// A row without a triangle, in the place of its first corner.
INTEGER_CONSTANT(NO_TRIANGLE, -1);

END_SHARED

#endif
