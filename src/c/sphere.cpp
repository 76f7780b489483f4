// The C interface to points on a sphere.
#include "flaunay/sphere.hpp"

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/verify.hpp"

using namespace flaunay;

using c::guarded;
using c::required;

FLAUNAY_HANDLE(spherical, SphericalTriangulation)
FLAUNAY_HANDLE(spherical_voronoi, SphericalVoronoi)
FLAUNAY_HANDLE(device_spherical, DeviceSphericalTriangulation)
FLAUNAY_HANDLE(spherical_locator, SphereLocator)

namespace {

SphereCoordinates to_coordinates(int given) {
  return c::to_enum<flaunay_sphere_coordinates, SphereCoordinates>(given);
}

}  // namespace

flaunay_status flaunay_spherical_create(flaunay_triangulator* triangulator, const double* points, size_t n,
                                        const size_t* offsets, size_t sets, int coordinates,
                                        flaunay_spherical** spherical) {
  return c::make(triangulator, spherical, [&](Triangulator& cpp) {
    return triangulate_sphere(cpp, points, c::to_offsets(offsets, sets, n), to_coordinates(coordinates));
  });
}

FLAUNAY_ACCESSOR(size_t, spherical, point_count, handle.cpp.representatives.size())
FLAUNAY_ACCESSOR(size_t, spherical, triangle_count, handle.cpp.triangles.size() / 3)
#define ARRAY(type, name, ...) FLAUNAY_ACCESSOR(const type*, spherical, name, c::elements(handle.cpp.name))
FLAUNAY_SPHERICAL_ARRAYS(ARRAY)
ARRAY(size_t, triangle_offsets)
#undef ARRAY

flaunay_status flaunay_spherical_directions(const flaunay_spherical* spherical, double* directions) {
  return guarded([&] {
    c::copy_to(directions, directions_of(required(spherical, "the triangulation").cpp.places), "directions");
  });
}

flaunay_status flaunay_spherical_verify(const flaunay_spherical* spherical, const double* points,
                                        int coordinates) {
  return c::verified([&] {
    const SphericalTriangulation& mesh = required(spherical, "the triangulation").cpp;
    return verify(points, mesh.point_offsets, to_coordinates(coordinates), mesh);
  });
}

FLAUNAY_DEVICE_RESULT(spherical, flaunay_spherical_part, FLAUNAY_SPHERICAL_ARRAYS, "the triangulation",
                      "a triangulation on the sphere")
FLAUNAY_ACCESSOR(size_t, device_spherical, triangle_count, c::total(handle.cpp.triangle_offsets))
FLAUNAY_ACCESSOR(const size_t*, device_spherical, triangle_offsets, c::elements(handle.cpp.triangle_offsets))

flaunay_status flaunay_spherical_compute_device(flaunay_triangulator* triangulator,
                                                const flaunay_device_points* points, int coordinates,
                                                const flaunay_enqueue* enqueue,
                                                flaunay_device_spherical* result) {
  return c::with(triangulator, enqueue, [&](Triangulator& cpp, const Enqueue& queued) {
    triangulate_sphere(cpp, c::to_points(points), to_coordinates(coordinates),
                       required(result, "the result").cpp, queued);
  });
}

flaunay_status flaunay_spherical_voronoi_create(flaunay_triangulator* triangulator,
                                                const flaunay_spherical* spherical,
                                                flaunay_spherical_voronoi** voronoi) {
  return c::make(triangulator, voronoi, [&](Triangulator& cpp) {
    return voronoi_on_sphere(cpp, required(spherical, "the triangulation").cpp);
  });
}

#define ARRAY(type, name, ...) \
  FLAUNAY_ACCESSOR(const type*, spherical_voronoi, name, c::elements(handle.cpp.name))
FLAUNAY_SPHERICAL_VORONOI_ARRAYS(ARRAY)
#undef ARRAY

flaunay_status flaunay_spherical_locator_create(flaunay_triangulator* triangulator,
                                                const flaunay_spherical* spherical,
                                                flaunay_spherical_locator** locator) {
  return c::make(triangulator, locator, [&](Triangulator& cpp) {
    return SphereLocator(cpp, required(spherical, "the triangulation").cpp);
  });
}

flaunay_status flaunay_spherical_locator_locate(flaunay_spherical_locator* locator, const double* queries,
                                                size_t m, int coordinates, int32_t* triangles) {
  return c::answer(locator, queries, m, triangles,
                   [&](SphereLocator& cpp) { return cpp.locate(queries, m, to_coordinates(coordinates)); });
}

flaunay_status flaunay_spherical_locator_nearest(flaunay_spherical_locator* locator, const double* queries,
                                                 size_t m, int coordinates, int32_t* points) {
  return c::answer(locator, queries, m, points,
                   [&](SphereLocator& cpp) { return cpp.nearest(queries, m, to_coordinates(coordinates)); });
}

flaunay_status flaunay_spherical_locator_nearest_points(flaunay_spherical_locator* locator,
                                                        const double* queries, size_t m, int coordinates,
                                                        size_t count, double max_distance, int32_t* points,
                                                        double* distances) {
  return guarded([&] {
    SphereLocator& cpp = required(locator, "the locator").cpp;
    check_queries(queries, m);
    check_array(points, m, "results");
    c::copy_to(cpp.nearest(queries, m, to_coordinates(coordinates), {count, max_distance}), points,
               distances);
  });
}

flaunay_status flaunay_spherical_locator_interpolate(flaunay_spherical_locator* locator, const double* values,
                                                     size_t columns, const double* queries, size_t m,
                                                     int coordinates, double* results) {
  return c::answer(locator, queries, m, results, [&](SphereLocator& cpp) {
    return cpp.interpolate(values, columns, queries, m, to_coordinates(coordinates));
  });
}
