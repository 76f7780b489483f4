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

// Whether the host is quicker than any device.
bool is_small(const Implementation& self, const Triangulation& result) {
  // About two triangles per point.
  return !self.is_named() && result.triangles.size() / 6 <= self.host_tuning().host_points;
}

}  // namespace

constrained::DomainRequest request_of(const ConstrainedOptions& options, bool are_closed) {
  return {{options.fill_rule, options.outside, are_closed}, options.labels};
}

void apply_domains(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
                   const Constraints& constraints, const constrained::DomainRequest& request,
                   ConstrainedTriangulation& result) {
  if (!request.needs_depths() && constraints.hole_count == 0) return;
  if (is_small(self, result)) {
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
    const constrained::Places holes = constrained::holes_of(constraints, offsets.size() - 1);
    const constrained::Seeds seeds =
        make_seeds(holes, magnitudes_at(holes, coordinates, offsets, result.added_offsets));
    const host::Runtime::Settled other_settled(with_doubles);
    const std::vector<std::int32_t> found = find_seeds(
        with_doubles,
        &with_doubles == &runtime ? mesh : view_triangles(with_doubles, coordinates, offsets, result), seeds);
    check_found(holes, found);
    drop_holes(runtime, found, regions);
  }
  if (request.rules.outside != Outside::keep || constraints.hole_count > 0) {
    leave(runtime, mesh, regions, result);
  }
  if (request.labels) write_labels(runtime, regions, result);
}

void write_attributes(Implementation& self, const double* coordinates,
                      const std::vector<std::size_t>& offsets, const Constraints& constraints,
                      ConstrainedTriangulation& result) {
  if (constraints.seed_count == 0) return;
  const constrained::Places places = constrained::seeds_of(constraints, offsets.size() - 1);
  const constrained::Seeds seeds =
      make_seeds(places, magnitudes_at(places, coordinates, offsets, result.added_offsets));
  const Frame call(is_small(self, result) ? self.native() : self.with_doubles(self.for_host_memory()));
  constrained::DomainMesh mesh = view_triangles(call.runtime, coordinates, offsets, result);
  mesh.neighbors = view_of(call.runtime, result.neighbors);
  const constrained::Regions regions = find_regions(call.runtime, mesh);
  std::vector<std::int32_t> of(mesh.triangle_count());
  call.runtime.read_later(regions.of_triangles, 0, of.size(), of.data());
  const std::vector<std::int32_t> found = find_seeds(call.runtime, mesh, seeds);
  std::vector<double> attributes(regions.count, 0);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k] >= 0) attributes[of[found[k]]] = constraints.seed_attributes[k];
  }
  for (const std::int32_t region : of) result.triangle_attributes.push_back(attributes[region]);
}

}  // namespace flaunay::call
