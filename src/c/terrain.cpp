// The C interface to rasters and contours.
#include "flaunay/terrain.hpp"

#include <algorithm>
#include <memory>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "c/raster.hpp"
#include "flaunay/flaunay.h"

using namespace flaunay;

using c::create;
using c::guarded;
using c::read;
using c::required;

flaunay_status flaunay_rasterize(flaunay_triangulator* triangulator, const double* coordinates, size_t n,
                                 const int32_t* triangles, const int32_t* neighbors, size_t t,
                                 const double* values, const flaunay_raster* raster, double* pixels) {
  return guarded([&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const flaunay_raster& wanted = required(raster, "the raster");
    rasterize(cpp, {coordinates, n, triangles, neighbors, t}, values, c::to_grid(wanted),
              c::to_options(wanted), pixels);
  });
}

flaunay_status flaunay_contours_compute(flaunay_triangulator* triangulator, const double* coordinates,
                                        size_t n, const int32_t* triangles, const int32_t* neighbors,
                                        size_t t, const double* values, const double* heights,
                                        size_t height_count, double max_edge, flaunay_contours** contours) {
  return create(contours, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    return std::make_unique<flaunay_contours>(
        flaunay_contours{trace_contours(cpp, {coordinates, n, triangles, neighbors, t}, values,
                                        c::to_heights(heights, height_count), c::to_longest(max_edge))});
  });
}

void flaunay_contours_destroy(flaunay_contours* contours) { delete contours; }

size_t flaunay_contours_line_count(const flaunay_contours* contours) {
  return read(contours, [](const auto& handle) { return handle.cpp.heights.size(); });
}

#define ACCESSOR(type, name)                                                                \
  const type* flaunay_contours_##name(const flaunay_contours* contours) {                   \
    return read(contours, [](const auto& handle) { return c::elements(handle.cpp.name); }); \
  }
ACCESSOR(size_t, offsets)
ACCESSOR(double, coordinates)
ACCESSOR(int32_t, heights)
#undef ACCESSOR
