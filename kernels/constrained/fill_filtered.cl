// Fills the cavities of constraints as fill_cavities does (constrained/insert.cl), but by floating point alone, so that
// no exact predicate takes registers: one pass over many winners. Few are left for fill_cavities.

#define CAVITIES_STOP
#include "constrained/arguments.h"
#include "constrained/cavities.h"
#include "constrained/codes.h"
#include "constrained/records.h"

kernel void fill_filtered(int n, uint mark, filter_bound bound, global const int* restrict list,
                          global const uint* restrict offsets, global uchar* restrict outcomes,
                          global const int* restrict lefts, global const constraint_walk* restrict walks,
                          global const coordinate* restrict points, REBUILT_ROWS()) {
  const int i = get_global_id(0);
  if (i < n && outcomes[i] == CONSTRAINT_FITS) {
    const replaced_rows rows = {triangles, neighbors, claims, flags, changed, new_corners, mark};
    if (fill_cavity(walks[list[i]], lefts[i], entries + offsets[i], points, bound, &rows)) {
      outcomes[i] = CONSTRAINT_FILLED;
    }
  }
}
