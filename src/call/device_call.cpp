#include "call/device_call.hpp"

#include <utility>

#include "blocks/run.hpp"
#include "call/engine.hpp"
#include "call/handles.hpp"
#include "call/on_host.hpp"
#include "geometry/magnitudes.hpp"

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

  // Enqueues the copies of results from the host.
  void write(Triangulation&& made) {
    const auto copy = [this](const Buffer<cl_int>& to, std::vector<std::int32_t>&& values) {
      if (to.memory() != nullptr) write_result(self_.runtime, to, std::move(values));
    };
    copy(mesh_.triangles, std::move(made.triangles));
    copy(mesh_.neighbors, std::move(made.neighbors));
    copy(mesh_.halfedges, std::move(made.halfedges));
    copy(mesh_.hull, std::move(made.hull));
    copy(representatives_, std::move(made.representatives));
  }

 private:
  Engine& self_;
  const DevicePoints& points_;
  bool wants_representatives_;
  blocks::MeshBuffers mesh_;
  Buffer<cl_int> representatives_{};
};

// A call on device memory: what comes before and after the work. work(offsets, exchange) computes if
// there are points, and sets the offsets and statistics of the result.
template <typename Work>
void run_call(Engine& self, const DevicePoints& points, DeviceTriangulation& result, const Parts& parts,
              const Enqueue& enqueue, const Work& work) {
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
  const std::size_t sets = offsets.size() - 1;
  DeviceExchange exchange(self, points, parts, result);
  result.statistics = {};
  result.statistics.device = runtime.name();
  result.statistics.points = points.count;
  result.parts = parts;
  result.is_constrained = false;
  result.points = points.count;
  result.point_offsets = offsets;
  result.triangle_offsets.assign(sets + 1, 0);
  result.hull_offsets.assign(sets + 1, 0);
  if (points.count > 0) work(offsets, exchange);
  call.end();
  result.statistics.seconds = runtime.working_clock() - begin;
  self.write_accounts(result.statistics);
}

// Computes on the host, natively.
void triangulate_on_host(Implementation& self, const std::string& reason, const DevicePoints& points,
                         DeviceTriangulation& result, const Parts& parts, const Enqueue& enqueue) {
  Engine& device = self.on_device();
  run_call(device, points, result, parts, enqueue,
           [&](const std::vector<std::size_t>& offsets, DeviceExchange& exchange) {
             const PointsOnHost read = read_points(device.runtime, points);
             Options options;
             options.neighbors = parts.neighbors;
             options.halfedges = parts.halfedges;
             self.native().check_size(points.count);
             Triangulation made = triangulate_on(self.native(), read.view(), offsets, options);
             result.triangle_offsets = std::move(made.triangle_offsets);
             result.hull_offsets = std::move(made.hull_offsets);
             result.statistics = std::move(made.statistics);
             add_note(device, self.native(), reason, "triangulated", result.statistics);
             exchange.write(std::move(made));
           });
}

}  // namespace

void triangulate_on(Engine& engine, const DevicePoints& points, DeviceTriangulation& result,
                    const Parts& parts, const Enqueue& enqueue) {
  run_call(engine, points, result, parts, enqueue,
           [&](const std::vector<std::size_t>& offsets, DeviceExchange& exchange) {
             host::Runtime& runtime = engine.runtime;
             engine.provide_memory(points.count, offsets.size() - 1);
             Arena::Scope scope(engine.persistent), scratch_scope(runtime.arena());
             const Options unheard;
             statistics::Phases phases(unheard);
             blocks::Outcome outcome = blocks::run(runtime, engine.persistent, offsets, exchange, phases);
             outcome.write(points.count, result.statistics);
             result.triangle_offsets = std::move(outcome.sizes.triangle_offsets);
             result.hull_offsets = std::move(outcome.sizes.hull_offsets);
           });
}

void triangulate(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                 const Parts& parts, const Enqueue& enqueue) {
  Engine& engine = self.on_device();
  if (engine.has_doubles()) return triangulate_on(engine, points, result, parts, enqueue);
  try {
    triangulate_on(engine, points, result, parts, enqueue);
  } catch (const geometry::TooWideForFixedPoint& error) {
    Engine& other = self.with_doubles(engine);
    if (other.runtime.is_native()) {
      return triangulate_on_host(self, error.reason(), points, result, parts, enqueue);
    }
    other.workspace = engine.workspace;
    triangulate_on(other, points, result, parts, on_queue_of(engine, enqueue));
    if (engine.workspace == nullptr) return;
    // The next call may use the workspace on another queue, or another workspace.
    other.runtime.finish();
    other.workspace = nullptr;
    other.use_own_memory();
  }
}

}  // namespace flaunay::call
