// Phases of refinement. Segments: the blocks.
//
// mark_pending: rows in which something is to be done. find_levels: which of them are too large, and how much.
// describe_rows: where they are. find_leaves, with the tree of cuts that the host makes, and after a sort find_starts:
// the rows that each block begins with.
// refine_blocks: each work-item takes one block after the other, and runs the sequential algorithm in it (blocks.h); a
// launch may end before all are done, and the next one goes on. When phases are over: number_added, flag_made_rows,
// key_made_rows and, after a sort, place_rows_in_order, sort_made_rows and invert_order: the numbers of vertices are in
// the order of phases, blocks and within them, rows follow their youngest corners; then move_rows and move_added, or
// write_refined_rows.

#include "refinement/arguments.h"
#include "refinement/blocks.h"
#include "refinement/records.h"

#ifndef FIXED_POINT

kernel void mark_pending(int n, int mask, global const uchar* restrict states, global uchar* restrict flags) {
  const int row = get_global_id(0);
  if (row < n) flags[row] = (states[row] & mask) != 0;
}

// n rows of the list: the middle of the shortest side; the squared circumradius; and whether they are in the sample by
// which the plane is cut, one row in mask + 1.
kernel void describe_rows(int n, uint mask, global const int* restrict list, REFINED_MESH(),
                          global double2* restrict middles, global double* restrict radii,
                          global uchar* restrict is_sampled) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    if (n > ROWS_IN_CACHE) {
      fetch_row(&mesh, list[min(n - 1, i + ROWS_FAR_AHEAD)]);
      fetch_corners(&mesh, list[min(n - 1, i + ROWS_AHEAD)]);
    }
    const ordered_triangle triangle = ordered(&mesh, list[i]);
    middles[i] = middle_of_shortest(triangle.point);
    radii[i] = squared_circumradius(triangle.point);
    is_sampled[i] = (hash_with(0, middles[i]) & mask) == 0;
  }
}

// n rows of the list: the number of levels of area, each `step` times the one before, at which they are too
// large.
kernel void find_levels(int n, refinement_rules rules, double step, global const int* restrict list, REFINED_MESH(),
                        global uchar* restrict levels) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    const ordered_triangle triangle = ordered(&mesh, list[i]);
    int level = 0;
    const double wanted = area_of_row(&mesh, list[i], rules, areas, 0);
    if (wanted > 0.0 && wanted < INFINITY) {
      const double2 u = triangle.point[1] - triangle.point[0], v = triangle.point[2] - triangle.point[0];
      const double area = fabs(u.x * v.y - u.y * v.x) / 2.0;
      for (double bound = wanted; area > bound && level < 255; bound = bound * step) ++level;
    }
    levels[i] = (uchar)level;
  }
}

// keys: leaves; payloads: rows.
kernel void find_leaves(int n, global const int* restrict list, global const double2* restrict middles,
                        global const block_cut* restrict cuts, global uint64* restrict keys,
                        global int* restrict payloads) {
  const int i = get_global_id(0);
  if (i < n) {
    keys[i] = (uint64)leaf_at(cuts, middles[i]);
    payloads[i] = list[i];
  }
}
// Where each of the leaves begins among n sorted keys, with the end.
kernel void find_starts(int n, int leaves, global const uint64* restrict keys, global int* restrict starts) {
  const int i = get_global_id(0);
  if (i < n) {
    const int before = i == 0 ? -1 : (int)keys[i - 1], here = (int)keys[i];
    for (int leaf = before + 1; leaf <= here; ++leaf) starts[leaf] = i;
    for (int leaf = here + 1; i == n - 1 && leaf <= leaves; ++leaf) starts[leaf] = n;
  }
}

// States and lists are per work-item. inserted: per block.
kernel void refine_blocks(refinement_rules rules, refinement_phase phase, global mesh_row* rows, global double2* points,
                          global edge_place* places, global const int* ends, global const int* wedges,
                          global const double* areas, global const mesh_row* given, global uchar* states,
                          global int2* births, global const block_cut* cuts, global const double* reaches,
                          global const int* list, global const int* starts, global volatile int* counters,
                          global int* inserted, global block_state* block_states, global int* heads, global int* tails,
                          global block_task* tasks, global dug_side* stacks, global int* cavities,
                          global star_side* sides, global first_task* firsts) {
  const size_t i = get_global_id(0), room = (size_t)(phase.room + SPARE_ROOM);
  block_work work;
  const seen_mesh mesh = {rows, points};
  work.mesh = mesh;
  work.rules = rules;
  work.phase = phase;
  work.rows = rows;
  work.points = points;
  work.places = places;
  work.ends = ends;
  work.wedges = wedges;
  work.areas = areas;
  work.given = given;
  work.states = states;
  work.births = births;
  work.cuts = cuts;
  work.reaches = reaches;
  work.counters = counters;
  work.heads = heads + TASK_CLASSES * i;
  work.tails = tails + TASK_CLASSES * i;
  work.tasks = tasks + room * i;
  work.stack = stacks + room * i;
  work.cavity = cavities + room * i;
  work.sides = sides + room * i;
  work.firsts = firsts + room * i;
  work.state = block_states[i];
  int steps = phase.steps, needs = 0;
  while (needs == 0) {
    const int is_new = work.state.block < 0;
    if (is_new) {
      const int block = atomic_inc(&counters[COUNT_BLOCKS]);
      if (block >= phase.blocks) break;
      work.state.block = block;
      work.state.inserted = 0;
    }
    if (is_new) start_block(&work, list, starts[work.state.block], starts[work.state.block + 1]);
    needs = run_block(&work, &steps);
    if (needs == 0) {
      end_block(&work);
      inserted[work.state.block] = work.state.inserted;
      work.state.block = -1;
    }
  }
  if (needs != 0) atomic_or(&counters[COUNT_NEEDS], needs);
  block_states[i] = work.state;
}

// ---------------------------------------------------------------------------------------------------------------------
// The order in the end

// n vertices. The first `known` have their numbers already; vertices of the input get their names in it.
// firsts: per block of all phases.
kernel void number_added(int n, int known, int inputs, global const int2* restrict births,
                         global const int* restrict firsts, global const int* restrict names,
                         global int* restrict numbers) {
  const int v = get_global_id(0);
  if (v < n) {
    numbers[v] = v < inputs        ? names[v]
                 : v < known       ? v
                 : births[v].x < 0 ? -1
                                   : known + firsts[births[v].x] + births[v].y;
  }
}

kernel void move_added(int n, global const int* restrict numbers, global const double2* restrict points,
                       global const edge_place* restrict places, global double2* restrict moved_points,
                       global edge_place* restrict moved_places) {
  const int v = get_global_id(0);
  if (v < n && numbers[v] >= 0) {
    edge_place place = places[v];
    if (place.apex >= 0) place.apex = numbers[place.apex];
    moved_points[numbers[v]] = points[v];
    moved_places[numbers[v]] = place;
  }
}

// n rows. flags: ROW_KEPT if a row is as it was, ROW_MADE if it was made.
kernel void flag_made_rows(int n, global const mesh_row* restrict rows, global uchar* restrict flags) {
  const int row = get_global_id(0);
  if (row < n)
    flags[row] = (uchar)(rows[row].corner[0] == NO_TRIANGLE ? 0 : rows[row].changed == 0 ? ROW_KEPT : ROW_MADE);
}
// n rows that were made, at these positions. keys: their first corners, the youngest ones.
kernel void key_made_rows(int n, global const int* restrict positions, global const int* restrict numbers,
                          global const mesh_row* restrict rows, global uint64* restrict keys,
                          global int* restrict payloads) {
  const int i = get_global_id(0);
  if (i < n) {
    keys[i] = (uint64)numbers[rows[positions[i]].corner[0]];
    payloads[i] = positions[i];
  }
}
// n rows, to elements of the order from `first` on: rows below the numbers of their second corners.
kernel void place_rows_in_order(int n, int first, global const int* restrict list, global const int* restrict numbers,
                                global const mesh_row* restrict rows, global uint64* restrict order) {
  const int i = get_global_id(0);
  if (i < n) order[first + i] = (uint64)numbers[rows[list[i]].corner[1]] << 32 | (uint64)list[i];
}
// keys: sorted. Sorts the rows of the same first corner by their second ones.
kernel void sort_made_rows(int n, int first, global const uint64* restrict keys, global uint64* restrict order) {
  const int begin = get_global_id(0);
  if (begin < n && (begin == 0 || keys[begin - 1] != keys[begin])) {
    for (int i = begin + 1; i < n && keys[i] == keys[begin]; ++i) {
      const uint64 moved = order[first + i];
      int to = i;
      for (; to > begin && order[first + to - 1] > moved; --to) order[first + to] = order[first + to - 1];
      order[first + to] = moved;
    }
  }
}
static inline int row_in_order(global const uint64* order, int i) { return (int)(order[i] & 0xffffffffu); }

// n rows in their order: where each goes.
kernel void invert_order(int n, global const uint64* restrict order, global int* restrict row_numbers) {
  const int i = get_global_id(0);
  if (i < n) row_numbers[row_in_order(order, i)] = i;
}
kernel void move_rows(int n, int by_row, global const uint64* restrict order, global const int* restrict row_numbers,
                      global const int* restrict numbers, global const mesh_row* restrict rows,
                      global const uchar* restrict states, global const double* restrict areas,
                      global mesh_row* restrict moved_rows, global uchar* restrict moved_states,
                      global double* restrict moved_areas) {
  const int i = get_global_id(0);
  if (i < n) {
    const int from = row_in_order(order, i);
    mesh_row row = rows[from];
    for (int k = 0; k < 3; ++k) {
      row.corner[k] = numbers[row.corner[k]];
      if (row.neighbor[k] >= 0) row.neighbor[k] = row_numbers[row.neighbor[k]];
    }
    row.changed = 0;
    moved_rows[i] = row;
    moved_states[i] = states[from];
    if (by_row) moved_areas[i] = areas[from];
  }
}

// Why constraints of a row that an angle opposite to them encroaches were not split; EXCUSED_NOT without such.
static inline int why_encroaching(const seen_mesh* mesh, int row, global const edge_place* places,
                                  global const int* ends, refinement_rules rules) {
  for (int corner = 3 * row; corner < 3 * row + 3; ++corner) {
    if (edge_at(mesh, corner) < 0 ||
        !encroaches(point_at(mesh, next_halfedge(corner)), point_at(mesh, previous_halfedge(corner)),
                    point_at(mesh, corner), rules.squared_cosine))
      continue;
    const int reason = why_not_split(mesh, corner, places, ends, rules);
    return reason == EXCUSED_NOT ? EXCUSED_LIMIT : reason;
  }
  return EXCUSED_NOT;
}

// n rows in their order, each from its smallest vertex on, as the result has them.
kernel void write_refined_rows(int n, refinement_rules rules, global const uint64* restrict order,
                               global const int* restrict row_numbers, global const int* restrict numbers,
                               REFINED_MESH(), global const uchar* restrict states, global int* restrict triangles,
                               global int* restrict neighbors, global int* restrict edges, global int* restrict parents,
                               global uchar* restrict excuses) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
#if FETCH_AHEAD
    if (n > ROWS_IN_CACHE) {
      fetch_row(&mesh, row_in_order(order, min(n - 1, i + ROWS_FAR_AHEAD)));
      const int ahead = row_in_order(order, min(n - 1, i + ROWS_AHEAD));
      for (int j = 0; j < 3; ++j) {
        fetch(&row_numbers[max(0, rows[ahead].neighbor[j])]);
        fetch(&numbers[rows[ahead].corner[j]]);
      }
    }
#endif
    const int from = row_in_order(order, i);
    global const mesh_row* const row = &rows[from];
    const int a = numbers[row->corner[0]], b = numbers[row->corner[1]], c = numbers[row->corner[2]];
    // Without branches, which could not be predicted.
    const int first = (b < a) & (b < c), is_last = (c < a) & (c < b);
    for (int k = 0, j = first + 2 * is_last; k < 3; ++k, j = corner_after_any(j)) {
      const int neighbor = row->neighbor[j], edge = row->edge[j];
      triangles[3 * i + k] = numbers[row->corner[j]];
      neighbors[3 * i + k] = neighbor < 0 ? -1 : row_numbers[neighbor];
      edges[3 * i + k] = edge < 0 ? -1 : edge & EDGE_NUMBER;
    }
    parents[i] = row->parent;
    int excuse = states[from] & ROW_BAD ? (int)EXCUSED_LIMIT : states[from] & ROW_REFUSED;
    if (excuse == EXCUSED_NOT && rules.squared_cosine == 0.0)
      excuse = why_encroaching(&mesh, from, places, ends, rules);
    excuses[i] = (uchar)excuse;
  }
}

#endif
