// Chains: the strict lower hulls of all regions at once, as paths in the order of u, without rounds.
//
// A region's internal points are sorted along its cut line. thin_lists takes the lowest point of each of equal parts of
// a region's list, and repeats this with the lists that it makes, until they are short. The hull of the
// shortest lists prunes the lists before (prune.cl); the hull of the remaining points and of that hull's own
// vertices prunes the lists before these, and so on up to the level's points and corners. Any path through some
// of a region's points, with its ends, can prune, so only the hull itself need be decided exactly. A step is:
//
// 1. sequence_of_lists lays out the shortest lists between the ends of their regions' hulls. Later steps have
//    three kinds of elements, each in the order of (region, u): the path's vertices, the internal points that
//    prune kept, and the corners that it kept. keep_bounds finds where regions begin among them.
//    gather_kept_corners and place_kept_corners put corners in order, or merge_corner_runs does where regions
//    have many. join_sequences merges the three: each element's place is the number of elements before it,
//    which it finds by binary searches.
// 2. hull_chains makes the hull of each region's sequence. A work-group takes a region; each work-item makes the hull
//    of consecutive points by a monotone chain, and neighbouring hulls are joined along their common tangent, in steps
//    that each halve their number. The tangent is found by a search for its left end; each probe is a
//    binary search for the right one; the work-items of both hulls take a probe each, and one of them goes on alone.
// 3. A scan (scan.cl) of the hulls' sizes tells where paths begin, and write_paths writes them.
//
// Where regions are small, hulls_alone does the first two alone, from all of a region's points.
//
// The kernels but hull_chains and write_paths have one work-item per element, or share elements whose number only the
// device knows.

#include "flattened/arguments.h"
#include "flattened/axes.h"
#include "flattened/codes.h"
#include "flattened/hull_height.h"
#include "flattened/limits.h"
#include "operations/limits.h"
#include "operations/prefetch.h"
#include "operations/search.h"

// Where the list of region r begins that is made of lists with these offsets: a place for each BUCKET points and one
// for the rest, so that no list is empty.
static inline int thin_begin(int r, global const int* offsets) { return offsets[r] / BUCKET + r; }

// The region that has place i of the thin lists.
static inline int thin_region(int i, int regions, global const int* offsets) {
  int low = 0, high = regions;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    if (thin_begin(middle, offsets) <= i) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}

// Place i gets the lowest of its part of the region's list, the first of several. Parts are as equal as they can be; if
// there are fewer points than places, points are taken twice. Without internal points it gets the first end of the
// region's hull, which is -1 for a set without points.
kernel void thin_lists(int n, int regions, global const int* restrict offsets, LISTS(),
                       global const double2* restrict projections, global const int* restrict axis,
                       global const int* restrict first_end, global int* restrict thin_offsets,
                       global int* restrict thin_ids, global int* restrict thin_regions,
                       global double2* restrict thin_projections) {
  const int i = get_global_id(0);
  if (i < n) {
    const int r = thin_region(i, regions, offsets);
    const int place = thin_begin(r, offsets);
    const int places = thin_begin(r + 1, offsets) - place;
    const int low = offsets[r];
    const int count = offsets[r + 1] - low;
    const int begin = low + (int)((int64)count * (i - place) / places);
    const int end = low + (int)((int64)count * (i - place + 1) / places);
    int id = first_end[r];
    double2 lowest = VECTOR(double2, 0.0, 0.0);
    if (count > 0) {
      int best = min(begin, low + count - 1);
      lowest = projections[best];
      for (int k = best + 1; k < end; ++k) {
        const double2 p = projections[k];
        if (p.x < lowest.x) {
          lowest = p;
          best = k;
        }
      }
      id = axis[r] == AXIS_Y ? x_list[best] : y_list[best];
    }
    thin_ids[i] = id;
    thin_regions[i] = r;
    thin_projections[i] = lowest;
    if (i == place) thin_offsets[r] = i;
    if (i == n - 1) thin_offsets[regions] = n;
  }
}

// The list of a region whose axis is AXIS_Y descends in u; all others ascend.
static inline int rank_in_list(int i, int low, int high, int axis) { return axis == AXIS_Y ? high - 1 - i : i - low; }

// A region's list, which has at least one element, between the two ends of its hull. A set without points has no ends:
// they are -1, as is all of its list.
kernel void sequence_of_lists(int n, global const int* restrict offsets, global const int* restrict list,
                              global const int* restrict regions, global const double2* restrict list_projections,
                              global const int* restrict first_end, global const int* restrict last_end, CUTS(),
                              global int* restrict begins, global int* restrict ids,
                              global double2* restrict projections COUNTERS) {
  const int i = get_global_id(0);
  if (i < n) {
    const int r = regions[i];
    const int low = offsets[r];
    const int high = offsets[r + 1];
    const int begin = low + 2 * r;
    const int to = begin + 1 + rank_in_list(i, low, high, axis[r]);
    ids[to] = list[i];
    projections[to] = list_projections[i];
    if (i == low) {
      begins[r] = begin;
      for (int side = 0; side < 2; ++side) {
        const int id = side ? last_end[r] : first_end[r];
        const int place = side ? high + 2 * r + 1 : begin;
        ids[place] = id;
        projections[place] =
            id < 0 ? VECTOR(double2, 0.0, 0.0) : project(to_frame(points[id], axis[r]), cut[r], is_planar(axis[r]));
      }
    }
    if (i == n - 1) begins[r + 1] = high + 2 * r + 2;
  }
}

// positions: of the kept elements among all. before[r]: the numbers of kept internal points and of kept corners of the
// regions before r; begins[r]: with the paths of those. facts: see codes.h; 0 before.
kernel void keep_bounds(int n, int points_count, global const uint* restrict kept_count,
                        global const int* restrict positions, global const int* restrict point_offsets,
                        global const int* restrict corner_offsets, global const int* restrict path_offsets,
                        global int2* restrict before, global int* restrict begins,
                        global volatile int* restrict facts) {
  const int r = get_global_id(0);
  if (r <= n) {
    const int kept = kept_count[0];
    const int point_count = positions_below(point_offsets[r], kept, positions);
    const int all_points = positions_below(points_count, kept, positions);
    // Without kept corners there is nothing to look for.
    const int has_corners = all_points < kept;
    const int corner_count =
        has_corners ? positions_below(points_count + corner_offsets[r], kept, positions) - all_points : 0;
    before[r] = VECTOR(int2, point_count, corner_count);
    begins[r] = path_offsets[r] + point_count + corner_count;
    if (r == n) {
      facts[KEPT_ALL] = path_offsets[r] + point_count + corner_count;
      facts[KEPT_CORNERS] = corner_count;
    } else if (has_corners) {
      const int own = positions_below(points_count + corner_offsets[r + 1], kept, positions) - all_points;
      if (own > corner_count) atomic_max(&facts[KEPT_CORNERS_MOST], own - corner_count);
    }
  }
}

// The kept corners' vertices, as they come.
kernel void gather_kept_corners(int n, int regions, int points_count, global const int2* restrict before,
                                global const int* restrict positions, global const int* restrict corner_regions,
                                global const int* restrict corners, CUTS(), NEW_CORNERS() COUNTERS) {
  const int c = get_global_id(0);
  if (c < n) {
    const int corner = positions[before[regions].x + c] - points_count;
    const int id = corners[3 * corner + 1];
    const int r = corner_regions[corner];
    new_ids[c] = id;
    new_owners[c] = r;
    new_projections[c] = project(to_frame(points[id], axis[r]), cut[r], is_planar(axis[r]));
  }
}

// In the order of (region, u), where no region has many.
kernel void place_kept_corners(int n, global const int2* restrict before, CORNERS_TO_JOIN(), NEW_CORNERS()) {
  const int c = get_global_id(0);
  if (c < n) {
    const int r = corner_owners[c];
    const int begin = before[r].y;
    const int end = before[r + 1].y;
    const double2 p = corner_projections[c];
    int to = begin;
    for (int k = begin; k < end; ++k) to += corner_projections[k].y < p.y || (k < c && corner_projections[k].y == p.y);
    new_ids[to] = corner_ids[c];
    new_owners[to] = r;
    new_projections[to] = p;
  }
}

// Merges MERGED_RUNS runs, each in the order of (region, u), into one.
kernel void merge_corner_runs(int n, int run, CORNERS_TO_JOIN(), NEW_CORNERS()) {
  const int c = get_global_id(0);
  if (c < n) {
    const int r = corner_owners[c];
    const double2 p = corner_projections[c];
    const int own = c / run;
    const int first = own - own % MERGED_RUNS;
    int to = c;
    for (int other = first; other < first + MERGED_RUNS; ++other) {
      if (other == own || (int64)other * run >= n) continue;
      const int begin = other * run;
      int low = begin, high = min(n, begin + run);
      while (low < high) {
        const int middle = low + (high - low) / 2;
        const int s = corner_owners[middle];
        const double u = corner_projections[middle].y;
        const int is_before = s != r ? s < r : u != p.y ? u < p.y : other < own;
        if (is_before) {
          low = middle + 1;
        } else {
          high = middle;
        }
      }
      // Elements of runs before this one are before it already.
      to += other < own ? low - min(n, begin + run) : low - begin;
    }
    new_ids[to] = corner_ids[c];
    new_owners[to] = r;
    new_projections[to] = p;
  }
}

// How many elements of [low, high), ascending in u, are before u, or have it and are to be counted too.
static inline int count_before(double u, int with_equal, int low, int high, global const double2* projections) {
  const int begin = low;
  while (low < high) {
    const int middle = low + (high - low) / 2;
    const double other = projections[middle].y;
    if (other < u || (with_equal && other == u)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low - begin;
}

// How many of a region's kept internal points, whose list may descend, are before u, or with it.
static inline int count_kept_before(double u, int with_equal, int low, int high, int axis, global const int* positions,
                                    global const double2* projections) {
  int least = 0, most = high - low;
  while (least < most) {
    const int middle = least + (most - least) / 2;
    const double other = projections[positions[axis == AXIS_Y ? high - 1 - middle : low + middle]].y;
    if (other < u || (with_equal && other == u)) {
      least = middle + 1;
    } else {
      most = middle;
    }
  }
  return least;
}

// If u is equal, path vertices come first, then internal points, then corners.
kernel void join_sequences(int regions_count, global const int2* restrict before, global const int* restrict begins,
                           global const int* restrict positions, global const int* restrict regions, LISTS(),
                           global const double2* restrict point_projections, global const int* restrict axis, PATHS(),
                           global const int* restrict path_regions, CORNERS_TO_JOIN(), global int* restrict ids,
                           global double2* restrict projections) {
  const int vertices = path_offsets[regions_count];
  const int kept = before[regions_count].x;
  const int all = begins[regions_count];
  for (int k = get_global_id(0); k < all; k += get_global_size(0)) {
    const int is_vertex = k < vertices;
    const int is_corner = k >= vertices + kept;
    const int own = is_vertex ? k : is_corner ? k - vertices - kept : k - vertices;
    const int i = is_vertex || is_corner ? own : positions[own];
    const int r = is_vertex ? path_regions[i] : is_corner ? corner_owners[i] : regions[i];
    const int a = axis[r];
    const double2 p = is_vertex ? path_projections[i] : is_corner ? corner_projections[i] : point_projections[i];
    const int2 low = before[r];
    const int2 high = before[r + 1];
    const int path_low = path_offsets[r];
    int to = begins[r];
    to += is_vertex ? i - path_low : count_before(p.y, 1, path_low, path_offsets[r + 1], path_projections);
    to += is_vertex || is_corner ? count_kept_before(p.y, is_corner, low.x, high.x, a, positions, point_projections)
                                 : rank_in_list(own, low.x, high.x, a);
    to += is_corner ? i - low.y : count_before(p.y, 0, low.y, high.y, corner_projections);
    ids[to] = is_vertex ? path[i] : is_corner ? corner_ids[i] : a == AXIS_Y ? x_list[i] : y_list[i];
    projections[to] = p;
  }
}

// A region's points in the order of u. hull_frame: the data by which their hull is decided.
typedef struct {
  global int* ids;
  global double2* projections;
} sequence;

typedef struct {
  int axis;
  double cut, bound;
  global const double2* points;
  uint undecided;  // predicates that were evaluated exactly
  TALLY_MEMBER
} hull_frame;

// The sign of how far element p is below the chord from element a to element b, whose u ascend.
static inline int below_chord(hull_frame* frame, int a, double2 pa, int b, double2 pb, int p, double2 pp COUNTERS) {
  TALLY(*frame, steps, 1);
  const int planar = is_planar(frame->axis);
  const double2 d = hull_depth(pa, pb, pp, planar);
  const double error = frame->bound * d.y;
  if (d.x > error) return 1;
  if (d.x < -error) return -1;
  if (frame->bound == 0.0) return 0;
  ++frame->undecided;
  return hull_depth_sign(to_frame(frame->points[a], frame->axis), to_frame(frame->points[b], frame->axis),
                         to_frame(frame->points[p], frame->axis), frame->cut, planar);
}

// Whether, of two elements of one u, p is another point than v, and lower.
static inline int is_lower_of_column(const hull_frame* frame, int p, int v) {
  return p != v && is_lower(to_frame(frame->points[p], frame->axis), to_frame(frame->points[v], frame->axis),
                            frame->cut, is_planar(frame->axis));
}

// Replaces elements [begin, end) by their hull, from begin on. Returns its size.
static inline int chain_of(hull_frame* frame, sequence s, int begin, int end COUNTERS) {
  int size = 0;
  for (int i = begin; i < end; ++i) {
    const int id = s.ids[i];
    const double2 p = s.projections[i];
    if (size > 0 && s.projections[begin + size - 1].y == p.y) {
      if (!is_lower_of_column(frame, id, s.ids[begin + size - 1])) continue;
      --size;
    }
    for (; size >= 2; --size) {
      const int top = begin + size - 1;
      if (below_chord(frame, s.ids[top - 1], s.projections[top - 1], id, p, s.ids[top],
                      s.projections[top] WITH_COUNTERS) > 0)
        break;
    }
    s.ids[begin + size] = id;
    s.projections[begin + size] = p;
    ++size;
  }
  return size;
}

// The first element of the hull [right, right_end) that the tangent from the point touches: later ones are
// above it.
static inline int tangent_from(hull_frame* frame, sequence s, int id, double2 p, int right, int right_end COUNTERS) {
  int low = right, high = right_end - 1;
  while (low < high) {
    const int middle = low + (high - low) / 2;
    if (below_chord(frame, id, p, s.ids[middle + 1], s.projections[middle + 1], s.ids[middle],
                    s.projections[middle] WITH_COUNTERS) > 0) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

// Two neighbouring hulls [left, left_end) and [right, right_end).
typedef struct {
  int left, left_end, right, right_end;
} hull_pair;

// The pair without the higher of two vertices of one u that would stand side by side.
static inline hull_pair without_column(const hull_frame* frame, sequence s, hull_pair pair) {
  if (pair.left < pair.left_end && pair.right < pair.right_end &&
      s.projections[pair.left_end - 1].y == s.projections[pair.right].y) {
    if (is_lower_of_column(frame, s.ids[pair.right], s.ids[pair.left_end - 1])) {
      --pair.left_end;
    } else {
      ++pair.right;
    }
  }
  return pair;
}

// Whether vertex i of the left hull is the left end of the common tangent or behind it: the tangent from there to the
// right hull is not above its successor.
static inline int is_past(hull_frame* frame, sequence s, int i, hull_pair pair COUNTERS) {
  if (i == pair.left_end - 1) return 1;
  const int id = s.ids[i];
  const double2 p = s.projections[i];
  const int touched = tangent_from(frame, s, id, p, pair.right, pair.right_end WITH_COUNTERS);
  return below_chord(frame, id, p, s.ids[touched], s.projections[touched], s.ids[i + 1],
                     s.projections[i + 1] WITH_COUNTERS) <= 0;
}

// The first such vertex of [low, high]; high is one.
static inline int first_past(hull_frame* frame, sequence s, int low, int high, hull_pair pair COUNTERS) {
  while (low < high) {
    const int middle = low + (high - low) / 2;
    if (is_past(frame, s, middle, pair WITH_COUNTERS)) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

// A work-group takes a region. The sequences become the hulls; other_ids and other_projections are as large as they
// are.
kernel void hull_chains(int regions, filter_bound bound, global const int* restrict begins, CUTS(), global int* ids,
                        global double2* projections, global int* other_ids, global double2* other_projections,
                        global uint* restrict sizes, global volatile uint* restrict undecided COUNTERS) {
  local int hull_size[LARGEST_TILE_GROUP], kept_left[LARGEST_TILE_GROUP], first_right[LARGEST_TILE_GROUP];
  local int past[LARGEST_TILE_GROUP];
  const int r = get_group_id(0), me = get_local_id(0), group = get_local_size(0);
  const int begin = r < regions ? begins[r] : 0;
  const int count = r < regions ? begins[r + 1] - begin : 0;
  const int piece = (count + group - 1) / group;
  hull_frame frame;
  frame.axis = axis[min(r, regions - 1)];
  frame.cut = cut[min(r, regions - 1)];
  frame.bound = bound;
  frame.points = points;
  frame.undecided = 0;
  CLEAR_TALLY(frame);
  sequence now = {ids, projections};
  sequence then = {other_ids, other_projections};
  hull_size[me] =
      chain_of(&frame, now, begin + min(count, me * piece), begin + min(count, (me + 1) * piece) WITH_COUNTERS);
  barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
  for (int runs = 1; runs < group; runs *= 2) {
    // The hulls of pieces [first, second) and [second, second + runs) are joined by the work-items of these pieces.
    const int first = me - me % (2 * runs);
    const int second = first + runs;
    const int items = min(2 * runs, group - first);
    hull_pair pair;
    pair.left = begin + min(count, first * piece);
    pair.left_end = pair.left + hull_size[first];
    pair.right = begin + min(count, second * piece);
    pair.right_end = pair.right + (second < group ? hull_size[second] : 0);
    pair = without_column(&frame, now, pair);
    // Each work-item looks at one vertex of the left hull. The one that finds the first that is past searches before
    // it.
    const int left_size = pair.left_end - pair.left;
    const int has_tangent = left_size > 0 && pair.right < pair.right_end;
    const int share = (left_size + items - 1) / items;
    const int low = pair.left + min((me - first) * share, left_size);
    const int high = min(low + share, pair.left_end) - 1;
    past[me] = !has_tangent || low > high || is_past(&frame, now, high, pair WITH_COUNTERS);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (past[me] && (me == first || !past[me - 1])) {
      int kept_end = pair.left_end, kept_begin = pair.right;
      if (has_tangent) {
        const int end = first_past(&frame, now, low, high, pair WITH_COUNTERS);
        kept_begin =
            tangent_from(&frame, now, now.ids[end], now.projections[end], pair.right, pair.right_end WITH_COUNTERS);
        kept_end = end + 1;
      }
      kept_left[first] = kept_end - pair.left;
      first_right[first] = kept_begin;
      hull_size[first] = kept_end - pair.left + pair.right_end - kept_begin;
    } else {
      // The others wait.
      TALLY(frame, steps, (search_comparisons(share) + 1) * (search_comparisons(pair.right_end - pair.right) + 1));
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const int left = pair.left;
    for (int k = me - first; k < hull_size[first]; k += items) {
      const int from = k < kept_left[first] ? left + k : first_right[first] + k - kept_left[first];
      then.ids[left + k] = now.ids[from];
      then.projections[left + k] = now.projections[from];
    }
    const sequence spare = now;
    now = then;
    then = spare;
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
  }
  if (now.ids != ids) {
    for (int k = me; k < hull_size[0]; k += group) {
      then.ids[begin + k] = now.ids[begin + k];
      then.projections[begin + k] = now.projections[begin + k];
    }
  }
  if (me == 0 && r < regions) sizes[r] = hull_size[0];
  if (frame.undecided > 0) atomic_add(undecided, frame.undecided);
  COUNT_STEPS(frame.counted.steps);
}

// Runs of this many corners are sorted by u by insertion, before runs are merged.
#define CORNERS_RUN 12

// Sorts the corners s by u into `spare`, which has as much room; s is lost.
static inline void sort_corners(sequence s, sequence spare, int count) {
  for (int low = 0; low < count; low += CORNERS_RUN) {
    const int high = min(count, low + CORNERS_RUN);
    for (int i = low + 1; i < high; ++i) {
      const int id = s.ids[i];
      const double2 p = s.projections[i];
      int to = i;
      for (; to > low && s.projections[to - 1].y > p.y; --to) {
        s.ids[to] = s.ids[to - 1];
        s.projections[to] = s.projections[to - 1];
      }
      s.ids[to] = id;
      s.projections[to] = p;
    }
  }
  int in_spare = 0;
  for (int64 run = CORNERS_RUN; run < count || !in_spare; run *= 2) {
    const sequence from = in_spare ? spare : s, to = in_spare ? s : spare;
    for (int64 low = 0; low < count; low += 2 * run) {
      const int middle = (int)min((int64)count, low + run), high = (int)min((int64)count, low + 2 * run);
      int a = (int)low, b = middle;
      for (int k = (int)low; k < high; ++k) {
        const int i = b == high || (a < middle && from.projections[a].y <= from.projections[b].y) ? a++ : b++;
        to.ids[k] = from.ids[i];
        to.projections[k] = from.projections[i];
      }
    }
    in_spare = !in_spare;
  }
}

// The hulls of regions so small that nothing need be pruned: a work-item takes a region with all its points and
// corners. The region's elements begin at begins[r]. sorted_corners and sorted_projections have room for all corners.
// flags: of corners, whether their vertices are on the hull.
kernel void hulls_alone(int n, filter_bound bound, global const int* restrict point_offsets,
                        global const int* restrict corner_offsets, LISTS(), global const int* restrict corners, CUTS(),
                        global int* restrict begins, global int* ids, global double2* projections,
                        global int* sorted_corners, global double2* sorted_projections, global uint* restrict sizes,
                        global uchar* restrict flags, global volatile uint* restrict undecided COUNTERS) {
  const int r = get_global_id(0);
  if (r < n) {
    const int low = point_offsets[r], high = point_offsets[r + 1];
    const int corners_low = corner_offsets[r], corners_high = corner_offsets[r + 1];
    const int begin = low + corners_low;
    const int a = axis[r], planar = is_planar(a);
    const double q = cut[r];
    global const int* const list = a == AXIS_Y ? x_list : y_list;
    // The points of a region are not neighbours in memory.
    for (int k = low; k < high; ++k) fetch(points + list[k]);
    for (int c = corners_high; c < corner_offsets[min(r + 2, n)]; ++c) fetch(points + corners[3 * c + 1]);
    hull_frame frame;
    frame.axis = a;
    frame.cut = q;
    frame.bound = bound;
    frame.points = points;
    frame.undecided = 0;
    CLEAR_TALLY(frame);
    const sequence now = {ids, projections};
    // The corners by u, as their numbers.
    const int count = corners_high - corners_low;
    const sequence unsorted = {ids + begin, projections + begin};
    const sequence sorted = {sorted_corners + corners_low, sorted_projections + corners_low};
    for (int c = 0; c < count; ++c) {
      unsorted.ids[c] = corners_low + c;
      unsorted.projections[c] = project(to_frame(points[corners[3 * (corners_low + c) + 1]], a), q, planar);
    }
    sort_corners(unsorted, sorted, count);
    int c = 0, end = begin;
    for (int k = 0; k <= high - low; ++k) {
      const int is_point = k < high - low;
      const int id = is_point ? list[a == AXIS_Y ? high - 1 - k : low + k] : 0;
      const double2 p = is_point ? project(to_frame(points[id], a), q, planar) : VECTOR(double2, 0.0, INFINITY);
      for (; c < count && sorted.projections[c].y < p.y; ++c) {
        now.ids[end] = corners[3 * sorted.ids[c] + 1];
        now.projections[end++] = sorted.projections[c];
      }
      if (is_point) {
        now.ids[end] = id;
        now.projections[end++] = p;
      }
    }
    const int size = chain_of(&frame, now, begin, end WITH_COUNTERS);
    int v = begin;
    for (c = 0; c < count; ++c) {
      while (now.projections[v].y < sorted.projections[c].y) ++v;
      flags[sorted.ids[c]] = now.ids[v] == corners[3 * sorted.ids[c] + 1];
    }
    begins[r] = begin;
    sizes[r] = size;
    if (frame.undecided > 0) atomic_add(undecided, frame.undecided);
    COUNT_STEPS(frame.counted.steps);
  }
}

// A work-group takes a region. band: see chord_bands in prune.cl.
kernel void write_paths(int regions, global const int* restrict begins, global const int* restrict offsets,
                        global const int* restrict axis, global const int* restrict ids,
                        global const double2* restrict projections, NEW_PATH_VERTICES(), global double* restrict band) {
  const int r = get_group_id(0);
  if (r >= regions) return;
  const int from = begins[r];
  const int to = offsets[r];
  const int count = offsets[r + 1] - to;
  for (int k = get_local_id(0); k < count; k += get_local_size(0)) {
    const double2 p = projections[from + k];
    new_path[to + k] = ids[from + k];
    new_region[to + k] = r;
    new_projections[to + k] = p;
    band[to + k] = k + 1 < count ? chord_band(p, projections[from + k + 1], is_planar(axis[r])) : INFINITY;
  }
}
