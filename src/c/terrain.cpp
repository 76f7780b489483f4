// The C interface to rasters and contours.
#include "flaunay/terrain.hpp"

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "c/raster.hpp"
#include "flaunay/flaunay.h"

using namespace flaunay;

using c::required;

flaunay_status flaunay_rasterize(flaunay_triangulator* triangulator, const double* coordinates, size_t n,
                                 const int32_t* triangles, const int32_t* neighbors, size_t t,
                                 const double* values, const flaunay_raster* raster, double* pixels) {
  return c::with(triangulator, [&](Triangulator& cpp) {
    const c::AskedRaster wanted = c::to_raster(required(raster, "the raster"));
    rasterize(cpp, {coordinates, n, triangles, neighbors, t}, values, wanted, wanted, pixels);
  });
}

flaunay_status flaunay_shade_hills(const flaunay_raster* raster, const double* pixels,
                                   const flaunay_shading* shading, uint8_t* picture) {
  return c::guarded([&] {
    const flaunay_shading& given = required(shading, "shading");
    ShadingOptions options;
    c::take<"vertical_factor">(given, options);
    if (given.vertical_factor != 0) options.vertical_factor = given.vertical_factor;
    shade_hills(c::to_raster(required(raster, "the raster")), pixels, options, picture);
  });
}

flaunay_status flaunay_contours_compute(flaunay_triangulator* triangulator, const double* coordinates,
                                        size_t n, const int32_t* triangles, const int32_t* neighbors,
                                        size_t t, const double* values, const double* heights,
                                        size_t height_count, double max_edge, flaunay_contours** contours) {
  return c::make(triangulator, contours, [&](Triangulator& cpp) {
    return trace_contours(cpp, {coordinates, n, triangles, neighbors, t}, values,
                          c::to_heights(heights, height_count), c::to_longest(max_edge));
  });
}

FLAUNAY_DESTROY(contours)
FLAUNAY_ACCESSOR(size_t, contours, line_count, handle.cpp.heights.size())
FLAUNAY_ACCESSOR(const size_t*, contours, offsets, c::elements(handle.cpp.offsets))
FLAUNAY_ACCESSOR(const double*, contours, coordinates, c::elements(handle.cpp.coordinates))
FLAUNAY_ACCESSOR(const int32_t*, contours, heights, c::elements(handle.cpp.heights))
