// The search for the nearest vertex of a triangulation.
//
// From a vertex near the query one mostly gets to the nearest by a few greedy steps along edges. Some meshes have
// queries for which that takes a number of steps in proportion to the number of points: points on a curve, and vertices
// with very many neighbours. A walk that takes long is given up; the search then is made through levels (Devillers,
// "The Delaunay hierarchy", 2002): triangulations of samples of the vertices, of samples of these samples, and so on.
// The nearest vertex of a level is where the greedy steps on the level below begin. As long as the samples do not know
// of the query, about as many vertices as a sample stands for are nearer to it than that, wherever the points are.
//
// Vertices with very many neighbours are of two kinds. The first vertex of a cocircular polygon is joined to all
// others, but a step need not look at those between the two that are its neighbours along the polygon: see `fan_part`.
// For all others, the last search is made in a tree of boxes around vertices.
#ifndef FLAUNAY_NEAREST_SEARCH_H
#define FLAUNAY_NEAREST_SEARCH_H

#include "arithmetic/language.h"
#include "arithmetic/records.h"
#include "locate/query_frames.h"
#include "locate/records.h"
#include "mesh/halfedges.h"
#include "mesh/records.h"
#include "predicates/nearness.h"

BEGIN_SHARED

// Neighbours that a step looks at before the vertex counts as one with very many; nodes of the tree of boxes that are
// looked at before the search returns to the neighbours: where all vertices are about as near, boxes do not help.
INTEGER_CONSTANT(MANY_NEIGHBORS, 64);
INTEGER_CONSTANT(MOST_BOXES, 512);

// Vertices of a box of the lowest level, and boxes of a box of any other; levels that indices can need.
INTEGER_CONSTANT(BOX_FAN, 8);
INTEGER_CONSTANT(BOX_LEVELS, 12);

static inline int corner_at(face f, int vertex) { return f.corner[0] == vertex ? 0 : f.corner[1] == vertex ? 1 : 2; }

// A triangulation, as locators have it; points are scaled by `unit` more, as queries are. Where there are levels:
// a triangle of each vertex, on the hull the first one counter-clockwise; the parts of fans.
typedef struct {
  GLOBAL const coordinate2* points;
  GLOBAL const face* faces;
  GLOBAL const int* clearances;
  GLOBAL const int* starts;
  GLOBAL const fan_part* fans;
} star_mesh;

// The nearest vertex known so far, a triangle that has it as a corner, and where it is.
typedef struct {
  int vertex, triangle;
  coordinate2 at;
} nearby;

// If two vertices are equally near, the first in the order of x and y is taken.
static inline void consider(nearby* best, int vertex, int triangle, coordinate2 q, filter_bound bound, coordinate unit,
                            GLOBAL const coordinate2* points) {
  const coordinate2 p = in_frame(points[vertex], unit);
  const int sign = nearness_sign(best->at, p, q, bound);
  if (sign > 0 || (sign == 0 && comes_before(p, best->at))) {
    best->vertex = vertex;
    best->triangle = triangle;
    best->at = p;
  }
}

// A vertex' clearance is the square of the distance to its nearest neighbour, as the bits of a float or the upper half
// of a double's, which are in the order of the numbers. In the frame of queries it is rounded downwards, or to nearest.
#ifdef FIXED_POINT
static inline int clearance_bits(real squared) { return as_int(squared); }
// Vertices are at least 1 apart in either frame: nothing underflows.
static inline real clearance_in_frame(int bits, coordinate unit) {
  return as_float(bits) * as_float((127 + 2 * (int)unit) << 23);
}
#define LEAST_CLEARANCE 0
#else
static inline int clearance_bits(real squared) { return (int)(as_ulong(squared) >> 32); }
static inline real clearance_in_frame(int bits, coordinate unit) {
  return as_double((uint64)(uint)bits << 32) * unit * unit;
}
#define LEAST_CLEARANCE 0x1p-1000
#endif

// Whether q is nearer to the vertex than half its clearance: nothing is as near then. So the neighbours of a vertex
// that has very many mostly need not be looked at. Rounding is below the margin, as long as there is no underflow: in
// single precision both sides are right but for 5 roundings.
#define CLEARANCE_MARGIN (1 + REAL(0x1p-19))
static inline int is_clear(nearby vertex, coordinate2 q, coordinate unit, GLOBAL const int* clearances) {
  const real clearance = clearance_in_frame(clearances[vertex.vertex], unit);
  return clearance > LEAST_CLEARANCE && 4 * CLEARANCE_MARGIN * squared_length(difference2(q, vertex.at)) < clearance;
}

// The nearest of points in their order on a line, or -1: distances fall, then rise, with two equal at most.
static inline int nearest_on_line(coordinate2 q, int first, int end, filter_bound bound, coordinate unit,
                                  GLOBAL const coordinate2* hull_points) {
  if (first == end) return -1;
  int low = first, high = end - 1;
  while (low < high) {
    const int middle = low + (high - low) / 2;
    const coordinate2 a = in_frame(hull_points[middle], unit), b = in_frame(hull_points[middle + 1], unit);
    if (nearness_sign(a, b, q, bound) > 0) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

// ---------------------------------------------------------------------------------------------------------------------
// Greedy steps

// The last triangle, counter-clockwise about the vertex, of the fan that t belongs to if the vertex is the fan's first.
static inline int last_of_fan(int t, int vertex, GLOBAL const fan_part* fans) {
  const fan_part part = fans[t];
  return part.vertex == vertex ? part.last : t;
}

// The best of a vertex and its neighbours, but for those between the first and the last neighbour in a fan. An edge to
// such a neighbour lies inside of a cocircular polygon, so the two cells touch in no more than a point: if it is nearer
// to q than the vertex, or as near and comes before it, so is another neighbour. Stops when `most` were looked at, and
// returns whether these were all. looked: gets their number added.
static inline int look_around(nearby vertex, coordinate2 q, filter_bound bound, coordinate unit, star_mesh mesh,
                              uint most, nearby* best, uint* looked) {
  *best = vertex;
  const int start = mesh.starts[vertex.vertex];
  const face beside = mesh.faces[start];
  consider(best, beside.corner[next_corner(corner_at(beside, vertex.vertex))], start, q, bound, unit, mesh.points);
  const int first = last_of_fan(start, vertex.vertex, mesh.fans);
  int t = first;
  for (uint count = 1; count <= most; ++count) {
    const face f = mesh.faces[t];
    const int at = corner_at(f, vertex.vertex);
    consider(best, f.corner[corner_before(at)], t, q, bound, unit, mesh.points);
    const int next = f.neighbor[next_corner(at)];
    if (next >= 0) t = last_of_fan(next, vertex.vertex, mesh.fans);
    if (next < 0 || t == first) {
      *looked += count + 1;
      return 1;
    }
  }
  *looked += most + 1;
  return 0;
}

// Goes to the best neighbour until none is better. In a Delaunay triangulation a vertex that is not nearest has a
// neighbour that is nearer; those that are nearest with others lie on one empty circle, whose first vertex is joined to
// all. Stops at a vertex with very many neighbours if the first of them are not better, and returns 0.
static inline int go_to_nearest(nearby* best, coordinate2 q, filter_bound bound, coordinate unit, star_mesh mesh,
                                uint* looked) {
  for (;;) {
    if (is_clear(*best, q, unit, mesh.clearances)) return 1;
    nearby next;
    const int all = look_around(*best, q, bound, unit, mesh, MANY_NEIGHBORS, &next, looked);
    if (next.vertex == best->vertex) return all;
    *best = next;
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Boxes

// Finds the number of boxes of each level, from the lowest, and where the level begins. Returns the number of
// levels, 0 without vertices. The highest level has one box.
static inline int box_levels(int vertices, int* counts, int* begins) {
  int levels = 0, begin = 0, count = vertices;
  while (vertices > 0 && (levels == 0 || count > 1)) {
    count = (count - 1) / BOX_FAN + 1;
    counts[levels] = count;
    begins[levels++] = begin;
    begin += count;
  }
  return levels;
}

// Whether all points of the box are farther from q than a point with that square of the distance, both rounded; each is
// right but for less than 4 roundings, and nothing underflows.
#ifdef FIXED_POINT
#define DISTANCE_MARGIN (1 + 0x1p-19f)
#else
#define DISTANCE_MARGIN (1 + 0x1p-48)
#endif
static inline real distance_beyond(coordinate low, coordinate high, coordinate q) {
  return q < low ? difference(low, q) : q > high ? difference(q, high) : 0;
}
static inline int is_beyond(vertex_box box, real squared, coordinate2 q, coordinate unit) {
  const coordinate2 low = in_frame(box.low, unit), high = in_frame(box.high, unit);
  const real x = distance_beyond(low.x, high.x, q.x), y = distance_beyond(low.y, high.y, q.y);
  return x * x + y * y > squared * DISTANCE_MARGIN;
}

static inline real squared_distance(coordinate2 a, coordinate2 b) { return squared_length(difference2(a, b)); }

// The best of vertices [first, end) and one that is given. Goes through the tree, of boxes around all `vertices`, in
// the order of the vertices, and leaves out boxes that are farther than the best so far. Returns 0 if it gives up.
static inline int search_boxes(nearby* best, coordinate2 q, int first, int end, int vertices, filter_bound bound,
                               coordinate unit, star_mesh mesh, GLOBAL const vertex_box* boxes, uint* looked) {
  int counts[BOX_LEVELS], begins[BOX_LEVELS];
  int level = box_levels(vertices, counts, begins) - 1;
  const int top = level;
  int i = 0;
  int64 width = BOX_FAN;  // vertices of a box
  for (int l = 0; l < level; ++l) width *= BOX_FAN;
  real squared = squared_distance(best->at, q);
  for (int seen = 0; seen < MOST_BOXES; ++seen) {
    const int is_needed =
        i * width < end && (i + 1) * width > first && !is_beyond(boxes[begins[level] + i], squared, q, unit);
    if (is_needed && level > 0) {
      --level;
      width /= BOX_FAN;
      i *= BOX_FAN;
      continue;
    }
    if (is_needed) {
      for (int v = max(first, BOX_FAN * i); v < min(end, BOX_FAN * (i + 1)); ++v) {
        if (v != best->vertex) consider(best, v, mesh.starts[v], q, bound, unit, mesh.points);
        ++*looked;
      }
      squared = squared_distance(best->at, q);
    }
    ++i;
    while (level < top && (i % BOX_FAN == 0 || i == counts[level])) {
      ++level;
      width *= BOX_FAN;
      i = (i - 1) / BOX_FAN + 1;
    }
    if (i == counts[level]) {
      *looked += seen + 1;
      return 1;
    }
  }
  *looked += MOST_BOXES;
  return 0;
}

// ---------------------------------------------------------------------------------------------------------------------
// Levels

// The levels of a locator: `levels` of them, of `sets` sets each, from the largest samples on. Per set of a level its
// record; per vertex of a sample its entry, and per entry the vertex below it, on the level below or of the mesh
// itself.
typedef struct {
  int levels, sets;
  GLOBAL const mesh_set* records;
  GLOBAL const int* source;
  GLOBAL const int* below;
  GLOBAL const coordinate2* hull_points;
  GLOBAL const int* hull;
  star_mesh samples;
} level_meshes;

// The nearest vertex of set `set`, which has triangles and levels, and vertices [first, end). looked: gets the number
// of vertices and boxes that were looked at.
OUT_OF_LINE static inline int nearest_by_levels(coordinate2 q, int set, int first, int end, int vertices,
                                                filter_bound bound, coordinate unit, star_mesh mesh,
                                                GLOBAL const vertex_box* boxes, level_meshes on, uint* looked) {
  nearby best;
  int vertex = -1;
  for (int level = on.levels - 1; level >= 0; --level) {
    const mesh_set record = on.records[level * on.sets + set];
    int entry = -1;
    if (record.triangles > 0) {
      best.vertex = vertex >= 0 ? vertex : on.samples.faces[record.starts].corner[0];
      best.triangle = -1;
      best.at = in_frame(on.samples.points[best.vertex], unit);
      go_to_nearest(&best, q, bound, unit, on.samples, looked);
      entry = on.source[best.vertex];
    } else {
      const int at = nearest_on_line(q, record.hull, record.hull_end, bound, unit, on.hull_points);
      if (at >= 0) entry = on.hull[at];
    }
    if (entry >= 0) vertex = on.below[entry];
  }
  best.vertex = vertex >= 0 ? vertex : first;
  best.triangle = -1;
  best.at = in_frame(mesh.points[best.vertex], unit);
  while (!go_to_nearest(&best, q, bound, unit, mesh, looked)) {
    if (search_boxes(&best, q, first, end, vertices, bound, unit, mesh, boxes, looked)) return best.vertex;
    nearby next;
    look_around(best, q, bound, unit, mesh, 0x7fffffff, &next, looked);
    if (next.vertex == best.vertex) break;
    best = next;
  }
  return best.vertex;
}

END_SHARED

#endif
