// Weighted points on a torus or a cylinder: what periodic/unroll.cl and fold.cl have besides for regular
// triangulations. Segments: sets, as these have them.
//
// weigh_images, over the places of the plane: images have their point's weight. flag_hidden_points, over hidden
// vertices of the plane: a point that is hidden at its place is hidden, since more images cannot uncover it.

#include "operations/segment_near.h"
#include "periodic/records.h"
#include "periodic/torus.h"

#ifndef FIXED_POINT

kernel void weigh_images(int n, int own, global const uint64* restrict images, global const double* restrict weights,
                         global double* restrict plane_weights) {
  const int v = get_global_id(0);
  if (v < n) plane_weights[v] = weights[point_of(image_at(v, own, images))];
}

// n of the vertices. offsets: where sets begin in the plane. is_hidden: by point. missing: see fold_representatives,
// which has counted points at ends.
kernel void flag_hidden_points(int n, int own, periodic_lattice lattice, int sets, global const int* restrict offsets,
                               global const unrolled_set* restrict all, global const int* restrict hidden,
                               global const uint64* restrict images, global const double* restrict coordinates,
                               global uchar* restrict is_hidden, global volatile uint* restrict missing) {
  const int i = get_global_id(0);
  if (i < n) {
    const int v = hidden[i];
    const uint64 image = image_at(v, own, images);
    if (!is_in_place(image)) return;
    is_hidden[point_of(image)] = 1;
    const int k = segment_near(v, sets, offsets);
    const periodic_box box = all[k].box;
    const double2 p = vload2(v, coordinates);
    atomic_add(&missing[2 * k + 1], (uint)(2 - ends_at(p.x, 0, &lattice, &box) - ends_at(p.y, 1, &lattice, &box)));
  }
}

#endif
