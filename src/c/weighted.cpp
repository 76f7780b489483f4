// The C interface to weighted points.
#include "flaunay/weighted.hpp"

#include <vector>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/verify.hpp"

using namespace flaunay;

using c::required;

struct flaunay_weighted {
  WeightedTriangulation cpp;
  std::vector<std::size_t> offsets;
};

flaunay_status flaunay_weighted_create(flaunay_triangulator* triangulator, const double* points,
                                       const double* weights, size_t n, const size_t* offsets, size_t sets,
                                       flaunay_weighted** weighted) {
  return c::make(triangulator, weighted, [&](Triangulator& cpp) {
    Options options;
    options.neighbors = true;
    std::vector<std::size_t> all = c::to_offsets(offsets, sets, n);
    WeightedTriangulation mesh = triangulate_weighted(cpp, points, weights, all, options);
    return flaunay_weighted{std::move(mesh), std::move(all)};
  });
}

FLAUNAY_DESTROY(weighted)
FLAUNAY_ACCESSOR(size_t, weighted, point_count, handle.cpp.representatives.size())
FLAUNAY_ACCESSOR(size_t, weighted, triangle_count, handle.cpp.triangles.size() / 3)
FLAUNAY_ACCESSOR(size_t, weighted, hull_vertex_count, handle.cpp.hull.size())
FLAUNAY_ACCESSOR(size_t, weighted, hidden_count, handle.cpp.hidden.size())
#define ARRAY(type, name, ...) FLAUNAY_ACCESSOR(const type*, weighted, name, c::elements(handle.cpp.name))
FLAUNAY_WEIGHTED_ARRAYS(ARRAY)
ARRAY(size_t, triangle_offsets)
ARRAY(size_t, hull_offsets)
#undef ARRAY

flaunay_status flaunay_weighted_hiding_triangles(flaunay_triangulator* triangulator,
                                                 const flaunay_weighted* weighted, const double* points,
                                                 int32_t* triangles) {
  return c::with(triangulator, [&](Triangulator& cpp) {
    const flaunay_weighted& mesh = required(weighted, "the triangulation");
    c::copy_to(triangles, hiding_triangles(cpp, points, mesh.offsets, mesh.cpp), "results");
  });
}

flaunay_status flaunay_weighted_verify(const flaunay_weighted* weighted, const double* points,
                                       const double* weights) {
  return c::verified([&] {
    const flaunay_weighted& mesh = required(weighted, "the triangulation");
    return verify(points, weights, mesh.offsets, mesh.cpp);
  });
}

flaunay_status flaunay_weighted_cells(flaunay_triangulator* triangulator, const flaunay_weighted* weighted,
                                      const double* points, const double* weights, const double* corners,
                                      size_t corner_count, flaunay_clipped_voronoi** cells) {
  return c::make(triangulator, cells, [&](Triangulator& cpp) {
    const WeightedTriangulation& mesh = required(weighted, "the triangulation").cpp;
    return power_cells(cpp, points, weights, mesh.representatives.size(), mesh, corners, corner_count);
  });
}
