// A small region without internal points, triangulated by one work-item. EXACT: 1 to decide exactly where
// floating point cannot, 0 to give up there.
#ifndef FLAUNAY_REGION_TRIANGLES_H
#define FLAUNAY_REGION_TRIANGLES_H

#include "arithmetic/language.h"
#include "flattened/limits.h"
#include "operations/counters.h"
#include "predicates/planar.h"
#include "predicates/records.h"

BEGIN_SHARED

// Corners of the largest region.
#ifndef SMALL_REGION
#define SMALL_REGION DEFAULT_SMALL_REGION
#endif
#define REGION_UNDECIDED -1
#define REGION_BROKEN -2

#if EXACT
#define DECIDE(sign, exact_sign) ((sign) == UNDECIDED ? (exact_sign) : (sign))
#else
#define DECIDE(sign, exact_sign) (sign)
#endif

// A region's border as simple cycles: corner v has vertex ids[v] at p[v]; chain holds one cycle's corners in order.
typedef struct {
  double2 p[SMALL_REGION];
  uchar chain[SMALL_REGION];
  filter_bounds bounds;
  filter_bound angle_bound;
  TALLY_MEMBER
} region_cycle;

static inline double2 on_chain(const region_cycle* g, int k) { return g->p[g->chain[k]]; }

static inline int turn_of(region_cycle* g, double2 a, double2 b, double2 c) {
  TALLY(*g, orientations, 1);
  const int sign = orient_filtered(a, b, c, g->bounds.orient);
  return DECIDE(sign, orient_exact(a, b, c));
}

static inline int in_circle(region_cycle* g, double2 a, double2 b, double2 c, double2 d) {
  TALLY(*g, circles, 1);
  const int sign = circle_filtered(a, b, c, d, g->bounds.circle);
  return DECIDE(sign, circle_undecided(a, b, c, d, g->bounds.circle));
}

// Returns a vertex of the chain i to j, on the circle through the base and `apex`, that no edge of the chain
// hides from the base.
static inline int visible_apex(region_cycle* g, int i, int j, int apex) {
  const double2 a = on_chain(g, j);
  const double2 b = on_chain(g, i);
  uchar on_circle[SMALL_REGION];
  for (int v = i; v <= j; ++v) {
    int on = v == i || v == j || v == apex;
    if (!on) {
      const int turn = turn_of(g, a, b, on_chain(g, v));
      if (turn == UNDECIDED) return REGION_UNDECIDED;
      if (turn > 0) {
        const int inside = in_circle(g, a, b, on_chain(g, apex), on_chain(g, v));
        if (inside == UNDECIDED) return REGION_UNDECIDED;
        on = inside == 0;
      }
    }
    on_circle[v] = on;
  }
  for (int v = i + 1; v < j; ++v) {
    if (!on_circle[v]) continue;
    int hidden = 0;
    for (int e = i; e < j && !hidden; ++e) {
      if (!on_circle[e] || !on_circle[e + 1] || e == v || e + 1 == v) continue;
      const double2 reference = e == i ? a : b;
      const int mine = turn_of(g, on_chain(g, e), on_chain(g, e + 1), on_chain(g, v));
      const int theirs = turn_of(g, on_chain(g, e), on_chain(g, e + 1), reference);
      if (mine == UNDECIDED || theirs == UNDECIDED) return REGION_UNDECIDED;
      hidden = mine * theirs < 0;
    }
    if (!hidden) return v;
  }
  return REGION_BROKEN;
}

// The apex of the triangle on the edge from chain j to chain i, the polygon of i to j on its left: the vertex left of
// it that sees it under the largest angle, which is the one whose circle holds no other.
static inline int apex_of(region_cycle* g, int i, int j) {
  if (j == i + 2) return i + 1;
  const double2 a = on_chain(g, j);
  const double2 b = on_chain(g, i);
  int apex = REGION_BROKEN;
  angle widest;
  int tied = 0;
  for (int v = i + 1; v < j; ++v) {
    const double2 p = on_chain(g, v);
    const angle seen = angle_at(p, a, b);
    TALLY(*g, orientations, 1);
    TALLY(*g, arithmetic, DOT_OPERATIONS);
    const int left = angle_side(seen, g->bounds.orient);
    const int turn = DECIDE(left, orient_exact(a, b, p));
    if (turn == UNDECIDED) return REGION_UNDECIDED;
    if (turn <= 0) continue;
    int wider = 1;
    if (apex >= 0) {
      TALLY(*g, arithmetic, ANGLE_OPERATIONS);
      const int sign = angle_compared(seen, widest, g->angle_bound);
      wider = DECIDE(sign, circle_undecided(a, b, on_chain(g, apex), p, g->angle_bound));
      if (wider == UNDECIDED) return REGION_UNDECIDED;
    }
    if (wider > 0) {
      apex = v;
      widest = seen;
      tied = 0;
    } else if (wider == 0) {
      tied = 1;
    }
  }
  return tied ? visible_apex(g, i, j, apex) : apex;
}

// The triangles of the region with `count` corners, three ids each, into triangles[] (which may be corners[]: it is
// read first and holds count - 2 triangles at least); returns their number, or REGION_UNDECIDED if a predicate was.
//
// The corners link into simple cycles. The triangle on one edge of a cycle leaves two chains, which their own
// edges close to polygons again. Border edges are Delaunay edges, so no vertex in a circle hides behind one;
// but if several vertices are on one circle, some may. A region that is left undecided is not counted.
// O(count^2) predicates at worst.
static inline int region_triangles(GLOBAL const int* corners, int count, GLOBAL const double2* RESTRICT points,
                                   filter_bounds bounds, GLOBAL int* triangles COUNTERS) {
  if (count == 3) {
    const int3 t = VECTOR3(int3, corners[0], corners[1], corners[2]);
    triangles[0] = t.x;
    triangles[1] = t.y;
    triangles[2] = t.z;
    return 1;
  }
  region_cycle g;
  g.bounds = bounds;
  g.angle_bound = angle_bound(bounds.circle);
  CLEAR_TALLY(g);
  int ids[SMALL_REGION];
  uchar after[SMALL_REGION];
  for (int v = 0; v < count; ++v) {
    ids[v] = corners[3 * v + 1];
    g.p[v] = points[ids[v]];
  }
  for (int v = 0; v < count; ++v) {
    const int wanted = corners[3 * v + 2];
    int w = 0;
    while (w < count && (ids[w] != wanted || corners[3 * w] != ids[v])) ++w;
    if (w == count) return REGION_BROKEN;
    after[v] = w;
  }
  uchar emitted[3 * SMALL_REGION];
  uchar2 pending[SMALL_REGION];
  uint64 taken = 0;
  int total = 0;
  for (int start = 0; start < count; ++start) {
    if (taken >> start & 1) continue;
    int length = 0;
    for (int v = start; !(taken >> v & 1); v = after[v]) {
      taken |= (uint64)1 << v;
      g.chain[length++] = v;
    }
    if (length < 3) return REGION_BROKEN;
    int depth = 0;
    pending[depth++] = VECTOR(uchar2, 0, (uchar)(length - 1));
    while (depth > 0) {
      const uchar2 ends = pending[--depth];
      const int apex = apex_of(&g, ends.x, ends.y);
      if (apex < 0) return apex;
      emitted[3 * total] = g.chain[ends.x];
      emitted[3 * total + 1] = g.chain[apex];
      emitted[3 * total + 2] = g.chain[ends.y];
      ++total;
      if (apex - ends.x > 1) pending[depth++] = VECTOR(uchar2, ends.x, (uchar)apex);
      if (ends.y - apex > 1) pending[depth++] = VECTOR(uchar2, (uchar)apex, ends.y);
    }
  }
  COUNT_TALLY(ENDGAME, g);
  for (int k = 0; k < 3 * total; ++k) triangles[k] = ids[emitted[k]];
  return total;
}

END_SHARED

#endif
