// Lists of arguments that kernels of voronoi have in common, or that belong together; PREFIX is put before their
// names. In launchers each list is a struct.
#ifndef FLAUNAY_VORONOI_ARGUMENTS_H
#define FLAUNAY_VORONOI_ARGUMENTS_H

// clang-format off

// A diagram that is clipped by a polygon: sizes, the corners of the polygon, and the triangulation.
#define CLIPPED_DIAGRAM(PREFIX) \
  int PREFIX##points, int PREFIX##triangle_count, int PREFIX##hull_count, int PREFIX##clip, \
  global const double* restrict PREFIX##corners, global const double* restrict PREFIX##input, \
  global const int* restrict PREFIX##triangles, global const int* restrict PREFIX##ahead, \
  global const int* restrict PREFIX##hull

// The Voronoi edges around all points, and their parts inside of the polygon.
#define SLOTS(PREFIX) \
  global const uint* restrict PREFIX##offsets, global const int* restrict PREFIX##slots, \
  global const uint* restrict PREFIX##codes

#endif
