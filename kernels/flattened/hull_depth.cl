// Exact depths below chords, for what floating point could not decide in prune, quickhull and the clean-up of paths.
//
// One pass over a packed list. Only the device knows the list's length, so a fixed number of work-items share it.

#include "shared/hull_height.h"

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
