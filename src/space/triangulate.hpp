// Mode blocks for points and results in host memory or in device memory.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "call/frame.hpp"
#include "points/device_mesh.hpp"
#include "points/distribute.hpp"

namespace flaunay::call {

/// Coordinates of sets; one of wide and narrow is null. Throws Error(usage) for wrong offsets and for null
/// coordinates in double precision.
HostPoints checked_points(const double* wide, const float* narrow, const std::vector<std::size_t>& offsets);

/// Whether points have weights. Hidden points tell it, too, of a mesh that a caller has made.
inline bool has_weights(const Triangulation& mesh) { return mesh.is_weighted || !mesh.hidden.empty(); }
inline bool has_weights(const DeviceTriangulation& mesh) { return mesh.is_weighted; }

/// Removes from a result what an earlier call of another kind has left.
inline void reset(const Space& space, DeviceTriangulation& result) {
  result.space = space;
  result.is_constrained = result.is_weighted = false;
  result.constraint_count = result.hidden_count = result.images = 0;
}

/// Converts the points to double precision. Returns an empty vector if they already are in it.
std::vector<double> widened(const HostPoints& points);

/// Writes Triangulation::areas, which the engine computes unless they are few. The points are finite. Resets
/// the engine's accounts.
void write_areas(Engine& engine, const HostPoints& points, Triangulation& result);
/// Computes them on the calling thread.
void write_areas(const HostPoints& points, Triangulation& result);

/// Implements Triangulator::triangulate for host memory: small sets on the calling thread if no device was
/// named, others on the triangulator's engine for host memory. The offsets must have been checked.
Triangulation triangulate(Implementation& self, const HostPoints& points,
                          const std::vector<std::size_t>& offsets, const Options& options);

/// Triangulates points of sets, at least one, as the first stage of a call on an engine that has doubles. The
/// arrays of the result are those of the mesh after the end of the call.
points::DeviceMesh triangulate_stage(Frame& call, const Buffer<cl_double>& coordinates,
                                     const std::vector<std::size_t>& offsets, const Options& options,
                                     Triangulation& result);

/// Whether sets are triangulated on the calling thread: they stay there, and each is one block.
bool are_small(Implementation& self, const std::vector<std::size_t>& offsets, bool profile);

/// Triangulates sets of at most a block's points each on the calling thread.
Triangulation triangulate_small(const HostPoints& points, const std::vector<std::size_t>& offsets,
                                const Options& options);

/// Weights as the caller gives them, and where hidden points go, in host or in device memory.
template <typename Values, typename Hidden>
struct GivenWeights {
  Values values;
  const points::WeightedSolver* solver;
  Hidden& hidden;
  std::size_t* hidden_count = nullptr;                  ///< not null for device memory
  std::function<std::size_t(std::size_t)> number = {};  ///< points::Weights::number
};
using HostWeights = GivenWeights<const double*, std::vector<cl_int>>;
using DeviceWeights = GivenWeights<cl_mem, DeviceBuffer>;

/// The weights of a call's points, if there are any, and the array of hidden points.
template <typename Values, typename Hidden>
std::optional<points::Weights> weights_in(Frame& call, std::size_t n,
                                          const GivenWeights<Values, Hidden>* given) {
  if (given == nullptr || n == 0) return std::nullopt;
  const auto hidden = call.output<cl_int>(given->hidden, n, "hidden");
  return points::Weights{call.in<cl_double>(given->values, n, "weights"), given->solver,
                         [given, hidden](std::size_t count) {
                           if (given->hidden_count != nullptr) *given->hidden_count = count;
                           return hidden.buffer(count);
                         },
                         given->number};
}

/// Computes regular triangulations of sets in host memory: on the device if one was named that has doubles.
Triangulation triangulate(Implementation& self, const HostPoints& points, const HostWeights& weights,
                          const std::vector<std::size_t>& offsets, const Options& options);
/// Computes them in device memory. Devices without doubles leave it to the host.
void triangulate(Implementation& self, const DevicePoints& points, const DeviceWeights& weights,
                 DeviceTriangulation& result, const Parts& parts, const Enqueue& enqueue);

/// Implements Triangulator::triangulate for device memory. What the device cannot compute in fixed point is
/// computed with its doubles, or if it has none, on the host.
void triangulate(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                 const Parts& parts, const Enqueue& enqueue);

/// Returns a result for this many sets without any triangles.
Triangulation empty_result(Engine& self, std::size_t sets);

}  // namespace flaunay::call
