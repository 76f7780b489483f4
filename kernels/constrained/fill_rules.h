// Rules for the outside and the holes of a triangulation with constraints, with the values of FillRule and
// Outside in flaunay/constrained.hpp.
#ifndef FLAUNAY_FILL_RULES_H
#define FLAUNAY_FILL_RULES_H

#include "arithmetic/language.h"

BEGIN_SHARED

INTEGER_CONSTANT(FILL_NESTING, 0);
INTEGER_CONSTANT(FILL_EVEN_ODD, 1);
INTEGER_CONSTANT(FILL_WINDING, 2);

INTEGER_CONSTANT(OUTSIDE_KEEP, 0);
INTEGER_CONSTANT(OUTSIDE_HULL, 1);
INTEGER_CONSTANT(OUTSIDE_HOLES, 2);

// The level of a region that no walk from outside has reached yet.
INTEGER_CONSTANT(UNREACHED, 0x7fffffff);

// The depth of a region: level is the least number of constraint edges on a path from outside, potential the sum of
// segments that such a path crosses.
static inline int depth_of(int level, int potential, int rule) {
  return rule == FILL_NESTING ? level : rule == FILL_EVEN_ODD ? potential & 1 : potential;
}

// Whether a region of this depth is left.
static inline int is_left(int depth, int rule, int outside) {
  if (outside == OUTSIDE_KEEP) return 1;
  return outside == OUTSIDE_HOLES && rule == FILL_NESTING ? depth & 1 : depth != 0;
}

// For a hash table of edges; see constrained/domain.cl.
static inline uint edge_hash(int from, int to) {
  uint bits = (uint)from * 0x9e3779b9u ^ (uint)to * 0x85ebca6bu;
  bits ^= bits >> 15;
  bits *= 0x2c1b3c6du;
  return bits ^ bits >> 13;
}

END_SHARED

#endif
