// The public calls for Lloyd's relaxation: triangulate, clip cells, move points to centroids, again. Points,
// triangles and cells stay where kernels run.
#include "blocks/memory.hpp"
#include "blocks/run.hpp"
#include "call/engine.hpp"
#include "call/errors.hpp"
#include "call/handles.hpp"
#include "call/on_host.hpp"
#include "derived/voronoi/clip.hpp"
#include "geometry/magnitudes.hpp"

namespace flaunay {

using host::Arena;
using host::Buffer;

namespace {

// Points and triangles in an arena.
class ArenaExchange : public blocks::Exchange {
 public:
  ArenaExchange(Arena& arena, const Buffer<cl_double>& points, std::size_t n)
      : points_(points),
        representatives_(arena.allocate<cl_int>(n)),
        mesh_{arena.allocate<cl_int>(3 * blocks::kMostTrianglesPerPoint * n),
              arena.allocate<cl_int>(3 * blocks::kMostTrianglesPerPoint * n),
              {},
              arena.allocate<cl_int>(n)} {}

  Buffer<cl_double> points() override { return points_; }
  Buffer<cl_int> representatives() override { return representatives_; }
  bool wants_links() const override { return true; }
  blocks::MeshBuffers mesh(const blocks::MeshSizes&) override { return mesh_; }

  points::DeviceMesh device_mesh(std::size_t n, const blocks::MeshSizes& sizes) const {
    points::DeviceMesh mesh;
    mesh.point_offsets = {0, n};
    mesh.triangle_offsets = sizes.triangle_offsets;
    mesh.hull_offsets = sizes.hull_offsets;
    mesh.coordinates = points_;
    mesh.triangles = mesh_.triangles;
    mesh.neighbors = mesh_.neighbors;
    mesh.hull = mesh_.hull;
    mesh.representatives = representatives_;
    return mesh;
  }

 private:
  Buffer<cl_double> points_;
  Buffer<cl_int> representatives_;
  blocks::MeshBuffers mesh_;
};

// Moves the points in this buffer. Everything else comes from the engine's arenas; its own, since the
// caller's workspace has room for a triangulation alone.
void relax_points(call::Engine& engine, const Buffer<cl_double>& points, std::size_t n,
                  const voronoi::ClipPolygon& polygon, std::size_t iterations) {
  if (n == 0) return;
  host::Runtime& runtime = engine.runtime;
  const blocks::WorkspaceBytes needed = blocks::workspace_bytes(runtime, n, 1);
  engine.persistent.reserve(needed.persistent);
  Arena::Scope kept(engine.even);
  ArenaExchange exchange(engine.even, points, n);
  const voronoi::ClippedBuffers cells{engine.even.allocate<cl_int>(n + 1), engine.even.allocate<cl_double>(n),
                                      engine.even.allocate<cl_double>(2 * n)};
  const Options unheard;
  for (std::size_t i = 0; i < iterations; ++i) {
    statistics::Phases phases(unheard);
    const blocks::MeshSizes sizes = [&] {
      Arena::Scope scope(engine.persistent), scratch_scope(runtime.arena());
      return blocks::run(runtime, engine.persistent, {0, n}, exchange, phases).sizes;
    }();
    voronoi::compute_clipped(
        runtime, exchange.device_mesh(n, sizes), polygon, cells,
        [&](std::size_t vertices) { return runtime.arena().allocate<cl_double>(2 * vertices); });
    voronoi::move_to_centroids(runtime, n, cells, points);
  }
}

std::vector<double> relax_on(call::Engine& engine, const double* coordinates, std::size_t n,
                             const voronoi::ClipPolygon& polygon, std::size_t iterations) {
  engine.check_size(n);
  engine.begin_call(false);
  std::vector<double> relaxed(2 * n);
  const host::Runtime::Settled settled(engine.runtime);
  Arena::Scope scope(engine.odd);
  const auto points = engine.odd.allocate<cl_double>(2 * n);
  engine.runtime.write(points, 0, 2 * n, coordinates);
  relax_points(engine, points, n, polygon, iterations);
  engine.runtime.read(points, 0, 2 * n, relaxed.data());
  return relaxed;
}

}  // namespace

std::vector<double> Triangulator::relax(const double* coordinates, std::size_t n, const double* corners,
                                        std::size_t corner_count, std::size_t iterations) {
  return call::take_turn(*implementation_, [&] {
    geometry::check_coordinates(coordinates, n);
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    return relax_on(implementation_->with_doubles(implementation_->for_host_memory()), coordinates, n,
                    polygon, iterations);
  });
}

void Triangulator::relax(const DevicePoints& points, const double* corners, std::size_t corner_count,
                         std::size_t iterations, DeviceBuffer& result, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    const call::WithDoubles call = call::with_doubles(*implementation_, enqueue);
    call::Engine& engine = call.device;
    engine.use_own_memory();
    host::Runtime& runtime = engine.runtime;
    call::check_enqueue(runtime, call.enqueue);
    call::check_points(runtime, points, "points");
    engine.check_size(points.count);
    call::QueuedCall queued(runtime, call.enqueue);
    if (call::checked_offsets(runtime, points).size() > 2) {
      throw Error(ErrorKind::usage, "points of several sets cannot be relaxed in one call");
    }
    const auto relaxed = call::result_buffer<cl_double>(runtime, result, 2 * points.count, "relaxed points",
                                                        engine.buffer_allocations);
    call::check_distinct({points.memory, relaxed.memory()});
    if (call.host != nullptr) {
      const std::vector<double> read = call::read_wide_points(runtime, points);
      call::write_result(runtime, relaxed,
                         relax_on(*call.host, read.data(), points.count, polygon, iterations));
    } else {
      {
        Arena::Scope scope(runtime.arena());
        runtime.copy(call::wide_points(runtime, runtime.arena(), points), 0, relaxed, 0, 2 * points.count);
      }
      relax_points(engine, relaxed, points.count, polygon, iterations);
    }
    queued.end();
  });
}

}  // namespace flaunay
