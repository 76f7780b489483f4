// Rasters as the C interface describes them.
#pragma once

#include <limits>

#include "c/handles.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/terrain.hpp"

namespace flaunay::c {

inline double to_longest(double max_edge) {
  return max_edge == 0 ? std::numeric_limits<double>::infinity() : max_edge;
}

inline RasterGrid to_grid(const flaunay_raster& raster) {
  check_reserved(raster, "flaunay_raster");
  return {raster.x, raster.y, raster.dx, raster.dy, raster.rows, raster.columns};
}

inline RasterOptions to_options(const flaunay_raster& raster) {
  return {to_longest(raster.max_edge), raster.fill};
}

}  // namespace flaunay::c
