#include "space/triangulate.hpp"

#include <algorithm>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include "blocks/run.hpp"
#include "blocks/small.hpp"
#include "call/groups.hpp"
#include "host/clock.hpp"
#include "host/opencl/device.hpp"
#include "launchers/call/areas.cl.hpp"
#include "predicates/rounded_area.h"
#include "tuning/tuning.hpp"

namespace flaunay::call {

using host::Arena;

namespace {

// The arrays of a triangulation, in host or in device memory.
class Arrays {
 public:
  template <typename Result>
  Arrays(Frame& call, const Parts& wanted, std::size_t n, Result& result)
      : points_(n), rows_(most_rows_of(n)) {
    const auto make = [&](bool is_wanted, auto& to, std::size_t most, const char* what) {
      return is_wanted && n > 0 ? call.output<cl_int>(to, most, what) : Output<cl_int>();
    };
    triangles_ = make(wanted.triangles, result.triangles, rows_, "triangles");
    neighbors_ = make(wanted.neighbors, result.neighbors, rows_, "neighbors");
    halfedges_ = make(wanted.halfedges, result.halfedges, rows_, "halfedges");
    hull_ = make(wanted.hull, result.hull, n, "hull");
    representatives = make(wanted.representatives, result.representatives, n, "representatives");
    if (wanted.areas && n > 0) areas = call.output<cl_double>(result.areas, rows_ / 3, "areas");
  }

  bool have_links() const { return neighbors_.is_wanted() || halfedges_.is_wanted(); }
  // Makes room for results while the device computes; for many results of a device by a thread per array,
  // since the system takes longer for so much new memory than a GPU computes.
  void reserve(const host::Runtime& runtime) {
    constexpr std::size_t kWorthAThread = std::size_t{1} << 20;
    const auto make_room = [&](const Output<cl_int>& array, std::size_t count) {
      if (!array.is_in_host_memory()) return;
      if (runtime.is_native() || rows_ < kWorthAThread) return array.reserve(count);
      reserving_.push_back(std::async([&array, count] { array.reserve(count); }));
    };
    for (const auto* array : {&triangles_, &neighbors_, &halfedges_}) make_room(*array, rows_);
    if (runtime.sizes().in_host_memory == 0) make_room(representatives, points_);
  }
  // Waits for threads that make room, or does what they could not begin.
  void await_room() {
    for (auto& each : std::exchange(reserving_, {})) each.get();
  }
  // After mesh() for an upper bound.
  void trim(const blocks::MeshSizes& sizes) {
    for (const auto* array : {&triangles_, &neighbors_, &halfedges_}) array->trim(3 * sizes.triangles());
    hull_.trim(sizes.hull_vertices());
  }
  points::DeviceMesh mesh(const blocks::MeshSizes& sizes) {
    await_room();
    const std::size_t rows = 3 * sizes.triangles();
    points::DeviceMesh mesh;
    mesh.triangles = triangles_.buffer(rows);
    mesh.neighbors = neighbors_.buffer(rows);
    mesh.halfedges = halfedges_.buffer(rows);
    mesh.hull = hull_.buffer(sizes.hull_vertices());
    return mesh;
  }

  Output<cl_int> representatives;
  Output<cl_double> areas;

 private:
  static std::size_t most_rows_of(std::size_t n) { return 3 * blocks::kMostTrianglesPerPoint * n; }

  std::size_t points_, rows_;
  Output<cl_int> triangles_, neighbors_, halfedges_, hull_;
  std::vector<std::future<void>> reserving_;
};

// Bytes of the persistent arena per point. Weights take a scaled copy, those of vertices, and links.
std::size_t persistent_bytes(bool has_weights) {
  return blocks::kPersistentBytesPerPoint + (has_weights ? 2 * sizeof(cl_double) + sizeof(cl_int) : 0);
}

const double* in_host_memory(const HostPoints& points) { return points.wide; }
template <typename Points>
const double* in_host_memory(const Points& /*in_device_memory*/) {
  return nullptr;
}

// Triangulates points of a call, at least one. Writes the result's offsets and statistics. ends: as below.
template <typename Points, typename Result>
geometry::Fitted<points::DeviceMesh> compute(Frame& call, const Points& points,
                                             const std::vector<std::size_t>& offsets, Arrays& arrays,
                                             const std::optional<points::Weights>& weights,
                                             statistics::Phases& phases, bool ends, Result& result) {
  Engine& engine = call.engine;
  const std::size_t n = offsets.back();
  Arena::Scope scope(engine.persistent), scratch_scope(engine.runtime.arena());
  points::DeviceMesh mesh;
  bool has_upper_bounds = false;
  const auto transfer = [&] {
    has_upper_bounds = true;
    if (ends) call.transfer();
  };
  const auto representatives = arrays.representatives.is_wanted() ? arrays.representatives.buffer(n)
                                                                  : engine.persistent.allocate<cl_int>(n);
  geometry::Fitted<blocks::Outcome> run =
      blocks::run(engine.runtime, engine.persistent, offsets,
                  {[&] { return call.points(points); }, representatives, arrays.have_links(),
                   [&](const blocks::MeshSizes& sizes) { return mesh = arrays.mesh(sizes); },
                   [&] { arrays.reserve(engine.runtime); }, weights ? &*weights : nullptr, transfer,
                   in_host_memory(points)},
                  phases);
  if (!run) return run.too_wide();
  blocks::Outcome outcome = *std::move(run);
  if (has_upper_bounds) arrays.trim(outcome.sizes);
  if (arrays.areas.is_wanted()) {
    // Points that are a copy in the arena are copied again, because they would take memory all the time.
    const std::size_t triangles = outcome.sizes.triangles();
    engine.runtime.map(triangles,
                       kernels::triangle_areas{.input = call.points(points).template as<cl_ulong>(),
                                               .triangles = mesh.triangles,
                                               .areas = arrays.areas.buffer(triangles).as<cl_ulong>()});
  }
  outcome.write(n, result.statistics);
  result.triangle_offsets = std::move(outcome.sizes.triangle_offsets);
  result.hull_offsets = std::move(outcome.sizes.hull_offsets);
  mesh.representatives = representatives;
  mesh.point_offsets = offsets;
  mesh.triangle_offsets = result.triangle_offsets;
  mesh.hull_offsets = result.hull_offsets;
  return mesh;
}

HostPoints part_of(const HostPoints& points, const Group& group) {
  const std::size_t first = 2 * group.first_point;
  return {points.wide == nullptr ? nullptr : points.wide + first,
          points.narrow == nullptr ? nullptr : points.narrow + first, group.offsets.back()};
}

// The mesh of at least one point. ends: whether the call has no other stages.
template <typename Points>
geometry::Fitted<points::DeviceMesh> triangulate_in(Frame& call, const Points& points,
                                                    const std::vector<std::size_t>& offsets,
                                                    const Options& options, Triangulation& result, bool ends,
                                                    const HostWeights* weights = nullptr) {
  Engine& engine = call.engine;
  const std::size_t n = offsets.back();
  statistics::Phases phases(options, [&engine] { return engine.runtime.working_clock(); });
  const host::Runtime::BeforeCompiling announce(engine.runtime,
                                                [&] { phases.interrupt("compiling kernels"); });
  engine.persistent.reserve(n * persistent_bytes(weights != nullptr));
  Arrays arrays(call, {true, options.neighbors, options.halfedges, true, true, options.areas}, n, result);
  const auto mesh =
      compute(call, points, offsets, arrays, weights_in(call, n, weights), phases, ends, result);
  if (!mesh) return mesh;
  if (ends) call.end();
  phases.end("output");
  phases.write(result.statistics);
  phases.progress("output", 1);
  return mesh;
}

geometry::Fitted<Triangulation> triangulate_on(Engine& engine, const HostPoints& points,
                                               const std::vector<std::size_t>& offsets,
                                               const Options& options, const HostWeights* weights = nullptr) {
  const std::size_t n = points.count, sets = offsets.size() - 1;
  Triangulation result = empty_result(engine, sets);
  if (n == 0) return result;
  Frame call(engine, options.profile);
  if (engine.workspace != nullptr && weights == nullptr) engine.provide_memory(n, sets);
  const auto mesh = triangulate_in(call, points, offsets, options, result, true, weights);
  if (!mesh) return mesh.too_wide();
  engine.write_accounts(result.statistics);
  return result;
}

// reason: why the host computes, if it does.
geometry::Fitted<geometry::Done> triangulate_on(Implementation& self, const Place& place,
                                                const std::string& reason, const DevicePoints& points,
                                                DeviceTriangulation& result, const Parts& parts,
                                                const Enqueue& enqueue,
                                                const DeviceWeights* weights = nullptr) {
  Engine& device = *place.device;
  Frame call(self, place, enqueue);
  if ((parts.neighbors || parts.halfedges || parts.areas) && !parts.triangles) {
    throw Error(ErrorKind::usage, "neighbours, halfedges and areas are computed with triangles only");
  }
  call.check(points, "points", SpaceKind::plane, weights != nullptr);
  device.check_size(points.count);
  call.begin();
  const double begin = device.runtime.working_clock();
  std::vector<std::size_t> offsets = call.offsets(points);
  const std::size_t n = points.count, sets = offsets.size() - 1;
  Arrays arrays(call, parts, n, result);
  const std::optional<points::Weights> by_point = weights_in(call, n, weights);
  call.check_distinct({device.workspace.get()});
  result.statistics = {};
  result.statistics.device = call.runtime.name();
  result.statistics.points = n;
  result.parts = parts;
  result.points = n;
  result.point_offsets = offsets;
  result.triangle_offsets.assign(sets + 1, 0);
  result.hull_offsets.assign(sets + 1, 0);
  if (n > 0) {
    call.check_size(n);
    if (place.is_apart() || weights != nullptr) {
      call.engine.persistent.reserve(n * persistent_bytes(weights != nullptr));
    } else {
      device.provide_memory(n, sets);
    }
    const Options unheard;
    statistics::Phases phases(unheard);
    const auto mesh = compute(call, points, offsets, arrays, by_point, phases, true, result);
    if (!mesh) return mesh.too_wide();
    call.end();
    if (place.is_apart()) {
      phases.end("output");
      phases.write(result.statistics);
      add_note(device, call.engine, reason, "triangulated", result.statistics);
    }
  } else {
    call.end();
  }
  result.statistics.seconds = device.runtime.working_clock() - begin;
  device.write_accounts(result.statistics);
  return geometry::Done();
}

}  // namespace

HostPoints checked_points(const double* wide, const float* narrow, const std::vector<std::size_t>& offsets) {
  check_offsets(offsets);
  check_points(narrow != nullptr ? static_cast<const void*>(narrow) : wide, offsets.back());
  return {wide, narrow, offsets.back()};
}

std::vector<double> widened(const HostPoints& points) {
  return points.narrow == nullptr ? std::vector<double>()
                                  : std::vector<double>(points.narrow, points.narrow + 2 * points.count);
}

void write_areas(Engine& engine, const HostPoints& points, Triangulation& result) {
  const std::size_t triangles = result.triangles.size() / 3;
  // Fewer take less time than a call of the engine.
  constexpr std::size_t kFewest = 1 << 14;
  if (triangles < kFewest) return write_areas(points, result);
  Frame call(engine);
  const auto areas = call.out<cl_double>(result.areas, triangles);
  engine.runtime.map(triangles, kernels::triangle_areas{.input = call.points(points).as<cl_ulong>(),
                                                        .triangles = call.in(result.triangles),
                                                        .areas = areas.as<cl_ulong>()});
  call.end();
}

void write_areas(const HostPoints& points, Triangulation& result) {
  const std::vector<double> doubles = widened(points);
  const auto* const input =
      reinterpret_cast<const kernel::double_bits*>(points.wide != nullptr ? points.wide : doubles.data());
  const std::int32_t* corners = result.triangles.data();
  result.areas.resize(result.triangles.size() / 3);
  for (double& area : result.areas) {
    area = kernel::as_double(kernel::rounded_area(input, corners[0], corners[1], corners[2]));
    corners += 3;
  }
}

Triangulation empty_result(Engine& self, std::size_t sets) {
  Triangulation result;
  result.statistics.device = self.runtime.name();
  result.triangle_offsets.assign(sets + 1, 0);
  result.hull_offsets.assign(sets + 1, 0);
  return result;
}

bool are_small(Implementation& self, const std::vector<std::size_t>& offsets, bool profile) {
  for (std::size_t s = 1; s < offsets.size(); ++s) {
    if (offsets[s] - offsets[s - 1] > self.host_tuning().block_points) return false;
  }
  return self.stays_here(offsets.back(), profile);
}

Triangulation triangulate_small(const HostPoints& points, const std::vector<std::size_t>& offsets,
                                const Options& options) {
  Triangulation result;
  const statistics::Phases phases(options);
  phases.progress("triangulate", 0);
  const double begin = host::now();
  const std::vector<double> doubles = widened(points);
  blocks::run_small(points.wide != nullptr ? points.wide : doubles.data(), offsets, options, result);
  if (options.areas) write_areas(points, result);
  result.statistics.device = host::kHostName;
  result.statistics.seconds = host::now() - begin;
  result.statistics.phases.push_back({"triangulate", result.statistics.seconds});
  phases.progress("output", 1);
  return result;
}

Triangulation triangulate(Implementation& self, const HostPoints& points, const HostWeights& weights,
                          const std::vector<std::size_t>& offsets, const Options& options) {
  Engine& asked = self.is_named() ? self.for_host_memory() : self.native();
  Engine& engine = self.with_doubles(asked);
  engine.check_size(points.count);
  Triangulation result = *triangulate_on(engine, points, offsets, options, &weights);
  add_note(asked, engine, "weights", "triangulated", result.statistics);
  return result;
}

points::DeviceMesh triangulate_stage(Frame& call, const Buffer<cl_double>& coordinates,
                                     const std::vector<std::size_t>& offsets, const Options& options,
                                     Triangulation& result) {
  result = empty_result(call.engine, offsets.size() - 1);
  points::DeviceMesh mesh = *triangulate_in(call, coordinates, offsets, options, result, false);
  mesh.coordinates = coordinates;
  return mesh;
}

Triangulation triangulate(Implementation& self, const HostPoints& points,
                          const std::vector<std::size_t>& offsets, const Options& options) {
  if (are_small(self, offsets, options.profile)) return triangulate_small(points, offsets, options);
  Engine& engine = self.for_host_memory();
  engine.check_size(points.count);
  const std::vector<Group> groups = options.profile ? std::vector<Group>() : groups_of(engine, offsets);
  if (!groups.empty()) {
    Options of_group = options;
    of_group.progress = nullptr;
    std::optional<Triangulation> joined =
        by_groups<Triangulation>(engine, groups, options, [&](std::size_t k) {
          return triangulate_small(part_of(points, groups[k]), groups[k].offsets, of_group);
        });
    if (joined) return *std::move(joined);
  }
  const double begin = engine.runtime.working_clock();
  return in_fixed_point_or(
      [&] { return triangulate_on(engine, points, offsets, options); },
      [&](const std::string& reason) -> geometry::Fitted<Triangulation> {
        const double seconds = engine.runtime.working_clock() - begin;
        Engine& other = self.with_doubles(engine);
        other.check_size(points.count);
        Triangulation result = *triangulate_on(other, points, offsets, options);
        result.statistics.seconds += seconds;
        result.statistics.phases.insert(result.statistics.phases.begin(), {"inspect", seconds});
        add_note(engine, other, reason, "triangulated", result.statistics);
        return result;
      });
}

void triangulate(Implementation& self, const DevicePoints& points, const DeviceWeights& weights,
                 DeviceTriangulation& result, const Parts& parts, const Enqueue& enqueue) {
  const Place place = with_doubles(self, self.on_device());
  (void)*triangulate_on(self, place, "weights", points, result, parts, enqueue, &weights);
}

void triangulate(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                 const Parts& parts, const Enqueue& enqueue) {
  Engine& engine = self.on_device();
  in_fixed_point_or(
      [&] {
        return triangulate_on(self, {engine, &engine}, "", points, result, parts, enqueue);
      },
      [&](const std::string& reason) {
        const Place place = with_doubles(self, engine);
        const bool lends = !place.is_apart() && engine.workspace != nullptr;
        if (lends) place.engine.workspace = engine.workspace;
        const auto done = triangulate_on(self, place, reason, points, result, parts, enqueue);
        if (!lends) return done;
        // The next call may use the workspace on another queue, or another workspace.
        place.engine.runtime.finish();
        place.engine.workspace = nullptr;
        place.engine.use_own_memory();
        return done;
      });
}

}  // namespace flaunay::call
