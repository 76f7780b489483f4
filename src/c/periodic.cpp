// The C interface to points on a torus or a cylinder.
#include "flaunay/periodic.hpp"

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

struct flaunay_periodic {
  PeriodicTriangulation cpp;
};

struct flaunay_device_periodic {
  DevicePeriodicTriangulation cpp;
};

struct flaunay_periodic_locator {
  PeriodicLocator cpp;
};

namespace {

template <c::Is<DevicePeriodicTriangulation> Result>
auto& buffer_of(Result& periodic, unsigned part) {
#define BUFFER(type, name, ...) &DevicePeriodicTriangulation::name,
  static constexpr std::array kBuffers = {FLAUNAY_PERIODIC_ARRAYS(BUFFER)};
#undef BUFFER
  return c::buffer_of(periodic, kBuffers, part, "a triangulation on a torus");
}

// Answers queries by answer(locator) into the caller's array.
template <typename Value, typename Answer>
flaunay_status answer(flaunay_periodic_locator* locator, const double* queries, size_t m, Value* to,
                      const Answer& answer) {
  return guarded([&] {
    PeriodicLocator& cpp = required(locator, "the locator").cpp;
    check_queries(queries, m);
    check_array(to, m, "results");
    c::copy_to(to, answer(cpp), "results");
  });
}

}  // namespace

flaunay_status flaunay_periodic_create(flaunay_triangulator* triangulator, const double* points, size_t n,
                                       const size_t* offsets, size_t sets, double period_x, double period_y,
                                       flaunay_periodic** periodic) {
  return create(periodic, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    return std::make_unique<flaunay_periodic>(flaunay_periodic{
        triangulate_periodic(cpp, points, c::to_offsets(offsets, sets, n), {period_x, period_y})});
  });
}

void flaunay_periodic_destroy(flaunay_periodic* periodic) { delete periodic; }

size_t flaunay_periodic_point_count(const flaunay_periodic* periodic) {
  return read(periodic, [](const auto& handle) { return handle.cpp.representatives.size(); });
}

size_t flaunay_periodic_triangle_count(const flaunay_periodic* periodic) {
  return read(periodic, [](const auto& handle) { return handle.cpp.triangles.size() / 3; });
}

size_t flaunay_periodic_image_count(const flaunay_periodic* periodic) {
  return read(periodic, [](const auto& handle) { return handle.cpp.images; });
}

const double* flaunay_periodic_period(const flaunay_periodic* periodic) {
  static_assert(sizeof(Period) == 2 * sizeof(double));
  return read(periodic, [](const auto& handle) { return &handle.cpp.period.x; });
}

#define ACCESSOR(type, name)                                                                \
  const type* flaunay_periodic_##name(const flaunay_periodic* periodic) {                   \
    return read(periodic, [](const auto& handle) { return c::elements(handle.cpp.name); }); \
  }
ACCESSOR(double, places)
ACCESSOR(int32_t, triangles)
ACCESSOR(int8_t, offsets)
ACCESSOR(int32_t, neighbors)
ACCESSOR(int32_t, representatives)
ACCESSOR(size_t, triangle_offsets)
#undef ACCESSOR

flaunay_status flaunay_periodic_cells(flaunay_triangulator* triangulator, const flaunay_periodic* periodic,
                                      flaunay_clipped_voronoi** cells) {
  return create(cells, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    return std::make_unique<flaunay_clipped_voronoi>(
        flaunay_clipped_voronoi{periodic_cells(cpp, required(periodic, "the triangulation").cpp)});
  });
}

flaunay_status flaunay_point_tree_create_periodic(flaunay_triangulator* triangulator,
                                                  const flaunay_periodic* periodic,
                                                  flaunay_point_tree** tree) {
  return create(tree, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    return std::make_unique<flaunay_point_tree>(
        flaunay_point_tree{PointTree(cpp, required(periodic, "the triangulation").cpp)});
  });
}

flaunay_status flaunay_periodic_verify(const flaunay_periodic* periodic) {
  return c::verified([&] { return verify(required(periodic, "the triangulation").cpp); });
}

FLAUNAY_DEVICE_RESULT(periodic, "the triangulation")

size_t flaunay_device_periodic_triangle_count(const flaunay_device_periodic* periodic) {
  return read(periodic, [](const auto& handle) { return c::total(handle.cpp.triangle_offsets); });
}

size_t flaunay_device_periodic_image_count(const flaunay_device_periodic* periodic) {
  return read(periodic, [](const auto& handle) { return handle.cpp.images; });
}

const double* flaunay_device_periodic_period(const flaunay_device_periodic* periodic) {
  return read(periodic, [](const auto& handle) { return &handle.cpp.period.x; });
}

const size_t* flaunay_device_periodic_triangle_offsets(const flaunay_device_periodic* periodic) {
  return read(periodic, [](const auto& handle) { return c::elements(handle.cpp.triangle_offsets); });
}

flaunay_status flaunay_periodic_compute_device(flaunay_triangulator* triangulator,
                                               const flaunay_device_points* points, double period_x,
                                               double period_y, const flaunay_enqueue* enqueue,
                                               flaunay_device_periodic* result) {
  return guarded([&] {
    const Enqueue queued = c::to_enqueue(enqueue);
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    triangulate_periodic(cpp, c::to_points(points), {period_x, period_y}, required(result, "the result").cpp,
                         queued);
  });
}

flaunay_status flaunay_periodic_locator_create(flaunay_triangulator* triangulator,
                                               const flaunay_periodic* periodic,
                                               flaunay_periodic_locator** locator) {
  return create(locator, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    return std::make_unique<flaunay_periodic_locator>(
        flaunay_periodic_locator{PeriodicLocator(cpp, required(periodic, "the triangulation").cpp)});
  });
}

void flaunay_periodic_locator_destroy(flaunay_periodic_locator* locator) { delete locator; }

flaunay_status flaunay_periodic_locator_locate(flaunay_periodic_locator* locator, const double* queries,
                                               size_t m, int32_t* triangles) {
  return answer(locator, queries, m, triangles, [&](PeriodicLocator& cpp) { return cpp.locate(queries, m); });
}

flaunay_status flaunay_periodic_locator_nearest(flaunay_periodic_locator* locator, const double* queries,
                                                size_t m, int32_t* points) {
  return answer(locator, queries, m, points, [&](PeriodicLocator& cpp) { return cpp.nearest(queries, m); });
}

flaunay_status flaunay_periodic_locator_interpolate(flaunay_periodic_locator* locator, const double* values,
                                                    size_t columns, const double* queries, size_t m,
                                                    double* results) {
  return answer(locator, queries, m, results, [&](PeriodicLocator& cpp) {
    InterpolationOptions options;
    options.columns = columns;
    return cpp.interpolate(values, queries, m, options);
  });
}
