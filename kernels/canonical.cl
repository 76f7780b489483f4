// The canonical result: where an empty circle passes through more than three points, their polygon becomes a fan
// from its lexicographically smallest vertex, which is the one with the smallest id.
//
// cocircular_flags tests every interior edge, circle_exact_list those left undecided (a packed list). If there are
// cocircular edges: cell_flags marks the half-edges around their cells, cell_links makes each cell's border a
// cycle, jump_labels brings each cycle's smallest id to all of it by pointer jumping (log2 of the longest cycle passes),
// fan_flags and fan_write replace the cells' triangles. One pass each, a work-item a half-edge.

#include "shared/halfedges.h"
#include "shared/planar.h"

// flags[h], for the smaller half-edge of each interior edge: 1 cocircular, 0 not, 2 undecided; 0 for all others.
// broken[0] gets bit 4 if an edge is not Delaunay.
kernel void cocircular_flags(int n, double bound, global const int* restrict triangles,
                             global const int* restrict twins, global const double2* restrict points,
                             global uchar* restrict flags, global volatile int* restrict broken) {
  const int h = get_global_id(0);
  if (h < n) {
    const int twin = twins[h];
    int flag = 0;
    if (twin > h) {
      const int sign = circle_filtered(points[triangles[h]], points[halfedge_from(triangles, h)],
                                       points[halfedge_to(triangles, h)], points[triangles[twin]], bound);
      flag = sign == UNDECIDED ? 2 : sign == 0;
      if (sign == 1) atomic_or(broken, 4);
    }
    flags[h] = flag;
  }
}

kernel void cocircular_exact(global const uint* restrict count, global const int* restrict list,
                             global const int* restrict triangles, global const int* restrict twins,
                             global const double2* restrict points, global uchar* restrict flags,
                             global volatile int* restrict broken) {
  const int length = count[0];
  for (int k = get_global_id(0); k < length; k += get_global_size(0)) {
    const int h = list[k];
    const int sign = circle_exact(points[triangles[h]], points[halfedge_from(triangles, h)],
                                  points[halfedge_to(triangles, h)], points[triangles[twins[h]]]);
    flags[h] = sign == 0;
    if (sign > 0) atomic_or(broken, 4);
  }
}

// Both half-edges of the edges listed.
kernel void dissolve_twins(int n, global const int* restrict list, global const int* restrict twins,
                           global uchar* restrict flags) {
  const int k = get_global_id(0);
  if (k < n) flags[twins[list[k]]] = 1;
}

// in_cell[t]: triangle t has a dissolved edge. border[h]: h remains and its triangle is in a cell.
kernel void cell_flags(int n, global const uchar* restrict dissolved, global uchar* restrict in_cell,
                       global uchar* restrict border) {
  const int t = get_global_id(0);
  if (t < n) {
    const int d0 = dissolved[3 * t], d1 = dissolved[3 * t + 1], d2 = dissolved[3 * t + 2];
    const int in = d0 | d1 | d2;
    in_cell[t] = in;
    border[3 * t] = in & !d0;
    border[3 * t + 1] = in & !d1;
    border[3 * t + 2] = in & !d2;
  }
}

// place[h]: where half-edge h stands in the list of border half-edges.
kernel void cell_places(int n, global const int* restrict list, global int* restrict place) {
  const int k = get_global_id(0);
  if (k < n) place[list[k]] = k;
}

// The next border half-edge of the same cell, and the id at its own begin as first label.
kernel void cell_links(int n, global const int* restrict list, global const int* restrict place,
                       global const int* restrict triangles, global const int* restrict twins,
                       global const uchar* restrict dissolved, global int* restrict next,
                       global int* restrict label) {
  const int k = get_global_id(0);
  if (k < n) {
    int h = next_halfedge(list[k]);
    while (dissolved[h]) h = next_halfedge(twins[h]);
    next[k] = place[h];
    label[k] = halfedge_from(triangles, list[k]);
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
  if (k < n)
    counts[k] = halfedge_from(triangles, list[k]) != label[k] && halfedge_to(triangles, list[k]) != label[k];
}

// The new triangles, to be put in the places of the cells' old ones.
kernel void fan_write(int n, global const int* restrict list, global const int* restrict triangles,
                      global const int* restrict label, global const uint* restrict scanned,
                      global int* restrict fans) {
  const int k = get_global_id(0);
  if (k < n && scanned[k + 1] != scanned[k]) {
    const int to = scanned[k];
    fans[3 * to] = label[k];
    fans[3 * to + 1] = halfedge_from(triangles, list[k]);
    fans[3 * to + 2] = halfedge_to(triangles, list[k]);
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
