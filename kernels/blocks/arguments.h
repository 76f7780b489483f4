// Lists of arguments that kernels of blocks have in common, or that belong together; PREFIX is put before their
// names. In launchers each list is a struct.
#ifndef FLAUNAY_BLOCKS_ARGUMENTS_H
#define FLAUNAY_BLOCKS_ARGUMENTS_H

// clang-format off

// Where parts of a height are, at depths from least_depth on below end_depth: how many places there are, where blocks
// begin, how many vertices they have, the block of each place, and the axes of cuts.
#define PLACES_OF_PARTS(PREFIX) \
  int PREFIX##height, int PREFIX##least_depth, int PREFIX##end_depth, int PREFIX##places, \
  global const int* restrict PREFIX##offsets, global const int* restrict PREFIX##distinct, \
  global const int* restrict PREFIX##block_of_place, global const uchar* restrict PREFIX##axes

// The triangulations of parts: their vertices, the rings around these, and the ends of parts and of whole blocks. In
// kernels with barriers, work-items read what others have written.
#define RINGS_OF_PARTS(PREFIX) \
  global const coordinate2* restrict PREFIX##points, global ring_edge* PREFIX##edges, \
  global int* PREFIX##vertex_edge, global solved_block* PREFIX##parts, global solved_block* PREFIX##solved

// The points of blocks, which are sorted, and the results: representatives, solved blocks, numbers of points.
#define BLOCK_POINTS(PREFIX) \
  global coordinate2* PREFIX##points, global int* PREFIX##source, global int* PREFIX##representatives, \
  global solved_block* PREFIX##solved, global int* PREFIX##distinct_counts

// Blocks that work-groups halve. are_listed: groups take the blocks that flag_larger_blocks has flagged; larger_blocks:
// the flags' prefix sums. Of blocks with more than `capacity` points, scanned has the number of distinct points before
// each place. Blocks of more than `largest` points get no vertices.
#define BLOCKS_TO_HALVE(PREFIX) \
  int PREFIX##blocks, int PREFIX##are_listed, global const uint* restrict PREFIX##larger_blocks, int PREFIX##capacity, \
  int PREFIX##largest, global const int* restrict PREFIX##offsets, global const uint* restrict PREFIX##scanned

// Room for sorting the points of blocks.
#define BLOCK_SCRATCH(PREFIX) \
  global coordinate2* PREFIX##scratch_points, global int* PREFIX##scratch_source, global uint64* PREFIX##scratch_ranks

// The vertices of a round: whether it is the first one, in which all are open; their numbers among all points;
// their places in the list of open points; and their open edges.
#define OPEN_VERTICES(PREFIX) \
  int PREFIX##is_first, global const int* restrict PREFIX##vertices, global const int* restrict PREFIX##listed, \
  global const int* restrict PREFIX##open_offsets, global const open_edge* restrict PREFIX##open_edges

// The parts of blocks that a round certifies: how many there are, where each begins, and where it lies.
#define FRAMES(PREFIX) \
  int PREFIX##frame_count, global const int* restrict PREFIX##frame_offsets, \
  global const block_frame* restrict PREFIX##frames

// Sets whose blocks were cut from each other by trees.
#define CUT_SETS(PREFIX) \
  int PREFIX##sets, global const int* restrict PREFIX##set_blocks, global const int* restrict PREFIX##set_nodes, \
  global const cut_node* restrict PREFIX##nodes

#endif
