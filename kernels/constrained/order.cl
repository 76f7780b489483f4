// The order of rows after constraints were inserted. A triangle belongs to its middle vertex along x, as the one right
// above it or right below it (blocks/mesh.cl), and so does exactly one triangle of any other triangulation. A new
// triangle takes the row of the Delaunay triangle that is in its place there.
//
// The host packs the numbers of changed rows. note_rows, over these: notes the row of each place. take_rows copies each
// row, from its smallest corner on, and notes where it goes and where its neighbours refer to it. put_rows: writes the
// copies to their places. write_row_halfedges and write_constrained, over all rows.

#include "arithmetic/language.h"
#include "constrained/segment_walks.h"
#include "mesh/halfedges.h"
#include "operations/prefetch.h"
#include "predicates/planar.h"

// The corner of a row with the smallest vertex.
static inline int first_corner(int row, global const int* triangles) {
  const int a = triangles[3 * row], b = triangles[3 * row + 1], c = triangles[3 * row + 2];
  return 3 * row + (b < a && b < c ? 1 : c < a && c < b ? 2 : 0);
}

// Twice the middle vertex of a triangle, and 1 more if the triangle lies above it: the next corner is behind it then.
static inline int place_of_row(int row, global const int* triangles, global const coordinate* points) {
  const int a = triangles[3 * row], b = triangles[3 * row + 1], c = triangles[3 * row + 2];
  const coordinate2 at_a = vload2(a, points), at_b = vload2(b, points), at_c = vload2(c, points);
  const int a_first = comes_before(at_a, at_b), b_first = comes_before(at_b, at_c), c_first = comes_before(at_c, at_a);
  return c_first == a_first ? 2 * a + a_first : a_first == b_first ? 2 * b + b_first : 2 * c + c_first;
}

// triangles: the Delaunay triangles.
kernel void note_rows(int n, global const int* restrict rows, global const int* restrict triangles,
                      global const coordinate* restrict points, global int* restrict row_at) {
  const int i = get_global_id(0);
  if (i < n) row_at[place_of_row(rows[i], triangles, points)] = rows[i];
}

// The neighbours of a copied row: a changed row; with this bit, the corner of an unchanged row that must refer
// to the copied one; or all bits beyond the hull.
#define UNCHANGED 0x80000000u
#define OUTSIDE 0xffffffffu

// Rows ahead whose neighbours are fetched.
#define NEIGHBORS_AHEAD 8

// rows: ascending. places: per changed row where its contents go.
kernel void take_rows(int n, global const int* restrict rows, global const int* restrict row_at,
                      global const coordinate* restrict points, global const int* restrict triangles,
                      global const int* restrict neighbors, global const uchar* restrict flags,
                      global const uchar* restrict changed, global int* restrict copied_triangles,
                      global uint* restrict copied_neighbors, global uchar* restrict copied_flags,
                      global uint* restrict places) {
  const int i = get_global_id(0);
  if (i < n) {
#if FETCH_AHEAD
    const int near = rows[min(n - 1, i + NEIGHBORS_AHEAD)];
    for (int k = 0; k < 3; ++k) {
      const int beyond = max(0, neighbors[3 * near + k]);
      fetch(&changed[beyond]);
      fetch(&neighbors[3 * beyond]);
    }
#endif
    const int row = rows[i];
    int corner = first_corner(row, triangles);
    const int turn = corner - 3 * row;
    for (int k = 0; k < 3; ++k) {
      const int beyond = neighbors[corner];
      copied_triangles[3 * i + k] = triangles[corner];
      copied_neighbors[3 * i + k] = beyond < 0        ? OUTSIDE
                                    : changed[beyond] ? (uint)beyond
                                                      : UNCHANGED | (uint)corner_with(beyond, row, neighbors);
      corner = next_halfedge(corner);
    }
    const uint flag = flags[row];
    copied_flags[i] = (uchar)((flag >> turn | flag << (3 - turn)) & 7u);
    places[row] = (uint)row_at[place_of_row(row, triangles, points)];
  }
}

kernel void put_rows(int n, global const int* restrict rows, global const int* restrict copied_triangles,
                     global const uint* restrict copied_neighbors, global const uchar* restrict copied_flags,
                     global const uint* restrict places, global int* restrict triangles, global int* restrict neighbors,
                     global uchar* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) {
    const int row = (int)places[rows[i]];
    for (int k = 0; k < 3; ++k) {
      const uint beyond = copied_neighbors[3 * i + k];
      triangles[3 * row + k] = copied_triangles[3 * i + k];
      if (beyond == OUTSIDE) {
        neighbors[3 * row + k] = -1;
      } else if (beyond >= UNCHANGED) {
        const int corner = (int)(beyond - UNCHANGED);
        neighbors[3 * row + k] = corner / 3;
        neighbors[corner] = row;
      } else {
        neighbors[3 * row + k] = (int)places[beyond];
      }
    }
    flags[row] = copied_flags[i];
  }
}

// n triangles.
kernel void write_row_halfedges(int n, global const int* restrict neighbors, global int* restrict halfedges) {
  const int t = get_global_id(0);
  if (t < n) {
    for (int k = 0; k < 3; ++k) {
      const int beyond = neighbors[3 * t + k];
      halfedges[3 * t + next_corner(k)] = beyond < 0 ? -1 : next_halfedge(corner_with(beyond, t, neighbors));
    }
  }
}

// n triangles. constrained: a byte per corner, whether the edge opposite is a constraint.
kernel void write_constrained(int n, global const uchar* restrict flags, global uchar* restrict constrained) {
  const int t = get_global_id(0);
  if (t < n) {
    for (int k = 0; k < 3; ++k) constrained[3 * t + k] = flags[t] >> k & 1;
  }
}
