// The C interface to points on a torus or a cylinder.
#include "flaunay/periodic.hpp"

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/verify.hpp"

using namespace flaunay;

using c::required;

FLAUNAY_HANDLE(periodic, PeriodicTriangulation)
FLAUNAY_HANDLE(device_periodic, DevicePeriodicTriangulation)
FLAUNAY_HANDLE(periodic_locator, PeriodicLocator)

flaunay_status flaunay_periodic_create(flaunay_triangulator* triangulator, const double* points, size_t n,
                                       const size_t* offsets, size_t sets, double period_x, double period_y,
                                       double shear, flaunay_periodic** periodic) {
  return c::make(triangulator, periodic, [&](Triangulator& cpp) {
    return triangulate_periodic(cpp, points, c::to_offsets(offsets, sets, n), {period_x, period_y, shear});
  });
}

static_assert(sizeof(Period) == 3 * sizeof(double));
FLAUNAY_ACCESSOR(size_t, periodic, point_count, handle.cpp.representatives.size())
FLAUNAY_ACCESSOR(size_t, periodic, triangle_count, handle.cpp.triangles.size() / 3)
FLAUNAY_ACCESSOR(size_t, periodic, image_count, handle.cpp.images)
FLAUNAY_ACCESSOR(const double*, periodic, period, &handle.cpp.period.x)
#define ARRAY(type, name, ...) FLAUNAY_ACCESSOR(const type*, periodic, name, c::elements(handle.cpp.name))
FLAUNAY_PERIODIC_ARRAYS(ARRAY)
ARRAY(size_t, triangle_offsets)
#undef ARRAY

flaunay_status flaunay_periodic_cells(flaunay_triangulator* triangulator, const flaunay_periodic* periodic,
                                      flaunay_clipped_voronoi** cells) {
  return c::make(triangulator, cells, [&](Triangulator& cpp) {
    return periodic_cells(cpp, required(periodic, "the triangulation").cpp);
  });
}

flaunay_status flaunay_point_tree_create_periodic(flaunay_triangulator* triangulator,
                                                  const flaunay_periodic* periodic,
                                                  flaunay_point_tree** tree) {
  return c::make(triangulator, tree, [&](Triangulator& cpp) {
    return PointTree(cpp, required(periodic, "the triangulation").cpp);
  });
}

flaunay_status flaunay_periodic_verify(const flaunay_periodic* periodic) {
  return c::verified([&] { return verify(required(periodic, "the triangulation").cpp); });
}

FLAUNAY_DEVICE_RESULT(periodic, flaunay_periodic_part, FLAUNAY_PERIODIC_ARRAYS, "the triangulation",
                      "a triangulation on a torus")
FLAUNAY_ACCESSOR(size_t, device_periodic, triangle_count, c::total(handle.cpp.triangle_offsets))
FLAUNAY_ACCESSOR(size_t, device_periodic, image_count, handle.cpp.images)
FLAUNAY_ACCESSOR(const double*, device_periodic, period, &handle.cpp.period.x)
FLAUNAY_ACCESSOR(const size_t*, device_periodic, triangle_offsets, c::elements(handle.cpp.triangle_offsets))

flaunay_status flaunay_periodic_compute_device(flaunay_triangulator* triangulator,
                                               const flaunay_device_points* points, double period_x,
                                               double period_y, double shear, const flaunay_enqueue* enqueue,
                                               flaunay_device_periodic* result) {
  return c::with(triangulator, enqueue, [&](Triangulator& cpp, const Enqueue& queued) {
    triangulate_periodic(cpp, c::to_points(points), {period_x, period_y, shear},
                         required(result, "the result").cpp, queued);
  });
}

flaunay_status flaunay_periodic_locator_create(flaunay_triangulator* triangulator,
                                               const flaunay_periodic* periodic,
                                               flaunay_periodic_locator** locator) {
  return c::make(triangulator, locator, [&](Triangulator& cpp) {
    return PeriodicLocator(cpp, required(periodic, "the triangulation").cpp);
  });
}

flaunay_status flaunay_periodic_locator_locate(flaunay_periodic_locator* locator, const double* queries,
                                               size_t m, int32_t* triangles) {
  return c::answer(locator, queries, m, triangles,
                   [&](PeriodicLocator& cpp) { return cpp.locate(queries, m); });
}

flaunay_status flaunay_periodic_locator_nearest(flaunay_periodic_locator* locator, const double* queries,
                                                size_t m, int32_t* points) {
  return c::answer(locator, queries, m, points,
                   [&](PeriodicLocator& cpp) { return cpp.nearest(queries, m); });
}

flaunay_status flaunay_periodic_locator_interpolate(flaunay_periodic_locator* locator, const double* values,
                                                    const double* queries, size_t m,
                                                    const flaunay_interpolation_options* options,
                                                    double* results) {
  return c::answer(locator, queries, m, results, [&](PeriodicLocator& cpp) {
    return cpp.interpolate(values, queries, m, c::to_interpolation(options));
  });
}
