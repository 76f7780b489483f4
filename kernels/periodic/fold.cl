// Triangles in the plane of points and their images, turned into those of a torus or a cylinder. Segments: sets, as
// unroll.cl has them.
//
// fold_representatives, over points: which are the same, and how many triangles are missing at ends.
// keep_triangles, over triangles: of all images of a triangle, the one is kept whose smallest corner is in its place.
// The host scans this to ranks. find_seams, over triangles: which kept ones have an edge that is a seam. list_seams,
// over these: their edges, of which the host finds out which belong together. link_seams, over seams: the triangles
// beyond. write_folded, over triangles: those that are kept.

#include "mesh/halfedges.h"
#include "operations/segment_near.h"
#include "periodic/records.h"
#include "periodic/torus.h"

#ifndef FIXED_POINT

// n points, with arguments as of unroll.cl. planar: representatives in the plane. missing: per set the number of
// duplicates, and of the triangles that ends lack, two of which a point has otherwise.
kernel void fold_representatives(int n, periodic_lattice lattice, int sets, global const int* restrict offsets,
                                 global const unrolled_set* restrict all, global const uint* restrict counts,
                                 global const double* restrict coordinates, global const int* restrict planar,
                                 global int* restrict representatives, global volatile uint* restrict missing) {
  const int i = get_global_id(0);
  if (i < n) {
    const int k = segment_near(i, sets, offsets);
    const int at = i + (int)counts[offsets[k]];
    const int back = at - planar[at], point = all[k].first + i - offsets[k];
    representatives[point] = point - back;
    if (back == 0 && all[k].has_ends == 0) return;
    uint fewer = 1;
    if (back == 0) {
      const periodic_box box = all[k].box;
      const double2 p = vload2(at, coordinates);
      fewer = (uint)(ends_at(p.x, 0, &lattice, &box) + ends_at(p.y, 1, &lattice, &box));
    }
    if (fewer > 0) atomic_add(&missing[2 * k + (back == 0)], fewer);
  }
}

// n triangles.
kernel void keep_triangles(int n, int own, global const int* restrict triangles, global const uint64* restrict images,
                           global uint* restrict kept) {
  const int t = get_global_id(0);
  if (t < n) {
    const int a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
    kept[t] = max(max(a, b), c) < own ||
              is_kept(image_at(a, own, images), image_at(b, own, images), image_at(c, own, images));
  }
}

// ranks: how many triangles before each one are kept.
static inline int has_row(int t, global const uint* ranks) { return ranks[t + 1] != ranks[t]; }
static inline int is_seam(int beyond, global const uint* ranks) { return beyond < 0 || !has_row(beyond, ranks); }

kernel void find_seams(int n, global const int* restrict neighbors, global const uint* restrict ranks,
                       global uchar* restrict flags) {
  const int t = get_global_id(0);
  if (t < n) {
    flags[t] = has_row(t, ranks) && (is_seam(neighbors[3 * t], ranks) || is_seam(neighbors[3 * t + 1], ranks) ||
                                     is_seam(neighbors[3 * t + 2], ranks));
  }
}

// n of the triangles. seams: 3 for each; own is NO_IMAGE in edges between two that are kept.
kernel void list_seams(int n, int own, global const int* restrict list, global const int* restrict triangles,
                       global const int* restrict neighbors, global const uint* restrict ranks,
                       global const uint64* restrict images, global const double* restrict coordinates,
                       global seam_record* restrict seams) {
  const int i = get_global_id(0);
  if (i < n) {
    for (int k = 0; k < 3; ++k) {
      seam_record seam;
      const int at = 3 * list[i] + k, beyond = neighbors[at];
      const int from = triangles[next_halfedge(at)], to = triangles[next_halfedge(next_halfedge(at))];
      const double2 a = vload2(from, coordinates), b = vload2(to, coordinates);
      seam.at = at;
      seam.own = is_seam(beyond, ranks) ? image_at(triangles[at], own, images) : NO_IMAGE;
      seam.from = image_at(from, own, images);
      seam.to = image_at(to, own, images);
      seam.beyond = NO_IMAGE;
      for (int j = 0; beyond >= 0 && j < 3; ++j) {
        if (neighbors[3 * beyond + j] == list[i]) seam.beyond = image_at(triangles[3 * beyond + j], own, images);
      }
      seam.ends[0] = a.x;
      seam.ends[1] = a.y;
      seam.ends[2] = b.x;
      seam.ends[3] = b.y;
      seams[3 * i + k] = seam;
    }
  }
}

// n pairs: a corner, and the triangle opposite to it; or NO_SEAM.
kernel void link_seams(int n, global const int2* restrict links, global int* restrict neighbors) {
  const int i = get_global_id(0);
  if (i < n && links[i].x != NO_SEAM) neighbors[links[i].x] = links[i].y;
}

// n triangles in the plane from `first` on, of sets from offsets on. shifts: from ranks to rows, or NOT_WRITTEN. folded
// begins at a row; periods: 3 per row, x and y per corner, of vectors of the lattice, relative to the first one. One
// work-item after the other may write to the arrays that it reads, if no row is behind its triangle.
kernel void write_folded(int n, int first, int begin, int sets, global const int* restrict offsets,
                         global const int* restrict shifts, int own, global const int* triangles,
                         global const int* neighbors, global const uint* restrict ranks,
                         global const uint64* restrict images, global int* folded, global uchar2* restrict periods,
                         global int* folded_neighbors) {
  const int t = first + get_global_id(0);
  if (t < first + n && has_row(t, ranks)) {
    const int shift = shifts[segment_near(t, sets, offsets)];
    if (shift == NOT_WRITTEN) return;
    const int row = (int)ranks[t] + shift, to = row - begin;
    const int corner[3] = {triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]};
    const int beyond[3] = {neighbors[3 * t], neighbors[3 * t + 1], neighbors[3 * t + 2]};
    const int is_inside = max(max(corner[0], corner[1]), corner[2]) < own;
    for (int k = 0; k < 3; ++k) {
      folded_neighbors[3 * to + k] = beyond[k] < 0 ? -1 : (int)ranks[beyond[k]] + shift;
      if (is_inside) {
        folded[3 * to + k] = corner[k];
        periods[3 * row + k] = VECTOR(uchar2, 0, 0);
      } else {
        const uint64 image = image_at(corner[k], own, images);
        folded[3 * to + k] = (int)point_of(image);
        periods[3 * row + k] = VECTOR(uchar2, (uchar)vectors_across(image), (uchar)vectors_up(image));
      }
    }
  }
}

#endif
