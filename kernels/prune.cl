// Prune: from all points of every region of a level, those that can be on its hull.
//
// extreme_* find the ends of each region's hull among its border vertices (passes of a segmented arg-reduce).
// candidate_flags takes from each bucket of consecutive internal points, sorted along the cut line, the one
// nearest to the line: one pass, a work-item a bucket. Quickhull makes those into a chord path; thin_regions and
// thin_offsets let many candidates be pruned as a level of their own first. path_bands bounds how high above the line
// a point can be and matter; prune_points and prune_corners then hold every internal point and corner against that bound
// and the path's chord over it: one pass, a binary search for each bucket or corner at most. What floating point cannot
// decide gets flag 2 and goes to hull_depth_exact (quickhull.cl). begin_paths and gather_points hand what is kept to
// quickhull, brought together by region.

#include "shared/hull_height.h"
#include "shared/search.h"
#include "shared/segmented_arg_reduce.h"

#define BUCKET 16

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

#define FLAG_END 3

// A point against the path's chord over it. flag: 1 keep, 0 drop, 2 undecided, FLAG_END on the hull as its end. keep_on also keeps what lies on the path
// and, of the column of the path's last vertex, all. low: the last vertex with u no greater than p's.
static inline int held_against(int id, double2 p, int low, int first, int last, int planar, double q, int keep_on,
                               double bound, global const int* restrict path,
                               global const double2* restrict path_places) {
  const double2 v = path_places[low];
  if (v.y == p.y) {
    // The path's ends are known to be on the hull, and need no finding.
    if (id == path[low]) return keep_on || (low != first && low != last) ? 1 : FLAG_END;
    return keep_on ? low == last : is_lower(p, v, q, planar);
  }
  const double2 d = hull_depth(v, path_places[low + 1], p, q, planar);
  const double error = bound * d.y;
  return d.x > error ? 1 : d.x < -error ? 0 : bound == 0.0 ? (keep_on && d.x == 0.0) : 2;
}

// band[r]: a height, as the bits of a float, above which nothing can be below any chord of region r's path: a chord of
// length l between heights h and k stays below max(h, k) + l^2 / 4. Rounded up, and by more than depth's error; infinite
// where a float cannot hold it, and for planar hulls, whose heights have no zero. band holds 0 before.
#define BAND_SLACK (1.0 + 0x1p-20)

kernel void path_bands(int n, global const int* restrict path_region, global const double2* restrict path_places,
                       global const int* restrict axis, global const double* restrict cut,
                       global volatile int* restrict band) {
  const int v = get_global_id(0);
  if (v < n - 1) {
    const int r = path_region[v];
    if (path_region[v + 1] == r) {
      const double2 a = path_places[v];
      const double2 b = path_places[v + 1];
      const double across = fmax(fabs(a.x - cut[r]), fabs(b.x - cut[r]));
      const double along = b.y - a.y;
      const double height = is_planar(axis[r]) ? INFINITY : BAND_SLACK * (across * across + 0.25 * along * along);
      // No subnormal floats, which devices may flush to zero.
      atomic_max(&band[r], as_int(convert_float_rtp(fmax(height, 0x1p-120))));
    }
  }
}

static inline int is_above_band(double s, double q, int band) { return (s - q) * (s - q) > (double)as_float(band); }

// Internal points, by buckets: their neighbours in the list are their neighbours along the line, so only the first of a
// region's in a bucket needs a search. ids and chord are written for the undecided alone.
kernel void prune_points(int n, int elements, int keep_on, double bound, global const int* restrict regions,
                         global const int* restrict x_list, global const int* restrict y_list,
                         global const int* restrict axis, global const double* restrict cut,
                         global const double2* restrict points, global const int* restrict band,
                         global const int* restrict path_offsets, global const int* restrict path,
                         global const double2* restrict path_places, global int* restrict ids,
                         global int* restrict chord, global uchar* restrict flags) {
  const int bucket = get_global_id(0);
  if (bucket < n) {
    int region = -1, a = 0, first = 0, last = 0, low = -1, height = 0;
    double q = 0.0;
    for (int i = bucket * BUCKET; i < min(elements, (bucket + 1) * BUCKET); ++i) {
      const int r = regions[i];
      if (r != region) {
        region = r;
        a = axis[r];
        q = cut[r];
        height = band[r];
        low = -1;
        first = path_offsets[r];
        last = path_offsets[r + 1] - 1;
      }
      const int id = a == AXIS_Y ? x_list[i] : y_list[i];
      const double2 p = to_frame(points[id], a);
      if (is_above_band(p.x, q, height)) {
        flags[i] = 0;
        continue;
      }
      if (low < 0) {
        low = search_path(p.y, first, last, path_places);
      } else {
        while (low < last && path_places[low + 1].y <= p.y) ++low;
        while (low > first && path_places[low].y > p.y) --low;
      }
      const int keep = held_against(id, p, low, first, last, is_planar(a), q, keep_on, bound, path, path_places);
      flags[i] = keep;
      if (keep == 2) {
        ids[i] = id;
        chord[i] = low;
      }
    }
  }
}

// Corners' vertices: element points_count + i is corner i.
kernel void prune_corners(int n, int points_count, double bound, global const int* restrict corner_regions,
                          global const int* restrict corners, global const int* restrict axis,
                          global const double* restrict cut, global const double2* restrict points,
                          global const int* restrict band, global const int* restrict path_offsets,
                          global const int* restrict path,
                          global const double2* restrict path_places, global int* restrict ids,
                          global int* restrict chord, global uchar* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) {
    const int r = corner_regions[i];
    const int a = axis[r];
    const int id = corners[3 * i + 1];
    const double2 p = to_frame(points[id], a);
    int low = 0;
    int keep = 0;
    if (!is_above_band(p.x, cut[r], band[r])) {
      const int first = path_offsets[r];
      const int last = path_offsets[r + 1] - 1;
      low = search_path(p.y, first, last, path_places);
      keep = held_against(id, p, low, first, last, is_planar(a), cut[r], 0, bound, path, path_places);
    }
    flags[points_count + i] = keep;
    if (keep == 2) {
      ids[points_count + i] = id;
      chord[points_count + i] = low;
    }
  }
}

// Flags of 1 as counts for a scan.
kernel void flag_counts(int n, global const uchar* restrict flags, global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) counts[i] = flags[i] == 1;
}

// How many of the ascending positions are below i.
static inline int positions_below(int i, int kept, global const int* restrict positions) {
  int low = 0, high = kept;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (positions[middle] < i) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

// The first paths of quickhull: each region's two ends, the kept points being below the chord between them. Their
// positions among all elements are given. before[r]: kept internal points and kept corners of the regions before r;
// internal points come first in each region. first: where the points below each path vertex's chord begin.
kernel void begin_paths(int n, int points_count, int kept, global const int* restrict positions,
                        global const int* restrict point_offsets, global const int* restrict corner_offsets,
                        global const int* restrict first_end, global const int* restrict last_end,
                        global const int* restrict axis, global const double2* restrict points,
                        global int* restrict path, global double2* restrict path_places,
                        global int* restrict path_region, global int* restrict first, global int2* restrict before) {
  const int r = get_global_id(0);
  if (r <= n) {
    const int point_count = positions_below(point_offsets[r], kept, positions);
    const int all_points = positions_below(points_count, kept, positions);
    // Without kept corners there is nothing to look for.
    const int corner_count =
        all_points == kept ? 0 : positions_below(points_count + corner_offsets[r], kept, positions) - all_points;
    before[r] = (int2)(point_count, corner_count);
    first[2 * r] = point_count + corner_count;
    if (r > 0) first[2 * r - 1] = point_count + corner_count;
    if (r < n) {
      const int a = first_end[r];
      const int b = last_end[r];
      path[2 * r] = a;
      path[2 * r + 1] = b;
      // Sets without points have no ends.
      path_places[2 * r] = a < 0 ? (double2)(0.0) : to_frame(points[a], axis[r]);
      path_places[2 * r + 1] = b < 0 ? (double2)(0.0) : to_frame(points[b], axis[r]);
      path_region[2 * r] = path_region[2 * r + 1] = r;
    }
  }
}

// The kept elements as quickhull's points.
kernel void gather_points(int n, int points_count, int regions_count, global const int* restrict positions,
                          global const int2* restrict before, global const int* restrict regions,
                          global const int* restrict x_list, global const int* restrict y_list,
                          global const int* restrict corner_regions, global const int* restrict corners,
                          global const int* restrict axis, global const double2* restrict points,
                          global int* restrict ids, global int* restrict segment, global double2* restrict places) {
  const int k = get_global_id(0);
  if (k < n) {
    const int i = positions[k];
    int r, id, to;
    if (i < points_count) {
      r = regions[i];
      id = axis[r] == AXIS_Y ? x_list[i] : y_list[i];
      to = k + before[r].y;
    } else {
      r = corner_regions[i - points_count];
      id = corners[3 * (i - points_count) + 1];
      to = k - before[regions_count].x + before[r + 1].x;
    }
    ids[to] = id;
    segment[to] = 2 * r;
    places[to] = to_frame(points[id], axis[r]);
  }
}

// The candidates as a level's lists of their own: their regions, and where each region's begin.
kernel void thin_regions(int n, global const int* restrict segment, global int* restrict regions) {
  const int i = get_global_id(0);
  if (i < n) regions[i] = segment[i] / 2;
}

kernel void thin_offsets(int n, global const int* restrict first, global int* restrict offsets) {
  const int r = get_global_id(0);
  if (r <= n) offsets[r] = first[2 * r];
}
