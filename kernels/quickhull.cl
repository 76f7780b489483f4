// Segmented quickhull: the strict lower hull of every region's points at once, as a path in the order of u.
//
// Points lie in segments, segment s being what is left below the chord (chord_a[s], chord_b[s]); segments are in the
// order of (region, u). A round: hull_depths holds each point against its chord; hull_depth_exact decides what
// floating point could not (a packed list); deepest_points takes each segment's deepest point (passes of a
// segmented arg-reduce); segments with such a point split there, and the points go to either half, stably: split_flags
// and side_flags make counts for scans (scan.cl), advance_segments and advance_points move. When no points are left,
// write_path lists the ends. The deepest point is chosen by rounded depths and may be no vertex of the hull: path_flags
// (and hull_depth_exact) find vertices on or above the segment of their neighbours, compact_path drops them,
// until there are none.

#include "shared/hull_height.h"
#include "shared/segmented_arg_reduce.h"

// places[i]: point i in its region's frame; chord_places[s]: both ends of chord s. flags: 1 strictly below the
// chord, 0 not, 2 undecided.
kernel void hull_depths(int n, double bound, global const int* restrict segment,
                        global const double2* restrict places, global const double4* restrict chord_places,
                        global const int* restrict chord_region, global const int* restrict axis,
                        global const double* restrict cut, global double* restrict depth,
                        global uchar* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) {
    const int s = segment[i];
    const int r = chord_region[s];
    const double4 chord = chord_places[s];
    const double2 d = hull_depth(chord.lo, chord.hi, places[i], cut[r], is_planar(axis[r]));
    const double error = bound * d.y;
    depth[i] = d.x;
    flags[i] = d.x > error ? 1 : d.x < -error || bound == 0.0 ? 0 : 2;
  }
}

// Decides the listed elements: point ids[i] against (chord_a[c], chord_b[c + b_offset]), c = chord[i] (or i - 1 for a
// path's own vertices). Work-items share the list, whose length only the device knows.
kernel void hull_depth_exact(global const uint* restrict count, global const int* restrict list, int keep_on,
                             int own_path, int b_offset, global const int* restrict ids,
                             global const int* restrict chord, global const int* restrict chord_a,
                             global const int* restrict chord_b, global const int* restrict chord_region,
                             global const int* restrict axis, global const double* restrict cut,
                             global const double2* restrict points, global uchar* restrict flags) {
  const int length = count[0];
  for (int k = get_global_id(0); k < length; k += get_global_size(0)) {
    const int i = list[k];
    const int c = own_path ? i - 1 : chord[i];
    const int r = chord_region[c];
    const int a = axis[r];
    const int sign = hull_depth_sign(to_frame(points[chord_a[c]], a), to_frame(points[chord_b[c + b_offset]], a),
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
                            global const int* restrict chord_region, global const int* restrict axis,
                            global const double* restrict cut) {
  if (!balanced && depth[i] != depth[j]) return depth[i] > depth[j];
  const int r = chord_region[s];
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
#define DEEPER(s, i, j) is_deeper(s, i, j, balanced, ids, depth, places, chord_region, axis, cut)
SEGMENTED_ARG_REDUCE(deepest_points, KEPT, DEEPER, int balanced, global const uchar* restrict flags,
                     global const int* restrict ids, global const double* restrict depth,
                     global const double2* restrict places, global const int* restrict chord_region,
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

// sizes: the new number of points and of segments.
kernel void advance_segments(int n, int points_count, global const int* restrict ids,
                             global const double2* restrict places, global const int* restrict deepest, global const int* restrict first,
                             global const uint2* restrict sides, global const uint* restrict splits,
                             global const int* restrict chord_a, global const int* restrict chord_b,
                             global const double4* restrict chord_places, global const int* restrict chord_region,
                             global int* restrict new_a, global int* restrict new_b,
                             global double4* restrict new_places, global int* restrict new_region,
                             global int* restrict new_first, global uint* restrict sizes) {
  const int s = get_global_id(0);
  if (s < n) {
    const int to = s + splits[s];
    const uint2 begin = sides[first[s]];
    new_a[to] = chord_a[s];
    new_region[to] = chord_region[s];
    new_first[to] = begin.x + begin.y;
    if (deepest[s] >= 0) {
      const int middle = ids[deepest[s]];
      const double2 place = places[deepest[s]];
      new_places[to] = (double4)(chord_places[s].lo, place);
      new_places[to + 1] = (double4)(place, chord_places[s].hi);
      new_b[to] = middle;
      new_a[to + 1] = middle;
      new_b[to + 1] = chord_b[s];
      new_region[to + 1] = chord_region[s];
      new_first[to + 1] = sides[first[s + 1]].x + begin.y;
    } else {
      new_b[to] = chord_b[s];
      new_places[to] = chord_places[s];
    }
    if (s == n - 1) {
      const uint2 total = sides[points_count];
      sizes[0] = total.x + total.y;
      sizes[1] = n + splits[n];
      new_first[n + splits[n]] = total.x + total.y;
    }
  }
}

// Every region has at least one segment, so its path begins after as many vertices as there are segments and
// regions before. Regions of no points have ends -1.
kernel void write_path(int n, global const int* restrict chord_a, global const int* restrict chord_b,
                       global const double4* restrict chord_places, global const int* restrict chord_region,
                       global int* restrict path, global double2* restrict path_places,
                       global int* restrict path_region, global int* restrict path_offsets) {
  const int s = get_global_id(0);
  if (s < n) {
    const int r = chord_region[s];
    const int to = s + r;
    path[to] = chord_a[s];
    path_places[to] = chord_places[s].lo;
    path_region[to] = r;
    if (s == 0 || chord_region[s - 1] != r) path_offsets[r] = to;
    if (s == n - 1 || chord_region[s + 1] != r) {
      path[to + 1] = chord_b[s];
      path_places[to + 1] = chord_places[s].hi;
      path_region[to + 1] = r;
      if (s == n - 1) path_offsets[r + 1] = to + 2;
    }
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

kernel void compact_path(int n, int old_n, global const int* restrict kept, global const int* restrict path,
                         global const double2* restrict path_places, global const int* restrict path_region,
                         global int* restrict new_path, global double2* restrict new_places,
                         global int* restrict new_region, global int* restrict new_offsets) {
  const int k = get_global_id(0);
  if (k < n) {
    const int from = kept[k];
    const int r = path_region[from];
    new_path[k] = path[from];
    new_places[k] = path_places[from];
    new_region[k] = r;
    // A path's ends are always kept.
    if (from == 0 || path_region[from - 1] != r) new_offsets[r] = k;
    if (from == old_n - 1) new_offsets[r + 1] = n;
  }
}
