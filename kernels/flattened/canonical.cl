// The canonical result: where an empty circle passes through more than three points, their polygon becomes a fan
// from its lexicographically smallest vertex, which is the one with the smallest id.
//
// cocircular_flags tests each interior edge; cocircular_exact decides those left undecided (a packed list).
// cocircular_listed only tells whether there are any among the listed ones. If there
// are cocircular edges, cell_flags finds the half-edges around their cells, and cell_links makes each cell's border a
// cycle. jump_labels brings each cycle's smallest id to all of the cycle by pointer jumping, in as many passes as the
// logarithm of the longest cycle. fan_flags and fan_write replace the cells' triangles. The other kernels are one pass
// each, with one work-item per half-edge.

#include "flattened/codes.h"
#include "mesh/halfedges.h"
#include "operations/prefetch.h"
#include "predicates/planar.h"

// The in-circle test of the apexes beside half-edge h and its twin: 0 if they are cocircular, 1 if the edge is not
// Delaunay, UNDECIDED.
static inline int circle_beside(int h, int twin, global const int* triangles, global const double2* points,
                                filter_bound bound, int exact) {
  const double2 apex = points[triangles[opposite_corner(h)]], beyond = points[triangles[opposite_corner(twin)]];
  const double2 from = points[halfedge_from(triangles, h)], to = points[halfedge_to(triangles, h)];
  return exact ? circle_undecided(apex, from, to, beyond, bound) : circle_filtered(apex, from, to, beyond, bound);
}

// How many half-edges ahead of its use an apex is fetched.
#define APEXES_AHEAD 16

// flags[h], for the smaller half-edge of each interior edge: 1 cocircular, 0 not, or FLAG_UNDECIDED; 0 for all others.
// broken[0] gets BROKEN_CIRCLE if an edge is not Delaunay.
kernel void cocircular_flags(int n, filter_bound bound, global const int* restrict triangles,
                             global const int* restrict twins, global const double2* restrict points,
                             global uchar* restrict flags, global volatile int* restrict broken) {
  const int h = get_global_id(0);
  if (h < n) {
    const int twin = twins[h];
    int flag = 0;
    const int ahead = h + APEXES_AHEAD;
    if (ahead < n && twins[ahead] > ahead) fetch(points + triangles[opposite_corner(twins[ahead])]);
    if (twin > h) {
      const int sign = circle_beside(h, twin, triangles, points, bound, 0);
      flag = sign == UNDECIDED ? FLAG_UNDECIDED : sign == 0;
      if (sign == 1) atomic_or(broken, BROKEN_CIRCLE);
    }
    flags[h] = flag;
  }
}

kernel void cocircular_exact(filter_bound bound, global const uint* restrict count, global const int* restrict list,
                             global const int* restrict triangles, global const int* restrict twins,
                             global const double2* restrict points, global uchar* restrict flags,
                             global volatile int* restrict broken) {
  const int length = count[0];
  for (int k = get_global_id(0); k < length; k += get_global_size(0)) {
    const int h = list[k];
    const int sign = circle_beside(h, twins[h], triangles, points, bound, 1);
    flags[h] = sign == 0;
    if (sign > 0) atomic_or(broken, BROKEN_CIRCLE);
  }
}

// found[0]: whether the apexes beside one of the listed half-edges are cocircular.
kernel void cocircular_listed(int n, filter_bound bound, global const int* restrict list,
                              global const int* restrict triangles, global const int* restrict twins,
                              global const double2* restrict points, global volatile int* restrict found,
                              global volatile int* restrict broken) {
  const int k = get_global_id(0);
  if (k < n) {
    const int h = list[k], twin = twins[h];
    if (twin > h) {
      int sign = circle_beside(h, twin, triangles, points, bound, 0);
      if (sign == UNDECIDED) sign = circle_beside(h, twin, triangles, points, bound, 1);
      if (sign == 0) atomic_or(found, 1);
      if (sign > 0) atomic_or(broken, BROKEN_CIRCLE);
    }
  }
}

// Both half-edges of the edges listed.
kernel void dissolve_twins(int n, global const int* restrict list, global const int* restrict twins,
                           global uchar* restrict flags) {
  const int k = get_global_id(0);
  if (k < n) flags[twins[list[k]]] = 1;
}

// in_cell[t]: triangle t has a dissolved edge. border[c]: the triangle of corner c is in a cell, and the half-edge
// opposite to c remains, on the cell's border. From here on border half-edges are listed by these corners.
kernel void cell_flags(int n, global const uchar* restrict dissolved, global uchar* restrict in_cell,
                       global uchar* restrict border) {
  const int t = get_global_id(0);
  if (t < n) {
    const int in = dissolved[3 * t] | dissolved[3 * t + 1] | dissolved[3 * t + 2];
    in_cell[t] = in;
    for (int c = 3 * t; c < 3 * t + 3; ++c) border[c] = in & !dissolved[opposite_halfedge(c)];
  }
}

// place[h]: where border half-edge h stands in the list.
kernel void cell_places(int n, global const int* restrict list, global int* restrict place) {
  const int k = get_global_id(0);
  if (k < n) place[opposite_halfedge(list[k])] = k;
}

// The next border half-edge of the same cell, and the id at its own begin as first label.
kernel void cell_links(int n, global const int* restrict list, global const int* restrict place,
                       global const int* restrict triangles, global const int* restrict twins,
                       global const uchar* restrict dissolved, global int* restrict next, global int* restrict label) {
  const int k = get_global_id(0);
  if (k < n) {
    const int own = opposite_halfedge(list[k]);
    int h = next_halfedge(own);
    while (dissolved[h]) h = next_halfedge(twins[h]);
    next[k] = place[h];
    label[k] = halfedge_from(triangles, own);
  }
}

kernel void jump_labels(int n, global const int* restrict next, global const int* restrict label,
                        global int* restrict new_next, global int* restrict new_label,
                        global volatile int* restrict changed) {
  const int k = get_global_id(0);
  if (k < n) {
    const int j = next[k];
    const int smaller = min(label[k], label[j]);
    new_label[k] = smaller;
    new_next[k] = next[j];
    if (smaller != label[k]) atomic_or(changed, 1);
  }
}

// A border half-edge that does not touch its cell's smallest vertex makes a triangle with it.
kernel void fan_flags(int n, global const int* restrict list, global const int* restrict triangles,
                      global const int* restrict label, global uint* restrict counts) {
  const int k = get_global_id(0);
  if (k < n) {
    const int own = opposite_halfedge(list[k]);
    counts[k] = halfedge_from(triangles, own) != label[k] && halfedge_to(triangles, own) != label[k];
  }
}

// The new triangles, to be put in the places of the cells' old ones.
kernel void fan_write(int n, global const int* restrict list, global const int* restrict triangles,
                      global const int* restrict label, global const uint* restrict scanned,
                      global int* restrict fans) {
  const int k = get_global_id(0);
  if (k < n && scanned[k + 1] != scanned[k]) {
    const int to = scanned[k];
    const int own = opposite_halfedge(list[k]);
    fans[3 * to] = label[k];
    fans[3 * to + 1] = halfedge_from(triangles, own);
    fans[3 * to + 2] = halfedge_to(triangles, own);
  }
}

kernel void fan_place(int n, global const int* restrict cell_triangles, global const int* restrict fans,
                      global int* restrict triangles) {
  const int k = get_global_id(0);
  if (k < n) {
    const int t = cell_triangles[k];
    triangles[3 * t] = fans[3 * k];
    triangles[3 * t + 1] = fans[3 * k + 1];
    triangles[3 * t + 2] = fans[3 * k + 2];
  }
}
