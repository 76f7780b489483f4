#include "call/domains.hpp"

#include <utility>

#include "call/frame.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::call {

using host::Buffer;

namespace {

template <typename T>
auto view_of(host::Runtime& runtime, const std::vector<T>& values) {
  return runtime.view(values.data(), values.size());
}

// What holes are found by.
constrained::DomainMesh view_triangles(host::Runtime& runtime, const double* coordinates,
                                       const std::vector<std::size_t>& offsets,
                                       const ConstrainedTriangulation& result) {
  constrained::DomainMesh mesh;
  mesh.triangle_offsets = result.triangle_offsets;
  mesh.points = offsets.back();
  mesh.coordinates = runtime.view(coordinates, 2 * (mesh.points + result.added_points.size() / 2));
  mesh.triangles = view_of(runtime, result.triangles);
  mesh.constrained = view_of(runtime, result.constrained);
  return mesh;
}

constrained::DomainMesh view(host::Runtime& runtime, const double* coordinates,
                             const std::vector<std::size_t>& offsets, const Constraints& constraints,
                             const ConstrainedTriangulation& result) {
  constrained::DomainMesh mesh = view_triangles(runtime, coordinates, offsets, result);
  mesh.segments = constraints.segment_count;
  mesh.edges = result.constraint_edges.size() / 2;
  mesh.neighbors = view_of(runtime, result.neighbors);
  mesh.representatives = view_of(runtime, result.representatives);
  mesh.segment_ends = runtime.view(constraints.segments, 2 * mesh.segments);
  mesh.piece_offsets = view_of(runtime, result.piece_offsets);
  mesh.piece_edges = view_of(runtime, result.piece_edges);
  mesh.constraint_edges = view_of(runtime, result.constraint_edges);
  return mesh;
}

// Replaces the triangles by those that are left.
void leave(host::Runtime& runtime, const constrained::DomainMesh& mesh, constrained::Regions& regions,
           ConstrainedTriangulation& result) {
  const constrained::LeftPlaces places = place_left(runtime, mesh, regions);
  const std::size_t left = places.triangle_offsets.back();
  if (left == mesh.triangle_count()) return;
  std::vector<std::int32_t> triangles, neighbors;
  std::vector<std::uint8_t> constrained;
  runtime.resize(triangles, 3 * left);
  runtime.resize(neighbors, 3 * left);
  runtime.resize(constrained, 3 * left);
  const host::Runtime::Settled settled(runtime);
  const constrained::LeftBuffers buffers{runtime.output(triangles), runtime.output(neighbors),
                                         runtime.output(constrained), runtime.arena().allocate<cl_int>(left)};
  write_left(runtime, mesh, places, buffers, regions);
  runtime.fetch_later(buffers.triangles, triangles);
  runtime.fetch_later(buffers.neighbors, neighbors);
  runtime.fetch_later(buffers.constrained, constrained);
  runtime.finish();
  regions.of_triangles = buffers.regions;
  result.triangles = std::move(triangles);
  result.neighbors = std::move(neighbors);
  result.constrained = std::move(constrained);
  result.triangle_offsets = places.triangle_offsets;
}

void write_labels(host::Runtime& runtime, const constrained::Regions& regions,
                  ConstrainedTriangulation& result) {
  const std::size_t triangles = result.triangles.size() / 3;
  runtime.resize(result.depths, triangles);
  runtime.resize(result.regions, triangles);
  const Buffer<cl_int> depths = runtime.output(result.depths), of = runtime.output(result.regions);
  constrained::write_depths(runtime, triangles, regions.of_triangles, regions.depths, depths);
  runtime.copy(regions.of_triangles, 0, of, 0, triangles);
  runtime.fetch_later(depths, result.depths);
  runtime.fetch_later(of, result.regions);
  runtime.finish();
}

}  // namespace

constrained::DomainRequest request_of(const ConstrainedOptions& options, bool are_closed) {
  return {{options.fill_rule, options.outside, are_closed}, options.labels};
}

void apply_domains(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
                   const Constraints& constraints, const constrained::DomainRequest& request,
                   ConstrainedTriangulation& result) {
  if (!request.needs_depths() && constraints.hole_count == 0) return;
  // About two triangles per point.
  if (!self.is_named() && result.triangles.size() / 6 <= self.host_tuning().host_points) {
    apply_domains_on_host(coordinates, offsets, constraints, request, result);
    return;
  }
  Engine& engine = self.for_host_memory();
  const Frame call(engine);
  if (constraints.hole_count == 0 || engine.has_doubles()) {
    return apply_domains_on(call.runtime, call.runtime, coordinates, offsets, constraints, request, result);
  }
  const Frame other(self.with_doubles(engine));
  apply_domains_on(call.runtime, other.runtime, coordinates, offsets, constraints, request, result);
}

void apply_domains_on(host::Runtime& runtime, host::Runtime& with_doubles, const double* coordinates,
                      const std::vector<std::size_t>& offsets, const Constraints& constraints,
                      const constrained::DomainRequest& request, ConstrainedTriangulation& result) {
  host::Arena::Scope scope(runtime.arena());
  const host::Runtime::Settled settled(runtime);
  const constrained::DomainMesh mesh = view(runtime, coordinates, offsets, constraints, result);
  constrained::Regions regions = find_regions(runtime, mesh);
  if (request.needs_depths()) find_depths(runtime, mesh, request.rules, regions);
  if (constraints.hole_count > 0) {
    const constrained::Seeds seeds = constrained::make_seeds(
        constraints,
        constrained::magnitudes_at_holes(coordinates, offsets, result.added_offsets, constraints));
    const host::Runtime::Settled other_settled(with_doubles);
    drop_holes(
        runtime,
        find_holes(
            with_doubles,
            &with_doubles == &runtime ? mesh : view_triangles(with_doubles, coordinates, offsets, result),
            seeds, constraints),
        regions);
  }
  if (request.rules.outside != Outside::keep || constraints.hole_count > 0) {
    leave(runtime, mesh, regions, result);
  }
  if (request.labels) write_labels(runtime, regions, result);
}

}  // namespace flaunay::call
