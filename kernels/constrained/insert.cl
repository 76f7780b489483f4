// Constraints become edges of a triangulation, all at once, in rounds. docs/constrained.md says why this is right.
//
// A row is a triangle; corner 3t + k stands for the vertex there and for the edge opposite to it. A constraint's rank
// is a random number, which is always the same. Each kernel has a work-item per constraint unless it says otherwise.
//
// - walk_segments: how many edges each segment consists of, in the Delaunay triangulation, in which it walks
//   from vertex to vertex. Segments that are edges already are flagged as constraints; the others claim the
//   rows that they cross. If any segment consists of several edges, write_pieces writes those, and
//   walk_segments begins again with these as segments. The host scans the sizes that they need.
// - In each round, keep_waiting lists the constraints that are left. choose_constraints: constraints that hold
//   all rows that they cross win. It writes the two chains of vertices around these rows to their entries.
//   fill_cavities: winners replace their rows by the canonical triangulations of both chains, which they
//   gift-wrap. If they are many, constrained/fill_filtered.cl has done so before, as far as floating point
//   decides.
//   join_cavities: joins the new rows to the rows beyond the chains. walk_constraints: the others walk and
//   claim again.
// - Winners with long walks: gather_long writes their chains, chain_vertices the chains' vertices, fill_long
//   has a work-item per triangle, and join_long one per entry.
//
// Claims of constraints that did not win remain: on rows that have not changed since, they are as before, and winners'
// rows are marked by the round, which anyone may claim again. A constraint that found a row held by another one of
// smaller rank is blocked: as long as that holds the row, it cannot win, and does not walk.

// Exact predicates are rare, and compiling each where it may be called takes long.
#ifndef __cplusplus
#define OUT_OF_LINE __attribute__((noinline))
#endif

#include "arithmetic/language.h"
#include "constrained/arguments.h"
#include "constrained/cavities.h"
#include "constrained/codes.h"
#include "constrained/limits.h"
#include "constrained/meanwhile.h"
#include "constrained/records.h"
#include "constrained/segment_walks.h"
#include "mesh/halfedges.h"
#include "operations/prefetch.h"
#include "operations/search.h"
#include "predicates/planar.h"

// A random number below RANK_WON for each number below that, each once.
static inline uint rank_of(int constraint) {
  uint x = (uint)constraint;
  x = (x ^ x >> 15) * 0x2c1b3c6du & 0x7fffffffu;
  x = (x ^ x >> 12) * 0x297a2d39u & 0x7fffffffu;
  return x ^ x >> 15;
}

static inline walked_mesh mesh_of(global const coordinate* points, global const int* triangles,
                                  global const int* neighbors, filter_bound bound) {
  walked_mesh mesh;
  mesh.points = points;
  mesh.triangles = triangles;
  mesh.neighbors = neighbors;
  mesh.bound = bound;
  return mesh;
}

// Follows a segment from a corner that it leaves by crossing, to the next vertex on it. Returns the corner of
// that vertex in the last row; -1 if it leaves the triangulation. Claims the rows if `claims` is not null.
static inline int follow(const walked_mesh* mesh, int corner, int goal, uint rank, global volatile uint* claims,
                         constraint_walk* walk) {
  const coordinate2 from = vload2(mesh->triangles[corner], mesh->points), to = vload2(goal, mesh->points);
  walk->origin = mesh->triangles[corner];
  walk->corner = corner;
  walk->rows = 1;
  walk->turns = 0;
  int row = corner / 3;
  atomic_min(&claims[row], rank);
  while (1) {
    const int beyond = mesh->neighbors[corner];
    if (beyond < 0) return -1;
    const int facing = corner_with(beyond, row, mesh->neighbors);
    const int v = mesh->triangles[facing];
    row = beyond;
    atomic_min(&claims[row], rank);
    const int side = side_of_segment(mesh, from, to, goal, v);
    if (side == 0) {
      ++walk->rows;
      walk->goal = v;
      return facing;
    }
    if (side > 0) walk->turns |= (uint64)1 << (walk->rows & 63);
    ++walk->rows;
    corner = side > 0 ? next_halfedge(facing) : previous_halfedge(facing);
  }
}

// Stands for the number of rows of a blocked constraint; its turns are the row at which it is blocked.
#define BLOCKED -1

// The share of a constraint in the scanned sizes: its entries, and 1 if it is left.
static inline uint2 size_of_walk(int rows) {
  return VECTOR(uint2, rows > 0 && rows <= SHORT_WALK ? (uint)rows + 4u : 0u, 1u);
}

// ---------------------------------------------------------------------------------------------------------------------
// Segments

// How many pieces a walk goes through before it counts them.
#define COUNTED_PIECES 64u
// From how many rows on it counts those; most walks are shorter.
#define COUNTED_ROWS 16u

// The next piece of the remaining part of a segment, between two corners, which it moves. last: the end at
// which the piece before was. It looks there first: the other end may have very many triangles. Returns the
// piece's end, see find_departure. walk: of the piece; rows is 0 if it is an edge already.
static inline int next_piece(const walked_mesh* mesh, int* first, int* second, int last, uint rank,
                             global volatile uint* claims, constraint_walk* walk) {
  // As a rule the segment is an edge, which is found without arithmetic.
  const int edge = corner_at_edge(mesh, *first, mesh->triangles[*second]);
  if (edge >= 0) {
    walk->origin = mesh->triangles[*first];
    walk->goal = mesh->triangles[*second];
    walk->corner = edge;
    walk->rows = 0;
    walk->turns = 0;
    *first = *second;
    return LEAVES_FIRST;
  }
  departure found;
  const int is_turned = last == LEAVES_SECOND;
  int end = find_departure(mesh, is_turned ? *second : *first, is_turned ? *first : *second, &found);
  if (end == LEAVES_NONE) return end;
  if (is_turned) end = end == LEAVES_FIRST ? LEAVES_SECOND : LEAVES_FIRST;
  int* const here = end == LEAVES_FIRST ? first : second;
  const int goal = mesh->triangles[end == LEAVES_FIRST ? *second : *first];
  if (found.vertex >= 0) {
    walk->origin = mesh->triangles[*here];
    walk->goal = found.vertex;
    walk->corner = found.corner;
    walk->rows = 0;
    walk->turns = 0;
    // In the row of that edge.
    *here = corner_with(found.corner / 3, found.vertex, mesh->triangles);
    return end;
  }
  *here = follow(mesh, found.corner, goal, rank, claims, walk);
  return *here < 0 ? LEAVES_NONE : end;
}

static inline void flag_edge(int corner, const walked_mesh* mesh, global volatile uint* flags) {
  for (int twin = 0; twin < 2; ++twin) {
    const int row = corner / 3;
    atomic_or(&flags[row >> 2], edge_flag(corner) << 8 * (row & 3));
    if (mesh->neighbors[corner] < 0) return;
    corner = corner_with(mesh->neighbors[corner], row, mesh->neighbors);
  }
}

FETCHING void fetch_row(int corner, const walked_mesh* mesh) {
  fetch(&mesh->triangles[corner]);
  fetch(&mesh->neighbors[corner]);
}
FETCHING void fetch_points(int row, const walked_mesh* mesh) {
  for (int k = 0; k < 3; ++k) fetch(&mesh->points[2 * mesh->triangles[3 * row + k]]);
}

// How many segments ahead the data of a walk is fetched: the rows at both ends; then their neighbours, and the
// points of the row; then the points of the neighbours.
#define ROWS_AHEAD 24
#define NEIGHBORS_AHEAD 16
#define POINTS_AHEAD 8
// With fewer segments than this, everything is in the cache.
#define FETCHED_SEGMENTS 4096
FETCHING void fetch_segments(int s, int n, global const uint64* keys, const walked_mesh* mesh) {
#if FETCH_AHEAD
  if (n < FETCHED_SEGMENTS) return;
  const uint64 far = keys[min(n - 1, s + ROWS_AHEAD)], middle = keys[min(n - 1, s + NEIGHBORS_AHEAD)],
               near = keys[min(n - 1, s + POINTS_AHEAD)];
  // Keys of points on a line come last.
  if ((uint)far >= PLACE_ON_LINE) return;
  fetch_row((int)(far >> 32), mesh);
  fetch(&mesh->triangles[(uint)far]);
  const int row = (int)(middle >> 32) / 3;
  fetch(&mesh->points[2 * mesh->triangles[(uint)middle]]);
  fetch_points(row, mesh);
  for (int k = 0; k < 3; ++k) {
    const int beyond = mesh->neighbors[3 * row + k];
    if (beyond >= 0) fetch_row(3 * beyond, mesh);
  }
  const int near_row = (int)(near >> 32) / 3;
  for (int k = 0; k < 3; ++k) {
    const int beyond = mesh->neighbors[3 * near_row + k];
    if (beyond >= 0) fetch_points(beyond, mesh);
  }
#endif
}

// n keys of segments, see segments.cl. flags: bytes, four in each word. ends: of the first piece, the lexicographically
// smaller one first. Stops at limits of pieces and of rows, of all segments together.
kernel void walk_segments(int n, uint most_pieces, uint most_rows, filter_bound bound,
                          global const coordinate* restrict points, TRIANGULATION(), global const int* restrict hull,
                          global const uint64* restrict keys, global volatile uint* restrict claims,
                          global volatile uint* restrict flags, global constraint_walk* restrict walks,
                          global int* restrict ends, global uint* restrict pieces, global uint2* restrict sizes,
                          global volatile uint* restrict status) {
  const int s = get_global_id(0);
  if (s < n) {
    const walked_mesh mesh = mesh_of(points, triangles, neighbors, bound);
    fetch_segments(s, n, keys, &mesh);
    const uint first_place = (uint)(keys[s] >> 32), second_place = (uint)keys[s];
    uint count = 0;
    sizes[s] = VECTOR(uint2, 0u, 0u);
    if (first_place == UNCLAIMED || second_place == UNCLAIMED || (first_place ^ second_place) >= PLACE_ON_LINE) {
      atomic_or(&status[INSERTION_BROKEN], 1u);
    } else if (first_place >= PLACE_ON_LINE) {
      const int from = (int)(first_place - PLACE_ON_LINE);
      count = second_place - first_place;
      ends[2 * s] = hull[from];
      ends[2 * s + 1] = hull[from + 1];
      for (uint k = 0; count > 1 && k < count && read_shared(&status[INSERTION_PIECES]) <= most_pieces;
           k += COUNTED_PIECES) {
        atomic_add(&status[INSERTION_PIECES], (uint)min((int)COUNTED_PIECES, (int)(count - k)));
      }
    } else {
      int first = (int)first_place, second = (int)second_place, at = LEAVES_FIRST;
      uint rows = 0;
      constraint_walk walk;
      while (triangles[first] != triangles[second]) {
        if (read_shared(&status[INSERTION_ROWS]) > most_rows) {
          atomic_or(&status[INSERTION_STOPPED], 1u);
          break;
        }
        at = next_piece(&mesh, &first, &second, at, rank_of(s), claims, &walk);
        if (at == LEAVES_NONE) {
          atomic_or(&status[INSERTION_BROKEN], 1u);
          break;
        }
        if (walk.rows == 0) flag_edge(walk.corner, &mesh, flags);
        if (count % COUNTED_PIECES == 1 && read_shared(&status[INSERTION_PIECES]) > most_pieces) break;
        if (++count % COUNTED_PIECES == 0) atomic_add(&status[INSERTION_PIECES], COUNTED_PIECES);
        rows += (uint)walk.rows;
        if (rows >= COUNTED_ROWS) {
          atomic_add(&status[INSERTION_ROWS], rows);
          rows = 0;
        }
      }
      if (count > 1) atomic_add(&status[INSERTION_PIECES], count % COUNTED_PIECES);
      if (count == 1) {
        walks[s] = walk;
        const int in_order = comes_before(vload2(walk.origin, points), vload2(walk.goal, points));
        ends[2 * s] = in_order ? walk.origin : walk.goal;
        ends[2 * s + 1] = in_order ? walk.goal : walk.origin;
        if (walk.rows > 0) sizes[s] = size_of_walk(walk.rows);
        if (walk.rows > SHORT_WALK) atomic_inc(&status[INSERTION_LONG]);
      }
    }
    pieces[s] = count;
  }
}

// The pieces of all segments, by their ends, in lexicographic order in each segment. offsets: the scanned numbers.
// claims: not used any more.
kernel void write_pieces(int n, filter_bound bound, global const coordinate* restrict points, TRIANGULATION(),
                         global const int* restrict hull, global const uint64* restrict keys,
                         global const uint* restrict offsets, global volatile uint* restrict claims,
                         global int* restrict ends) {
  const int s = get_global_id(0);
  if (s < n) {
    const walked_mesh mesh = mesh_of(points, triangles, neighbors, bound);
    const uint first_place = (uint)(keys[s] >> 32), second_place = (uint)keys[s];
    const int begin = (int)offsets[s], end = (int)offsets[s + 1];
    if (first_place >= PLACE_ON_LINE) {
      const int from = (int)(first_place - PLACE_ON_LINE);
      for (int i = begin; i < end; ++i) {
        ends[2 * i] = hull[from + i - begin];
        ends[2 * i + 1] = hull[from + i - begin + 1];
      }
    } else {
      int first = (int)first_place, second = (int)second_place, from_first = 0, from_second = 0, at = LEAVES_FIRST;
      const int in_order = comes_before(vload2(triangles[first], points), vload2(triangles[second], points));
      constraint_walk walk = {-1, -1, -1, 0, 0};
      while (from_first + from_second < end - begin) {
        at = next_piece(&mesh, &first, &second, at, rank_of(s), claims, &walk);
        const int place = at == LEAVES_FIRST ? from_first++ : end - begin - 1 - from_second++;
        const int i = in_order ? begin + place : end - 1 - place;
        ends[2 * i] = walk.origin;
        ends[2 * i + 1] = walk.goal;
      }
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Rounds

// n elements of a list of constraints; of the first list, each is its own number. sizes: scanned. Writes the list of
// those that are left, and where their entries begin.
kernel void keep_waiting(int n, int is_first, global const int* restrict list, global const uint2* restrict sizes,
                         global int* restrict waiting, global uint* restrict offsets) {
  const int i = get_global_id(0);
  if (i < n) {
    const uint2 place = sizes[i], end = sizes[i + 1];
    if (place.y != end.y) {
      waiting[place.y] = is_first ? i : list[i];
      offsets[place.y] = place.x;
    }
  }
}

// Writes the edge opposite to a corner as that from an entry to the next one.
static inline void write_side(int corner, const walked_mesh* mesh, global const uchar* flags,
                              global chain_entry* entry) {
  const int row = corner / 3, beyond = mesh->neighbors[corner];
  const uint twin = beyond < 0 ? 0u : (uint)corner_with(beyond, row, mesh->neighbors) + 1u;
  entry->corner = corner;
  entry->side = twin << 1 | ((flags[row] & edge_flag(corner)) != 0);
}

// Walks along a constraint as long as it holds the rows, and writes entries if there are any: the row in each, in the
// order of the walk; the chain on the left of the constraint, from its origin to its goal, and the chain on its
// right, from the goal to the origin. Returns the number of entries on the left; if the constraint does not
// hold all rows, the complement of the first row that it does not hold.
static inline int gather_cavity(const constraint_walk* walk, uint rank, const walked_mesh* mesh,
                                global const uint* claims, global const uchar* flags, global chain_entry* entries,
                                int* crosses) {
  int corner = walk->corner, row = corner / 3, left = 0, right = walk->rows + 3;
  if (claims[row] != rank) return ~row;
  const int is_long = walk->rows > SHORT_WALK;
  coordinate2 from = VECTOR(coordinate2, 0, 0), to = from;
  if (is_long) {
    from = vload2(walk->origin, mesh->points);
    to = vload2(walk->goal, mesh->points);
  }
  const int next = next_halfedge(corner), previous = previous_halfedge(corner);
  if (entries) {
    entries[0].row = row;
    entries[left].vertex = entries[right].vertex = walk->origin;
    entries[right].corner = -1;
    write_side(next, mesh, flags, &entries[left]);
    entries[++left].vertex = mesh->triangles[previous];
    entries[--right].vertex = mesh->triangles[next];
    write_side(previous, mesh, flags, &entries[right]);
  } else {
    ++left;
  }
  for (int j = 1;; ++j) {
    const int beyond = mesh->neighbors[corner];
    *crosses |= flags[row] & edge_flag(corner);
    if (claims[beyond] != rank) return ~beyond;
    const int facing = corner_with(beyond, row, mesh->neighbors), v = mesh->triangles[facing];
    row = beyond;
    const int side = v == walk->goal          ? 0
                     : is_long                ? side_of_segment(mesh, from, to, walk->goal, v)
                     : (walk->turns >> j & 1) ? 1
                                              : -1;
    if (entries) {
      entries[j].row = row;
      if (side >= 0) {
        write_side(previous_halfedge(facing), mesh, flags, &entries[left]);
        entries[left + 1].vertex = v;
      }
      if (side <= 0) {
        entries[--right].vertex = v;
        write_side(next_halfedge(facing), mesh, flags, &entries[right]);
      }
    }
    left += side >= 0;
    if (side == 0) break;
    corner = side > 0 ? next_halfedge(facing) : previous_halfedge(facing);
  }
  if (entries) entries[left].corner = -1;
  return left + 1;
}

// 0 if a constraint that is an edge holds the rows beside it; else the complement of one that it does not hold.
static inline int hold_edge(int corner, uint rank, global const int* neighbors, global const uint* claims) {
  const int beyond = neighbors[corner];
  return claims[corner / 3] != rank ? ~(corner / 3) : beyond >= 0 && claims[beyond] != rank ? ~beyond : 0;
}

// offsets: of the entries. lefts: how many of these are on the left.
kernel void choose_constraints(int n, filter_bound bound, global const int* restrict list,
                               global const uint* restrict offsets, global const coordinate* restrict points,
                               TRIANGULATION(), global const uint* restrict claims, global const uchar* restrict flags,
                               global constraint_walk* restrict walks, global uchar* restrict outcomes,
                               global int* restrict lefts, global chain_entry* restrict entries,
                               global volatile uint* restrict status) {
  const int i = get_global_id(0);
  if (i < n) {
    const walked_mesh mesh = mesh_of(points, triangles, neighbors, bound);
#if FETCH_AHEAD
    const int far = walks[list[min(n - 1, i + NEIGHBORS_AHEAD)]].corner,
              near = walks[list[min(n - 1, i + POINTS_AHEAD)]].corner / 3;
    fetch_row(far, &mesh);
    fetch(&claims[far / 3]);
    for (int k = 0; k < 3; ++k) {
      const int beyond = max(0, neighbors[3 * near + k]);
      fetch_row(3 * beyond, &mesh);
      fetch(&claims[beyond]);
    }
#endif
    const uint rank = rank_of(list[i]);
    const constraint_walk walk = walks[list[i]];
    const int is_long = walk.rows > SHORT_WALK;
    int outcome = CONSTRAINT_WAITS;
    if (walk.rows != BLOCKED) {
      int crosses = 0;
      const int left = walk.rows == 0 ? hold_edge(walk.corner, rank, neighbors, claims)
                                      : gather_cavity(&walk, rank, &mesh, claims, flags,
                                                      is_long ? 0 : entries + offsets[i], &crosses);
      if (crosses) {
        atomic_or(&status[INSERTION_CROSSED], 1u);
      } else if (left >= 0) {
        outcome = is_long ? CONSTRAINT_FITS_LONG : CONSTRAINT_FITS;
        lefts[i] = left;
      } else {
        walks[list[i]].rows = BLOCKED;
        walks[list[i]].turns = (uint64)~left;
      }
    }
    outcomes[i] = (uchar)outcome;
  }
}

// Constraints whose entries' points are fetched. Entries follow each other in memory, so they need not be.
#define CAVITIES_AHEAD 4

kernel void fill_cavities(int n, uint mark, filter_bound bound, global const int* restrict list,
                          global const uint* restrict offsets, global const uchar* restrict outcomes,
                          global const int* restrict lefts, global const constraint_walk* restrict walks,
                          global const coordinate* restrict points, REBUILT_ROWS()) {
  const int i = get_global_id(0);
#if FETCH_AHEAD
  if (i + CAVITIES_AHEAD < n && outcomes[i + CAVITIES_AHEAD] == CONSTRAINT_FITS) {
    global const chain_entry* const ahead = entries + offsets[i + CAVITIES_AHEAD];
    const int count = walks[list[i + CAVITIES_AHEAD]].rows + 3;
    for (int p = 0; p < count && count > 3; ++p) fetch(&points[2 * ahead[p].vertex]);
  }
#endif
  if (i < n && outcomes[i] == CONSTRAINT_FITS) {
    const replaced_rows rows = {triangles, neighbors, claims, flags, changed, new_corners, mark};
    fill_cavity(walks[list[i]], lefts[i], entries + offsets[i], points, bound, &rows);
  }
}

// Joins a side to the row beyond it, and gives its vertex a new place if the row of its place was replaced.
static inline void join_side(chain_entry entry, uint mark, global const uint* claims, global const uint* marks,
                             global const int* new_corners, global int* neighbors, global volatile uint* places) {
  const int inside = new_corners[entry.corner], row = inside / 3, twin = (int)(entry.side >> 1) - 1;
  int beyond = -1;
  if (twin >= 0) {
    beyond = twin / 3;
    if (claims[beyond] == mark) {
      beyond = new_corners[twin] / 3;
    } else {
      neighbors[twin] = row;
    }
  }
  neighbors[inside] = beyond;
  const int v = entry.vertex;
  if (marks[v >> 5] >> (v & 31) & 1) {
    // The edge from i to j is opposite to the second corner, and i is at the first one; or j to k, and j at the third.
    const int corner = 3 * row + (inside - 3 * row == 1 ? 0 : BASE_CORNER);
    if (claims[read_shared(&places[v]) / 3] == mark) write_shared(&places[v], (uint)corner);
  }
}

kernel void join_cavities(int n, uint mark, global const int* restrict list, global const uint* restrict offsets,
                          global const int* restrict lefts, global const constraint_walk* restrict walks,
                          global const uint* restrict claims, global const uint* restrict marks,
                          global const int* restrict new_corners, global const chain_entry* restrict entries,
                          global uchar* restrict outcomes, global int* restrict neighbors,
                          global volatile uint* restrict places) {
  const int i = get_global_id(0);
#if FETCH_AHEAD
  if (i + CAVITIES_AHEAD < n && outcomes[i + CAVITIES_AHEAD] == CONSTRAINT_FITS) {
    global const chain_entry* const ahead = entries + offsets[i + CAVITIES_AHEAD];
    const int count = walks[list[i + CAVITIES_AHEAD]].rows + 3;
    for (int p = 0; p < count && count > 3; ++p) {
      const int twin = max(0, (int)(ahead[p].side >> 1) - 1);
      fetch(&claims[twin / 3]);
      fetch(&neighbors[twin]);
      fetch(&new_corners[max(0, ahead[p].corner)]);
      const int v = ahead[p].vertex;
      if (marks[v >> 5] >> (v & 31) & 1) fetch((global const void*)&places[v]);
    }
  }
#endif
  if (i < n) {
    const int rows = walks[list[i]].rows;
    if (outcomes[i] == CONSTRAINT_WAITS) {
      if (rows == BLOCKED && claims[walks[list[i]].turns] < rank_of(list[i])) outcomes[i] = CONSTRAINT_BLOCKED;
    } else if ((outcomes[i] == CONSTRAINT_FITS || outcomes[i] == CONSTRAINT_FILLED) && rows > 0) {
      for (int p = 0; p < rows + 3; ++p) {
        const chain_entry entry = entries[offsets[i] + p];
        if (p != lefts[i] - 1) join_side(entry, mark, claims, marks, new_corners, neighbors, places);
      }
    }
  }
}

// The constraints of the list that have not won walk and claim again. sizes: as in walk_segments.
kernel void walk_constraints(int n, filter_bound bound, global const int* restrict list,
                             global const uchar* restrict outcomes, global const coordinate* restrict points,
                             TRIANGULATION(), global const uint* restrict places, global volatile uint* restrict claims,
                             global constraint_walk* restrict walks, global uint2* restrict sizes,
                             global volatile uint* restrict status) {
  const int i = get_global_id(0);
  if (i < n) {
    if (outcomes[i] == CONSTRAINT_BLOCKED) {
      sizes[i] = size_of_walk(BLOCKED);
    } else if (outcomes[i] != CONSTRAINT_WAITS) {
      sizes[i] = VECTOR(uint2, 0u, 0u);
    } else {
      const walked_mesh mesh = mesh_of(points, triangles, neighbors, bound);
      const uint rank = rank_of(list[i]);
      constraint_walk walk = walks[list[i]];
      const int origin = walk.origin, goal = walk.goal;
      int first = walk.corner, second;
      departure found;
      // As a rule it leaves through the same row.
      int is_found = 0;
      if (triangles[first] == origin) {
        const star_search star = star_search_at(&mesh, first, goal);
        is_found = star.next_side < 0 && star.previous_side > 0;
        found.corner = first;
        found.vertex = -1;
      }
      int end = LEAVES_FIRST;
      if (!is_found) {
        first = (int)places[origin];
        second = (int)places[goal];
        end = find_departure(&mesh, first, second, &found);
      }
      if (end != LEAVES_NONE && found.vertex >= 0) {
        walk.corner = found.corner;
        walk.rows = 0;
        atomic_min(&claims[found.corner / 3], rank);
        if (neighbors[found.corner] >= 0) atomic_min(&claims[neighbors[found.corner]], rank);
      } else if (end == LEAVES_NONE ||
                 follow(&mesh, found.corner, end == LEAVES_FIRST ? goal : origin, rank, claims, &walk) < 0) {
        atomic_or(&status[INSERTION_BROKEN], 1u);
      }
      walks[list[i]] = walk;
      sizes[i] = size_of_walk(walk.rows);
      if (walk.rows > SHORT_WALK) atomic_inc(&status[INSERTION_LONG]);
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Winners with long walks

// n elements of the list that have won: their numbers of entries.
kernel void measure_long(int n, global const int* restrict winners, global const int* restrict list,
                         global const constraint_walk* restrict walks, global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) counts[i] = (uint)walks[list[winners[i]]].rows + 4u;
}

// offsets: the scanned counts. chain_offsets: where the chains begin, two per winner, and their end.
kernel void gather_long(int n, filter_bound bound, global const int* restrict winners, global const int* restrict list,
                        global const uint* restrict offsets, global const constraint_walk* restrict walks,
                        global const coordinate* restrict points, TRIANGULATION(), global const uint* restrict claims,
                        global const uchar* restrict flags, global chain_entry* restrict entries,
                        global int* restrict chain_offsets) {
  const int i = get_global_id(0);
  if (i < n) {
    const walked_mesh mesh = mesh_of(points, triangles, neighbors, bound);
    const int constraint = list[winners[i]];
    const constraint_walk walk = walks[constraint];
    int crosses = 0;
    const int left = gather_cavity(&walk, rank_of(constraint), &mesh, claims, flags, entries + offsets[i], &crosses);
    chain_offsets[2 * i] = (int)offsets[i];
    chain_offsets[2 * i + 1] = (int)offsets[i] + left;
    if (i + 1 == n) chain_offsets[2 * n] = (int)offsets[n];
  }
}

// n entries.
kernel void chain_vertices(int n, global const chain_entry* restrict entries, global int* restrict chain) {
  const int i = get_global_id(0);
  if (i < n) chain[i] = entries[i].vertex;
}

// n triangles of all chains, three positions in the chain each.
kernel void fill_long(int n, uint mark, int chains, global const int* restrict chain_offsets,
                      global const int* restrict chain_triangles, REBUILT_ROWS()) {
  const int t = get_global_id(0);
  if (t < n) {
    // The last chain whose triangles begin here or before.
    int low = 0, high = chains;
    while (high - low > 1) {
      const int middle = low + (high - low) / 2;
      if (chain_offsets[middle] - 2 * middle <= t) {
        low = middle;
      } else {
        high = middle;
      }
    }
    const replaced_rows rows = {triangles, neighbors, claims, flags, changed, new_corners, mark};
    global chain_entry* const chain = entries + chain_offsets[low];
    // Each pair of chains before has as many rows as triangles, and 4 entries more.
    global const chain_entry* const row_of = entries + 4 * (low / 2);
    const int i = chain_triangles[3 * t], j = chain_triangles[3 * t + 1], k = chain_triangles[3 * t + 2];
    const int row = row_of[t].row, corner = 3 * row;
    uint flag = 0;
    if (k - i == chain_offsets[low + 1] - chain_offsets[low] - 1) {
      const int other = chain_offsets[low ^ 1] - 2 * (low ^ 1);
      neighbors[corner + BASE_CORNER] = row_of[other].row;
      flag = edge_flag(corner + BASE_CORNER);
    }
    if (k - j > 1) {
      join(corner, 3 * row_of[t + j - i].row + BASE_CORNER, &rows);
    } else {
      flag |= put_side(corner, &chain[j], &rows);
    }
    if (j - i > 1) {
      join(corner + 1, 3 * row_of[t + 1].row + BASE_CORNER, &rows);
    } else {
      flag |= put_side(corner + 1, &chain[i], &rows);
    }
    put_row(row, chain[i].vertex, chain[k].vertex, chain[j].vertex, flag, &rows);
  }
}

// n entries.
kernel void join_long(int n, uint mark, global const uint* restrict claims, global const uint* restrict marks,
                      global const int* restrict new_corners, global const chain_entry* restrict entries,
                      global int* restrict neighbors, global volatile uint* restrict places) {
  const int i = get_global_id(0);
  if (i < n && entries[i].corner >= 0) join_side(entries[i], mark, claims, marks, new_corners, neighbors, places);
}
