// Walks around a vertex, from neighbour to neighbour.
#ifndef FLAUNAY_STARS_H
#define FLAUNAY_STARS_H

#include "arithmetic/language.h"
#include "mesh/halfedges.h"
#include "mesh/records.h"

BEGIN_SHARED

// The neighbour that was found last, and where the next one is looked for: counter-clockwise, and on the hull then the
// other way from the first triangle.
typedef struct {
  int vertex, first, triangle, is_back, neighbor;
} star_walk;

// Without branches, since they could not be predicted.
static inline int corner_of(face f, int vertex) {
  return (f.corner[0] != vertex) + ((f.corner[0] != vertex) & (f.corner[1] != vertex));
}

static inline star_walk star_begin(int vertex, int triangle) {
  const star_walk walk = {vertex, triangle, triangle, 0, -1};
  return walk;
}

// Finds the next neighbour; 0 after the last one.
static inline int star_next(star_walk* walk, GLOBAL const face* faces) {
  if (walk->triangle < 0) return 0;
  const face f = faces[walk->triangle];
  const int at = corner_of(f, walk->vertex);
  if (walk->is_back) {
    walk->neighbor = f.corner[next_corner(at)];
    walk->triangle = f.neighbor[corner_before(at)];
  } else {
    walk->neighbor = f.corner[corner_before(at)];
    walk->triangle = f.neighbor[next_corner(at)];
    if (walk->triangle == walk->first) {
      walk->triangle = -1;
    } else if (walk->triangle < 0) {
      walk->is_back = 1;
      walk->triangle = walk->first;
    }
  }
  return 1;
}

END_SHARED

#endif
