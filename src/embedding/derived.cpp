// The public side of what is derived from a triangulation: the dual, and the answers to queries.
#include <fmt/format.h>

#include <limits>
#include <utility>

#include "derived/locator.hpp"
#include "derived/voronoi.hpp"
#include "embedding/handles.hpp"
#include "flattened/errors.hpp"
#include "flattened/implementation.hpp"
#include "input/magnitudes.hpp"

namespace flaunay {

using host::Arena;
using host::Buffer;

namespace {

void expect(bool holds, const char* what) {
  if (!holds) throw Error(ErrorKind::usage, what);
}

// In place, or copied; until the next wait. All sets taken as one, which is no matter where none is asked
// for.
derived::Mesh mesh_of(host::Runtime& runtime, const double* coordinates, std::size_t n,
                      const Triangulation& triangulation) {
  expect(n == 0 || coordinates != nullptr, "points, but no coordinates: the pointer is null");
  expect(triangulation.representatives.size() == n, "the triangulation is of another number of points");
  expect(triangulation.neighbors.size() == triangulation.triangles.size(),
         "the triangulation has no neighbours: see Options::neighbors");
  const auto view = [&](const std::vector<std::int32_t>& values) {
    return runtime.view(values.data(), values.size());
  };
  derived::Mesh mesh;
  mesh.point_offsets = {0, n};
  mesh.triangle_offsets = {0, triangulation.triangles.size() / 3};
  mesh.hull_offsets = {0, triangulation.hull.size()};
  mesh.coordinates = runtime.view(coordinates, 2 * n);
  mesh.triangles = view(triangulation.triangles);
  mesh.neighbors = view(triangulation.neighbors);
  mesh.hull = view(triangulation.hull);
  mesh.representatives = view(triangulation.representatives);
  return mesh;
}

derived::Mesh mesh_of(host::Runtime& runtime, const double* coordinates,
                      const std::vector<std::size_t>& offsets, const Triangulation& triangulation) {
  check_offsets(offsets);
  expect(triangulation.triangle_offsets.size() == offsets.size() &&
             triangulation.hull_offsets.size() == offsets.size(),
         "the triangulation is of another number of sets");
  derived::Mesh mesh = mesh_of(runtime, coordinates, offsets.back(), triangulation);
  expect(triangulation.triangle_offsets.back() == mesh.triangle_count() &&
             triangulation.hull_offsets.back() == triangulation.hull.size(),
         "the triangulation's offsets do not fit its arrays");
  mesh.point_offsets = offsets;
  mesh.triangle_offsets = triangulation.triangle_offsets;
  mesh.hull_offsets = triangulation.hull_offsets;
  return mesh;
}

derived::Mesh mesh_of(host::Runtime& runtime, const DevicePoints& points,
                      const DeviceTriangulation& triangulation) {
  const Parts& parts = triangulation.parts;
  expect(parts.triangles && parts.neighbors && parts.hull && parts.representatives,
         "the parts triangles, neighbors, hull and representatives are needed");
  expect(points.count == triangulation.points, "the triangulation is of another number of points");
  const auto input = [&](const DeviceBuffer& buffer, std::size_t count, const char* what) {
    return embedding::input_buffer<cl_int>(runtime, buffer, count, what);
  };
  const std::size_t sets = triangulation.point_offsets.size();
  expect(sets > 0 && triangulation.triangle_offsets.size() == sets &&
             triangulation.hull_offsets.size() == sets && triangulation.point_offsets.back() == points.count,
         "the triangulation's offsets do not fit: was it moved from?");
  derived::Mesh mesh;
  mesh.point_offsets = triangulation.point_offsets;
  mesh.triangle_offsets = triangulation.triangle_offsets;
  mesh.hull_offsets = triangulation.hull_offsets;
  mesh.triangles = input(triangulation.triangles, 3 * mesh.triangle_count(), "triangles");
  mesh.neighbors = input(triangulation.neighbors, 3 * mesh.triangle_count(), "neighbors");
  mesh.hull = input(triangulation.hull, mesh.hull_offsets.back(), "hull");
  mesh.representatives = input(triangulation.representatives, points.count, "representatives");
  mesh.coordinates = embedding::wide_points(runtime, runtime.arena(), points);
  return mesh;
}

// What a method of the host's interface works with: the own queue, the own memory.
class HostCall {
 public:
  explicit HostCall(host::Runtime& used) : runtime(used), scope_(used.arena()) {
    used.use_queue(nullptr, false);
  }
  host::Runtime& runtime;

 private:
  Arena::Scope scope_;
};

}  // namespace

Voronoi Triangulator::voronoi(const double* coordinates, std::size_t n, const Triangulation& triangulation) {
  return with_errors([&] {
    implementation_->check_size(n);
    const HostCall call(implementation_->own_memory());
    host::Runtime& runtime = call.runtime;
    Voronoi result;
    const host::Runtime::Settled settled(runtime);
    const derived::Mesh mesh = mesh_of(runtime, coordinates, n, triangulation);
    result.circumcentres.resize(2 * mesh.triangle_count());
    result.cell_offsets.resize(n + 1);
    result.cells.resize(3 * mesh.triangle_count());
    result.unbounded.resize(n);
    const derived::VoronoiBuffers buffers{runtime.output(result.circumcentres),
                                          runtime.output(result.cell_offsets), runtime.output(result.cells),
                                          runtime.output(result.unbounded)};
    derived::voronoi(runtime, mesh, buffers);
    runtime.fetch_later(buffers.circumcentres, result.circumcentres);
    runtime.fetch_later(buffers.cell_offsets, result.cell_offsets);
    runtime.fetch_later(buffers.cells, result.cells);
    runtime.fetch_later(buffers.unbounded, result.unbounded);
    runtime.finish();
    return result;
  });
}

void Triangulator::voronoi(const DevicePoints& points, const DeviceTriangulation& triangulation,
                           DeviceVoronoi& result, const Enqueue& enqueue) {
  with_errors([&] {
    host::Runtime& runtime = implementation_->own_memory();
    std::size_t& made = implementation_->buffer_allocations;
    embedding::check_enqueue(runtime, enqueue);
    embedding::check_points(runtime, points, "points");
    embedding::QueuedCall call(runtime, enqueue);
    Arena::Scope scope(runtime.arena());
    const derived::Mesh mesh = mesh_of(runtime, points, triangulation);
    const std::size_t triangles = mesh.triangle_count();
    derived::VoronoiBuffers buffers;
    buffers.circumcentres = embedding::result_buffer<cl_double>(runtime, result.circumcentres, 2 * triangles,
                                                                "circumcentres", made);
    buffers.cell_offsets = embedding::result_buffer<cl_int>(runtime, result.cell_offsets, points.count + 1,
                                                            "cell offsets", made);
    buffers.cells = embedding::result_buffer<cl_int>(runtime, result.cells, 3 * triangles, "cells", made);
    buffers.unbounded =
        embedding::result_buffer<cl_uchar>(runtime, result.unbounded, points.count, "unbounded cells", made);
    embedding::check_distinct({mesh.triangles.memory(), mesh.neighbors.memory(), mesh.hull.memory(),
                               mesh.representatives.memory(), points.memory, buffers.circumcentres.memory(),
                               buffers.cell_offsets.memory(), buffers.cells.memory(),
                               buffers.unbounded.memory()});
    derived::voronoi(runtime, mesh, buffers);
    call.end();
  });
}

struct Locator::Implementation {
  explicit Implementation(std::shared_ptr<Triangulator::Implementation> used)
      : owner(std::move(used)), own(owner->runtime.context(), owner->runtime.device()) {
    if (owner->runtime.tuning().separate_buffers) own.separate_buffers();
  }

  // Kernels count with 32-bit integers.
  static void check_queries(std::size_t m) {
    expect(m <= std::numeric_limits<std::int32_t>::max() / 2, "more queries than 32-bit indices can count");
  }

  /// Answers queries in host memory: work(runtime, queries, m, offsets, results) enqueues what writes the
  /// results.
  template <typename Result, typename Work>
  std::vector<Result> answer(const double* queries, const std::vector<std::size_t>& offsets,
                             const Work& work) {
    return with_errors([&] {
      check_offsets(offsets);
      const std::size_t m = offsets.back();
      check_queries(m);
      expect(m == 0 || queries != nullptr, "queries, but no coordinates: the pointer is null");
      const HostCall call(owner->own_memory());
      host::Runtime& runtime = call.runtime;
      std::vector<Result> result(m);
      const host::Runtime::Settled settled(runtime);
      const auto output = runtime.output(result);
      work(runtime, runtime.view(queries, 2 * m), m, offsets, output);
      runtime.fetch_later(output, result);
      runtime.finish();
      return result;
    });
  }

  /// The same in device memory. values: what else is read there, or null.
  template <typename Result, typename Work>
  void answer(const DevicePoints& queries, cl_mem values, DeviceBuffer& result, const char* what,
              const Enqueue& enqueue, const Work& work) {
    with_errors([&] {
      host::Runtime& runtime = owner->own_memory();
      embedding::check_enqueue(runtime, enqueue);
      embedding::check_points(runtime, queries, "queries");
      embedding::QueuedCall call(runtime, enqueue);
      Arena::Scope scope(runtime.arena());
      check_queries(queries.count);
      const std::vector<std::size_t> offsets = embedding::checked_offsets(runtime, queries);
      const auto output =
          embedding::result_buffer<Result>(runtime, result, queries.count, what, owner->buffer_allocations);
      embedding::check_distinct({queries.memory, queries.device_offsets, values, result.memory()});
      work(runtime, embedding::wide_points(runtime, runtime.arena(), queries), queries.count, offsets,
           output);
      call.end();
    });
  }

  std::shared_ptr<Triangulator::Implementation> owner;
  Arena own;
  derived::Locator locator;
  std::size_t points = 0;
};

std::unique_ptr<Locator::Implementation> Locator::make(Triangulator& triangulator) {
  return with_errors([&] { return std::make_unique<Implementation>(triangulator.implementation_); });
}

Locator::Locator(Triangulator& triangulator, const double* coordinates, std::size_t n,
                 const Triangulation& triangulation)
    : Locator(triangulator, coordinates, std::vector<std::size_t>{0, n}, triangulation) {}

Locator::Locator(Triangulator& triangulator, const double* coordinates,
                 const std::vector<std::size_t>& offsets, const Triangulation& triangulation)
    : implementation_(make(triangulator)) {
  with_errors([&] {
    implementation_->owner->check_size(offsets.empty() ? 0 : offsets.back());
    const HostCall call(implementation_->owner->own_memory());
    const host::Runtime::Settled settled(call.runtime);
    const derived::Mesh mesh = mesh_of(call.runtime, coordinates, offsets, triangulation);
    implementation_->locator = derived::make_locator(call.runtime, implementation_->own, mesh);
    implementation_->points = offsets.back();
    call.runtime.finish();
  });
}

Locator::Locator(Triangulator& triangulator, const DevicePoints& points,
                 const DeviceTriangulation& triangulation, const Enqueue& enqueue)
    : implementation_(make(triangulator)) {
  with_errors([&] {
    host::Runtime& runtime = implementation_->owner->own_memory();
    embedding::check_enqueue(runtime, enqueue);
    embedding::check_points(runtime, points, "points");
    embedding::QueuedCall call(runtime, enqueue);
    Arena::Scope scope(runtime.arena());
    implementation_->locator =
        derived::make_locator(runtime, implementation_->own, mesh_of(runtime, points, triangulation));
    implementation_->points = points.count;
    call.end();
  });
}

Locator::~Locator() = default;
Locator::Locator(Locator&&) noexcept = default;
Locator& Locator::operator=(Locator&&) noexcept = default;

std::vector<std::int32_t> Locator::locate(const double* queries, std::size_t m) {
  return locate(queries, std::vector<std::size_t>{0, m});
}

std::vector<std::int32_t> Locator::locate(const double* queries, const std::vector<std::size_t>& offsets) {
  return implementation_->answer<std::int32_t>(queries, offsets, [&](auto& runtime, const auto&... all) {
    derived::locate(runtime, implementation_->locator, all...);
  });
}

void Locator::locate(const DevicePoints& queries, DeviceBuffer& triangles, const Enqueue& enqueue) {
  implementation_->answer<cl_int>(
      queries, nullptr, triangles, "located triangles", enqueue,
      [&](auto& runtime, const auto&... all) { derived::locate(runtime, implementation_->locator, all...); });
}

std::vector<std::int32_t> Locator::nearest(const double* queries, std::size_t m) {
  return nearest(queries, std::vector<std::size_t>{0, m});
}

std::vector<std::int32_t> Locator::nearest(const double* queries, const std::vector<std::size_t>& offsets) {
  return implementation_->answer<std::int32_t>(queries, offsets, [&](auto& runtime, const auto&... all) {
    derived::nearest(runtime, implementation_->locator, all...);
  });
}

void Locator::nearest(const DevicePoints& queries, DeviceBuffer& points, const Enqueue& enqueue) {
  implementation_->answer<cl_int>(queries, nullptr, points, "nearest points", enqueue,
                                  [&](auto& runtime, const auto&... all) {
                                    derived::nearest(runtime, implementation_->locator, all...);
                                  });
}

std::vector<double> Locator::interpolate(const double* values, const double* queries, std::size_t m) {
  return interpolate(values, queries, std::vector<std::size_t>{0, m});
}

std::vector<double> Locator::interpolate(const double* values, const double* queries,
                                         const std::vector<std::size_t>& offsets) {
  const std::size_t n = implementation_->points;
  if (n > 0) expect(values != nullptr, "points have no values: the pointer is null");
  return implementation_->answer<double>(queries, offsets, [&](auto& runtime, const auto&... all) {
    derived::interpolate(runtime, implementation_->locator, runtime.view(values, n), all...);
  });
}

void Locator::interpolate(cl_mem values, const DevicePoints& queries, DeviceBuffer& results,
                          const Enqueue& enqueue) {
  const std::size_t n = implementation_->points;
  implementation_->answer<cl_double>(
      queries, values, results, "interpolated values", enqueue, [&](auto& runtime, const auto&... all) {
        embedding::check_buffer(runtime, values, n * sizeof(cl_double), embedding::Access::read, "values");
        const Buffer<cl_double> given(values == nullptr ? nullptr : embedding::retained(values), n);
        derived::interpolate(runtime, implementation_->locator, given, all...);
      });
}

}  // namespace flaunay
