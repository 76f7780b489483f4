// The C interface to Voronoi diagrams.
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

struct flaunay_voronoi {
  Voronoi cpp;
};

struct flaunay_device_voronoi {
  DeviceVoronoi cpp;
};

namespace {

template <c::Is<DeviceVoronoi> Result>
auto& buffer_of(Result& voronoi, unsigned part) {
#define BUFFER(type, name, ...) &DeviceVoronoi::name,
  static constexpr std::array kBuffers = {FLAUNAY_VORONOI_ARRAYS(BUFFER)};
#undef BUFFER
  return c::buffer_of(voronoi, kBuffers, part, "a Voronoi diagram");
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

#define ACCESSOR(type, name, ...)                                                          \
  const type* flaunay_voronoi_##name(const flaunay_voronoi* voronoi) {                     \
    return read(voronoi, [](const auto& handle) { return c::elements(handle.cpp.name); }); \
  }
FLAUNAY_VORONOI_ARRAYS(ACCESSOR)
#undef ACCESSOR

FLAUNAY_DEVICE_RESULT(voronoi, "the Voronoi diagram")

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
