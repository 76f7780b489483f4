// The cells of a Voronoi diagram, clipped to a convex polygon.
//
// A cell's *slots* are the Voronoi edges around its point, counter-clockwise, including edges of length zero;
// an edge that goes to infinity is one. Slots of all cells follow each other in the order of the points. The
// passes:
//
// - locate_centres, over the triangles: which circumcentres lie strictly inside of the polygon; for each other
//   one, an edge of the polygon that it lies on or beyond. mark_flat: which Voronoi edges have length zero.
//   Both look at rounded centres first, whose errors are known.
// - add_open_slots, over the hull: cells on the hull have one slot more than triangles. The host scans the sizes.
//   write_slots, over chunks of triangles, and write_line_slots, over the hulls of sets on one line. The former follows
//   the triangles, since their order keeps neighbours in the plane close in memory, and decides simple cases.
// - clip_slots, over the slots: which part of any other Voronoi edge is inside of the polygon.
// - join_centres, over the points: makes the centres of cocircular triangles the same to the last bit.
// - count_corners, over the slots, and count_whole, over the points: how many corners of the clipped cell
//   belong to each slot. The host scans the counts. find_cells, over the points: where clipped cells begin.
//   write_corners, over the slots: the corners.
// - measure_clipped, over the points: areas and centroids. move_to_centroids: the latter in the place of points.
//
// The polygon has its corners counter-clockwise, and none on the line through its neighbours. All decisions are
// exact: the side of a clip edge on which a circumcentre lies, whether four points are cocircular, and to which
// of two points a clip corner is nearer. Voronoi edges count if they have a part of positive length strictly
// inside of the polygon; see docs/exactness.md. Only coordinates are rounded. Indices that are out of range are
// skipped.

#include "arithmetic/coordinates.h"
#include "arithmetic/records.h"
#include "mesh/halfedges.h"
#include "operations/prefetch.h"
#include "operations/search.h"
#include "predicates/bounds.h"
#include "voronoi/arguments.h"
#include "voronoi/centre_side.h"
#include "voronoi/codes.h"

// As in voronoi.cl.
#define TRIANGLES_AHEAD 32
#define TRIANGLES_AT_ONCE 64
#define WALKS_AHEAD (FETCH_AHEAD / 3 * 2)
// How many slots ahead the centres are fetched.
#define SLOTS_AHEAD 32

static inline double2 corner_of(int i, global const double* corners) { return vload2(i, corners); }
static inline int next_clip_edge(int edge, int clip) { return edge + 1 == clip ? 0 : edge + 1; }

static inline int are_points(int i, int j, int k, int points) {
  return ((uint)i < (uint)points) & ((uint)j < (uint)points) & ((uint)k < (uint)points);
}

// ---------------------------------------------------------------------------------------------------------------------
// Triangles

static inline centre_terms terms_of(int t, global const double* input, global const int* triangles) {
  return centre_terms_of(vload2(triangles[3 * t], input), vload2(triangles[3 * t + 1], input),
                         vload2(triangles[3 * t + 2], input));
}

static inline int side_of_edge(const centre_terms* of, int edge, int clip, global const double* corners,
                               filter_bound bound) {
  return centre_side(of, corner_of(edge, corners), corner_of(next_clip_edge(edge, clip), corners), bound);
}

// STRICTLY_INSIDE, or an edge of the polygon that the centre lies on or beyond. Diagonals from corner 0 cut the polygon
// into triangles, in which it is located by binary search.
static inline int witness_of(const centre_terms* of, int clip, global const double* corners, filter_bound bound) {
  if (side_of_edge(of, 0, clip, corners, bound) <= 0) return 0;
  if (side_of_edge(of, clip - 1, clip, corners, bound) <= 0) return clip - 1;
  int low = 1, high = clip - 1;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (centre_side(of, corner_of(0, corners), corner_of(middle, corners), bound) > 0) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return side_of_edge(of, low, clip, corners, bound) <= 0 ? low : STRICTLY_INSIDE;
}

// Whether a rounded centre is certainly inside, with its errors' bounds. Tests triangles from corner 0, as
// above.
static inline int is_surely_inside(double2 centre, double slack, int clip, global const double* corners) {
  const double2 apex = corner_of(0, corners);
  if (centre_side_rounded(centre, slack, apex, corner_of(1, corners)) <= 0) return 0;
  if (centre_side_rounded(centre, slack, corner_of(clip - 1, corners), apex) <= 0) return 0;
  int low = 1, high = clip - 1;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    const int side = centre_side_rounded(centre, slack, apex, corner_of(middle, corners));
    if (side == 0) return 0;
    if (side > 0) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return centre_side_rounded(centre, slack, corner_of(low, corners), corner_of(high, corners)) > 0;
}

kernel void locate_centres(int n, int points, int clip, filter_bound bound, global const double* restrict corners,
                           global const double* restrict input, global const int* restrict triangles,
                           global const double* restrict centres, global int* restrict witnesses) {
  const int t = get_global_id(0);
  if (t < n) {
    fetch(&input[2 * triangles[3 * min(n - 1, t + TRIANGLES_AHEAD)]]);
    int witness = 0;
    if (are_points(triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2], points)) {
      const double2 centre = vload2(t, centres);
      if (is_surely_inside(centre, centre_slack(centre, vload2(triangles[3 * t], input)), clip, corners)) {
        witness = STRICTLY_INSIDE;
      } else {
        const centre_terms terms = terms_of(t, input, triangles);
        witness = witness_of(&terms, clip, corners, bound);
      }
    }
    witnesses[t] = witness;
  }
}

// Whether triangle t and its neighbour u opposite to corner k have one circle.
static inline int is_one_circle(int t, int k, int u, int points, filter_bound bound, global const double* input,
                                global const int* triangles, global const int* neighbors,
                                global const double* centres) {
  const int a = triangles[3 * t], b = triangles[3 * t + 1], c = triangles[3 * t + 2];
  if (!are_points(a, b, c, points)) return 0;
  const double2 centre = vload2(t, centres), other = vload2(u, centres);
  // A vertex of both.
  const double2 shared = vload2(k == 0 ? b : a, input);
  const double slack = centre_slack(centre, shared) + centre_slack(other, shared);
  if (fabs(centre.x - other.x) + fabs(centre.y - other.y) > slack) return 0;
  global const int* const back = neighbors + 3 * u;
  const int d = triangles[3 * u + (back[0] == t ? 0 : back[1] == t ? 1 : 2)];
  if ((uint)d >= (uint)points) return 0;
  return circle_sign(vload2(a, input), vload2(b, input), vload2(c, input), vload2(d, input), bound) == 0;
}

// flats: gets for each triangle the set of its corners whose opposite triangle has a larger index and the same circle.
kernel void mark_flat(int n, int points, filter_bound bound, global const double* restrict input,
                      global const int* restrict triangles, global const int* restrict neighbors,
                      global const double* restrict centres, global uchar* restrict flats) {
  const int t = get_global_id(0);
  if (t < n) {
    const int ahead = min(n - 1, t + TRIANGLES_AHEAD);
    fetch(&input[2 * triangles[3 * ahead]]);
    fetch(&input[2 * triangles[3 * ahead + 1]]);
    int flat = 0;
    for (int k = 0; k < 3; ++k) {
      const int u = neighbors[3 * t + k];
      if ((u > t) & (u < n) && is_one_circle(t, k, u, points, bound, input, triangles, neighbors, centres))
        flat |= 1 << k;
    }
    flats[t] = (uchar)flat;
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Slots
//
// A slot is a number. Corner c of a triangle: the Voronoi edge from this triangle to the next one around the corner's
// vertex, or to infinity. ~c: the one from infinity to this triangle. ~(3 * triangles + 3 * h + kind): of hull vertex h
// of a set on one line, towards the next or the previous one, or of a vertex that is alone.

#define LINE_NEXT 0
#define LINE_PREVIOUS 1
#define LINE_ALONE 2

// Whether a set's points are on one line, and its hull vertices [first, last).
typedef struct {
  int is_line, first, last;
} hull_part;

static inline hull_part hull_part_of(int i, int sets, global const int* hull_offsets,
                                     global const int* triangle_offsets) {
  const int s = segment_of(i, sets, hull_offsets);
  hull_part part;
  part.is_line = triangle_offsets[s] == triangle_offsets[s + 1];
  part.first = hull_offsets[s];
  part.last = hull_offsets[s + 1];
  return part;
}

static inline uint line_slots(hull_part part, int i) {
  return part.last - part.first == 1 ? 1 : (uint)(i > part.first) + (uint)(i + 1 < part.last);
}

// n hull vertices. sizes: the numbers of the cells' triangles; become the numbers of their slots.
kernel void add_open_slots(int n, int points, int sets, global const int* restrict hull_offsets,
                           global const int* restrict triangle_offsets, global const int* restrict hull,
                           global uint* restrict sizes) {
  const int i = get_global_id(0);
  if (i < n) {
    const hull_part part = hull_part_of(i, sets, hull_offsets, triangle_offsets);
    const int p = hull[i];
    if ((uint)p < (uint)points) sizes[p] += part.is_line ? line_slots(part, i) : 1;
  }
}

// n hull vertices.
kernel void write_line_slots(int n, int points, int sets, int triangle_count, global const int* restrict hull_offsets,
                             global const int* restrict triangle_offsets, global const int* restrict hull,
                             global const uint* restrict offsets, global int* restrict slots) {
  const int i = get_global_id(0);
  if (i < n && (uint)hull[i] < (uint)points) {
    const hull_part part = hull_part_of(i, sets, hull_offsets, triangle_offsets);
    const int slot = 3 * triangle_count + 3 * i;
    uint to = offsets[hull[i]];
    const uint end = offsets[hull[i] + 1];
    if (part.is_line) {
      if (part.last - part.first == 1 && to < end) slots[to++] = ~(slot + LINE_ALONE);
      if (i + 1 < part.last && to < end) slots[to++] = ~(slot + LINE_NEXT);
      if (i > part.first && to < end) slots[to] = ~(slot + LINE_PREVIOUS);
    }
  }
}

// The Voronoi edge between the cells of p and q, with p on its left, from the centre of triangle `tail` to the
// centre of `head`; -1 for infinity. q = p: the vertex is alone, or the slot is empty.
typedef struct {
  int p, q, tail, head;
} voronoi_edge;

static inline voronoi_edge no_edge(int p) {
  const voronoi_edge edge = {p, p, -1, -1};
  return edge;
}

static inline voronoi_edge edge_at_corner(int c, global const int* triangles, global const int* ahead) {
  const int t = c / 3, next = ahead[c];
  const voronoi_edge edge = {triangles[c], triangles[3 * t + corner_before(c - 3 * t)], t, next < 0 ? -1 : next / 3};
  return edge;
}

// Whether the edge from a corner's triangle to that of the next corner around the vertex has length zero.
static inline int is_flat_edge(int c, int next, global const uchar* flats) {
  const int t = c / 3, u = next / 3;
  return t < u ? flats[t] >> next_corner(c - 3 * t) & 1 : flats[u] >> corner_before(next - 3 * u) & 1;
}

static inline voronoi_edge edge_of(int slot, int points, int triangle_count, int hull_count,
                                   global const int* triangles, global const int* ahead, global const int* hull) {
  voronoi_edge edge = no_edge(-1);
  if (slot >= 0) {
    edge = edge_at_corner(slot, triangles, ahead);
  } else if (~slot < 3 * triangle_count) {
    const int c = ~slot, t = c / 3;
    edge.p = triangles[c];
    edge.q = triangles[3 * t + next_corner(c - 3 * t)];
    edge.head = t;
  } else if (~slot < 3 * triangle_count + 3 * hull_count) {
    const int line = ~slot - 3 * triangle_count, h = line / 3, kind = line - 3 * h;
    edge.p = hull[h];
    edge.q = hull[h + (kind == LINE_NEXT) - (kind == LINE_PREVIOUS)];
  }
  if (!are_points(edge.p, edge.q, edge.q, points)) edge = no_edge(-1);
  return edge;
}

// The part of a Voronoi edge inside of the polygon, in one number: the polygon's edge through which the Voronoi
// edge enters and the one through which it leaves, or STRICTLY_INSIDE if it begins or ends inside; whether it
// begins or ends at a Voronoi vertex, which may be on the polygon's edge; whether any part is inside; and
// whether its length is zero.
#define LEAVES_SHIFT CLIP_BITS
#define BEGINS_AT_VERTEX (1u << 2 * CLIP_BITS)
#define ENDS_AT_VERTEX (2u << 2 * CLIP_BITS)
#define IS_KEPT (4u << 2 * CLIP_BITS)
#define IS_FLAT (8u << 2 * CLIP_BITS)
static inline int enters(uint code) { return (int)(code & STRICTLY_INSIDE); }
static inline int leaves(uint code) { return (int)(code >> LEAVES_SHIFT & STRICTLY_INSIDE); }

// The code of the edge at corner c of triangle t if no predicates of the edge are needed: it has length zero,
// or is all inside. 0 for other edges.
static inline uint simple_code(int c, int t, int next, global const uchar* flats, global const int* witnesses) {
  if (next < 0) return 0;
  if (is_flat_edge(c, next, flats)) return IS_FLAT;
  const int is_inside = (witnesses[t] == STRICTLY_INSIDE) & (witnesses[next / 3] == STRICTLY_INSIDE);
  return is_inside ? IS_KEPT | BEGINS_AT_VERTEX | ENDS_AT_VERTEX | STRICTLY_INSIDE | STRICTLY_INSIDE << LEAVES_SHIFT
                   : 0;
}

// n triangles. slots: NO_SLOT throughout; codes: 0 throughout. Others: see write_cells in voronoi.cl.
kernel void write_slots(int n, int chunk, global const int* restrict triangles, global const int* restrict neighbors,
                        global const int* restrict ahead, global const uchar* restrict firsts,
                        global const uchar* restrict flats, global const int* restrict witnesses,
                        global const uint* restrict offsets, global int* restrict slots, global uint* restrict codes) {
  const int c = get_global_id(0);
  if ((int64)c * chunk < n) {
    const int last = (int)min((int64)n, ((int64)c + 1) * chunk);
    for (int begin = c * chunk; begin < last; begin += TRIANGLES_AT_ONCE) {
      const int end = min(last, begin + TRIANGLES_AT_ONCE);
      int corners[3 * TRIANGLES_AT_ONCE + 1];
      int count = 0;
      for (int t = begin; t < end; ++t) {
        fetch(&ahead[3 * min(n - 1, t + WALKS_AHEAD)]);
        for (int k = 0; k < 3; ++k) {
          corners[count] = 3 * t + k;
          count += firsts[t] >> k & 1;
        }
      }
      for (int i = 0; i < count; ++i) fetch(&offsets[triangles[corners[i]]]);
      for (int i = 0; i < count; ++i) {
        fetch(&slots[offsets[triangles[corners[i]]]]);
        fetch(&codes[offsets[triangles[corners[i]]]]);
      }
      for (int i = 0; i < count; ++i) {
        int at = corners[i];
        const int p = triangles[at], t = at / 3;
        const uint end_of_cell = offsets[p + 1];
        uint to = offsets[p];
        if (neighbors[3 * t + corner_before(at - 3 * t)] == -1 && to < end_of_cell) slots[to++] = ~at;
        for (; to < end_of_cell && at >= 0; ++to) {
          const int next = ahead[at];
          slots[to] = at;
          codes[to] = simple_code(at, at / 3, next, flats, witnesses);
          at = next;
        }
      }
    }
  }
}

// The edges through which the bisector of p and q enters and leaves the polygon, with p on its left. It enters where
// corners nearer to p are followed by others, counter-clockwise; if it goes through a corner, that is the end of the
// edge by which it enters, or the beginning of the one by which it leaves. x is -1 if it does not meet the interior.
static inline int2 crossed_edges(double2 p, double2 q, int clip, global const double* corners, filter_bound bound) {
  int2 crossed = VECTOR(int2, -1, -1);
  int is_beyond = 0;
  const int first = nearness_sign(q, p, corner_of(0, corners), bound);
  int sign = first;
  for (int i = 0; i < clip; ++i) {
    const int next = i + 1 == clip ? first : nearness_sign(q, p, corner_of(i + 1, corners), bound);
    if (sign > 0 && next <= 0) crossed.x = i;
    if (sign <= 0 && next > 0) crossed.y = i;
    is_beyond |= sign < 0;
    sign = next;
  }
  if (!is_beyond | (crossed.y < 0)) crossed.x = -1;
  return crossed;
}

static inline int side_of_centre(int t, int edge, int clip, global const double* corners, global const double* input,
                                 global const int* triangles, filter_bound bound) {
  const centre_terms terms = terms_of(t, input, triangles);
  return side_of_edge(&terms, edge, clip, corners, bound);
}

// In the place of the witness of an end at infinity.
#define NO_WITNESS -1
static inline int is_outside(int witness) { return (witness != NO_WITNESS) & (witness != STRICTLY_INSIDE); }

static inline int is_whole(int t, int points, global const int* triangles) {
  return t < 0 || are_points(triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2], points);
}

// n slots. codes: 0 where write_slots has not decided; get the part inside, and stay 0 where nothing is inside.
kernel void clip_slots(int n, CLIPPED_DIAGRAM(), filter_bound side_bound, filter_bound nearness_bound,
                       global const int* restrict witnesses, global const int* restrict slots,
                       global uint* restrict codes) {
  const int i = get_global_id(0);
  if (i < n && codes[i] == 0) {
    const voronoi_edge edge = edge_of(slots[i], points, triangle_count, hull_count, triangles, ahead, hull);
    const int tail = edge.tail >= 0 ? witnesses[edge.tail] : NO_WITNESS;
    const int head = edge.head >= 0 ? witnesses[edge.head] : NO_WITNESS;
    int2 crossed = VECTOR(int2, -1, -1);
    if (edge.p != edge.q && is_whole(edge.tail, points, triangles) && is_whole(edge.head, points, triangles)) {
      // Beyond one edge with both ends, as most edges outside are.
      const int is_beyond =
          is_outside(tail) && is_outside(head) &&
          (tail == head || side_of_centre(edge.head, tail, clip, corners, input, triangles, side_bound) <= 0 ||
           side_of_centre(edge.tail, head, clip, corners, input, triangles, side_bound) <= 0);
      if (!is_beyond)
        crossed = crossed_edges(vload2(edge.p, input), vload2(edge.q, input), clip, corners, nearness_bound);
    }
    if (crossed.x >= 0) {
      int in = crossed.x, out = crossed.y, begins = 0, ends = 0, is_missed = 0;
      // It begins where its line enters, or where its tail is, if that is behind; and ends in the same way. It misses
      // the interior if it begins where its line leaves or behind, or ends where that enters or before.
      if (tail == STRICTLY_INSIDE) {
        in = STRICTLY_INSIDE;
        begins = 1;
      } else if (tail != NO_WITNESS) {
        is_missed |= side_of_centre(edge.tail, crossed.y, clip, corners, input, triangles, side_bound) <= 0;
        begins = side_of_centre(edge.tail, crossed.x, clip, corners, input, triangles, side_bound) == 0;
      }
      if (head == STRICTLY_INSIDE) {
        out = STRICTLY_INSIDE;
        ends = 1;
      } else if (head != NO_WITNESS) {
        is_missed |= side_of_centre(edge.head, crossed.x, clip, corners, input, triangles, side_bound) <= 0;
        ends = side_of_centre(edge.head, crossed.y, clip, corners, input, triangles, side_bound) == 0;
      }
      if (!is_missed) {
        codes[i] = IS_KEPT | (uint)in | (uint)out << LEAVES_SHIFT | (begins ? BEGINS_AT_VERTEX : 0u) |
                   (ends ? ENDS_AT_VERTEX : 0u);
      }
    }
  }
}

// n points. centres: where the circles of triangles in the fan of a cocircular polygon are the same, the centre of the
// first is copied to the others, by its first vertex, which has them all.
kernel void join_centres(int n, global const double* restrict input, global const int* restrict triangles,
                         global const int* restrict ahead, SLOTS(), global double* restrict centres) {
  const int p = get_global_id(0);
  if (p < n) {
    const uint first = offsets[p], end = offsets[p + 1];
    uint sharp = first;
    while (sharp < end && (codes[sharp] & IS_FLAT)) ++sharp;
    for (uint step = 1; sharp < end && step < end - first; ++step) {
      const uint i = sharp + step < end ? sharp + step : sharp + step - (end - first);
      if (!(codes[i] & IS_FLAT)) continue;
      const int c = slots[i], t = c / 3, k = c - 3 * t;
      if (c < 0 || ahead[c] < 0) continue;
      const int q = triangles[3 * t + next_corner(k)], r = triangles[3 * t + corner_before(k)];
      if (!are_points(q, r, r, n)) continue;
      const double2 at = vload2(p, input);
      if (comes_before(at, vload2(q, input)) & comes_before(at, vload2(r, input)))
        vstore2(vload2(t, centres), ahead[c] / 3, centres);
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Corners
//
// A slot with a kept Voronoi edge has the point where that begins; if the cell comes along the polygon to that point,
// also the point where the cell's kept edge before ends, and the polygon's corners between. The first slot of a cell
// without such edges has all corners of the polygon if it lies in the cell.

// The slot of the kept edge before in the cell, and whether all between have length zero.
typedef struct {
  uint slot;
  int joins;
} preceding;

static inline preceding kept_before(uint i, uint first, uint end, global const uint* codes) {
  preceding before;
  before.joins = 1;
  before.slot = i;
  do {
    if (before.slot != i && !(codes[before.slot] & IS_FLAT)) before.joins = 0;
    before.slot = before.slot == first ? end - 1 : before.slot - 1;
  } while (!(codes[before.slot] & IS_KEPT) && before.slot != i);
  return before;
}

// Whether a kept edge begins where the one before ends.
static inline int is_joint(uint code, uint code_before, int joins) {
  return (enters(code) == STRICTLY_INSIDE) | (leaves(code_before) == STRICTLY_INSIDE) |
         (joins && (code_before & ENDS_AT_VERTEX) && (code & BEGINS_AT_VERTEX));
}

static inline uint corners_between(int edge, int other, int clip) {
  return (uint)(other >= edge ? other - edge : other - edge + clip);
}

// n slots. counts: how many corners each has, but for cells without kept edges.
kernel void count_corners(int n, CLIPPED_DIAGRAM(), SLOTS(), global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) {
    const uint code = codes[i];
    uint count = 0;
    if (code & IS_KEPT) {
      count = 1;
      const int p = enters(code) == STRICTLY_INSIDE
                        ? -1
                        : edge_of(slots[i], points, triangle_count, hull_count, triangles, ahead, hull).p;
      // A slot of another cell is in no triangulation.
      if (p >= 0 && offsets[p] <= (uint)i && (uint)i < offsets[p + 1]) {
        const preceding before = kept_before(i, offsets[p], offsets[p + 1], codes);
        const uint code_before = codes[before.slot];
        if (!is_joint(code, code_before, before.joins))
          count = 2 + corners_between(leaves(code_before), enters(code), clip);
      }
    }
    counts[i] = count;
  }
}

// Whether the polygon lies in a cell with slots [first, end), whose edges all miss its interior. If corner 0 is nearer
// to another point it does not, and that is nearly always so.
static inline int is_all_nearest(uint first, uint end, int points, int triangle_count, int hull_count, int clip,
                                 filter_bound bound, global const double* corners, global const double* input,
                                 global const int* triangles, global const int* ahead, global const int* hull,
                                 global const int* slots) {
  for (int k = 0; k < clip; ++k) {
    for (uint i = first; i < end; ++i) {
      const voronoi_edge edge = edge_of(slots[i], points, triangle_count, hull_count, triangles, ahead, hull);
      if (edge.p < 0) return 0;
      if (edge.p != edge.q &&
          nearness_sign(vload2(edge.q, input), vload2(edge.p, input), corner_of(k, corners), bound) < 0)
        return 0;
    }
  }
  return 1;
}

// n points.
kernel void count_whole(int n, CLIPPED_DIAGRAM(), filter_bound nearness_bound, SLOTS(), global uint* restrict counts) {
  const int p = get_global_id(0);
  if (p < n) {
    const uint first = offsets[p], end = offsets[p + 1];
    uint i = first;
    while (i < end && !(codes[i] & IS_KEPT)) ++i;
    if (first < end && i == end &&
        is_all_nearest(first, end, n, triangle_count, hull_count, clip, nearness_bound, corners, input, triangles,
                       ahead, hull, slots))
      counts[first] = (uint)clip;
  }
}

// n points. places: where the corners of each slot begin, and their number. cells: where each cell's corners
// begin.
kernel void find_cells(int n, global const uint* restrict offsets, global const uint* restrict places,
                       global int* restrict cells) {
  const int p = get_global_id(0);
  if (p < n) {
    cells[p] = (int)places[offsets[p]];
    if (p + 1 == n) cells[n] = (int)places[offsets[n]];
  }
}

static inline double clamped(double x, double low, double high) { return min(max(x, low), high); }

// To the box around an edge of the polygon, since rounding may leave it.
static inline double2 clamped_to(double2 at, double2 v, double2 w) {
  return VECTOR(double2, clamped(at.x, min(v.x, w.x), max(v.x, w.x)), clamped(at.y, min(v.y, w.y), max(v.y, w.y)));
}

// Where a Voronoi edge enters or leaves through an edge of the polygon. end: the corner of that edge where it
// may be. centre: a triangle if the point is the centre of its circle, else -1.
static inline double2 point_on_edge(int p, int q, int edge, int end, int centre, int clip, filter_bound bound,
                                    global const double* corners, global const double* input,
                                    global const double* centres) {
  const double2 at_p = vload2(p, input), at_q = vload2(q, input), corner = corner_of(end, corners);
  if (nearness_sign(at_q, at_p, corner, bound) == 0) return corner;
  const double2 v = corner_of(edge, corners), w = corner_of(next_clip_edge(edge, clip), corners);
  return clamped_to(centre >= 0 ? vload2(centre, centres) : bisector_crossing(at_p, at_q, v, w), v, w);
}

static inline double2 unscaled(double2 p, scaling scale) {
  return VECTOR(double2, scaled(p.x, scale), scaled(p.y, scale));
}

// n slots. box: around the polygon. unscale: to the coordinates of the caller.
kernel void write_corners(int n, CLIPPED_DIAGRAM(), filter_bound nearness_bound, vertex_box box, scaling unscale,
                          global const double* restrict centres, SLOTS(), global const uint* restrict places,
                          global double* restrict vertices) {
  const int i = get_global_id(0);
  if (i < n) {
    fetch(&centres[2 * (max(0, slots[min(n - 1, i + SLOTS_AHEAD)]) / 3)]);
    const uint code = codes[i], end = places[i + 1];
    uint to = places[i];
    if (to < end && !(code & IS_KEPT)) {
      for (int k = 0; to < end; ++to, ++k) vstore2(unscaled(corner_of(k, corners), unscale), to, vertices);
    } else if (to < end && enters(code) == STRICTLY_INSIDE) {
      const double2 at = clamped_to(vload2(max(0, slots[i]) / 3, centres), box.low, box.high);
      vstore2(unscaled(at, unscale), to, vertices);
    } else if (to < end) {
      const voronoi_edge edge = edge_of(slots[i], points, triangle_count, hull_count, triangles, ahead, hull);
      if (end - to > 1) {
        const preceding before = kept_before(i, offsets[edge.p], offsets[edge.p + 1], codes);
        const uint code_before = codes[before.slot];
        const int out = leaves(code_before);
        const voronoi_edge other =
            edge_of(slots[before.slot], points, triangle_count, hull_count, triangles, ahead, hull);
        const double2 at = point_on_edge(other.p, other.q, out, out, code_before & ENDS_AT_VERTEX ? other.head : -1,
                                         clip, nearness_bound, corners, input, centres);
        vstore2(unscaled(at, unscale), to++, vertices);
        for (int k = next_clip_edge(out, clip); to + 1 < end; ++to, k = next_clip_edge(k, clip))
          vstore2(unscaled(corner_of(k, corners), unscale), to, vertices);
      }
      const int in = enters(code);
      const double2 at =
          point_on_edge(edge.p, edge.q, in, next_clip_edge(in, clip), code & BEGINS_AT_VERTEX ? edge.tail : -1, clip,
                        nearness_bound, corners, input, centres);
      vstore2(unscaled(at, unscale), to, vertices);
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Measures

static inline int next_around(int i, int first, int end) { return i + 1 == end ? first : i + 1; }

// The lexicographically first corner of a cell. Only the rare case is a branch, which can be predicted.
static inline int lowest_corner(int first, int end, global const double* vertices) {
  int lowest = first;
  double least = vertices[2 * first];
  for (int i = first + 1; i < end; ++i) {
    const double x = vertices[2 * i];
    int is_lower = x < least;
    if (x == least) is_lower = vertices[2 * i + 1] < vertices[2 * lowest + 1];
    lowest = is_lower ? i : lowest;
    least = min(least, x);
  }
  return lowest;
}

// Mostly there is nothing to scale.
static inline double2 scaled_corner(int i, global const double* vertices, scaling scale) {
  const double2 at = vload2(i, vertices);
  return scale.s2 == 1.0 ? at : unscaled(at, scale);
}

// n points. Areas and centroids, relative to a corner of the cell: since cells are convex, all terms are positive but
// for their rounding. Sums begin with the lowest corner, so they do not depend on the order of points. Without a cell,
// the area is 0 and the centroid NaN. scale: the factor with which squares neither overflow nor underflow.
kernel void measure_clipped(int n, scaling scale, scaling unscale, global const int* restrict cells,
                            global const double* restrict vertices, global double* restrict areas,
                            global double* restrict centroids) {
  const int p = get_global_id(0);
  if (p < n) {
    const int first = cells[p], end = cells[p + 1];
    const double none = as_double(0x7ff8000000000000UL);
    double2 centroid = VECTOR(double2, none, none);
    double twice = 0.0;
    if (first < end) {
      const int lowest = lowest_corner(first, end, vertices);
      const double2 origin = scaled_corner(lowest, vertices, scale);
      double2 before = VECTOR(double2, 0.0, 0.0), moment = before, low = before, high = before;
      for (int i = next_around(lowest, first, end); i != lowest; i = next_around(i, first, end)) {
        const double2 at = scaled_corner(i, vertices, scale) - origin;
        const double area = before.x * at.y - before.y * at.x;
        twice += area;
        moment = moment + area * (before + at);
        low.y = min(low.y, at.y);
        high = VECTOR(double2, max(high.x, at.x), max(high.y, at.y));
        before = at;
      }
      // In slender cells, little may be left but rounding. The box holds the centroid in any case.
      centroid = twice > 0.0 ? moment / (3.0 * twice) : 0.5 * (low + high);
      centroid = unscaled(origin + clamped_to(centroid, low, high), unscale);
    }
    areas[p] = scaled(scaled(0.5 * max(twice, 0.0), unscale), unscale);
    vstore2(centroid, p, centroids);
  }
}

// n points. Points with a cell go to its centroid.
kernel void move_to_centroids(int n, global const int* restrict cells, global const double* restrict centroids,
                              global double* restrict points) {
  const int p = get_global_id(0);
  if (p < n && cells[p] < cells[p + 1]) vstore2(vload2(p, centroids), p, points);
}
