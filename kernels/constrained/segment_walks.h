// Walks along segments through a triangulation, for the insertion of constraints.
//
// Corner 3t + k of triangle t stands for the vertex there and for the edge opposite to it. Each decision is exact.
#ifndef FLAUNAY_SEGMENT_WALKS_H
#define FLAUNAY_SEGMENT_WALKS_H

#include "arithmetic/language.h"
#include "constrained/limits.h"
#include "mesh/halfedges.h"
#include "predicates/planar.h"

BEGIN_SHARED

// bound: of orientations, see predicates/bounds.h.
typedef struct {
  GLOBAL const coordinate* points;
  GLOBAL const int* triangles;
  GLOBAL const int* neighbors;
  filter_bound bound;
} walked_mesh;

// The corner of a row that holds a vertex, or that is opposite to a neighbour. Without branches, since they could not
// be predicted.
static inline int corner_with(int row, int value, GLOBAL const int* values) {
  const int at = 3 * row, is_0 = values[at] == value, is_1 = values[at + 1] == value;
  return at + (is_0 ? 0 : is_1 ? 1 : 2);
}

// The bit in a row's byte of constraint flags of the edge opposite to a corner.
static inline uint edge_flag(int corner) { return 1u << corner % 3; }

// How the segment from one vertex to another leaves the first.
typedef struct {
  int corner;  // opposite to the edge that it crosses, or that it runs along
  int vertex;  // the other end of the edge that it runs along; -1 if it crosses
} departure;

// A search for the departure around a vertex, triangle by triangle: the corner there, and the sides of the segment's
// line on which the next and the previous corner of its triangle are.
typedef struct {
  coordinate2 at, goal_at;
  int goal, origin;
  int first, first_next_side, first_previous_side;
  int corner, next_side, previous_side;
  int turn;        // 1: counter-clockwise, -1: clockwise, 0: not chosen yet
  int met_border;  // whether the search has begun again in the other direction
} star_search;

static inline int side_of_segment(const walked_mesh* mesh, coordinate2 from, coordinate2 to, int goal, int v) {
#ifdef FIXED_POINT
  // A filter would take about as long, and more registers.
  return v == goal ? 0 : orient_exact(from, to, vload2(v, mesh->points));
#else
  return v == goal ? 0 : orient_sign(from, to, vload2(v, mesh->points), mesh->bound);
#endif
}

static inline star_search star_search_at(const walked_mesh* mesh, int corner, int goal) {
  star_search star;
  star.origin = mesh->triangles[corner];
  star.goal = goal;
  star.at = vload2(star.origin, mesh->points);
  star.goal_at = vload2(goal, mesh->points);
  star.corner = star.first = corner;
  star.next_side = star.first_next_side =
      side_of_segment(mesh, star.at, star.goal_at, goal, mesh->triangles[next_halfedge(corner)]);
  star.previous_side = star.first_previous_side =
      side_of_segment(mesh, star.at, star.goal_at, goal, mesh->triangles[previous_halfedge(corner)]);
  star.turn = star.met_border = 0;
  return star;
}

// Whether a vertex on the line is on the goal's side of the origin.
static inline int is_ahead(const walked_mesh* mesh, const star_search* star, int v) {
  return comes_before(star->at, vload2(v, mesh->points)) == comes_before(star->at, star->goal_at);
}

// The corner opposite to the edge between the vertex at a corner and another vertex, if it is one of the first edges
// counter-clockwise from there; otherwise -1.
static inline int corner_at_edge(const walked_mesh* mesh, int corner, int goal) {
  const int origin = mesh->triangles[corner];
  if (mesh->triangles[next_halfedge(corner)] == goal) return previous_halfedge(corner);
  for (int k = 0; k < STAR_PATIENCE; ++k) {
    const int next = next_halfedge(corner);
    if (mesh->triangles[previous_halfedge(corner)] == goal) return next;
    const int beyond = mesh->neighbors[next];
    if (beyond < 0) return -1;
    corner = corner_with(beyond, origin, mesh->triangles);
  }
  return -1;
}

// Outcomes of a step.
#define STAR_GOES_ON 0
#define STAR_FOUND 1
#define STAR_BROKEN 2

// Looks at one triangle.
static inline int star_search_step(const walked_mesh* mesh, star_search* star, departure* found) {
  const int corner = star->corner, next = next_halfedge(corner), previous = previous_halfedge(corner);
  found->corner = corner;
  found->vertex = -1;
  if (star->next_side < 0 && star->previous_side > 0) return STAR_FOUND;
  if (star->next_side == 0 && is_ahead(mesh, star, mesh->triangles[next])) {
    found->corner = previous;
    found->vertex = mesh->triangles[next];
    return STAR_FOUND;
  }
  if (star->previous_side == 0 && is_ahead(mesh, star, mesh->triangles[previous])) {
    found->corner = next;
    found->vertex = mesh->triangles[previous];
    return STAR_FOUND;
  }
  // To the side on which less than half a turn leads to the segment.
  if (star->turn == 0) star->turn = star->next_side > 0 ? -1 : 1;
  int row = mesh->neighbors[star->turn > 0 ? next : previous];
  if (row < 0) {
    if (star->met_border) return STAR_BROKEN;
    star->met_border = 1;
    star->turn = -star->turn;
    star->next_side = star->first_next_side;
    star->previous_side = star->first_previous_side;
    row = mesh->neighbors[star->turn > 0 ? next_halfedge(star->first) : previous_halfedge(star->first)];
    if (row < 0) return STAR_BROKEN;
  }
  star->corner = corner_with(row, star->origin, mesh->triangles);
  if (star->corner == star->first) return STAR_BROKEN;
  if (star->turn > 0) {
    star->next_side = star->previous_side;
    star->previous_side =
        side_of_segment(mesh, star->at, star->goal_at, star->goal, mesh->triangles[previous_halfedge(star->corner)]);
  } else {
    star->previous_side = star->next_side;
    star->next_side =
        side_of_segment(mesh, star->at, star->goal_at, star->goal, mesh->triangles[next_halfedge(star->corner)]);
  }
  return STAR_GOES_ON;
}

// Which end find_departure has found.
#define LEAVES_FIRST 0
#define LEAVES_SECOND 1
#define LEAVES_NONE 2

// Looks around both ends of a segment in turns. begun: the search around the first end. Out of line and with
// both searches in memory, as this is rare, and kernels have more registers without.
OUT_OF_LINE static inline int find_departure_in_turns(walked_mesh mesh, star_search begun, int second,
                                                      departure* found) {
  star_search stars[2];
  stars[LEAVES_FIRST] = begun;
  stars[LEAVES_SECOND] = star_search_at(&mesh, second, begun.origin);
  for (int end = LEAVES_SECOND;; end ^= LEAVES_FIRST ^ LEAVES_SECOND) {
    const int outcome = star_search_step(&mesh, &stars[end], found);
    if (outcome != STAR_GOES_ON) return outcome == STAR_FOUND ? end : LEAVES_NONE;
  }
}

// Finds how the segment between the vertices at two corners leaves one of them. If that takes long, looks around both
// in turns, so it takes O(the smaller of their numbers of edges).
static inline int find_departure(const walked_mesh* mesh, int first, int second, departure* found) {
  star_search star = star_search_at(mesh, first, mesh->triangles[second]);
  for (int k = 0; k <= STAR_PATIENCE; ++k) {
    const int outcome = star_search_step(mesh, &star, found);
    if (outcome != STAR_GOES_ON) return outcome == STAR_FOUND ? LEAVES_FIRST : LEAVES_NONE;
  }
  departure late;
  const int end = find_departure_in_turns(*mesh, star, second, &late);
  *found = late;
  return end;
}

END_SHARED

#endif
