// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_MESH_LIMITS_H
#define FLAUNAY_MESH_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Directed edges that a vertex brings: a planar graph has less than 3 edges per vertex.
// Instead of an edge out of a weighted point that is no vertex.
INTEGER_CONSTANT(HIDDEN_VERTEX, -2);
INTEGER_CONSTANT(EDGES_PER_VERTEX, 6);
INTEGER_CONSTANT(PAIRS_PER_VERTEX, EDGES_PER_VERTEX / 2);
// Divide and conquer ends with leaves of at most this many vertices.
INTEGER_CONSTANT(LEAF_VERTICES, 4);
// A block of at most this many points, which one cut divides into leaves, needs no work-group of its own.
INTEGER_CONSTANT(TINY_BLOCK, 2 * LEAF_VERTICES);

END_SHARED

#endif
