// Segmented quickhull: the strict lower hulls of all regions at once, as paths in the order of u.
//
// Paths grow from the two ends of each region, or from prune's paths, whose depths are known already. Points lie in
// segments: segment v holds the points below the chord from path vertex v to the next one. Path vertices are in the
// order of (region, u), and the last vertex of a region has no points. Kernels have one work-item per point or per path
// vertex. A round is:
//
// 1. hull_depths holds each point against its chord; hull_depth.cl decides what floating point could not.
// 2. deepest_points takes the deepest point of each segment, by passes of a segmented arg-reduce. It becomes a vertex.
// 3. The segment's points go to either side of it, stably: split_counts and side_flags make counts for scans (scan.cl),
//    advance_paths and advance_points move.
//
// The deepest point is chosen by rounded depths, so it may be no vertex of the hull. When no points are left,
// path_flags (and hull_depth.cl) find the vertices on or above the segment of their neighbours, and compact_path drops
// them, until none is left. Dropping may expose one vertex per round. restart_paths and restart_segments make a
// path's vertices the points of a quickhull that begins with the ends, which needs fewer rounds.
//
// Quickhull's splits can be lopsided. A balanced round (Chan, Snoeyink and Yap 1997; with a random pair's slope in
// place of the median one, Bhattacharya and Sen 1997) pairs neighbouring points of a segment. random_pairs takes one
// pair of each segment; tilted_depths computes the points' depths above a line of that pair's slope, and
// deepest_points takes the greatest. drop_pairs then finds, in each pair on one side of it, a point that is
// above a chord, and drops that point.

#include "flattened/arguments.h"
#include "flattened/codes.h"
#include "flattened/hull_height.h"
#include "operations/counters.h"
#include "operations/segmented_arg_reduce.h"

// projections[i]: of point i, as path_projections. flags: 1 strictly below the chord, 0 not, or FLAG_UNDECIDED.
kernel void hull_depths(int n, filter_bound bound, HULL_POINTS(), PATH_VERTICES(), global const int* restrict axis,
                        global double* restrict depth, global uchar* restrict flags COUNTERS) {
  const int i = get_global_id(0);
  if (i < n) {
    const int v = segment[i];
    const double2 d =
        hull_depth(path_projections[v], path_projections[v + 1], projections[i], is_planar(axis[path_region[v]]));
    const double error = bound * d.y;
    depth[i] = d.x;
    flags[i] = d.x > error ? 1 : d.x < -error || bound == 0.0 ? 0 : FLAG_UNDECIDED;
  }
}

static inline uint64 scramble(double u) {
  // The finaliser of SplitMix64 (Steele, Lea and Flood, 2014).
  uint64 z = as_ulong(u) + 0x9e3779b97f4a7c15UL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9UL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebUL;
  return z ^ (z >> 31);
}

// Whether u value p comes before q in a random order.
static inline int comes_first(double p, double q) {
  const uint64 hp = scramble(p);
  const uint64 hq = scramble(q);
  return hp != hq ? hp < hq : p < q;
}

// Whether point i is preferred to j: the deeper one; of equal depth, at random by u, so that flat chords split evenly;
// of equal u, the one with the lower projection, so that the others of that u can be dropped.
static inline int is_deeper(int s, int i, int j, global const int* restrict ids, global const double* restrict depth,
                            global const double2* restrict projections, global const int* restrict path_region,
                            CUTS()) {
  if (depth[i] != depth[j]) return depth[i] > depth[j];
  if (projections[i].y != projections[j].y) return comes_first(projections[i].y, projections[j].y);
  if (ids[i] == ids[j]) return i < j;
  const int r = path_region[s];
  return is_lower(to_frame(points[ids[i]], axis[r]), to_frame(points[ids[j]], axis[r]), cut[r], is_planar(axis[r]));
}
#define KEPT(i) flags[i] == 1 ? i : -1
#define DEEPER(s, i, j) is_deeper(s, i, j, ids, depth, projections, path_region, axis, cut, points)
kernel void deepest_points(ARG_REDUCE_ARGUMENTS, global const uchar* restrict flags, global const int* restrict ids,
                           global const double* restrict depth, global const double2* restrict projections,
                           global const int* restrict path_region, CUTS() COUNTERS) {
  SEGMENTED_ARG_REDUCE(KEPT, DEEPER);
}

// Whether points i and i + 1 are a pair: places 2k and 2k + 1 of one segment, both below its chord. Pairs of equal u
// have no slope.
static inline int is_pair(int i, int n, global const int* restrict segment, global const int* restrict first,
                          global const uchar* restrict flags) {
  return i + 1 < n && ((i - first[segment[i]]) & 1) == 0 && segment[i + 1] == segment[i] && flags[i] == 1 &&
         flags[i + 1] == 1;
}
#define SLOPED_PAIR(i) is_pair(i, n, segment, first, flags) && projections[i].y != projections[(i) + 1].y ? i : -1
#define COMES_FIRST(s, i, j) \
  (projections[i].y != projections[j].y ? comes_first(projections[i].y, projections[j].y) : i < j)
kernel void random_pairs(ARG_REDUCE_ARGUMENTS, global const int* restrict first, global const uchar* restrict flags,
                         global const double2* restrict projections COUNTERS) {
  SEGMENTED_ARG_REDUCE(SLOPED_PAIR, COMES_FIRST);
}

kernel void tilted_depths(int n, HULL_POINTS(), global const double2* restrict path_projections,
                          global const int* restrict pair, global const double* restrict depth,
                          global double* restrict tilted COUNTERS) {
  const int i = get_global_id(0);
  if (i < n) {
    const int s = segment[i];
    const int k = pair[s];
    double value = depth[i];
    if (k >= 0) {
      COUNT(HULL, ARITHMETIC, TILT_OPERATIONS);
      const double slope = (depth[k + 1] - depth[k]) / (projections[k + 1].y - projections[k].y);
      const double height = value - slope * (projections[i].y - path_projections[s].y);
      if (isfinite(height)) value = height;
    }
    tilted[i] = value;
  }
}

// Drops points that are certainly not below a chord to the new vertex. Undecided points stay, which does no harm.
kernel void drop_pairs(int n, filter_bound bound, HULL_POINTS(), global const int* restrict first,
                       global const int* restrict path_region, global const int* restrict axis,
                       global const int* restrict deepest, global uchar* restrict flags COUNTERS) {
  const int i = get_global_id(0);
  if (i < n && is_pair(i, n, segment, first, flags)) {
    const int s = segment[i];
    const int planar = is_planar(axis[path_region[s]]);
    const double2 middle = projections[deepest[s]];
    const int swapped = projections[i].y > projections[i + 1].y;
    const double2 p = projections[i + swapped];
    const double2 q = projections[i + !swapped];
    const int left = q.y < middle.y;
    COUNT(HULL, ARITHMETIC, 2);
    if (p.y < q.y && (left || p.y > middle.y)) {
      const double2 d = left ? hull_depth(p, middle, q, planar) : hull_depth(middle, q, p, planar);
      if (d.x < -bound * d.y || (bound == 0.0 && d.x == 0.0)) flags[left ? i + !swapped : i + swapped] = 0;
    }
  }
}

kernel void split_counts(int n, global const int* restrict deepest, global uint* restrict splits) {
  const int s = get_global_id(0);
  if (s < n) splits[s] = deepest[s] >= 0;
}

// Which half of its segment a kept point goes to. Points that share u with the new vertex are above it and are dropped.
kernel void side_flags(int n, HULL_POINTS(), global const uchar* restrict flags, global const int* restrict deepest,
                       global uint2* restrict sides COUNTERS) {
  const int i = get_global_id(0);
  if (i < n) {
    uint2 side = VECTOR(uint2, 0, 0);
    if (flags[i] == 1) {
      const double u = projections[i].y;
      const double middle = projections[deepest[segment[i]]].y;
      side = VECTOR(uint2, u<middle, u> middle);
      COUNT(HULL, ARITHMETIC, 2);
    }
    sides[i] = side;
  }
}

kernel void advance_points(int n, HULL_POINTS(), global const int* restrict first, global const uint2* restrict sides,
                           global const uint* restrict splits, NEW_HULL_POINTS()) {
  const int i = get_global_id(0);
  if (i < n) {
    const uint2 before = sides[i];
    const uint2 after = sides[i + 1];
    if (after.x != before.x || after.y != before.y) {
      const int s = segment[i];
      const int right = after.y != before.y;
      const int to = right ? before.y + sides[first[s + 1]].x : before.x + sides[first[s]].y;
      new_ids[to] = ids[i];
      new_segment[to] = s + splits[s] + right;
      new_projections[to] = projections[i];
    }
  }
}

// sizes: the new number of points and of path vertices.
kernel void advance_paths(int n, int points_count, HULL_POINTS(), global const int* restrict deepest,
                          global const int* restrict first, global const uint2* restrict sides,
                          global const uint* restrict splits, PATH_VERTICES(), NEW_PATH_VERTICES(),
                          global int* restrict new_first, global uint* restrict sizes) {
  const int v = get_global_id(0);
  if (v < n) {
    const int to = v + splits[v];
    const uint2 begin = sides[first[v]];
    new_path[to] = path[v];
    new_projections[to] = path_projections[v];
    new_region[to] = path_region[v];
    new_first[to] = begin.x + begin.y;
    const int i = deepest[v];
    if (i >= 0) {
      new_path[to + 1] = ids[i];
      new_projections[to + 1] = projections[i];
      new_region[to + 1] = path_region[v];
      new_first[to + 1] = sides[first[v + 1]].x + begin.y;
    }
    if (v == n - 1) {
      const uint2 total = sides[points_count];
      sizes[0] = total.x + total.y;
      sizes[1] = n + splits[n];
      new_first[n + splits[n]] = total.x + total.y;
    }
  }
}

// Where each region's path begins, closed by the number of all vertices.
kernel void find_path_offsets(int n, global const int* restrict path_region, global int* restrict path_offsets) {
  const int v = get_global_id(0);
  if (v < n) {
    const int r = path_region[v];
    if (v == 0 || path_region[v - 1] != r) path_offsets[r] = v;
    if (v == n - 1) path_offsets[r + 1] = n;
  }
}

// flags: 1 for the ends of paths and for vertices strictly below the segment of their neighbours. If two
// neighbours have equal u, the one with the higher projection is above. kept: where the vertices stood in the
// path of the round before; vertices with the same neighbours need no second look.
kernel void path_flags(int n, filter_bound bound, int first_round, global const int* restrict kept, PATHS(),
                       global const int* restrict path_region, CUTS(), global uchar* restrict flags COUNTERS) {
  const int k = get_global_id(0);
  if (k < n) {
    const int r = path_region[k];
    uchar flag = 1;
    const int inner = k > path_offsets[r] && k < path_offsets[r + 1] - 1;
    if (inner && (first_round || kept[k + 1] - kept[k - 1] > 2)) {
      const double2 before = path_projections[k - 1];
      const double2 after = path_projections[k + 1];
      const double2 p = path_projections[k];
      const int planar = is_planar(axis[r]);
      const int shares_u = before.y == p.y || after.y == p.y;
      COUNT(HULL, ARITHMETIC, shares_u ? 2 + LOWER_OPERATIONS : 2);
      if (shares_u) {
        const int other = before.y == p.y ? k - 1 : k + 1;
        flag = is_lower(to_frame(points[path[k]], axis[r]), to_frame(points[path[other]], axis[r]), cut[r], planar);
      } else {
        const double2 d = hull_depth(before, after, p, planar);
        const double error = bound * d.y;
        flag = d.x > error ? 1 : d.x < -error || bound == 0.0 ? 0 : FLAG_UNDECIDED;
      }
    }
    flags[k] = flag;
  }
}

// A path's vertices as points below the chord between its ends, to begin again with: see begin_paths in prune.cl.
kernel void restart_paths(int n, PATHS(), NEW_PATH_VERTICES(), global int* restrict first) {
  const int r = get_global_id(0);
  if (r < n) {
    for (int side = 0; side < 2; ++side) {
      const int v = side ? path_offsets[r + 1] - 1 : path_offsets[r];
      new_path[2 * r + side] = path[v];
      new_projections[2 * r + side] = path_projections[v];
      new_region[2 * r + side] = r;
      first[2 * r + side] = path_offsets[r + side];
    }
    if (r == n - 1) first[2 * n] = path_offsets[n];
  }
}

kernel void restart_segments(int n, global const int* restrict path_region, global int* restrict segment) {
  const int v = get_global_id(0);
  if (v < n) segment[v] = 2 * path_region[v];
}

kernel void compact_path(int n, global const int* restrict kept, PATH_VERTICES(), NEW_PATH_VERTICES()) {
  const int k = get_global_id(0);
  if (k < n) {
    const int from = kept[k];
    new_path[k] = path[from];
    new_projections[k] = path_projections[from];
    new_region[k] = path_region[from];
  }
}
