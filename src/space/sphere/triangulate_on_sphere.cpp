// Triangulations and Voronoi diagrams on the sphere.
#include "space/sphere/triangulate_on_sphere.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "flaunay/device_memory.hpp"
#include "flaunay/sphere.hpp"
#include "geometry/arguments.hpp"
#include "launchers/sphere/cap.cl.hpp"
#include "mesh/corners.hpp"
#include "prove/sphere_proof.hpp"
#include "space/spaces.hpp"
#include "space/sphere/close.hpp"
#include "space/sphere/places.hpp"
#include "space/sphere/plane.hpp"
#include "space/triangulate.hpp"
#include "sphere/places.h"
#include "sphere/records.h"

namespace flaunay {
namespace {

using host::Buffer;
using Ids = std::vector<std::int32_t>;
using Offsets = std::vector<std::size_t>;
using sphere::Plane;
using sphere::Point;

using HullVertices = std::vector<kernel::hull_vertex>;

// The hulls of all sets.
template <typename Planar>
HullVertices read_hulls(call::Frame& call, const Planar& planar, const Buffer<cl_double>& places,
                        const Buffer<cl_int>& triangles, const Buffer<cl_int>& neighbors) {
  host::Runtime& runtime = call.runtime;
  HullVertices hulls(planar.hull_offsets.back());
  const auto edge_from = runtime.arena().allocate<cl_int>(places.size() / 2);
  const auto vertices = runtime.arena().allocate<kernel::hull_vertex>(hulls.size());
  runtime.map(planar.triangle_offsets.back(),
              kernels::open_edges{.triangles = triangles, .neighbors = neighbors, .edge_from = edge_from});
  runtime.map(hulls.size(),
              kernels::gather_hull{.hull = call.template in<cl_int>(planar.hull, hulls.size(), "hull"),
                                   .places = places.as<cl_double2>(),
                                   .edge_from = edge_from,
                                   .vertices = vertices});
  runtime.read(vertices, 0, hulls.size(), hulls.data());
  return hulls;
}

// The caps of all sets.
struct Caps {
  Ids triangles, neighbors;    // neighbours are numbered as in the result
  std::vector<cl_int2> links;  // of a corner in the plane's triangles, as numbered in the result
  Offsets triangle_offsets;    // of all triangles of the sets
};

template <typename Planar>
Caps make_caps(const HullVertices& hulls, const Planar& planar, const Plane& plane) {
  Caps caps;
  caps.triangles.reserve(3 * hulls.size());
  caps.neighbors.reserve(3 * hulls.size());
  caps.links.reserve(hulls.size());
  caps.triangle_offsets.reserve(planar.hull_offsets.size());
  caps.triangle_offsets.push_back(0);
  for (std::size_t s = 0; s + 1 < planar.hull_offsets.size(); ++s) {
    const std::size_t first = planar.hull_offsets[s], end = planar.hull_offsets[s + 1];
    const std::size_t triangles = planar.triangle_offsets[s + 1] - planar.triangle_offsets[s];
    const auto corner = static_cast<cl_int>(3 * planar.triangle_offsets[s]);
    sphere::PlanarSet set{{}, {}, plane.poles[s].empty() ? -1 : plane.poles[s].front()};
    std::vector<sphere::OpenEdge> open;
    set.hull.reserve(end - first);
    set.places.reserve(end - first);
    if (triangles > 0) open.reserve(4 * (end - first));  // with those of the cap
    for (std::size_t i = first; i < end; ++i) {
      const kernel::hull_vertex& vertex = hulls[i];
      set.hull.push_back(vertex.point);
      set.places.push_back({vertex.x, vertex.y});
      const std::int32_t next = hulls[i + 1 == end ? first : i + 1].point;
      if (triangles > 0) open.push_back({vertex.point, next, vertex.edge - corner});
    }
    const sphere::Cap cap = sphere::close(set, std::move(open), triangles);
    const auto begin = static_cast<cl_int>(caps.triangle_offsets.back());
    const std::size_t before = caps.neighbors.size();
    for (const auto& corners : cap.triangles)
      caps.triangles.insert(caps.triangles.end(), corners.begin(), corners.end());
    caps.neighbors.resize(caps.triangles.size());
    for (const auto& [at, beyond] : cap.links) {
      const auto place = static_cast<std::size_t>(at);
      if (place < 3 * triangles) {
        caps.links.push_back({{3 * begin + at, begin + beyond}});
      } else {
        caps.neighbors[before + place - 3 * triangles] = begin + beyond;
      }
    }
    caps.triangle_offsets.push_back(caps.triangle_offsets.back() + triangles + cap.triangles.size());
  }
  return caps;
}

// The rows of a single set in host memory stay where they are. Returns whether it is one.
bool append(const Caps& caps, Triangulation& planar, Triangulation& result) {
  if (result.point_offsets.size() != 2) return false;
  result.triangles = std::move(planar.triangles);
  result.neighbors = std::move(planar.neighbors);
  for (Ids* const rows : {&result.triangles, &result.neighbors}) rows->reserve(6 * result.point_offsets[1]);
  result.triangles.insert(result.triangles.end(), caps.triangles.begin(), caps.triangles.end());
  result.neighbors.insert(result.neighbors.end(), caps.neighbors.begin(), caps.neighbors.end());
  for (const cl_int2& link : caps.links) result.neighbors[static_cast<std::size_t>(link.s[0])] = link.s[1];
  return true;
}
bool append(const Caps&, const DeviceTriangulation&, DeviceTriangulation&) { return false; }

Ids narrow(const Offsets& offsets) { return {offsets.begin(), offsets.end()}; }

// planar: its arrays are numbered by the points of the sphere.
template <typename Planar, typename Result>
void write_triangles(call::Frame& call, const Plane& plane, Planar& planar, Result& result) {
  const std::size_t n = result.point_offsets.back(), planar_corners = 3 * planar.triangle_offsets.back();
  const auto places = call.template in<cl_double>(result.places, 2 * n, "places");
  const auto from = call.template in<cl_int>(planar.triangles, planar_corners, "triangles in the plane");
  const auto beyond = call.template in<cl_int>(planar.neighbors, planar_corners, "neighbors in the plane");
  Caps caps = make_caps(read_hulls(call, planar, places, from, beyond), planar, plane);
  const Offsets& sums = result.triangle_offsets = std::move(caps.triangle_offsets);
  if (append(caps, planar, result)) return;
  const std::size_t rows = sums.back(), links = caps.links.size();
  const auto triangles = call.template output<cl_int>(result.triangles, 6 * n, "triangles").buffer(3 * rows);
  const auto neighbors = call.template output<cl_int>(result.neighbors, 6 * n, "neighbors").buffer(3 * rows);
  call.check_distinct();
  host::Runtime& runtime = call.runtime;
  host::Arena& arena = runtime.arena();
  runtime.map(rows,
              kernels::place_sphere_rows{.sets = static_cast<cl_int>(sums.size() - 1),
                                         .sums = runtime.upload(arena, narrow(sums)),
                                         .plane_sums = runtime.upload(arena, narrow(planar.triangle_offsets)),
                                         .plane_triangles = from,
                                         .plane_neighbors = beyond,
                                         .cap_triangles = runtime.upload(arena, std::move(caps.triangles)),
                                         .cap_neighbors = runtime.upload(arena, std::move(caps.neighbors)),
                                         .triangles = triangles,
                                         .neighbors = neighbors});
  runtime.map(links, kernels::link_cap{.links = runtime.upload(arena, std::move(caps.links)),
                                       .neighbors = neighbors});
}

// Computes places. If one is the south pole, returns the points for the host.
template <typename T>
std::vector<double> write_places(call::Frame& call, const DevicePoints& points, SphereCoordinates coordinates,
                                 const Buffer<cl_double>& places) {
  const std::size_t n = points.count, width = sphere::width_of(coordinates), first = points.first * width;
  const auto given = call.in<T>(points.memory, first + n * width, "points");
  if (!sphere::find_places(call.runtime, given, first, n, coordinates, places, "point")) return {};
  std::vector<T> values(n * width);
  call.runtime.read(given, first, values.size(), values.data());
  return {values.begin(), values.end()};
}

std::vector<double> write_places(call::Implementation& self, const DevicePoints& points,
                                 SphereCoordinates coordinates, DeviceTriangulation& result,
                                 const Enqueue& enqueue) {
  call::Frame call(self, call::with_doubles(self, self.on_device()), enqueue);
  call.check(points, "points", SpaceKind::sphere);
  check_count(points.count, "points", kMostPointsAtOnce);
  call.begin();
  result.point_offsets = call.offsets(points);
  result.triangle_offsets.assign(result.point_offsets.size(), 0);
  result.statistics = {};
  if (points.count == 0) return {};
  const auto places = call.out<cl_double>(result.places, 2 * points.count, "places");
  call.check_distinct();
  std::vector<double> for_host = points.precision == Precision::float64
                                     ? write_places<cl_double>(call, points, coordinates, places)
                                     : write_places<cl_float>(call, points, coordinates, places);
  call.end();
  return for_host;
}

void triangulate_plane(call::Implementation& self, std::size_t n, DeviceTriangulation& result,
                       Enqueue enqueue) {
  enqueue.event = nullptr;
  DevicePoints in_plane;
  in_plane.memory = result.places.memory();
  in_plane.count = n;
  in_plane.offsets = result.point_offsets;
  Parts parts;
  parts.neighbors = parts.hull = parts.representatives = true;
  if (!result.planar) result.planar = std::make_shared<DeviceTriangulation>();
  DeviceTriangulation& planar = *result.planar;
  planar.representatives = result.representatives;
  call::triangulate(self, in_plane, planar, parts, enqueue);
  result.representatives = planar.representatives;
  result.statistics = planar.statistics;
}

template <typename T>
void write(call::Frame& call, DeviceBuffer& to, std::size_t most, const char* what, std::vector<T> values) {
  call::write_result(call.runtime, call.output<T>(to, most, what).buffer(values.size()), std::move(values));
}

void write_all(call::Frame& call, Triangulation mesh, DeviceTriangulation& result) {
  const std::size_t n = mesh.representatives.size();
  write<cl_int>(call, result.triangles, 6 * n, "triangles", std::move(mesh.triangles));
  write<cl_int>(call, result.neighbors, 6 * n, "neighbors", std::move(mesh.neighbors));
  write<cl_int>(call, result.representatives, n, "representatives", std::move(mesh.representatives));
  result.triangle_offsets = std::move(mesh.triangle_offsets);
  result.statistics = std::move(mesh.statistics);
}

void check_arrays(const Triangulation& mesh) {
  call::expect(mesh.space.kind == SpaceKind::sphere, "the triangulation is not one on the sphere");
  call::expect(call::do_arrays_fit(mesh, 0), "the arrays are not those of a triangulation on the sphere");
}

}  // namespace

namespace call {
namespace {

Triangulation triangulate_on_sphere(Implementation& self, const HostPoints& points, const Offsets& offsets,
                                    const Space& space, const Options& /*options*/) {
  const std::size_t n = points.count;
  const SphereCoordinates coordinates = space.coordinates;
  check_points(points.wide, n);
  check_enumerator(coordinates);
  Triangulation result;
  result.space = Space::sphere(coordinates);
  result.point_offsets = offsets;
  Triangulation planar;
  Frame call(self.native_for(n));
  const bool has_pole =
      sphere::find_places(call.runtime, call.in<cl_double>(points.wide, n * sphere::width_of(coordinates)), 0,
                          n, coordinates, call.out<cl_double>(result.places, 2 * n), "point");
  const Plane plane = sphere::make_plane(result.places, offsets, has_pole);
  planar = triangulate(self, {plane.places().data(), nullptr, plane.offsets.back()}, plane.offsets, {});
  sphere::number_by_points(plane, n, planar);
  write_triangles(call, plane, planar, result);
  call.end();
  result.representatives = std::move(planar.representatives);
  result.statistics = std::move(planar.statistics);
  std::size_t duplicates = 0;
  for (std::size_t i = 0; i < n; ++i) duplicates += result.representatives[i] != static_cast<std::int32_t>(i);
  write_counts(duplicates, result);
  return result;
}

void triangulate_on_sphere(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                           const Parts& /*parts*/, const Enqueue& enqueue) {
  const SphereCoordinates coordinates = points.space.coordinates;
  check_enumerator(coordinates);
  result.points = points.count;
  result.parts = kPartsInSpace;
  result.hull_offsets.clear();
  result.images = 0;
  Enqueue first = enqueue, rest = enqueue;
  first.event = nullptr;
  rest.wait_for.clear();
  const std::vector<double> for_host = write_places(self, points, coordinates, result, first);
  if (!for_host.empty()) {
    Triangulation mesh = triangulate_on_sphere(self, {for_host.data(), nullptr, points.count},
                                               result.point_offsets, points.space, {});
    // Copies alone need no doubles.
    Engine& device = self.on_device();
    Frame call(self, Place{device, &device}, rest);
    call.begin();
    write_all(call, std::move(mesh), result);
    return call.end();
  }
  if (points.count > 0) triangulate_plane(self, points.count, result, rest);
  Frame call(self, with_doubles(self, self.on_device()), rest);
  call.begin();
  if (points.count > 0) {
    Plane plane;
    plane.poles.resize(result.point_offsets.size() - 1);
    write_triangles(call, plane, *result.planar, result);
    write_counts(result.statistics.duplicates, result);
  }
  call.end();
}

std::string find_problem_on_sphere(const double* points, const Offsets& offsets, const Space& space,
                                   const Triangulation& mesh) {
  check_arrays(mesh);
  if (offsets != mesh.point_offsets) return "the sets have other points";
  return prove::find_problem(places_of(points, offsets.back(), space), mesh);
}

}  // namespace

const SpaceCalls kOnSphere{
    .refusal_of_weights = "points on the sphere have no weights",
    .refusal_of_polygons = "cells on the sphere are not clipped to a polygon",
    .triangulate = triangulate_on_sphere,
    .triangulate_on_device = triangulate_on_sphere,
    .find_problem = find_problem_on_sphere,
    .width = [](const Space& space) { return sphere::width_of(space.coordinates); },
    .places = sphere::to_places,
    .dual = sphere::make_dual,
    .centroids = sphere::centroids,
    .tree = [](Triangulator& triangulator, const Triangulation& mesh) -> std::unique_ptr<nearest::Tree> {
      return std::make_unique<SphereLocator>(triangulator, mesh);
    }};

}  // namespace call

void call::check_on_sphere(const Triangulation& mesh) {
  check_arrays(mesh);
  for (std::size_t i = 0; i < mesh.places.size() / 2; ++i) {
    const Point place = sphere::place_at(mesh.places, i), known = kernel::rounded_place(place.x, place.y);
    call::expect(place.x == known.x && place.y == known.y, [&] {
      return fmt::format("place {} of the triangulation on the sphere is none: ({}, {})", i, place.x,
                         place.y);
    });
  }
  // Each edge has the same ends in the triangle beyond it, so that walks around a point come back.
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::size_t first = 3 * static_cast<std::size_t>(mesh.neighbors[c]);
    const auto [from, to] = mesh::edge_opposite(mesh.triangles, c);
    bool has_edge = false;
    for (std::size_t k = 0; k < 3; ++k) {
      has_edge |= mesh.triangles[first + k] == to && mesh.triangles[first + (k + 1) % 3] == from &&
                  mesh.neighbors[first + (k + 2) % 3] == static_cast<std::int32_t>(c / 3);
    }
    call::expect(has_edge, "the arrays are not those of a triangulation on the sphere");
  }
}

std::vector<double> directions_of(const std::vector<double>& places) {
  std::vector<double> directions;
  directions.reserve(places.size() / 2 * 3);
  for (std::size_t i = 0; i < places.size() / 2; ++i) {
    const sphere::Direction d = sphere::direction_of(sphere::place_at(places, i));
    directions.insert(directions.end(), {d.x, d.y, d.z});
  }
  return directions;
}

}  // namespace flaunay
