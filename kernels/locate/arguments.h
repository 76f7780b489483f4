// Lists of arguments that kernels of locate have in common, or that belong together; PREFIX is put before their
// names. In launchers each list is a struct.
#ifndef FLAUNAY_LOCATE_ARGUMENTS_H
#define FLAUNAY_LOCATE_ARGUMENTS_H

// clang-format off

// Queries in the order of their places: the sets, where the queries of each begin, how they are scaled, the query at
// a place, and the scaled queries.
#define PLACED_QUERIES(PREFIX) \
  int PREFIX##sets, global const int* restrict PREFIX##query_offsets, \
  global const query_frame* restrict PREFIX##frames, global const int* restrict PREFIX##order, \
  global const coordinate2* restrict PREFIX##placed

// A triangulation in which nearest vertices are searched, with the arrays that levels need.
#define SEARCHED_MESH(PREFIX) \
  global const mesh_set* restrict PREFIX##records, global const coordinate2* restrict PREFIX##points, \
  global const int* restrict PREFIX##source, global const int* restrict PREFIX##clearances, \
  global const face* restrict PREFIX##faces, global const coordinate2* restrict PREFIX##hull_points, \
  global const int* restrict PREFIX##hull, global const int* restrict PREFIX##starts, \
  global const fan_part* restrict PREFIX##fans

// The levels of a locator, which are samples (locate/nearest_search.h): their number, and the number of sets
// that have them; where the vertices of sets begin; boxes around vertices; the number of each set among the
// sets with levels; and the vertex below each vertex of a sample.
#define LEVELS(PREFIX) \
  int PREFIX##levels, int PREFIX##sets_with_levels, global const int* restrict PREFIX##first_vertices, \
  global const vertex_box* restrict PREFIX##boxes, global const int* restrict PREFIX##long_sets, \
  global const int* restrict PREFIX##below

// A triangulation in which queries walk.
#define WALKED_MESH(PREFIX) \
  global const coordinate2* restrict PREFIX##points, global const face* restrict PREFIX##faces, \
  global const int* restrict PREFIX##first_triangle

// The records of sets, and their cut trees.
#define QUERY_TREES(PREFIX) \
  global const mesh_set* restrict PREFIX##records, global const cut_node* restrict PREFIX##nodes, \
  global const int* restrict PREFIX##starts

#endif
