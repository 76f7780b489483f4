// Rounds of blocks: final triangles of the blocks' triangulations are emitted, and the points around which
// triangles are missing go on to the next round, in other blocks. Where blocks are triangulated part by part
// (blocks/parts.h) up to a height, that is done with these parts, and the others need not be merged. Each has a frame;
// a block has 2^depth frames, some of which are empty.
//
// A triangle is final if its circumcircle lies within the frame's rectangle (blocks/certify.h): then it belongs
// to the triangulation of all points of the round. These are the points that are not done yet, so that
// triangulation also has triangles over the area that earlier rounds emitted. The open sectors at a vertex
// (blocks/open_sectors.h) distinguish these from triangles still missing. The outside is emitted per hull edge.
//
// Each round, when the blocks are solved:
// 1. In the first round, if a set has several blocks or frames, box_blocks, per block, and join_boxes, in a launch per
//    factor of 16 blocks, find the box around each set's points. begin_round, per vertex, numbers the vertices, in the
//    first round with nothing emitted, and per frame finds the rectangle between the cuts.
// 2. emit_triangles, per pair of edges, emits triangles to their middle vertices' places, one below and one above the
//    vertex, and notes the state of each edge's left side. After the first round, emit_unsure, per pair of edges,
//    decides exactly what the filters could not.
// 3. link_triangles, per pair of edges, joins emitted triangles, also with triangles of earlier rounds.
// 4. Unless each set has one triangulation: count_open, per vertex, counts vertices that go on; after a scan
//    write_open writes the points and their open edges.
// After the rounds:
// 5. count_results counts triangles, per place, and hull vertices, per vertex; then there is a scan, and measure_sets
//    tells where sets begin. For few points count_few_results does all this in one launch, by a work-group.
// 6. write_results, per place, closes the gaps between triangles, and per vertex lists the hulls' vertices.
// 7. rank_hull, in one launch per factor of HULL_HOPS, finds how many vertices of a hull follow each; write_hull writes
//    them in order. For few hull vertices order_hull does all this in one launch, by a work-group.
// measure_open tells the host how large the parts of several sets are that go on.

#include "arithmetic/coordinates.h"
#include "arithmetic/records.h"
#include "blocks/arguments.h"
#include "blocks/certify.h"
#include "blocks/codes.h"
#include "blocks/limits.h"
#include "blocks/open_sectors.h"
#include "blocks/parts.h"
#include "blocks/records.h"
#include "blocks/rows.h"
#include "mesh/halfedges.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "operations/limits.h"
#include "operations/search.h"
#include "operations/work_group.h"
#include "points/cut_tree.h"
#include "points/records.h"

static inline vertex_box joined_boxes(vertex_box a, vertex_box b) {
  vertex_box both;
  both.low = VECTOR(coordinate2, min(a.low.x, b.low.x), min(a.low.y, b.low.y));
  both.high = VECTOR(coordinate2, max(a.high.x, b.high.x), max(a.high.y, b.high.y));
  return both;
}

static inline vertex_box no_box(void) {
  const vertex_box none = {VECTOR(coordinate2, COORDINATE_LARGEST, COORDINATE_LARGEST),
                           VECTOR(coordinate2, -COORDINATE_LARGEST, -COORDINATE_LARGEST)};
  return none;
}

static inline vertex_box box_of(hull_ends ends, global const coordinate2* points) {
  vertex_box box = no_box();
  if (ends.first_x != NO_VERTEX) {
    box.low = VECTOR(coordinate2, points[ends.first_x].x, points[ends.first_y].y);
    box.high = VECTOR(coordinate2, points[ends.last_x].x, points[ends.last_y].y);
  }
  return box;
}

// The box around the points of a block's frames first..last - 1.
static inline vertex_box box_of_frames(const halved_blocks* blocks, int b, int height, int depth, int first, int last,
                                       global const coordinate2* points) {
  vertex_box box = no_box();
  for (int j = first; j < last; ++j) {
    const block_part part = part_in_frame(blocks, b, height, depth, j);
    box = joined_boxes(box, box_of(ends_of_part(blocks, part), points));
  }
  return box;
}

// n blocks.
kernel void box_blocks(int n, PLACES_OF_PARTS(), int depth, global solved_block* parts, global solved_block* solved,
                       global const coordinate2* restrict points, global vertex_box* restrict boxes) {
  const int b = get_global_id(0);
  if (b < n) {
    const halved_blocks blocks =
        blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, parts, solved);
    boxes[b] = box_of_frames(&blocks, b, height, depth, 0, 1 << depth, points);
  }
}

// n blocks. step: the first of this many blocks of a set has the box around them all.
kernel void join_boxes(int n, int sets, int step, global const int* restrict set_blocks, global vertex_box* boxes) {
  const int b = get_global_id(0);
  if (b < n) {
    const int s = segment_of(b, sets, set_blocks);
    if ((b - set_blocks[s]) % (JOINED_BOXES * step) == 0) {
      vertex_box box = boxes[b];
      for (int k = 1; k < JOINED_BOXES; ++k) {
        const int64 other = b + (int64)k * step;
        if (other < set_blocks[s + 1]) box = joined_boxes(box, boxes[other]);
      }
      boxes[b] = box;
    }
  }
}

// The edges of a triangle around a triangulation, from the outside; of other hulls none.
static inline void find_outside(hull_ends ends, global const ring_edge* edges, global const int* vertex_edge,
                                int* outside) {
  outside[0] = outside[1] = outside[2] = NO_EDGE;
  const int first = ends.first_x == NO_VERTEX ? NO_EDGE : vertex_edge[ends.first_x];
  if (first == NO_EDGE) return;
  const int second = edges[first ^ 1].next, third = edges[second ^ 1].next;
  if (third == first || edges[third ^ 1].next != first) return;
  outside[0] = first ^ 1;
  outside[1] = second ^ 1;
  outside[2] = third ^ 1;
}

// The number of a round's vertex k in the first round, which all rounds use. listed: where the vertices stood in the
// list that was made into blocks; listed_vertices: their numbers; of the first round itself, there is no list.
static inline int round_vertex(int k, int is_first, global const int* listed, global const int* listed_vertices) {
  return is_first ? k : listed_vertices[listed[k]];
}

// The next and the previous vertex of a hull vertex, in its pair of links. Different work-items write them, which must
// not write whole pairs.
#define NEXT_ON_HULL(v) (2 * (v))
#define PREVIOUS_ON_HULL(v) (2 * (v) + 1)

// The part of a rectangle that lies in frame j of a block, which has this part, between the cuts into parts: the points
// on the other side of each are in a box.
static inline vertex_box rectangle_in_block(vertex_box rectangle, const halved_blocks* blocks, block_part part,
                                            int height, int depth, int j, global const coordinate2* points) {
  for (int up = depth - part.depth; up < depth; ++up) {
    const int is_high = j >> up & 1, others = (j >> up ^ 1) << up;
    const vertex_box box = box_of_frames(blocks, part.block, height, depth, others, others + (1 << up), points);
    const int axis = blocks->axes[part.first + (1 << (depth - up - 1)) + (j >> (up + 1))];
    if (axis != 0 && is_high) rectangle.low.y = max(rectangle.low.y, box.high.y);
    if (axis != 0 && !is_high) rectangle.high.y = min(rectangle.high.y, box.low.y);
    if (axis == 0 && is_high) rectangle.low.x = max(rectangle.low.x, box.high.x);
    if (axis == 0 && !is_high) rectangle.high.x = min(rectangle.high.x, box.low.x);
  }
  return rectangle;
}

// n: the largest of the numbers of places, of frames, and of RINGS_NUMBERS. Blocks are the leaves of each set's tree,
// whose nodes begin at set_nodes. is_merged: the first block of each set has the set's triangulation. set_boxes: where
// each set of several blocks or frames has its box. frame_offsets: where frames begin. numbers: of the host, behind 2
// per set and 2 more the account and the blocks' numbers of vertices in the first round.
kernel void begin_round(int n, PLACES_OF_PARTS(), int depth, int blocks, CUT_SETS(), int is_merged, scaling scale,
                        global solved_block* parts, global solved_block* solved, global const int* restrict set_boxes,
                        global const vertex_box* restrict boxes, global const coordinate2* restrict points,
                        global const ring_edge* restrict edges, global const int* restrict vertex_edge, int is_first,
                        global const int* restrict listed, global const int* restrict listed_vertices,
                        global int* restrict vertices, global int* restrict emitted, global int* restrict hull_links,
                        global int* restrict frame_offsets, global block_frame* restrict frames,
                        global const uint* restrict account, global int* restrict numbers) {
  const int f = get_global_id(0), b = f >> depth, j = f - (b << depth);
  if (f < places) vertices[f] = round_vertex(f, is_first, listed, listed_vertices);
  if (f < places && is_first) {
    emitted[6 * f] = emitted[6 * f + 3] = NO_VERTEX;
    hull_links[NEXT_ON_HULL(f)] = hull_links[PREVIOUS_ON_HULL(f)] = NO_VERTEX;
  }
  global int* const own_numbers = numbers + 2 * (sets + 1);
  if (f < RINGS_NUMBERS) own_numbers[f] = (int)account[f];
  if (f < blocks && is_first) own_numbers[RINGS_NUMBERS + f] = distinct[f];
  if (b < blocks) {
    const halved_blocks halved =
        blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, parts, solved);
    const block_part part = part_in_frame(&halved, b, height, depth, j);
    const int s = segment_of(b, sets, set_blocks);
    const int first = set_blocks[s], leaves = set_blocks[s + 1] - first;
    block_frame frame;
    frame.all = depth > 0 || (leaves > 1 && !is_merged) ? boxes[set_boxes[s]] : no_box();
    frame.rectangle.low = VECTOR(coordinate2, -COORDINATE_LARGEST, -COORDINATE_LARGEST);
    frame.rectangle.high = VECTOR(coordinate2, COORDINATE_LARGEST, COORDINATE_LARGEST);
    for (int node = leaves + b - first; node > 1 && !is_merged; node >>= 1) {
      frame.rectangle = cut_rectangle(frame.rectangle, nodes[set_nodes[s] + (node >> 1)], node & 1, scale);
    }
    if (part.block >= 0) frame.rectangle = rectangle_in_block(frame.rectangle, &halved, part, height, depth, j, points);
    const hull_ends ends = is_merged ? solved[first].ends : ends_of_part(&halved, part);
    find_outside(ends, edges, vertex_edge, frame.outside);
    const int is_single = ends.first_x != NO_VERTEX && ends.first_x == ends.last_x;
    if (is_single && (is_merged || leaves == 1)) frame.outside[0] = -2 - ends.first_x;
    frame.vertices = part.block < 0 ? 0 : vertices_of_part(part);
    frames[f] = frame;
    frame_offsets[f] = begin_of_frame(&halved, b, part, depth, j);
  }
}

// The arrays from which and to which a round's triangles are emitted.
typedef struct {
  int is_first;
  filter_bound bound;  // of orientations
  global const coordinate2* points;
  global const ring_edge* edges;
  global const int* vertices;
  global const int* listed;
  global const int* open_offsets;
  global const open_edge* open_edges;
  global const coordinate2* all_points;
  global const int* indices;  // in the input, by vertex
  global int* places;
  global int* states;
  global int* hull_links;
} emission;

static inline int is_outside(int e, global const ring_edge* edges, const block_frame* frame) {
  const int apex = edges[edges[e].next].to;
  return edges[edges[e ^ 1].previous].to != apex || e == frame->outside[0] || e == frame->outside[1] ||
         e == frame->outside[2];
}

// Whether the face left of the edge from `from` to `to` is missing; UNDECIDED if that takes exact arithmetic.
static inline int is_missing(const emission* m, int from, int to, int is_ghost, int exactly) {
  const int begin = m->open_offsets[m->listed[from]], end = m->open_offsets[m->listed[from] + 1];
  if (begin == end) return 1;
  const direction d = {m->points[from], m->points[to], m->vertices[to], is_ghost};
  return begins_open(&d, m->open_edges, begin, end, m->all_points, m->bound, exactly);
}

static inline int open_count(const emission* m, int vertex) {
  return m->open_offsets[m->listed[vertex] + 1] - m->open_offsets[m->listed[vertex]];
}

// Whether a triangle is missing, asked at the vertex with the fewest open edges.
static inline int is_triangle_missing(const emission* m, int a, int b, int c, int exactly) {
  const int at_a = open_count(m, a), at_b = open_count(m, b), at_c = open_count(m, c);
  if (at_a <= at_b && at_a <= at_c) return is_missing(m, a, b, 0, exactly);
  return at_b <= at_c ? is_missing(m, b, c, 0, exactly) : is_missing(m, c, a, 0, exactly);
}

// Emits the triangle left of e, an edge of its middle vertex v, whose row starts with the smallest index.
static inline void emit_triangle(const emission* m, int e) {
  const ring_edge there = m->edges[e], back = m->edges[e ^ 1];
  const int v = back.to, a = there.to, b = m->edges[there.next].to;
  const int vertex = m->vertices[v];
  const int row = 3 * (2 * vertex + precedes(m->points[v], m->points[a], 0));
  const int at_v = m->indices[vertex], at_a = m->indices[m->vertices[a]], at_b = m->indices[m->vertices[b]];
  const row_places to = places_in_row(at_v, at_a, at_b);
  m->places[row + to.v] = at_v;
  m->places[row + to.a] = at_a;
  m->places[row + to.b] = at_b;
  m->states[e] = row + to.b;
  m->states[back.previous] = row + to.v;
  m->states[there.next ^ 1] = row + to.a;
}

// The hull goes from v to w. The vertices of a set on one line are a chain in the order of x.
static inline void emit_hull_edge(const emission* m, int v, int w, int is_line) {
  if (is_line && !precedes(m->points[v], m->points[w], 0)) return;
  m->hull_links[NEXT_ON_HULL(m->vertices[v])] = m->vertices[w];
  m->hull_links[PREVIOUS_ON_HULL(m->vertices[w])] = m->vertices[v];
}

// The emitted corner beyond an open edge from one vertex, where that side begins, to another; GHOST if none is.
static inline int corner_beyond(int listed, int to, global const int* open_offsets,
                                global const open_edge* open_edges) {
  for (int k = open_offsets[listed]; k < open_offsets[listed + 1]; ++k) {
    if (open_edges[k].to == to && open_edges[k].begins) return open_edges[k].corner;
  }
  return GHOST;
}

// Whether the outside left of the edge is missing. If something is emitted and the points that are left are on one
// line, they are vertices of the hull, and there are triangles on the other side of the line alone, all of them
// emitted.
static inline int is_ghost_missing(const emission* m, int from, int to, int is_line, int exactly) {
  if (!is_line || open_count(m, from) == 0) return is_missing(m, from, to, 1, exactly);
  return corner_beyond(m->listed[from], m->vertices[to], m->open_offsets, m->open_edges) != GHOST;
}

// Emits the outside left of e if it is to be. Returns whether that takes exact arithmetic.
static inline int decide_ghost(const emission* m, const block_frame* frame, int e, int exactly) {
  const int to = m->edges[e].to, from = m->edges[e ^ 1].to;
  const int is_line = is_outside(e ^ 1, m->edges, frame);
  // If the points are on one line, it is not known on which side others are.
  const int is_final =
      !has_other_frames(frame) || (!is_line && is_half_plane_inside(frame, m->points[to], m->points[from]));
  const int missing = is_final && !m->is_first ? is_ghost_missing(m, from, to, is_line, exactly) : is_final;
  // If something is emitted, the set has triangles, and the points on one line are the rest of its hull.
  const int is_set_on_line = is_line && (m->is_first || open_count(m, from) == 0);
  if (missing == 1) emit_hull_edge(m, to, from, is_set_on_line);
  m->states[e] = missing == 1 ? GHOST : OPEN_GHOST;
  return missing == UNDECIDED;
}

// The same of the triangle left of e, an edge of its middle vertex.
static inline int decide_triangle(const emission* m, const block_frame* frame, int e, int exactly) {
  const ring_edge there = m->edges[e], back = m->edges[e ^ 1];
  const int v = back.to, a = there.to, b = m->edges[there.next].to;
  const int is_final = is_circle_inside(frame, m->points[v], m->points[a], m->points[b]);
  const int missing = is_final && !m->is_first ? is_triangle_missing(m, v, a, b, exactly) : is_final;
  if (missing == 1) {
    emit_triangle(m, e);
  } else {
    m->states[e] = m->states[back.previous] = m->states[there.next ^ 1] = OPEN;
  }
  return missing == UNDECIDED;
}

// The triangle left of e belongs to the edge's origin, which is its middle vertex, if the edge to the right or to the
// left separates it from neither of the other two.
static inline int is_from_middle(int e, global const ring_edge* edges, global const coordinate2* points) {
  const coordinate2 v = points[edges[e ^ 1].to];
  return precedes(v, points[edges[e].to], 0) != precedes(v, points[edges[edges[e].next].to], 0);
}

// n pairs of edges. unsure: by pair, a bit for each edge on whose left side emit_unsure decides; not in the first
// round, in which all that is final is missing. The first pair of a single vertex, which has no edges, is for its hull.
kernel void emit_triangles(int n, OPEN_VERTICES(), filter_bound bound, FRAMES(),
                           global const coordinate2* restrict points, global const ring_edge* restrict edges,
                           global const coordinate2* all_points, global const int* restrict indices,
                           global int* restrict places, global int* states, global int* restrict hull_links,
                           global uchar* restrict unsure) {
  const int k = get_global_id(0);
  int undecided = 0;
  const block_frame frame = frames[segment_of(min(k, n - 1) / PAIRS_PER_VERTEX, frame_count, frame_offsets)];
  if (k < n && edges[2 * k].to == NO_VERTEX) {
    states[2 * k] = states[2 * k + 1] = OPEN;
    const int v = -2 - frame.outside[0];
    if (v >= 0 && k == PAIRS_PER_VERTEX * v) hull_links[NEXT_ON_HULL(vertices[v])] = vertices[v];
  }
  if (k < n && edges[2 * k].to != NO_VERTEX) {
    const emission m = {is_first,   bound,      points,  edges,  vertices, listed,    open_offsets,
                        open_edges, all_points, indices, places, states,   hull_links};
    for (int e = 2 * k; e < 2 * k + 2; ++e) {
      if (is_outside(e, edges, &frame)) {
        undecided |= decide_ghost(&m, &frame, e, 0) << (e - 2 * k);
      } else if (is_from_middle(e, edges, points)) {
        undecided |= decide_triangle(&m, &frame, e, 0) << (e - 2 * k);
      }
    }
  }
  if (k < n && !is_first) unsure[k] = (uchar)undecided;
}

// n pairs of edges.
kernel void emit_unsure(int n, OPEN_VERTICES(), filter_bound bound, FRAMES(), global const coordinate2* restrict points,
                        global const ring_edge* restrict edges, global const coordinate2* all_points,
                        global const int* restrict indices, global int* restrict places, global int* states,
                        global int* restrict hull_links, global const uchar* restrict unsure) {
  const int k = get_global_id(0);
  if (k < n && unsure[k] != 0) {
    const emission m = {is_first,   bound,      points,  edges,  vertices, listed,    open_offsets,
                        open_edges, all_points, indices, places, states,   hull_links};
    const block_frame frame = frames[segment_of(k / PAIRS_PER_VERTEX, frame_count, frame_offsets)];
    for (int e = 2 * k; e < 2 * k + 2; ++e) {
      if ((unsure[k] >> (e - 2 * k) & 1) == 0) continue;
      if (is_outside(e, edges, &frame)) {
        decide_ghost(&m, &frame, e, 1);
      } else {
        decide_triangle(&m, &frame, e, 1);
      }
    }
  }
}

// n pairs of edges. links: the corner on the other side of the edge opposite to each corner.
kernel void link_triangles(int n, OPEN_VERTICES(), global const ring_edge* restrict edges,
                           global const int* restrict states, global int* restrict links) {
  const int k = get_global_id(0);
  if (k < n) {
    for (int e = 2 * k; e < 2 * k + 2; ++e) {
      const int corner = states[e];
      if (corner < 0) continue;
      int other = states[e ^ 1];
      if (!is_final(other) && !is_first) {
        other = corner_beyond(listed[edges[e ^ 1].to], vertices[edges[e].to], open_offsets, open_edges);
        if (other >= 0) links[other] = corner;
      }
      links[corner] = max(other, -1);
    }
  }
}

// The open edges of a vertex after a round: those that were open before and those that became open, without those that
// did both. If `to` is not null, they are written there.
typedef struct {
  global open_edge* to;
  global const open_edge* before;
  int begin, end;
  int count;
  int emitted;  // whether there is an emitted triangle at the vertex
} open_list;

static inline void add_open(open_list* list, int to, int corner, int begins) {
  for (int k = list->begin; k < list->end; ++k) {
    if (list->before[k].to == to && list->before[k].begins != begins) return;
  }
  if (list->to != 0) {
    const open_edge edge = {to, corner, begins};
    list->to[list->count] = edge;
  }
  ++list->count;
}

// Whether an open edge is closed by a face that this round emits on its other side.
static inline int is_closed_now(open_edge before, int first, global const ring_edge* edges, global const int* states,
                                global const int* vertices) {
  int e = first;
  do {
    const int left = is_final(states[e]), right = is_final(states[e ^ 1]);
    if (before.to >= 0) {
      if (vertices[edges[e].to] == before.to && (before.begins ? left && !right : right && !left)) return 1;
    } else if (is_ghost(states[e])) {
      const int behind = is_final(states[edges[e].next ^ 1]);
      if (before.begins ? behind && !left : left && !behind) return 1;
    }
    e = edges[e].next;
  } while (e != first);
  return 0;
}

static inline void gather_open(open_list* list, int first, global const ring_edge* edges, global const int* states,
                               global const int* vertices) {
  list->count = 0;
  list->emitted = list->begin < list->end;
  for (int k = list->begin; k < list->end; ++k) {
    if (first != NO_EDGE && is_closed_now(list->before[k], first, edges, states, vertices)) continue;
    if (list->to != 0) list->to[list->count] = list->before[k];
    ++list->count;
  }
  int e = first;
  while (e != NO_EDGE) {
    const int left = states[e], right = states[e ^ 1];
    list->emitted |= is_final(left);
    if (is_final(right) && !is_final(left)) add_open(list, vertices[edges[e].to], right, 1);
    if (is_final(left) && !is_final(right)) add_open(list, vertices[edges[e].to], left, 0);
    if (is_ghost(left)) {
      // The outside begins with the ghost of this edge and ends with that of the next one.
      const int behind = states[edges[e].next ^ 1];
      if (is_final(left) && !is_final(behind)) add_open(list, NO_VERTEX, GHOST, 1);
      if (is_final(behind) && !is_final(left)) add_open(list, NO_VERTEX, GHOST, 0);
    }
    e = edges[e].next;
    if (e == first) e = NO_EDGE;
  }
}

// The open edges of vertex k of a round.
static inline open_list open_list_of(int k, int is_first, global const int* listed, global const int* open_offsets,
                                     global const open_edge* open_edges) {
  open_list list;
  list.to = 0;
  list.before = open_edges;
  list.begin = is_first ? 0 : open_offsets[listed[k]];
  list.end = is_first ? 0 : open_offsets[listed[k] + 1];
  list.count = list.emitted = 0;
  return list;
}

// Whether a block has several parts: then the one in the middle frame is none of the first frame's.
static inline int is_in_parts(int block, int depth, global const block_frame* frames) {
  return depth > 0 && frames[(block << depth) + (1 << (depth - 1))].vertices > 0;
}

// Counts each vertex that goes on, and its open edges. n places; in the first round, the first ones of each frame are
// vertices, later all, also in blocks that were left unsolved. No vertex of a set that is one part goes on.
kernel void count_open(int n, OPEN_VERTICES(), int sets, global const int* restrict set_blocks, int depth, FRAMES(),
                       global const ring_edge* restrict edges, global const int* restrict vertex_edge,
                       global const int* restrict states, global uint2* restrict counts) {
  const int k = get_global_id(0);
  if (k < n) {
    const int f = segment_of(k, frame_count, frame_offsets);
    const int s = segment_of(f >> depth, sets, set_blocks);
    const int is_vertex = !is_first || k - frame_offsets[f] < frames[f].vertices;
    uint2 count = VECTOR(uint2, 0, 0);
    if (is_vertex && (set_blocks[s + 1] - set_blocks[s] > 1 || is_in_parts(f >> depth, depth, frames))) {
      open_list list = open_list_of(k, is_first, listed, open_offsets, open_edges);
      gather_open(&list, vertex_edge[k], edges, states, vertices);
      if (list.count > 0 || !list.emitted) count = VECTOR(uint2, 1, (uint)list.count);
    }
    counts[k] = count;
  }
}

// Writes the points that go on, in their order, and their open edges. n places.
kernel void write_open(int n, OPEN_VERTICES(), global const coordinate2* restrict points,
                       global const ring_edge* restrict edges, global const int* restrict vertex_edge,
                       global const int* restrict states, global const uint2* restrict scanned,
                       global coordinate2* restrict next_points, global int* restrict next_vertices,
                       global int* restrict next_offsets, global open_edge* restrict next_edges) {
  const int k = get_global_id(0);
  if (k < n) {
    const uint2 at = scanned[k];
    if (scanned[k + 1].x > at.x) {
      next_points[at.x] = points[k];
      next_vertices[at.x] = vertices[k];
      next_offsets[at.x] = (int)at.y;
      open_list list = open_list_of(k, is_first, listed, open_offsets, open_edges);
      list.to = next_edges + at.y;
      gather_open(&list, vertex_edge[k], edges, states, vertices);
    }
    if (k == n - 1) next_offsets[scanned[n].x] = (int)scanned[n].y;
  }
}

static inline int is_on_hull(int2 links) { return links.x != NO_VERTEX || links.y != NO_VERTEX; }

// How many results are at p: of the places of triangles, 2 per vertex, and behind them the vertices, for hulls.
static inline uint results_at(int p, int vertices, global const int* places, global const int2* hull_links) {
  return p < 2 * vertices ? places[3 * p] >= 0 : is_on_hull(hull_links[p - 2 * vertices]);
}

// n: 3 per vertex.
kernel void count_results(int n, int vertices, global const int* restrict places,
                          global const int2* restrict hull_links, global uint* restrict counts) {
  const int p = get_global_id(0);
  if (p < n) counts[p] = results_at(p, vertices, places, hull_links);
}

// Where hull vertex v stands in the list of all of n vertices.
static inline int place_on_hull(int v, int n, global const uint* scanned) {
  return (int)(scanned[2 * n + v] - scanned[2 * n]);
}

// Where a set, or the end, stands among the rows, and behind all of these among the hull vertices.
static inline void measure_set(int s, int sets, global const int* set_points, global const uint* scanned,
                               global int* sizes) {
  sizes[s] = (int)scanned[2 * set_points[s]];
  sizes[sets + 1 + s] = place_on_hull(set_points[s], set_points[sets], scanned);
}

// n: the number of sets plus 1.
kernel void measure_sets(int n, global const int* restrict set_points, global const uint* restrict scanned,
                         global int* restrict sizes) {
  const int s = get_global_id(0);
  if (s < n) measure_set(s, n - 1, set_points, scanned, sizes);
}

SCAN_IN_GROUP(results_before, uint)

// n: 3 per vertex. Each work-item of the first group counts `items` consecutive results of a tile, one tile after the
// other.
kernel void count_few_results(int n, int vertices, int items, global const int* restrict places,
                              global const int2* restrict hull_links, int sets, global const int* restrict set_points,
                              global uint* scanned, global int* restrict sizes) {
  local uint sums[LARGEST_TILE_GROUP];
  const int me = get_local_id(0), lanes = get_local_size(0), is_first = get_group_id(0) == 0;
  const int end = is_first ? n : 0;
  uint all_before = 0;
  for (int tile = 0; tile < end; tile += items * lanes) {
    const int first = tile + me * items, last = min(end, first + items);
    uint count = 0, all;
    for (int p = first; p < last; ++p) count += results_at(p, vertices, places, hull_links);
    uint before = all_before + results_before(count, sums, &all);
    for (int p = first; p < last; ++p) {
      scanned[p] = before;
      before += results_at(p, vertices, places, hull_links);
    }
    all_before += all;
  }
  if (is_first && me == 0) scanned[n] = all_before;
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int s = me; is_first && s <= sets; s += lanes) measure_set(s, sets, set_points, scanned, sizes);
}

// A place p of a triangle; scanned: the row of each. with_neighbors, with_halfedges: whether these arrays are wanted.
static inline void write_row(int p, int with_neighbors, int with_halfedges, global const int* places,
                             global const int* links, global const uint* scanned, global int* triangles,
                             global int* neighbors, global int* halfedges) {
  const int row = (int)scanned[p];
  for (int k = 0; k < 3; ++k) {
    triangles[3 * row + k] = places[3 * p + k];
    if (!with_neighbors && !with_halfedges) continue;
    const int link = links[3 * p + k];
    const int other = link < 0 ? -1 : (int)scanned[link / 3];
    if (with_neighbors) neighbors[3 * row + k] = other;
    if (with_halfedges) halfedges[3 * row + next_corner(k)] = link < 0 ? -1 : 3 * other + next_corner(link % 3);
  }
}

// Whether the hull's order begins with a vertex: the first one along x.
static inline int begins_hull(int v, global const coordinate2* points, global const int2* hull_links) {
  const int before = hull_links[v].y, after = hull_links[v].x;
  return before == NO_VERTEX || after == v ||
         (after != NO_VERTEX && comes_before(points[v], points[after]) && comes_before(points[v], points[before]));
}

// n: 3 per vertex, as for count_results; scanned: its prefix sums. Writes the rows, if with_triangles. Lists the hull
// vertices of all sets, and for each the place of the next one with 1, their distance, or its own with 0, if it is the
// last one.
kernel void write_results(int n, int vertices, int with_triangles, int with_neighbors, int with_halfedges,
                          global const int* restrict places, global const int* restrict links,
                          global const uint* restrict scanned, global int* restrict triangles,
                          global int* restrict neighbors, global int* restrict halfedges,
                          global const coordinate2* restrict points, global const int2* restrict hull_links,
                          global int* restrict hull_vertices, global int2* restrict ahead) {
  const int p = get_global_id(0), v = p - 2 * vertices;
  if (p < n && v < 0 && with_triangles && places[3 * p] >= 0) {
    write_row(p, with_neighbors, with_halfedges, places, links, scanned, triangles, neighbors, halfedges);
  }
  if (p < n && v >= 0 && is_on_hull(hull_links[v])) {
    const int at = place_on_hull(v, vertices, scanned), after = hull_links[v].x;
    const int is_last = after == NO_VERTEX || begins_hull(after, points, hull_links);
    hull_vertices[at] = v;
    ahead[at] = is_last ? VECTOR(int2, at, 0) : VECTOR(int2, place_on_hull(after, vertices, scanned), 1);
  }
}

// Hull vertex k looks HULL_HOPS times as far ahead (Wyllie, "The complexity of parallel computations", 1979, doubles).
static inline int2 farther_ahead(int k, global const int2* ahead) {
  int2 here = ahead[k];
  for (int hop = 1; hop < HULL_HOPS; ++hop) {
    const int2 there = ahead[here.x];
    here = VECTOR(int2, there.x, here.y + there.y);
  }
  return here;
}

// n hull vertices.
kernel void rank_hull(int n, global const int2* restrict from, global int2* restrict to) {
  const int k = get_global_id(0);
  if (k < n) to[k] = farther_ahead(k, from);
}

// Writes hull vertex k, which knows the distance to the end of its hull: beyond its begin only if walks of merges did
// not meet, which the host may not know yet. sizes: of measure_sets.
static inline void write_hull_vertex(int k, int sets, global const int* sizes, global const int* hull_vertices,
                                     int2 ahead, global const int* indices, global int* hull) {
  global const int* const hull_offsets = sizes + sets + 1;
  const int s = segment_of(k, sets, hull_offsets), size = hull_offsets[s + 1] - hull_offsets[s];
  if (ahead.y < size) hull[hull_offsets[s] + size - 1 - ahead.y] = indices[hull_vertices[k]];
}

// n hull vertices.
kernel void write_hull(int n, int sets, global const int* restrict sizes, global const int* restrict hull_vertices,
                       global const int2* restrict ahead, global const int* restrict indices,
                       global int* restrict hull) {
  const int k = get_global_id(0);
  if (k < n) write_hull_vertex(k, sets, sizes, hull_vertices, ahead[k], indices, hull);
}

// As rank_hull and write_hull, by the first work-group.
kernel void order_hull(int sets, global const int* restrict sizes, global const int* restrict hull_vertices,
                       global int2* ahead, global int2* spare, global const int* restrict indices,
                       global int* restrict hull) {
  const int me = get_local_id(0), lanes = get_local_size(0);
  const int n = get_group_id(0) == 0 ? sizes[2 * sets + 1] : 0;
  global int2 *from = ahead, *to = spare;
  for (int reach = 1; reach < n; reach *= HULL_HOPS) {
    for (int k = me; k < n; k += lanes) to[k] = farther_ahead(k, from);
    barrier(CLK_GLOBAL_MEM_FENCE);
    global int2* const ranked = to;
    to = from;
    from = ranked;
  }
  for (int k = me; k < n; k += lanes) write_hull_vertex(k, sets, sizes, hull_vertices, from[k], indices, hull);
}

// Where sets begin among the points that go on. n: the number of sets plus 1.
kernel void measure_open(int n, global const int* restrict set_points, global const uint2* restrict scanned,
                         global uint2* restrict sizes) {
  const int s = get_global_id(0);
  if (s < n) sizes[s] = scanned[set_points[s]];
}
