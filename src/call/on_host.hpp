// What a device without double precision leaves to the host, natively: arrays go from device memory to the
// host and back.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "call/handles.hpp"
#include "call/host_call.hpp"
#include "call/implementation.hpp"
#include "flaunay/device_memory.hpp"
#include "points/device_mesh.hpp"
#include "points/download.hpp"

namespace flaunay::call {

/// Says in the statistics that the host did what this engine's device cannot do without doubles; nothing if
/// the engine that was used is the same or on a device. what: for what doubles are needed, such as
/// "constraints"; done: what became of them, such as "inserted".
void add_note(const Engine& asked, const Engine& used, const std::string& what, const std::string& done,
              Statistics& statistics);

/// How a call on device memory is done that needs doubles.
struct WithDoubles {
  Engine& device;   ///< has the memory; it computes unless the host does
  Engine* host;     ///< what computes natively if the device has no doubles; otherwise null
  Enqueue enqueue;  ///< the caller's, for this engine
};
WithDoubles with_doubles(Implementation& self, const Enqueue& enqueue);

/// For another engine on the same device: a queue of the caller's, or else the own queue of the triangulator,
/// which is that of its first engine.
Enqueue on_queue_of(Engine& first, const Enqueue& enqueue);

/// Coordinates in the caller's precision; one of both is empty.
struct PointsOnHost {
  std::vector<double> wide;
  std::vector<float> narrow;

  HostPoints view() const;
};
/// Reads points in device memory, which check_points has accepted. Waits.
PointsOnHost read_points(host::Runtime& runtime, const DevicePoints& points);
/// The same in double precision.
std::vector<double> read_wide_points(host::Runtime& runtime, const DevicePoints& points);

/// A triangulation and its points.
struct MeshOnHost {
  std::vector<double> coordinates;
  Triangulation triangulation;
};
/// Reads a triangulation in device memory, as mesh_without_points has checked it. Waits.
MeshOnHost read_mesh(host::Runtime& runtime, const DevicePoints& points, const points::DeviceMesh& mesh);

/// Reads the caller's array. Null is an empty array. what: its name in error messages. Waits.
template <typename T>
std::vector<T> read_given(host::Runtime& runtime, cl_mem memory, std::size_t count, const std::string& what) {
  return points::download(runtime, given_buffer<T>(runtime, memory, count, what), count);
}

/// Enqueues the copy of an array to a buffer, of which the host need not be allowed to write.
template <typename T>
void write_result(host::Runtime& runtime, const host::Buffer<T>& to, std::vector<T> values) {
  const std::size_t count = values.size();
  if (count == 0) return;
  const host::Buffer<T> copy(host::allocate_memory(runtime.memory(), count * sizeof(T)), count);
  runtime.write_kept(copy, std::move(values));
  runtime.copy(copy, 0, to, 0, count);
}

}  // namespace flaunay::call
