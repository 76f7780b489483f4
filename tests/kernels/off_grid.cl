// Predicates of queries in fixed point (kernels/locate/off_grid.h, nearness.h), for tests that compare them
// with exact arithmetic. One work-item per case.
#include "locate/off_grid.h"
#include "predicates/nearness.h"

// Cases of 4 coordinates: a, b. queries: as the caller gives them, times 2^shift. placed: the place nearest
// to each. results: per case, orientation and nearness of the query; whether it is on the grid; and if it is,
// orientation and nearness as for all queries on the grid, and nearness by the filter.
kernel void off_grid_cases(int n, int shift, global const coordinate* restrict cases,
                           global const coordinate* restrict queries, global coordinate2* restrict placed,
                           global int* restrict results) {
  const int i = get_global_id(0);
  if (i < n) {
    const coordinate2 a = vload2(2 * i, cases), b = vload2(2 * i + 1, cases);
    const coordinate2 place = grid_point(i, queries, shift);
    const wide2 q = wide_query(i, queries, shift);
    placed[i] = place;
    global int* const result = results + 6 * i;
    result[0] = orient_wide(a, b, q);
    result[1] = nearness_wide(a, b, q);
    result[2] = is_on_grid(q, place);
    result[3] = orient_sign(a, b, place, ORIENT_BOUND);
    result[4] = nearness_sign(a, b, place, NEARNESS_BOUND);
    result[5] = nearness_filtered(a, b, place, NEARNESS_BOUND);
  }
}
