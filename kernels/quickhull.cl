// Segmented quickhull: the strict lower hull of every region's points at once, as a path in the order of u.
//
// Paths grow from each region's two ends. Points lie in segments, segment v being what is left below the chord from path
// vertex v to the next one; path vertices are in the order of (region, u), and the last of a region has no points. A
// round: hull_depths holds each point against its chord; hull_depth_exact decides what floating point could not (a packed
// list); deepest_points takes each segment's deepest point (passes of a segmented arg-reduce), which becomes a vertex; the
// segment's points go to either side of it, stably: split_flags and side_flags make counts for scans (scan.cl),
// advance_paths and advance_points move. The deepest point is chosen by rounded depths and may be no vertex of the
// hull: when no points are left, path_flags (and hull_depth_exact) find vertices on or above the segment of their
// neighbours, compact_path drops them, until there are none.

#include "shared/hull_height.h"
#include "shared/segmented_arg_reduce.h"

// places[i]: point i in its region's frame, as path_places. flags: 1 strictly below the chord, 0 not, 2 undecided.
kernel void hull_depths(int n, double bound, global const int* restrict segment,
                        global const double2* restrict places, global const double2* restrict path_places,
                        global const int* restrict path_region, global const int* restrict axis,
                        global const double* restrict cut, global double* restrict depth,
                        global uchar* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) {
    const int v = segment[i];
    const int r = path_region[v];
    const double2 d = hull_depth(path_places[v], path_places[v + 1], places[i], cut[r], is_planar(axis[r]));
    const double error = bound * d.y;
    depth[i] = d.x;
    flags[i] = d.x > error ? 1 : d.x < -error || bound == 0.0 ? 0 : 2;
  }
}

// Decides the listed elements: point ids[i] against the chord from path vertex chord[i] to the next one; with own_path,
// path vertex i against the chord of its neighbours. Work-items share the list, whose length only the device knows.
kernel void hull_depth_exact(global const uint* restrict count, global const int* restrict list, int keep_on,
                             int own_path, global const int* restrict ids, global const int* restrict chord,
                             global const int* restrict path, global const int* restrict path_region,
                             global const int* restrict axis, global const double* restrict cut,
                             global const double2* restrict points, global uchar* restrict flags) {
  const int length = count[0];
  for (int k = get_global_id(0); k < length; k += get_global_size(0)) {
    const int i = list[k];
    const int from = own_path ? i - 1 : chord[i];
    const int to = own_path ? i + 1 : from + 1;
    const int r = path_region[from];
    const int a = axis[r];
    const int sign = hull_depth_sign(to_frame(points[path[from]], a), to_frame(points[path[to]], a),
                                     to_frame(points[ids[i]], a), cut[r], is_planar(a));
    flags[i] = sign > 0 || (keep_on && sign == 0);
  }
}

static inline ulong scramble(double u) {
  // The finaliser of SplitMix64 (Steele, Lea and Flood, 2014).
  ulong z = as_ulong(u) + 0x9e3779b97f4a7c15UL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9UL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebUL;
  return z ^ (z >> 31);
}

// Whether point i is to be preferred to j: deeper; of equal depth, by a hash of u, so that flat chords split evenly; of
// equal u, the lower projection, so that what else shares that u can be dropped. `balanced` ranks by the hash alone: a
// random split, for input on which the deepest points are always next to the ends.
static inline int is_deeper(int s, int i, int j, int balanced, global const int* restrict ids,
                            global const double* restrict depth, global const double2* restrict places,
                            global const int* restrict path_region, global const int* restrict axis,
                            global const double* restrict cut) {
  if (!balanced && depth[i] != depth[j]) return depth[i] > depth[j];
  const int r = path_region[s];
  const double2 p = places[i];
  const double2 v = places[j];
  if (p.y != v.y) {
    const ulong hp = scramble(p.y);
    const ulong hv = scramble(v.y);
    return hp != hv ? hp < hv : p.y < v.y;
  }
  return ids[i] == ids[j] ? i < j : is_lower(p, v, cut[r], is_planar(axis[r]));
}
#define KEPT(i) flags[i] == 1 ? i : -1
#define DEEPER(s, i, j) is_deeper(s, i, j, balanced, ids, depth, places, path_region, axis, cut)
SEGMENTED_ARG_REDUCE(deepest_points, KEPT, DEEPER, int balanced, global const uchar* restrict flags,
                     global const int* restrict ids, global const double* restrict depth,
                     global const double2* restrict places, global const int* restrict path_region,
                     global const int* restrict axis, global const double* restrict cut)

kernel void split_flags(int n, global const int* restrict deepest, global uint* restrict splits) {
  const int s = get_global_id(0);
  if (s < n) splits[s] = deepest[s] >= 0;
}

// Which half of its segment a kept point goes to; points that share u with the new vertex are above it, and go.
kernel void side_flags(int n, global const int* restrict segment, global const double2* restrict places,
                       global const uchar* restrict flags, global const int* restrict deepest,
                       global uint2* restrict sides) {
  const int i = get_global_id(0);
  if (i < n) {
    uint2 side = (uint2)(0, 0);
    if (flags[i] == 1) {
      const double u = places[i].y;
      const double middle = places[deepest[segment[i]]].y;
      side = (uint2)(u < middle, u > middle);
    }
    sides[i] = side;
  }
}

kernel void advance_points(int n, global const int* restrict ids, global const int* restrict segment,
                           global const double2* restrict places, global const int* restrict first,
                           global const uint2* restrict sides, global const uint* restrict splits,
                           global int* restrict new_ids, global int* restrict new_segment,
                           global double2* restrict new_places) {
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
      new_places[to] = places[i];
    }
  }
}

// sizes: the new number of points and of path vertices.
kernel void advance_paths(int n, int points_count, global const int* restrict ids,
                          global const double2* restrict places, global const int* restrict deepest,
                          global const int* restrict first, global const uint2* restrict sides,
                          global const uint* restrict splits, global const int* restrict path,
                          global const double2* restrict path_places, global const int* restrict path_region,
                          global int* restrict new_path, global double2* restrict new_places,
                          global int* restrict new_region, global int* restrict new_first,
                          global uint* restrict sizes) {
  const int v = get_global_id(0);
  if (v < n) {
    const int to = v + splits[v];
    const uint2 begin = sides[first[v]];
    new_path[to] = path[v];
    new_places[to] = path_places[v];
    new_region[to] = path_region[v];
    new_first[to] = begin.x + begin.y;
    const int i = deepest[v];
    if (i >= 0) {
      new_path[to + 1] = ids[i];
      new_places[to + 1] = places[i];
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

// flags: 1 for the ends of paths and for vertices strictly below the segment of their neighbours.
kernel void path_flags(int n, double bound, global const double2* restrict path_places,
                       global const int* restrict path_region, global const int* restrict path_offsets,
                       global const int* restrict axis, global const double* restrict cut,
                       global uchar* restrict flags) {
  const int k = get_global_id(0);
  if (k < n) {
    const int r = path_region[k];
    uchar flag = 1;
    if (k > path_offsets[r] && k < path_offsets[r + 1] - 1) {
      const double2 d =
          hull_depth(path_places[k - 1], path_places[k + 1], path_places[k], cut[r], is_planar(axis[r]));
      const double error = bound * d.y;
      flag = d.x > error ? 1 : d.x < -error || bound == 0.0 ? 0 : 2;
    }
    flags[k] = flag;
  }
}

kernel void compact_path(int n, global const int* restrict kept, global const int* restrict path,
                         global const double2* restrict path_places, global const int* restrict path_region,
                         global int* restrict new_path, global double2* restrict new_places,
                         global int* restrict new_region) {
  const int k = get_global_id(0);
  if (k < n) {
    const int from = kept[k];
    new_path[k] = path[from];
    new_places[k] = path_places[from];
    new_region[k] = path_region[from];
  }
}
