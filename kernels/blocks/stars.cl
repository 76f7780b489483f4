// Triangulations of few points, before blocks/local_parts.cl: for these a device has more lanes than merges can use,
// and each merge waits for the one before. Here a work-group per vertex finds its star, the vertices to which it has
// edges: the nearest vertex is one, and beside an edge of the star lies the triangle whose circle has no vertex inside.
// Each work-item compares some vertices, then the group compares theirs: those as near as the vertices beside it in the
// order of leaves, and where a circle is not certainly among these, all. Predicates are exact and ties canonical
// (mesh/rings.h), so that stars are those of one triangulation. A star stops at a predicate that floating point cannot
// decide, as merges do, or at MOST_STAR edges, or if all vertices are on one line.
//
// Units are the parts that groups of local_parts.cl have, or whole blocks. wrap_stars is one launch, and join_stars
// makes rings of the stars of each unit, unless one has stopped: then the unit is left to merges. So it is if an edge
// is in one star alone, which would be an error of the program or a compiler: the account tells the host.

#ifndef FIXED_POINT
#define RINGS_STOP
#endif
#include "blocks/arguments.h"
#include "blocks/codes.h"
#include "blocks/limits.h"
#include "blocks/parts.h"
#include "blocks/rings_account.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "operations/limits.h"
#include "operations/work_group.h"
#include "predicates/nearness.h"
#include "predicates/order.h"
#include "predicates/records.h"

// What the group of a vertex looks for: the nearest vertex, or the next one of the star counter-clockwise or clockwise
// from a vertex of it. tile: where the NEAR_TILE vertices beside it begin, in the order of leaves.
enum { NEAREST, LEFTWARD, RIGHTWARD };
typedef struct {
  int from, at, turn, tile;
  coordinate_pair left, right;  // the edge's vertices, with the side on which the next one is above
} star_search;

// A vertex, or none. seen: the edge to `at`, as the vertex sees it (predicates/planar.h). In a search for the nearest
// one, of those that were compared: how far, squared, those of the tile are from it, and the largest difference of
// coordinates.
typedef struct {
  int vertex;
  real_pair seen;
} candidate;

// Whether a vertex is nearer to another one than a third.
static inline int is_nearer(rings* g, int vertex, int than, int to) {
  const coordinate2 a = g->points[than], b = g->points[vertex], q = g->points[to];
#ifdef FIXED_POINT
  return nearness_sign(a, b, q, NEARNESS_BOUND) > 0;
#else
  const int sign = nearness_filtered(a, b, q, has_coarse_points(g->bounds) ? 0 : NEARNESS_BOUND);
  if (sign == UNDECIDED) ++g->undecided;
  return sign == 1;
#endif
}

static inline void turn_search(const rings* g, star_search* s, int turn, int at) {
  s->turn = turn;
  s->at = at;
  s->left = point_at(g, turn == RIGHTWARD ? at : s->from);
  s->right = point_at(g, turn == RIGHTWARD ? s->from : at);
}

static inline real squared_distance(const rings* g, int a, int b) {
  return squared_length(difference2(g->points[a], g->points[b]));
}

// Whether the circle through the edge and a vertex that sees it so is certainly within a distance, squared, from the
// edge's ends. By the law of sines its diameter is the length of the edge over the sine of the angle.
static inline int is_circle_near(const rings* g, const star_search* s, real_pair seen, real reach) {
  const real cotangent = low(seen) / high(seen);
  return high(seen) > 1000 * g->errors.side &&
         REAL(1.1) * squared_distance(g, s->from, s->at) * (1 + cotangent * cotangent) < reach;
}

static inline candidate candidate_of(rings* g, const star_search* s, int vertex) {
  candidate c = {vertex, VECTOR(real_pair, 0, 0)};
  if (s->turn == NEAREST) {
    const real2 apart = difference2(g->points[vertex], g->points[s->from]);
    const int is_in_tile = vertex >= s->tile && vertex < s->tile + NEAR_TILE;
    c.seen = VECTOR(real_pair, is_in_tile ? squared_length(apart) : 0, fmax(fabs(apart.x), fabs(apart.y)));
  } else {
    const coordinate_pair apex = point_at(g, vertex);
    c.seen = angle_products(apex, s->left, s->right);
    if (!is_above(g, s->left, s->right, apex, c.seen)) c.vertex = NO_VERTEX;
  }
  return c;
}

static inline candidate better_of(rings* g, const star_search* s, candidate a, candidate b) {
  TALLY(*g, steps, 1);
  if (b.vertex == NO_VERTEX) return a;
  if (a.vertex == NO_VERTEX) return b;
  if (s->turn == NEAREST) {
    const candidate nearest = {is_nearer(g, b.vertex, a.vertex, s->from) ? b.vertex : a.vertex, fmax(a.seen, b.seen)};
    return nearest;
  }
  return rules_out(g, s->left, s->right, point_at(g, a.vertex), a.seen, point_at(g, b.vertex), b.seen) ? b : a;
}

// Finds the best of the candidates of a group's first `width` work-items: best[0]. (oclgrind cannot inline functions
// that return structures.)
WITH_BARRIERS void find_best(rings* g, const star_search* s, candidate own, int width, local candidate* best,
                             local int* has_stopped) {
  const int me = get_local_id(0);
  best[me] = own;
  barrier(CLK_LOCAL_MEM_FENCE);
  do {
    const int kept = (width + 1) / 2;
    if (me < width - kept) best[me] = better_of(g, s, best[me], best[me + kept]);
    if (HAS_STOPPED(g)) atomic_or(has_stopped, 1);
    barrier(CLK_LOCAL_MEM_FENCE);
    width = kept;
  } while (width > 1);
}

SCAN_IN_GROUP(stars_before, uint)

// In so many bits, the two checks of an edge that is in the stars of both its vertices add up to 0. Sums of others are
// hardly ever 0.
INTEGER_CONSTANT(CHECK_BITS, 15);
static inline uint check_of_edge(int v, int w) {
  const uint edge = STAR_VERTICES * min(v, w) + max(v, w), check = edge * (edge | 1) * 0x9e3779b1u >> (32 - CHECK_BITS);
  return v < w ? check : -check;
}

static inline int star_size_of(int edges, int larger, uint check) {
  return edges | larger << STAR_SIZE_BITS | (check & ((1 << CHECK_BITS) - 1)) << (2 * STAR_SIZE_BITS);
}
static inline int edges_of_star(int star_size) { return star_size & ((1 << STAR_SIZE_BITS) - 1); }
static inline int larger_in_star(int star_size) { return edges_of_star(star_size >> STAR_SIZE_BITS); }
static inline uint check_of_star(int star_size) { return star_size >> (2 * STAR_SIZE_BITS); }

// groups: of units, each with `most` groups here, one per vertex. stars: MOST_STAR per vertex, by number in the unit,
// counter-clockwise; of a vertex on the hull from its hull edge on. star_sizes: the number of edges, how many of them
// lead to vertices of a larger number, and the sum of check_of_edge; or -1.
kernel void wrap_stars(int groups, int most, int blocks, PLACES_OF_PARTS(), filter_bounds bounds,
                       global const coordinate2* restrict points, global int* restrict stars,
                       global int* restrict star_sizes, global volatile uint* account COUNTERS) {
  local candidate best[LARGEST_TILE_GROUP];
  local uint sums[LARGEST_TILE_GROUP];
  local ushort star[2 * MOST_STAR];
  local int near_vertices[MOST_NEAR], has_stopped;
  const int me = get_local_id(0), lanes = get_local_size(0), group = get_group_id(0), v = group % most;
  const halved_blocks halved = blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, 0, 0);
  const local_part unit = local_part_of(&halved, blocks, min(group / most, groups - 1), height);
  const int size = group / most < groups && unit.own_height >= 0 && v < unit.size ? unit.size : 0;
  rings g = rings_on(0, points + unit.first, 0, bounds);
  g.most_ties = ~0u;
  // The last tile has vertices of the one before, so that no vertex is alone.
  star_search s = {v, NO_VERTEX, NEAREST, min(v / NEAR_TILE * NEAR_TILE, size - NEAR_TILE)};
  const candidate none = {NO_VERTEX, VECTOR(real_pair, 0, 0)};
  if (me == 0) has_stopped = 0;
  candidate own = none;
  for (int c = me; c < size; c += lanes) {
    if (c != v) own = better_of(&g, &s, own, candidate_of(&g, &s, c));
  }
  find_best(&g, &s, own, max(1, min(lanes, size)), best, &has_stopped);
  const candidate nearest = best[0];
  const int first = nearest.vertex;
  const real reach = low(nearest.seen);
  const int each = share_of(size), from = min(size, me * each), to = min(size, from + each);
  uint own_near = 0, near_count;
  for (int c = from; c < to; ++c) own_near += squared_distance(&g, c, v) <= reach;
  uint place = stars_before(own_near, sums, &near_count);
  for (int c = from; c < to && place < MOST_NEAR; ++c) {
    if (squared_distance(&g, c, v) <= reach) near_vertices[place++] = c;
  }
  TALLY(g, steps, to - from);
  int begin = MOST_STAR, end = MOST_STAR, is_searching, is_again = 0;
  if (first != NO_VERTEX) {
    g.errors = errors_within(2 * high(nearest.seen), bounds);
    if (me == 0) star[end] = first;
    ++end;
    turn_search(&g, &s, LEFTWARD, first);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  do {
    const int is_near = !is_again && near_count <= MOST_NEAR, count = is_near ? near_count : size;
    own = none;
    for (int k = me; k < count; k += lanes) {
      const int c = is_near ? near_vertices[k] : k;
      if (c != v && c != s.at) own = better_of(&g, &s, own, candidate_of(&g, &s, c));
    }
    find_best(&g, &s, own, max(1, min(lanes, count)), best, &has_stopped);
    const candidate found = best[0];
    const int is_none = found.vertex == NO_VERTEX;
    is_again = is_near && (is_none || !is_circle_near(&g, &s, found.seen, reach));
    is_searching = first != NO_VERTEX && !has_stopped && end - begin < MOST_STAR &&
                   (is_again || (s.turn == LEFTWARD ? found.vertex != first : !is_none));
    if (is_searching && !is_again && is_none) {
      turn_search(&g, &s, RIGHTWARD, first);
    } else if (is_searching && !is_again) {
      const int at = s.turn == RIGHTWARD ? --begin : end++;
      if (me == 0) star[at] = found.vertex;
      turn_search(&g, &s, s.turn, found.vertex);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  } while (is_searching);
  const int edges = end - begin;
  for (int k = me; k < edges; k += lanes) stars[MOST_STAR * (unit.first + v) + k] = star[begin + k];
  if (me == 0 && size > 0) {
    int larger = 0;
    uint check = 0;
    for (int k = begin; k < end; ++k) {
      larger += star[k] > v;
      check += check_of_edge(v, star[k]);
    }
    const int is_whole = !has_stopped && edges < MOST_STAR && (edges > 1 || size < 3);
    star_sizes[unit.first + v] = is_whole ? star_size_of(edges, larger, check) : -1;
  }
#ifndef RINGS_STOP
  add_to_account(&g, account);
#endif
  COUNT_STEPS(g.counted.steps);
}

// The pair of edges from v to w, v < w, behind the first pair of v.
static inline int pair_in_star(int v, int w, global const int* star, int edges) {
  int pair = 0;
  for (int k = 0, is_beyond = 0; k < edges; ++k) {
    is_beyond |= star[k] == w;
    pair += !is_beyond && star[k] > v;
  }
  return pair;
}

// Bits for the ends of a hull, as hull_ends has them, of which a vertex can be one if another is there, too.
INTEGER_CONSTANT(ALL_ENDS, 15);
static inline int ends_beside(coordinate2 p, coordinate2 other) {
  return precedes(p, other, 0) | precedes(other, p, 0) << 1 | precedes(p, other, 1) << 2 | precedes(other, p, 1) << 3;
}

static inline void write_ends(int ends, int vertex, global solved_block* solved) {
  if (ends & 1) solved->ends.first_x = vertex;
  if (ends & 2) solved->ends.last_x = vertex;
  if (ends & 4) solved->ends.first_y = vertex;
  if (ends & 8) solved->ends.last_y = vertex;
}

// groups: of units, each with `shares` groups here, one per STARS_JOINED vertices. are_blocks: units are whole blocks,
// whose places lose their block when they are done, in places_left, which is block_of_place; otherwise states has, by
// unit, whether it is left to merges.
kernel void join_stars(int groups, int shares, int are_blocks, int blocks, PLACES_OF_PARTS(), RINGS_OF_PARTS(),
                       global const int* restrict stars, global const int* restrict star_sizes, global int* places_left,
                       global int* restrict states, global volatile uint* account COUNTERS) {
  local uint sums[LARGEST_TILE_GROUP];
  local ushort first_pairs[STAR_VERTICES];
  local short own_edges[STARS_JOINED * MOST_STAR];
  local int ends[STARS_JOINED], has_stopped;
  const int me = get_local_id(0), lanes = get_local_size(0), u = get_group_id(0) / shares;
  const int share = get_group_id(0) % shares;
  const halved_blocks halved =
      blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, parts, solved);
  const local_part unit = local_part_of(&halved, blocks, min(u, groups - 1), height);
  const int size = u < groups && unit.own_height >= 0 ? unit.size : 0, first = unit.first;
  stars += MOST_STAR * first;
  star_sizes += first;
  if (me == 0) has_stopped = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  // A pair of edges is one of its vertex of the smaller number, in the order of that star.
  const int each = share_of(size), low = min(size, me * each), high = min(size, low + each);
  uint own = 0, all, steps = each;
  for (int v = low; v < high; ++v) {
    if (star_sizes[v] < 0) atomic_or(&has_stopped, 1);
    own += larger_in_star(star_sizes[v]) + (check_of_star(star_sizes[v]) << (32 - CHECK_BITS));
  }
  uint before = stars_before(own, sums, &all);
  const int pairs = all << CHECK_BITS >> CHECK_BITS, is_whole = all == (uint)pairs;
  const int is_done = size > 0 && !has_stopped && is_whole;
  for (int v = low; is_done && v < high; ++v) {
    first_pairs[v] = (ushort)before;
    before += larger_in_star(star_sizes[v]);
  }
  const int begin = share * STARS_JOINED, count = is_done ? min(STARS_JOINED, size - begin) : 0;
  for (int i = me; i < count; i += lanes) ends[i] = ALL_ENDS;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int t = me; t < count * MOST_STAR; t += lanes) {
    const int i = t / MOST_STAR, v = begin + i, k = t % MOST_STAR;
    if (k >= edges_of_star(star_sizes[v])) continue;
    const int w = stars[MOST_STAR * v + k], from = min(v, w), to = max(v, w);
    const int pair = pair_in_star(from, to, stars + MOST_STAR * from, edges_of_star(star_sizes[from]));
    own_edges[t] = 2 * (first_pairs[from] + pair) + (v == to);
    atomic_and(&ends[i], ends_beside(points[first + v], points[first + w]));
    steps += edges_of_star(star_sizes[from]);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  global solved_block* const result = unit.part.depth > 0 ? &parts[first / 2] : &solved[max(0, unit.part.block)];
  for (int t = me; t < count * MOST_STAR; t += lanes) {
    const int i = t / MOST_STAR, v = begin + i, k = t % MOST_STAR, edges_at_v = edges_of_star(star_sizes[v]);
    if (k == 0) {
      vertex_edge[first + v] = edges_at_v > 0 ? edge_at(first) + own_edges[t] : NO_EDGE;
      write_ends(ends[i], first + v, result);
    }
    if (k >= edges_at_v) continue;
    const int next = k + 1 < edges_at_v ? t + 1 : t - k, previous = k > 0 ? t - 1 : t + edges_at_v - 1;
    const ring_edge edge = {first + stars[MOST_STAR * v + k], edge_at(first) + own_edges[next],
                            edge_at(first) + own_edges[previous]};
    edges[edge_at(first) + own_edges[t]] = edge;
  }
  // The edges of places without vertices are the block's, too.
  const int is_block = unit.part.depth == 0 && is_done, b = max(0, unit.part.block);
  const int spare = is_block ? first + size : 0, end = is_block ? offsets[b + 1] : 0, is_first = me == 0 && share == 0;
  const int pairs_end = is_done ? PAIRS_PER_VERTEX * size : 0, step = shares * lanes, from = share * lanes + me;
  for (int pair = pairs + from; pair < pairs_end; pair += step) {
    const int e = edge_at(first) + 2 * pair, next = pair + 1 < pairs_end || spare < end ? e + 2 : NO_EDGE;
    const ring_edge low_half = {NO_VERTEX, next, e}, high_half = {NO_VERTEX, e, e};
    edges[e] = low_half;
    edges[e + 1] = high_half;
  }
  for (int place = spare + from; place < end; place += step) free_place(edges, vertex_edge, place, end);
  for (int place = first + from; are_blocks && place < end; place += step) places_left[place] = -1;
  if (is_first && is_done) {
    const free_edges unused = {edge_at(first) + 2 * pairs, edge_at(max(end, first + size)) - 2};
    result->unused = unused;
    // The walks of a later merge look roughly where the high half is.
    const block_part part = unit.part;
    const int middle = first - part.begin + part_begin(part.count, part.depth + 1, 2 * part.number + 1);
    if (part.depth > 0 && unit.own_height > 0) parts[middle / 2].ends = ends_of(middle, middle, middle, middle);
  }
  if (is_first && size > 0 && !has_stopped && !is_whole) atomic_inc(&account[RINGS_BROKEN]);
  if (is_first && size > 0 && !are_blocks) states[u] = !is_done;
  COUNT_STEPS(steps);
}
