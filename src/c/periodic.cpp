// The C interface to points on a torus.
#include "flaunay/periodic.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"

using namespace flaunay;

using c::create;
using c::guarded;
using c::read;
using c::required;

struct flaunay_periodic {
  PeriodicTriangulation cpp;
  Period period;
};

flaunay_status flaunay_periodic_create(flaunay_triangulator* triangulator, const double* points, size_t n,
                                       const size_t* offsets, size_t sets, double period_x, double period_y,
                                       flaunay_periodic** periodic) {
  return create(periodic, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const Period period{period_x, period_y};
    return std::make_unique<flaunay_periodic>(
        flaunay_periodic{triangulate_periodic(cpp, points, c::to_offsets(offsets, sets, n), period), period});
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

flaunay_status flaunay_periodic_cell_areas(const flaunay_periodic* periodic, double* areas) {
  return guarded([&] {
    const flaunay_periodic& mesh = required(periodic, "the triangulation");
    const std::vector<double> all = periodic_cell_areas(mesh.cpp, mesh.period);
    if (!all.empty()) std::copy(all.begin(), all.end(), &required(areas, "the room for areas"));
  });
}
