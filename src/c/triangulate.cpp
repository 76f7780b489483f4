// The C interface to devices, triangulators and triangulations.
#include <array>
#include <memory>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"
#include "host/opencl/loader.hpp"

using namespace flaunay;

// These keep the promises of the interface about null handles, exceptions and new handles.
using c::create;
using c::guarded;
using c::read;
using c::required;

namespace {

template <typename Coordinate>
flaunay_status triangulate(flaunay_triangulator* triangulator, const Coordinate* coordinates, size_t n,
                           const size_t* offsets, size_t sets, const flaunay_options* options,
                           flaunay_triangulation** result) {
  return create(result, [&] {
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    const std::vector<std::size_t> all = c::to_offsets(offsets, sets, n);
    const research::Options wanted = c::to_options(options);
    // What is about the paper's modes has a call of its own, which refuses what does not go together.
    const bool is_plain =
        wanted.mode == research::Mode::blocks && wanted.hull != research::Hull::monotone_chain;
    return std::make_unique<flaunay_triangulation>(
        is_plain ? cpp.triangulate(coordinates, all, static_cast<const Options&>(wanted))
                 : research::triangulate(cpp, coordinates, all, wanted));
  });
}

const std::vector<flaunay_mode_info>& modes() {
  // Never destroyed, like those of list_modes.
  static const auto& infos = *new std::vector<flaunay_mode_info>([] {
    std::vector<flaunay_mode_info> all;
    for (const research::ModeInfo& mode : research::list_modes()) {
      all.push_back({static_cast<int>(mode.mode), mode.name, mode.description, mode.on_host});
    }
    return all;
  }());
  return infos;
}

template <c::Is<DeviceTriangulation> Result>
auto& buffer_of(Result& triangulation, unsigned part) {
#define BUFFER(type, name, ...) &DeviceTriangulation::name,
  static constexpr std::array kBuffers = {FLAUNAY_TRIANGULATION_ARRAYS(BUFFER)};
#undef BUFFER
  return c::buffer_of(triangulation, kBuffers, part, "a triangulation");
}

}  // namespace

struct flaunay_device_list {
  explicit flaunay_device_list(std::vector<DeviceInfo> found) : infos(std::move(found)) {
    for (const DeviceInfo& info : infos) views.push_back(c::view_of(info));
  }
  std::vector<DeviceInfo> infos;
  std::vector<flaunay_device_info> views;
};

const char* flaunay_version(void) { return version(); }

flaunay_status flaunay_device_list_create(int self_test, flaunay_device_list** list) {
  return create(list, [&] { return std::make_unique<flaunay_device_list>(list_devices(self_test != 0)); });
}

flaunay_status flaunay_add_driver(const char* platform, const char* path) {
  return guarded([&] {
    host::add_driver(&required(platform, "the platform's name"), &required(path, "the path of the driver"));
  });
}

void flaunay_device_list_destroy(flaunay_device_list* list) { delete list; }

size_t flaunay_device_list_count(const flaunay_device_list* list) {
  return read(list, [](const auto& handle) { return handle.views.size(); });
}

const flaunay_device_info* flaunay_device_list_at(const flaunay_device_list* list, size_t k) {
  return read(list, [&](const auto& handle) { return k < handle.views.size() ? &handle.views[k] : nullptr; });
}

flaunay_status flaunay_triangulator_create(const char* device, flaunay_triangulator** triangulator) {
  return create(triangulator, [&] {
    return std::make_unique<flaunay_triangulator>(Triangulator(device != nullptr ? device : ""));
  });
}

flaunay_status flaunay_triangulator_create_in_context(cl_context context, cl_device_id device,
                                                      flaunay_triangulator** triangulator) {
  return create(triangulator,
                [&] { return std::make_unique<flaunay_triangulator>(Triangulator(context, device)); });
}

void flaunay_triangulator_destroy(flaunay_triangulator* triangulator) { delete triangulator; }

const flaunay_device_info* flaunay_triangulator_device(const flaunay_triangulator* triangulator) {
  return read(triangulator, [](const auto& handle) { return handle.device(); });
}

cl_context flaunay_triangulator_context(const flaunay_triangulator* triangulator) {
  return read(triangulator, [](const auto& handle) { return handle.cpp.context(); });
}

cl_device_id flaunay_triangulator_device_id(const flaunay_triangulator* triangulator) {
  return read(triangulator, [](const auto& handle) { return handle.cpp.device_id(); });
}

cl_command_queue flaunay_triangulator_queue(const flaunay_triangulator* triangulator) {
  return read(triangulator, [](const auto& handle) { return handle.cpp.queue(); });
}

size_t flaunay_triangulator_capacity(const flaunay_triangulator* triangulator) {
  return read(triangulator, [](const auto& handle) { return handle.cpp.capacity(); });
}

flaunay_status flaunay_triangulator_workspace_bytes(const flaunay_triangulator* triangulator, size_t n,
                                                    size_t sets, size_t* bytes) {
  return guarded([&] {
    required(bytes, "the pointer to the number of bytes") = 0;
    *bytes = required(triangulator, "the triangulator").cpp.workspace_bytes(n, sets);
  });
}

flaunay_status flaunay_triangulator_use_workspace(flaunay_triangulator* triangulator, cl_mem workspace) {
  return guarded([&] { required(triangulator, "the triangulator").cpp.use_workspace(workspace); });
}

size_t flaunay_mode_count(void) { return research::list_modes().size(); }

const flaunay_mode_info* flaunay_mode_at(size_t k) {
  const flaunay_mode_info* found = nullptr;
  guarded([&] { found = k < modes().size() ? &modes()[k] : nullptr; });
  return found;
}

flaunay_status flaunay_triangulate(flaunay_triangulator* triangulator, const double* coordinates, size_t n,
                                   const size_t* offsets, size_t sets, const flaunay_options* options,
                                   flaunay_triangulation** result) {
  return triangulate(triangulator, coordinates, n, offsets, sets, options, result);
}

flaunay_status flaunay_triangulate_float(flaunay_triangulator* triangulator, const float* coordinates,
                                         size_t n, const size_t* offsets, size_t sets,
                                         const flaunay_options* options, flaunay_triangulation** result) {
  return triangulate(triangulator, coordinates, n, offsets, sets, options, result);
}

flaunay_status flaunay_triangulate_on_host(const double* coordinates, size_t n, const size_t* offsets,
                                           size_t sets, const flaunay_options* options,
                                           flaunay_triangulation** result) {
  return create(result, [&] {
    return std::make_unique<flaunay_triangulation>(
        research::triangulate_on_host(coordinates, c::to_offsets(offsets, sets, n), c::to_options(options)));
  });
}

void flaunay_triangulation_destroy(flaunay_triangulation* triangulation) { delete triangulation; }

#define ACCESSOR(type, name)                                                         \
  type flaunay_triangulation_##name(const flaunay_triangulation* triangulation) {    \
    return read(triangulation, [](const auto& handle) { return handle.view.name; }); \
  }
#define ARRAY(type, name, ...) ACCESSOR(const type*, name)
ACCESSOR(size_t, point_count)
ACCESSOR(size_t, set_count)
ACCESSOR(size_t, triangle_count)
ACCESSOR(size_t, hull_count)
FLAUNAY_TRIANGULATION_ARRAYS(ARRAY)
ACCESSOR(const size_t*, triangle_offsets)
ACCESSOR(const size_t*, hull_offsets)
ACCESSOR(const flaunay_statistics*, statistics)
#undef ARRAY
#undef ACCESSOR

const flaunay_mesh* flaunay_triangulation_mesh(const flaunay_triangulation* triangulation) {
  return read(triangulation, [](const auto& handle) { return &handle.view; });
}

FLAUNAY_DEVICE_RESULT(triangulation, "the triangulation")

#define ACCESSOR(type, name, value)                                                             \
  type flaunay_device_triangulation_##name(const flaunay_device_triangulation* triangulation) { \
    return read(triangulation, [](const auto& handle) { return value; });                       \
  }
ACCESSOR(unsigned, parts, c::to_bits(handle.cpp.parts))
ACCESSOR(size_t, point_count, handle.cpp.points)
ACCESSOR(size_t, set_count, c::set_count(handle.cpp.point_offsets))
ACCESSOR(size_t, triangle_count, c::total(handle.cpp.triangle_offsets))
ACCESSOR(size_t, hull_count, c::total(handle.cpp.hull_offsets))
ACCESSOR(const size_t*, point_offsets, c::elements(handle.cpp.point_offsets))
ACCESSOR(const size_t*, triangle_offsets, c::elements(handle.cpp.triangle_offsets))
ACCESSOR(const size_t*, hull_offsets, c::elements(handle.cpp.hull_offsets))
ACCESSOR(const flaunay_statistics*, statistics, handle.statistics.get())
#undef ACCESSOR

flaunay_status flaunay_triangulate_device(flaunay_triangulator* triangulator,
                                          const flaunay_device_points* points, unsigned parts,
                                          const flaunay_enqueue* enqueue,
                                          flaunay_device_triangulation* result) {
  return guarded([&] {
    const Enqueue queued = c::to_enqueue(enqueue);
    Triangulator& cpp = required(triangulator, "the triangulator").cpp;
    flaunay_device_triangulation& handle = required(result, "the result");
    // The view refers to statistics that the call replaces.
    handle.statistics.clear();
    cpp.triangulate(c::to_points(points), handle.cpp, c::to_parts(parts), queued);
    handle.statistics.show(handle.cpp.statistics);
  });
}
