// Vertices are removed from a mesh with ghosts, those whose stars are apart at once. Segments: the stars. One work-item
// per vertex; steps of three passes each, until no vertex waits.
//
// claim_stars claims the rows around each by atomic minima. find_holders: those that hold all of these, with no better
// claim beside them. fill_stars: these replace them by two rows fewer.

#define GHOSTS

#include "constrained/meanwhile.h"
#include "refinement/records.h"
#include "updates/arguments.h"
#include "updates/filled_star.h"
#include "updates/records.h"
#include "updates/walks.h"

#ifndef FIXED_POINT

// n elements of the list. first: the claim of rank 0. sizes: of each vertex the number of rows around it.
kernel void claim_stars(int n, uint first, global const int* restrict list, LIVING_MESH(),
                        global const int* restrict rows_of, global volatile uint* restrict claims,
                        global removed_vertex* restrict removed, global uint* restrict sizes,
                        global uchar* restrict states) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    removed_vertex of = removed[list[i]];
    const int row = rows_of[of.vertex];
    const int start = 3 * row + number_of_vertex(&rows[row], of.vertex);
    int at = start, count = 0;
    // Whichever row it is found by, the star begins with the one of the smallest number.
    of.corner = start;
    do {
      atomic_min(&claims[row_of(at)], first + of.rank);
      of.corner = min(of.corner, at);
      ++count;
      at = next_around(&mesh, at);
    } while (at != start);
    if (count > MOST_AROUND) states[list[i]] = UPDATE_TOO_LARGE;
    removed[list[i]] = of;
    sizes[i] = (uint)count;
  }
}

static inline int holds_star(const seen_mesh* mesh, int corner, uint claim, global const uint* claims) {
  int at = corner;
  do {
    if (claims[row_of(at)] != claim || claims[neighbor_at(mesh, at)] < claim) return 0;
    at = next_around(mesh, at);
  } while (at != corner);
  return 1;
}

kernel void find_holders(int n, uint first, global const int* restrict list, LIVING_MESH(),
                         global const uint* restrict claims, global const removed_vertex* restrict removed,
                         global uchar* restrict states) {
  const int i = get_global_id(0);
  if (i < n && states[list[i]] == UPDATE_WAITS) {
    const seen_mesh mesh = {rows, points};
    const removed_vertex of = removed[list[i]];
    if (holds_star(&mesh, of.corner, first + of.rank, claims)) states[list[i]] = UPDATE_HOLDS;
  }
}

// offsets: the scanned sizes. touched: from element first_touched on, per row around a vertex one that this batch has
// changed first here, or -1. waits: 1 for vertices that wait for the next step. triangles: incremented by the
// number of additional triangles, modulo 2^32.
kernel void fill_stars(int n, int batch, int first_touched, global const int* restrict list,
                       global const uint* restrict offsets, global mesh_row* restrict rows,
                       global const double2* restrict points, global volatile int* restrict rows_of,
                       global removed_vertex* restrict removed, global uchar* restrict states,
                       global int* restrict touched, global uchar* restrict waits,
                       global volatile uint* restrict triangles) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    const removed_vertex of = removed[list[i]];
    const int state = states[list[i]];
    const int holds = state == UPDATE_HOLDS;
    global int* const changed = touched + first_touched + offsets[i];
    waits[i] = state == UPDATE_WAITS;
    if (!holds) {
      for (uint k = 0; k < offsets[i + 1] - offsets[i]; ++k) changed[k] = -1;
    } else {
      star_around star;
      star_filling filling;
      list_around(&mesh, of.corner, &star);
      fill_star(&star, points[of.vertex], &filling);
      int more = 0;
      for (int k = 0; k < star.count; ++k) {
        global mesh_row* const row = &rows[star.row[k]];
        int is_first;
        more -= kind_of_row(row) == ROW_TRIANGLE;
        row->parent = new_stamp(row, batch, &is_first);
        changed[k] = is_first ? star.row[k] : -1;
      }
      for (int t = 0; t < filling.count; ++t) {
        global mesh_row* const row = &rows[star.row[t]];
        for (int k = 0; k < 3; ++k) {
          const int vertex = star.vertex[filling.corner[3 * t + k]], beyond = filling.beyond[3 * t + k];
          row->corner[k] = vertex;
          row->neighbor[k] = beyond >= 0 ? star.row[row_of(beyond)] : star.outside[~beyond];
          row->edge[k] = beyond >= 0 ? NO_EDGE_THERE : star.edge[~beyond];
          if (beyond < 0) rows[star.outside[~beyond]].neighbor[star.facing[~beyond]] = star.row[t];
          if (vertex >= 0) write_shared(&rows_of[vertex], star.row[t]);
        }
        more += kind_of_row(row) == ROW_TRIANGLE;
      }
      for (int k = 0; k < 2; ++k) {
        const int row = star.row[star.count - 2 + k];
        rows[row].corner[0] = NO_TRIANGLE;
        rows[row].neighbor[0] = star.row[0];
        removed[list[i]].freed[k] = row;
      }
      write_shared(&rows_of[of.vertex], star.row[0]);
      atomic_add(triangles, (uint)more);
      states[list[i]] = UPDATE_DONE;
    }
  }
}

#endif
