// Proposals of points that mend bad triangles, and which of them win. Segments: the cavities, whose rows atomic minima
// claim; what they leave does not depend on their order. One work-item per bad triangle or proposal, one pass each.
//
// find_active: bad triangles that do not wait for a bad neighbour. propose: their points, and cavities. list_ranks and
// order_equal: the places of proposals in the order of their keys. claim_splits: cavities of constraints that are split
// in any case. claim_cavities: those of all proposals. decide: who wins. mark_winners, in the order of ranks, and
// refuse: what became of them. list_wanted: the constraints that winners split.

#include "operations/prefetch.h"
#include "refinement/arguments.h"
#include "refinement/limits.h"
#include "refinement/quality_of_rows.h"
#include "refinement/records.h"

#ifndef FIXED_POINT

kernel void find_active(int n, int waits, global const int* restrict list, global const mesh_row* restrict rows,
                        global const uint64* restrict keys, global uchar* restrict active) {
  const int i = get_global_id(0);
  if (i < n) {
#if FETCH_AHEAD
    const seen_mesh mesh = {rows, 0};
    const int far = list[min(n - 1, i + ROWS_FAR_AHEAD)], near = list[min(n - 1, i + ROWS_AHEAD)];
    fetch_row(&mesh, far);
    fetch(&keys[far]);
    for (int k = 0; k < 3; ++k) fetch(&keys[max(0, rows[near].neighbor[k])]);
#endif
    const int row = list[i];
    const uint64 key = keys[row];
    int is_active = 1;
    if (waits && !is_key_of_large(key)) {
      for (int k = 0; k < 3; ++k) {
        if (rows[row].edge[k] < 0 && keys[rows[row].neighbor[k]] < key) is_active = 0;
      }
    }
    active[i] = (uchar)is_active;
  }
}

// The off-centre of a triangle (Uengoer, 2009): on the bisector of the shortest side, as far from it as the
// circumcentre, but no farther than where an edge to it would make the smallest angle that is wanted. Relative to the
// corner after the one opposite to that side.
static inline double2 centre_of(const double2* p, int is_large, refinement_rules rules) {
  const int k = opposite_to_shortest(p);
  const double2 from = p[(k + 1) % 3], to = p[(k + 2) % 3], apex = p[k];
  const double2 u = to - from, v = apex - from;
  const double uu = squared_length(u), vv = squared_length(v), scale = 0.5 / (u.x * v.y - u.y * v.x);
  double2 centre = VECTOR(double2, (v.y * uu - u.y * vv) * scale, (u.x * vv - v.x * uu) * scale);
  if (!is_large && rules.off_centre > 0.0) {
    const double2 off = VECTOR(double2, 0.5 * u.x - rules.off_centre * u.y, 0.5 * u.y + rules.off_centre * u.x);
    if (squared_length(off) < squared_length(centre)) centre = off;
  }
  return centre;
}

// Walks from a corner's triangle to p, over one side after the other that p is beyond. Returns the first corner of its
// triangle; or of a constraint in the way, the corner opposite, complemented. In Delaunay triangulations it ends
// (Edelsbrunner, 1990).
static inline int walk_to(const seen_mesh* mesh, int corner, double2 p) {
  int row = row_of(corner), k = corner - 3 * row, left = 3;
  double2 from = mesh->points[mesh->rows[row].corner[next_corner(k)]];
  while (left > 0) {
    GLOBAL const mesh_row* const at = &mesh->rows[row];
    const double2 to = mesh->points[at->corner[corner_before(k)]];
    if (orient_sign(from, to, p, ORIENT_BOUND) < 0) {
      if (at->edge[k] >= 0) return ~(3 * row + k);
      const int beyond = at->neighbor[k];
      // The next side begins where this one does.
      k = next_corner(number_facing(&mesh->rows[beyond], row));
      row = beyond;
      left = 2;
    } else {
      k = next_corner(k);
      from = to;
      --left;
    }
  }
  return 3 * row;
}

// cavities: of each proposal the rows of its cavity, if they are at most `listed`; unlisted: how many have more.
kernel void propose(int n, refinement_rules rules, int listed, global const int* restrict list, REFINED_MESH(),
                    global const uint64* restrict row_keys, global proposal* restrict proposals,
                    global int* restrict cavities, global uint64* restrict keys, global int* restrict payloads,
                    global uchar* restrict outcomes, global volatile uint* restrict unlisted) {
  const int i = get_global_id(0);
  if (i < n) {
    const seen_mesh mesh = {rows, points};
#if FETCH_AHEAD
    fetch_row(&mesh, list[min(n - 1, i + ROWS_FAR_AHEAD)]);
    const int ahead = list[min(n - 1, i + ROWS_AHEAD)], next_row = list[min(n - 1, i + ROWS_NEXT)];
    fetch_corners(&mesh, ahead);
    fetch_neighbors(&mesh, ahead);
    for (int k = 0; k < 3; ++k) {
      const int beyond = max(0, rows[next_row].neighbor[k]);
      fetch_corners(&mesh, beyond);
      fetch_neighbors(&mesh, beyond);
    }
    const int soon = list[min(n - 1, i + ROWS_SOON)];
    for (int k = 0; k < 3; ++k) {
      const int beyond = max(0, rows[soon].neighbor[k]);
      for (int j = 0; j < 3; ++j) fetch_corners(&mesh, max(0, rows[beyond].neighbor[j]));
    }
#endif
    const int row = list[i];
    const ordered_triangle triangle = ordered(&mesh, row);
    const uint64 key = row_keys[row];
    proposal made;
    const double2 from = triangle.point[(opposite_to_shortest(triangle.point) + 1) % 3],
                  centre = centre_of(triangle.point, is_key_of_large(key), rules),
                  p = VECTOR(double2, rounded_to(from.x + centre.x, rules.coarse),
                             rounded_to(from.y + centre.y, rules.coarse));
    made.x = p.x;
    made.y = p.y;
    made.row = row;
    made.count = 1;
    made.splits = 0;
    made.hit = -1;
    made.spare = 0;
    made.start = triangle.corner[0];
    int outcome = PROPOSAL_OPEN;
    // Farther points are not rounded by as much as an eighth of that, and all vertices are nearly as far away: the
    // circle around such a point leaves that of the triangle only beyond the shortest side, which is not much nearer.
    const double distance = squared_distance(p, from);
    const int is_close = distance < rules.long_edge;
    if (!(distance >= rules.min_edge) || (is_close && 64.0 * squared_distance(p - from, centre) > distance) ||
        !(fabs(p.x) < INFINITY && fabs(p.y) < INFINITY)) {
      outcome = EXCUSED_MIN_EDGE;
    } else {
      const int found = walk_to(&mesh, triangle.corner[0], p);
      if (found < 0) {
        made.hit = ~found;
        made.splits = 1;
        outcome = why_not_split(&mesh, made.hit, places, ends, rules);
        if (outcome == EXCUSED_NOT) outcome = PROPOSAL_OPEN;
        // The point of a flat triangle may be rounded out of its circle; then its cavity would not be a tree.
        if (outcome == PROPOSAL_OPEN && !is_in_circle(&mesh, row, p)) outcome = EXCUSED_FROZEN;
      } else {
        made.start = found;
        if (is_vertex(&mesh, row_of(found), p)) outcome = EXCUSED_MIN_EDGE;
      }
    }
    if (outcome == PROPOSAL_OPEN) {
      cavity_tour tour;
      start_tour(&tour, made.start, made.start);
      global int* const cavity = cavities + listed * i;
      cavity[0] = row_of(made.start);
      int sides = 0, refused = PROPOSAL_OPEN;
      for (int next = next_in_tour(&tour, &mesh, p); next != NO_MORE; next = next_in_tour(&tour, &mesh, p)) {
        if (next < 0) {
          if (made.count < listed) cavity[made.count] = ~next;
          ++made.count;
        } else {
          ++sides;
          if (made.hit < 0 && edge_at(&mesh, next) >= 0 && encroaches(&mesh, next, p, rules)) {
            const int reason = why_not_split(&mesh, next, places, ends, rules);
            if (reason == EXCUSED_NOT) {
              ++made.splits;
            } else {
              refused = min(refused, reason);
            }
          }
        }
      }
      // Constraints that may be split are, whatever others are encroached.
      if (made.splits == 0) outcome = refused;
      if (made.splits == 0 && is_close && is_near_vertex(&mesh, made.start, made.start, p, rules.min_edge))
        outcome = min(outcome, (int)EXCUSED_MIN_EDGE);
      // Of a long tour, which meets rows twice, there is no list.
      if (made.count > listed || made.count != sides - 2) {
        made.count = max(sides - 2, listed + 1);
        atomic_inc(unlisted);
      }
    }
    proposals[i] = made;
    outcomes[i] = (uchar)outcome;
    keys[i] = outcome == PROPOSAL_OPEN ? key : NO_KEY;
    payloads[i] = i;
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// The order of proposals

// Whether one triangle comes before another of the same key, by the coordinates of its corners.
static inline int comes_first(const seen_mesh* mesh, int row, int other) {
  const ordered_triangle a = ordered(mesh, row), b = ordered(mesh, other);
  for (int k = 0; k < 3; ++k) {
    if (comes_before(a.point[k], b.point[k])) return 1;
    if (comes_before(b.point[k], a.point[k])) return 0;
  }
  return 0;
}

// keys: sorted, with the numbers of their proposals in order. The first of equal keys sorts them by insertion: as
// hashes are in the keys, they are few.
kernel void order_equal(int n, global const uint64* restrict keys, global const proposal* restrict proposals,
                        REFINED_MESH(), global int* restrict order) {
  const int i = get_global_id(0);
  if (i + 1 < n && keys[i] == keys[i + 1] && keys[i] != NO_KEY && (i == 0 || keys[i - 1] != keys[i])) {
    const seen_mesh mesh = {rows, points};
    for (int j = i + 1; j < n && keys[j] == keys[i]; ++j) {
      const int moved = order[j];
      int to = j;
      for (; to > i && comes_first(&mesh, proposals[moved].row, proposals[order[to - 1]].row); --to) {
        order[to] = order[to - 1];
      }
      order[to] = moved;
    }
  }
}

kernel void list_ranks(int n, global const int* restrict order, global uint* restrict ranks) {
  const int i = get_global_id(0);
  if (i < n) ranks[order[i]] = (uint)i;
}

// ---------------------------------------------------------------------------------------------------------------------
// Claims

// Claims the cavity of the point that splits the constraint opposite to a corner.
static inline void claim_split(const seen_mesh* mesh, int corner, double2 p, uint claim, global volatile uint* claims) {
  const int beyond = neighbor_at(mesh, corner);
  for (int side = 0; side < (beyond < 0 ? 1 : 2); ++side) {
    const int from = side ? corner_facing(mesh, beyond, row_of(corner)) : corner;
    atomic_min(&claims[row_of(from)], claim);
    if (!is_in_circle(mesh, row_of(from), p)) continue;  // it will not be split
    cavity_tour tour;
    start_tour(&tour, next_halfedge(from), from);
    for (int next = next_in_tour(&tour, mesh, p); next != NO_MORE; next = next_in_tour(&tour, mesh, p)) {
      if (next < 0) atomic_min(&claims[~next], claim);
    }
  }
}

// Whether there is a constraint opposite to a corner that a proposal's point encroaches and that may be split.
static inline int is_to_split(const seen_mesh* mesh, int corner, double2 p, global const edge_place* places,
                              global const int* ends, refinement_rules rules) {
  return edge_at(mesh, corner) >= 0 && encroaches(mesh, corner, p, rules) &&
         why_not_split(mesh, corner, places, ends, rules) == EXCUSED_NOT;
}

static inline double2 place_of(const proposal* made) { return VECTOR(double2, made->x, made->y); }

// n constraints by their corners; those that are less than 0 are none.
kernel void claim_splits(int n, refinement_rules rules, uint claim, global const int* restrict corners, REFINED_MESH(),
                         global volatile uint* restrict claims) {
  const int i = get_global_id(0);
  if (i < n && corners[i] >= 0) {
    const seen_mesh mesh = {rows, points};
    claim_split(&mesh, corners[i], place_of_constraint(&mesh, corners[i], places, ends, rules).point, claim, claims);
  }
}

// Whether a proposal meets rows that splits have claimed.
static inline int is_blocked(const seen_mesh* mesh, const proposal* made, int listed, global const int* cavity,
                             global volatile uint* claims, uint claim) {
  if (made->count <= listed) {
    for (int k = 0; k < made->count; ++k) {
      if (claims[cavity[k]] <= claim) return 1;
    }
    return 0;
  }
  cavity_tour tour;
  start_tour(&tour, made->start, made->start);
  int blocked = claims[row_of(made->start)] <= claim;
  for (int next = next_in_tour(&tour, mesh, place_of(made)); next != NO_MORE;
       next = next_in_tour(&tour, mesh, place_of(made))) {
    if (next < 0) blocked |= claims[~next] <= claim;
  }
  return blocked;
}

// claim: of the constraints that are split in any case.
kernel void find_blocked(int n, uint claim, int listed, global const proposal* restrict proposals,
                         global const int* restrict cavities, REFINED_MESH(), global volatile uint* restrict claims,
                         global uchar* restrict outcomes) {
  const int i = get_global_id(0);
  if (i < n && outcomes[i] == PROPOSAL_OPEN) {
    const seen_mesh mesh = {rows, points};
    const proposal made = proposals[i];
    if (is_blocked(&mesh, &made, listed, cavities + listed * i, claims, claim)) outcomes[i] = PROPOSAL_BLOCKED;
  }
}

// first: the claim of the first proposal.
kernel void claim_cavities(int n, refinement_rules rules, uint first, int listed,
                           global const proposal* restrict proposals, global const int* restrict cavities,
                           global const uint* restrict ranks, global const uchar* restrict outcomes, REFINED_MESH(),
                           global volatile uint* restrict claims) {
  const int i = get_global_id(0);
  if (i < n && outcomes[i] == PROPOSAL_OPEN) {
    const seen_mesh mesh = {rows, points};
#if FETCH_AHEAD
    const int ahead = min(n - 1, i + ROWS_AHEAD);
    for (int k = 0; k < ROWS_NEXT; ++k) fetch((global const void*)&claims[max(0, cavities[listed * ahead + k])]);
#endif
    const proposal made = proposals[i];
    const uint claim = first + ranks[i];
    if (made.count <= listed) {
      for (int k = 0; k < made.count; ++k) atomic_min(&claims[cavities[listed * i + k]], claim);
    }
    if (made.count > listed || made.splits > 0) {
      atomic_min(&claims[row_of(made.start)], claim);
      cavity_tour tour;
      start_tour(&tour, made.start, made.start);
      for (int next = next_in_tour(&tour, &mesh, place_of(&made)); next != NO_MORE;
           next = next_in_tour(&tour, &mesh, place_of(&made))) {
        if (next < 0) {
          atomic_min(&claims[~next], claim);
        } else if (made.hit < 0 && is_to_split(&mesh, next, place_of(&made), places, ends, rules)) {
          claim_split(&mesh, next, place_of_constraint(&mesh, next, places, ends, rules).point, claim, claims);
        }
      }
      if (made.hit >= 0) {
        claim_split(&mesh, made.hit, place_of_constraint(&mesh, made.hit, places, ends, rules).point, claim, claims);
      }
    }
  }
}

// Whether a proposal holds all rows of its cavity, and no better one has a row beside them.
static inline int holds_ring(const seen_mesh* mesh, const proposal* made, global const uint* claims, uint claim) {
  cavity_tour tour;
  start_tour(&tour, made->start, made->start);
  int holds = claims[row_of(made->start)] == claim;
  for (int next = next_in_tour(&tour, mesh, place_of(made)); next != NO_MORE;
       next = next_in_tour(&tour, mesh, place_of(made))) {
    if (next < 0) {
      holds &= claims[~next] == claim;
    } else if (neighbor_at(mesh, next) >= 0) {
      holds &= claims[neighbor_at(mesh, next)] >= claim;
    }
  }
  return holds;
}

kernel void decide(int n, refinement_rules rules, uint first, global const proposal* restrict proposals,
                   global const uint* restrict ranks, REFINED_MESH(), global const uint64* restrict row_keys,
                   global const uint* restrict claims, global uchar* restrict outcomes) {
  const int i = get_global_id(0);
  if (i < n && outcomes[i] == PROPOSAL_OPEN) {
    const seen_mesh mesh = {rows, points};
#if FETCH_AHEAD
    const int far = proposals[min(n - 1, i + ROWS_FAR_AHEAD)].row, near = proposals[min(n - 1, i + ROWS_AHEAD)].row;
    fetch_row(&mesh, far);
    fetch(&claims[far]);
    fetch(&row_keys[far]);
    for (int k = 0; k < 3; ++k) fetch(&claims[max(0, rows[near].neighbor[k])]);
#endif
    const proposal made = proposals[i];
    const uint claim = first + ranks[i];
    const int is_large = is_key_of_large(row_keys[made.row]);
    int wins = claims[made.row] >= claim;
    if (wins && !is_large) {
      for (int k = 0; k < 3; ++k) {
        const int neighbor = rows[made.row].neighbor[k];
        wins &= neighbor < 0 || claims[neighbor] >= claim;
      }
      if (wins && rules.rule == RULE_RING) wins = holds_ring(&mesh, &made, claims, claim);
    }
    outcomes[i] = (uchar)(wins ? (made.splits > 0 ? PROPOSAL_SPLITS : PROPOSAL_INSERTS) : PROPOSAL_LOSES);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// What follows

// n proposals in the order of their ranks: 1 for those that insert their points.
kernel void mark_winners(int n, global const int* restrict order, global const uchar* restrict outcomes,
                         global uchar* restrict inserts) {
  const int i = get_global_id(0);
  if (i < n) inserts[i] = outcomes[order[i]] == PROPOSAL_INSERTS;
}

// Puts aside the triangles whose points were refused, until they change.
kernel void refuse(int n, global const proposal* restrict proposals, global const uchar* restrict outcomes,
                   global uint64* restrict row_keys, global uchar* restrict refused) {
  const int i = get_global_id(0);
  if (i < n && outcomes[i] < PROPOSAL_OPEN) {
    row_keys[proposals[i].row] = NO_KEY;
    refused[proposals[i].row] = outcomes[i];
  }
}

kernel void count_wanted(int n, global const proposal* restrict proposals, global const uchar* restrict outcomes,
                         global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) counts[i] = outcomes[i] == PROPOSAL_SPLITS ? (uint)proposals[i].splits : 0u;
}

// offsets: the scanned counts. corners: opposite to the constraints that winners split, from element `first` on.
kernel void list_wanted(int n, refinement_rules rules, int first, global const proposal* restrict proposals,
                        global const uchar* restrict outcomes, global const uint* restrict offsets, REFINED_MESH(),
                        global int* restrict corners) {
  const int i = get_global_id(0);
  if (i < n && outcomes[i] == PROPOSAL_SPLITS) {
    const seen_mesh mesh = {rows, points};
    const proposal made = proposals[i];
    int to = first + (int)offsets[i];
    if (made.hit >= 0) {
      corners[to] = made.hit;
    } else {
      cavity_tour tour;
      start_tour(&tour, made.start, made.start);
      for (int next = next_in_tour(&tour, &mesh, place_of(&made)); next != NO_MORE;
           next = next_in_tour(&tour, &mesh, place_of(&made))) {
        if (next >= 0 && is_to_split(&mesh, next, place_of(&made), places, ends, rules)) corners[to++] = next;
      }
    }
  }
}

#endif
