// Border merge: every region's path splits its border in two.
//
// A border is an unordered run of corners (before, vertex, after), three ids each, with the interior to the left.
// corner_codes finds each corner's case with filtered predicates; corner_codes_exact decides those left undecided (a
// packed list). corner_counts computes how many corners each child gets from each corner, for a scan; path_internal
// does the same for internal points on the path. children.cl lays out the children, and emit_corners and emit_path
// write their corners. Each kernel is one pass, with one work-item per corner or path vertex.

#include "flattened/arguments.h"
#include "flattened/axes.h"
#include "flattened/codes.h"
#include "operations/counters.h"
#include "operations/prefetch.h"
#include "operations/search.h"
#include "predicates/planar.h"

// A corner's code: the child it goes to (0, 1), if its vertex is off the path; CODE_UNDECIDED; else CODE_ON_PATH and
// how the path's two edges at the vertex lie in the corner's wedge. Angles are counter-clockwise from the edge to
// `after`: to the path's next edge, to its previous one, and to the edge to `before`, which ends the wedge.
#define CODE_NEXT_IS_AFTER 1      // the next edge's angle is 0
#define CODE_PREVIOUS_IS_AFTER 2  // the previous edge's angle is 0
#define CODE_NEXT_IN 4            // the next edge's angle is below the wedge's
#define CODE_PREVIOUS_IN 8        // the previous edge's angle is below the wedge's
#define CODE_NEXT_FIRST 16        // the next edge's angle is below the previous edge's
#define CODE_ON_PATH 32
#define CODE_UNDECIDED FLAG_UNDECIDED

// A vertex of the path with its neighbours on it, in the frame (s, u), for the cut at q. An end of the path has no
// neighbour on one side: id -1.
typedef struct {
  double2 m, previous, next;
  int previous_id, next_id;
  double q;
  TALLY_MEMBER
} path_vertex;

static inline path_vertex path_vertex_at(int place, int first, int last, int a, double q,
                                         global const int* restrict path, global const double2* restrict points) {
  path_vertex v;
  v.q = q;
  v.m = to_frame(points[path[place]], a);
  v.previous_id = place > first ? path[place - 1] : -1;
  v.next_id = place < last ? path[place + 1] : -1;
  v.previous = place > first ? to_frame(points[v.previous_id], a) : VECTOR(double2, 0.0, -INFINITY);
  v.next = place < last ? to_frame(points[v.next_id], a) : VECTOR(double2, 0.0, INFINITY);
  CLEAR_TALLY(v);
  return v;
}

// How many corners ahead of its use a vertex is fetched.
#define CORNERS_AHEAD 24

// Where a corner's edge leaves the path's vertex.
#define EDGE_LEFT 0
#define EDGE_RIGHT 1
#define EDGE_NEXT 2
#define EDGE_PREVIOUS 3
#define EDGE_UNDECIDED 4

// The turn at the path's vertex, b and c.
static inline int turn_at(path_vertex* v, double2 b, double2 c, filter_bound bound, int exact) {
  TALLY(*v, orientations, 1);
  return exact ? orient_exact(v->m, b, c) : orient_filtered(v->m, b, c, bound);
}

// The edge to point x. A point between the neighbours in u is off the path, so that its own side of the cut line is its
// edge's. Beyond them it may be on the path itself, and one neighbour's edge parts its half of the plane. UNDECIDED.
static inline int edge_of(path_vertex* v, int id, double2 x, filter_bound bound, int exact) {
  if (id == v->next_id) return EDGE_NEXT;
  if (id == v->previous_id) return EDGE_PREVIOUS;
  const int is_after = x.y > v->next.y;
  const int is_between = !is_after && x.y >= v->previous.y;
  TALLY(*v, arithmetic, is_between ? 3 : 2);
  if (is_between) return x.x < v->q ? EDGE_LEFT : EDGE_RIGHT;
  const int turn = turn_at(v, is_after ? v->next : v->previous, x, bound, exact);
  if (turn == UNDECIDED) return EDGE_UNDECIDED;
  return (turn > 0) == is_after ? EDGE_LEFT : EDGE_RIGHT;
}

// Whether, of two edges on one side of the path, the first comes first counter-clockwise. UNDECIDED.
static inline int comes_first(path_vertex* v, int side, double2 x, double2 y, filter_bound bound, int exact) {
  TALLY(*v, arithmetic, 2);
  const int x_along = sign_of(x.y - v->m.y);
  const int y_along = sign_of(y.y - v->m.y);
  // The right side is passed from the previous edge to the next one, which is upwards in u; the left side downwards.
  if (x_along != y_along) return (x_along < y_along) == (side == EDGE_RIGHT);
  const int turn = turn_at(v, x, y, bound, exact);
  return turn == UNDECIDED ? UNDECIDED : turn > 0;
}

// The code of a corner on the path, or CODE_UNDECIDED; then the counts in v are dropped, and the exact
// evaluation counts.
static inline int code_on_path(path_vertex* v, int before_id, double2 before, int after_id, double2 after,
                               filter_bound bound, int exact) {
  const int a = edge_of(v, after_id, after, bound, exact);
  const int b = edge_of(v, before_id, before, bound, exact);
  if (a == EDGE_UNDECIDED || b == EDGE_UNDECIDED) return CODE_UNDECIDED;
  // Counter-clockwise from `after`: the right side ends with the next edge, the left side with the previous one.
  const int next_first = a == EDGE_RIGHT || a == EDGE_NEXT;
  int first_in, second_in;
  if (a == b) {
    const int narrow = comes_first(v, a, after, before, bound, exact);
    if (narrow == UNDECIDED) return CODE_UNDECIDED;
    first_in = second_in = !narrow;
  } else {
    first_in = b != (next_first ? EDGE_NEXT : EDGE_PREVIOUS);
    second_in = b == (next_first ? EDGE_RIGHT : EDGE_LEFT);
  }
  const int next_in = next_first ? first_in : second_in;
  const int previous_in = next_first ? second_in : first_in;
  return CODE_ON_PATH | (a == EDGE_NEXT ? CODE_NEXT_IS_AFTER : 0) | (a == EDGE_PREVIOUS ? CODE_PREVIOUS_IS_AFTER : 0) |
         (next_in ? CODE_NEXT_IN : 0) | (previous_in ? CODE_PREVIOUS_IN : 0) | (next_first ? CODE_NEXT_FIRST : 0);
}

// place: the corner's vertex on its region's path, or -1.
// kept[points_count + i]: 0 if it is known that corner i's vertex is not on the path.
kernel void corner_codes(int n, int points_count, filter_bound bound, global const uchar* restrict kept,
                         global const int* restrict corners, global const int* restrict regions, CUTS(), PATHS(),
                         global int* restrict places, global uchar* restrict codes COUNTERS) {
  const int i = get_global_id(0);
  if (i < n) {
    const int r = regions[i];
    const int a = axis[r];
    const int vertex = corners[3 * i + 1];
    const double2 m = to_frame(points[vertex], a);
    if (i + CORNERS_AHEAD < n) fetch(points + corners[3 * (i + CORNERS_AHEAD) + 1]);
    const int first = path_offsets[r];
    const int last = path_offsets[r + 1] - 1;
    const int maybe_on_path = kept[points_count + i];
    const int low = maybe_on_path ? search_path(m.y, first, last, path_projections) : first;
    int place = -1;
    int code;
    COUNT(MERGE, ARITHMETIC, (maybe_on_path ? search_comparisons(last - first + 1) : 0) + (path[low] != vertex));
    if (path[low] == vertex) {
      place = low;
      path_vertex v = path_vertex_at(place, first, last, a, cut[r], path, points);
      const int before = corners[3 * i];
      const int after = corners[3 * i + 2];
      code = code_on_path(&v, before, to_frame(points[before], a), after, to_frame(points[after], a), bound, 0);
      if (code != CODE_UNDECIDED) {
        COUNT_TALLY(MERGE, v);
      }
    } else {
      code = m.x < cut[r] ? SIDE_LEFT : SIDE_RIGHT;
    }
    places[i] = place;
    codes[i] = code;
  }
}

kernel void corner_codes_exact(global const uint* restrict count, global const int* restrict list,
                               global const int* restrict corners, global const int* restrict regions, CUTS(), PATHS(),
                               global const int* restrict places, global uchar* restrict codes COUNTERS) {
  const int length = count[0];
  for (int k = get_global_id(0); k < length; k += get_global_size(0)) {
    const int i = list[k];
    const int r = regions[i];
    const int a = axis[r];
    path_vertex v = path_vertex_at(places[i], path_offsets[r], path_offsets[r + 1] - 1, a, cut[r], path, points);
    const int before = corners[3 * i];
    const int after = corners[3 * i + 2];
    codes[i] = code_on_path(&v, before, to_frame(points[before], a), after, to_frame(points[after], a), 0.0, 1);
    COUNT_TALLY(MERGE, v);
  }
}

// The parts of a corner's wedge in the sector that runs counter-clockwise from path edge `start` to path edge `end`:
// none, one or two corners, as (before, after) pairs.
static inline int wedge_parts(int start_is_after, int end_is_after, int start_in, int end_in, int start_first,
                              int before, int after, int start, int end, int4* parts) {
  const int2 to_end = VECTOR(int2, end_in ? end : before, after);
  if (start_first) {
    if (!start_in) return 0;
    *parts = VECTOR4(int4, to_end.x, start_is_after ? after : start, 0, 0);
    return 1;
  }
  int count = 0;
  if (start_in) {
    *parts = VECTOR4(int4, before, start, to_end.x, to_end.y);
    count = 1;
  } else {
    *parts = VECTOR4(int4, to_end.x, to_end.y, 0, 0);
  }
  return count + !end_is_after;
}

static inline int left_parts(int code, int before, int after, int previous, int next, int4* parts) {
  return wedge_parts((code & CODE_NEXT_IS_AFTER) != 0, (code & CODE_PREVIOUS_IS_AFTER) != 0, (code & CODE_NEXT_IN) != 0,
                     (code & CODE_PREVIOUS_IN) != 0, (code & CODE_NEXT_FIRST) != 0, before, after, next, previous,
                     parts);
}

static inline int right_parts(int code, int before, int after, int previous, int next, int4* parts) {
  return wedge_parts((code & CODE_PREVIOUS_IS_AFTER) != 0, (code & CODE_NEXT_IS_AFTER) != 0,
                     (code & CODE_PREVIOUS_IN) != 0, (code & CODE_NEXT_IN) != 0, (code & CODE_NEXT_FIRST) == 0, before,
                     after, previous, next, parts);
}

// counts[i]: corners that the left and the right child get from corner i.
kernel void corner_counts(int n, global const uchar* restrict codes, global uint2* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) {
    const int code = codes[i];
    uint2 count = VECTOR(uint2, code == SIDE_LEFT, code == SIDE_RIGHT);
    if (code & CODE_ON_PATH) {
      int4 parts;
      count.x = left_parts(code, 0, 0, 0, 0, &parts);
      count.y = right_parts(code, 0, 0, 0, 0, &parts);
    }
    counts[i] = count;
  }
}

// internal[k] = 1 for a path vertex that was an internal point; it becomes a border vertex. n: at least the number of
// path vertices.
kernel void path_internal(int n, int regions, PATHS(), global uchar* restrict side, global uint* restrict internal) {
  const int k = get_global_id(0);
  if (k < n) {
    const int id = k < path_offsets[regions] ? path[k] : -1;
    const int is_internal = id >= 0 && side[id] != SIDE_BORDER;
    internal[k] = is_internal;
    if (is_internal) side[id] = SIDE_BORDER;
  }
}

static inline void put_corner(int child, int to, int before, int vertex, int after, global const int* child_region,
                              global int* corners, global int* corner_region, global int* retired) {
  const int region = child_region[child];
  global int* target = region >= 0 ? corners : retired;
  target[3 * to] = before;
  target[3 * to + 1] = vertex;
  target[3 * to + 2] = after;
  if (region >= 0) corner_region[to] = region;
}

kernel void emit_corners(int n, global const int* restrict old_corners, global const int* restrict regions,
                         global const int* restrict corner_offsets, PATHS(), global const int* restrict places,
                         global const uchar* restrict codes, global const uint2* restrict scanned, CHILDREN()) {
  const int i = get_global_id(0);
  if (i < n) {
    const int r = regions[i];
    const int code = codes[i];
    const int before = old_corners[3 * i];
    const int vertex = old_corners[3 * i + 1];
    const int after = old_corners[3 * i + 2];
    const uint2 rank = scanned[i] - scanned[corner_offsets[r]];
    if (code & CODE_ON_PATH) {
      const int place = places[i];
      const int previous = place > path_offsets[r] ? path[place - 1] : -1;
      const int next = place < path_offsets[r + 1] - 1 ? path[place + 1] : -1;
      for (int side = 0; side < 2; ++side) {
        int4 parts;
        const int count = side ? right_parts(code, before, after, previous, next, &parts)
                               : left_parts(code, before, after, previous, next, &parts);
        const int to = child_base[2 * r + side] + (side ? rank.y : rank.x);
        if (count > 0)
          put_corner(2 * r + side, to, parts.x, vertex, parts.y, child_region, corners, corner_region, retired);
        if (count > 1)
          put_corner(2 * r + side, to + 1, parts.z, vertex, parts.w, child_region, corners, corner_region, retired);
      }
    } else {
      put_corner(2 * r + code, child_base[2 * r + code] + (code ? rank.y : rank.x), before, vertex, after, child_region,
                 corners, corner_region, retired);
    }
  }
}

// An internal point on the path: (previous, m, next) on the left, (next, m, previous) on the right, behind the
// corners that come from corners.
kernel void emit_path(int n, PATHS(), global const int* restrict path_region, global const uint* restrict internal,
                      global const int* restrict corner_offsets, global const uint2* restrict scanned, CHILDREN()) {
  const int k = get_global_id(0);
  if (k < n && internal[k + 1] != internal[k]) {
    const int r = path_region[k];
    const uint2 from_corners = scanned[corner_offsets[r + 1]] - scanned[corner_offsets[r]];
    const int rank = internal[k] - internal[path_offsets[r]];
    put_corner(2 * r, child_base[2 * r] + from_corners.x + rank, path[k - 1], path[k], path[k + 1], child_region,
               corners, corner_region, retired);
    put_corner(2 * r + 1, child_base[2 * r + 1] + from_corners.y + rank, path[k + 1], path[k], path[k - 1],
               child_region, corners, corner_region, retired);
  }
}
