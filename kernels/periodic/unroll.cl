// Points on a torus or a cylinder as they are triangulated in the plane. Segments: sets.
//
// find_places, over all points: their places in the period. find_box_ends, over pieces of sets: the lowest and the
// highest of these, for boxes of cylinders. Then, for some of the sets: count_images, over their points; the host scans
// the counts. write_images, over the points: in the plane each set has its points, and behind them their images.

#include "operations/segment_near.h"
#include "periodic/records.h"
#include "periodic/torus.h"

#ifndef FIXED_POINT

// bad: the first point that is not finite.
kernel void find_places(int n, periodic_lattice lattice, global const double* restrict input,
                        global double* restrict places, global volatile int* restrict bad) {
  const int i = get_global_id(0);
  if (i < n) {
    const double2 place = place_in(vload2(i, input), &lattice);
    vstore2(place, i, places);
    if (!(fabs(place.x) < INFINITY && fabs(place.y) < INFINITY)) atomic_min(bad, i);
  }
}

// n pieces, not empty: from a point to before another one. ends: 4 per piece, the lowest x and y, the highest x and y.
kernel void find_box_ends(int n, global const int2* restrict pieces, global const double* restrict places,
                          global double* restrict ends) {
  const int i = get_global_id(0);
  if (i < n) {
    double2 low = vload2(pieces[i].x, places), high = low;
    for (int j = pieces[i].x + 1; j < pieces[i].y; ++j) {
      const double2 p = vload2(j, places);
      low = VECTOR(double2, min(low.x, p.x), min(low.y, p.y));
      high = VECTOR(double2, max(high.x, p.x), max(high.y, p.y));
    }
    vstore2(low, 2 * i, ends);
    vstore2(high, 2 * i + 1, ends);
  }
}

// Whether a point has no images within the margin, which is so of most points of a large set.
static inline int is_far_inside(double2 p, global const periodic_box* box) {
  return p.x > box->low[0] + box->margin && p.x < box->high[0] - box->margin && p.y > box->low[1] + box->margin &&
         p.y < box->high[1] - box->margin;
}

// n points of sets, which have the points from offsets on.
kernel void count_images(int n, periodic_lattice lattice, int sets, global const int* restrict offsets,
                         global const unrolled_set* restrict all, global const double* restrict places,
                         global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) {
    const int k = segment_near(i, sets, offsets);
    const double2 p = vload2(all[k].first + i - offsets[k], places);
    counts[i] = 0;
    if (is_far_inside(p, &all[k].box)) return;
    const periodic_box box = all[k].box;
    const image_range to = images_around(p, &lattice, &box);
    counts[i] = (uint)((to.high[0] - to.low[0] + 1) * (to.high[1] - to.low[1] + 1) - 1);
    if (!is_sheared(&lattice)) return;
    uint count = 0;
    for (int across = to.low[0]; across <= to.high[0]; ++across) {
      for (int up = to.low[1]; up <= to.high[1]; ++up) count += (uint)is_image(p, across, up, &lattice, &box);
    }
    counts[i] = count;
  }
}

// n places in the sums that a scan has made.
kernel void read_totals(int n, global const int* restrict offsets, global const uint* restrict sums,
                        global uint* restrict totals) {
  const int k = get_global_id(0);
  if (k < n) totals[k] = sums[offsets[k]];
}

// counts: scanned. images: what is at each place of the plane. own: how many of the first points need none.
// are_there: whether coordinates are the places, behind which images go.
kernel void write_images(int n, periodic_lattice lattice, int sets, int own, int are_there,
                         global const int* restrict offsets, global const unrolled_set* restrict all,
                         global const double* places, global const uint* restrict counts, global double* coordinates,
                         global uint64* restrict images) {
  const int i = get_global_id(0);
  if (i < n && !(are_there && counts[i + 1] == counts[i])) {
    const int k = segment_near(i, sets, offsets);
    const int point = all[k].first + i - offsets[k], at = i + (int)counts[offsets[k]];
    const double2 p = vload2(point, places);
    if (!are_there) vstore2(p, at, coordinates);
    if (i >= own) images[at] = image_of(point, 0, 0);
    if (counts[i + 1] == counts[i]) return;
    const periodic_box box = all[k].box;
    const image_range to = images_around(p, &lattice, &box);
    int next = offsets[k + 1] + (int)counts[i];
    for (int across = to.low[0]; across <= to.high[0]; ++across) {
      for (int up = to.low[1]; up <= to.high[1]; ++up) {
        if (!is_image(p, across, up, &lattice, &box)) continue;
        vstore2(moved(p, across, up, &lattice), next, coordinates);
        images[next++] = image_of(point, across, up);
      }
    }
  }
}

#endif
