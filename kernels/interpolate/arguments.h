// Lists of arguments that kernels of interpolate have in common, or that belong together; PREFIX is put before their
// names. In launchers each list is a struct.
#ifndef FLAUNAY_INTERPOLATE_ARGUMENTS_H
#define FLAUNAY_INTERPOLATE_ARGUMENTS_H

// clang-format off

// The faces of a triangulation, by numbers of vertices, and the points that these are.
#define FACES(PREFIX) \
  global const double2* restrict PREFIX##points, global const int* restrict PREFIX##source, \
  global const face* restrict PREFIX##faces

// The edges of a triangulation, by vertex.
#define EDGES(PREFIX) \
  int PREFIX##room, global const int* restrict PREFIX##vertices, global const uint* restrict PREFIX##firsts, \
  global const int* restrict PREFIX##neighbors, global const double* restrict PREFIX##weights, \
  global const double* restrict PREFIX##inverses

#endif
