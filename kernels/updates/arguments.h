// Lists of arguments that kernels of updates have in common; PREFIX is put before their names. In launchers each list
// is a struct.
#ifndef FLAUNAY_UPDATES_ARGUMENTS_H
#define FLAUNAY_UPDATES_ARGUMENTS_H

// clang-format off

// The current mesh.
#define LIVING_MESH(PREFIX) \
  global const mesh_row* restrict PREFIX##rows, global const double2* restrict PREFIX##points

// Where walks begin. A sample of the mesh's points is in cells: `slabs` along x, with as many cells along y in
// each, which begin at these coordinates; each cell has a vertex. rows_of: per vertex a row that it had; freed
// rows lead to others.
#define HINTS(PREFIX) \
  int PREFIX##slabs, global const double* restrict PREFIX##xs, global const double* restrict PREFIX##ys, \
  global const int* restrict PREFIX##vertices, global const int* restrict PREFIX##rows_of

#endif
