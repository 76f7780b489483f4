// The triangles that close the gap around the south pole in a triangulation of sets of places. Few triangles do; they
// are made on the host, which learns the hull from gather_hull, after open_edges has found the edges there: one
// work-item per hull vertex, and one per triangle. place_sphere_rows then puts those of each set behind its triangles
// of the plane, with one work-item per row, and link_cap joins both, with one per edge between them. One pass each.

#include "arithmetic/language.h"
#include "operations/segment_near.h"
#include "sphere/records.h"

// n triangles. edge_from: per vertex the corner opposite to the edge without a triangle beyond that begins there.
kernel void open_edges(int n, global const int* restrict triangles, global const int* restrict neighbors,
                       global int* restrict edge_from) {
  const int t = get_global_id(0);
  if (t < n && (neighbors[3 * t] | neighbors[3 * t + 1] | neighbors[3 * t + 2]) < 0) {
    for (int k = 0; k < 3; ++k) {
      if (neighbors[3 * t + k] < 0) edge_from[triangles[k == 2 ? 3 * t : 3 * t + k + 1]] = 3 * t + k;
    }
  }
}

#ifndef FIXED_POINT

kernel void gather_hull(int n, global const int* restrict hull, global const double2* restrict places,
                        global const int* restrict edge_from, global hull_vertex* restrict vertices) {
  const int i = get_global_id(0);
  if (i < n) {
    const int point = hull[i];
    vertices[i].x = places[point].x;
    vertices[i].y = places[point].y;
    vertices[i].point = point;
    vertices[i].edge = edge_from[point];
  }
}

#endif

// Set s has rows from sums[s] on, of which those from plane_sums[s] on are in the plane's rows, and the rest in the
// cap's.
kernel void place_sphere_rows(int n, int sets, global const int* restrict sums, global const int* restrict plane_sums,
                              global const int* restrict plane_triangles, global const int* restrict plane_neighbors,
                              global const int* restrict cap_triangles, global const int* restrict cap_neighbors,
                              global int* restrict triangles, global int* restrict neighbors) {
  const int row = get_global_id(0);
  if (row < n) {
    const int s = segment_near(row, sets, sums);
    const int planar = plane_sums[s + 1] - plane_sums[s], place = row - sums[s];
    const int is_planar = place < planar;
    // Rows of the cap have their final numbers.
    const int shift = is_planar ? sums[s] - plane_sums[s] : 0;
    const int from = is_planar ? plane_sums[s] + place : sums[s] - plane_sums[s] + place - planar;
    for (int k = 0; k < 3; ++k) {
      const int beyond = is_planar ? plane_neighbors[3 * from + k] : cap_neighbors[3 * from + k];
      triangles[3 * row + k] = is_planar ? plane_triangles[3 * from + k] : cap_triangles[3 * from + k];
      neighbors[3 * row + k] = beyond < 0 ? beyond : beyond + shift;
    }
  }
}

kernel void link_cap(int n, global const int2* restrict links, global int* restrict neighbors) {
  const int i = get_global_id(0);
  if (i < n) neighbors[links[i].x] = links[i].y;
}
