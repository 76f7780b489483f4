// What is bad, of one triangle each. Segments: none; one pass each.
//
// load_rows: the rows of the mesh, from the arrays of the host. test_rows, over those that the last round has made:
// whether triangles are bad, with their keys, and which of their constraints they encroach. find_unchanged, over the
// list of bad triangles: which are as they were. make_again: those that are tried once more. append_made: makes the
// next list. find_parents: the triangles of the mesh at first whose areas count, by centroids. write_centroids: places
// at which the host asks for areas. report_rows: why triangles are bad in the end.

#include "refinement/arguments.h"
#include "refinement/quality_of_rows.h"
#include "refinement/records.h"

#ifndef FIXED_POINT

kernel void load_rows(int n, global const int* restrict triangles, global const int* restrict neighbors,
                      global const int* restrict edges, global mesh_row* restrict rows, global int2* restrict made) {
  const int t = get_global_id(0);
  if (t < n) {
    for (int k = 0; k < 3; ++k) {
      rows[t].corner[k] = triangles[3 * t + k];
      rows[t].neighbor[k] = neighbors[3 * t + k];
      rows[t].edge[k] = edges[3 * t + k];
    }
    rows[t].parent = t;
    rows[t].changed = 0;
    made[t] = VECTOR(int2, t, triangles[3 * t]);
  }
}

// Whether a row is still the one that was made, with this first vertex; a later step may have used it again.
static inline int is_as_made(int2 made, global const mesh_row* rows) {
  return made.x >= 0 && rows[made.x].corner[0] == made.y;
}

// Whether an apex of the triangles beside a constraint encroaches it. The one beyond may be as it was when rounding did
// not allow to split the constraint.
static inline int is_encroached_from_a_side(const seen_mesh* mesh, int corner, refinement_rules rules) {
  const int beyond = neighbor_at(mesh, corner);
  return encroaches(mesh, corner, point_at(mesh, corner), rules) ||
         (beyond >= 0 && encroaches(mesh, corner, point_at(mesh, corner_facing(mesh, beyond, row_of(corner))), rules));
}

// made: rows and their first vertices, or less than 0. keys: per row. bad: 1 or 0. split_bits: a bit per corner whose
// opposite constraint is to be split; encroached: whether there is one.
kernel void test_rows(int n, refinement_rules rules, global const int2* restrict made, REFINED_MESH(),
                      global uint64* restrict keys, global uchar* restrict bad, global uchar* restrict encroached,
                      global uchar* restrict split_bits) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    int is_bad = 0, splits = 0;
#if FETCH_AHEAD
    const int far = max(0, made[min(n - 1, i + ROWS_FAR_AHEAD)].x);
    fetch_row(&mesh, far);
    fetch(&keys[far]);
    fetch_corners(&mesh, max(0, made[min(n - 1, i + ROWS_AHEAD)].x));
#endif
    if (is_as_made(made[i], rows)) {
      const int row = made[i].x;
      double2 p[3];
      for (int k = 0; k < 3; ++k) p[k] = points[rows[row].corner[k]];
      const int is_large = is_too_large(&mesh, row, p, rules, areas);
      is_bad = is_large || is_angle_below(p[0], p[1], p[2], rules.squared_sine);
      keys[row] = NO_KEY;
      if (is_bad) {
        const ordered_triangle triangle = ordered(&mesh, row);
        is_bad = is_large || excuse_of(&mesh, &triangle, places, ends, wedges, rules.vertices) == EXCUSED_NOT;
        if (is_bad) keys[row] = key_of(&triangle, is_large);
      }
      for (int k = 0; k < 3; ++k) {
        const int corner = 3 * row + k;
        if (rows[row].edge[k] >= 0 && is_encroached_from_a_side(&mesh, corner, rules) &&
            why_not_split(&mesh, corner, places, ends, rules) == EXCUSED_NOT)
          splits |= 1 << k;
      }
    }
    bad[i] = (uchar)is_bad;
    encroached[i] = splits != 0;
    split_bits[i] = (uchar)splits;
  }
}

kernel void find_unchanged(int n, global const int* restrict list, global const uint64* restrict keys,
                           global uchar* restrict unchanged) {
  const int i = get_global_id(0);
  if (i < n) unchanged[i] = keys[list[i]] != NO_KEY;
}

// Lists the n rows at these positions as if they had been made again, so that they are tested anew.
kernel void make_again(int n, global const int* restrict positions, global const mesh_row* restrict rows,
                       global uchar* restrict refused, global int2* restrict made) {
  const int i = get_global_id(0);
  if (i < n) {
    const int row = positions[i], first = rows[row].corner[0];
    refused[row] = EXCUSED_NOT;
    made[i] = VECTOR(int2, first == NO_TRIANGLE ? -1 : row, first);
  }
}

// The n rows at these positions go to a list, from its element `first` on.
kernel void append_made(int n, int first, global const int* restrict positions, global const int2* restrict made,
                        global int* restrict list) {
  const int i = get_global_id(0);
  if (i < n) list[first + i] = made[positions[i]].x;
}
kernel void gather_elements(int n, global const int* restrict positions, global const int* restrict from,
                            global int* restrict list) {
  const int i = get_global_id(0);
  if (i < n) list[i] = from[positions[i]];
}

static inline double2 centroid_of(const seen_mesh* mesh, int row) {
  const ordered_triangle triangle = ordered(mesh, row);
  const double2* const p = triangle.point;
  return VECTOR(double2, (p[0].x + p[1].x + p[2].x) / 3.0, (p[0].y + p[1].y + p[2].y) / 3.0);
}

// Whether p is beyond the side opposite to a corner. On the line, a point counts as a little to the right, and less
// above, so that it is in one triangle only.
static inline int is_beyond(const seen_mesh* mesh, int corner, double2 p) {
  const double2 from = point_at(mesh, next_halfedge(corner)), to = point_at(mesh, previous_halfedge(corner));
  const int side = orient_sign(from, to, p, ORIENT_BOUND);
  return side < 0 || (side == 0 && (to.y > from.y || (to.y == from.y && to.x < from.x)));
}

// The triangle with p in it, by a walk that begins at a row and crosses no constraint. Which sides it tries first does
// not depend on numbers.
static inline int walk_within(const seen_mesh* mesh, int row, double2 p) {
  for (;;) {
    const ordered_triangle triangle = ordered(mesh, row);
    int next = -1;
    for (int k = 0; k < 3 && next < 0; ++k) {
      const int corner = triangle.corner[k];
      if (edge_at(mesh, corner) < 0 && is_beyond(mesh, corner, p)) next = neighbor_at(mesh, corner);
    }
    if (next < 0) return row;
    row = next;
  }
}

// n elements of made: their parents are the triangles of the mesh at first with their centroids in them. given: the
// rows of that mesh.
kernel void find_parents(int n, refinement_rules rules, global const int2* restrict made,
                         global const mesh_row* restrict given, global const double2* restrict points,
                         global mesh_row* restrict rows) {
  const int i = get_global_id(0);
  if (i < n && is_as_made(made[i], rows)) {
    const seen_mesh mesh = {rows, points}, before = {given, points};
    const double2 p = centroid_of(&mesh, made[i].x);
    const double2 place = VECTOR(double2, rounded_to(p.x, rules.coarse), rounded_to(p.y, rules.coarse));
    rows[made[i].x].parent = walk_within(&before, rows[made[i].x].parent, place);
  }
}

// n elements of made; x and y of those that are no rows any more are not a number.
kernel void write_centroids(int n, global const int2* restrict made, REFINED_MESH(),
                            global double2* restrict centroids) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    centroids[i] = is_as_made(made[i], rows) ? centroid_of(&mesh, made[i].x) : VECTOR(double2, NAN, NAN);
  }
}

// n elements of made: the areas that the host was given for them, and those of their parents, if these have some.
kernel void set_areas(int n, int has_parents, global const int2* restrict made, global const mesh_row* restrict rows,
                      global const double* restrict given, global const double* restrict parent_areas,
                      global double* restrict areas) {
  const int i = get_global_id(0);
  if (i < n && is_as_made(made[i], rows)) {
    const int row = made[i].x;
    areas[row] = has_parents ? smaller_area(given[i], parent_areas[rows[row].parent]) : given[i];
  }
}

// Why constraints of a row that an angle opposite to them encroaches were not split; EXCUSED_NOT without such.
static inline int why_encroaching(const seen_mesh* mesh, int row, global const edge_place* places,
                                  global const int* ends, refinement_rules rules) {
  for (int corner = 3 * row; corner < 3 * row + 3; ++corner) {
    if (edge_at(mesh, corner) < 0 || !encroaches(mesh, corner, point_at(mesh, corner), rules)) continue;
    const int reason = why_not_split(mesh, corner, places, ends, rules);
    return reason == EXCUSED_NOT ? EXCUSED_LIMIT : reason;
  }
  return EXCUSED_NOT;
}

// n rows: EXCUSED_NOT of those that are good enough.
kernel void report_rows(int n, refinement_rules rules, REFINED_MESH(), global const uchar* restrict refused,
                        global uchar* restrict excuses) {
  const int row = get_global_id(0);
  if (row < n) {
    const seen_mesh mesh = {rows, points};
    int excuse = EXCUSED_NOT;
    if (rows[row].corner[0] != NO_TRIANGLE) {
      double2 p[3];
      for (int k = 0; k < 3; ++k) p[k] = points[rows[row].corner[k]];
      const int reason = refused[row] == EXCUSED_NOT ? EXCUSED_LIMIT : refused[row];
      if (is_too_large(&mesh, row, p, rules, areas)) {
        excuse = reason;
      } else if (is_angle_below(p[0], p[1], p[2], rules.squared_sine)) {
        const ordered_triangle triangle = ordered(&mesh, row);
        excuse = excuse_of(&mesh, &triangle, places, ends, wedges, rules.vertices);
        if (excuse == EXCUSED_NOT) excuse = reason;
      }
      if (excuse == EXCUSED_NOT && rules.squared_cosine == 0.0)
        excuse = why_encroaching(&mesh, row, places, ends, rules);
    }
    excuses[row] = (uchar)excuse;
  }
}

#endif
