// Vertices move, and edges that are not Delaunay then are mended. Segments: rows.
//
// swap_points exchanges the places of vertices with others. count_around and list_around_vertices, with a scan between:
// the rows around vertices. check_rows: which rows have turned over, where the hull is not convex, and which rows have
// an edge that is not locally Delaunay. mark_turned: the vertices that have moved of rows that have turned over. Flips
// are made in steps: claim_wrong_edges claims both rows of an edge by atomic minima; find_holding_rows: edges
// that hold both, with no better claim beside them; flip_edges_of_rows flips these.

#define GHOSTS

#include "constrained/meanwhile.h"
#include "operations/prefetch.h"
#include "refinement/flips.h"
#include "refinement/ranks.h"
#include "refinement/records.h"
#include "updates/arguments.h"
#include "updates/records.h"
#include "updates/walks.h"

#ifndef FIXED_POINT

kernel void swap_points(int n, global const int* restrict vertices, global double2* restrict others,
                        global double2* restrict points) {
  const int i = get_global_id(0);
  if (i < n) {
    const double2 other = others[i];
    others[i] = points[vertices[i]];
    points[vertices[i]] = other;
  }
}

// moved_at: per vertex, which of n it is, or with is_over, -1 again.
kernel void mark_moved(int n, int is_over, global const int* restrict vertices, global int* restrict moved_at) {
  const int i = get_global_id(0);
  if (i < n) moved_at[vertices[i]] = is_over ? -1 : i;
}

kernel void count_around(int n, global const int* restrict vertices, LIVING_MESH(), global const int* restrict rows_of,
                         global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    const int row = rows_of[vertices[i]], start = 3 * row + number_of_vertex(&rows[row], vertices[i]);
    int at = start;
    uint count = 0;
    do {
      ++count;
      at = next_around(&mesh, at);
    } while (at != start);
    counts[i] = count;
  }
}

// offsets: the scanned counts.
kernel void list_around_vertices(int n, global const int* restrict vertices, LIVING_MESH(),
                                 global const int* restrict rows_of, global const uint* restrict offsets,
                                 global int* restrict list) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    const int row = rows_of[vertices[i]];
    int at = 3 * row + number_of_vertex(&rows[row], vertices[i]);
    for (uint k = offsets[i]; k < offsets[i + 1]; ++k) {
      list[k] = row_of(at);
      at = next_around(&mesh, at);
    }
  }
}

// Whether the edge opposite to a corner is not locally Delaunay. Ghosts have none that are to be flipped.
static inline int is_wrong_edge(const seen_mesh* mesh, int corner) {
  const int row = row_of(corner), beyond = neighbor_at(mesh, corner);
  if (edge_at(mesh, corner) >= 0 || kind_of_row(&mesh->rows[row]) != ROW_TRIANGLE ||
      kind_of_row(&mesh->rows[beyond]) != ROW_TRIANGLE)
    return 0;
  return is_in_circle(mesh, row, point_at(mesh, corner_facing(mesh, beyond, row)));
}

// n rows of the list, or with all, the first n. found: for each ROW_TURNED, ROW_WRONG or neither. minima: incremented
// by the vertices of the hull that come before both of their neighbours: if it is convex at each of them, it goes round
// once if there is one.
kernel void check_rows(int n, int all, global const int* restrict list, LIVING_MESH(), global uchar* restrict found,
                       global volatile int* restrict minima) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    const int row = all ? i : list[i];
#if FETCH_AHEAD
    const int far = all ? min(n - 1, i + ROWS_AHEAD) : list[min(n - 1, i + ROWS_AHEAD)],
              near = all ? min(n - 1, i + ROWS_NEXT) : list[min(n - 1, i + ROWS_NEXT)];
    fetch_corners(&mesh, far);
    fetch_neighbors(&mesh, far);
    for (int k = 0; k < 3; ++k) fetch_corners(&mesh, max(0, rows[near].neighbor[k]));
#endif
    const int kind = kind_of_row(&rows[row]);
    int result = 0;
    if (kind == ROW_TRIANGLE) {
      const int corner = 3 * row;
      if (side_of_edge(&mesh, corner, point_at(&mesh, corner)) <= 0) {
        result = ROW_TURNED;
      } else {
        for (int k = 0; k < 3 && result == 0; ++k) {
          // If all rows are tested, each edge is tested on one side only.
          if ((!all || rows[row].neighbor[k] > row) && is_wrong_edge(&mesh, corner + k)) result = ROW_WRONG;
        }
      }
    } else if (kind == ROW_GHOST) {
      const int k = infinite_corner(&rows[row]), next = rows[row].neighbor[corner_before(k)];
      const double2 from = point_at(&mesh, 3 * row + corner_before(k)), at = point_at(&mesh, 3 * row + next_corner(k)),
                    to = point_at(&mesh, 3 * next + next_corner(infinite_corner(&rows[next])));
      const int turn = orient_sign(from, at, to, ORIENT_BOUND);
      if (turn < 0 || (turn == 0 && comes_before(from, at) != comes_before(at, to))) result = ROW_TURNED;
      if (comes_before(at, from) && comes_before(at, to)) atomic_inc(minima);
    }
    found[i] = (uchar)result;
  }
}

// n elements of the list of rows; with all: the rows themselves, as in check_rows. moved_at: per vertex, which of those
// that moved it is, or -1. turned: per vertex that moved, 1 if it is one of a row that has turned over.
kernel void mark_turned(int n, int all, global const int* restrict list, global const uchar* restrict found,
                        global const mesh_row* restrict rows, global const int* restrict moved_at,
                        global volatile uint* restrict turned) {
  const int i = get_global_id(0);
  if (i < n && found[i] == ROW_TURNED) {
    const int row = all ? i : list[i];
    const int k = infinite_corner(&rows[row]);
    for (int c = 0; c < 3; ++c) {
      const int at = rows[row].corner[c] >= 0 ? moved_at[rows[row].corner[c]] : -1;
      if (at >= 0) atomic_or(&turned[at], 1u);
    }
    if (k >= 0) {
      // The end of the next edge of the hull, too.
      const int next = rows[row].neighbor[corner_before(k)];
      const int at = moved_at[rows[next].corner[next_corner(infinite_corner(&rows[next]))]];
      if (at >= 0) atomic_or(&turned[at], 1u);
    }
  }
}

// n vertices: 1 for those on the hull.
kernel void find_hull_vertices(int n, global const int* restrict vertices, LIVING_MESH(),
                               global const int* restrict rows_of, global uint* restrict on_hull) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    const int row = rows_of[vertices[i]], start = 3 * row + number_of_vertex(&rows[row], vertices[i]);
    int at = start;
    uint found = 0;
    do {
      found |= infinite_corner(&rows[row_of(at)]) >= 0;
      at = next_around(&mesh, at);
    } while (at != start);
    on_hull[i] = found;
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Flips

// n rows of the list. first: the claim of rank 0; mask: ranks are below it and one more. corners: opposite to the edge
// that is to be flipped.
kernel void claim_wrong_edges(int n, uint first, uint mask, global const int* restrict list, LIVING_MESH(),
                              global volatile uint* restrict claims, global int* restrict corners,
                              global uchar* restrict states) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    int corner = -1;
    for (int k = 0; k < 3 && corner < 0; ++k) {
      if (is_wrong_edge(&mesh, 3 * list[i] + k)) corner = 3 * list[i] + k;
    }
    if (corner >= 0) {
      const uint claim = first + shuffled((uint)i, mask);
      atomic_min(&claims[row_of(corner)], claim);
      atomic_min(&claims[neighbor_at(&mesh, corner)], claim);
    }
    corners[i] = corner;
    states[i] = (uchar)(corner < 0 ? UPDATE_NEEDLESS : UPDATE_WAITS);
  }
}

// Whether nobody has a better claim on the rows beside this one.
static inline int is_free_around(const seen_mesh* mesh, int row, uint claim, global const uint* claims) {
  for (int k = 0; k < 3; ++k) {
    if (claims[mesh->rows[row].neighbor[k]] < claim) return 0;
  }
  return 1;
}

kernel void find_holding_rows(int n, uint first, uint mask, LIVING_MESH(), global const int* restrict corners,
                              global const uint* restrict claims, global uchar* restrict states) {
  const int i = get_global_id(0);
  if (i < n && states[i] == UPDATE_WAITS) {
    const seen_mesh mesh = {rows, points};
    const uint claim = first + shuffled((uint)i, mask);
    const int t = row_of(corners[i]), u = neighbor_at(&mesh, corners[i]);
    if (claims[t] == claim && claims[u] == claim && is_free_around(&mesh, t, claim, claims) &&
        is_free_around(&mesh, u, claim, claims)) {
      states[i] = UPDATE_HOLDS;
    }
  }
}

// next: two elements each, the rows to look at again, or -1. touched: from element first_touched on, two elements each,
// rows that this batch has changed first here, or -1.
kernel void flip_edges_of_rows(int n, int batch, int first_touched, global const int* restrict list,
                               global const int* restrict corners, global const uchar* restrict states,
                               global mesh_row* restrict rows, global volatile int* restrict rows_of,
                               global int* restrict touched, global int* restrict next,
                               global uchar* restrict is_next) {
  const int i = get_global_id(0);
  if (i < n) {
    global int* const changed = touched + first_touched + 2 * i;
    changed[0] = changed[1] = -1;
    next[2 * i] = list[i];
    next[2 * i + 1] = -1;
    is_next[2 * i] = states[i] != UPDATE_NEEDLESS;
    is_next[2 * i + 1] = 0;
    if (states[i] == UPDATE_HOLDS) {
      const flip_place at = place_of_flip(rows, corners[i]);
      const int t = at.row, u = at.beyond, c = rows[t].corner[at.k], d = rows[u].corner[at.j];
      int is_first;
      rows[t].parent = new_stamp(&rows[t], batch, &is_first);
      if (is_first) changed[0] = t;
      rows[u].parent = new_stamp(&rows[u], batch, &is_first);
      if (is_first) changed[1] = u;
      flip_rows(rows, at, number_across(&rows[at.from_row], c), number_across(&rows[at.from_beyond], d));
      for (int k = 0; k < 2; ++k) {
        write_shared(&rows_of[rows[t].corner[k]], t);
        write_shared(&rows_of[rows[u].corner[k]], u);
      }
      next[2 * i] = t;
      next[2 * i + 1] = u;
      is_next[2 * i + 1] = 1;
    }
  }
}

// Lists the rows that have an edge to flip, n of them.
kernel void append_rows(int n, global const int* restrict positions, int all, global const int* restrict from,
                        global int* restrict list) {
  const int i = get_global_id(0);
  if (i < n) list[i] = all ? positions[i] : from[positions[i]];
}

#endif
