// Sizes on which kernels of refinement and the host agree.
#ifndef FLAUNAY_REFINEMENT_LIMITS_H
#define FLAUNAY_REFINEMENT_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Tasks are done in the order of classes, and within a class in their own order.
INTEGER_CONSTANT(TASK_CLASSES, 2048);
// Rows and vertices are handed out in chunks.
INTEGER_CONSTANT(ROWS_PER_CHUNK, 128);
INTEGER_CONSTANT(VERTICES_PER_CHUNK, 64);
// Lists have this many places more than `room`.
INTEGER_CONSTANT(SPARE_ROOM, 8);

END_SHARED

#endif
