// Lists of arguments that kernels of flattened have in common, or that belong together; PREFIX is put before their
// names. In launchers each list is a struct.
#ifndef FLAUNAY_FLATTENED_ARGUMENTS_H
#define FLAUNAY_FLATTENED_ARGUMENTS_H

// clang-format off

// The points of all regions, in the orders of x and of y.
#define LISTS(PREFIX) \
  global const int* restrict PREFIX##x_list, global const int* restrict PREFIX##y_list

// The lines that cut regions, through points of all.
#define CUTS(PREFIX) \
  global const int* restrict PREFIX##axis, global const double* restrict PREFIX##cut, \
  global const double2* restrict PREFIX##points

// The paths of all regions.
#define PATHS(PREFIX) \
  global const int* restrict PREFIX##path_offsets, global const int* restrict PREFIX##path, \
  global const double2* restrict PREFIX##path_projections

// The vertices of all paths, and their regions.
#define PATH_VERTICES(PREFIX) \
  global const int* restrict PREFIX##path, global const double2* restrict PREFIX##path_projections, \
  global const int* restrict PREFIX##path_region

// The vertices of paths that are made.
#define NEW_PATH_VERTICES(PREFIX) \
  global int* restrict PREFIX##new_path, global double2* restrict PREFIX##new_projections, \
  global int* restrict PREFIX##new_region

// The points of quickhull, and the path vertices whose chords they are below.
#define HULL_POINTS(PREFIX) \
  global const int* restrict PREFIX##ids, global const int* restrict PREFIX##segment, \
  global const double2* restrict PREFIX##projections

// The points that are made for quickhull.
#define NEW_HULL_POINTS(PREFIX) \
  global int* restrict PREFIX##new_ids, global int* restrict PREFIX##new_segment, \
  global double2* restrict PREFIX##new_projections

// The results for elements that may be on a path.
#define CANDIDATES(PREFIX) \
  global int* restrict PREFIX##ids, global int* restrict PREFIX##chord, global double* restrict PREFIX##depth, \
  global uchar* restrict PREFIX##flags

// Corners that are joined to sequences.
#define CORNERS_TO_JOIN(PREFIX) \
  global const int* restrict PREFIX##corner_ids, global const int* restrict PREFIX##corner_owners, \
  global const double2* restrict PREFIX##corner_projections

// The same arrays after sorting.
#define NEW_CORNERS(PREFIX) \
  global int* restrict PREFIX##new_ids, global int* restrict PREFIX##new_owners, \
  global double2* restrict PREFIX##new_projections

// The children of all regions, and the corners of those that go on and of those that retire.
#define CHILDREN(PREFIX) \
  global const int* restrict PREFIX##child_region, global const int* restrict PREFIX##child_base, \
  global int* restrict PREFIX##corners, global int* restrict PREFIX##corner_region, global int* restrict PREFIX##retired

// The corners of large regions, and the vertices that they are.
#define STRIP_CORNERS(PREFIX) \
  global const int* restrict PREFIX##corners, global const int* restrict PREFIX##corner_region, \
  global const int* restrict PREFIX##corner_vertex, global const int* restrict PREFIX##vertices

#endif
