// The C interface to locators and their queries.
#include <memory>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/neighbors.hpp"

using namespace flaunay;

using c::create;
using c::guarded;
using c::required;

FLAUNAY_DESTROY(locator)
FLAUNAY_HANDLE(natural_weights, NaturalWeights)

namespace {

// compute(locator, offsets) returns one value per query; the values are copied to the caller's array.
template <typename Value, typename Compute>
flaunay_status answer(flaunay_locator* locator, const double* queries, size_t m, const size_t* offsets,
                      size_t sets, Value* place, const Compute& compute) {
  return guarded([&] {
    Locator& cpp = required(locator, "the locator").cpp;
    const std::vector<std::size_t> checked = c::to_offsets(offsets, sets, m);
    check_queries(queries, m);
    check_array(place, m, "results");
    c::copy_to(place, compute(cpp, checked), "results");
  });
}

// compute(locator, buffer, enqueue) writes to the caller's buffer. If there is none, it writes to a new
// buffer, which the caller receives.
template <typename Compute>
flaunay_status write_on_device(flaunay_locator* locator, const flaunay_enqueue* enqueue, cl_mem* place,
                               const Compute& compute) {
  return guarded([&] {
    const Enqueue queued = c::to_enqueue(enqueue);
    Locator& cpp = required(locator, "the locator").cpp;
    DeviceBuffer buffer = c::to_buffer(required(place, "the pointer to the buffer of results"));
    compute(cpp, buffer, queued);
    c::give(buffer, *place);
  });
}

// compute(locator, queries, buffer, enqueue).
template <typename Compute>
flaunay_status answer_on_device(flaunay_locator* locator, const flaunay_device_points* queries,
                                const flaunay_enqueue* enqueue, cl_mem* place, const Compute& compute) {
  return write_on_device(locator, enqueue, place,
                         [&](Locator& cpp, DeviceBuffer& buffer, const Enqueue& queued) {
                           compute(cpp, c::to_points(queries, "the queries"), buffer, queued);
                         });
}

}  // namespace

flaunay_status flaunay_locator_create(flaunay_triangulator* triangulator, const double* coordinates,
                                      const double* weights, size_t n, const size_t* offsets, size_t sets,
                                      const flaunay_triangulation* triangulation, flaunay_locator** locator) {
  return c::make(triangulator, locator, [&](Triangulator& cpp) {
    const flaunay_triangulation& searched = required(triangulation, "the triangulation");
    if (searched.constrained() != nullptr) {
      expect(offsets == nullptr || sets == 1, "a triangulation with constraints must be of one set");
      return Locator(cpp, coordinates, n, *searched.constrained());
    }
    if (searched.plain().space.kind != SpaceKind::plane) return Locator(cpp, searched.plain(), weights);
    return Locator(cpp, coordinates, c::to_offsets(offsets, sets, n), searched.plain());
  });
}

flaunay_status flaunay_locator_set_coordinates(flaunay_locator* locator, int coordinates) {
  return guarded([&] {
    required(locator, "the locator").cpp.set_coordinates(c::to_enum<SphereCoordinates>(coordinates));
  });
}

flaunay_status flaunay_locator_create_device(flaunay_triangulator* triangulator,
                                             const flaunay_device_points* points,
                                             const flaunay_device_triangulation* triangulation,
                                             const flaunay_enqueue* enqueue, flaunay_locator** locator) {
  return create(locator, [&] {
    const Enqueue queued = c::to_enqueue(enqueue);
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const DeviceTriangulation& searched = required(triangulation, "the triangulation").cpp;
    return std::make_unique<flaunay_locator>(
        flaunay_locator{Locator(cpp, c::to_points(points), searched, queued)});
  });
}

flaunay_status flaunay_locator_locate(flaunay_locator* locator, const double* queries, size_t m,
                                      const size_t* offsets, size_t sets, int32_t* triangles) {
  return answer(locator, queries, m, offsets, sets, triangles,
                [&](Locator& cpp, const auto& checked) { return cpp.locate(queries, checked); });
}

flaunay_status flaunay_locator_nearest(flaunay_locator* locator, const double* queries, size_t m,
                                       const size_t* offsets, size_t sets, int32_t* points) {
  return answer(locator, queries, m, offsets, sets, points,
                [&](Locator& cpp, const auto& checked) { return cpp.nearest(queries, checked); });
}

flaunay_status flaunay_locator_locate_device(flaunay_locator* locator, const flaunay_device_points* queries,
                                             const flaunay_enqueue* enqueue, cl_mem* triangles) {
  return answer_on_device(locator, queries, enqueue, triangles,
                          [](Locator& cpp, auto&&... given) { cpp.locate(given...); });
}

flaunay_status flaunay_locator_nearest_device(flaunay_locator* locator, const flaunay_device_points* queries,
                                              const flaunay_enqueue* enqueue, cl_mem* points) {
  return answer_on_device(locator, queries, enqueue, points,
                          [](Locator& cpp, auto&&... given) { cpp.nearest(given...); });
}

flaunay_status flaunay_locator_interpolate(flaunay_locator* locator, const double* values,
                                           const double* queries, size_t m, const size_t* offsets,
                                           size_t sets, const flaunay_interpolation_options* options,
                                           double* results) {
  return answer(locator, queries, m, offsets, sets, results, [&](Locator& cpp, const auto& checked) {
    return cpp.interpolate(values, queries, checked, c::to_interpolation(options));
  });
}

flaunay_status flaunay_locator_interpolate_device(flaunay_locator* locator, cl_mem values,
                                                  const flaunay_device_points* queries,
                                                  const flaunay_interpolation_options* options,
                                                  const flaunay_enqueue* enqueue, cl_mem* results) {
  return answer_on_device(
      locator, queries, enqueue, results,
      [&](Locator& cpp, const DevicePoints& points, DeviceBuffer& buffer, const Enqueue& queued) {
        cpp.interpolate(values, points, buffer, c::to_interpolation(options), queued);
      });
}

flaunay_status flaunay_locator_gradients(flaunay_locator* locator, const double* values,
                                         const flaunay_interpolation_options* options, double* gradients) {
  return guarded([&] {
    Locator& cpp = required(locator, "the locator").cpp;
    const InterpolationOptions checked = c::to_interpolation(options);
    c::copy_to(gradients, cpp.gradients(values, checked.columns, checked.estimation), "gradients");
  });
}

flaunay_status flaunay_locator_gradients_device(flaunay_locator* locator, cl_mem values,
                                                const flaunay_interpolation_options* options,
                                                const flaunay_enqueue* enqueue, cl_mem* gradients) {
  return write_on_device(locator, enqueue, gradients,
                         [&](Locator& cpp, DeviceBuffer& buffer, const Enqueue& queued) {
                           const InterpolationOptions checked = c::to_interpolation(options);
                           cpp.gradients(values, buffer, checked.columns, checked.estimation, queued);
                         });
}

flaunay_status flaunay_natural_weights_compute(flaunay_locator* locator, const double* queries, size_t m,
                                               int method, flaunay_natural_weights** weights) {
  return create(weights, [&] {
    Locator& cpp = required(locator, "the locator").cpp;
    const auto by = c::to_enum<Interpolation>(method);
    return std::make_unique<flaunay_natural_weights>(
        flaunay_natural_weights{cpp.natural_weights(queries, m, by)});
  });
}

FLAUNAY_ACCESSOR(const size_t*, natural_weights, offsets, c::elements(handle.cpp.offsets))
FLAUNAY_ACCESSOR(const int32_t*, natural_weights, points, c::elements(handle.cpp.points))
FLAUNAY_ACCESSOR(const double*, natural_weights, weights, c::elements(handle.cpp.weights))

flaunay_status flaunay_point_tree_create(flaunay_triangulator* triangulator, const double* coordinates,
                                         size_t n, flaunay_point_tree** tree) {
  return c::make(triangulator, tree, [&](Triangulator& cpp) { return PointTree(cpp, coordinates, n); });
}

FLAUNAY_DESTROY(point_tree)

flaunay_status flaunay_point_tree_create_in_space(flaunay_triangulator* triangulator,
                                                  const flaunay_triangulation* triangulation,
                                                  flaunay_point_tree** tree) {
  return c::make(triangulator, tree, [&](Triangulator& cpp) {
    return PointTree(cpp, required(triangulation, "the triangulation").plain());
  });
}

flaunay_status flaunay_point_tree_set_coordinates(flaunay_point_tree* tree, int coordinates) {
  return guarded(
      [&] { required(tree, "the tree").cpp.set_coordinates(c::to_enum<SphereCoordinates>(coordinates)); });
}

flaunay_status flaunay_point_tree_nearest(flaunay_point_tree* tree, const double* queries, size_t m,
                                          size_t count, double max_distance, int32_t* points,
                                          double* distances) {
  return guarded([&] {
    PointTree& cpp = required(tree, "the tree").cpp;
    check_queries(queries, m);
    check_array(points, m, "results");
    c::copy_to(cpp.nearest(queries, m, {count, max_distance}), points, distances);
  });
}
