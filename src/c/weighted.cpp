// The C interface to weighted points.
#include "flaunay/weighted.hpp"

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

struct flaunay_weighted {
  WeightedTriangulation cpp;
  std::vector<std::size_t> offsets;
};

flaunay_status flaunay_weighted_create(flaunay_triangulator* triangulator, const double* points,
                                       const double* weights, size_t n, const size_t* offsets, size_t sets,
                                       flaunay_weighted** weighted) {
  return create(weighted, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    Options options;
    options.neighbors = true;
    std::vector<std::size_t> all = c::to_offsets(offsets, sets, n);
    WeightedTriangulation mesh = triangulate_weighted(cpp, points, weights, all, options);
    return std::make_unique<flaunay_weighted>(flaunay_weighted{std::move(mesh), std::move(all)});
  });
}

void flaunay_weighted_destroy(flaunay_weighted* weighted) { delete weighted; }

#define WEIGHTED_COUNT(name, count)                                                       \
  size_t flaunay_weighted_##name##_count(const flaunay_weighted* weighted) {              \
    return read(weighted, [](const auto& handle) -> size_t { return handle.cpp.count; }); \
  }
WEIGHTED_COUNT(point, representatives.size())
WEIGHTED_COUNT(triangle, triangles.size() / 3)
WEIGHTED_COUNT(hull_vertex, hull.size())
WEIGHTED_COUNT(hidden, hidden.size())
#undef WEIGHTED_COUNT

#define ACCESSOR(type, name)                                                                \
  const type* flaunay_weighted_##name(const flaunay_weighted* weighted) {                   \
    return read(weighted, [](const auto& handle) { return c::elements(handle.cpp.name); }); \
  }
ACCESSOR(int32_t, triangles)
ACCESSOR(int32_t, neighbors)
ACCESSOR(int32_t, hull)
ACCESSOR(int32_t, representatives)
ACCESSOR(int32_t, hidden)
ACCESSOR(size_t, triangle_offsets)
ACCESSOR(size_t, hull_offsets)
#undef ACCESSOR

flaunay_status flaunay_weighted_hiding_triangles(flaunay_triangulator* triangulator,
                                                 const flaunay_weighted* weighted, const double* points,
                                                 int32_t* triangles) {
  return guarded([&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
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
  return create(cells, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const WeightedTriangulation& mesh = required(weighted, "the triangulation").cpp;
    return std::make_unique<flaunay_clipped_voronoi>(flaunay_clipped_voronoi{
        power_cells(cpp, points, weights, mesh.representatives.size(), mesh, corners, corner_count)});
  });
}
