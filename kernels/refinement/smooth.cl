// Vertices that may move go to better places, and the triangulation is made Delaunay again. Segments: the stars of
// vertices. One work-item per vertex, triangle or edge, one pass each.
//
// find_stars: a corner of each vertex. propose_moves: where it is to go. find_spoiled and cancel_moves, until nothing
// is spoiled: corners of triangles that would turn over or be bad stay. apply_moves. find_moved: triangles that have
// other shapes. find_flips, claim_flips, decide_flips and flip, after a sort by the keys of edges, until none
// is left: edges that are not Delaunay are replaced by the other diagonals (Lawson, 1977), in the order of
// keys, since triangles inherit from the triangles before. forget_changed: rows to test again.

#include "refinement/arguments.h"
#include "refinement/flips.h"
#include "refinement/limits.h"
#include "refinement/moves.h"
#include "refinement/records.h"

#ifndef FIXED_POINT

kernel void find_stars(int n, global const mesh_row* restrict rows, global volatile int* restrict stars) {
  const int row = get_global_id(0);
  if (row < n && rows[row].corner[0] != NO_TRIANGLE) {
    for (int k = 0; k < 3; ++k) atomic_min(&stars[rows[row].corner[k]], 3 * row + k);
  }
}

// n vertices. moves: MOVES or STAYS; targets: where they go.
kernel void propose_moves(int n, refinement_rules rules, global const int* restrict stars, REFINED_MESH(),
                          global double2* restrict targets, global int* restrict moves) {
  const int v = get_global_id(0);
  if (v < n) {
    const seen_mesh mesh = {rows, points};
    double2 target = points[v];
    int state = STAYS;
    if (v >= rules.vertices && stars[v] != NO_STAR && places[v].edge < 0) {
      const int first = first_of_star(&mesh, stars[v]);
      optimal_move move = optimal_move_of(&mesh, first);
      for (int k = 0; k < MOST_HALVINGS && state == STAYS; ++k) {
        // Also if it is not a number.
        const int is_far = !(squared_length(move.step) <= move.reach);
        target = is_far ? points[v] : moved_by(points[v], move.step, rules);
        if (!is_far && is_star_good(&mesh, first, target, rules, areas)) state = MOVES;
        move.step = VECTOR(double2, move.step.x / 2.0, move.step.y / 2.0);
      }
    }
    targets[v] = target;
    moves[v] = state;
  }
}

// n rows. Tests rows that changed with the last pass: at first all with vertices that move. spoiled: 1 or 0.
kernel void find_spoiled(int n, int pass, refinement_rules rules, REFINED_MESH(),
                         global const double2* restrict targets, global const int* restrict moves,
                         global uchar* restrict spoiled) {
  const int row = get_global_id(0);
  if (row < n) {
    int is_spoiled = 0, has_moved = 0, is_new = 0;
    if (rows[row].corner[0] != NO_TRIANGLE) {
      double2 before[3], after[3];
      for (int k = 0; k < 3; ++k) {
        const int v = rows[row].corner[k], move = moves[v];
        before[k] = points[v];
        after[k] = move == MOVES ? targets[v] : before[k];
        has_moved |= move == MOVES;
        is_new |= move == pass;
      }
      const seen_mesh mesh = {rows, points};
      if (has_moved && (pass == STAYS || is_new)) is_spoiled = !is_change_good(&mesh, row, before, after, rules, areas);
    }
    spoiled[row] = (uchar)is_spoiled;
  }
}

// The vertices of n rows at these positions stay. pass: of find_spoiled next.
kernel void cancel_moves(int n, int pass, global const int* restrict positions, global const mesh_row* restrict rows,
                         global volatile int* restrict moves) {
  const int i = get_global_id(0);
  if (i < n) {
    for (int k = 0; k < 3; ++k) atomic_min(&moves[rows[positions[i]].corner[k]], pass);
  }
}

kernel void apply_moves(int n, global const double2* restrict targets, global const int* restrict moves,
                        global double2* restrict points) {
  const int v = get_global_id(0);
  if (v < n && moves[v] == MOVES) points[v] = targets[v];
}

// n rows. changes: 1 for those that have a vertex that moved.
kernel void find_moved(int n, global const mesh_row* restrict rows, global const int* restrict moves,
                       global uint* restrict changes) {
  const int row = get_global_id(0);
  if (row < n) {
    int is_moved = 0;
    for (int k = 0; k < 3 && rows[row].corner[0] != NO_TRIANGLE; ++k) is_moved |= moves[rows[row].corner[k]] == MOVES;
    changes[row] = (uint)is_moved;
  }
}

// n rows. changes: the last pass that changed a row, or 0. flips: per corner of a row that was changed in this pass, 1
// if the edge opposite is not Delaunay, once for both of its sides.
kernel void find_flips(int n, uint pass, REFINED_MESH(), global const uint* restrict changes,
                       global uchar* restrict flips) {
  const int row = get_global_id(0);
  if (row < n) {
    const seen_mesh mesh = {rows, points};
    for (int k = 0; k < 3; ++k) {
      int is_found = 0;
      if (changes[row] == pass && rows[row].edge[k] < 0) {
        const int beyond = rows[row].neighbor[k];
        is_found = !(changes[beyond] == pass && beyond < row) &&
                   is_in_circle(&mesh, row, point_at(&mesh, corner_facing(&mesh, beyond, row)));
      }
      flips[3 * row + k] = (uchar)is_found;
    }
  }
}

// The keys of n edges, opposite to corners: hashes of their ends, whichever side they are seen from.
kernel void keys_of_edges(int n, global const int* restrict corners, REFINED_MESH(), global uint64* restrict keys) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
    const double2 a = point_at(&mesh, next_halfedge(corners[i])), b = point_at(&mesh, previous_halfedge(corners[i]));
    keys[i] = comes_before(a, b) ? hash_with(hash_with(0, a), b) : hash_with(hash_with(0, b), a);
  }
}

// n edges, in the order of their keys, by which they claim their rows.
kernel void claim_flips(int n, global const int* restrict corners, global const mesh_row* restrict rows,
                        global volatile uint* restrict claims) {
  const int i = get_global_id(0);
  if (i < n) {
    const int row = row_of(corners[i]);
    atomic_min(&claims[row], (uint)i);
    atomic_min(&claims[rows[row].neighbor[corners[i] % 3]], (uint)i);
  }
}

// wins: 0 for those that have a better one at or beside their rows; otherwise from bits 1 and 3 on the numbers of the
// corners that face from_row and from_beyond.
kernel void decide_flips(int n, global const int* restrict corners, global const mesh_row* restrict rows,
                         global const uint* restrict claims, global uchar* restrict wins) {
  const int i = get_global_id(0);
  if (i < n) {
    const flip_place at = place_of_flip(rows, corners[i]);
    const uint claim = (uint)i;
    int has_won = claims[at.row] == claim && claims[at.beyond] == claim;
    for (int k = 0; k < 3; ++k) {
      const int a = rows[at.row].neighbor[k], b = rows[at.beyond].neighbor[k];
      has_won &= (a < 0 || claims[a] >= claim) && (b < 0 || claims[b] >= claim);
    }
    if (has_won && at.from_row >= 0) has_won |= number_facing(&rows[at.from_row], at.row) << 1;
    if (has_won && at.from_beyond >= 0) has_won |= number_facing(&rows[at.from_beyond], at.beyond) << 3;
    wins[i] = (uchar)has_won;
  }
}

// Edges that lose are tested again in the next pass.
kernel void flip(int n, uint next_pass, global const int* restrict corners, global const uchar* restrict wins,
                 global mesh_row* restrict rows, global volatile uint* restrict changes) {
  const int i = get_global_id(0);
  if (i < n && wins[i]) {
    const flip_place at = place_of_flip(rows, corners[i]);
    flip_rows(rows, at, wins[i] >> 1 & 3, wins[i] >> 3);
    atomic_max(&changes[at.beyond], next_pass);
    atomic_max(&changes[at.row], next_pass);
  } else if (i < n) {
    atomic_max(&changes[row_of(corners[i])], next_pass);
  }
}

// n rows. Resets the states of changed rows, as if they had just been made.
kernel void forget_changed(int n, global const uint* restrict changes, global mesh_row* restrict rows,
                           global uchar* restrict states) {
  const int row = get_global_id(0);
  if (row < n) {
    const int has_changed = changes[row] != 0;
    if (has_changed) states[row] = ROW_NEW;
    for (int k = 0; k < 3 && rows[row].corner[0] != NO_TRIANGLE; ++k) {
      const int edge = rows[row].edge[k], beyond = rows[row].neighbor[k];
      if (edge >= 0 && (has_changed || (beyond >= 0 && changes[beyond] != 0))) rows[row].edge[k] = edge & ~EDGE_FROZEN;
    }
  }
}

#endif
