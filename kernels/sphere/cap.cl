// What closes the gap around the south pole in a triangulation of sets of places. Few triangles do; they are made on
// the host, which learns the hull from gather_hull, after open_edges has found the edges there: one work-item per hull
// vertex, and one per corner of a triangle. place_sphere_rows then puts those of each set behind its triangles of the
// plane, with one work-item per row, and link_cap joins both, with one per edge between them. One pass each.

#include "arithmetic/language.h"
#include "operations/search.h"

// The triangle's corner, of all n, opposite to the edge without a triangle beyond that begins at a vertex.
kernel void open_edges(int n, global const int* restrict triangles, global const int* restrict neighbors,
                       global int* restrict edge_from) {
  const int c = get_global_id(0);
  if (c < n && neighbors[c] < 0) edge_from[triangles[c % 3 == 2 ? c - 2 : c + 1]] = c;
}

#ifndef FIXED_POINT

// Of sets without triangles, edges have no meaning.
kernel void gather_hull(int n, global const int* restrict hull, global const double2* restrict places,
                        global const int* restrict edge_from, global double2* restrict hull_places,
                        global int* restrict edges) {
  const int i = get_global_id(0);
  if (i < n) {
    hull_places[i] = places[hull[i]];
    edges[i] = edge_from[hull[i]];
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
    const int s = segment_of(row, sets, sums);
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
