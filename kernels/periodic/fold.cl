// Triangles in the plane of points and their images, turned into those of a torus or a cylinder. Segments: sets, as
// unroll.cl has them.
//
// fold_representatives, over points: which are the same, and how many triangles are missing for that or at ends.
// keep_triangles, over triangles: of all images of a triangle, the one is kept whose smallest corner is in its place.
// The host scans this to ranks. find_seams, over triangles: which kept ones have an edge that is a seam. list_seams,
// over these: their edges, of which the host finds out which belong together. link_seams, over seams: the triangles
// beyond. write_folded, over triangles: those that are kept.

#include "mesh/halfedges.h"
#include "operations/search.h"
#include "periodic/records.h"
#include "periodic/torus.h"

#ifndef FIXED_POINT

// What is at a place of the plane. Places below `own` are those of the points with these numbers.
static inline uint image_at(int v, int own, global const uint* images) {
  return v < own ? image_of(v, 0, 0) : images[v];
}

// The corner of the smallest image.
static inline int first_corner(const uint* image) {
  const int first = image[1] < image[0] ? 1 : 0;
  return image[2] < image[first] ? 2 : first;
}

// n points, with arguments as of unroll.cl. planar: representatives in the plane. missing: per set, of two triangles a
// point.
kernel void fold_representatives(int n, int sets, global const int* restrict offsets,
                                 global const unrolled_set* restrict all, global const uint* restrict counts,
                                 global const double* restrict coordinates, global const int* restrict planar,
                                 global int* restrict representatives, global volatile uint* restrict missing) {
  const int i = get_global_id(0);
  if (i < n) {
    const int k = segment_of(i, sets, offsets);
    const unrolled_set set = all[k];
    const int at = i + (int)counts[offsets[k]];
    const int back = at - planar[at], point = set.first + i - offsets[k];
    representatives[point] = point - back;
    uint fewer = 2;
    if (back == 0) {
      const double2 p = vload2(at, coordinates);
      fewer = (uint)(ends_at(p.x, &set.box, 0) + ends_at(p.y, &set.box, 1));
    }
    if (fewer > 0) atomic_add(&missing[k], fewer);
  }
}

// n triangles.
kernel void keep_triangles(int n, int own, global const int* restrict triangles, global const uint* restrict images,
                           global uint* restrict kept) {
  const int t = get_global_id(0);
  if (t < n) {
    const int a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
    if (max(max(a, b), c) < own) {
      kept[t] = 1;
    } else {
      const uint image[3] = {image_at(a, own, images), image_at(b, own, images), image_at(c, own, images)};
      kept[t] = (uint)is_in_place(image[first_corner(image)]);
    }
  }
}

// ranks: how many triangles before each one are kept.
static inline int is_kept(int t, global const uint* ranks) { return ranks[t + 1] != ranks[t]; }
static inline int is_seam(int beyond, global const uint* ranks) { return beyond < 0 || !is_kept(beyond, ranks); }

kernel void find_seams(int n, global const int* restrict neighbors, global const uint* restrict ranks,
                       global uchar* restrict flags) {
  const int t = get_global_id(0);
  if (t < n) {
    flags[t] = is_kept(t, ranks) && (is_seam(neighbors[3 * t], ranks) || is_seam(neighbors[3 * t + 1], ranks) ||
                                     is_seam(neighbors[3 * t + 2], ranks));
  }
}

// n of the triangles. seams: 3 for each.
kernel void list_seams(int n, int own, global const int* restrict list, global const int* restrict triangles,
                       global const int* restrict neighbors, global const uint* restrict ranks,
                       global const uint* restrict images, global const double* restrict coordinates,
                       global seam_record* restrict seams) {
  const int i = get_global_id(0);
  if (i < n) {
    for (int k = 0; k < 3; ++k) {
      seam_record seam;
      const int at = 3 * list[i] + k, beyond = neighbors[at];
      const int from = triangles[next_halfedge(at)], to = triangles[next_halfedge(next_halfedge(at))];
      const double2 a = vload2(from, coordinates), b = vload2(to, coordinates);
      seam.at = is_seam(beyond, ranks) ? at : NO_SEAM;
      seam.unused = 0;
      seam.own = image_at(triangles[at], own, images);
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

// n pairs: a corner, and the triangle opposite to it.
kernel void link_seams(int n, global const int2* restrict links, global int* restrict neighbors) {
  const int i = get_global_id(0);
  if (i < n) neighbors[links[i].x] = links[i].y;
}

// n triangles in the plane, of sets from offsets on. shifts: from ranks to rows, or NOT_WRITTEN. periods: 6 per row, x
// and y per corner, relative to the first one.
kernel void write_folded(int n, int sets, global const int* restrict offsets, global const int* restrict shifts,
                         int own, global const int* restrict triangles, global const int* restrict neighbors,
                         global const uint* restrict ranks, global const uint* restrict images,
                         global int* restrict folded, global uchar* restrict periods,
                         global int* restrict folded_neighbors) {
  const int t = get_global_id(0);
  if (t < n && is_kept(t, ranks)) {
    const int shift = shifts[segment_of(t, sets, offsets)];
    if (shift == NOT_WRITTEN) return;
    const int row = (int)ranks[t] + shift;
    const int corner[3] = {triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]};
    // Of points alone, the first one is the smallest.
    const int is_inside = max(max(corner[0], corner[1]), corner[2]) < own;
    uint image[3] = {0, 0, 0};
    for (int k = 0; k < 3 && !is_inside; ++k) image[k] = image_at(corner[k], own, images);
    int from = is_inside ? 0 : first_corner(image);
    for (int k = 0; k < 3; ++k) {
      const int beyond = neighbors[3 * t + from];
      folded[3 * row + k] = is_inside ? corner[k] : point_of(image[from]);
      folded_neighbors[3 * row + k] = beyond < 0 ? -1 : (int)ranks[beyond] + shift;
      // The first one is in its place.
      periods[6 * (int64)row + 2 * k] = is_inside ? 0 : (uchar)periods_across(image[from]);
      periods[6 * (int64)row + 2 * k + 1] = is_inside ? 0 : (uchar)periods_up(image[from]);
      from = next_corner(from);
    }
  }
}

#endif
