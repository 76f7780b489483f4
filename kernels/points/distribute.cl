// Points to blocks: each set that is larger than a block is cut by a tree, whose leaves are its blocks. cut_tree.cl
// makes the trees. Both it and inspect.cl are parts of this program, since each program costs its start-up time.
//
// Kernels work on chunks of points, with one work-item per chunk. A chunk lies in one set with a tree, or in sets that
// are one block each. For chunks with a tree, count_blocks finds the block of each point and counts points per block,
// in one row of `cursors` per chunk. The counts, in the order of blocks and then of chunks, are scanned. move_points
// scales all points and brings them and their indices to their blocks, in the order of the input. block_offsets writes
// where blocks begin. That makes two passes over the points, or one where there is no tree. distribute_tiles.cl does
// the same for devices with many lanes.

#include "arithmetic/coordinates.h"
#include "arithmetic/records.h"
#include "operations/prefetch.h"
#include "points/cut_tree.cl"
#include "points/cut_tree.h"
#include "points/inspect.cl"
#include "points/records.h"

kernel void count_blocks(int n, global const chunk_of_points* restrict chunks, global const coordinate* restrict input,
                         global const cut_node* restrict nodes, global int* restrict block_of_point,
                         global int* restrict cursors, global uint* restrict counts) {
  const int c = get_global_id(0);
  if (c < n && chunks[c].depth > 0) {
    const chunk_of_points chunk = chunks[c];
    global const cut_node* const tree = nodes + chunk.nodes;
    global int* const cursor = cursors + chunk.row;
    const int blocks = 1 << chunk.depth;
    for (int b = 0; b < blocks; ++b) cursor[b] = 0;
    for (int i = chunk.first; i < chunk.last; i += DESCENTS) {
      fetch_bytes(&input[2 * min(chunk.last, i + STREAM_AHEAD)], DESCENTS * sizeof(coordinate2));
      int block[DESCENTS];
      find_leaves(i, chunk.last, input, tree, chunk.depth, block);
      for (int k = 0; k < min(DESCENTS, chunk.last - i); ++k) {
        block_of_point[i + k] = block[k];
        ++cursor[block[k]];
      }
    }
    for (int b = 0; b < blocks; ++b) counts[chunk.counts + b * chunk.chunks + chunk.number] = cursor[b];
  }
}

kernel void move_points(int n, global const chunk_of_points* restrict chunks, global const int* restrict set_first,
                        global const coordinate* restrict input, scaling scale,
                        global const int* restrict block_of_point, global const uint* restrict scanned,
                        global int* restrict cursors, global coordinate2* restrict points, global int* restrict source,
                        global int* restrict representatives) {
  const int c = get_global_id(0);
  if (c < n) {
    const chunk_of_points chunk = chunks[c];
    for (int i = chunk.first; i < chunk.last; ++i) representatives[i] = i;
    if (chunk.depth == 0) {
      for (int i = chunk.first; i < chunk.last; ++i) {
        points[i] = scaled_point(i, input, scale);
        source[i] = i;
      }
    } else {
      global int* const cursor = cursors + chunk.row;
      const int begin = set_first[c] - (int)scanned[chunk.counts];
      for (int b = 0; b < 1 << chunk.depth; ++b) {
        cursor[b] = begin + (int)scanned[chunk.counts + b * chunk.chunks + chunk.number];
      }
      for (int i = chunk.first; i < chunk.last; ++i) {
        const int to = cursor[block_of_point[i]]++;
        points[to] = scaled_point(i, input, scale);
        source[to] = i;
      }
    }
  }
}

// Where each block begins. set_count: by block, the first count of its set.
kernel void block_offsets(int n, global const block_place* restrict places, global const int* restrict set_count,
                          global const uint* restrict scanned, global int* restrict offsets) {
  const int b = get_global_id(0);
  if (b < n) {
    const block_place place = places[b];
    offsets[b] = place.first + (place.count < 0 ? 0 : (int)(scanned[place.count] - scanned[set_count[b]]));
  }
}
