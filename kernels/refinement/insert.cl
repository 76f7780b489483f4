// Points are put into the mesh, those whose cavities are apart at once. Segments: the cavities. One work-item per
// point; steps of three passes each, until no point waits.
//
// start_splits and start_points: what is to be inserted, in the order of ranks. claim_points finds the cavities in the
// mesh as it is now and claims their rows by atomic minima; gather_stars, after a scan of the numbers of sides, lists
// the sides of cavities that have no row, and no row beside them, of a point with a smaller rank; insert_stars writes a
// triangle for each side. The rows of a cavity are used again, and so are two rows that were set aside.
// freeze_constraints: those that could not be split. sort keys of constraints: constraint_keys; find_new: each
// constraint once.

#include "constrained/meanwhile.h"
#include "operations/prefetch.h"
#include "refinement/arguments.h"
#include "refinement/claimed_cavities.h"
#include "refinement/limits.h"
#include "refinement/quality_of_rows.h"
#include "refinement/records.h"

#ifndef FIXED_POINT

// ---------------------------------------------------------------------------------------------------------------------
// Constraints that are split

// n elements of made, at these positions, whose constraints are to be split as the bits say: the corners opposite,
// three elements each, those that are none less than 0.
kernel void list_encroached(int n, global const int* restrict positions, global const int2* restrict made,
                            global const uchar* restrict split_bits, global int* restrict corners) {
  const int i = get_global_id(0);
  if (i < n) {
    for (int k = 0; k < SLOTS_PER_ROW; ++k) {
      corners[SLOTS_PER_ROW * i + k] = split_bits[positions[i]] >> k & 1 ? 3 * made[positions[i]].x + k : -1;
    }
  }
}

// Their keys: hashes of their ends, whichever side they are seen from.
kernel void constraint_keys(int n, global const int* restrict corners, REFINED_MESH(), global uint64* restrict keys) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    uint64 key = NO_KEY;
    if (corners[i] >= 0) {
      const double2 a = point_at(&mesh, next_halfedge(corners[i])), b = point_at(&mesh, previous_halfedge(corners[i]));
      key = comes_before(a, b) ? hash_with(hash_with(0, a), b) : hash_with(hash_with(0, b), a);
      key = min(key, NO_KEY - 1);
    }
    keys[i] = key;
  }
}

// corners: sorted by their keys. is_new: whether no corner before is opposite to the same constraint.
kernel void find_new(int n, global const uint64* restrict keys, global const int* restrict corners,
                     global const mesh_row* restrict rows, global uchar* restrict is_new) {
  const int i = get_global_id(0);
  if (i < n) {
    int found = keys[i] != NO_KEY;
    for (int j = i - 1; found && j >= 0 && keys[j] == keys[i]; --j) {
      const int row = row_of(corners[i]);
      found = corners[j] != corners[i] && !(rows[row].neighbor[corners[i] % 3] == row_of(corners[j]) &&
                                            rows[row_of(corners[j])].neighbor[corners[j] % 3] == row);
    }
    is_new[i] = (uchar)found;
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// What is inserted

// Rows that are set aside for a point have no triangle as long as it is not inserted.
static inline void clear_row(int row, global mesh_row* rows, global uint64* row_keys, global uint* claims,
                             global uint* visits) {
  rows[row].corner[0] = NO_TRIANGLE;
  row_keys[row] = NO_KEY;
  claims[row] = visits[row] = UNCLAIMED_ROW;
}

// n constraints, in the order of their ranks, at these positions of corners.
kernel void start_splits(int n, refinement_rules rules, int first_vertex, int first_row,
                         global const int* restrict positions, global const int* restrict corners,
                         global const int* restrict ends, global mesh_row* restrict rows,
                         global double2* restrict points, global edge_place* restrict places,
                         global uint64* restrict row_keys, global uint* restrict claims, global uint* restrict visits,
                         global insertion* restrict insertions, global uchar* restrict states) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    const int corner = corners[positions[i]], v = first_vertex + i;
    insertion made;
    made.vertex = v;
    made.corner = corner;
    made.known = -1;
    made.rank = (uint)i;
    made.from = vertex_at(&mesh, next_halfedge(corner));
    made.to = vertex_at(&mesh, previous_halfedge(corner));
    made.count = made.seen = 0;
    made.first_row = first_row + 2 * i;
    const split_place split = place_of_split(made.from, made.to, edge_at(&mesh, corner) & EDGE_NUMBER, points, places,
                                             ends, rules.vertices, rules.coarse);
    points[v] = split.point;
    places[v] = split.at;
    for (int k = 0; k < 2; ++k) clear_row(made.first_row + k, rows, row_keys, claims, visits);
    insertions[i] = made;
    states[i] = POINT_WAITS;
  }
}

kernel void list_places(int n, global const int* restrict positions, global const int* restrict order,
                        global int* restrict places_of) {
  const int i = get_global_id(0);
  if (i < n) places_of[order[positions[i]]] = i;
}

// n proposals, of which the points are inserted; places_of: their places in the order of keys. At most `most` are
// inserted. Ranks are behind those of `first` constraints, and shuffled: points whose cavities overlap one after the
// other would wait for each other in long chains. Vertices and rows are numbered in the order of the list, which is
// that of places in the plane, more or less.
kernel void start_points(int n, int step, int first, uint mask, int most, int first_vertex, int first_row,
                         global const int* restrict list, global const int* restrict places_of,
                         global const proposal* restrict proposals, global mesh_row* restrict rows,
                         global double2* restrict points, global edge_place* restrict places,
                         global uint64* restrict row_keys, global uint* restrict claims, global uint* restrict visits,
                         global insertion* restrict insertions, global uchar* restrict states) {
  const int i = get_global_id(0);
  if (i < n) {
    const int at = places_of[list[i]];
    const proposal of = proposals[list[i]];
    insertion made;
    made.vertex = first_vertex + i;
    made.corner = of.start;
    made.known = list[i];
    made.rank = (uint)first + shuffled((uint)at, mask);
    made.from = made.to = -1;
    made.count = of.count;
    made.seen = step;
    made.first_row = first_row + 2 * i;
    for (int k = 0; k < 2; ++k) clear_row(made.first_row + k, rows, row_keys, claims, visits);
    const edge_place nowhere = {0.0, 0.0, -1, -1};
    points[made.vertex] = VECTOR(double2, of.x, of.y);
    places[made.vertex] = nowhere;
    insertions[first + i] = made;
    states[first + i] = (uchar)(at < most ? POINT_WAITS : POINT_DROPPED);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Steps

// All triangles around the vertex that was inserted last, if a step has changed a row, have it for their first corner.
// The one of them that has p in it.
static inline int find_in_star(const seen_mesh* mesh, int row, double2 p) {
  for (;;) {
    const double2 centre = point_at(mesh, 3 * row);
    const int first = orient_sign(centre, point_at(mesh, 3 * row + 1), p, ORIENT_BOUND);
    const int last = orient_sign(centre, point_at(mesh, 3 * row + 2), p, ORIENT_BOUND);
    const int turn = first < 0 ? 2 : last > 0 ? 1 : 0;
    if (turn == 0 || mesh->rows[row].neighbor[turn] < 0) return row;
    row = mesh->rows[row].neighbor[turn];
  }
}

// The corner opposite to the constraint that runs between these vertices, near a corner that was it before a step; or
// -1.
static inline int find_constraint(const seen_mesh* mesh, int corner, int from, int to) {
  if (vertex_at(mesh, next_halfedge(corner)) == from && vertex_at(mesh, previous_halfedge(corner)) == to) return corner;
  const int start = row_of(corner);
  for (int turn = 1; turn <= 2; ++turn) {
    int row = start;
    do {
      if (mesh->rows[row].corner[1] == from && mesh->rows[row].corner[2] == to) return 3 * row;
      row = mesh->rows[row].neighbor[turn];
    } while (row >= 0 && row != start);
  }
  return -1;
}

// Whether all sides of a triangle have p on their left or on them.
static inline int is_in_row(const seen_mesh* mesh, int row, double2 p) {
  for (int k = 0; k < 3; ++k) {
    if (orient_sign(point_at(mesh, 3 * row + k), point_at(mesh, 3 * row + next_corner(k)), p, ORIENT_BOUND) < 0)
      return 0;
  }
  return 1;
}

// Whether the rows of a cavity and those beside them are as they were when they were listed.
static inline int is_as_listed(const seen_mesh* mesh, const insertion* of, global const int* cavity) {
  for (int k = 0; k < of->count; ++k) {
    if (mesh->rows[cavity[k]].changed >= of->seen) return 0;
  }
  return 1;
}

// n elements of the list. first: the claim of rank 0. cavities: lists, see propose.cl, which are kept up. sizes: of
// each point the number of triangles around it.
kernel void claim_points(int n, refinement_rules rules, int step, int is_first, uint first, int listed,
                         global const int* restrict list, global int* restrict cavities, REFINED_MESH(),
                         global volatile uint* restrict claims, global insertion* restrict insertions,
                         global uint* restrict sizes, global uchar* restrict states) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
#if FETCH_AHEAD
    const insertion far = insertions[list[min(n - 1, i + ROWS_AHEAD)]],
                    near = insertions[list[min(n - 1, i + ROWS_NEXT)]];
    if (is_first && far.known >= 0) {
      for (int k = 0; k < ROWS_NEXT; ++k) {
        fetch((global const void*)&claims[max(0, cavities[listed * far.known + min(k, far.count - 1)])]);
      }
    } else {
      fetch_row(&mesh, row_of(max(0, far.corner)));
      fetch_corners(&mesh, row_of(max(0, near.corner)));
      fetch_neighbors(&mesh, row_of(max(0, near.corner)));
    }
#endif
    insertion of = insertions[list[i]];
    const uint claim = first + of.rank;
    uint size = 0;
    global int* const cavity = cavities + listed * max(0, of.known);
    int state = states[list[i]];
    if (state != POINT_WAITS) {
      // It was left out from the beginning.
    } else if (of.known >= 0 && of.count <= listed && (is_first || is_as_listed(&mesh, &of, cavity))) {
      for (int k = 0; k < of.count; ++k) atomic_min(&claims[cavity[k]], claim);
      size = (uint)of.count + 2u;
    } else {
      const double2 p = points[of.vertex];
      of.count = 0;
      if (of.from >= 0) {
        of.corner = find_constraint(&mesh, of.corner, of.from, of.to);
        const int can_split = of.corner >= 0 && can_split_at(&mesh, of.corner, p);
        if (can_split && why_not_split(&mesh, of.corner, places, ends, rules) != EXCUSED_NOT) {
          state = POINT_REFUSED;
        } else if (can_split) {
          const int beyond = neighbor_at(&mesh, of.corner);
          size =
              (uint)claim_tour(&mesh, next_halfedge(of.corner), of.corner, p, 0.0, claim, claims, cavity, 0, &of.count);
          of.count = (int)size - 1;
          if (beyond >= 0) {
            const int other = corner_facing(&mesh, beyond, row_of(of.corner));
            size += (uint)claim_tour(&mesh, next_halfedge(other), other, p, 0.0, claim, claims, cavity, 0, &of.count);
            of.count = (int)size - 2;
          }
        }
      } else {
        int row = row_of(of.corner);
        if (!is_in_row(&mesh, row, p)) row = find_in_star(&mesh, row, p);
        of.corner = 3 * row;
        if (!is_vertex(&mesh, row, p))
          size = (uint)claim_tour(&mesh, of.corner, of.corner, p, rules.min_edge, claim, claims, cavity, listed,
                                  &of.count);
        // Of a long tour, which meets rows twice, there is no list that could be used again.
        of.seen = of.count == (int)size - 2 ? step : 0;
        of.count = (int)size - 2;
      }
      if (size == 0) states[list[i]] = (uchar)(state == POINT_WAITS ? POINT_DROPPED : state);
      insertions[list[i]] = of;
    }
    sizes[i] = size;
  }
}

// offsets: the scanned sizes. visits: per row the last claim by which gather_stars met it.
kernel void gather_stars(int n, uint first, global const int* restrict list, global const uint* restrict offsets,
                         global const insertion* restrict insertions, REFINED_MESH(),
                         global const uint* restrict claims, global uint* restrict visits,
                         global star_side* restrict sides, global uchar* restrict states,
                         global uint* restrict made_sizes) {
  const int i = get_global_id(0);
  if (i < n) made_sizes[i] = 0;
  if (i < n && states[list[i]] == POINT_WAITS) {
    const seen_mesh mesh = {rows, points};
#if FETCH_AHEAD
    const int far = row_of(max(0, insertions[list[min(n - 1, i + ROWS_AHEAD)]].corner)),
              near = row_of(max(0, insertions[list[min(n - 1, i + ROWS_NEXT)]].corner));
    fetch_row(&mesh, far);
    fetch(&claims[far]);
    fetch(&visits[far]);
    fetch_neighbors(&mesh, near);
    for (int k = 0; k < 3; ++k) {
      const int beyond = max(0, rows[near].neighbor[k]);
      fetch(&claims[beyond]);
      fetch(&visits[beyond]);
    }
#endif
    const insertion of = insertions[list[i]];
    const uint claim = first + of.rank;
    gathered found = {0, 0, 1};
    global star_side* const star = sides + offsets[i];
    if (of.from < 0) {
      found = gather_tour(&mesh, of.corner, of.corner, claim, claims, visits, star, found);
    } else {
      const int beyond = neighbor_at(&mesh, of.corner);
      found = gather_tour(&mesh, next_halfedge(of.corner), of.corner, claim, claims, visits, star, found);
      if (found.holds && beyond >= 0) {
        const int other = corner_facing(&mesh, beyond, row_of(of.corner));
        found = gather_tour(&mesh, next_halfedge(other), other, claim, claims, visits, star, found);
      }
    }
    if (found.holds) {
      states[list[i]] = POINT_INSERTED;
      made_sizes[i] = offsets[i + 1] - offsets[i];
    }
  }
}

// A constraint that rounding did not allow to split is tried again when a triangle there is another one.
static inline int thawed(int edge) { return edge < 0 ? edge : edge & ~EDGE_FROZEN; }

// made: from element first_made on, the rows of the triangles that were made and their first vertices; made_at: the
// scanned sizes. waits: 1 for points that wait for the next step.
kernel void insert_stars(int n, int step, int first_made, global const int* restrict list,
                         global const uint* restrict offsets, global const uint* restrict made_at,
                         global const insertion* restrict insertions, global const uchar* restrict states,
                         global const star_side* restrict sides, global const edge_place* restrict places,
                         global mesh_row* restrict rows, global uint64* restrict row_keys,
                         global uchar* restrict refused, global int2* restrict made, global uchar* restrict waits) {
  const int i = get_global_id(0);
  if (i < n) {
#if FETCH_AHEAD
    if (i + ROWS_NEXT < n) {
      for (uint k = offsets[i + ROWS_NEXT]; k < offsets[i + ROWS_NEXT + 1]; ++k) {
        fetch(&rows[max(0, sides[k].outside)]);
        fetch(&row_keys[max(0, sides[k].row)]);
      }
    }
#endif
    const uint first = offsets[i];
    const int count = (int)(offsets[i + 1] - first), state = states[list[i]];
    waits[i] = state == POINT_WAITS;
    if (state == POINT_INSERTED) {
      const insertion of = insertions[list[i]];
      global const star_side* const star = sides + first;
      // Where a constraint on the border is split, the triangles do not go all the way round.
      const int is_open = count == of.count + 1, edge = of.from < 0 ? NO_EDGE_THERE : places[of.vertex].edge;
      int row = star[0].row, before = -1;
      if (!is_open) before = of.count < count - 1 ? of.first_row + count - 1 - of.count : star[count - 1].row;
      const int row_of_first = row;
      for (int k = 0; k < count; ++k) {
        star_side side = star[k];
        side.edge = thawed(side.edge);
        const int is_last = k + 1 == count;
        const int to = is_last ? (is_open ? of.from : star[0].from) : star[k + 1].from;
        const int after = is_last            ? (is_open ? -1 : row_of_first)
                          : k + 1 < of.count ? star[k + 1].row
                                             : of.first_row + k + 1 - of.count;
        global mesh_row* const written = &rows[row];
        write_star_row(written, of.vertex, side, to, after, before, edge, of.from, of.to);
        written->parent = side.parent;
        written->changed = step;
        if (side.outside >= 0) {
          rows[side.outside].neighbor[side.facing] = row;
          write_shared((global volatile int*)&rows[side.outside].changed, step);
          if (side.edge >= 0) rows[side.outside].edge[side.facing] = side.edge;
        }
        row_keys[row] = NO_KEY;
        refused[row] = EXCUSED_NOT;
        made[first_made + (int)made_at[i] + k] = VECTOR(int2, row, of.vertex);
        before = row;
        row = after;
      }
    }
  }
}

// Those of n insertions of the list that were dropped and are constraints cannot be split there, and are not tried
// again.
kernel void freeze_constraints(int n, global const int* restrict list, global const insertion* restrict insertions,
                               global const uchar* restrict states, global const double2* restrict points,
                               global mesh_row* restrict rows) {
  const int i = get_global_id(0);
  if (i < n) {
    const insertion of = insertions[list[i]];
    const seen_mesh mesh = {rows, points};
    const int is_frozen = states[list[i]] == POINT_DROPPED && of.from >= 0 && of.corner >= 0;
    const int corner = is_frozen ? find_constraint(&mesh, of.corner, of.from, of.to) : -1;
    if (corner >= 0) {
      const int beyond = neighbor_at(&mesh, corner);
      rows[row_of(corner)].edge[corner % 3] |= EDGE_FROZEN;
      if (beyond >= 0) rows[beyond].edge[corner_facing(&mesh, beyond, row_of(corner)) % 3] |= EDGE_FROZEN;
    }
  }
}

#endif
