#include "call/on_host.hpp"

#include <fmt/format.h>

#include "host/note.hpp"

namespace flaunay::call {

void add_note(const Engine& asked, const Engine& used, const std::string& what, const std::string& done,
              Statistics& statistics) {
  if (&asked == &used || !used.runtime.is_native()) return;
  statistics.host_points = statistics.points;
  host::append_note(statistics.note, fmt::format("{} has no double precision (fp64) for {}: {} on the host",
                                                 asked.runtime.name(), what, done));
}

WithDoubles with_doubles(Implementation& self, const Enqueue& enqueue) {
  Engine& first = self.on_device();
  Engine& engine = self.with_doubles(first);
  if (engine.runtime.is_native()) return {first, &engine, enqueue};
  return {engine, nullptr, &engine == &first ? enqueue : on_queue_of(first, enqueue)};
}

Enqueue on_queue_of(Engine& first, const Enqueue& enqueue) {
  const bool is_own = enqueue.queue == nullptr || enqueue.queue == first.runtime.own_queue();
  if (!is_own) return enqueue;
  Enqueue same = enqueue;
  // Kernels are timed on a queue of their engine, and calls that time them wait for it.
  if (enqueue.profile) first.runtime.settle();
  same.queue = enqueue.profile ? nullptr : first.runtime.own_queue();
  return same;
}

HostPoints PointsOnHost::view() const {
  return {narrow.empty() ? wide.data() : nullptr, narrow.empty() ? nullptr : narrow.data()};
}

namespace {

template <typename T>
std::vector<T> read_coordinates(host::Runtime& runtime, const DevicePoints& points) {
  if (points.count == 0) return {};
  const host::Buffer<T> given(retained(points.memory), 2 * (points.first + points.count));
  return points::download(runtime, given, 2 * points.first, 2 * points.count);
}

}  // namespace

PointsOnHost read_points(host::Runtime& runtime, const DevicePoints& points) {
  PointsOnHost read;
  if (points.precision == Precision::float32) {
    read.narrow = read_coordinates<float>(runtime, points);
  } else {
    read.wide = read_coordinates<double>(runtime, points);
  }
  return read;
}

std::vector<double> read_wide_points(host::Runtime& runtime, const DevicePoints& points) {
  PointsOnHost read = read_points(runtime, points);
  return read.narrow.empty() ? std::move(read.wide) : widened(read.view(), points.count);
}

MeshOnHost read_mesh(host::Runtime& runtime, const DevicePoints& points, const points::DeviceMesh& mesh) {
  MeshOnHost read;
  const auto fetch = [&runtime](const host::Buffer<cl_int>& from) {
    return points::download(runtime, from, from.size());
  };
  read.coordinates = read_wide_points(runtime, points);
  read.triangulation.triangles = fetch(mesh.triangles);
  read.triangulation.neighbors = fetch(mesh.neighbors);
  read.triangulation.hull = fetch(mesh.hull);
  read.triangulation.representatives = fetch(mesh.representatives);
  read.triangulation.triangle_offsets = mesh.triangle_offsets;
  read.triangulation.hull_offsets = mesh.hull_offsets;
  return read;
}

}  // namespace flaunay::call
