// Points to blocks: each set that is larger than a block is cut by a tree, whose leaves are its blocks; cut_tree.cl,
// part of the same program, makes the trees.
//
// All is done in chunks of points, a work-item each. A chunk lies in one set with a tree, or in sets that are one
// block each. Of the former, count_blocks finds each point's block and counts, in a row of `cursors` a chunk; the
// counts, block by block and chunk by chunk, are scanned. move_points scales all points and brings them and their
// indices to their blocks, in the order of the input. block_offsets tells where blocks begin. Two passes over the
// points, one where there is no tree.

#include "cut_tree.cl"
#include "shared/coordinates.h"
#include "shared/cut_tree.h"

// A chunk: points [first, last), and of a set with a tree: its depth, where its nodes begin, where the chunk's row of
// cursors begins, the set's first count, the chunk's number in the set, and the set's number of chunks.
typedef struct {
  int first, last, depth, nodes, row, counts, number, chunks;
} chunk_of_points;

kernel void count_blocks(int n, global const chunk_of_points* restrict chunks, global const double* restrict input,
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
                        global const double* restrict input, double s0, double s1, double s2,
                        global const int* restrict block_of_point, global const uint* restrict scanned,
                        global int* restrict cursors, global double2* restrict points, global int* restrict source,
                        global int* restrict representatives) {
  const int c = get_global_id(0);
  if (c < n) {
    const chunk_of_points chunk = chunks[c];
    for (int i = chunk.first; i < chunk.last; ++i) representatives[i] = i;
    if (chunk.depth == 0) {
      for (int i = chunk.first; i < chunk.last; ++i) {
        points[i] = scaled_point(i, input, s0, s1, s2);
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
        points[to] = scaled_point(i, input, s0, s1, s2);
        source[to] = i;
      }
    }
  }
}

// offsets of blocks: of block k of its set, in whose counts it begins at first_count (-1: the set is one block).
kernel void block_offsets(int n, global const int2* restrict set_and_count, global const int* restrict set_count,
                          global const uint* restrict scanned, global int* restrict offsets) {
  const int b = get_global_id(0);
  if (b < n) {
    const int2 place = set_and_count[b];
    offsets[b] = place.x + (place.y < 0 ? 0 : (int)(scanned[place.y] - scanned[set_count[b]]));
  }
}
