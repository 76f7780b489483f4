// The C interface to Voronoi diagrams, their clipped cells, and relaxation.

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"

using namespace flaunay;

using c::required;

FLAUNAY_DESTROY(voronoi)
FLAUNAY_HANDLE(device_voronoi, DeviceVoronoi)
FLAUNAY_DESTROY(clipped_voronoi)
FLAUNAY_HANDLE(device_clipped_voronoi, DeviceClippedVoronoi)

flaunay_status flaunay_voronoi_compute(flaunay_triangulator* triangulator, const double* coordinates,
                                       size_t n, const flaunay_triangulation* triangulation,
                                       flaunay_voronoi** voronoi) {
  return c::make(triangulator, voronoi, [&](Triangulator& cpp) {
    const Triangulation& primal = required(triangulation, "the triangulation").plain();
    return cpp.voronoi(coordinates, n, primal);
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

// ---- Clipped cells and relaxation

flaunay_status flaunay_voronoi_clip(flaunay_triangulator* triangulator, const double* coordinates,
                                    const double* weights, size_t n,
                                    const flaunay_triangulation* triangulation, const double* corners,
                                    size_t corner_count, flaunay_clipped_voronoi** cells) {
  return c::make(triangulator, cells, [&](Triangulator& cpp) {
    const Triangulation& primal = required(triangulation, "the triangulation").plain();
    return cpp.clipped_voronoi(coordinates, weights, n, primal, corners, corner_count);
  });
}

FLAUNAY_ACCESSOR(size_t, clipped_voronoi, point_count, handle.cpp.areas.size())
FLAUNAY_ACCESSOR(size_t, clipped_voronoi, vertex_count, handle.cpp.vertices.size() / 2)
#define ARRAY(type, name, ...) \
  FLAUNAY_ACCESSOR(const type*, clipped_voronoi, name, c::elements(handle.cpp.name))
FLAUNAY_CLIPPED_VORONOI_ARRAYS(ARRAY)
#undef ARRAY

flaunay_status flaunay_join_cells(const double* vertices, size_t v, const int32_t* offsets, size_t n,
                                  const int32_t* groups, size_t group_count, const double* bounds,
                                  size_t bound_count, int32_t* corners, int32_t* ring_offsets,
                                  int32_t* part_offsets, int32_t* group_offsets) {
  return c::guarded([&] {
    check_array(vertices, v, "vertices of cells");
    check_array(groups, n, "groups of points");
    check_count(group_count, "groups");
    check_array(bounds, bound_count, "corners of the bounds");
    check_array(corners, v, "corners");
    check_array(ring_offsets, v / 3 + 1, "ring_offsets");
    check_array(part_offsets, v / 3 + 1, "part_offsets");
    check_array(group_offsets, group_count + 1, "group_offsets");
    const JoinedCells joined =
        join_cells({c::copied(vertices, 2 * v, "vertices"), c::copied(offsets, n + 1, "offsets"), {}, {}},
                   c::copied(groups, n, "groups"), group_count, c::copied(bounds, 2 * bound_count, "bounds"));
#define COPY(name) std::copy(joined.name.begin(), joined.name.end(), name);
    COPY(corners) COPY(ring_offsets) COPY(part_offsets) COPY(group_offsets)
#undef COPY
  });
}

FLAUNAY_DEVICE_RESULT(clipped_voronoi, flaunay_clipped_voronoi_part, FLAUNAY_CLIPPED_VORONOI_ARRAYS,
                      "the clipped cells", "clipped Voronoi cells")
FLAUNAY_ACCESSOR(size_t, device_clipped_voronoi, vertex_count, handle.cpp.vertex_count)

flaunay_status flaunay_voronoi_clip_device(flaunay_triangulator* triangulator,
                                           const flaunay_device_points* points,
                                           const flaunay_device_triangulation* triangulation,
                                           const double* corners, size_t corner_count,
                                           const flaunay_enqueue* enqueue,
                                           flaunay_device_clipped_voronoi* result) {
  return c::with(triangulator, enqueue, [&](Triangulator& cpp, const Enqueue& queued) {
    const DeviceTriangulation& primal = required(triangulation, "the triangulation").cpp;
    cpp.clipped_voronoi(c::to_points(points), primal, corners, corner_count,
                        required(result, "the result").cpp, queued);
  });
}

flaunay_status flaunay_relax(flaunay_triangulator* triangulator, const double* points, size_t n,
                             const flaunay_space* space, const double* corners, size_t corner_count,
                             size_t iterations, double* relaxed) {
  return c::with(triangulator, [&](Triangulator& cpp) {
    check_points(points, n);
    check_array(relaxed, n, "relaxed points");
    c::copy_to(relaxed, cpp.relax(points, n, c::to_space(space), iterations, corners, corner_count),
               "relaxed points");
  });
}

flaunay_status flaunay_relax_device(flaunay_triangulator* triangulator, const flaunay_device_points* points,
                                    const double* corners, size_t corner_count, size_t iterations,
                                    const flaunay_enqueue* enqueue, cl_mem* relaxed) {
  return c::with(triangulator, enqueue, [&](Triangulator& cpp, const Enqueue& queued) {
    DeviceBuffer buffer = c::to_buffer(required(relaxed, "the pointer to the buffer of relaxed points"));
    cpp.relax(c::to_points(points), corners, corner_count, iterations, buffer, queued);
    c::give(buffer, *relaxed);
  });
}
