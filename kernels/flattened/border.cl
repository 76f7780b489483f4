// The initial borders: the convex hull of each set, with the points on its edges, as corners.
//
// Each set s makes two planar regions: 2s for its lower hull and 2s + 1 for its upper one. The elements of both are all
// points of the set. The hull stages (prune.cl, quickhull.cl) find the strict hulls, and a second prune keeps the
// points that lie on them. The border, counter-clockwise, is the lower side in ascending order of ids and then the
// upper side in descending order; the smallest and the largest id are on both sides. If a set is collinear, all its
// points are on both sides. Each kernel is one pass, with one work-item per point, set or border vertex.

#include "flattened/arguments.h"
#include "flattened/axes.h"
#include "flattened/codes.h"
#include "operations/counters.h"
#include "operations/search.h"

// Elements [2 * offsets[s], 2 * offsets[s + 1]) of the doubled list: the set's ids up, then down.
kernel void doubled_lists(int n, global const int* restrict set_of_id, global const int* restrict offsets,
                          global int* restrict ids, global int* restrict regions) {
  const int id = get_global_id(0);
  if (id < n) {
    const int s = set_of_id[id];
    const int low = offsets[s];
    const int high = offsets[s + 1];
    ids[low + id] = id;
    regions[low + id] = 2 * s;
    const int down = 2 * high - 1 - (id - low);
    ids[down] = id;
    regions[down] = 2 * s + 1;
  }
}

kernel void all_ids(int n, global int* restrict ids) {
  const int id = get_global_id(0);
  if (id < n) ids[id] = id;
}

// Where the planar regions' elements begin, closed by their number.
kernel void doubled_offsets(int n, global const int* restrict offsets, global int* restrict doubled) {
  const int s = get_global_id(0);
  if (s < n) {
    doubled[2 * s] = 2 * offsets[s];
    doubled[2 * s + 1] = offsets[s] + offsets[s + 1];
    if (s == n - 1) doubled[2 * n] = 2 * offsets[n];
  }
}

// The ends of both hulls. In the lower frame: the first of the lowest column by x, and the first of the last column.
// Empty sets get no segment: their ends are -1.
kernel void set_ends(int n, global const int* restrict offsets, global const double2* restrict points,
                     global int* restrict axis, global double* restrict cut, global int* restrict first_end,
                     global int* restrict last_end COUNTERS) {
  const int s = get_global_id(0);
  if (s < n) {
    const int low = offsets[s];
    const int high = offsets[s + 1];
    axis[2 * s] = AXIS_PLANAR_LOWER;
    axis[2 * s + 1] = AXIS_PLANAR_UPPER;
    if (low == high) {
      first_end[2 * s] = last_end[2 * s] = first_end[2 * s + 1] = last_end[2 * s + 1] = -1;
      cut[2 * s] = cut[2 * s + 1] = 0.0;
    } else {
      const double left = points[low].x;
      const double right = points[high - 1].x;
      COUNT(HULL, ARITHMETIC, 2 * search_comparisons(high - low));
      // The last id of the first column, the first id of the last one.
      int below = low, above = high;
      while (above - below > 1) {
        const int middle = below + (above - below) / 2;
        if (points[middle].x > left) {
          above = middle;
        } else {
          below = middle;
        }
      }
      const int last_of_first = below;
      below = low - 1;
      above = high - 1;
      while (above - below > 1) {
        const int middle = below + (above - below) / 2;
        if (points[middle].x < right) {
          below = middle;
        } else {
          above = middle;
        }
      }
      first_end[2 * s] = low;
      last_end[2 * s] = above;
      first_end[2 * s + 1] = high - 1;
      last_end[2 * s + 1] = last_of_first;
      cut[2 * s] = points[low].y;
      cut[2 * s + 1] = -points[high - 1].y;
    }
  }
}

// From the scanned flags of the doubled list (1: on a hull): each set's border length, its internal points, and
// its corners; collinear sets have no corners and no internal points.
kernel void border_sizes(int n, global const int* restrict offsets, global const uint* restrict scanned,
                         global uint* restrict hull_size, global int* restrict collinear,
                         global int* restrict child_points, global int* restrict child_corners) {
  const int s = get_global_id(0);
  if (s < n) {
    const int low = offsets[s];
    const int high = offsets[s + 1];
    const int count = high - low;
    const int lower = scanned[low + high] - scanned[2 * low];
    const int upper = scanned[2 * high] - scanned[low + high];
    const int flat = count < 3 || (lower == count && upper == count);
    collinear[s] = flat;
    hull_size[s] = flat ? count : lower + upper - 2;
    child_corners[s] = flat ? 0 : lower + upper - 2;
    child_points[s] = flat ? 0 : count - (lower + upper - 2);
  }
}

// hull[hull_offsets[s] + k]: the k-th id of set s's border. Gives the border's points SIDE_BORDER, so that
// the first lists leave them out.
kernel void border_write(int n, global const int* restrict ids, global const int* restrict regions,
                         global const int* restrict offsets, global const uint* restrict scanned,
                         global const int* restrict collinear, global const uint* restrict hull_offsets,
                         global int* restrict hull, global uchar* restrict side) {
  const int i = get_global_id(0);
  if (i < n) {
    const int region = regions[i];
    const int s = region / 2;
    const int low = offsets[s];
    const int high = offsets[s + 1];
    const int id = ids[i];
    const int on = scanned[i + 1] != scanned[i];
    const uint base = hull_offsets[s];
    if (region % 2 == 0) {
      if (on || collinear[s]) side[id] = SIDE_BORDER;
      if (collinear[s]) {
        hull[base + (id - low)] = id;
      } else if (on) {
        hull[base + scanned[i] - scanned[2 * low]] = id;
      }
    } else if (on && !collinear[s] && id != low && id != high - 1) {
      // The upper side begins with the largest id, which the lower side ended with.
      side[id] = SIDE_BORDER;
      hull[base + (scanned[low + high] - scanned[2 * low]) + (scanned[i] - scanned[low + high]) - 1] = id;
    }
  }
}

// Corner k of a border: (before, vertex, after).
kernel void border_corners(int n, global const int* restrict hull, global const uint* restrict hull_offsets,
                           global const int* restrict set_of_id, global const int* restrict collinear, CHILDREN()) {
  const int k = get_global_id(0);
  if (k < n) {
    const int s = set_of_id[hull[k]];
    if (!collinear[s]) {
      const int first = hull_offsets[s];
      const int last = (int)hull_offsets[s + 1] - 1;
      const int before = hull[k == first ? last : k - 1];
      const int after = hull[k == last ? first : k + 1];
      const int to = child_base[s] + (k - first);
      const int region = child_region[s];
      global int* restrict target = region >= 0 ? corners : retired;
      target[3 * to] = before;
      target[3 * to + 1] = hull[k];
      target[3 * to + 2] = after;
      if (region >= 0) corner_region[to] = region;
    }
  }
}
