// The triangulations of long chains, by many work-items together: as constrained/chains.cl, with a work-item per
// vertex.
//
// Vertices are removed and inserted in rounds. In a round of thin_chains, each chain loses a random set of
// vertices, no two of them neighbours, about a third of its vertices: O(log k) rounds for k vertices.
// finish_thinning removes the rest. Then vertices are inserted in the opposite order: each as soon as the two
// between which it was removed are there. In each round, claim_triangles puts the random keys of these vertices
// on the triangles that they remove. A vertex wins if it has all of them, and no better key is on a triangle
// beside them (choose_vertices). So the triangles of winners neither overlap nor touch, and it is as if
// insert_vertices inserted them one after the other. The best key always wins.
//
// A vertex with very many triangles would keep all others waiting. If a walk takes more than `longest_walk` steps, the
// vertex is marked as a hub, and all starts again, with hubs removed last and inserted first, when there are few
// others.
//
// check_triangles checks the result. Triangles are placed in preorder. The triangle (i, j, k) has place i plus
// the number of ancestors whose left children lead to it. Vertex j is the apex of one triangle, so this number
// is one more for k = j: link_apexes and jump_apexes find it by pointer jumping. write_chain_rows writes the
// triangles.

#include "constrained/arguments.h"
#include "constrained/chains.h"
#include "constrained/records.h"
#include "operations/counters.h"
#include "operations/search.h"

// For each vertex in a list, the vertices before and after it. A vertex that is removed has NOT_LISTED.
#define NOT_LISTED VECTOR(int2, -2, -2)
#define NO_OWNER 0xffffffffu

// A different random number of this many bits for each vertex; the bits must suffice for all.
static inline uint random_key(int vertex, int bits, int round) {
  const uint most = (1u << bits) - 1u;
  const int half_bits = (bits + 1) / 2;
  uint x = (uint)vertex;
  for (int k = 0; k < 3; ++k) {
    x = (x * 0x2c1b3c6du + (uint)round * 0x297a2d39u) & most;
    x ^= x >> half_bits;
  }
  return x;
}

// The bits of the largest position.
static inline int bits_of(const polygon* g) { return 32 - clz(g->last); }

// Keys by which vertices claim triangles, below NO_OWNER: the smaller one wins. Vertices that were removed later go
// first: if many others went before one of them, it would take very many triangles away, and hardly ever win.
static inline uint claim_key(const polygon* g, int vertex, int stage, int round) {
  const int bits = bits_of(g);
  return (uint)min((uint64)stage, ((uint64)1 << (32 - bits)) - (uint64)2) << bits | random_key(vertex, bits, round);
}

// sizes: per chain, whether it is long, and its vertices if so.
kernel void measure_long_chains(int n, int least, global const int* restrict offsets, global uint2* restrict sizes) {
  const int c = get_global_id(0);
  if (c >= n) return;
  const int size = offsets[c + 1] - offsets[c];
  sizes[c] = size >= least ? VECTOR(uint2, 1u, (uint)size) : VECTOR(uint2, 0u, 0u);
}

// places: the scanned sizes. Lists the long chains, and where their vertices begin.
kernel void list_long_chains(int n, global const uint2* restrict places, global int* restrict chains,
                             global int* restrict offsets) {
  const int c = get_global_id(0);
  if (c > n) return;
  if (c == n || places[c].x != places[c + 1].x) {
    offsets[places[c].x] = places[c].y;
    if (c < n) chains[places[c].x] = c;
  }
}

// chains: the long ones, with vertices from `offsets` on; all chains' vertices begin at `all`. of: chains of
// vertices.
kernel void start_vertices(int n, int count, global const int* restrict chains, global const int* restrict offsets,
                           global const int* restrict all, global const coordinate2* restrict all_places,
                           global int* restrict of, global coordinate2* restrict places, global uchar* restrict hubs) {
  const int i = get_global_id(0);
  if (i >= n) return;
  const int c = segment_of(i, count, offsets);
  of[i] = c;
  places[i] = all_places[all[chains[c]] + i - offsets[c]];
  hubs[i] = 0;
}

kernel void start_lists(int n, global const int* restrict offsets, global const int* restrict of,
                        global chain_vertex* restrict vertices, global int2* restrict list,
                        global uint* restrict owners) {
  const int i = get_global_id(0);
  if (i >= n) return;
  const int v = i - offsets[of[i]];
  vertices[i].next = -1;
  list[i] = VECTOR(int2, v - 1, v + 1);
  owners[i] = NO_OWNER;
}

// ---------------------------------------------------------------------------------------------------------------------
// Removal

typedef struct {
  polygon g;
  int round, with_hubs;
  global const int2* list;
  global const uchar* hubs;
} thinning;

static inline int can_go(const thinning* of, int v) {
  if (v <= 0 || v >= of->g.last || (of->hubs[v] && !of->with_hubs)) return 0;
  const int2 at = of->list[v];
  return (at.x > 0 || at.y < of->g.last) && may_be_removed(&of->g, at.x, v, at.y);
}

static inline int goes_before(const thinning* of, int v, int other) {
  return !can_go(of, other) ||
         random_key(v, bits_of(&of->g), of->round) < random_key(other, bits_of(&of->g), of->round);
}

static inline int goes(const thinning* of, int v) {
  if (!can_go(of, v)) return 0;
  const int2 at = of->list[v];
  return goes_before(of, v, at.x) && goes_before(of, v, at.y);
}

// stage: of the vertices that go.
kernel void thin_chains(int n, int round, int stage, int with_hubs, global const int* restrict offsets,
                        global const int* restrict of, global const coordinate2* restrict places,
                        global const uchar* restrict hubs, global const int2* restrict list,
                        global int2* restrict thinned, global chain_vertex* restrict vertices,
                        global uchar* restrict stages) {
  const int i = get_global_id(0);
  if (i >= n) return;
  const int first = offsets[of[i]], v = i - first;
  int2 at = list[i];
  if (at.y >= 0) {
    thinning t;
    t.g = polygon_at(0, first, offsets[of[i] + 1] - first, places, vertices, 0);
    t.round = round;
    t.with_hubs = with_hubs;
    t.list = list + first;
    t.hubs = hubs + first;
    if (goes(&t, v)) {
      vertices[i].before = at.x;
      vertices[i].after = at.y;
      stages[i] = stage;
      at = NOT_LISTED;
    } else {
      if (v > 0 && goes(&t, at.x)) at.x = list[first + at.x].x;
      if (v < t.g.last && goes(&t, at.y)) at.y = list[first + at.y].y;
    }
  }
  thinned[i] = at;
}

// Removes all but one, for each long chain, and puts the first triangle. Their stage is 0.
kernel void finish_thinning(int n, global const int* restrict offsets, global const coordinate2* restrict places,
                            global int2* restrict lists, global chain_vertex* restrict vertices,
                            global chain_edge* restrict edges, global uchar* restrict stages COUNTERS) {
  const int c = get_global_id(0);
  if (c >= n) return;
  const int first = offsets[c];
  const polygon g = polygon_at(0, first, offsets[c + 1] - first, places, vertices, edges);
  global int2* const list = lists + first;
  int v = list[0].y, steps = 0;
  while (list[v].x > 0 || list[v].y < g.last) {
    const int2 at = list[v];
    if (may_be_removed(&g, at.x, v, at.y)) {
      g.vertices[v].before = at.x;
      g.vertices[v].after = at.y;
      stages[first + v] = 0;
      list[at.x].y = at.y;
      list[at.y].x = at.x;
      v = at.y < g.last ? list[at.y].y : g.last;
    } else {
      v = at.y;
    }
    if (v == g.last) v = list[0].y;
    ++steps;
  }
  put_first(&g, v);
  COUNT_STEPS(steps);
}

// ---------------------------------------------------------------------------------------------------------------------
// Insertion

// The action of a vertex in a round: it waits for another one, takes triangles away, or takes none.
#define WAITS 0
#define TAKES 1
#define TAKES_NONE 2

static inline int is_missing(const polygon* g, int v) { return v > 0 && v < g->last && g->vertices[v].next < 0; }

// A vertex that takes no triangle away claims the one that it is joined to. hubs: those that are found in pass p become
// p + 1.
kernel void claim_triangles(int n, int round, int pass, int longest_walk, filter_bound bound, WORKED_CHAINS(),
                            global const uchar* restrict stages, global uchar* restrict hubs,
                            global volatile uint* restrict owners, global uchar* restrict roles,
                            global volatile uint* restrict state COUNTERS) {
  const int i = get_global_id(0);
  if (i >= n) return;
  const int first = offsets[of[i]], v = i - first;
  const polygon g = polygon_at(bound, first, offsets[of[i] + 1] - first, places, vertices, edges);
  int role = WAITS;
  if (is_missing(&g, v) && hubs[i] != pass + 1 && g.vertices[g.vertices[v].before].next == g.vertices[v].after) {
    const int before = g.vertices[v].before;
    const uint key = claim_key(&g, v, stages[i], round);
    int h = g.vertices[before].inside, steps = 0;
    role = takes_away(&g, h, v) ? TAKES : TAKES_NONE;
    atomic_min(&owners[first + h / 3], key);
    if (role == TAKES) h = g.edges[next_halfedge(h)].twin;
    while (role == TAKES) {
      if (++steps > longest_walk) {
        hubs[i] = pass + 1;
        atomic_inc(&state[1]);
        role = WAITS;
      } else if (h >= 0 && takes_away(&g, h, v)) {
        atomic_min(&owners[first + h / 3], key);
        h = g.edges[next_halfedge(h)].twin;
      } else {
        const int crossed = edge_after(&g, h, before);
        if (crossed < 0) break;
        h = g.edges[crossed].twin;
      }
    }
    COUNT_STEPS(steps + 1);
  }
  roles[i] = role;
}

// Whether a vertex has all triangles that it takes away, and none beside them has a better key.
static inline int has_all(const polygon* g, int v, uint key, global const uint* owners) {
  const int before = g->vertices[v].before;
  int h = g->vertices[before].inside;
  while (1) {
    const uint owner = h >= 0 ? owners[h / 3] : NO_OWNER;
    if (owner < key) return 0;
    if (owner == key) {
      h = g->edges[next_halfedge(h)].twin;
    } else {
      const int crossed = edge_after(g, h, before);
      if (crossed < 0) return 1;
      h = g->edges[crossed].twin;
    }
  }
}

// Vertices that lose wait. Clears the owners of the next round. state[0]: how many vertices are left, if counts.
kernel void choose_vertices(int n, int round, int counts, WORKED_CHAINS(), global const uchar* restrict stages,
                            global const uint* restrict owners, global uint* restrict next_owners,
                            global uchar* restrict roles, global volatile uint* restrict state) {
  const int i = get_global_id(0);
  if (i >= n) return;
  next_owners[i] = NO_OWNER;
  const int first = offsets[of[i]], v = i - first;
  const polygon g = polygon_at(0, first, offsets[of[i] + 1] - first, places, vertices, edges);
  const uint key = claim_key(&g, v, stages[i], round);
  int role = roles[i];
  if (role == TAKES && !has_all(&g, v, key, owners + first)) role = WAITS;
  if (role == TAKES_NONE && owners[first + g.vertices[g.vertices[v].before].inside / 3] != key) role = WAITS;
  roles[i] = role;
  if (counts && role == WAITS && is_missing(&g, v)) atomic_inc(&state[0]);
}

kernel void insert_vertices(int n, int round, WORKED_CHAINS(), global const uchar* restrict stages,
                            global const uint* restrict owners, global const uchar* restrict roles) {
  const int i = get_global_id(0);
  if (i >= n || roles[i] == WAITS) return;
  const int first = offsets[of[i]], v = i - first;
  const polygon g = polygon_at(0, first, offsets[of[i] + 1] - first, places, vertices, edges);
  const chain_vertex at = g.vertices[v];
  // The only triangle that it looks at otherwise is its own, which it leaves.
  const uint key = roles[i] == TAKES ? claim_key(&g, v, stages[i], round) : NO_OWNER;
  insert_vertex(&g, at.before, v, at.after, owners + first, key);
}

// ---------------------------------------------------------------------------------------------------------------------
// The result

kernel void check_triangles(int n, filter_bound bound, WORKED_CHAINS(), global volatile uint* restrict wrong) {
  const int i = get_global_id(0);
  if (i >= n) return;
  const int first = offsets[of[i]], v = i - first;
  const polygon g = polygon_at(bound, first, offsets[of[i] + 1] - first, places, vertices, edges);
  if (v > 0 && v < g.last && !is_right(&g, own_triangle(v))) atomic_or(&wrong[of[i]], 1u);
}

// The corners of a triangle by their positions, ascending.
static inline int3 ascending(const polygon* g, int triangle) {
  int h = 3 * triangle;
  // The half-edge that leads to a larger position.
  while (g->edges[h].origin > g->edges[next_halfedge(h)].origin) ++h;
  return VECTOR3(int3, g->edges[h].origin, g->edges[previous_halfedge(h)].origin, g->edges[next_halfedge(h)].origin);
}

// jumps: per vertex, one whose number of ancestors is known to be so much less.
kernel void link_apexes(int n, WORKED_CHAINS(), global int2* restrict jumps) {
  const int i = get_global_id(0);
  if (i >= n) return;
  const int first = offsets[of[i]], v = i - first;
  const polygon g = polygon_at(0, first, offsets[of[i] + 1] - first, places, vertices, edges);
  if (v == 0 || v == g.last) {
    jumps[i] = VECTOR(int2, i, 0);
  } else {
    const int3 corners = ascending(&g, own_triangle(v));
    jumps[first + corners.y] = VECTOR(int2, first + corners.z, 1);
  }
}

kernel void jump_apexes(int n, global const int2* restrict jumps, global int2* restrict result) {
  const int i = get_global_id(0);
  if (i >= n) return;
  const int2 first = jumps[i], second = jumps[first.x];
  result[i] = VECTOR(int2, second.x, first.y + second.y);
}

// Chains that are wrong are gift-wrapped, by the work-items of their first vertices.
kernel void write_chain_rows(int n, filter_bound bound, global const int* restrict chains, WORKED_CHAINS(),
                             global const int* restrict all, global const int2* restrict jumps,
                             global const uint* restrict wrong, global int* restrict triangles) {
  const int i = get_global_id(0);
  if (i >= n) return;
  const int first = offsets[of[i]], v = i - first, c = chains[of[i]];
  const polygon g = polygon_at(bound, first, offsets[of[i] + 1] - first, places, vertices, edges);
  global int* const rows = triangles + (int64)3 * (all[c] - 2 * c);
  if (wrong[of[i]]) {
    if (v == 0) wrap(&g, rows);
  } else if (v > 0 && v < g.last) {
    const int3 corners = ascending(&g, own_triangle(v));
    global int* const row = rows + 3 * (corners.x + jumps[first + corners.z].y);
    row[0] = corners.x;
    row[1] = corners.y;
    row[2] = corners.z;
  }
}
