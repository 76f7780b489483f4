// The C interface to clipped Voronoi cells and to relaxation.
#include <algorithm>
#include <array>
#include <memory>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"

using namespace flaunay;

using c::create;
using c::guarded;
using c::read;
using c::required;

struct flaunay_device_clipped_voronoi {
  DeviceClippedVoronoi cpp;
};

namespace {

template <c::Is<DeviceClippedVoronoi> Result>
auto& buffer_of(Result& cells, unsigned part) {
#define BUFFER(type, name, ...) &DeviceClippedVoronoi::name,
  static constexpr std::array kBuffers = {FLAUNAY_CLIPPED_VORONOI_ARRAYS(BUFFER)};
#undef BUFFER
  return c::buffer_of(cells, kBuffers, part, "clipped Voronoi cells");
}

}  // namespace

flaunay_status flaunay_voronoi_clip(flaunay_triangulator* triangulator, const double* coordinates, size_t n,
                                    const flaunay_triangulation* triangulation, const double* corners,
                                    size_t corner_count, flaunay_clipped_voronoi** cells) {
  return create(cells, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const Triangulation& primal = required(triangulation, "the triangulation").cpp;
    return std::make_unique<flaunay_clipped_voronoi>(
        flaunay_clipped_voronoi{cpp.clipped_voronoi(coordinates, n, primal, corners, corner_count)});
  });
}

void flaunay_clipped_voronoi_destroy(flaunay_clipped_voronoi* cells) { delete cells; }

size_t flaunay_clipped_voronoi_point_count(const flaunay_clipped_voronoi* cells) {
  return read(cells, [](const auto& handle) { return handle.cpp.areas.size(); });
}

size_t flaunay_clipped_voronoi_vertex_count(const flaunay_clipped_voronoi* cells) {
  return read(cells, [](const auto& handle) { return handle.cpp.vertices.size() / 2; });
}

#define ACCESSOR(type, name, ...)                                                        \
  const type* flaunay_clipped_voronoi_##name(const flaunay_clipped_voronoi* cells) {     \
    return read(cells, [](const auto& handle) { return c::elements(handle.cpp.name); }); \
  }
FLAUNAY_CLIPPED_VORONOI_ARRAYS(ACCESSOR)
#undef ACCESSOR

FLAUNAY_DEVICE_RESULT(clipped_voronoi, "the clipped cells")

size_t flaunay_device_clipped_voronoi_vertex_count(const flaunay_device_clipped_voronoi* cells) {
  return read(cells, [](const auto& handle) { return handle.cpp.vertex_count; });
}

flaunay_status flaunay_voronoi_clip_device(flaunay_triangulator* triangulator,
                                           const flaunay_device_points* points,
                                           const flaunay_device_triangulation* triangulation,
                                           const double* corners, size_t corner_count,
                                           const flaunay_enqueue* enqueue,
                                           flaunay_device_clipped_voronoi* result) {
  return guarded([&] {
    const Enqueue queued = c::to_enqueue(enqueue);
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const DeviceTriangulation& primal = required(triangulation, "the triangulation").cpp;
    cpp.clipped_voronoi(c::to_points(points), primal, corners, corner_count,
                        required(result, "the result").cpp, queued);
  });
}

flaunay_status flaunay_relax(flaunay_triangulator* triangulator, const double* coordinates, size_t n,
                             const double* corners, size_t corner_count, size_t iterations, double* relaxed) {
  return guarded([&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    check_points(coordinates, n);
    check_array(relaxed, n, "relaxed points");
    c::copy_to(relaxed, cpp.relax(coordinates, n, corners, corner_count, iterations), "relaxed points");
  });
}

flaunay_status flaunay_relax_device(flaunay_triangulator* triangulator, const flaunay_device_points* points,
                                    const double* corners, size_t corner_count, size_t iterations,
                                    const flaunay_enqueue* enqueue, cl_mem* relaxed) {
  return guarded([&] {
    const Enqueue queued = c::to_enqueue(enqueue);
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    DeviceBuffer buffer = c::to_buffer(required(relaxed, "the pointer to the buffer of relaxed points"));
    cpp.relax(c::to_points(points), corners, corner_count, iterations, buffer, queued);
    c::give(buffer, *relaxed);
  });
}
