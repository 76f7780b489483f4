// The mesh that changes: made of triangles and hulls, and read. Segments: rows and hull vertices.
//
// number_hull: where vertices are on the hull. load_triangles and load_ghosts, one work-item per triangle and per hull
// vertex: rows with ghosts. clear_rows: further rows. report_changes: the contents of rows that a batch has
// changed. find_old_triangles: which triangles there were before.

#include "constrained/meanwhile.h"
#include "refinement/records.h"
#include "updates/arguments.h"
#include "updates/records.h"
#include "updates/walks.h"

#ifndef FIXED_POINT

// n hull vertices.
kernel void number_hull(int n, global const int* restrict hull, global int* restrict places) {
  const int i = get_global_id(0);
  if (i < n) places[hull[i]] = i;
}

// n triangles; edges: opposite to corners, the number of a constraint or -1, if there are any. The ghost of hull vertex
// i and the next one is in row n + i. inside: per ghost the corner opposite to its edge.
kernel void load_triangles(int n, int has_edges, global const int* restrict triangles,
                           global const int* restrict neighbors, global const int* restrict edges,
                           global const int* restrict places, global mesh_row* restrict rows,
                           global volatile int* restrict rows_of, global int* restrict inside) {
  const int i = get_global_id(0);
  if (i < n) {
    global mesh_row* const row = &rows[i];
    row->parent = 0;
    for (int k = 0; k < 3; ++k) {
      row->corner[k] = triangles[3 * i + k];
      row->edge[k] = has_edges ? edges[3 * i + k] : NO_EDGE_THERE;
      int beyond = neighbors[3 * i + k];
      if (beyond < 0) {
        const int at = places[triangles[3 * i + next_corner(k)]];
        inside[at] = 3 * i + k;
        beyond = n + at;
      }
      row->neighbor[k] = beyond;
      write_shared(&rows_of[triangles[3 * i + k]], i);
    }
  }
}

// n hull vertices, after `first` triangles.
kernel void load_ghosts(int n, int first, int has_edges, global const int* restrict hull,
                        global const int* restrict inside, global const int* restrict edges,
                        global mesh_row* restrict rows) {
  const int i = get_global_id(0);
  if (i < n) {
    const int next = i + 1 == n ? 0 : i + 1, before = i == 0 ? n - 1 : i - 1;
    global mesh_row* const row = &rows[first + i];
    row->parent = 0;
    row->corner[0] = INFINITE_VERTEX;
    row->corner[1] = hull[next];
    row->corner[2] = hull[i];
    row->neighbor[0] = row_of(inside[i]);
    row->neighbor[1] = first + before;
    row->neighbor[2] = first + next;
    row->edge[0] = has_edges ? edges[inside[i]] : NO_EDGE_THERE;
    row->edge[1] = row->edge[2] = NO_EDGE_THERE;
  }
}

// n rows from `first` on have no triangle, and have not changed in any batch.
kernel void clear_rows(int n, int first, global mesh_row* restrict rows) {
  const int i = get_global_id(0);
  if (i < n) {
    const mesh_row free_row = {{NO_TRIANGLE, NO_TRIANGLE, NO_TRIANGLE}, {0, 0, 0}, {-1, -1, -1}, stamp_of(-1, 0), 0};
    rows[first + i] = free_row;
  }
}

// n elements; negative ones are no rows.
kernel void flag_touched(int n, global const int* restrict touched, global uchar* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) flags[i] = touched[i] >= 0;
}

// n rows that a batch has changed, at these positions.
kernel void report_changes(int n, global const int* restrict positions, global const int* restrict touched,
                           global const mesh_row* restrict rows, global row_report* restrict reports) {
  const int i = get_global_id(0);
  if (i < n) {
    global const mesh_row* const row = &rows[touched[positions[i]]];
    row_report report;
    report.row = touched[positions[i]];
    report.was_triangle = row->parent & 1;
    report.holds = kind_of_row(row);
    for (int k = 0; k < 3; ++k) report.corner[k] = row->corner[k];
    reports[i] = report;
  }
}

// n rows: 1 for those that held a triangle before this batch.
kernel void find_old_triangles(int n, int batch, global const mesh_row* restrict rows, global uchar* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) {
    int touched;
    flags[i] = (uchar)(new_stamp(&rows[i], batch, &touched) & 1);
  }
}

#endif
