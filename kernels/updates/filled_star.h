// Fills the hole that a removed vertex leaves: the canonical triangulation of the polygon around it, or of the
// part of the polygon inside the hull of the other points, with ghosts.
//
// A first triangulation cuts off corners; where the vertex was on the hull, it has a ghost on each side instead. Flips
// then make it Delaunay, or convex.
#ifndef FLAUNAY_UPDATES_FILLED_STAR_H
#define FLAUNAY_UPDATES_FILLED_STAR_H

#include "updates/walks.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// The rows around a vertex, counter-clockwise: each with its side, from a vertex to the next one, and with the
// row beyond that side.
typedef struct {
  int count, infinite;  // infinite: which vertex is at infinity, or -1
  int vertex[MOST_AROUND], row[MOST_AROUND], outside[MOST_AROUND], facing[MOST_AROUND], edge[MOST_AROUND];
  double2 point[MOST_AROUND];
} star_around;

// New triangles. Corners are numbers of vertices around. beyond: the triangle's corner opposite to that of another one,
// or the complement of a side.
typedef struct {
  int count;
  int corner[3 * MOST_AROUND], beyond[3 * MOST_AROUND];
} star_filling;

// Lists the rows around a corner's vertex, at most MOST_AROUND.
static inline void list_around(const seen_mesh* mesh, int corner, star_around* star) {
  int at = corner, count = 0;
  star->infinite = -1;
  do {
    const int row = row_of(at), beyond = neighbor_at(mesh, at), from = vertex_at(mesh, next_halfedge(at));
    star->vertex[count] = from;
    star->row[count] = row;
    star->outside[count] = beyond;
    star->facing[count] = number_across(&mesh->rows[beyond], vertex_at(mesh, previous_halfedge(at)));
    star->edge[count] = edge_at(mesh, at);
    if (from == INFINITE_VERTEX) {
      star->infinite = count;
    } else {
      star->point[count] = mesh->points[from];
    }
    ++count;
    at = next_around(mesh, at);
  } while (at != corner);
  star->count = count;
}

static inline void set_beyond(star_filling* filling, int corner, int beyond) {
  filling->beyond[corner] = beyond;
  if (beyond >= 0) filling->beyond[beyond] = corner;
}

// Adds a triangle, with the neighbours beyond its sides opposite to a and to c. Returns its corner b.
static inline int add_triangle(star_filling* filling, int a, int b, int c, int beyond_a, int beyond_c) {
  const int first = 3 * filling->count++;
  filling->corner[first] = a;
  filling->corner[first + 1] = b;
  filling->corner[first + 2] = c;
  set_beyond(filling, first, beyond_a);
  set_beyond(filling, first + 2, beyond_c);
  return first + 1;
}

// Cuts corners off a polygon that sees the point v from all of its inside, as long as more than three are left: those
// that leave one that does.
static inline void cut_corners(const star_around* star, double2 v, star_filling* filling) {
  int next[MOST_AROUND], outer[MOST_AROUND];
  int left = star->count;
  for (int i = 0; i < left; ++i) {
    next[i] = i + 1 == left ? 0 : i + 1;
    outer[i] = ~i;
  }
  int i = 0;
  while (left > 3) {
    const int j = next[i], k = next[j];
    const double2 p = star->point[i], q = star->point[j], r = star->point[k];
    // If four corners are left, the vertex may be where the diagonals meet.
    const double2 kept = left == 4 ? star->point[next[k]] : v;
    if (orient_sign(p, q, r, ORIENT_BOUND) > 0 && orient_sign(p, r, kept, ORIENT_BOUND) > 0) {
      outer[i] = add_triangle(filling, i, j, k, outer[j], outer[i]);
      next[i] = k;
      --left;
    } else {
      i = j;
    }
  }
  const int j = next[i], k = next[j];
  const int corner = add_triangle(filling, i, j, k, outer[j], outer[i]);
  set_beyond(filling, corner, outer[k]);
}

// A ghost on each side that does not end at infinity.
static inline void put_ghosts(const star_around* star, star_filling* filling) {
  const int count = star->count, infinite = star->infinite;
  const int first = infinite + 1 == count ? 0 : infinite + 1;
  // The neighbour beyond the edge from infinity to i.
  int before = ~infinite;
  int i = first;
  for (int k = 0; k < count - 2; ++k) {
    const int next = i + 1 == count ? 0 : i + 1;
    before = add_triangle(filling, infinite, i, next, ~i, before);
    i = next;
  }
  set_beyond(filling, before, ~i);
}

// Whether the edge opposite to a corner is to be flipped: its other triangle has d.
static inline int is_to_flip(const star_around* star, int c, int a, int b, int d) {
  const int infinite = star->infinite;
  if (c == infinite || d == infinite) return 0;
  if (a == infinite) return orient_sign(star->point[b], star->point[c], star->point[d], ORIENT_BOUND) > 0;
  if (b == infinite) return orient_sign(star->point[c], star->point[a], star->point[d], ORIENT_BOUND) > 0;
  return circle_canonical(star->point[c], star->point[a], star->point[b], star->point[d], CIRCLE_BOUND) > 0;
}

static inline void flip_edges(const star_around* star, star_filling* filling) {
  for (int corner = 0, unchanged = 0; unchanged < 3 * filling->count; corner = (corner + 1) % (3 * filling->count)) {
    const int other = filling->beyond[corner];
    ++unchanged;
    if (other < corner) continue;
    const int t1 = next_halfedge(corner), t2 = previous_halfedge(corner), u1 = next_halfedge(other),
              u2 = previous_halfedge(other);
    const int c = filling->corner[corner], a = filling->corner[t1], b = filling->corner[t2], d = filling->corner[other];
    if (!is_to_flip(star, c, a, b, d)) continue;
    // The triangles are (c, a, b) and (d, b, a), and become (c, a, d) and (d, b, c).
    const int beyond_a = filling->beyond[t1], beyond_b = filling->beyond[u1];
    filling->corner[t2] = d;
    filling->corner[u2] = c;
    set_beyond(filling, corner, beyond_b);
    set_beyond(filling, other, beyond_a);
    set_beyond(filling, t1, u1);
    unchanged = 0;
  }
}

// The new triangles: two fewer than there were.
static inline void fill_star(const star_around* star, double2 v, star_filling* filling) {
  filling->count = 0;
  if (star->infinite >= 0) {
    put_ghosts(star, filling);
  } else {
    cut_corners(star, v, filling);
  }
  flip_edges(star, filling);
}

END_SHARED

#endif

#endif
