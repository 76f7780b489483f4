// Merges of two triangulations from both ends of their seam at once. One walk goes up from the lower tangent and one
// down from the upper one, each until it is beyond the middle of the seam. Each is Guibas and Stolfi's merge
// (mesh/rings.h), but only reads the rings: it lists the edges that cross the seam, and lists and marks the pairs of
// edges that it would remove. The downward walk is the upward one of the plane turned by half a turn.
//
// They meet, since the crossing edges are the same from both ends, ties included: where candidates of both sides and
// the base are on one circle, the upward walk takes the left one first and the downward walk the right one, which is
// one and the same edge. With RINGS_STOP a walk stops at a predicate that floating point cannot decide, and a program
// without it continues from the last crossing edge; marks are right in any case.
#ifndef FLAUNAY_SEAMS_H
#define FLAUNAY_SEAMS_H

#include "arithmetic/language.h"
#include "blocks/limits.h"
#include "blocks/parts.h"
#include "blocks/records.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"

BEGIN_SHARED

// How a walk has ended: at an edge beyond the middle of the seam, at the other end, or without a result.
INTEGER_CONSTANT(WALK_HAS_CROSSED, 0);
INTEGER_CONSTANT(WALK_IS_WHOLE, 1);
INTEGER_CONSTANT(WALK_HAS_STOPPED, 2);
// For an axis, a point on the cut, from which heights and distances are measured: seen from the input's origin, which
// may be far away, they would be wrong by more than the seam is long. The middle of the seam, and more than the
// rounding errors of heights on it.
typedef struct {
  int axis;
  coordinate2 origin;
  real middle, error;
} seam_line;

// The data of a walk. crossings: per crossing the edge along which the walk came there, and the vertex on the
// other side; the walk itself has the vertices of the first one. removals: the pairs of edges that it removes, each
// once. is_removed: by pair of edges. most: room in both lists.
typedef struct {
  seam_line line;
  int is_downward, most;
  RINGS_MEMORY uchar* is_removed;
  GLOBAL int* removals;
  GLOBAL int2* crossings;
} seam;

// A side of a walk: its vertex on the base, the edge along which the walk came there, and the candidate's edge.
typedef struct {
  int vertex, from, edge, to;
  coordinate_pair at, apex;
  real_pair seen;
  int rises;
} seam_side;

// Along the cut upwards, and across it to the right.
static inline real height_of(coordinate2 p, const seam_line* line) {
  return line->axis ? difference(line->origin.x, p.x) : difference(p.y, line->origin.y);
}
static inline real across(coordinate2 p, const seam_line* line) {
  return line->axis ? difference(p.y, line->origin.y) : difference(p.x, line->origin.x);
}

// The larger of the magnitudes of a half's heights.
static inline real largest_height(const rings* g, hull_ends ends, const seam_line* line) {
  return fmax(fabs(height_of(g->points[first_along(ends, !line->axis)], line)),
              fabs(height_of(g->points[last_along(ends, !line->axis)], line)));
}

// About how high half of the vertices of a half are: where it was cut itself, if that was along the seam; or else in
// the middle of its extent.
static inline real median_height(const rings* g, const halved_blocks* blocks, const part_halves* halves, int is_high,
                                 hull_ends ends, const seam_line* line) {
  const block_part part = halves->part;
  const int depth = part.depth + 1, number = 2 * part.number + is_high, axis = halves->axis;
  int from = first_along(ends, !axis), to = last_along(ends, !axis);
  if (depth < halving_depth(part.count) && blocks->axes[part.first + (1 << depth) + number] != axis) {
    const int above = part.first + part_begin(part.count, depth + 1, 2 * number + 1);
    from = to = first_along(blocks->parts[above / 2].ends, !axis);
  }
  return REAL(0.5) * (height_of(g->points[from], line) + height_of(g->points[to], line));
}

// Heights have some ten roundings, of numbers that are at most twice as large.
#define HEIGHT_ERROR (90 * ROUNDOFF)

static inline seam_line seam_line_of(const rings* g, const halved_blocks* blocks, const part_halves* halves,
                                     hull_ends low, hull_ends high) {
  seam_line line = {halves->axis, g->points[last_along(low, halves->axis)], 0, 0};
  line.middle =
      REAL(0.5) * (median_height(g, blocks, halves, 0, low, &line) + median_height(g, blocks, halves, 1, high, &line));
  line.error = HEIGHT_ERROR * fmax(largest_height(g, low, &line), largest_height(g, high, &line));
  return line;
}

// About how high the line through a point of the low side and one of the high side passes the cut.
static inline real height_at_cut(const seam_line* line, coordinate2 low, coordinate2 high) {
  const real before = -across(low, line), run = before + across(high, line);
  const real share = run > 0 ? before / run : REAL(0.5);
  const real from = height_of(low, line);
  return from + share * (height_of(high, line) - from);
}

// Whether a walk is beyond the middle, whatever the rounding errors. Edges pass the cut in their order, and both walks
// go that far or to the other end; so the last edge of either is one of the other's.
static inline int is_beyond(const seam* s, coordinate2 low, coordinate2 high) {
  const real height = height_at_cut(&s->line, low, high);
  return s->is_downward ? height < s->line.middle - s->line.error : height > s->line.middle + s->line.error;
}

// The edge beyond e in its ring that is not removed.
static inline int kept_beyond(const rings* g, const seam* s, int e, int is_right) {
  do {
    e = is_right ? g->edges[e].previous : g->edges[e].next;
  } while (s->is_removed[e / 2]);
  return e;
}

static inline void set_candidate(const rings* g, seam_side* side, int edge) {
  side->edge = edge;
  side->to = g->edges[edge].to;
  side->apex = point_at(g, side->to);
}

static inline seam_side side_from(const rings* g, const seam* s, int vertex, int from, int is_right) {
  seam_side side;
  side.vertex = vertex;
  side.from = from;
  side.at = point_at(g, vertex);
  set_candidate(g, &side, kept_beyond(g, s, from, is_right));
  return side;
}

static inline void look_at_apex(rings* g, seam_side* side, coordinate_pair left, coordinate_pair right) {
  side->seen = angle_products(side->apex, left, right);
  side->rises = is_above(g, left, right, side->apex, side->seen);
}

// Removes the candidates that the circle through the base and the next one rules out.
static inline void drop_ruled_out(rings* g, const seam* s, seam_walk* walk, seam_side* side, coordinate_pair left,
                                  coordinate_pair right, int is_right) {
  while (side->rises && side->edge != side->from && walk->removals < s->most) {
    const int then = kept_beyond(g, s, side->edge, is_right), beyond_to = g->edges[then].to;
    const coordinate_pair beyond = point_at(g, beyond_to);
    const real_pair seen = angle_products(beyond, left, right);
    if (!rules_out(g, left, right, side->apex, side->seen, beyond, seen)) break;
    TALLY(*g, steps, 1);
    s->is_removed[side->edge / 2] = 1;
    s->removals[walk->removals++] = side->edge / 2;
    side->edge = then;
    side->to = beyond_to;
    side->apex = beyond;
    side->seen = seen;
  }
}

static inline seam_side moved_side(const rings* g, const seam* s, const seam_side* side, int is_right) {
  return side_from(g, s, side->to, side->edge ^ 1, is_right);
}

// The end of a side from which the line to a point of the other side passes the cut lowest, or for a downward
// walk highest.
static inline int lowest_end(const rings* g, const seam* s, hull_ends ends, coordinate2 other, int is_of_high) {
  int lowest = ends.first_x;
  real least = INFINITY;
  for (int k = 0; k < 4; ++k) {
    const int end = k == 0 ? ends.first_x : k == 1 ? ends.last_x : k == 2 ? ends.first_y : ends.last_y;
    const coordinate2 p = g->points[end];
    const real height = is_of_high ? height_at_cut(&s->line, other, p) : height_at_cut(&s->line, p, other);
    const real turned = s->is_downward ? -height : height;
    lowest = turned < least ? end : lowest;
    least = turned < least ? turned : least;
  }
  return lowest;
}

// Moves along the hulls to the tangent that has both sides above it, and of points on it to those next to the cut. They
// may begin anywhere: each move lowers where the line passes the cut, or keeps it and comes nearer to the cut, so none
// comes back. Returns whether it found the tangent.
static inline int find_seam_tangent(rings* g, const seam* s, seam_walk* walk) {
  RINGS_MEMORY const edge_in_rings* edges = g->edges;
  const int axis = s->line.axis;
  walk->left_edge = edges[g->vertex_edge[walk->left]].previous;
  walk->right_edge = g->vertex_edge[walk->right];
  for (int moves = 1; moves;) {
    TALLY(*g, steps, 1);
    const coordinate2 l = g->points[walk->left], r = g->points[walk->right];
    const int left_inner = edges[walk->left_edge].next, right_inner = edges[walk->right_edge].previous;
    const coordinate2 l_outer = g->points[edges[walk->left_edge].to], r_outer = g->points[edges[walk->right_edge].to];
    const coordinate2 l_inner = g->points[edges[left_inner].to], r_inner = g->points[edges[right_inner].to];
    const int left_side = side_of(g, r, l, l_inner), right_side = side_of(g, l, r_inner, r);
    const int left_is_nearer = s->is_downward ? precedes(l_inner, l, axis) : precedes(l, l_inner, axis);
    const int right_is_nearer = s->is_downward ? precedes(r, r_inner, axis) : precedes(r_inner, r, axis);
    if (turns_left_in_merge(g, r, l, l_outer)) {
      walk->left = edges[walk->left_edge].to;
      walk->left_edge = edges[walk->left_edge ^ 1].previous;
    } else if (turns_left_in_merge(g, l, r_outer, r)) {
      walk->right = edges[walk->right_edge].to;
      walk->right_edge = edges[walk->right_edge ^ 1].next;
    } else if (left_side > 0 || (left_side == 0 && left_is_nearer)) {
      walk->left = edges[left_inner].to;
      walk->left_edge = left_inner ^ 1;
    } else if (right_side > 0 || (right_side == 0 && right_is_nearer)) {
      walk->right = edges[right_inner].to;
      walk->right_edge = right_inner ^ 1;
    } else {
      moves = 0;
    }
    if (HAS_STOPPED(g)) return 0;
  }
  return 1;
}

// Walks from the tangent, which it finds from two vertices on, as the plane is turned for this walk; or on from where
// the walk has stopped.
static inline seam_walk walk_along(rings* g, const seam* s, seam_walk walk) {
  if (walk.left_from == NO_EDGE) {
    if (!find_seam_tangent(g, s, &walk)) return walk;
    walk.left_from = walk.left_edge;
    walk.right_from = walk.right_edge;
  }
  seam_side l = side_from(g, s, g->edges[walk.left_from ^ 1].to, walk.left_from, 0);
  seam_side r = side_from(g, s, g->edges[walk.right_from ^ 1].to, walk.right_from, 1);
  for (;;) {
    const coordinate2 low = as_point(s->is_downward ? r.at : l.at), high = as_point(s->is_downward ? l.at : r.at);
    walk.outcome = WALK_HAS_CROSSED;
    if (is_beyond(s, low, high)) return walk;
    TALLY(*g, steps, 1);
    look_at_apex(g, &l, l.at, r.at);
    look_at_apex(g, &r, l.at, r.at);
    walk.outcome = WALK_IS_WHOLE;
    if (!HAS_STOPPED(g) && !l.rises && !r.rises) return walk;
    drop_ruled_out(g, s, &walk, &l, l.at, r.at, 0);
    drop_ruled_out(g, s, &walk, &r, l.at, r.at, 1);
    const int takes_right = !l.rises || (r.rises && rules_out(g, l.at, r.at, l.apex, l.seen, r.apex, r.seen));
    if (HAS_STOPPED(g) || walk.crossings == s->most || walk.removals == s->most) {
      walk.outcome = WALK_HAS_STOPPED;
      walk.left_from = l.from;
      walk.right_from = r.from;
      return walk;
    }
    s->crossings[walk.crossings] = takes_right ? VECTOR(int2, r.edge, l.vertex) : VECTOR(int2, l.edge, r.vertex);
    ++walk.crossings;
    if (takes_right) {
      r = moved_side(g, s, &r, 1);
    } else {
      l = moved_side(g, s, &l, 0);
    }
  }
}

static inline seam_walk walk_from(int left, int right, int crossings, int outcome) {
  const seam_walk walk = {left, right, NO_EDGE, NO_EDGE, NO_EDGE, NO_EDGE, crossings, 0, outcome};
  return walk;
}

// The walk along the seam of two halves, upwards or downwards. before: the same walk if it has stopped above the
// tangent, otherwise a walk without edges. Crossings and removals have room for CROSSINGS_PER_VERTEX per vertex, in its
// place.
static inline seam_walk walk_of_halves(rings* g, const halved_blocks* blocks, const part_halves* halves,
                                       int is_downward, seam_walk before, GLOBAL int2* crossings, GLOBAL int* removals,
                                       RINGS_MEMORY uchar* is_removed) {
  const hull_ends low = blocks->parts[halves->low_at].ends, high = blocks->parts[halves->high_at].ends;
  const int axis = halves->axis, own_list = CROSSINGS_PER_VERTEX * halves->begin;
  g->errors = errors_between(g, joined_ends(g, low, high, axis));
  const seam s = {seam_line_of(g, blocks, halves, low, high),
                  is_downward,
                  CROSSINGS_PER_VERTEX * (halves->end - halves->begin),
                  is_removed,
                  removals + own_list,
                  crossings + own_list};
  if (before.left_from != NO_EDGE) return walk_along(g, &s, before);
  // Upwards is along y, or against x.
  const int lowest = (axis == 1) != is_downward ? last_along(high, !axis) : first_along(high, !axis);
  const int from_low = lowest_end(g, &s, low, g->points[lowest], 0);
  const int from_high = lowest_end(g, &s, high, g->points[from_low], 1);
  const int left = is_downward ? from_high : from_low, right = is_downward ? from_low : from_high;
  return walk_along(g, &s, walk_from(left, right, 1, WALK_HAS_STOPPED));
}

// The crossing edges of two walks, from below: all of the upward walk, then from the downward walk the edges
// before the one at which they met, from the last to the first.
typedef struct {
  int count, middle;  // middle: the first vertex of the high side
  seam_walk up, down;
  GLOBAL const int2* crossings_up;
  GLOBAL const int2* crossings_down;
} whole_seam;

static inline int2 ordered_crossing(int v, int other, int middle) {
  return v < middle ? VECTOR(int2, v, other) : VECTOR(int2, other, v);
}

// The vertices of a walk's k-th crossing edge, on the low side and on the high side.
static inline int2 crossing_of(const seam_walk* walk, GLOBAL const int2* crossings, int k,
                               RINGS_MEMORY const edge_in_rings* edges, int middle) {
  if (k == 0) return ordered_crossing(walk->left, walk->right, middle);
  return ordered_crossing(edges[crossings[k].x].to, crossings[k].y, middle);
}

static inline int2 crossing_at(const whole_seam* s, int i, RINGS_MEMORY const edge_in_rings* edges) {
  return i < s->up.crossings ? crossing_of(&s->up, s->crossings_up, i, edges, s->middle)
                             : crossing_of(&s->down, s->crossings_down, s->count - 1 - i, edges, s->middle);
}

// The edge from a vertex of crossing edge i - 1 to one of i, which has the other vertex in common.
static inline int edge_into(const whole_seam* s, int i) {
  return i < s->up.crossings ? s->crossings_up[i].x : s->crossings_down[s->count - i].x ^ 1;
}

// Whether the downward walk's k-th crossing edge is the last one of the upward walk.
static inline int walks_meet(const whole_seam* s, int k, RINGS_MEMORY const edge_in_rings* edges) {
  const int2 last = crossing_of(&s->up, s->crossings_up, s->up.crossings - 1, edges, s->middle);
  const int2 other = crossing_of(&s->down, s->crossings_down, k, edges, s->middle);
  return last.x == other.x && last.y == other.y;
}

END_SHARED

#endif
