// Cavities: the triangles whose circumcircles contain a point that is to be inserted, as far as constraints let it see
// them. Around a point that splits a constraint, those on both of its sides.
//
// A cavity has no vertex inside, so its triangles are a tree. A tour around the tree meets the sides of the cavity
// counter-clockwise and needs memory only for the last steps of the way back: beyond them it tests again.
#ifndef FLAUNAY_CAVITIES_OF_POINTS_H
#define FLAUNAY_CAVITIES_OF_POINTS_H

#include "arithmetic/language.h"
#include "mesh/halfedges.h"
#include "operations/prefetch.h"
#include "predicates/planar.h"
#include "refinement/codes.h"
#include "refinement/records.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// The mesh, as kernels that only read it have it.
typedef struct {
  GLOBAL const mesh_row* rows;
  GLOBAL const double2* points;
} seen_mesh;

static inline int row_of(int corner) { return corner / 3; }
static inline int vertex_at(const seen_mesh* mesh, int corner) { return mesh->rows[corner / 3].corner[corner % 3]; }
static inline double2 point_at(const seen_mesh* mesh, int corner) { return mesh->points[vertex_at(mesh, corner)]; }
static inline int neighbor_at(const seen_mesh* mesh, int corner) { return mesh->rows[corner / 3].neighbor[corner % 3]; }
static inline int edge_at(const seen_mesh* mesh, int corner) { return mesh->rows[corner / 3].edge[corner % 3]; }

// The number of the corner that is opposite to a neighbour, and the corner. Without branches, since they could not be
// predicted. Others may change the row's other neighbours meanwhile, which does not matter.
#ifdef __cplusplus
#define neighbor_meanwhile(at) __atomic_load_n(at, __ATOMIC_RELAXED)
#else
#define neighbor_meanwhile(at) (*(at))
#endif
static inline int number_facing(GLOBAL const mesh_row* row, int neighbor) {
  const int is_first = neighbor_meanwhile(&row->neighbor[0]) == neighbor,
            is_second = neighbor_meanwhile(&row->neighbor[1]) == neighbor;
  return 2 - is_second - 2 * is_first;
}
// next_corner and corner_before, likewise without branches.
static inline int corner_after_any(int k) { return 1 << k & 3; }
static inline int corner_before_any(int k) { return 18 >> 2 * k & 3; }
static inline int corner_facing(const seen_mesh* mesh, int row, int neighbor) {
  return 3 * row + number_facing(&mesh->rows[row], neighbor);
}

// Fetches a row far ahead in a list, and for a nearer one the corners of its triangle and its neighbours.
#define ROWS_FAR_AHEAD 16
#define ROWS_AHEAD 8
#define ROWS_NEXT 4
// At most this many rows are in the cache, with everything that belongs to them.
#define ROWS_IN_CACHE 4096
FETCHING void fetch_row(const seen_mesh* mesh, int row) {
#if FETCH_AHEAD
  fetch(&mesh->rows[row]);
  fetch(&mesh->rows[row].parent);
#endif
}
FETCHING void fetch_corners(const seen_mesh* mesh, int row) {
#if FETCH_AHEAD
  for (int k = 0; k < 3; ++k) fetch(&mesh->points[max(0, mesh->rows[row].corner[k])]);
#endif
}
FETCHING void fetch_neighbors(const seen_mesh* mesh, int row) {
#if FETCH_AHEAD
  for (int k = 0; k < 3; ++k) fetch_row(mesh, max(0, neighbor_meanwhile(&mesh->rows[row].neighbor[k])));
#endif
}

// Never on the circle: see planar.h. With GHOSTS, rows beyond the hull have a corner at infinity, whose number is less
// than 0; their circle is the half-plane beyond their edge, with the inside of the edge.
static inline int is_in_circle(const seen_mesh* mesh, int row, double2 p) {
  GLOBAL const int* const corners = mesh->rows[row].corner;
#ifdef GHOSTS
  const int k = corners[0] < 0 ? 0 : corners[1] < 0 ? 1 : corners[2] < 0 ? 2 : -1;
  if (k >= 0) {
    const double2 from = mesh->points[corners[next_corner(k)]], to = mesh->points[corners[corner_before(k)]];
    const int side = orient_sign(from, to, p, ORIENT_BOUND);
    if (side != 0) return side > 0;
    return comes_before(from, p) ? comes_before(p, to) : comes_before(to, p) && comes_before(p, from);
  }
#endif
  return circle_canonical(mesh->points[corners[0]], mesh->points[corners[1]], mesh->points[corners[2]], p,
                          CIRCLE_BOUND) > 0;
}

// Whether p is in the place of a row's corner.
static inline int is_vertex(const seen_mesh* mesh, int row, double2 p) {
  for (int k = 0; k < 3; ++k) {
    const double2 q = point_at(mesh, 3 * row + k);
    if (q.x == p.x && q.y == p.y) return 1;
  }
  return 0;
}

#define TOUR_MEMORY 64

// The side that comes next is opposite to corner k of a row. The tour is over at the corner `end`.
typedef struct {
  int row, k, end, begins, depth;
  int back[TOUR_MEMORY];
} cavity_tour;

// A tour from this corner's row on, up to another corner, which may be the same.
static inline void start_tour(cavity_tour* tour, int corner, int end) {
  tour->row = row_of(corner);
  tour->k = corner - 3 * tour->row;
  tour->end = end;
  tour->begins = 1;
  tour->depth = 0;
}

// Goes on to the next side of the cavity of p and returns the corner of the row inside opposite to it; or to a row that
// the tour has not met yet, or not known for long, and returns it complemented. At the end returns NO_MORE.
#define NO_MORE INT_MIN
static inline int next_in_tour(cavity_tour* tour, const seen_mesh* mesh, double2 p) {
  for (;;) {
    const int row = tour->row, corner = 3 * row + tour->k;
    if (corner == tour->end && !tour->begins) return NO_MORE;
    tour->begins = 0;
    GLOBAL const mesh_row* const from = &mesh->rows[row];
    const int beyond = from->neighbor[tour->k];
    if (from->edge[tour->k] >= 0) {
      tour->k = next_corner(tour->k);
      return corner;
    }
    const int knows = tour->depth > 0 && tour->depth <= TOUR_MEMORY && beyond == tour->back[tour->depth - 1];
    if (!knows && !is_in_circle(mesh, beyond, p)) {
      tour->k = next_corner(tour->k);
      return corner;
    }
    tour->row = beyond;
    tour->k = next_corner(number_facing(&mesh->rows[beyond], row));
    if (knows) {
      --tour->depth;
    } else {
      // Where it has forgotten the way back, it never knows again whether it goes back.
      if (tour->depth < TOUR_MEMORY) tour->back[tour->depth] = row;
      if (tour->depth <= TOUR_MEMORY) ++tour->depth;
      return ~beyond;
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Points that split constraints

static inline double squared_distance(double2 a, double2 b) { return squared_length(b - a); }

// New coordinates near 0 are rounded so that predicates are exact. coarse: see refinement_rules.
static inline double rounded_to(double x, double coarse) {
  const double away = x < 0.0 ? -coarse : coarse;
  return fabs(x) < coarse ? (x + away) - away : x;
}

// The largest power of two that is not above x.
static inline double power_below(double x) { return as_double(as_ulong(x) & 0x7ff0000000000000UL); }

typedef struct {
  double2 point;
  edge_place at;
} split_place;

// Where the part of an edge between vertices a and b is split: in the middle; or if one of them is an apex, at a power
// of two from it, so that parts of all edges there have the same lengths (Ruppert's concentric shells). New vertices
// are computed from the ends of the whole edge, never from other rounded vertices.
static inline split_place place_of_split(int a, int b, int edge, GLOBAL const double2* points,
                                         GLOBAL const edge_place* places, GLOBAL const int* ends, int vertices,
                                         double coarse) {
  const int first = ends[2 * edge], last = ends[2 * edge + 1];
  const double length = sqrt(squared_distance(points[first], points[last]));
  const int is_apex_a = a < vertices && places[a].apex == a, is_apex_b = b < vertices && places[b].apex == b;
  // That of a vertex of the input is where it is on one of its edges, perhaps another one.
  const edge_place nowhere = {0.0, 0.0, -1, -1};
  const edge_place of_a = a < vertices && !is_apex_a ? nowhere : places[a],
                   of_b = b < vertices && !is_apex_b ? nowhere : places[b];
  const double part_a = a == first ? 0.0 : a == last ? 1.0 : of_a.part;
  const double part_b = b == first ? 0.0 : b == last ? 1.0 : of_b.part;
  split_place split;
  split.at.edge = edge;
  split.at.apex = -1;
  split.at.distance = 0.0;
  if (is_apex_a != is_apex_b) {
    const int apex = is_apex_a ? a : b;
    const edge_place other = is_apex_a ? of_b : of_a;
    split.at.apex = apex;
    split.at.distance = other.apex == apex ? other.distance / 2.0
                                           : power_below(sqrt(squared_distance(points[a], points[b])) * (2.0 / 3.0));
    const double part = split.at.distance / length;
    split.at.part = apex == first ? part : 1.0 - part;
  } else {
    split.at.part = (part_a + part_b) / 2.0;
    // The far end of an edge with an apex counts as being at the edge's length.
    int apex_a = of_a.apex, apex_b = of_b.apex;
    double distance_a = of_a.distance, distance_b = of_b.distance;
    if (apex_a < 0 && apex_b >= 0 && apex_b != a && (a == first || a == last)) {
      apex_a = apex_b;
      distance_a = length;
    }
    if (apex_b < 0 && apex_a >= 0 && apex_a != b && (b == first || b == last)) {
      apex_b = apex_a;
      distance_b = length;
    }
    if (apex_a >= 0 && apex_a == apex_b) {
      split.at.apex = apex_a;
      split.at.distance = (distance_a + distance_b) / 2.0;
    }
  }
  const int from_last = split.at.apex >= 0 && split.at.apex == last;
  const double2 origin = points[from_last ? last : first], goal = points[from_last ? first : last];
  const double part = split.at.apex >= 0 ? split.at.distance / length : split.at.part;
  split.point = VECTOR(double2, rounded_to(origin.x + part * (goal.x - origin.x), coarse),
                       rounded_to(origin.y + part * (goal.y - origin.y), coarse));
  return split;
}

// Whether a vertex around the cavity of p, or around one side of it, is nearer to p than this distance, squared.
static inline int is_near_vertex(const seen_mesh* mesh, int start, int end, double2 p, double distance) {
  cavity_tour tour;
  start_tour(&tour, start, end);
  for (int next = next_in_tour(&tour, mesh, p); next != NO_MORE; next = next_in_tour(&tour, mesh, p)) {
    if (next >= 0 && (squared_distance(p, point_at(mesh, next_halfedge(next))) < distance ||
                      squared_distance(p, point_at(mesh, previous_halfedge(next))) < distance))
      return 1;
  }
  return 0;
}

// Whether a point is strictly left of the two sides of a row that are not opposite to the corner, and in its circle. If
// rounding puts it beyond the constraint by more than the circle reaches, the row would have to stay.
static inline int is_before_sides(const seen_mesh* mesh, int corner, double2 p) {
  const double2 apex = point_at(mesh, corner), from = point_at(mesh, next_halfedge(corner)),
                to = point_at(mesh, previous_halfedge(corner));
  return orient_sign(to, apex, p, ORIENT_BOUND) > 0 && orient_sign(apex, from, p, ORIENT_BOUND) > 0 &&
         is_in_circle(mesh, row_of(corner), p);
}

// Whether the constraint opposite to a corner may be split at p: then no triangle turns over, and all edges that are
// left are locally Delaunay.
static inline int can_split_at(const seen_mesh* mesh, int corner, double2 p) {
  const int beyond = neighbor_at(mesh, corner);
  return is_before_sides(mesh, corner, p) &&
         (beyond < 0 || is_before_sides(mesh, corner_facing(mesh, beyond, row_of(corner)), p));
}

END_SHARED

#endif

#endif
