// Vertices are put into a mesh with ghosts, those whose cavities are apart at once. Segments: the cavities. One
// work-item per vertex; after the first pass steps of three passes each, until no vertex waits.
//
// locate_vertices: the row of each, by hints and a walk. claim_around finds the cavities in the mesh as it is now,
// and claims their rows by atomic minima; gather_around, after a scan of the numbers of sides, lists the sides of
// cavities that have no row, and no row beside them, of a vertex with a smaller rank; insert_around writes a triangle
// or a ghost for each side. The rows of a cavity are used again, and so are two rows that were set aside.

#define GHOSTS

#include "constrained/meanwhile.h"
#include "operations/prefetch.h"
#include "refinement/claimed_cavities.h"
#include "refinement/records.h"
#include "updates/arguments.h"
#include "updates/records.h"
#include "updates/walks.h"

#ifndef FIXED_POINT

// The last of n coordinates that is not above x, or the first one.
static inline int last_below(global const double* restrict coordinates, int n, double x) {
  int first = 0;
  for (int count = n; count > 1;) {
    const int before = count / 2, is_above = coordinates[first + before] <= x;
    first = is_above ? first + before : first;
    count = is_above ? count - before : before;
  }
  return first;
}

kernel void locate_vertices(int n, LIVING_MESH(), HINTS(), global placed_vertex* restrict placed) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    const double2 p = points[placed[i].vertex];
    const int slab = last_below(xs, slabs, p.x);
    const int cell = slab * slabs + last_below(ys + slab * slabs, slabs, p.y);
    placed[i].corner = 3 * find_row(&mesh, rows_of[vertices[cell]], p);
  }
}

// Finds where a vertex is: its cavity begins at the same corner, however it was found.
static inline placed_vertex place_in_row(const seen_mesh* mesh, placed_vertex of, int row, double2 p) {
  of.from = of.to = of.edge = of.found = -1;
  const int ghost = infinite_corner(&mesh->rows[row]);
  if (ghost >= 0) {
    // Goes to the first of the hull's edges beyond which the vertex is.
    for (;;) {
      const int before = neighbor_at(mesh, 3 * row + corner_before(infinite_corner(&mesh->rows[row])));
      if (!is_in_circle(mesh, before, p)) break;
      row = before;
    }
    of.corner = 3 * row;
    return of;
  }
  int on = 0, side = 0, other = 0;
  for (int k = 0; k < 3; ++k) {
    if (side_of_edge(mesh, 3 * row + k, p) == 0) {
      ++on;
      other = side;
      side = k;
    }
  }
  of.corner = 3 * row;
  if (on == 2) {
    of.found = mesh->rows[row].corner[3 - side - other];
  } else if (on == 1) {
    const int beyond = mesh->rows[row].neighbor[side], edge = mesh->rows[row].edge[side];
    int corner = 3 * row + side;
    if (beyond < row && infinite_corner(&mesh->rows[beyond]) < 0) corner = corner_facing(mesh, beyond, row);
    of.corner = 3 * row_of(corner);
    if (edge >= 0) {
      of.edge = edge;
      of.corner = corner;
      of.from = vertex_at(mesh, next_halfedge(corner));
      of.to = vertex_at(mesh, previous_halfedge(corner));
    }
  }
  return of;
}

// n elements of the list. first: the claim of rank 0. sizes: of each vertex the number of rows around it.
kernel void claim_around(int n, uint first, global const int* restrict list, LIVING_MESH(),
                         global volatile uint* restrict claims, global placed_vertex* restrict placed,
                         global uint* restrict sizes, global uchar* restrict states) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
#if FETCH_AHEAD
    const int far = row_of(placed[list[min(n - 1, i + ROWS_AHEAD)]].corner),
              near = row_of(placed[list[min(n - 1, i + ROWS_NEXT)]].corner);
    fetch_row(&mesh, far);
    fetch((global const void*)&claims[far]);
    fetch_corners(&mesh, near);
    fetch_neighbors(&mesh, near);
#endif
    placed_vertex of = placed[list[i]];
    const double2 p = points[of.vertex];
    const uint claim = first + of.rank;
    of = place_in_row(&mesh, of, find_row(&mesh, row_of(of.corner), p), p);
    uint size = 0;
    if (of.found >= 0) {
      states[list[i]] = POINT_DROPPED;
    } else if (of.edge >= 0) {
      const int row = row_of(of.corner), other = corner_facing(&mesh, neighbor_at(&mesh, of.corner), row);
      size = (uint)claim_tour(&mesh, next_halfedge(of.corner), of.corner, p, claim, claims) +
             (uint)claim_tour(&mesh, next_halfedge(other), other, p, claim, claims);
    } else {
      size = (uint)claim_tour(&mesh, of.corner, of.corner, p, claim, claims);
    }
    of.count = (int)size - 2;
    placed[list[i]] = of;
    sizes[i] = size;
  }
}

// offsets: the scanned sizes. visits: per row the last claim by which this met it.
kernel void gather_around(int n, uint first, global const int* restrict list, global const uint* restrict offsets,
                          global const placed_vertex* restrict placed, LIVING_MESH(),
                          global const uint* restrict claims, global uint* restrict visits,
                          global star_side* restrict sides, global uchar* restrict states) {
  const int i = get_global_id(0);
  if (i < n && states[list[i]] == POINT_WAITS) {
    const seen_mesh mesh = {rows, points};
    const placed_vertex of = placed[list[i]];
    const uint claim = first + of.rank;
    gathered found = {0, 0, 1};
    global star_side* const star = sides + offsets[i];
    if (of.edge < 0) {
      found = gather_tour(&mesh, of.corner, of.corner, claim, claims, visits, star, found);
    } else {
      const int other = corner_facing(&mesh, neighbor_at(&mesh, of.corner), row_of(of.corner));
      found = gather_tour(&mesh, next_halfedge(of.corner), of.corner, claim, claims, visits, star, found);
      if (found.holds) found = gather_tour(&mesh, next_halfedge(other), other, claim, claims, visits, star, found);
    }
    if (found.holds) states[list[i]] = POINT_INSERTED;
  }
}

// touched: from element first_touched on, per side a row that this batch has changed first here, or -1. waits: 1 for
// vertices that wait for the next step.
kernel void insert_around(int n, int batch, int first_touched, global const int* restrict list,
                          global const uint* restrict offsets, global const placed_vertex* restrict placed,
                          global const uchar* restrict states, global const star_side* restrict sides,
                          global mesh_row* restrict rows, global volatile int* restrict rows_of,
                          global int* restrict touched, global uchar* restrict waits) {
  const int i = get_global_id(0);
  if (i < n) {
    const uint first = offsets[i];
    const int count = (int)(offsets[i + 1] - first), state = states[list[i]];
    waits[i] = state == POINT_WAITS;
    if (state != POINT_INSERTED) {
      for (int k = 0; k < count; ++k) touched[first_touched + (int)first + k] = -1;
    } else {
      const placed_vertex of = placed[list[i]];
      global const star_side* const star = sides + first;
      int row = star[0].row, before = of.spare[1];
      const int row_of_first = row;
      for (int k = 0; k < count; ++k) {
        const star_side side = star[k];
        const int to = k + 1 == count ? star[0].from : star[k + 1].from;
        const int after = k + 1 == count     ? row_of_first
                          : k + 1 < of.count ? star[k + 1].row
                                             : of.spare[k + 1 - of.count];
        global mesh_row* const written = &rows[row];
        int is_first;
        written->parent = new_stamp(written, batch, &is_first);
        write_star_row(written, of.vertex, side, to, after, before, of.edge, of.from, of.to);
        rows[side.outside].neighbor[side.facing] = row;
        if (side.from >= 0) write_shared(&rows_of[side.from], row);
        touched[first_touched + (int)first + k] = is_first ? row : -1;
        before = row;
        row = after;
      }
      write_shared(&rows_of[of.vertex], row_of_first);
    }
  }
}

#endif
