// Tests of single triangles. Segments: none; one pass each.
//
// place_edges, load_rows, load_vertices and place_apexes: the mesh, from arrays of triangulations. test_rows: the tasks
// for rows. retry_frozen: triangles that are tried once more. write_centroids: places at which the host asks for areas,
// and set_areas.

#include "arithmetic/coordinates.h"
#include "refinement/arguments.h"
#include "refinement/blocks.h"
#include "refinement/records.h"

#ifndef FIXED_POINT

// n corners and the edges that are opposite to them.
kernel void place_edges(int n, global const int2* restrict corners, global int* restrict edges) {
  const int i = get_global_id(0);
  if (i < n) edges[corners[i].x] = corners[i].y;
}

// numbers: the numbers of vertices here. kept: per edge, if some must be kept.
kernel void load_rows(int n, int has_kept, global const int* restrict triangles, global const int* restrict neighbors,
                      global const int* restrict edges, global const uchar* restrict kept,
                      global const int* restrict numbers, global mesh_row* restrict rows,
                      global uchar* restrict states) {
  const int t = get_global_id(0);
  if (t < n) {
    for (int k = 0; k < 3; ++k) {
      const int edge = edges[3 * t + k];
      rows[t].corner[k] = numbers[triangles[3 * t + k]];
      rows[t].neighbor[k] = neighbors[3 * t + k];
      rows[t].edge[k] = edge >= 0 && has_kept && kept[edge] ? edge | EDGE_KEPT : edge;
    }
    rows[t].parent = t;
    rows[t].changed = 0;
    states[t] = ROW_NEW;
  }
}
// n points. names: the points of vertices.
kernel void load_vertices(int n, scaling scale, global const double* restrict coordinates,
                          global const int* restrict numbers, global double2* restrict points,
                          global int* restrict names, global int2* restrict births,
                          global edge_place* restrict places) {
  const int i = get_global_id(0);
  if (i < n) {
    const int v = numbers[i];
    const edge_place nowhere = {0.0, 0.0, -1, -1};
    points[v] = scaled_point(i, coordinates, scale);
    names[v] = i;
    births[v] = VECTOR(int2, -1, 0);
    places[v] = nowhere;
  }
}

// The places of n vertices at apexes.
kernel void place_apexes(int n, global const int* restrict vertices, global const edge_place* restrict at_apexes,
                         global edge_place* restrict places) {
  const int i = get_global_id(0);
  if (i < n) places[vertices[i]] = at_apexes[i];
}

// n rows; refused ones are left out. Tests constraints first, and then triangles.
kernel void test_rows(int n, int segments_only, refinement_rules rules, REFINED_MESH(), global uchar* restrict states) {
  const int row = get_global_id(0);
  if (row < n && rows[row].corner[0] != NO_TRIANGLE) {
    const seen_mesh mesh = {rows, points};
    int state = states[row];
    if (segments_only) {
      state = (state & ~ROW_ALL_SPLITS) | splits_of_row(&mesh, row, rules);
    } else if ((state & ROW_REFUSED) == EXCUSED_NOT) {
      const int tier = tier_of_row(&mesh, row, rules, 1.0, areas, 0, places, ends, wedges);
      state = (state & ROW_ALL_SPLITS) | state_of_tier(tier);
    }
    states[row] = (uchar)state;
  }
}

kernel void retry_frozen(int n, global uchar* restrict states, global uchar* restrict is_tried) {
  const int row = get_global_id(0);
  if (row < n) {
    const int is_frozen = (states[row] & ROW_REFUSED) == EXCUSED_FROZEN;
    if (is_frozen) states[row] = (uchar)((states[row] & ~ROW_REFUSED) | ROW_BAD);
    is_tried[row] = (uchar)is_frozen;
  }
}

// n rows of the list.
kernel void write_centroids(int n, global const int* restrict list, REFINED_MESH(),
                            global double2* restrict centroids) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    centroids[i] = centroid_of(&mesh, list[i]);
  }
}

// n rows of the list: their parents, if areas differ by triangles that were given.
kernel void find_parents(int n, refinement_rules rules, global const int* restrict list,
                         global const mesh_row* restrict given, global const double2* restrict points,
                         global mesh_row* restrict rows) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    rows[list[i]].parent = parent_of(&mesh, given, list[i], rules);
  }
}

// n rows of the list: sets their areas from the host's values and from the areas of their parents, if any; and
// whether they are too large.
kernel void set_areas(int n, int has_parents, refinement_rules rules, global const int* restrict list,
                      global const mesh_row* restrict rows, global const double2* restrict points,
                      global const double* restrict given, global const double* restrict parent_areas,
                      global double* restrict areas, global uchar* restrict states) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    const int row = list[i];
    areas[row] = has_parents ? smaller_area(given[i], parent_areas[rows[row].parent]) : given[i];
    const int tier = tier_of_large(&mesh, row, rules, 1.0, areas, 0);
    states[row] = (uchar)((states[row] & ~ROW_NEW) | state_of_tier(tier));
  }
}

#endif
