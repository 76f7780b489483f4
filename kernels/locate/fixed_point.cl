// Kernels that locators need in fixed point alone.
//
// Queries that are not on the grid of points (locate/off_grid.h): locate.cl takes each for the place of the grid
// nearest to it, mostly less than one place away. From its answers two kernels go on, with exact predicates alone. Each
// is one pass with one work-item per query, and leaves queries on the grid as they are:
// - locate_off_grid, after find_triangles: a visibility walk from that triangle. Queries beyond the last place are
//   outside of every hull.
// - nearest_off_grid, after nearest_points: greedy steps from that vertex, over a limited number of neighbours.
//
// give_coordinates makes doubles of the samples of levels (levels.cl), as blocks take them.
//
// The programs of devices with double precision have these kernels too, which then do nothing, as every query is on the
// grid.

#include "locate/arguments.h"
#include "locate/nearest_search.h"
#include "locate/off_grid.h"
#include "locate/records.h"
#include "mesh/halfedges.h"
#include "mesh/records.h"
#include "mesh/stars.h"
#include "operations/search.h"
#include "points/records.h"

#ifdef FIXED_POINT

// The triangle that q lies in, the smallest one of several; outside of the hull -1, and so after `most` steps.
static inline int walk_wide(wide2 q, int start, int most, coordinate unit, global const coordinate2* points,
                            global const face* faces, global const int* first_triangle) {
  int t = start;
  for (int step = 0; step <= most; ++step) {
    const face f = faces[t];
    coordinate2 p[3];
    for (int k = 0; k < 3; ++k) p[k] = in_frame(points[f.corner[k]], unit);
    int beyond = -1, zeros = 0, zero = 0, other = 0;
    for (int k = 0; k < 3 && beyond < 0; ++k) {
      const int sign = orient_wide(p[next_corner(k)], p[corner_before(k)], q);
      if (sign < 0) beyond = k;
      if (sign == 0) {
        ++zeros;
        zero = k;
      } else {
        other = k;
      }
    }
    if (beyond < 0) {
      if (zeros == 0) return t;
      if (zeros == 2) return first_triangle[f.corner[other]];
      return f.neighbor[zero] < 0 ? t : min(t, f.neighbor[zero]);
    }
    t = f.neighbor[beyond];
    if (t < 0) return -1;
  }
  return -1;
}

// As is_clear, for a query that is less than one place away in x and in y.
static inline int is_clear_around(int vertex, coordinate2 at, coordinate2 place, coordinate unit,
                                  global const int* clearances) {
  const real2 away = difference2(place, at);
  const real x = fabs(away.x) + UNIT, y = fabs(away.y) + UNIT;
  return 4 * CLEARANCE_MARGIN * (x * x + y * y) < clearance_in_frame(clearances[vertex], unit);
}

// The nearest vertex, by descent from `vertex`; GIVEN_UP if it takes more than `most` neighbours.
#define GIVEN_UP INT_MIN
static inline int descend_wide(wide2 q, coordinate2 place, int vertex, int most, coordinate unit,
                               global const coordinate2* points, global const face* faces,
                               global const int* first_triangle, global const int* clearances) {
  int left = most, best = vertex, before;
  coordinate2 at = in_frame(points[vertex], unit);
  do {
    before = best;
    if (!is_beyond_grid(place) && is_clear_around(best, at, place, unit, clearances)) return best;
    star_walk around = star_begin(before, first_triangle[before]);
    while (star_next(&around, faces)) {
      if (--left < 0) return GIVEN_UP;
      const coordinate2 p = in_frame(points[around.neighbor], unit);
      const int sign = nearness_wide(at, p, q);
      if (sign > 0 || (sign == 0 && comes_before(p, at))) {
        best = around.neighbor;
        at = p;
      }
    }
  } while (best != before);
  return best;
}

// As nearest_on_line.
static inline int nearest_on_line_wide(wide2 q, int first, int end, coordinate unit,
                                       global const coordinate2* hull_points) {
  int low = first, high = end - 1;
  while (low < high) {
    const int middle = low + (high - low) / 2;
    const int sign = nearness_wide(in_frame(hull_points[middle], unit), in_frame(hull_points[middle + 1], unit), q);
    if (sign > 0) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

#endif

// found: of find_triangles, by place. answers: by query.
kernel void locate_off_grid(int n, PLACED_QUERIES(), global const mesh_set* restrict records,
                            global const coordinate* restrict queries, WALKED_MESH(), global const int* restrict found,
                            global int* restrict answers) {
  const int i = get_global_id(0);
  if (i < n) {
    int answer = max(found[i], -1);
#ifdef FIXED_POINT
    const int s = sets > 1 ? segment_of(i, sets, query_offsets) : 0;
    const wide2 q = wide_query(order[i], queries, frames[s].shift);
    if (records[s].triangles > 0 && !is_on_grid(q, placed[i])) {
      const int start = found[i] < 0 ? ~found[i] : found[i];
      answer = is_beyond_grid(placed[i])
                   ? -1
                   : walk_wide(q, start, records[s].triangles, frames[s].unit, points, faces, first_triangle);
    }
#endif
    answers[order[i]] = answer;
  }
}

// nearest: by query; of sets with triangles vertices, which become points. most: neighbours that are looked at; if
// that does not suffice, unanswered[0] is set to 1.
kernel void nearest_off_grid(int n, PLACED_QUERIES(), int most, global const mesh_set* restrict records,
                             global const coordinate* restrict queries, global const coordinate2* restrict points,
                             global const int* restrict source, global const int* restrict clearances,
                             global const face* restrict faces, global const int* restrict first_triangle,
                             global const coordinate2* restrict hull_points, global const int* restrict hull,
                             global int* restrict nearest, global volatile int* restrict unanswered) {
  const int i = get_global_id(0);
  if (i < n) {
    const int s = sets > 1 ? segment_of(i, sets, query_offsets) : 0;
    const mesh_set set = records[s];
    int answer = nearest[order[i]];
#ifdef FIXED_POINT
    const wide2 q = wide_query(order[i], queries, frames[s].shift);
    const coordinate unit = frames[s].unit;
    if (answer >= 0 && !is_on_grid(q, placed[i])) {
      if (set.triangles > 0) {
        answer = descend_wide(q, placed[i], answer, most, unit, points, faces, first_triangle, clearances);
      } else {
        answer = hull[nearest_on_line_wide(q, set.hull, set.hull_end, unit, hull_points)];
      }
    }
    if (answer == GIVEN_UP) atomic_max(unanswered, 1);
#endif
    nearest[order[i]] = answer >= 0 && set.triangles > 0 ? source[answer] : answer;
  }
}

// n coordinates, and the bits of the doubles that they are.
kernel void give_coordinates(int n, global const coordinate* restrict coordinates,
                             global double_bits* restrict doubles) {
  const int i = get_global_id(0);
  if (i < n) doubles[i] = double_bits_of(coordinates[i]);
}
