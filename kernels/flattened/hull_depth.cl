// Exact depths below chords, for elements that prune, quickhull and the clean-up of paths could not decide.
//
// One pass, with one work-item per element. Few are undecided as a rule, so that a list of them would take more
// launches than it would save work.

#include "flattened/arguments.h"
#include "flattened/codes.h"
#include "flattened/hull_height.h"

// Decides the elements with FLAG_UNDECIDED, and adds their number to undecided[0]: point ids[i] against the chord from
// path vertex chord[i] to the next one; with own_path, path vertex i against the chord of its neighbours.
kernel void hull_depth_exact(int n, int keep_on, int own_path, global const int* restrict ids,
                             global const int* restrict chord, PATH_VERTICES(), CUTS(), global uchar* restrict flags,
                             global volatile uint* restrict undecided) {
  const int i = get_global_id(0);
  if (i < n && flags[i] == FLAG_UNDECIDED) {
    const int from = own_path ? i - 1 : chord[i];
    const int to = own_path ? i + 1 : from + 1;
    const int r = path_region[from];
    const int a = axis[r];
    const int sign = hull_depth_sign(to_frame(points[path[from]], a), to_frame(points[path[to]], a),
                                     to_frame(points[ids[i]], a), cut[r], is_planar(a));
    flags[i] = sign > 0 || (keep_on && sign == 0);
    atomic_inc(undecided);
  }
}
