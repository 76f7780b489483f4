// Regular triangulations of blocks on devices with many lanes, between blocks/halve.cl and the merges of blocks in
// blocks/weighted.cl: the leaves and the merges of halves, as in blocks/merge.cl. Nothing stops; exact power tests are
// in the same launch.
//
// blocks/halve.cl has kept one of several points in one place and made it the others' representative; the heaviest is
// to be kept, of several the first. Three passes over the points find it by atomic operations on halves of the weights'
// bits and on numbers, whose results depend on no order; name_by_weight makes it the representative, and
// weigh_vertices, per vertex, the vertex. merge_weighted_halves has a launch per height, with one work-item per cell of
// blocks/halves.h.

#include "arithmetic/coordinates.h"
#include "blocks/arguments.h"
#include "blocks/halves.h"
#include "blocks/rings_account.h"
#include "mesh/power_rings.h"
#include "mesh/records.h"
#include "operations/spread.h"
#include "predicates/records.h"

#ifndef FIXED_POINT

static inline uint upper_half(double weight) { return (uint)(orderable(weight) >> 32); }
static inline uint lower_half(double weight) { return (uint)orderable(weight); }

// upper, lower, heaviest: by the point that was kept. The first two are 0 at first, the last one is the largest int.
kernel void find_upper_halves(int n, global const int* restrict representatives, global const double* restrict weights,
                              global volatile uint* restrict upper) {
  const int i = get_global_id(0);
  if (i < n) atomic_max(&upper[representatives[i]], upper_half(weights[i]));
}

kernel void find_lower_halves(int n, global const int* restrict representatives, global const double* restrict weights,
                              global const uint* restrict upper, global volatile uint* restrict lower) {
  const int i = get_global_id(0);
  if (i < n && upper_half(weights[i]) == upper[representatives[i]]) {
    atomic_max(&lower[representatives[i]], lower_half(weights[i]));
  }
}

kernel void find_heaviest(int n, global const int* restrict representatives, global const double* restrict weights,
                          global const uint* restrict upper, global const uint* restrict lower,
                          global volatile int* restrict heaviest) {
  const int i = get_global_id(0);
  if (i < n && upper_half(weights[i]) == upper[representatives[i]] &&
      lower_half(weights[i]) == lower[representatives[i]]) {
    atomic_min(&heaviest[representatives[i]], i);
  }
}

// As solve_weighted_blocks: a lighter point gets the complement of the heaviest one.
kernel void name_by_weight(int n, global const double* restrict weights, global const int* restrict heaviest,
                           global int* restrict representatives) {
  const int i = get_global_id(0);
  if (i < n) {
    const int kept = heaviest[representatives[i]];
    representatives[i] = weights[i] == weights[kept] ? kept : ~kept;
  }
}

// n places, of which those behind the vertices of their block have other points.
kernel void weigh_vertices(int n, global const int* restrict block_of_place, global const int* restrict offsets,
                           global const int* restrict distinct, global const double* restrict weights,
                           global const int* restrict heaviest, global int* restrict source,
                           global double* restrict vertex_weights) {
  const int v = get_global_id(0);
  const int block = v < n ? block_of_place[v] : -1;
  if (block >= 0 && v < offsets[block] + distinct[block]) {
    source[v] = heaviest[source[v]];
    vertex_weights[v] = weights[source[v]];
  }
}

static inline void make_power_leaves_of_cell(power_rings* g, const halved_blocks* blocks, int cell) {
  const int end = min(blocks->places, 2 * cell + 2);
  for (int place = 2 * cell; place < end; ++place) {
    const block_part part = begin_leaf(&g->all, blocks, place);
    if (part.block < 0) continue;
    finish_leaf(&g->all, blocks, part, make_power_leaf(g, place, vertices_of_part(part)));
  }
}

static inline void merge_power_halves_of_cell(power_rings* g, const halved_blocks* blocks, int height, int cell) {
  const part_halves halves = halves_of_cell(blocks, height, cell);
  if (halves.part.block < 0) return;
  const solved_block low = blocks->parts[halves.low_at], high = blocks->parts[halves.high_at];
  join_free_lists(&g->all, low.unused, high.unused);
  finish_part(&g->all, blocks, halves.part,
              merge_power_triangulations(g, low.ends, high.ends, halves.axis, halves.middle));
}

kernel void merge_weighted_halves(int n, int spread, PLACES_OF_PARTS(), filter_bounds bounds,
                                  global const double* restrict vertex_weights, double weight_range, global int* links,
                                  global const coordinate2* points, global ring_edge* edges, global int* vertex_edge,
                                  global solved_block* parts, global solved_block* solved,
                                  global volatile uint* account COUNTERS) {
  const int cell = spread_item(n, spread);
  if (cell < n) {
    const halved_blocks blocks =
        blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, parts, solved);
    power_rings g = power_rings_on(edges, points, vertex_edge, bounds, vertex_weights, links, weight_range);
    if (height == 0) {
      make_power_leaves_of_cell(&g, &blocks, cell);
    } else {
      merge_power_halves_of_cell(&g, &blocks, height, cell);
    }
    add_to_account(&g.all, account);
    COUNT_STEPS(g.all.counted.steps);
  }
}

#endif
