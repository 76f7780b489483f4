#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "embedding/handles.hpp"
#include "flattened/errors.hpp"
#include "flattened/implementation.hpp"
#include "host/clock.hpp"
#include "hybrid/workspace.hpp"

namespace flaunay {

using host::Arena;
using host::Buffer;

namespace {

// A vertex is the middle one of two triangles at most.
constexpr std::size_t kMostTrianglesPerPoint = 2;

// The results' buffers for n points.
struct Results {
  hybrid::MeshBuffers mesh;
  Buffer<cl_int> representatives;
};

Results make_results(host::Runtime& runtime, std::size_t n, const Parts& parts, DeviceTriangulation& result,
                     std::size_t& made) {
  const auto make = [&](bool is_wanted, DeviceBuffer& buffer, std::size_t count, const char* what) {
    return is_wanted && count > 0 ? embedding::result_buffer<cl_int>(runtime, buffer, count, what, made)
                                  : Buffer<cl_int>();
  };
  const std::size_t rows = 3 * kMostTrianglesPerPoint * n;
  Results results;
  results.mesh.triangles = make(parts.triangles, result.triangles, rows, "triangles");
  results.mesh.neighbors = make(parts.neighbors, result.neighbors, rows, "neighbors");
  results.mesh.halfedges = make(parts.halfedges, result.halfedges, rows, "halfedges");
  results.mesh.hull = make(parts.hull, result.hull, n, "hull");
  results.representatives = make(parts.representatives, result.representatives, n, "representatives");
  return results;
}

}  // namespace

host::Runtime& Triangulator::Implementation::own_memory() {
  persistent.lend(nullptr, 0, 0);
  runtime.arena().lend(nullptr, 0, 0);
  return runtime;
}

void Triangulator::Implementation::provide_workspace(std::size_t n, std::size_t sets) {
  const hybrid::WorkspaceBytes needed = hybrid::workspace_bytes(runtime, n, sets);
  if (workspace == nullptr) {
    // The most that points can need, so that others of the same number find it there.
    persistent.reserve(needed.persistent);
    runtime.arena().reserve(needed.scratch);
    return;
  }
  std::size_t size = 0;
  FLAUNAY_CL(clGetMemObjectInfo(workspace.get(), CL_MEM_SIZE, sizeof size, &size, nullptr));
  if (size < needed.persistent + needed.scratch) {
    throw Error(ErrorKind::usage,
                fmt::format("the workspace is too small: it has {} bytes, {} points in {} sets "
                            "need {}",
                            size, n, sets, needed.persistent + needed.scratch));
  }
  persistent.lend(workspace, 0, needed.persistent);
  runtime.arena().lend(workspace, needed.persistent, size - needed.persistent);
}

void Triangulator::Implementation::triangulate(const DevicePoints& points, DeviceTriangulation& result,
                                               const Parts& parts, const Enqueue& enqueue) {
  embedding::check_enqueue(runtime, enqueue);
  if ((parts.neighbors || parts.halfedges) && !parts.triangles) {
    throw Error(ErrorKind::usage, "neighbours and halfedges are computed with triangles only");
  }
  embedding::check_points(runtime, points, "points");
  check_size(points.count);
  embedding::QueuedCall call(runtime, enqueue);
  reset_accounts();
  const double begin = host::now();
  const std::vector<std::size_t> offsets = embedding::checked_offsets(runtime, points);
  const std::size_t n = points.count;
  const std::size_t sets = offsets.size() - 1;
  const Results results = make_results(runtime, n, parts, result, buffer_allocations);
  embedding::check_distinct({points.memory, points.device_offsets, workspace.get(),
                             results.mesh.triangles.memory(), results.mesh.neighbors.memory(),
                             results.mesh.halfedges.memory(), results.mesh.hull.memory(),
                             results.representatives.memory()});
  provide_workspace(n, sets);
  Statistics statistics;
  statistics.device = runtime.device().name();
  statistics.points = n;
  result.parts = parts;
  result.points = n;
  result.point_offsets = offsets;
  result.triangle_offsets.assign(sets + 1, 0);
  result.hull_offsets.assign(sets + 1, 0);

  if (n > 0) {
    Arena::Scope scope(persistent), scratch_scope(runtime.arena());
    hybrid::Workspace work{runtime, persistent};
    const auto representatives =
        parts.representatives ? results.representatives : persistent.allocate<cl_int>(n);
    const hybrid::Blocks blocks = [&] {
      Arena::Scope input_scope(runtime.arena());
      const auto input = embedding::wide_points(runtime, runtime.arena(), points);
      return make_blocks(work, input, offsets, representatives);
    }();
    hybrid::Rings rings = divide(work, blocks, representatives);
    await_rings(work, blocks, rings);
    hybrid::MeshSizes sizes = count_mesh(work, blocks, rings);
    write_mesh(work, blocks, rings, sizes, results.mesh);
    result.triangle_offsets = std::move(sizes.triangle_offsets);
    result.hull_offsets = std::move(sizes.hull_offsets);
    statistics.duplicates = n - sizes.vertices;
    statistics.undecided = rings.undecided;
    statistics.triangles = result.triangle_offsets.back();
    statistics.hull_vertices = result.hull_offsets.back();
  }
  call.end();
  statistics.seconds = host::now() - begin;
  write_accounts(statistics);
  result.statistics = std::move(statistics);
}

void Triangulator::triangulate(const DevicePoints& points, DeviceTriangulation& result, const Parts& parts,
                               const Enqueue& enqueue) {
  with_errors([&] { implementation_->triangulate(points, result, parts, enqueue); });
}

std::size_t Triangulator::workspace_bytes(std::size_t n, std::size_t sets) const {
  return with_errors([&] {
    implementation_->check_size(n);
    // Sums of what is more could overflow.
    if (sets > embedding::kMostCountable) throw Error(ErrorKind::usage, "too many sets of points");
    const hybrid::WorkspaceBytes needed = hybrid::workspace_bytes(implementation_->runtime, n, sets);
    return needed.persistent + needed.scratch;
  });
}

void Triangulator::use_workspace(cl_mem workspace) {
  with_errors([&] {
    Implementation& self = *implementation_;
    std::shared_ptr<_cl_mem> lent;
    if (workspace != nullptr) {
      embedding::check_buffer(self.runtime, workspace, 1, embedding::Access::workspace, "the workspace");
      cl_mem parent = nullptr;
      FLAUNAY_CL(clGetMemObjectInfo(workspace, CL_MEM_ASSOCIATED_MEMOBJECT, sizeof parent, &parent, nullptr));
      if (parent != nullptr) {
        throw Error(ErrorKind::usage,
                    "the workspace must not be a sub-buffer: it is divided into such itself");
      }
      lent = embedding::retained(workspace);
    }
    self.own_memory().finish();
    self.workspace = std::move(lent);
  });
}

namespace {

boost::compute::device checked_member(cl_context context, cl_device_id device) {
  if (context == nullptr || device == nullptr) {
    throw Error(ErrorKind::usage, "a triangulator needs a context and a device, or neither");
  }
  std::size_t bytes = 0;
  const cl_int code = clGetContextInfo(context, CL_CONTEXT_DEVICES, 0, nullptr, &bytes);
  if (code != CL_SUCCESS) {
    throw Error(ErrorKind::usage, fmt::format("the context is none: {}", host::error_name(code)), code,
                "clGetContextInfo");
  }
  std::vector<cl_device_id> members(bytes / sizeof(cl_device_id));
  FLAUNAY_CL(clGetContextInfo(context, CL_CONTEXT_DEVICES, bytes, members.data(), nullptr));
  if (std::find(members.begin(), members.end(), device) == members.end()) {
    throw Error(ErrorKind::usage, "the device is not one of the context");
  }
  return boost::compute::device(device);
}

}  // namespace

Triangulator::Triangulator(cl_context context, cl_device_id device)
    : implementation_(with_errors([&] {
        const boost::compute::device member = checked_member(context, device);
        return std::make_shared<Implementation>(boost::compute::context(context), member);
      })) {}

cl_context Triangulator::context() const noexcept { return implementation_->runtime.context().get(); }
cl_device_id Triangulator::device_id() const noexcept { return implementation_->runtime.device().id(); }
cl_command_queue Triangulator::queue() const noexcept { return implementation_->runtime.own_queue(); }

}  // namespace flaunay
