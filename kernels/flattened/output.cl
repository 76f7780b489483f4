// Output: ids become indices of the input, and each row begins with its smallest index.
//
// finish_rows does so for triangles and their neighbours, map_ids for the hull. If there are several sets,
// triangle_sets and reorder_triangles put their triangles into the order of the sets, triangle_places and reorder_twins
// their twins, if they are known. Each kernel is one pass, with one
// work-item per triangle or hull vertex.

#include "mesh/halfedges.h"

// rows may be triangles, and neighbors twins.
kernel void finish_rows(int n, int with_neighbors, global const int* triangles, global const int* twins,
                        global const int* restrict source, global int* rows, global int* neighbors) {
  const int t = get_global_id(0);
  if (t < n) {
    int v[3], beyond[3] = {-1, -1, -1};
    int first = 0;
    for (int j = 0; j < 3; ++j) {
      v[j] = source[triangles[3 * t + j]];
      if (v[j] < v[first]) first = j;
      if (with_neighbors) beyond[j] = twins[opposite_halfedge(3 * t + j)];
    }
    for (int j = 0; j < 3; ++j) {
      const int from = (first + j) % 3;
      rows[3 * t + j] = v[from];
      if (with_neighbors) neighbors[3 * t + j] = beyond[from] < 0 ? -1 : beyond[from] / 3;
    }
  }
}

// Indices for ids.
kernel void map_ids(int n, global const int* restrict ids, global const int* restrict source,
                    global int* restrict indices) {
  const int i = get_global_id(0);
  if (i < n) indices[i] = source[ids[i]];
}

// Several sets: the triangles in the order of their sets, otherwise as they were.
kernel void triangle_sets(int n, global const int* restrict triangles, global const int* restrict set_of_id,
                          global uint64* restrict keys, global int* restrict order,
                          global volatile uint* restrict counts) {
  const int t = get_global_id(0);
  if (t < n) {
    const int s = set_of_id[triangles[3 * t]];
    keys[t] = s;
    order[t] = t;
    atomic_inc(&counts[s]);
  }
}

kernel void reorder_triangles(int n, global const int* restrict order, global const int* restrict triangles,
                              global int* restrict reordered) {
  const int t = get_global_id(0);
  if (t < n) {
    const int from = order[t];
    for (int j = 0; j < 3; ++j) reordered[3 * t + j] = triangles[3 * from + j];
  }
}

// order: the triangle that goes to each place; places: where each triangle goes.
kernel void triangle_places(int n, global const int* restrict order, global int* restrict places) {
  const int t = get_global_id(0);
  if (t < n) places[order[t]] = t;
}

kernel void reorder_twins(int n, global const int* restrict order, global const int* restrict places,
                          global const int* restrict twins, global int* restrict reordered) {
  const int t = get_global_id(0);
  if (t < n) {
    for (int j = 0; j < 3; ++j) {
      const int twin = twins[3 * order[t] + j];
      reordered[3 * t + j] = twin < 0 ? -1 : 3 * places[twin / 3] + twin % 3;
    }
  }
}
