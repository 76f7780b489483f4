// Lists of arguments that kernels of points have in common; PREFIX is put before their names. In launchers each list is
// a struct.
#ifndef FLAUNAY_POINTS_ARGUMENTS_H
#define FLAUNAY_POINTS_ARGUMENTS_H

// clang-format off

// The samples of all trees, and their chunks or tiles.
#define SAMPLED_CHUNKS(PREFIX) \
  int PREFIX##tree_count, global const int* restrict PREFIX##first_chunks, \
  global const sampled_tree* restrict PREFIX##trees, int PREFIX##all_samples, \
  global const coordinate2* restrict PREFIX##samples

#endif
