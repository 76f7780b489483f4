// The C interface to what is derived from a triangulation: Voronoi diagrams and queries.
#include <CL/cl.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"

using namespace flaunay;

using c::create;
using c::guarded;
using c::read;
using c::required;

struct flaunay_voronoi {
  Voronoi cpp;
};

struct flaunay_device_voronoi {
  DeviceVoronoi cpp;
};

struct flaunay_locator {
  Locator cpp;
};

namespace {

template <typename Handle>
auto& buffer_of(Handle& voronoi, unsigned part) {
  switch (part) {
    case FLAUNAY_VORONOI_CIRCUMCENTRES:
      return voronoi.cpp.circumcentres;
    case FLAUNAY_VORONOI_CELL_OFFSETS:
      return voronoi.cpp.cell_offsets;
    case FLAUNAY_VORONOI_CELLS:
      return voronoi.cpp.cells;
    case FLAUNAY_VORONOI_UNBOUNDED:
      return voronoi.cpp.unbounded;
  }
  throw Error(ErrorKind::usage, fmt::format("{} is not one part of a Voronoi diagram", part));
}

// compute(locator, offsets) gives one value a query, which go to the caller's array.
template <typename Value, typename Compute>
flaunay_status answer(flaunay_locator* locator, const double* queries, size_t m, const size_t* offsets,
                      size_t sets, Value* place, const Compute& compute) {
  return guarded([&] {
    Locator& cpp = required(locator, "the locator").cpp;
    const std::vector<std::size_t> checked = c::to_offsets(offsets, sets, m);
    if (m > 0) required(queries, "the queries");
    if (m > 0) required(place, "the array of results");
    const auto values = compute(cpp, checked);
    std::copy(values.begin(), values.end(), place);
  });
}

// compute(locator, queries, buffer, enqueue) writes to the caller's buffer, or to a new one, which goes to
// the caller.
template <typename Compute>
flaunay_status answer_on_device(flaunay_locator* locator, const flaunay_device_points* queries,
                                const flaunay_enqueue* enqueue, cl_mem* place, const Compute& compute) {
  return guarded([&] {
    const Enqueue queued = c::to_enqueue(enqueue);
    Locator& cpp = required(locator, "the locator").cpp;
    DeviceBuffer buffer = c::to_buffer(required(place, "the pointer to the buffer of results"));
    compute(cpp, c::to_points(queries), buffer, queued);
    if (*place == nullptr && buffer.memory() != nullptr) {
      clRetainMemObject(buffer.memory());
      *place = buffer.memory();
    }
  });
}

}  // namespace

flaunay_status flaunay_voronoi_compute(flaunay_triangulator* triangulator, const double* coordinates,
                                       size_t n, const flaunay_triangulation* triangulation,
                                       flaunay_voronoi** voronoi) {
  return create(voronoi, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const Triangulation& primal = required(triangulation, "the triangulation").cpp;
    return std::make_unique<flaunay_voronoi>(flaunay_voronoi{cpp.voronoi(coordinates, n, primal)});
  });
}

void flaunay_voronoi_destroy(flaunay_voronoi* voronoi) { delete voronoi; }

size_t flaunay_voronoi_point_count(const flaunay_voronoi* voronoi) {
  return read(voronoi, [](const auto& handle) { return handle.cpp.unbounded.size(); });
}

size_t flaunay_voronoi_triangle_count(const flaunay_voronoi* voronoi) {
  return read(voronoi, [](const auto& handle) { return handle.cpp.circumcentres.size() / 2; });
}

size_t flaunay_voronoi_corner_count(const flaunay_voronoi* voronoi) {
  return read(voronoi, [](const auto& handle) { return handle.cpp.cells.size(); });
}

const double* flaunay_voronoi_circumcentres(const flaunay_voronoi* voronoi) {
  return read(voronoi, [](const auto& handle) { return c::elements(handle.cpp.circumcentres); });
}

const int32_t* flaunay_voronoi_cell_offsets(const flaunay_voronoi* voronoi) {
  return read(voronoi, [](const auto& handle) { return c::elements(handle.cpp.cell_offsets); });
}

const int32_t* flaunay_voronoi_cells(const flaunay_voronoi* voronoi) {
  return read(voronoi, [](const auto& handle) { return c::elements(handle.cpp.cells); });
}

const uint8_t* flaunay_voronoi_unbounded(const flaunay_voronoi* voronoi) {
  return read(voronoi, [](const auto& handle) { return c::elements(handle.cpp.unbounded); });
}

flaunay_status flaunay_device_voronoi_create(flaunay_device_voronoi** voronoi) {
  return create(voronoi, [] { return std::make_unique<flaunay_device_voronoi>(); });
}

void flaunay_device_voronoi_destroy(flaunay_device_voronoi* voronoi) { delete voronoi; }

flaunay_status flaunay_device_voronoi_set_buffer(flaunay_device_voronoi* voronoi, unsigned part,
                                                 cl_mem memory) {
  return guarded([&] { buffer_of(required(voronoi, "the Voronoi diagram"), part) = c::to_buffer(memory); });
}

cl_mem flaunay_device_voronoi_buffer(const flaunay_device_voronoi* voronoi, unsigned part) {
  return read(voronoi, [&](const auto& handle) { return buffer_of(handle, part).memory(); });
}

flaunay_status flaunay_voronoi_compute_device(flaunay_triangulator* triangulator,
                                              const flaunay_device_points* points,
                                              const flaunay_device_triangulation* triangulation,
                                              const flaunay_enqueue* enqueue,
                                              flaunay_device_voronoi* result) {
  return guarded([&] {
    const Enqueue queued = c::to_enqueue(enqueue);
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const DeviceTriangulation& primal = required(triangulation, "the triangulation").cpp;
    cpp.voronoi(c::to_points(points), primal, required(result, "the result").cpp, queued);
  });
}

flaunay_status flaunay_locator_create(flaunay_triangulator* triangulator, const double* coordinates, size_t n,
                                      const size_t* offsets, size_t sets,
                                      const flaunay_triangulation* triangulation, flaunay_locator** locator) {
  return create(locator, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const Triangulation& searched = required(triangulation, "the triangulation").cpp;
    return std::make_unique<flaunay_locator>(
        flaunay_locator{Locator(cpp, coordinates, c::to_offsets(offsets, sets, n), searched)});
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

void flaunay_locator_destroy(flaunay_locator* locator) { delete locator; }

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

flaunay_status flaunay_locator_interpolate(flaunay_locator* locator, const double* values,
                                           const double* queries, size_t m, const size_t* offsets,
                                           size_t sets, double* results) {
  return answer(locator, queries, m, offsets, sets, results, [&](Locator& cpp, const auto& checked) {
    if (m > 0) required(values, "the values of points");
    return cpp.interpolate(values, queries, checked);
  });
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

flaunay_status flaunay_locator_interpolate_device(flaunay_locator* locator, cl_mem values,
                                                  const flaunay_device_points* queries,
                                                  const flaunay_enqueue* enqueue, cl_mem* results) {
  return answer_on_device(locator, queries, enqueue, results,
                          [&](Locator& cpp, auto&&... given) { cpp.interpolate(values, given...); });
}
