// The C interface to points on a sphere.
#include "flaunay/sphere.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/verify.hpp"

using namespace flaunay;

using c::create;
using c::guarded;
using c::read;
using c::required;

struct flaunay_spherical {
  SphericalTriangulation cpp;
};

struct flaunay_spherical_voronoi {
  SphericalVoronoi cpp;
};

struct flaunay_device_spherical {
  DeviceSphericalTriangulation cpp;
};

struct flaunay_spherical_locator {
  SphereLocator cpp;
};

namespace {

SphereCoordinates to_coordinates(int given) {
  return c::to_enum<flaunay_sphere_coordinates, SphereCoordinates>(given);
}

template <c::Is<DeviceSphericalTriangulation> Result>
auto& buffer_of(Result& spherical, unsigned part) {
#define BUFFER(type, name, ...) &DeviceSphericalTriangulation::name,
  static constexpr std::array kBuffers = {FLAUNAY_SPHERICAL_ARRAYS(BUFFER)};
#undef BUFFER
  return c::buffer_of(spherical, kBuffers, part, "a triangulation on the sphere");
}

// Answers queries by answer(locator, coordinates) into the caller's array.
template <typename Value, typename Answer>
flaunay_status answer(flaunay_spherical_locator* locator, const double* queries, size_t m, int coordinates,
                      Value* to, const Answer& answer) {
  return guarded([&] {
    SphereLocator& cpp = required(locator, "the locator").cpp;
    check_queries(queries, m);
    check_array(to, m, "results");
    c::copy_to(to, answer(cpp, to_coordinates(coordinates)), "results");
  });
}

}  // namespace

flaunay_status flaunay_spherical_create(flaunay_triangulator* triangulator, const double* points, size_t n,
                                        const size_t* offsets, size_t sets, int coordinates,
                                        flaunay_spherical** spherical) {
  return create(spherical, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    return std::make_unique<flaunay_spherical>(flaunay_spherical{
        triangulate_sphere(cpp, points, c::to_offsets(offsets, sets, n), to_coordinates(coordinates))});
  });
}

void flaunay_spherical_destroy(flaunay_spherical* spherical) { delete spherical; }

size_t flaunay_spherical_point_count(const flaunay_spherical* spherical) {
  return read(spherical, [](const auto& handle) { return handle.cpp.representatives.size(); });
}

size_t flaunay_spherical_triangle_count(const flaunay_spherical* spherical) {
  return read(spherical, [](const auto& handle) { return handle.cpp.triangles.size() / 3; });
}

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

FLAUNAY_DEVICE_RESULT(spherical, "the triangulation")

size_t flaunay_device_spherical_triangle_count(const flaunay_device_spherical* spherical) {
  return read(spherical, [](const auto& handle) { return c::total(handle.cpp.triangle_offsets); });
}

const size_t* flaunay_device_spherical_triangle_offsets(const flaunay_device_spherical* spherical) {
  return read(spherical, [](const auto& handle) { return c::elements(handle.cpp.triangle_offsets); });
}

flaunay_status flaunay_spherical_compute_device(flaunay_triangulator* triangulator,
                                                const flaunay_device_points* points, int coordinates,
                                                const flaunay_enqueue* enqueue,
                                                flaunay_device_spherical* result) {
  return guarded([&] {
    const Enqueue queued = c::to_enqueue(enqueue);
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    triangulate_sphere(cpp, c::to_points(points), to_coordinates(coordinates),
                       required(result, "the result").cpp, queued);
  });
}

flaunay_status flaunay_spherical_voronoi_create(flaunay_triangulator* triangulator,
                                                const flaunay_spherical* spherical,
                                                flaunay_spherical_voronoi** voronoi) {
  return create(voronoi, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    return std::make_unique<flaunay_spherical_voronoi>(
        flaunay_spherical_voronoi{voronoi_on_sphere(cpp, required(spherical, "the triangulation").cpp)});
  });
}

void flaunay_spherical_voronoi_destroy(flaunay_spherical_voronoi* voronoi) { delete voronoi; }

#define ACCESSOR(type, handle_type, name)                                                 \
  const type* handle_type##_##name(const handle_type* result) {                           \
    return read(result, [](const auto& handle) { return c::elements(handle.cpp.name); }); \
  }
ACCESSOR(double, flaunay_spherical, places)
ACCESSOR(int32_t, flaunay_spherical, triangles)
ACCESSOR(int32_t, flaunay_spherical, neighbors)
ACCESSOR(int32_t, flaunay_spherical, representatives)
ACCESSOR(size_t, flaunay_spherical, triangle_offsets)
ACCESSOR(double, flaunay_spherical_voronoi, centres)
ACCESSOR(int32_t, flaunay_spherical_voronoi, cell_offsets)
ACCESSOR(int32_t, flaunay_spherical_voronoi, cells)
ACCESSOR(double, flaunay_spherical_voronoi, areas)
#undef ACCESSOR

flaunay_status flaunay_spherical_locator_create(flaunay_triangulator* triangulator,
                                                const flaunay_spherical* spherical,
                                                flaunay_spherical_locator** locator) {
  return create(locator, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    return std::make_unique<flaunay_spherical_locator>(
        flaunay_spherical_locator{SphereLocator(cpp, required(spherical, "the triangulation").cpp)});
  });
}

void flaunay_spherical_locator_destroy(flaunay_spherical_locator* locator) { delete locator; }

flaunay_status flaunay_spherical_locator_locate(flaunay_spherical_locator* locator, const double* queries,
                                                size_t m, int coordinates, int32_t* triangles) {
  return answer(locator, queries, m, coordinates, triangles,
                [&](SphereLocator& cpp, SphereCoordinates given) { return cpp.locate(queries, m, given); });
}

flaunay_status flaunay_spherical_locator_nearest(flaunay_spherical_locator* locator, const double* queries,
                                                 size_t m, int coordinates, int32_t* points) {
  return answer(locator, queries, m, coordinates, points,
                [&](SphereLocator& cpp, SphereCoordinates given) { return cpp.nearest(queries, m, given); });
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
  return answer(locator, queries, m, coordinates, results, [&](SphereLocator& cpp, SphereCoordinates given) {
    return cpp.interpolate(values, columns, queries, m, given);
  });
}
