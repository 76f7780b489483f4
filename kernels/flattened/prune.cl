// Prune: of all points of every region of a level, keeps those that can be on its hull.
//
// 1. candidate_flags takes from each bucket of consecutive projected points, which are sorted along the cut line, the
//    one nearest to the line: one pass, with one work-item per bucket. Quickhull makes a path of chords from these
//    candidates. If there are many, thin_regions and thin_offsets make them a level of their own, to be pruned first.
// 2. chord_bands computes for each chord the height above which no point can be below it.
// 3. prune_points and prune_corners hold every internal point and corner against that height and then against
//    the chord: one pass each, with a binary search per bucket or corner. Elements that floating point cannot
//    decide get FLAG_UNDECIDED and go to hull_depth.cl.
//
// Quickhull then continues from that path: chord_keys, a sort, gather_below and chord_begins bring the kept points
// together by their chords. Or it begins with the ends of the hull alone: begin_paths and gather_points bring flagged
// elements together by region.

#include "flattened/arguments.h"
#include "flattened/codes.h"
#include "flattened/hull_height.h"
#include "flattened/limits.h"
#include "operations/counters.h"
#include "operations/search.h"

kernel void candidate_flags(int n, int elements, global const int* restrict regions,
                            global const double2* restrict projections, global uchar* restrict flags COUNTERS) {
  const int bucket = get_global_id(0);
  if (bucket < n) {
    const int low = bucket * BUCKET;
    const int high = min(elements, low + BUCKET);
    COUNT(HULL, ARITHMETIC, high - low);
    int best = low;
    for (int i = low; i < high; ++i) {
      flags[i] = 0;
      if (i > low && regions[i] != regions[i - 1]) {
        flags[best] = 1;
        best = i;
      } else if (projections[i].x < projections[best].x) {
        best = i;
      }
    }
    flags[best] = 1;
  }
}

// Holds a point that is not above its chord's band against that chord. Returns a flag: 1 to keep the point, 0 to drop
// it, FLAG_UNDECIDED, or FLAG_ON_PATH for a vertex of the path. keep_on: also keep the points on the path and all
// points of the column of the path's last vertex. low: the last vertex with u no greater than p's; it becomes the
// vertex whose chord p is below. depth: the rounded depth of a point that may be kept. It is infinite for a point that
// is lower than the path's vertex of the same u, so that the first round takes it: a mirror image of that vertex in the
// cut line is not strictly below any later chord from there.
static inline int held_against(int id, double2 p, int* low, int last, int axis, double q, int keep_on,
                               filter_bound bound, global const double2* restrict points,
                               global const int* restrict path, global const double2* restrict path_projections,
                               double* depth COUNTERS) {
  const int planar = is_planar(axis);
  COUNT(HULL, ARITHMETIC, 1);
  if (path_projections[*low].y == p.y) {
    if (id == path[*low]) return keep_on ? 1 : FLAG_ON_PATH;
    if (keep_on) return *low == last;
    COUNT(HULL, ARITHMETIC, LOWER_OPERATIONS);
    if (!is_lower(to_frame(points[id], axis), to_frame(points[path[*low]], axis), q, planar)) return 0;
    *low = min(*low, last - 1);
    *depth = INFINITY;
    return 1;
  }
  const double2 d = hull_depth(path_projections[*low], path_projections[*low + 1], p, planar);
  *depth = d.x;
  const double error = bound * d.y;
  return d.x > error ? 1 : d.x < -error ? 0 : bound == 0.0 ? (keep_on && d.x == 0.0) : FLAG_UNDECIDED;
}

// band[v]: a height above which nothing can be below the chord from path vertex v to the next. Behind a path's last
// vertex there is no chord, and nothing is above it.
kernel void chord_bands(int n, int regions, PATHS(), global const int* restrict path_region,
                        global const int* restrict axis, global double* restrict band COUNTERS) {
  const int v = get_global_id(0);
  const int vertices = path_offsets[regions];
  if (v < vertices) {
    const int r = path_region[v];
    double height = INFINITY;
    if (v + 1 < vertices && path_region[v + 1] == r) {
      COUNT(HULL, ARITHMETIC, BAND_OPERATIONS);
      height = chord_band(path_projections[v], path_projections[v + 1], is_planar(axis[r]));
    }
    band[v] = height;
  }
}

// Internal points, by buckets. The points of one region in a bucket are neighbours along the line, often under one
// chord: so the chord of the first of them in u is searched, and the last is tested for the same chord. For each point
// that is not dropped, chord is the path vertex whose chord it is held against, and depth is its depth below that
// chord, without keep_on. ids is written for undecided points only. rough: keeps undecided points, and writes nothing
// but flags.
kernel void prune_points(int n, int elements, int keep_on, int rough, filter_bound bound,
                         global const int* restrict regions, LISTS(), global const double2* restrict projections,
                         CUTS(), global const double* restrict band, PATHS(), CANDIDATES() COUNTERS) {
  const int bucket = get_global_id(0);
  if (bucket < n) {
    const int end = min(elements, (bucket + 1) * BUCKET);
    for (int begin = bucket * BUCKET; begin < end;) {
      const int r = regions[begin];
      const int first = path_offsets[r];
      const int last = path_offsets[r + 1] - 1;
      const int a = axis[r];
      int run = begin + 1;
      while (run < end && regions[run] == r) ++run;
      const double u_begin = projections[begin].y;
      const double u_end = projections[run - 1].y;
      int low = search_path(fmin(u_begin, u_end), first, last, path_projections);
      const int one_chord = low == last || path_projections[low + 1].y > fmax(u_begin, u_end);
      COUNT(HULL, ARITHMETIC, 2 + search_comparisons(last - first + 1));
      for (int i = begin; i < run; ++i) {
        const double2 p = projections[i];
        int above = low;
        if (!one_chord) {
          while (above < last && path_projections[above + 1].y <= p.y) ++above;
          while (above > first && path_projections[above].y > p.y) --above;
        }
        COUNT(HULL, ARITHMETIC, (one_chord ? 1 : 3) + abs(above - low));
        low = above;
        if (p.x > band[low]) {
          flags[i] = 0;
          continue;
        }
        const int id = a == AXIS_Y ? x_list[i] : y_list[i];
        double below = 0.0;
        int keep = held_against(id, p, &above, last, a, cut[r], keep_on, bound, points, path, path_projections,
                                &below WITH_COUNTERS);
        if (rough && keep == FLAG_UNDECIDED) keep = 1;
        flags[i] = keep;
        if (rough) continue;
        if (keep == 1 || keep == FLAG_UNDECIDED) {
          chord[i] = above;
          if (!keep_on) depth[i] = below;
        }
        if (keep == FLAG_UNDECIDED) ids[i] = id;
      }
      begin = run;
    }
  }
}

// Corners' vertices: element points_count + i is corner i. rough: as in prune_points.
kernel void prune_corners(int n, int points_count, int rough, filter_bound bound,
                          global const int* restrict corner_regions, global const int* restrict corners, CUTS(),
                          global const double* restrict band, PATHS(), CANDIDATES() COUNTERS) {
  const int i = get_global_id(0);
  if (i < n) {
    const int r = corner_regions[i];
    const int a = axis[r];
    const int id = corners[3 * i + 1];
    const double2 p = project(to_frame(points[id], a), cut[r], is_planar(a));
    const int first = path_offsets[r];
    const int last = path_offsets[r + 1] - 1;
    int low = search_path(p.y, first, last, path_projections);
    double below = 0.0;
    COUNT(HULL, ARITHMETIC, search_comparisons(last - first + 1) + 1);
    int keep = p.x > band[low] ? 0
                               : held_against(id, p, &low, last, a, cut[r], 0, bound, points, path, path_projections,
                                              &below WITH_COUNTERS);
    if (rough && keep == FLAG_UNDECIDED) keep = 1;
    flags[points_count + i] = keep;
    if (rough) return;
    if (keep == 1 || keep == FLAG_UNDECIDED) {
      chord[points_count + i] = low;
      depth[points_count + i] = below;
    }
    if (keep == FLAG_UNDECIDED) ids[points_count + i] = id;
  }
}

// The first paths of quickhull: each region's two ends. The kept points are below the chord between them. positions: of
// the kept elements among all. before[r]: the numbers of kept internal points and of kept corners of the regions before
// r; internal points come first in each region. first: where the points below each path vertex's chord begin.
kernel void begin_paths(int n, int points_count, int kept, global const int* restrict positions,
                        global const int* restrict point_offsets, global const int* restrict corner_offsets,
                        global const int* restrict first_end, global const int* restrict last_end, CUTS(),
                        NEW_PATH_VERTICES(), global int* restrict first, global int2* restrict before COUNTERS) {
  const int r = get_global_id(0);
  if (r <= n) {
    const int point_count = positions_below(point_offsets[r], kept, positions);
    const int all_points = positions_below(points_count, kept, positions);
    // Without kept corners there is nothing to look for.
    const int corner_count =
        all_points == kept ? 0 : positions_below(points_count + corner_offsets[r], kept, positions) - all_points;
    before[r] = VECTOR(int2, point_count, corner_count);
    first[2 * r] = point_count + corner_count;
    if (r > 0) first[2 * r - 1] = point_count + corner_count;
    if (r < n) {
      for (int side = 0; side < 2; ++side) {
        const int id = side ? last_end[r] : first_end[r];
        new_path[2 * r + side] = id;
        // Sets without points have no ends.
        new_projections[2 * r + side] =
            id < 0 ? VECTOR(double2, 0.0, 0.0) : project(to_frame(points[id], axis[r]), cut[r], is_planar(axis[r]));
        new_region[2 * r + side] = r;
      }
    }
  }
}

// The kept elements as quickhull's points.
kernel void gather_points(int n, int points_count, int regions_count, global const int* restrict positions,
                          global const int2* restrict before, global const int* restrict regions,
                          global const double2* restrict point_projections, LISTS(),
                          global const int* restrict corner_regions, global const int* restrict corners, CUTS(),
                          NEW_HULL_POINTS() COUNTERS) {
  const int k = get_global_id(0);
  if (k < n) {
    const int i = positions[k];
    int r, id, to;
    double2 p;
    if (i < points_count) {
      r = regions[i];
      p = point_projections[i];
      id = axis[r] == AXIS_Y ? x_list[i] : y_list[i];
      to = k + before[r].y;
    } else {
      r = corner_regions[i - points_count];
      id = corners[3 * (i - points_count) + 1];
      p = project(to_frame(points[id], axis[r]), cut[r], is_planar(axis[r]));
      to = k - before[regions_count].x + before[r + 1].x;
    }
    new_ids[to] = id;
    new_segment[to] = 2 * r;
    new_projections[to] = p;
  }
}

// Keys for a stable sort of the kept elements: the path vertex whose chord an element is below.
kernel void chord_keys(int n, global const int* restrict positions, global const int* restrict chord,
                       global uint64* restrict keys) {
  const int k = get_global_id(0);
  if (k < n) keys[k] = chord[positions[k]];
}

// The sorted elements as quickhull's points.
kernel void gather_below(int n, int points_count, global const uint64* restrict keys,
                         global const int* restrict elements, global const int* restrict path_region,
                         global const double* restrict element_depth, global const double2* restrict point_projections,
                         LISTS(), global const int* restrict corners, CUTS(), NEW_HULL_POINTS(),
                         global double* restrict depth COUNTERS) {
  const int k = get_global_id(0);
  if (k < n) {
    const int i = elements[k];
    const int v = keys[k];
    const int r = path_region[v];
    const int a = axis[r];
    if (i < points_count) {
      new_ids[k] = a == AXIS_Y ? x_list[i] : y_list[i];
      new_projections[k] = point_projections[i];
    } else {
      const int id = corners[3 * (i - points_count) + 1];
      new_ids[k] = id;
      new_projections[k] = project(to_frame(points[id], a), cut[r], is_planar(a));
    }
    new_segment[k] = v;
    depth[k] = element_depth[i];
  }
}

// Where the points below each vertex's chord begin, closed by the number of points.
kernel void chord_begins(int n, int kept, global const int* restrict segment, global int* restrict first) {
  const int v = get_global_id(0);
  if (v <= n) first[v] = positions_below(v, kept, segment);
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
