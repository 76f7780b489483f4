// Rows with ghosts, and walks to the row that contains a point. Every decision is exact.
#ifndef FLAUNAY_UPDATES_WALKS_H
#define FLAUNAY_UPDATES_WALKS_H

#ifndef GHOSTS
#define GHOSTS
#endif

#include "arithmetic/language.h"
#include "refinement/cavities.h"
#include "updates/codes.h"
#include "updates/limits.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// The number of the corner at infinity, or -1.
static inline int infinite_corner(GLOBAL const mesh_row* row) {
  return row->corner[0] == INFINITE_VERTEX   ? 0
         : row->corner[1] == INFINITE_VERTEX ? 1
         : row->corner[2] == INFINITE_VERTEX ? 2
                                             : -1;
}
static inline int number_of_vertex(GLOBAL const mesh_row* row, int vertex) {
  return row->corner[0] == vertex ? 0 : row->corner[1] == vertex ? 1 : 2;
}
// The number of the corner opposite to an edge that begins at this vertex. Unlike neighbours, corners are not written
// while rows beside are.
static inline int number_across(GLOBAL const mesh_row* row, int from) {
  return corner_before(number_of_vertex(row, from));
}
static inline int kind_of_row(GLOBAL const mesh_row* row) {
  return row->corner[0] == NO_TRIANGLE ? ROW_FREE : infinite_corner(row) >= 0 ? ROW_GHOST : ROW_TRIANGLE;
}

// Rows remember in which batch they changed first, and whether they held a triangle before.
static inline int stamp_of(int batch, int was_triangle) { return 2 * batch + was_triangle; }
// The stamp of a row that is about to change. touched: whether it has not changed in this batch yet.
static inline int new_stamp(GLOBAL const mesh_row* row, int batch, int* touched) {
  *touched = row->parent >> 1 != batch;
  return *touched ? stamp_of(batch, kind_of_row(row) == ROW_TRIANGLE) : row->parent;
}

// A row that was freed leads to one that was not at that time, so this ends.
static inline int living_row(const seen_mesh* mesh, int row) {
  while (mesh->rows[row].corner[0] == NO_TRIANGLE) row = mesh->rows[row].neighbor[0];
  return row;
}

// The next row counter-clockwise around a corner's vertex, by its corner there.
static inline int next_around(const seen_mesh* mesh, int corner) {
  const int beyond = neighbor_at(mesh, next_halfedge(corner)), vertex = vertex_at(mesh, corner);
  return 3 * beyond + number_of_vertex(&mesh->rows[beyond], vertex);
}

// The sign of the turn from the edge opposite to a corner to p.
static inline int side_of_edge(const seen_mesh* mesh, int corner, double2 p) {
  return orient_sign(point_at(mesh, next_halfedge(corner)), point_at(mesh, previous_halfedge(corner)), p, ORIENT_BOUND);
}

// Goes straight from a vertex of a row to p, and from vertices on the way on. Every step is nearer to p on that line,
// so this ends.
static inline int walk_straight(const seen_mesh* mesh, int row, double2 p) {
  int corner = 3 * row;
  for (;;) {
    const double2 q = point_at(mesh, corner);
    // The row at q towards p.
    int at = corner, ghost = -1;
    do {
      if (infinite_corner(&mesh->rows[row_of(at)]) >= 0) {
        if (is_in_circle(mesh, row_of(at), p)) ghost = row_of(at);
      } else if (orient_sign(q, point_at(mesh, next_halfedge(at)), p, ORIENT_BOUND) >= 0 &&
                 orient_sign(q, point_at(mesh, previous_halfedge(at)), p, ORIENT_BOUND) <= 0) {
        break;
      }
      at = next_around(mesh, at);
    } while (at != corner);
    if (at == corner && ghost >= 0) return ghost;
    row = row_of(at);
    int facing = at;
    for (;;) {
      if (side_of_edge(mesh, facing, p) >= 0) return row;
      // It goes through an end of the edge, or across it.
      const int right = next_halfedge(facing), left = previous_halfedge(facing);
      if (orient_sign(q, point_at(mesh, right), p, ORIENT_BOUND) == 0) {
        corner = right;
        break;
      }
      if (orient_sign(q, point_at(mesh, left), p, ORIENT_BOUND) == 0) {
        corner = left;
        break;
      }
      const int beyond = neighbor_at(mesh, facing), apex = corner_facing(mesh, beyond, row);
      row = beyond;
      if (infinite_corner(&mesh->rows[row]) >= 0) return row;
      // From the triangle (apex, left, right), it leaves on that side of the apex on which p is not.
      const int turn = orient_sign(q, p, point_at(mesh, apex), ORIENT_BOUND);
      if (turn == 0) {
        if (side_of_edge(mesh, next_halfedge(apex), p) >= 0 && side_of_edge(mesh, previous_halfedge(apex), p) >= 0)
          return row;
        corner = apex;
        break;
      }
      facing = turn > 0 ? next_halfedge(apex) : previous_halfedge(apex);
    }
  }
}

// A row that has p in it or on its border, or a ghost beyond whose edge it is; from any row.
static inline int find_row(const seen_mesh* mesh, int row, double2 p) {
  row = living_row(mesh, row);
  const int k = infinite_corner(&mesh->rows[row]);
  if (k >= 0) row = mesh->rows[row].neighbor[k];
  int from = -1;
  for (int step = 0; step < WALK_STEPS; ++step) {
    GLOBAL const mesh_row* const at = &mesh->rows[row];
    int next = -1;
    for (int side = 0; side < 3 && next < 0; ++side) {
      if (at->neighbor[side] != from && side_of_edge(mesh, 3 * row + side, p) < 0) next = at->neighbor[side];
    }
    if (next < 0) return row;
    from = row;
    row = next;
    if (infinite_corner(&mesh->rows[row]) >= 0) return row;
  }
  return walk_straight(mesh, row, p);
}

END_SHARED

#endif

#endif
