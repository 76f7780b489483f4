// Twins: for each half-edge the same edge in the triangle beyond it, or -1.
//
// Two passes over a hash table of undirected edges, with one work-item per half-edge. insert_edges puts the half-edges
// that ascend (from a smaller to a larger vertex) into free slots; match_edges looks there for the twins of the others.
// Which slot an edge gets depends on scheduling; the result does not, since each edge is in the table once.

//
// loose_edges flags half-edges that have no twin yet; insert_loose and match_loose do the same for a list of them.

#include "mesh/halfedges.h"
#include "operations/prefetch.h"

static inline uint edge_hash(int low, int high) {
  uint64 z = ((uint64)(uint)low << 32 | (uint)high) * 0x9e3779b97f4a7c15UL;
  z = (z ^ (z >> 32)) * 0xd6e8feb86659fd93UL;
  return (uint)(z >> 32);
}

// The first slots tried belong to the smaller vertex, which has three edges on average: neighbours in the plane
// are neighbours in the table. A vertex with many edges overflows into slots all over it, by double hashing.
#define SLOTS_PER_VERTEX 4
#define SLOTS_NEAR 8

static inline uint edge_slot(int low, int high, uint attempt) {
  if (attempt < SLOTS_NEAR) return SLOTS_PER_VERTEX * (uint)low + attempt;
  const uint hash = edge_hash(low, high);
  return hash + (attempt - SLOTS_NEAR) * (hash >> 7 | 1);
}

static inline void insert_edge(int h, uint mask, global const int* restrict triangles,
                               global volatile int* restrict table) {
  const int from = halfedge_from(triangles, h);
  const int to = halfedge_to(triangles, h);
  int searching = from < to;
  for (uint attempt = 0; searching; ++attempt) {
    searching = atomic_cmpxchg(&table[edge_slot(from, to, attempt) & mask], -1, h) != -1;
  }
}

static inline void match_edge(int h, uint mask, global const int* restrict triangles, global const int* restrict table,
                              global int* restrict twins) {
  const int from = halfedge_from(triangles, h);
  const int to = halfedge_to(triangles, h);
  int searching = from > to;
  for (uint attempt = 0; searching; ++attempt) {
    const int other = table[edge_slot(to, from, attempt) & mask];
    if (other < 0) {
      searching = 0;
    } else if (halfedge_from(triangles, other) == to && halfedge_to(triangles, other) == from) {
      twins[h] = other;
      twins[other] = h;
      searching = 0;
    }
  }
}

// How many half-edges ahead of its use a slot is fetched.
#define SLOTS_AHEAD 32

static inline void fetch_slot(int h, int n, uint mask, global const int* restrict triangles,
                              global const volatile int* table) {
  const int ahead = h + SLOTS_AHEAD;
  if (ahead < n) {
    const int low = min(halfedge_from(triangles, ahead), halfedge_to(triangles, ahead));
    fetch((global const int*)table + (edge_slot(low, low, 0) & mask));
  }
}

// table: mask + 1 slots (a power of two, more than there are edges), -1 throughout.
kernel void insert_edges(int n, uint mask, global const int* restrict triangles, global volatile int* restrict table) {
  const int h = get_global_id(0);
  if (h < n) {
    fetch_slot(h, n, mask, triangles, table);
    insert_edge(h, mask, triangles, table);
  }
}

// twins: -1 throughout.
kernel void match_edges(int n, uint mask, global const int* restrict triangles, global const int* restrict table,
                        global int* restrict twins) {
  const int h = get_global_id(0);
  if (h < n) {
    fetch_slot(h, n, mask, triangles, table);
    match_edge(h, mask, triangles, table, twins);
  }
}

kernel void loose_edges(int n, global const int* restrict twins, global uchar* restrict flags) {
  const int h = get_global_id(0);
  if (h < n) flags[h] = twins[h] < 0;
}

kernel void insert_loose(int n, uint mask, global const int* restrict list, global const int* restrict triangles,
                         global volatile int* restrict table) {
  const int k = get_global_id(0);
  if (k < n) insert_edge(list[k], mask, triangles, table);
}

kernel void match_loose(int n, uint mask, global const int* restrict list, global const int* restrict triangles,
                        global const int* restrict table, global int* restrict twins) {
  const int k = get_global_id(0);
  if (k < n) match_edge(list[k], mask, triangles, table, twins);
}
