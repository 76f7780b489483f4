// How a work-group sorts a tile of samples in local memory. In OpenCL C alone.
#ifndef FLAUNAY_SORTED_TILE_H
#define FLAUNAY_SORTED_TILE_H

#include "operations/work_group.h"
#include "points/limits.h"
#include "predicates/order.h"

// How many elements of a tile's sorted run [begin, end) come before p, or are equal to it and are to come before it.
static inline int places_before(coordinate2 p, int equals_count, int begin, int end, local const ushort* order,
                                local const coordinate2* points, int axis) {
  int least = begin, most = end;
  while (least < most) {
    const int middle = (least + most) / 2;
    const coordinate2 q = points[order[middle]];
    const int is_before = equals_count ? !precedes(p, q, axis) : precedes(q, p, axis);
    least = is_before ? middle + 1 : least;
    most = is_before ? most : middle;
  }
  return least - begin;
}

// The place of element i of a tile whose pairs of runs are merged.
static inline int merged_place(int i, int run, int size, local const ushort* order, local const coordinate2* points,
                               int axis) {
  const int own = i & -run, is_high = (i & run) != 0;
  const int sibling = is_high ? own - run : min(size, own + run);
  const int before = places_before(points[order[i]], is_high, sibling, min(size, sibling + run), order, points, axis);
  return i - (is_high ? run : 0) + before;
}

// An order of a tile and room for the next one.
#define TILE_ORDERS (2 * LARGEST_SAMPLE_TILE)

// Sorts the tile along `axes` axes from `axis` on, each into TILE_ORDERS elements of its own, from the place on that is
// returned. Equal points stay in their order.
WITH_BARRIERS int sort_samples(int size, int axis, int axes, local const coordinate2* points, local ushort* orders) {
  const int me = get_local_id(0), group = get_local_size(0);
  for (int k = 0; k < axes; ++k) {
    for (int i = me; i < size; i += group) orders[k * TILE_ORDERS + i] = (ushort)i;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  int from = 0, run = 1;
  do {
    const int to = LARGEST_SAMPLE_TILE - from;
    for (int k = 0; k < axes; ++k) {
      local ushort* const order = orders + k * TILE_ORDERS;
      for (int i = me; i < size; i += group) {
        order[to + merged_place(i, run, size, order + from, points, axis + k)] = order[from + i];
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    from = to;
    run *= 2;
  } while (run < size);
  return from;
}

#endif
