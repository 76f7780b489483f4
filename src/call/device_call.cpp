#include "call/device_call.hpp"

#include <utility>

#include "blocks/run.hpp"
#include "call/engine.hpp"
#include "call/handles.hpp"

namespace flaunay::call {

using host::Arena;
using host::Buffer;

namespace {

// Points in the caller's buffer, and results in the buffers of a DeviceTriangulation.
class DeviceExchange : public blocks::Exchange {
 public:
  DeviceExchange(Engine& self, const DevicePoints& points, const Parts& parts, DeviceTriangulation& result)
      : self_(self), points_(points), wants_representatives_(parts.representatives) {
    const std::size_t n = points.count;
    const auto make = [&](bool is_wanted, DeviceBuffer& buffer, std::size_t count, const char* what) {
      if (!is_wanted || count == 0) return Buffer<cl_int>();
      return result_buffer<cl_int>(self.runtime, buffer, count, what, self.buffer_allocations);
    };
    const std::size_t rows = 3 * blocks::kMostTrianglesPerPoint * n;
    mesh_.triangles = make(parts.triangles, result.triangles, rows, "triangles");
    mesh_.neighbors = make(parts.neighbors, result.neighbors, rows, "neighbors");
    mesh_.halfedges = make(parts.halfedges, result.halfedges, rows, "halfedges");
    mesh_.hull = make(parts.hull, result.hull, n, "hull");
    representatives_ = make(parts.representatives, result.representatives, n, "representatives");
    check_distinct({points.memory, points.device_offsets, self.workspace.get(), mesh_.triangles.memory(),
                    mesh_.neighbors.memory(), mesh_.halfedges.memory(), mesh_.hull.memory(),
                    representatives_.memory()});
  }

  Buffer<cl_double> points() override { return wide_points(self_.runtime, self_.runtime.arena(), points_); }
  Buffer<cl_int> representatives() override {
    return wants_representatives_ ? representatives_ : self_.persistent.allocate<cl_int>(points_.count);
  }
  bool wants_links() const override {
    return mesh_.neighbors.memory() != nullptr || mesh_.halfedges.memory() != nullptr;
  }
  blocks::MeshBuffers mesh(const blocks::MeshSizes&) override { return mesh_; }

 private:
  Engine& self_;
  const DevicePoints& points_;
  bool wants_representatives_;
  blocks::MeshBuffers mesh_;
  Buffer<cl_int> representatives_{};
};

}  // namespace

void triangulate(Engine& self, const DevicePoints& points, DeviceTriangulation& result, const Parts& parts,
                 const Enqueue& enqueue) {
  host::Runtime& runtime = self.runtime;
  check_enqueue(runtime, enqueue);
  if ((parts.neighbors || parts.halfedges) && !parts.triangles) {
    throw Error(ErrorKind::usage, "neighbours and halfedges are computed with triangles only");
  }
  check_points(runtime, points, "points");
  self.check_size(points.count);
  QueuedCall call(runtime, enqueue);
  self.reset_accounts();
  const double begin = runtime.working_clock();
  const std::vector<std::size_t> offsets = checked_offsets(runtime, points);
  const std::size_t n = points.count;
  const std::size_t sets = offsets.size() - 1;
  DeviceExchange exchange(self, points, parts, result);
  self.provide_memory(n, sets);
  Statistics statistics;
  statistics.device = runtime.name();
  statistics.points = n;
  result.parts = parts;
  result.is_constrained = false;
  result.points = n;
  result.point_offsets = offsets;
  result.triangle_offsets.assign(sets + 1, 0);
  result.hull_offsets.assign(sets + 1, 0);

  if (n > 0) {
    Arena::Scope scope(self.persistent), scratch_scope(runtime.arena());
    const Options unheard;
    statistics::Phases phases(unheard);
    blocks::Outcome outcome = blocks::run(runtime, self.persistent, offsets, exchange, phases);
    outcome.write(n, statistics);
    result.triangle_offsets = std::move(outcome.sizes.triangle_offsets);
    result.hull_offsets = std::move(outcome.sizes.hull_offsets);
  }
  call.end();
  statistics.seconds = runtime.working_clock() - begin;
  self.write_accounts(statistics);
  result.statistics = std::move(statistics);
}

}  // namespace flaunay::call
