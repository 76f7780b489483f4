// Rasters and contours of the C interface.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/terrain.hpp"

struct flaunay_contours {
  flaunay::Contours cpp;
};

namespace flaunay::c {

inline double to_longest(double max_edge) {
  return max_edge == 0 ? std::numeric_limits<double>::infinity() : max_edge;
}

/// The grid of flaunay_raster with its options.
struct AskedRaster : RasterGrid, RasterOptions {};
inline AskedRaster to_raster(const flaunay_raster& raster) {
  AskedRaster result;
  take<"max_edge">(raster, result);
  result.max_edge = to_longest(raster.max_edge);
  return result;
}

/// The heights of contours.
inline std::vector<double> to_heights(const double* heights, std::size_t count) {
  check_array(heights, count, "heights");
  return {heights, heights + count};
}

}  // namespace flaunay::c
