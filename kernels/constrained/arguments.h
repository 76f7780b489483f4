// Lists of arguments that kernels of constrained have in common, or that belong together; PREFIX is put before their
// names. In launchers each list is a struct.
#ifndef FLAUNAY_CONSTRAINED_ARGUMENTS_H
#define FLAUNAY_CONSTRAINED_ARGUMENTS_H

// clang-format off

// Triangles and their neighbours.
#define TRIANGULATION(PREFIX) \
  global const int* restrict PREFIX##triangles, global const int* restrict PREFIX##neighbors

// The arrays that change where cavities are triangulated again.
#define REBUILT_ROWS(PREFIX) \
  global int* restrict PREFIX##triangles, global int* restrict PREFIX##neighbors, \
  global uint* restrict PREFIX##claims, global uchar* restrict PREFIX##flags, global uchar* restrict PREFIX##changed, \
  global int* restrict PREFIX##new_corners, global chain_entry* restrict PREFIX##entries

// The chains that rounds triangulate, all behind each other.
#define WORKED_CHAINS(PREFIX) \
  global const int* restrict PREFIX##offsets, global const int* restrict PREFIX##of, \
  global const coordinate2* restrict PREFIX##places, global chain_vertex* restrict PREFIX##vertices, \
  global chain_edge* restrict PREFIX##edges

#endif
