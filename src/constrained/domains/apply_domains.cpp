#include <optional>
#include <utility>

#include "call/frame.hpp"
#include "constrained/stages.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::call {
namespace {

// The part of the mesh that finds the triangles of places.
constrained::DomainMesh triangles_of(Frame& call, const double* coordinates,
                                     const std::vector<std::size_t>& offsets,
                                     const ConstrainedTriangulation& result) {
  constrained::DomainMesh mesh;
  mesh.triangle_offsets = result.triangle_offsets;
  mesh.point_offsets = offsets;
  mesh.coordinates = call.in(coordinates, 2 * offsets.back() + result.added_points.size());
  mesh.triangles = call.in(result.triangles);
  mesh.constrained = call.in(result.constrained);
  return mesh;
}

constrained::DomainMesh mesh_of(Frame& call, const double* coordinates,
                                const std::vector<std::size_t>& offsets, const Constraints& constraints,
                                const ConstrainedTriangulation& result) {
  constrained::DomainMesh mesh = triangles_of(call, coordinates, offsets, result);
  mesh.segments = constraints.segment_count;
  mesh.edges = result.constraint_edges.size() / 2;
  mesh.neighbors = call.in(result.neighbors);
  mesh.representatives = call.in(result.representatives);
  mesh.segment_ends = call.in(constraints.segments, 2 * mesh.segments);
  mesh.piece_offsets = call.in(result.piece_offsets);
  mesh.piece_edges = call.in(result.piece_edges);
  mesh.constraint_edges = call.in(result.constraint_edges);
  return mesh;
}

// Labels regions by the polygons that curves bound.
void find_polygons(Frame& call, const double* coordinates, const Constraints& constraints,
                   const DomainRequest& request, const ConstrainedTriangulation& result,
                   constrained::Regions& regions) {
  host::Runtime& runtime = call.runtime;
  call.fetch();  // what earlier stages have made of the result
  constrained::MapLabels labels = constrained::label_map(
      coordinates, result, points::download(runtime, regions.of_triangles, result.triangles.size() / 3),
      regions.count, constraints.segments, *request.curves, request.rules.fill, request.overlaps);
  if (request.rules.outside != Outside::keep) {
    std::vector<cl_uchar> left;
    for (const std::int32_t polygon : labels.polygons) left.push_back(polygon >= 0 ? 1 : 0);
    runtime.write_kept(regions.left, std::move(left));
  }
  regions.depths = runtime.upload(runtime.arena(), std::move(labels.depths));
  regions.polygons = runtime.upload(runtime.arena(), std::move(labels.polygons));
}

// The triangles of places.
std::vector<std::int32_t> find_places(Frame& call, Engine& with_doubles, const constrained::DomainMesh& mesh,
                                      const constrained::Places& places, const double* coordinates,
                                      const std::vector<std::size_t>& offsets,
                                      const ConstrainedTriangulation& result) {
  const auto find = [&](host::Runtime& runtime, const constrained::DomainMesh& of) {
    return constrained::find_places(runtime, of, places, coordinates, offsets, result.added_offsets);
  };
  if (&with_doubles == &call.engine) return find(call.runtime, mesh);
  call.fetch();  // what earlier stages have made of the result
  Frame other(with_doubles);
  return find(other.runtime, triangles_of(other, coordinates, offsets, result));
}

// Labels regions by the last seed in each, or by -1.
void label_seeds(host::Runtime& runtime, const std::vector<std::int32_t>& triangles,
                 std::size_t triangle_count, constrained::Regions& regions) {
  const std::vector<cl_int> of = points::download(runtime, regions.of_triangles, triangle_count);
  std::vector<cl_int> seeds(regions.count, -1);
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    seeds[of[triangles[k]]] = static_cast<cl_int>(k);
  }
  regions.seeds = runtime.upload(runtime.arena(), std::move(seeds));
}

// Writes the triangles that are left, if some are left out. numbers: gets the regions of these triangles.
void leave(Frame& call, constrained::DomainMesh& mesh, const constrained::LeftPlaces& places,
           const Buffer<cl_int>& numbers, constrained::Regions& regions,
           const ConstrainedTriangulation& result, Left& left) {
  call.drop(result.triangles);
  call.drop(result.neighbors);
  call.drop(result.halfedges);
  call.drop(result.constrained);
  const std::size_t corners = 3 * places.triangle_offsets.back();
  left.triangle_offsets = places.triangle_offsets;
  const constrained::LeftBuffers buffers{.triangles = call.out<cl_int>(left.triangles, corners),
                                         .neighbors = call.out<cl_int>(left.neighbors, corners),
                                         .constrained = call.out<cl_uchar>(left.constrained, corners),
                                         .regions = numbers};
  write_left(call.runtime, mesh, places, buffers, regions);
  mesh.triangle_offsets = places.triangle_offsets;
  mesh.triangles = buffers.triangles;
  mesh.neighbors = buffers.neighbors;
  mesh.constrained = buffers.constrained;
}

}  // namespace

DomainRequest request_of(const ConstrainedOptions& options, bool are_closed) {
  return {{options.fill_rule, options.outside, are_closed}, options.labels};
}

void apply_domains(Frame& call, Engine& with_doubles, constrained::DomainMesh& mesh,
                   const double* coordinates, const std::vector<std::size_t>& offsets,
                   const Constraints& constraints, const DomainRequest& request,
                   ConstrainedTriangulation& result, Left& left) {
  host::Runtime& runtime = call.runtime;
  constrained::Regions regions = find_regions(runtime, mesh);
  if (request.needs_depths() && request.curves != nullptr) {
    find_polygons(call, coordinates, constraints, request, result, regions);
  } else if (request.needs_depths()) {
    find_depths(runtime, mesh, request.rules, regions);
  }
  const auto find = [&](const constrained::Places& places) {
    std::vector<std::int32_t> found =
        find_places(call, with_doubles, mesh, places, coordinates, offsets, result);
    constrained::check_found(places, found);
    return found;
  };
  if (constraints.hole_count > 0) {
    drop_holes(runtime, find(constrained::holes_of(constraints, offsets.size() - 1)), regions);
  }
  if (constraints.seed_count > 0) {
    label_seeds(runtime, find(constrained::seeds_of(constraints, offsets.size() - 1)), mesh.triangle_count(),
                regions);
  }
  std::size_t triangles = mesh.triangle_count();
  constrained::LeftPlaces places;
  if (request.rules.outside != Outside::keep || constraints.hole_count > 0) {
    places = place_left(runtime, mesh, regions);
    triangles = places.triangle_offsets.back();
  }
  const bool are_all_left = triangles == mesh.triangle_count();
  const auto numbers = request.labels ? call.out<cl_int>(result.regions, triangles)
                                      : runtime.arena().allocate<cl_int>(triangles);
  if (!are_all_left) {
    leave(call, mesh, places, numbers, regions, result, left);
  } else if (request.labels) {
    runtime.copy(regions.of_triangles, 0, numbers, 0, triangles);
  }
  const auto write = [&](const Buffer<cl_int>& labels, std::vector<std::int32_t>& to) {
    const auto buffer = call.out<cl_int>(to, triangles);
    constrained::write_labels(runtime, triangles, regions.of_triangles, labels, buffer);
  };
  if (request.labels) write(regions.depths, result.depths);
  if (request.polygons) write(regions.polygons, result.polygons);
  if (constraints.seed_count > 0) write(regions.seeds, left.seeds);
}

std::vector<std::int32_t> take_left(const Constraints& constraints, Left& left,
                                    ConstrainedTriangulation& result) {
  if (constraints.seed_attributes != nullptr) {
    for (const std::int32_t seed : left.seeds) {
      result.triangle_attributes.push_back(seed < 0 ? 0 : constraints.seed_attributes[seed]);
    }
  }
  if (!left.triangle_offsets.empty()) {
    result.triangles = std::move(left.triangles);
    result.neighbors = std::move(left.neighbors);
    result.constrained = std::move(left.constrained);
    result.triangle_offsets = std::move(left.triangle_offsets);
  }
  return std::move(left.seeds);
}

std::vector<std::int32_t> apply_domains_on(Engine& engine, Engine& with_doubles, const double* coordinates,
                                           const std::vector<std::size_t>& offsets,
                                           const Constraints& constraints, const DomainRequest& request,
                                           ConstrainedTriangulation& result) {
  Left left;
  Frame call(engine);
  constrained::DomainMesh mesh = mesh_of(call, coordinates, offsets, constraints, result);
  apply_domains(call, with_doubles, mesh, coordinates, offsets, constraints, request, result, left);
  call.end();
  return take_left(constraints, left, result);
}

}  // namespace flaunay::call
