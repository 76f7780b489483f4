// The C interface to triangulations that change.
#include "flaunay/dynamic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"

using namespace flaunay;

using c::create;
using c::elements;
using c::guarded;
using c::read;
using c::required;

struct flaunay_dynamic {
  explicit flaunay_dynamic(DynamicTriangulation made) : cpp(std::move(made)) {}

  void show(Changes made) {
    changes = std::move(made);
    c::show<"representative_count", "removed_count", "made_count">(changes, view);
    view.representative_count = changes.representatives.size();
    view.removed_count = changes.removed.size();
    view.made_count = changes.made.size();
  }

  DynamicTriangulation cpp;
  Changes changes;
  flaunay_changes view{};
  LivingConstraints constraints;
  flaunay_living_constraints constraints_view{};
};

FLAUNAY_DESTROY(dynamic)

namespace {

constexpr const char* kName = "the triangulation";

Options to_plain_options(const flaunay_options* options) {
  const research::Options all = c::to_options(options);
  if (all.mode != research::Mode::blocks) {
    throw Error(ErrorKind::usage, fmt::format("mode {} has no triangulations that change; mode {} has",
                                              to_string(all.mode), to_string(research::Mode::blocks)));
  }
  return all;
}

// work(triangulation) returns the changes.
template <typename Work>
flaunay_status change(flaunay_dynamic* dynamic, const Work& work) {
  return guarded([&] {
    flaunay_dynamic& handle = required(dynamic, kName);
    handle.show(work(handle.cpp));
  });
}

}  // namespace

flaunay_status flaunay_dynamic_create(flaunay_triangulator* triangulator, const double* coordinates, size_t n,
                                      const flaunay_constraints* constraints, const flaunay_options* options,
                                      flaunay_dynamic** dynamic) {
  return c::make(triangulator, dynamic, [&](Triangulator& cpp) {
    if (constraints == nullptr) {
      return DynamicTriangulation(cpp, coordinates, n, to_plain_options(options));
    }
    const auto asked = c::to_constraints(*constraints, 1, options);
    return DynamicTriangulation(cpp, coordinates, n, asked, asked);
  });
}

flaunay_status flaunay_dynamic_create_device(flaunay_triangulator* triangulator,
                                             const flaunay_device_points* points,
                                             const flaunay_options* options, flaunay_dynamic** dynamic) {
  return c::make(triangulator, dynamic, [&](Triangulator& cpp) {
    return DynamicTriangulation(cpp, c::to_points(points), to_plain_options(options));
  });
}

flaunay_status flaunay_dynamic_insert(flaunay_dynamic* dynamic, const double* coordinates, size_t m) {
  return change(dynamic, [&](DynamicTriangulation& cpp) { return cpp.insert(coordinates, m); });
}

flaunay_status flaunay_dynamic_insert_device(flaunay_dynamic* dynamic, const flaunay_device_points* points) {
  return change(dynamic, [&](DynamicTriangulation& cpp) { return cpp.insert(c::to_points(points)); });
}

flaunay_status flaunay_dynamic_remove(flaunay_dynamic* dynamic, const int32_t* points, size_t m) {
  return change(dynamic, [&](DynamicTriangulation& cpp) { return cpp.remove(points, m); });
}

flaunay_status flaunay_dynamic_move(flaunay_dynamic* dynamic, const int32_t* points,
                                    const double* coordinates, size_t m) {
  return change(dynamic, [&](DynamicTriangulation& cpp) { return cpp.move(points, coordinates, m); });
}

FLAUNAY_ACCESSOR(const flaunay_changes*, dynamic, changes, &handle.view)
FLAUNAY_ACCESSOR(size_t, dynamic, numbers, handle.cpp.numbers())
FLAUNAY_ACCESSOR(size_t, dynamic, point_count, handle.cpp.point_count())
FLAUNAY_ACCESSOR(size_t, dynamic, triangle_count, handle.cpp.triangle_count())
FLAUNAY_ACCESSOR(size_t, dynamic, row_count, handle.cpp.row_count())

int flaunay_dynamic_has_point(const flaunay_dynamic* dynamic, size_t number) {
  return read(dynamic, [&](const auto& handle) { return static_cast<int>(handle.cpp.has_point(number)); });
}

flaunay_status flaunay_dynamic_coordinates(const flaunay_dynamic* dynamic, double* coordinates) {
  return guarded([&] { c::copy_to(coordinates, required(dynamic, kName).cpp.coordinates(), "coordinates"); });
}

flaunay_status flaunay_dynamic_rows(flaunay_dynamic* dynamic, int32_t* triangles, int32_t* neighbors) {
  return guarded([&] {
    const TriangleRows all = required(dynamic, kName).cpp.rows();
    if (triangles != nullptr) std::copy(all.triangles.begin(), all.triangles.end(), triangles);
    if (neighbors != nullptr) std::copy(all.neighbors.begin(), all.neighbors.end(), neighbors);
  });
}

flaunay_status flaunay_dynamic_triangulation(flaunay_dynamic* dynamic, flaunay_triangulation** result) {
  return create(result, [&] {
    return std::make_unique<flaunay_triangulation>(required(dynamic, kName).cpp.triangulation());
  });
}

const flaunay_living_constraints* flaunay_dynamic_constraints(flaunay_dynamic* dynamic) {
  const flaunay_living_constraints* found = nullptr;
  guarded([&] {
    flaunay_dynamic& handle = required(dynamic, kName);
    handle.constraints = handle.cpp.constraints();
    handle.constraints_view = {handle.constraints.segments.size(), elements(handle.constraints.edges),
                               elements(handle.constraints.segments)};
    found = &handle.constraints_view;
  });
  return found;
}

flaunay_status flaunay_dynamic_rows_device(flaunay_dynamic* dynamic, const flaunay_enqueue* enqueue,
                                           flaunay_device_triangulation* result) {
  return guarded([&] {
    const Enqueue queued = c::to_enqueue(enqueue);
    DynamicTriangulation& cpp = required(dynamic, kName).cpp;
    flaunay_device_triangulation& handle = required(result, "the result");
    handle.clear();
    cpp.rows(handle.cpp, queued);
    handle.show();
  });
}
