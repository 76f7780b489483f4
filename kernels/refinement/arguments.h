// Lists of arguments that kernels of refinement have in common; PREFIX is put before their names. In launchers each
// list is a struct.
#ifndef FLAUNAY_REFINEMENT_ARGUMENTS_H
#define FLAUNAY_REFINEMENT_ARGUMENTS_H

// clang-format off

// The mesh; the ends of its edges, the lexicographically smaller one first, and for each end the next edge
// counter-clockwise around it, or -1 if there are no triangles between; and the areas that are asked for.
#define REFINED_MESH(PREFIX) \
  global const mesh_row* restrict PREFIX##rows, global const double2* restrict PREFIX##points, \
  global const edge_place* restrict PREFIX##places, global const int* restrict PREFIX##ends, \
  global const int* restrict PREFIX##wedges, global const double* restrict PREFIX##areas

#endif
