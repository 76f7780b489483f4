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

// Why a triangle is bad and stays so. The numbers are those of flaunay::Excuse.
INTEGER_CONSTANT(EXCUSED_NOT, 0);
INTEGER_CONSTANT(EXCUSED_INPUT_ANGLE, 1);
INTEGER_CONSTANT(EXCUSED_NEAR_APEX, 2);
INTEGER_CONSTANT(EXCUSED_MIN_EDGE, 3);
INTEGER_CONSTANT(EXCUSED_KEPT, 4);
INTEGER_CONSTANT(EXCUSED_FROZEN, 5);
INTEGER_CONSTANT(EXCUSED_LIMIT, 6);

// What becomes of a proposal: one of the reasons from EXCUSED_MIN_EDGE on, or one of these.
INTEGER_CONSTANT(PROPOSAL_OPEN, 16);
INTEGER_CONSTANT(PROPOSAL_BLOCKED, 17);  // a constraint is split nearby, which goes first
INTEGER_CONSTANT(PROPOSAL_LOSES, 18);    // to a better one
INTEGER_CONSTANT(PROPOSAL_INSERTS, 19);  // its point
INTEGER_CONSTANT(PROPOSAL_SPLITS, 20);   // the constraints that its point encroaches

// What becomes of a point in a step.
INTEGER_CONSTANT(POINT_WAITS, 0);
INTEGER_CONSTANT(POINT_INSERTED, 1);
INTEGER_CONSTANT(POINT_DROPPED, 2);  // there is a point in its place, or its constraint cannot be split there
INTEGER_CONSTANT(POINT_REFUSED, 3);  // for its constraint, others of the same round are too near

// How a proposal must not be beaten: where its triangle is, and beside it; or in all of its cavity and around that.
INTEGER_CONSTANT(RULE_NEIGHBORS, 0);
INTEGER_CONSTANT(RULE_RING, 1);

// What the areas are given for.
INTEGER_CONSTANT(AREAS_NONE, 0);
INTEGER_CONSTANT(AREAS_BY_PARENT, 1);
INTEGER_CONSTANT(AREAS_BY_ROW, 2);

// What a vertex does: it moves, it never did, or the pass in which its move was cancelled, from 1 on.
INTEGER_CONSTANT(MOVES, 0x7fffffff);
INTEGER_CONSTANT(STAYS, 0);
// The star of a vertex without triangles.
INTEGER_CONSTANT(NO_STAR, 0x7fffffff);

// The key of a row that is not bad, or whose badness is not known yet.
#define NO_KEY 0xffffffffffffffffUL
// A row that was not claimed. Claims are above the last ones of all steps before.
#define UNCLAIMED_ROW 0xffffffffu
// A row without a triangle, in the place of its first corner.
INTEGER_CONSTANT(NO_TRIANGLE, -1);

END_SHARED

#endif
