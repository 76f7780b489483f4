// Domains of a triangulation with constraints: regions, their depths, and the kept triangles. The elements are
// triangles, segments, constraint edges or regions of all sets at once; no kernel knows of sets.
//
// 1. Regions. start_regions joins triangles of a chunk that are connected without crossing a constraint, and
//    join_regions joins triangles of different chunks: to a forest in which every parent has a smaller number,
//    so that roots are the first triangles of their regions, whatever the order of joins (Jaiganesh and
//    Burtscher, "A high-performance connected components implementation for GPUs", 2018). find_roots and, after
//    a scan over roots, number_regions give each triangle its region's number. Few triangles are visited by one
//    work-item (visit_regions).
// 2. Weights of constraint edges, if the fill rule needs them: cover_edges writes where segments begin and end to
//    cover edges; a scan of this gives each edge's sum. count_ends and find_unbalanced find points where segments are
//    no closed curves. list_edges puts the edges into a hash table, by which triangles find them.
// 3. Borders. count_borders counts for each triangle its constraints to another region with a larger triangle there,
//    or to the outside; after a scan write_borders lists them.
// 4. Depths. Each pass of reach_regions over the borders goes one level further from outside. Where there are too many
//    levels the host goes on, one region after the other (src/constrained/domains/domain.cpp). finish_regions says
//    which regions are kept.
// 5. Holes. drop_holes marks the regions of the triangles that contain seeds, which seeds.cl has found.
// 6. Result. count_left and, after a scan, write_left move the kept triangles; find_offsets, number_labels and
//    write_labels do the rest.

#include "arithmetic/bit_account.h"
#include "arithmetic/language.h"
#include "constrained/arguments.h"
#include "constrained/fill_rules.h"
#include "constrained/meanwhile.h"

// Where another work-item has joined meanwhile: an older parent is an ancestor, too, and whether an old root is
// still a root is checked when it is joined (constrained/meanwhile.h).

// ---------------------------------------------------------------------------------------------------------------------
// Regions

// Makes paths shorter on its way.
static inline int root_of(int t, global volatile int* parents) {
  int parent = read_shared(&parents[t]);
  while (parent != t) {
    const int above = read_shared(&parents[parent]);
    if (above == parent) return parent;
    write_shared(&parents[t], above);
    t = above;
    parent = read_shared(&parents[t]);
  }
  return t;
}

// The root of t in parents that no other work-item reads or writes meanwhile.
static inline int own_root_of(int t, global int* parents) {
  int parent = parents[t];
  while (parent != t) {
    const int above = parents[parent];
    parents[t] = above;
    t = above;
    parent = parents[t];
  }
  return t;
}

// Joins neighbours within each chunk.
kernel void start_regions(int n, int chunk, global const int* restrict neighbors,
                          global const uchar* restrict constrained, global int* restrict parents) {
  const int c = get_global_id(0);
  const int low = c * chunk, high = (int)min((int64)n, ((int64)c + 1) * chunk);
  for (int t = low; t < high; ++t) {
    parents[t] = t;
    int root = t;
    for (int k = 3 * t; k < 3 * t + 3; ++k) {
      const int u = neighbors[k];
      if ((u < low) | (u >= t) | constrained[k]) continue;
      const int other = own_root_of(u, parents);
      parents[max(root, other)] = min(root, other);
      root = min(root, other);
    }
  }
}

// Where all triangles are one chunk: a work-item alone visits the regions one after the other, and numbers them.
// regions: each triangle's number. visited: n + 3. count: that of the regions.
kernel void visit_regions(int n, global const int* restrict neighbors, global const uchar* restrict constrained,
                          global int* restrict regions, global int* restrict visited, global uint* restrict count) {
  if (get_global_id(0) == 0) {
    for (int t = 0; t < n; ++t) regions[t] = -1;
    int region = 0;
    for (int first = 0; first < n; ++first) {
      if (regions[first] >= 0) continue;
      regions[first] = region;
      visited[0] = first;
      for (int top = 1; top > 0;) {
        const int t = visited[--top];
        for (int k = 3 * t; k < 3 * t + 3; ++k) {
          // Without a branch, since it could not be predicted.
          const int u = max(neighbors[k], 0), known = regions[u];
          const int is_new = (neighbors[k] >= 0) & (known < 0) & !constrained[k];
          regions[u] = is_new ? region : known;
          visited[top] = u;
          top += is_new;
        }
      }
      ++region;
    }
    count[0] = (uint)region;
  }
}

static inline void join(int t, int u, global volatile int* parents) {
  int a = root_of(t, parents), b = root_of(u, parents);
  while (a != b) {
    const int high = max(a, b), low = min(a, b);
    const int found = atomic_cmpxchg(&parents[high], high, low);
    if (found == high) return;
    a = root_of(found, parents);
    b = root_of(low, parents);
  }
}

// length: of the chunks in which neighbours are joined already.
kernel void join_regions(int n, int length, global const int* restrict neighbors,
                         global const uchar* restrict constrained, global volatile int* restrict parents) {
  const int t = get_global_id(0);
  if (t < n) {
    const int low = t - t % length;
    for (int k = 3 * t; k < 3 * t + 3; ++k) {
      const int u = neighbors[k];
      if (u >= 0 && u < low && !constrained[k]) join(t, u, parents);
    }
  }
}

// regions: the first triangle of each triangle's region. counts: 1 where that is the triangle itself, for a scan.
kernel void find_roots(int n, global volatile int* restrict parents, global int* restrict regions,
                       global uint* restrict counts) {
  const int t = get_global_id(0);
  if (t < n) {
    const int root = root_of(t, parents);
    regions[t] = root;
    counts[t] = root == t;
  }
}

// numbers: the scan of find_roots' counts.
kernel void number_regions(int n, global const uint* restrict numbers, global int* restrict regions) {
  const int t = get_global_id(0);
  if (t < n) regions[t] = (int)numbers[regions[t]];
}

// ---------------------------------------------------------------------------------------------------------------------
// Weights

// The pieces of a segment are on its way from the lexicographically smaller end to the other one. changes: 0
// throughout; gets 1 where a piece's edges begin, and -1 where they end; with the winding rule the opposite if the
// segment goes the other way than its edges.
kernel void cover_edges(int n, int rule, global const double_bits* restrict input, global const int* restrict segments,
                        global const int* restrict representatives, global const int* restrict piece_offsets,
                        global const int* restrict piece_edges, global const int* restrict edges,
                        global volatile uint* restrict changes) {
  const int s = get_global_id(0);
  if (s < n) {
    const int a = representatives[segments[2 * s]], b = representatives[segments[2 * s + 1]];
    if (a != b) {
      const int is_turned = lies_before(b, a, input);
      int from = is_turned ? b : a;
      for (int p = piece_offsets[s]; p < piece_offsets[s + 1]; ++p) {
        const int first = piece_edges[2 * p], end = piece_edges[2 * p + 1];
        if (first == end) continue;
        const int is_backward = edges[2 * first] != from;
        from = is_backward ? edges[2 * first] : edges[2 * end - 1];
        const uint amount = rule == FILL_WINDING && is_backward != is_turned ? (uint)-1 : 1u;
        atomic_add(&changes[first], amount);
        atomic_add(&changes[end], (uint)0 - amount);
      }
    }
  }
}

// balances: 0 throughout; gets the number of segments that begin at a point minus the segments that end there,
// or the number that do either. The representative of equal points has the segments of all.
kernel void count_ends(int n, int rule, global const int* restrict segments, global const int* restrict representatives,
                       global volatile uint* restrict balances) {
  const int s = get_global_id(0);
  if (s < n) {
    atomic_add(&balances[representatives[segments[2 * s]]], 1u);
    atomic_add(&balances[representatives[segments[2 * s + 1]]], rule == FILL_WINDING ? (uint)-1 : 1u);
  }
}

// bad[0]: INT_MAX; gets the first point where segments are no closed curves.
kernel void find_unbalanced(int n, int rule, global const uint* restrict balances, global volatile int* restrict bad) {
  const int i = get_global_id(0);
  if (i < n && (rule == FILL_WINDING ? balances[i] != 0 : balances[i] & 1)) atomic_min(&bad[0], i);
}

// Whether edges must be known: not if the rule is even-odd and every one is covered an odd number of times. needed[0]:
// 0.
kernel void find_even(int n, int rule, global const uint* restrict sums, global uint* restrict needed) {
  const int e = get_global_id(0);
  if (e < n && (rule == FILL_WINDING || (sums[e + 1] & 1) == 0)) needed[0] = 1;
}

// Where an edge may be in the hash table: first by its first point, so that edges that are close in memory stay
// close, and then anywhere, since very many edges may have the same first point.
#define PLACES_BY_POINT 4
static inline int slot_of(int from, int to, uint attempt, int mask) {
  const uint home = attempt < PLACES_BY_POINT ? 2 * (uint)from : edge_hash(from, to);
  return (int)((home + attempt) & (uint)mask);
}

// slots: mask + 1, a power of two, -1 throughout; twice as many as edges, and more than PLACES_BY_POINT.
kernel void list_edges(int n, int mask, global const uint* restrict needed, global const int* restrict edges,
                       global volatile int* restrict slots) {
  const int e = get_global_id(0);
  if (e < n && needed[0]) {
    uint attempt = 0;
    while (atomic_cmpxchg(&slots[slot_of(edges[2 * e], edges[2 * e + 1], attempt, mask)], -1, e) != -1) ++attempt;
  }
}

// The number of the edge in slots; -1 if it is not there, which cannot be.
static inline int find_edge(int from, int to, int mask, global const int* edges, global const int* slots) {
  for (uint attempt = 0;; ++attempt) {
    const int e = slots[slot_of(from, to, attempt, mask)];
    if (e < 0 || (edges[2 * e] == from && edges[2 * e + 1] == to)) return e;
  }
}

// The sum of segments that a path crosses over the edge from v to w, right to left. sums: edge e at e + 1.
static inline int crossed(int v, int w, int mask, global const double_bits* input, global const uint* needed,
                          global const uint* sums, global const int* edges, global const int* slots) {
  if (!needed[0]) return 1;
  const int is_turned = lies_before(w, v, input);
  const int e = is_turned ? find_edge(w, v, mask, edges, slots) : find_edge(v, w, mask, edges, slots);
  const int sum = e < 0 ? 0 : (int)sums[e + 1];
  return is_turned ? -sum : sum;
}

// ---------------------------------------------------------------------------------------------------------------------
// Borders

// Whether the edge opposite to corner k is a border that is listed with this triangle.
static inline int is_border(int t, int k, global const int* neighbors, global const uchar* constrained,
                            global const int* regions) {
  const int u = neighbors[k];
  // Without branches, since they could not be predicted.
  return (constrained[k] != 0) & ((u < 0) | ((t < u) & (regions[t] != regions[max(u, 0)])));
}

// levels: UNREACHED throughout; 0 for regions that are connected with the outside.
kernel void count_borders(int n, global const int* restrict neighbors, global const uchar* restrict constrained,
                          global const int* restrict regions, global uint* restrict counts,
                          global int* restrict levels) {
  const int t = get_global_id(0);
  if (t < n) {
    uint count = 0;
    int is_open = 0;
    for (int k = 3 * t; k < 3 * t + 3; ++k) {
      count += is_border(t, k, neighbors, constrained, regions);
      is_open |= (neighbors[k] < 0) & !constrained[k];
    }
    if (is_open) levels[regions[t]] = 0;
    counts[t] = count;
  }
}

// Each border has two regions; the first is -1 if it is the outside. steps: the sum of segments crossed from
// the first to the second one, if the rule is not nesting.
kernel void write_borders(int n, int rule, int mask, TRIANGULATION(), global const uchar* restrict constrained,
                          global const int* restrict regions, global const uint* restrict places,
                          global const double_bits* restrict input, global const uint* restrict needed,
                          global const uint* restrict sums, global const int* restrict edges,
                          global const int* restrict slots, global int* restrict borders, global int* restrict steps) {
  const int t = get_global_id(0);
  if (t < n) {
    uint place = places[t];
    for (int k = 0; k < 3 && place < places[t + 1]; ++k) {
      if (!is_border(t, 3 * t + k, neighbors, constrained, regions)) continue;
      const int u = neighbors[3 * t + k];
      borders[2 * place] = u < 0 ? -1 : regions[u];
      borders[2 * place + 1] = regions[t];
      if (rule != FILL_NESTING) {
        const int v = triangles[3 * t + (k + 1) % 3], w = triangles[3 * t + (k + 2) % 3];
        steps[place] = crossed(v, w, mask, input, needed, sums, edges, slots);
      }
      ++place;
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Depths

// Goes on from regions of a level. reached: 0 throughout; reached[level] gets 1 if there are regions of the next one.
kernel void reach_regions(int n, int rule, int level, global const int* restrict borders,
                          global const int* restrict steps, global volatile int* restrict levels,
                          global int* restrict potentials, global int* restrict reached) {
  const int i = get_global_id(0);
  if (i < n) {
    const int a = borders[2 * i], b = borders[2 * i + 1];
    const int at_a = a < 0 ? 0 : read_shared(&levels[a]), at_b = read_shared(&levels[b]);
    const int is_forward = at_a == level && at_b == UNREACHED, is_backward = at_b == level && at_a == UNREACHED;
    if (is_forward || is_backward) {
      const int from = is_forward ? a : b, to = is_forward ? b : a;
      // All that reach it find the same potential.
      if (atomic_cmpxchg(&levels[to], UNREACHED, level + 1) == UNREACHED && rule != FILL_NESTING) {
        const int before = from < 0 ? 0 : potentials[from];
        potentials[to] = is_forward ? before + steps[i] : before - steps[i];
      }
      reached[level] = 1;
    }
  }
}

// depths: of regions; may be levels. left: 1 if the region is left.
kernel void finish_regions(int n, int rule, int outside, global const int* levels, global const int* potentials,
                           global int* depths, global uchar* restrict left) {
  const int r = get_global_id(0);
  if (r < n) {
    const int depth = depth_of(levels[r], potentials[r], rule);
    depths[r] = depth;
    left[r] = (uchar)is_left(depth, rule, outside);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Holes

kernel void drop_holes(int n, global const int* restrict found, global const int* restrict regions,
                       global uchar* restrict left) {
  const int h = get_global_id(0);
  if (h < n) left[regions[found[h]]] = 0;
}

// ---------------------------------------------------------------------------------------------------------------------
// Result

kernel void count_left(int n, global const int* restrict regions, global const uchar* restrict left,
                       global uint* restrict counts) {
  const int t = get_global_id(0);
  if (t < n) counts[t] = left[regions[t]];
}

kernel void count_regions(int n, global const uchar* restrict left, global uint* restrict counts) {
  const int r = get_global_id(0);
  if (r < n) counts[r] = left[r];
}

// n: sets + 1.
kernel void find_offsets(int n, global const int* restrict triangle_offsets, global const uint* restrict places,
                         global uint* restrict offsets) {
  const int s = get_global_id(0);
  if (s < n) offsets[s] = places[triangle_offsets[s]];
}

// places: of triangles; numbers: of regions; both are scans of the kept ones.
kernel void write_left(int n, TRIANGULATION(), global const uchar* restrict constrained,
                       global const int* restrict regions, global const uint* restrict places,
                       global const uint* restrict numbers, global int* restrict left_triangles,
                       global int* restrict left_neighbors, global uchar* restrict left_constrained,
                       global int* restrict left_regions) {
  const int t = get_global_id(0);
  if (t < n && places[t] != places[t + 1]) {
    const uint to = places[t];
    for (int k = 0; k < 3; ++k) {
      const int u = neighbors[3 * t + k];
      left_triangles[3 * to + k] = triangles[3 * t + k];
      left_neighbors[3 * to + k] = u < 0 || places[u] == places[u + 1] ? -1 : (int)places[u];
      left_constrained[3 * to + k] = constrained[3 * t + k];
    }
    left_regions[to] = (int)numbers[regions[t]];
  }
}

// labels: of regions.
kernel void number_labels(int n, global const uint* restrict numbers, global const int* restrict labels,
                          global int* restrict left_labels) {
  const int r = get_global_id(0);
  if (r < n && numbers[r] != numbers[r + 1]) left_labels[numbers[r]] = labels[r];
}

// labels: of regions.
kernel void write_labels(int n, global const int* restrict regions, global const int* restrict labels,
                         global int* restrict triangle_labels) {
  const int t = get_global_id(0);
  if (t < n) triangle_labels[t] = labels[regions[t]];
}
