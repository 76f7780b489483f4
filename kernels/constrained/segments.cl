// Segments and their edges: sorting and numbering before and after constraints are inserted (insert.cl).
//
// A vertex' *place* is the first corner at which it stands in the array of triangles; so the order of places is one of
// places in the plane. A vertex of a set without triangles has PLACE_ON_LINE and its number on the hull. Before
// insertion:
// - mark_ends, over the segments: checks them, and marks the vertices at their ends. clear_vertices is before that.
// - start_rows, over the triangles: the places of the marked vertices; all rows are unclaimed, and at first unchanged
//   and without constraints. line_places, over the hulls: the places of vertices in sets on a line.
// - segment_keys, over the segments: a key of the places of both ends, by which the host sorts them.
// - find_runs and write_unique, over the sorted segments: leave out equal segments.
// After insertion, for constraint edges that are linked to straight chains:
// - link_pieces, over the segments; start_chains, jump and measure_chains, over the edges: the first edge of each
//   chain, the distance from there, and lengths, by pointer jumping.
// - edge_keys, over the edges, by which the host sorts chains; sorted_lengths, over these; number_edges and
//   write_segments.

#include "arithmetic/language.h"
#include "constrained/codes.h"
#include "constrained/meanwhile.h"
#include "operations/prefetch.h"
#include "operations/search.h"
#include "predicates/planar.h"

#define NO_KEY 0xffffffffffffffffUL

static inline int is_marked(int v, global const uint* marks) { return marks[v >> 5] >> (v & 31) & 1; }

// n points. all: whether all vertices are marked, or none.
kernel void clear_vertices(int n, int all, global uint* restrict marks, global uint* restrict places) {
  const int v = get_global_id(0);
  if (v < n) {
    places[v] = UNCLAIMED;
    if ((v & 31) == 0) marks[v >> 5] = all ? 0xffffffffu : 0u;
  }
}

static inline int are_in_one_set(int a, int b, int sets, global const int* offsets) {
  if (sets == 1) return 1;
  const int s = segment_of(a, sets, offsets);
  return b >= offsets[s] && b < offsets[s + 1];
}

// As a rule two segments end at a vertex.
static inline void mark(int v, global volatile uint* marks) {
  const uint bit = 1u << (v & 31);
  if ((read_shared(&marks[v >> 5]) & bit) == 0) atomic_or(&marks[v >> 5], bit);
}

// n segments. ends: the representatives of their ends; -1 if these are equal, or if the segment is wrong.
kernel void mark_ends(int n, int points, int sets, global const int* restrict offsets,
                      global const int* restrict segments, global const int* restrict representatives,
                      global int* restrict ends, global volatile uint* restrict marks,
                      global volatile uint* restrict status) {
  const int s = get_global_id(0);
  if (s < n) {
    const int a = segments[2 * s], b = segments[2 * s + 1];
    int from = -1, to = -1;
    if (a < 0 || b < 0 || a >= points || b >= points || !are_in_one_set(a, b, sets, offsets)) {
      atomic_or(&status[INSERTION_WRONG], 1u);
    } else {
      from = representatives[a];
      to = representatives[b];
      if (from == to) {
        from = to = -1;
      } else {
        mark(from, marks);
        mark(to, marks);
      }
    }
    ends[2 * s] = from;
    ends[2 * s + 1] = to;
  }
}

// Rows whose marked corners are collected before they are used: until then their vertices' places are fetched.
#define ROWS_AT_ONCE 64

// n triangles.
kernel void start_rows(int n, int chunk, int is_first, global const int* restrict triangles,
                       global const uint* restrict marks, global volatile uint* restrict places,
                       global uint* restrict claims, global uchar* restrict flags, global uchar* restrict changed) {
  const int c = get_global_id(0);
  int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    int marked[3 * ROWS_AT_ONCE];
    while (low < high) {
      const int end = min(high, low + ROWS_AT_ONCE);
      int count = 0;
      for (int corner = 3 * low; corner < 3 * end; ++corner) {
        // Without a branch, since it could not be predicted.
        marked[count] = corner;
        count += is_marked(triangles[corner], marks);
      }
      for (int i = 0; i < count; ++i) fetch((global const void*)&places[triangles[marked[i]]]);
      for (; low < end; ++low) {
        claims[low] = UNCLAIMED;
        if (is_first) flags[low] = changed[low] = 0;
      }
      for (int i = 0; i < count; ++i) atomic_min(&places[triangles[marked[i]]], (uint)marked[i]);
    }
  }
}

// n hull vertices.
kernel void line_places(int n, int sets, global const int* restrict triangle_offsets,
                        global const int* restrict hull_offsets, global const int* restrict hull,
                        global uint* restrict places) {
  const int k = get_global_id(0);
  if (k < n) {
    const int s = segment_of(k, sets, hull_offsets);
    if (triangle_offsets[s] == triangle_offsets[s + 1]) places[hull[k]] = PLACE_ON_LINE | (uint)k;
  }
}

// n pairs of ends. payloads: their numbers.
kernel void segment_keys(int n, global const int* restrict ends, global const uint* restrict places,
                         global uint64* restrict keys, global int* restrict payloads) {
  const int s = get_global_id(0);
  if (s < n) {
    uint64 key = NO_KEY;
    if (ends[2 * s] >= 0) {
      const uint64 a = places[ends[2 * s]], b = places[ends[2 * s + 1]];
      key = min(a, b) << 32 | max(a, b);
    }
    keys[s] = key;
    payloads[s] = s;
  }
}

// n sorted keys. counts: 1 at the first of each.
kernel void find_runs(int n, global const uint64* restrict keys, global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) counts[i] = keys[i] != NO_KEY && (i == 0 || keys[i - 1] != keys[i]);
}

// ranks: the scanned counts. unique_of: per element its place among the unique keys, or -1.
kernel void write_unique(int n, global const uint64* restrict keys, global const int* restrict payloads,
                         global const uint* restrict ranks, global int* restrict unique_of,
                         global uint64* restrict unique) {
  const int i = get_global_id(0);
  if (i < n) {
    const uint rank = ranks[i + 1];
    unique_of[payloads[i]] = keys[i] == NO_KEY ? -1 : (int)rank - 1;
    if (ranks[i] != rank) unique[rank - 1] = keys[i];
  }
}

// n segments, each with the pieces [offsets[s], offsets[s + 1]), which are numbered by piece_of. next and previous are
// -1 where no edge is linked. All segments along two edges that follow each other link them.
kernel void link_pieces(int n, global const uint* restrict offsets, global const int* restrict piece_of,
                        global volatile int* restrict next, global volatile int* restrict previous) {
  const int s = get_global_id(0);
  if (s < n) {
    for (uint i = offsets[s]; i + 1 < offsets[s + 1]; ++i) {
      atomic_max(&next[piece_of[i]], piece_of[i + 1]);
      atomic_max(&previous[piece_of[i + 1]], piece_of[i]);
    }
  }
}

// n edges. hops: an edge on the way to the first one of the chain, and how many edges that is away.
kernel void start_chains(int n, global const int* restrict previous, global int* restrict heads,
                         global int* restrict distances) {
  const int e = get_global_id(0);
  if (e < n) {
    heads[e] = previous[e] < 0 ? e : previous[e];
    distances[e] = previous[e] >= 0;
  }
}

kernel void jump(int n, global const int* restrict heads, global const int* restrict distances,
                 global int* restrict next_heads, global int* restrict next_distances) {
  const int e = get_global_id(0);
  if (e < n) {
    const int head = heads[e];
    next_heads[e] = heads[head];
    next_distances[e] = distances[e] + distances[head];
  }
}

kernel void measure_chains(int n, global const int* restrict next, global const int* restrict heads,
                           global const int* restrict distances, global uint* restrict lengths) {
  const int e = get_global_id(0);
  if (e < n && next[e] < 0) lengths[heads[e]] = distances[e] + 1;
}

// n edges. with_chains: only the first ones of chains have keys.
kernel void edge_keys(int n, int with_chains, global const int* restrict ends, global const int* restrict heads,
                      global uint64* restrict keys, global int* restrict payloads) {
  const int e = get_global_id(0);
  if (e < n) {
    keys[e] = with_chains && heads[e] != e ? NO_KEY : (uint64)ends[2 * e] << 32 | (uint64)ends[2 * e + 1];
    payloads[e] = e;
  }
}

// n sorted keys of edges.
kernel void sorted_lengths(int n, global const uint64* restrict keys, global const int* restrict payloads,
                           global const uint* restrict lengths, global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) counts[i] = keys[i] == NO_KEY ? 0 : lengths[payloads[i]];
}

kernel void start_numbers(int n, global const uint64* restrict keys, global const int* restrict payloads,
                          global const uint* restrict counts, global uint* restrict starts) {
  const int i = get_global_id(0);
  if (i < n && keys[i] != NO_KEY) starts[payloads[i]] = counts[i];
}

// n edges. starts: by the first edge of a chain, its number.
kernel void number_chained(int n, global const int* restrict heads, global const int* restrict distances,
                           global const uint* restrict starts, global const int* restrict ends,
                           global int* restrict numbers, global int* restrict edges) {
  const int e = get_global_id(0);
  if (e < n) {
    const int number = (int)starts[heads[e]] + distances[e];
    numbers[e] = number;
    edges[2 * number] = ends[2 * e];
    edges[2 * number + 1] = ends[2 * e + 1];
  }
}

// n sorted keys of edges without chains.
kernel void number_edges(int n, global const uint64* restrict keys, global const int* restrict payloads,
                         global int* restrict numbers, global int* restrict edges) {
  const int i = get_global_id(0);
  if (i < n) {
    numbers[payloads[i]] = i;
    edges[2 * i] = (int)(keys[i] >> 32);
    edges[2 * i + 1] = (int)(uint)keys[i];
  }
}

// n segments of the input. with_pieces: whether the segments' edges are pieces [offsets[u], offsets[u + 1]) of them;
// otherwise each is the edge of the same number.
kernel void write_segments(int n, int with_pieces, global const int* restrict unique_of,
                           global const uint* restrict offsets, global const int* restrict piece_of,
                           global const int* restrict numbers, global int* restrict segment_edges) {
  const int s = get_global_id(0);
  if (s < n) {
    const int u = unique_of[s];
    int first = 0, end = 0;
    if (u >= 0) {
      first = numbers[with_pieces ? piece_of[offsets[u]] : u];
      end = first + (with_pieces ? (int)(offsets[u + 1] - offsets[u]) : 1);
    }
    segment_edges[2 * s] = first;
    segment_edges[2 * s + 1] = end;
  }
}
