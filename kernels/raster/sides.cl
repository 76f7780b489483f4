// The pixels on single sides of triangles. Which triangle they belong to is not known where a triangle beyond a side
// may be in another chunk of the mesh. Counted first, then listed.

#include "mesh/barycentric.h"
#include "raster/arguments.h"
#include "raster/pixels.h"
#include "raster/records.h"

// The pixels on a side, without its ends, if they would belong to a triangle beyond it. side: 3 t + k, opposite to
// corner k of triangle t. values: null to count alone. Returns how many pixels there are.
static inline int pixels_on_side(int side, pixel_grid grid, GLOBAL const double* coordinates,
                                 GLOBAL const int* triangles, GLOBAL const double* values, GLOBAL uint64* places,
                                 GLOBAL double* found) {
  const int t = side / 3, corner = side - 3 * t;
  double2 q[3], p[3];
  for (int k = 0; k < 3; ++k) q[k] = vload2(triangles[3 * t + k], coordinates);
  if (belongs_to_left(q[next_corner(corner)], q[corner_before(corner)]) || has_longer_edge(q, grid.longest)) return 0;
  double value[3] = {0.0, 0.0, 0.0};
  int opposite = 0, k = lowest_corner(q), count = 0;
  for (int i = 0; i < 3; ++i, k = next_corner(k)) {
    p[i] = q[k];
    if (values) value[i] = values[triangles[3 * t + k]];
    if (k == corner) opposite = i;
  }
  const sloping_triangle slopes = sloping(p, grid);
  const pixel_range rows = rows_of(p, grid);
  for (int row = rows.first; row <= rows.last; ++row) {
    const double y = grid.y + row * grid.dy;
    const pixel_range columns = columns_in_row(&slopes, y, grid);
    for (int column = columns.first; column <= columns.last; ++column) {
      const double2 centre = VECTOR(double2, grid.x + column * grid.dx, y);
      int edge = 0;
      if (place_in_triangle(p, centre, &edge) != 1 || edge != opposite) continue;
      if (values) {
        double weight[3];
        barycentric(p, centre, ORIENT_BOUND, weight);
        places[count] = (uint64)row * grid.columns + column;
        found[count] = weighted(weight, value);
      }
      ++count;
    }
  }
  return count;
}

// counts[i]: the number of pixels on side i.
kernel void count_side_pixels(int n, pixel_grid grid, SCANNED_MESH(), global const int* restrict sides,
                              global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) counts[i] = (uint)pixels_on_side(sides[i], grid, coordinates, triangles, 0, 0, 0);
}

// The pixels of side i begin at offsets[i]. places: row * columns + column.
kernel void list_side_pixels(int n, pixel_grid grid, SCANNED_MESH(), global const double* restrict values,
                             global const int* restrict sides, global const uint* restrict offsets,
                             global uint64* restrict places, global double* restrict found) {
  const int i = get_global_id(0);
  if (i < n) pixels_on_side(sides[i], grid, coordinates, triangles, values, places + offsets[i], found + offsets[i]);
}
