// The shared predicates on arrays of cases, one case a work-item, for predicates_test.cpp.
//
// A case is its points' coordinates one after the other (and the cut). The filters' bounds come from the
// host, as they do in the library; 0 is for coarse input. The signs: -1, 0, 1 or UNDECIDED.

#include "flattened/hull_height.h"
#include "predicates/nearness.h"
#include "predicates/planar.h"

// Cases of 7: a, b, p, cut. The filter is that of hull_depths in quickhull.cl.
kernel void hull_filtered(int n, int axis, filter_bound bound, global const double* restrict cases,
                          global double* restrict depth, global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* c = cases + 7 * i;
    const int planar = is_planar(axis);
    const double2 d = hull_depth(project(to_frame((double2)(c[0], c[1]), axis), c[6], planar),
                                 project(to_frame((double2)(c[2], c[3]), axis), c[6], planar),
                                 project(to_frame((double2)(c[4], c[5]), axis), c[6], planar), planar);
    const double error = bound * d.y;
    depth[i] = d.x;
    signs[i] = d.x > error ? 1 : d.x < -error ? -1 : bound == 0.0 ? 0 : UNDECIDED;
  }
}

kernel void hull_exact(int n, int axis, global const double* restrict cases, global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* c = cases + 7 * i;
    signs[i] = hull_depth_sign(to_frame((double2)(c[0], c[1]), axis), to_frame((double2)(c[2], c[3]), axis),
                               to_frame((double2)(c[4], c[5]), axis), c[6], is_planar(axis));
  }
}

// Cases of 5: p, v, cut.
kernel void lower_cases(int n, int axis, global const double* restrict cases, global char* restrict lower) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* c = cases + 5 * i;
    lower[i] = is_lower(to_frame((double2)(c[0], c[1]), axis), to_frame((double2)(c[2], c[3]), axis), c[4],
                        is_planar(axis));
  }
}

// Cases of 6: a, b, c.
kernel void orient_filtered_cases(int n, filter_bound bound, global const double* restrict cases,
                                  global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* c = cases + 6 * i;
    signs[i] = orient_filtered((double2)(c[0], c[1]), (double2)(c[2], c[3]), (double2)(c[4], c[5]), bound);
  }
}

kernel void orient_exact_cases(int n, global const double* restrict cases, global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* c = cases + 6 * i;
    signs[i] = orient_exact((double2)(c[0], c[1]), (double2)(c[2], c[3]), (double2)(c[4], c[5]));
  }
}

// Cases of 8: a, b, c, d.
kernel void circle_filtered_cases(int n, filter_bound bound, global const double* restrict cases,
                                  global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* c = cases + 8 * i;
    signs[i] = circle_filtered((double2)(c[0], c[1]), (double2)(c[2], c[3]), (double2)(c[4], c[5]),
                               (double2)(c[6], c[7]), bound);
  }
}

// In-circle signs by the angles under which c and d see the edge from a to b. bound: of the in-circle test.
kernel void angle_compared_cases(int n, filter_bound bound, global const double* restrict cases,
                                 global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* c = cases + 8 * i;
    const double2 a = (double2)(c[0], c[1]);
    const double2 b = (double2)(c[2], c[3]);
    signs[i] = angle_compared(angle_at((double2)(c[6], c[7]), a, b), angle_at((double2)(c[4], c[5]), a, b),
                              angle_bound(bound));
  }
}

// The exact sign; WRONG if circle_undecided has another one of a case that a filter leaves to it.
#define WRONG 3
kernel void circle_exact_cases(int n, global const double* restrict cases, global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    const double2 a = vload2(4 * i, cases), b = vload2(4 * i + 1, cases);
    const double2 c = vload2(4 * i + 2, cases), d = vload2(4 * i + 3, cases);
    const int sign = circle_exact(a, b, c, d);
    const int is_undecided = circle_filtered(a, b, c, d, CIRCLE_BOUND) == UNDECIDED ||
                             angle_compared(angle_at(d, a, b), angle_at(c, a, b), ANGLE_BOUND) == UNDECIDED;
    signs[i] = is_undecided && circle_undecided(a, b, c, d, CIRCLE_BOUND) != sign ? WRONG : sign;
  }
}

kernel void circle_canonical_cases(int n, filter_bound bound, global const double* restrict cases,
                                   global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* c = cases + 8 * i;
    signs[i] = circle_canonical((double2)(c[0], c[1]), (double2)(c[2], c[3]), (double2)(c[4], c[5]),
                                (double2)(c[6], c[7]), bound);
  }
}

// Cases of 6: a, b, q.
kernel void nearness_filtered_cases(int n, filter_bound bound, global const double* restrict cases,
                                    global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* c = cases + 6 * i;
    signs[i] = nearness_filtered((double2)(c[0], c[1]), (double2)(c[2], c[3]), (double2)(c[4], c[5]), bound);
  }
}

kernel void nearness_exact_cases(int n, global const double* restrict cases, global char* restrict signs) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* c = cases + 6 * i;
    signs[i] = nearness_exact((double2)(c[0], c[1]), (double2)(c[2], c[3]), (double2)(c[4], c[5]));
  }
}
