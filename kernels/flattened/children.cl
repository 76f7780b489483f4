// The layout of the next level: how large each child of a region is, and where its points and corners begin.
//
// child_sizes computes the numbers of points and corners of the two children of each region, set_sizes the
// numbers of the one child of each set. The host scans the sizes. child_places then separates the children:
// children with internal points are the regions of the next level, the others retire to the end game. Each
// kernel is one pass, with one work-item per region, set or child.

#include "arithmetic/language.h"

// (1, corners, points, 0, 0) for a child with internal points, (0, 0, 0, 1, corners) for one that retires, 0 for one
// that is empty; to be scanned.
static inline uint8 child_size(uint points, uint corners) {
  const uint goes_on = points > 0, retires = points == 0 && corners > 0;
  return VECTOR8(uint8, goes_on, goes_on ? corners : 0, points, retires, retires ? corners : 0, 0, 0, 0);
}

// sizes[2r + side]: of a child.
kernel void child_sizes(int n, global const int* restrict corner_offsets, global const int* restrict path_offsets,
                        global const uint2* restrict points_before, global const uint2* restrict corner_sides,
                        global const uint* restrict internal, global uint8* restrict sizes) {
  const int r = get_global_id(0);
  if (r < n) {
    const uint2 points = points_before[r + 1] - points_before[r];
    uint2 corners = corner_sides[corner_offsets[r + 1]] - corner_sides[corner_offsets[r]];
    corners += internal[path_offsets[r + 1]] - internal[path_offsets[r]];
    for (int side = 0; side < 2; ++side) {
      const uint p = side ? points.y : points.x;
      const uint c = side ? corners.y : corners.x;
      sizes[2 * r + side] = child_size(p, c);
    }
  }
}

// The sizes of sets, before the first level: one child each.
kernel void set_sizes(int n, global const int* restrict child_points, global const int* restrict child_corners,
                      global uint8* restrict sizes) {
  const int s = get_global_id(0);
  if (s < n) {
    const uint p = child_points[s];
    const uint c = child_corners[s];
    sizes[s] = child_size(p, c);
  }
}

// From the scanned sizes: each child's number as a region (or -1 - its number among the retired), where its corners
// begin, and the offsets of regions and of retired regions, closed by their totals.
kernel void child_places(int n, global const uint8* restrict scanned, global int* restrict child_region,
                         global int* restrict child_base, global int* restrict point_offsets,
                         global int* restrict corner_offsets, global int* restrict retired_offsets) {
  const int c = get_global_id(0);
  if (c < n) {
    const uint8 now = scanned[c];
    const uint8 then = scanned[c + 1];
    if (then.s0 != now.s0) {
      child_region[c] = now.s0;
      child_base[c] = now.s1;
      point_offsets[now.s0] = now.s2;
      corner_offsets[now.s0] = now.s1;
    } else {
      child_region[c] = -1 - (int)now.s3;
      child_base[c] = now.s4;
      if (then.s3 != now.s3) retired_offsets[now.s3] = now.s4;
    }
    if (c == n - 1) {
      point_offsets[then.s0] = then.s2;
      corner_offsets[then.s0] = then.s1;
      retired_offsets[then.s3] = then.s4;
    }
  }
}
