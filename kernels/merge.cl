// Border merge: every region's path splits its border in two.
//
// A border is an unordered run of corners (before, vertex, after), three ids each, interior to the left.
// corner_codes finds each corner's case with filtered predicates, corner_codes_exact those left undecided (a packed
// list); corner_counts says how many corners each child gets from each, for a scan; path_internal does the same for
// internal points on the path. child_sizes and child_places lay out the children, emit_corners and emit_path write
// their corners. One pass each, a work-item a corner (a path vertex, a region).

#include "shared/frame.h"
#include "shared/planar.h"
#include "shared/search.h"

#define SIDE_LEFT 0
#define SIDE_RIGHT 1
#define SIDE_BORDER 2

// A corner's code: the child it goes to (0, 1), if its vertex is off the path; CODE_UNDECIDED; else CODE_ON_PATH and how the path's two edges
// at the vertex lie in the corner's wedge. Angles are counter-clockwise from the edge to `after`: those of the path's
// next edge, of its previous one, and of the edge to `before`, which ends the wedge.
#define CODE_NEXT_IS_AFTER 1      // the next edge's angle is 0
#define CODE_PREVIOUS_IS_AFTER 2  // the previous edge's angle is 0
#define CODE_NEXT_IN 4            // the next edge's angle is below the wedge's
#define CODE_PREVIOUS_IN 8        // the previous edge's angle is below the wedge's
#define CODE_NEXT_FIRST 16        // the next edge's angle is below the previous edge's
#define CODE_ON_PATH 32
#define CODE_UNDECIDED 2

// A direction from a corner's vertex: to a point, or straight up or down along the cut line (id < 0, p.y = +-1)
// where the path ends.
typedef struct {
  int id;
  double2 p;
} direction;

#define DIRECTION_AFTER 0
#define DIRECTION_BEFORE 1
#define DIRECTION_PREVIOUS 2
#define DIRECTION_NEXT 3
#define PAIRS 6

// The turns that decide a corner: (after, before), (after, previous), (after, next), (previous, before), (next,
// before), (next, previous).
static inline int2 pair_of(int k) {
  const int first = k < 3 ? DIRECTION_AFTER : k == 3 ? DIRECTION_PREVIOUS : DIRECTION_NEXT;
  const int second = k == 0 || k == 3 || k == 4 ? DIRECTION_BEFORE
                     : k == 2                   ? DIRECTION_NEXT
                                                : DIRECTION_PREVIOUS;
  return (int2)(first, second);
}

// Turns that need no arithmetic: with a line's end, comparisons; the same point, 0. Else UNDECIDED.
static inline int plain_turn(double2 m, direction f, direction g) {
  if (f.id < 0) return (int)f.p.y * sign_of(m.x - g.p.x);
  if (g.id < 0) return (int)g.p.y * sign_of(f.p.x - m.x);
  return f.id == g.id ? 0 : UNDECIDED;
}

// 0: the direction of `after` itself; 1: to its left; 2: opposite; 3: to its right. Delaunay edges of one direction
// are one edge, so a straight turn to another point is opposite.
static inline int quadrant(int turn, int same) { return turn > 0 ? 1 : turn < 0 ? 3 : same ? 0 : 2; }

static inline int comes_before(int quadrant_f, int quadrant_g, int turn) {
  return quadrant_f != quadrant_g ? quadrant_f < quadrant_g : (quadrant_f & 1) && turn > 0;
}

static inline int code_from_turns(const int* turns, const direction* d) {
  const int before = quadrant(turns[0], 0);
  const int previous = quadrant(turns[1], d[DIRECTION_PREVIOUS].id == d[DIRECTION_AFTER].id);
  const int next = quadrant(turns[2], d[DIRECTION_NEXT].id == d[DIRECTION_AFTER].id);
  int code = CODE_ON_PATH;
  if (next == 0) code |= CODE_NEXT_IS_AFTER;
  if (previous == 0) code |= CODE_PREVIOUS_IS_AFTER;
  if (comes_before(next, before, turns[4])) code |= CODE_NEXT_IN;
  if (comes_before(previous, before, turns[3])) code |= CODE_PREVIOUS_IN;
  if (comes_before(next, previous, turns[5])) code |= CODE_NEXT_FIRST;
  return code;
}

static inline void corner_directions(global const int* restrict corner, int a, int place, int first, int last,
                                     global const int* restrict path, global const double2* restrict path_places,
                                     global const double2* restrict points, direction* d) {
  d[DIRECTION_AFTER].id = corner[2];
  d[DIRECTION_BEFORE].id = corner[0];
  d[DIRECTION_PREVIOUS].id = place > first ? path[place - 1] : -1;
  d[DIRECTION_NEXT].id = place < last ? path[place + 1] : -1;
  d[DIRECTION_AFTER].p = to_frame(points[corner[2]], a);
  d[DIRECTION_BEFORE].p = to_frame(points[corner[0]], a);
  d[DIRECTION_PREVIOUS].p = place > first ? path_places[place - 1] : (double2)(0.0, -1.0);
  d[DIRECTION_NEXT].p = place < last ? path_places[place + 1] : (double2)(0.0, 1.0);
}

// place: the corner's vertex on its region's path, or -1.
// kept[points_count + i]: 0 if prune found that corner i's vertex is not on the path.
kernel void corner_codes(int n, int points_count, double bound, global const uchar* restrict kept,
                         global const int* restrict corners, global const int* restrict regions,
                         global const int* restrict axis, global const double* restrict cut,
                         global const double2* restrict points, global const int* restrict path_offsets,
                         global const int* restrict path, global const double2* restrict path_places,
                         global int* restrict places, global uchar* restrict codes) {
  const int i = get_global_id(0);
  if (i < n) {
    const int r = regions[i];
    const int a = axis[r];
    const int vertex = corners[3 * i + 1];
    const double2 m = to_frame(points[vertex], a);
    const int first = path_offsets[r];
    const int last = path_offsets[r + 1] - 1;
    const int low = kept[points_count + i] ? search_path(m.y, first, last, path_places) : first;
    int place = -1;
    int code = m.x < cut[r] ? SIDE_LEFT : SIDE_RIGHT;
    if (path[low] == vertex) {
      place = low;
      direction d[4];
      corner_directions(corners + 3 * i, a, place, first, last, path, path_places, points, d);
      int turns[PAIRS];
      int undecided = 0;
      for (int k = 0; k < PAIRS; ++k) {
        const int2 pair = pair_of(k);
        turns[k] = plain_turn(m, d[pair.x], d[pair.y]);
        if (turns[k] == UNDECIDED) turns[k] = orient_filtered(m, d[pair.x].p, d[pair.y].p, bound);
        undecided |= turns[k] == UNDECIDED;
      }
      code = undecided ? CODE_UNDECIDED : code_from_turns(turns, d);
    }
    places[i] = place;
    codes[i] = code;
  }
}

kernel void corner_codes_exact(global const uint* restrict count, global const int* restrict list,
                               global const int* restrict corners, global const int* restrict regions,
                               global const int* restrict axis, global const double2* restrict points,
                               global const int* restrict path_offsets, global const int* restrict path,
                               global const double2* restrict path_places, global const int* restrict places,
                               global uchar* restrict codes) {
  const int length = count[0];
  for (int k = get_global_id(0); k < length; k += get_global_size(0)) {
    const int i = list[k];
    const int r = regions[i];
    const int a = axis[r];
    const double2 m = to_frame(points[corners[3 * i + 1]], a);
    direction d[4];
    corner_directions(corners + 3 * i, a, places[i], path_offsets[r], path_offsets[r + 1] - 1, path, path_places, points,
                      d);
    int turns[PAIRS];
    for (int t = 0; t < PAIRS; ++t) {
      const int2 pair = pair_of(t);
      turns[t] = plain_turn(m, d[pair.x], d[pair.y]);
      if (turns[t] == UNDECIDED) turns[t] = orient_exact(m, d[pair.x].p, d[pair.y].p);
    }
    codes[i] = code_from_turns(turns, d);
  }
}

// The parts of a corner's wedge in the sector that runs counter-clockwise from path edge `start` to path edge `end`:
// none, one or two corners, as (before, after) pairs.
static inline int wedge_parts(int start_is_after, int end_is_after, int start_in, int end_in, int start_first,
                              int before, int after, int start, int end, int4* parts) {
  const int2 to_end = (int2)(end_in ? end : before, after);
  if (start_first) {
    if (!start_in) return 0;
    *parts = (int4)(to_end.x, start_is_after ? after : start, 0, 0);
    return 1;
  }
  int count = 0;
  if (start_in) {
    *parts = (int4)(before, start, to_end.x, to_end.y);
    count = 1;
  } else {
    *parts = (int4)(to_end.x, to_end.y, 0, 0);
  }
  return count + !end_is_after;
}

static inline int left_parts(int code, int before, int after, int previous, int next, int4* parts) {
  return wedge_parts((code & CODE_NEXT_IS_AFTER) != 0, (code & CODE_PREVIOUS_IS_AFTER) != 0,
                     (code & CODE_NEXT_IN) != 0, (code & CODE_PREVIOUS_IN) != 0, (code & CODE_NEXT_FIRST) != 0, before,
                     after, next, previous, parts);
}

static inline int right_parts(int code, int before, int after, int previous, int next, int4* parts) {
  return wedge_parts((code & CODE_PREVIOUS_IS_AFTER) != 0, (code & CODE_NEXT_IS_AFTER) != 0,
                     (code & CODE_PREVIOUS_IN) != 0, (code & CODE_NEXT_IN) != 0, (code & CODE_NEXT_FIRST) == 0,
                     before, after, previous, next, parts);
}

// counts[i]: corners that the left and the right child get from corner i.
kernel void corner_counts(int n, global const uchar* restrict codes, global uint2* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) {
    const int code = codes[i];
    uint2 count = (uint2)(code == SIDE_LEFT, code == SIDE_RIGHT);
    if (code & CODE_ON_PATH) {
      int4 parts;
      count.x = left_parts(code, 0, 0, 0, 0, &parts);
      count.y = right_parts(code, 0, 0, 0, 0, &parts);
    }
    counts[i] = count;
  }
}

// internal[k] = 1 for a path vertex that was an internal point; it becomes a border vertex.
kernel void path_internal(int n, global const int* restrict path, global uchar* restrict side,
                          global uint* restrict internal) {
  const int k = get_global_id(0);
  if (k < n) {
    const int id = path[k];
    const int is_internal = side[id] != SIDE_BORDER;
    internal[k] = is_internal;
    if (is_internal) side[id] = SIDE_BORDER;
  }
}

// sizes[2r + side]: (1, corners, points, 0, 0) for a child with internal points, (0, 0, 0, 1, corners) for one that
// retires, 0 for one that is empty; to be scanned.
kernel void child_sizes(int n, global const int* restrict corner_offsets, global const int* restrict path_offsets,
                        global const uint2* restrict points_before,
                        global const uint2* restrict corner_sides, global const uint* restrict internal,
                        global uint8* restrict sizes) {
  const int r = get_global_id(0);
  if (r < n) {
    const uint2 points = points_before[r + 1] - points_before[r];
    uint2 corners = corner_sides[corner_offsets[r + 1]] - corner_sides[corner_offsets[r]];
    corners += internal[path_offsets[r + 1]] - internal[path_offsets[r]];
    for (int side = 0; side < 2; ++side) {
      const uint p = side ? points.y : points.x;
      const uint c = side ? corners.y : corners.x;
      sizes[2 * r + side] =
          p > 0 ? (uint8)(1, c, p, 0, 0, 0, 0, 0) : c > 0 ? (uint8)(0, 0, 0, 1, c, 0, 0, 0) : (uint8)(0);
    }
  }
}

// The same for sets, before the first level: one child each.
kernel void set_sizes(int n, global const int* restrict child_points, global const int* restrict child_corners,
                      global uint8* restrict sizes) {
  const int s = get_global_id(0);
  if (s < n) {
    const uint p = child_points[s];
    const uint c = child_corners[s];
    sizes[s] = p > 0 ? (uint8)(1, c, p, 0, 0, 0, 0, 0) : c > 0 ? (uint8)(0, 0, 0, 1, c, 0, 0, 0) : (uint8)(0);
  }
}

// From the scanned sizes: each child's number as a region (or -1 - its number among the retired), where its corners
// begin, and the offsets of regions and of retired regions, closed by their totals.
kernel void child_places(int n, global const uint8* restrict scanned, global int* restrict child_region,
                         global int* restrict child_base, global int* restrict point_offsets,
                         global int* restrict corner_offsets, global int* restrict retired_offsets) {
  const int c = get_global_id(0);
  if (c < n) {
    const uint8 now = scanned[c];
    const uint8 then = scanned[c + 1];
    if (then.s0 != now.s0) {
      child_region[c] = now.s0;
      child_base[c] = now.s1;
      point_offsets[now.s0] = now.s2;
      corner_offsets[now.s0] = now.s1;
    } else {
      child_region[c] = -1 - (int)now.s3;
      child_base[c] = now.s4;
      if (then.s3 != now.s3) retired_offsets[now.s3] = now.s4;
    }
    if (c == n - 1) {
      point_offsets[then.s0] = then.s2;
      corner_offsets[then.s0] = then.s1;
      retired_offsets[then.s3] = then.s4;
    }
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
                         global const int* restrict corner_offsets, global const int* restrict path,
                         global const int* restrict path_offsets, global const int* restrict places,
                         global const uchar* restrict codes, global const uint2* restrict scanned,
                         global const int* restrict child_region, global const int* restrict child_base,
                         global int* restrict corners, global int* restrict corner_region,
                         global int* restrict retired) {
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
      put_corner(2 * r + code, child_base[2 * r + code] + (code ? rank.y : rank.x), before, vertex, after,
                 child_region, corners, corner_region, retired);
    }
  }
}

// An internal point on the path: (previous, m, next) on the left, (next, m, previous) on the right, behind the
// corners that come from corners.
kernel void emit_path(int n, global const int* restrict path, global const int* restrict path_region,
                      global const int* restrict path_offsets, global const uint* restrict internal,
                      global const int* restrict corner_offsets, global const uint2* restrict scanned,
                      global const int* restrict child_region, global const int* restrict child_base,
                      global int* restrict corners, global int* restrict corner_region,
                      global int* restrict retired) {
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
