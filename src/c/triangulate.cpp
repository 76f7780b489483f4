// The C interface to devices, triangulators and triangulations.
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

Triangulation triangulate_in(Triangulator& cpp, const double* coordinates,
                             const std::vector<std::size_t>& offsets, const Space& space,
                             const research::Options& options) {
  expect(options.mode == research::Mode::blocks, "spaces and weights are for mode blocks alone");
  return cpp.triangulate(coordinates, offsets, space, static_cast<const Options&>(options));
}
Triangulation triangulate_in(Triangulator&, const float*, const std::vector<std::size_t>&, const Space&,
                             const research::Options&) {
  throw Error(ErrorKind::usage, "points in single precision lie in the plane: flaunay_options.space");
}

template <typename Coordinate>
flaunay_status triangulate(flaunay_triangulator* triangulator, const Coordinate* coordinates, size_t n,
                           const size_t* offsets, size_t sets, const flaunay_options* options,
                           flaunay_triangulation** result) {
  return c::make(triangulator, result, [&](Triangulator& cpp) {
    const std::vector<std::size_t> all = c::to_offsets(offsets, sets, n);
    const research::Options wanted = c::to_options(options, true);
    if (options != nullptr && options->space != nullptr)
      return triangulate_in(cpp, coordinates, all, c::to_space(options->space), wanted);
    // The paper's modes have a call of their own, which refuses options that do not go together.
    const bool is_plain =
        wanted.mode == research::Mode::blocks && wanted.hull != research::Hull::monotone_chain;
    return is_plain ? cpp.triangulate(coordinates, all, static_cast<const Options&>(wanted))
                    : research::triangulate(cpp, coordinates, all, wanted);
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

FLAUNAY_DESTROY(device_list)
FLAUNAY_ACCESSOR(size_t, device_list, count, handle.views.size())

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

FLAUNAY_DESTROY(triangulator)
FLAUNAY_ACCESSOR(const flaunay_device_info*, triangulator, device, handle.device())
FLAUNAY_ACCESSOR(cl_context, triangulator, context, handle.cpp.context())
FLAUNAY_ACCESSOR(cl_device_id, triangulator, device_id, handle.cpp.device_id())
FLAUNAY_ACCESSOR(cl_command_queue, triangulator, queue, handle.cpp.queue())
FLAUNAY_ACCESSOR(size_t, triangulator, capacity, handle.cpp.capacity())

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

FLAUNAY_DESTROY(triangulation)
FLAUNAY_ACCESSOR(const flaunay_mesh*, triangulation, mesh, &handle.view)

FLAUNAY_DESTROY(device_triangulation)
#define ARRAYS(X) FLAUNAY_TRIANGULATION_ARRAYS(X) FLAUNAY_SPACE_ARRAYS(X) FLAUNAY_DEVICE_ARRAYS(X)
FLAUNAY_DEVICE_RESULT(triangulation, flaunay_part, ARRAYS, "the triangulation", "a triangulation")
#undef ARRAYS
FLAUNAY_ACCESSOR(unsigned, device_triangulation, parts, c::to_bits(handle.cpp.parts))
FLAUNAY_ACCESSOR(const flaunay_mesh*, device_triangulation, mesh, &handle.view)
FLAUNAY_ACCESSOR(size_t, device_triangulation, constraint_count, handle.cpp.constraint_count)

flaunay_status flaunay_triangulate_device(flaunay_triangulator* triangulator,
                                          const flaunay_device_points* points, unsigned parts,
                                          const flaunay_enqueue* enqueue,
                                          flaunay_device_triangulation* result) {
  return c::with(triangulator, enqueue, [&](Triangulator& cpp, const Enqueue& queued) {
    flaunay_device_triangulation& handle = required(result, "the result");
    handle.clear();
    cpp.triangulate(c::to_points(points), handle.cpp, c::to_parts(parts), queued);
    handle.show();
  });
}
