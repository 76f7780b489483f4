// The C interface to Voronoi diagrams.

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"

using namespace flaunay;

using c::required;

FLAUNAY_DESTROY(voronoi)
FLAUNAY_HANDLE(device_voronoi, DeviceVoronoi)

flaunay_status flaunay_voronoi_compute(flaunay_triangulator* triangulator, const double* coordinates,
                                       size_t n, const flaunay_triangulation* triangulation,
                                       flaunay_voronoi** voronoi) {
  return c::make(triangulator, voronoi, [&](Triangulator& cpp) {
    const Triangulation& primal = required(triangulation, "the triangulation").plain();
    return primal.space.kind == SpaceKind::sphere ? cpp.voronoi(primal) : cpp.voronoi(coordinates, n, primal);
  });
}

FLAUNAY_ACCESSOR(size_t, voronoi, point_count, handle.cpp.cell_offsets.size() - 1)
FLAUNAY_ACCESSOR(size_t, voronoi, triangle_count,
                 handle.cpp.circumcentres.size() / (handle.cpp.areas.empty() ? 2 : 3))
FLAUNAY_ACCESSOR(size_t, voronoi, corner_count, handle.cpp.cells.size())
#define ARRAY(type, name, ...) FLAUNAY_ACCESSOR(const type*, voronoi, name, c::elements(handle.cpp.name))
FLAUNAY_VORONOI_ARRAYS(ARRAY)
ARRAY(double, areas)
#undef ARRAY

FLAUNAY_DEVICE_RESULT(voronoi, flaunay_voronoi_part, FLAUNAY_VORONOI_ARRAYS, "the Voronoi diagram",
                      "a Voronoi diagram")

flaunay_status flaunay_voronoi_compute_device(flaunay_triangulator* triangulator,
                                              const flaunay_device_points* points,
                                              const flaunay_device_triangulation* triangulation,
                                              const flaunay_enqueue* enqueue,
                                              flaunay_device_voronoi* result) {
  return c::with(triangulator, enqueue, [&](Triangulator& cpp, const Enqueue& queued) {
    const DeviceTriangulation& primal = required(triangulation, "the triangulation").cpp;
    cpp.voronoi(c::to_points(points), primal, required(result, "the result").cpp, queued);
  });
}
