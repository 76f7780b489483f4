// The public calls for Lloyd's relaxation: triangulate, clip cells, move points to centroids, again. Points,
// triangles and cells stay where kernels run.
#include "blocks/memory.hpp"
#include "blocks/run.hpp"
#include "call/frame.hpp"
#include "derived/voronoi/clip.hpp"

namespace flaunay {

using host::Arena;
using host::Buffer;

namespace {

// Moves the points in this buffer. Everything else comes from the engine's arenas; its own, since the
// caller's workspace has room for a triangulation alone.
void relax_points(call::Engine& engine, const Buffer<cl_double>& points, std::size_t n,
                  const voronoi::ClipPolygon& polygon, std::size_t iterations) {
  if (n == 0) return;
  host::Runtime& runtime = engine.runtime;
  engine.persistent.reserve(blocks::workspace_bytes(runtime, n, 1).persistent);
  Arena::Scope kept(engine.even);
  const voronoi::ClippedBuffers cells{engine.even.allocate<cl_int>(n + 1), engine.even.allocate<cl_double>(n),
                                      engine.even.allocate<cl_double>(2 * n)};
  for (std::size_t i = 0; i < iterations; ++i) {
    Arena::Scope mesh_scope(engine.even);
    const points::DeviceMesh mesh = [&] {
      Arena::Scope scope(engine.persistent), scratch_scope(runtime.arena());
      return blocks::run(runtime, engine.persistent, {0, n}, points, engine.even);
    }();
    voronoi::compute_clipped(runtime, mesh, polygon, cells, [&](std::size_t vertices) {
      return runtime.arena().allocate<cl_double>(2 * vertices);
    });
    voronoi::move_to_centroids(runtime, n, cells, points);
  }
}

template <typename Points, typename Result>
void relax_in(call::Frame& call, const Points& points, const voronoi::ClipPolygon& polygon,
              std::size_t iterations, Result& result) {
  const std::size_t n = points.count;
  call.check_size(n);
  const auto relaxed = call.out<cl_double>(result, 2 * n, "relaxed points");
  call.check_distinct();
  {
    Arena::Scope scope(call.runtime.arena());
    call.runtime.copy(call.points(points), 0, relaxed, 0, 2 * n);
  }
  relax_points(call.engine, relaxed, n, polygon, iterations);
  call.end();
}

}  // namespace

std::vector<double> Triangulator::relax(const double* coordinates, std::size_t n, const double* corners,
                                        std::size_t corner_count, std::size_t iterations) {
  return call::take_turn(*implementation_, [&] {
    check_points(coordinates, n);
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    std::vector<double> relaxed;
    call::Frame call(implementation_->with_doubles(implementation_->for_host_memory()));
    relax_in(call, call::HostPoints{coordinates, nullptr, n}, polygon, iterations, relaxed);
    return relaxed;
  });
}

void Triangulator::relax(const DevicePoints& points, const double* corners, std::size_t corner_count,
                         std::size_t iterations, DeviceBuffer& result, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    const call::Place place = call::with_doubles(*implementation_, implementation_->on_device());
    call::Frame call(*implementation_, place, enqueue);
    call.check(points, "points");
    place.device->check_size(points.count);
    call.begin();
    call::expect(call.offsets(points).size() <= 2, "points of several sets cannot be relaxed in one call");
    relax_in(call, points, polygon, iterations, result);
  });
}

}  // namespace flaunay
