// Prune: from all points of every region of a level, those that can be on its hull.
//
// extreme_* find the ends of each region's hull among its border vertices (passes of a segmented arg-reduce).
// candidate_flags takes from each bucket of consecutive internal points, sorted along the cut line, the one
// nearest to the line: one pass, a work-item a bucket. Quickhull makes those into a chord path. prune_points then
// holds every internal point and corner against the path's chord over it: one pass, a binary search each. What
// floating point cannot decide gets flag 2 and goes to hull_depth_exact (quickhull.cl).

#include "shared/hull_height.h"
#include "shared/segmented_arg_reduce.h"

#define BUCKET 8

// Corner i stands for its vertex.
#define VERTEX_OF_CORNER(i) corners[3 * (i) + 1]

static inline int before_along(int region, int i, int j, int direction, global const int* restrict axis,
                               global const double* restrict cut, global const double2* restrict points) {
  const int a = axis[region];
  const double2 p = to_frame(points[i], a);
  const double2 v = to_frame(points[j], a);
  if (p.y != v.y) return direction > 0 ? p.y < v.y : p.y > v.y;
  return i != j && is_lower(p, v, cut[region], is_planar(a));
}
#define BEFORE_ALONG(region, i, j) before_along(region, i, j, direction, axis, cut, points)

// The vertex of the smallest u (direction 1) or largest u (-1), the lowest of these if there are several.
SEGMENTED_ARG_REDUCE(extreme_vertices, VERTEX_OF_CORNER, BEFORE_ALONG, int direction,
                     global const int* restrict corners, global const int* restrict axis,
                     global const double* restrict cut, global const double2* restrict points)

kernel void candidate_flags(int n, int elements, global const int* restrict regions,
                            global const int* restrict x_list, global const int* restrict y_list,
                            global const int* restrict axis, global const double* restrict cut,
                            global const double2* restrict points, global uchar* restrict flags) {
  const int bucket = get_global_id(0);
  if (bucket < n) {
    const int low = bucket * BUCKET;
    const int high = min(elements, low + BUCKET);
    int best = low;
    double best_distance = 0.0;
    for (int i = low; i < high; ++i) {
      const int r = regions[i];
      const int a = axis[r];
      const double s = to_frame(points[a == AXIS_Y ? x_list[i] : y_list[i]], a).x;
      const double distance = is_planar(a) ? s : fabs(s - cut[r]);
      flags[i] = 0;
      if (i == low || r != regions[i - 1]) {
        if (i > low) flags[best] = 1;
        best = i;
        best_distance = distance;
      } else if (distance < best_distance) {
        best = i;
        best_distance = distance;
      }
    }
    flags[best] = 1;
  }
}

// Elements 0..points_count-1 are the internal points, the others the corners' vertices. flags: 1 keep, 0 drop, 2
// undecided. keep_on also keeps what lies on the path and, of the column of the path's last vertex, all.
kernel void prune_points(int n, int points_count, int keep_on, double bound, global const int* restrict regions,
                         global const int* restrict x_list, global const int* restrict y_list,
                         global const int* restrict corner_regions, global const int* restrict corners,
                         global const int* restrict axis, global const double* restrict cut,
                         global const double2* restrict points, global const int* restrict path_offsets,
                         global const int* restrict path, global const double* restrict path_u,
                         global int* restrict ids, global int* restrict chord, global uchar* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) {
    int r, id;
    if (i < points_count) {
      r = regions[i];
      id = axis[r] == AXIS_Y ? x_list[i] : y_list[i];
    } else {
      r = corner_regions[i - points_count];
      id = corners[3 * (i - points_count) + 1];
    }
    const int a = axis[r];
    const double2 p = to_frame(points[id], a);
    const int first = path_offsets[r];
    const int last = path_offsets[r + 1] - 1;
    // The last vertex with u no greater than p's.
    int low = first, high = last + 1;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      if (path_u[middle] <= p.y) {
        low = middle;
      } else {
        high = middle;
      }
    }
    const int v = path[low];
    int keep;
    if (id == v) {
      keep = 1;
    } else if (path_u[low] == p.y) {
      keep = keep_on ? low == last : is_lower(p, to_frame(points[v], a), cut[r], is_planar(a));
    } else {
      const double2 d = hull_depth(to_frame(points[v], a), to_frame(points[path[low + 1]], a), p, cut[r], is_planar(a));
      const double error = bound * d.y;
      keep = d.x > error ? 1 : d.x < -error ? 0 : bound == 0.0 ? (keep_on && d.x == 0.0) : 2;
    }
    ids[i] = id;
    chord[i] = low;
    flags[i] = keep;
  }
}

// Flags of 1 as counts for a scan.
kernel void flag_counts(int n, global const uchar* restrict flags, global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) counts[i] = flags[i] == 1;
}

// The flagged elements as quickhull's points: ids, and to begin with one segment a region. Without corners (the
// candidates) n is points_count. Internal points come first in each region, then border vertices.
kernel void gather_points(int n, int points_count, global const uint* restrict scanned,
                          global const int* restrict regions, global const int* restrict x_list,
                          global const int* restrict y_list, global const int* restrict corner_regions,
                          global const int* restrict corners, global const int* restrict point_offsets,
                          global const int* restrict corner_offsets, global const int* restrict axis,
                          global int* restrict ids, global int* restrict segment) {
  const int i = get_global_id(0);
  if (i < n && scanned[i + 1] != scanned[i]) {
    int r, id, to;
    if (i < points_count) {
      r = regions[i];
      id = axis[r] == AXIS_Y ? x_list[i] : y_list[i];
      to = scanned[i];
      if (n > points_count) to += scanned[points_count + corner_offsets[r]] - scanned[points_count];
    } else {
      r = corner_regions[i - points_count];
      id = corners[3 * (i - points_count) + 1];
      to = scanned[i] - scanned[points_count] + scanned[point_offsets[r + 1]];
    }
    ids[to] = id;
    segment[to] = r;
  }
}

// The first segments: one a region, from end to end, with the gathered points.
kernel void begin_segments(int n, int points_count, int elements, global const uint* restrict scanned,
                           global const int* restrict point_offsets, global const int* restrict corner_offsets,
                           global const int* restrict first_end, global const int* restrict last_end,
                           global int* restrict chord_a, global int* restrict chord_b,
                           global int* restrict chord_region, global int* restrict first) {
  const int r = get_global_id(0);
  if (r < n) {
    chord_a[r] = first_end[r];
    chord_b[r] = last_end[r];
    chord_region[r] = r;
    int before = scanned[point_offsets[r]];
    if (elements > points_count) before += scanned[points_count + corner_offsets[r]] - scanned[points_count];
    first[r] = before;
    if (r == n - 1) first[n] = scanned[elements];
  }
}
