// Which triangles contain seeds, of holes or of attributes: one pass over the triangles of all sets. Each looks
// at the seeds in its range of x. Seeds may be anywhere: they need not share a grid with the points. So this is
// for double precision alone; where a device computes in fixed point, another one or the host finds them.

#include "arithmetic/coordinates.h"
#include "arithmetic/language.h"
#include "operations/search.h"
#include "points/records.h"
#include "predicates/planar.h"

#ifndef FIXED_POINT

// seeds: in each set by ascending x, scaled by frames. found: INT_MAX throughout; gets the first triangle that contains
// the seed. barred: 0 throughout; gets 1 if the seed is on a constraint.
kernel void find_seeds(int n, int sets, global const int* restrict triangle_offsets,
                       global const int* restrict seed_offsets, global const query_frame* restrict frames,
                       filter_bound bound, global const double* restrict input, global const int* restrict triangles,
                       global const uchar* restrict constrained, global const double2* restrict seeds,
                       global volatile int* restrict found, global uchar* restrict barred) {
  const int t = get_global_id(0);
  if (t < n) {
    const int s = segment_of(t, sets, triangle_offsets);
    const int last = seed_offsets[s + 1];
    int low = seed_offsets[s];
    if (low < last) {
      double2 p[3];
      for (int k = 0; k < 3; ++k) p[k] = scaled_point(triangles[3 * t + k], input, frames[s].scale);
      const double2 least = VECTOR(double2, min(p[0].x, min(p[1].x, p[2].x)), min(p[0].y, min(p[1].y, p[2].y)));
      const double2 most = VECTOR(double2, max(p[0].x, max(p[1].x, p[2].x)), max(p[0].y, max(p[1].y, p[2].y)));
      int high = last;
      while (low < high) {
        const int middle = low + (high - low) / 2;
        if (seeds[middle].x < least.x) {
          low = middle + 1;
        } else {
          high = middle;
        }
      }
      for (int h = low; h < last && seeds[h].x <= most.x; ++h) {
        const double2 q = seeds[h];
        if (q.y < least.y || q.y > most.y) continue;
        const int ab = orient_sign(p[0], p[1], q, bound), bc = orient_sign(p[1], p[2], q, bound),
                  ca = orient_sign(p[2], p[0], q, bound);
        if (ab < 0 || bc < 0 || ca < 0) continue;
        atomic_min(&found[h], t);
        const int on_constraint = (ab == 0 && constrained[3 * t + 2]) || (bc == 0 && constrained[3 * t]) ||
                                  (ca == 0 && constrained[3 * t + 1]);
        if (on_constraint) barred[h] = 1;
      }
    }
  }
}

#endif
