// Lists of arguments that kernels of rasters have in common; PREFIX is put before their names. In launchers each list
// is a struct.
#ifndef FLAUNAY_RASTER_ARGUMENTS_H
#define FLAUNAY_RASTER_ARGUMENTS_H

// clang-format off

// A mesh with its numbers of points and triangles, and the triangle opposite to each corner.
#define SCANNED_MESH(PREFIX) \
  int PREFIX##points, int PREFIX##count, global const double* restrict PREFIX##coordinates, \
  global const int* restrict PREFIX##triangles, global const int* restrict PREFIX##neighbors

#endif
