// The pixels of a raster, as the host describes them to kernels.
#ifndef FLAUNAY_RASTER_RECORDS_H
#define FLAUNAY_RASTER_RECORDS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// The centre of the pixel in row r and column c is (x + c dx, y + r dy), in floating point: the product is rounded,
// then the sum. columns_by and rows_by: the inverses of dx and dy. Margins: how many pixels a computed row or column
// may be beside the right one. Pixels have values in triangles without an edge whose square is longer.
typedef struct {
  double x, y, dx, dy, columns_by, rows_by, column_margin, row_margin, longest;
  int rows, columns;
} pixel_grid;
ASSERT_SIZE(pixel_grid, 80);

END_SHARED

#endif
