// The public call for points of a sphere in device memory. The device computes places, triangles in the plane
// and rows of results; the host makes the few triangles around the south pole.
#include <algorithm>
#include <utility>

#include "call/triangulate.hpp"
#include "derived/sphere/close.hpp"
#include "derived/sphere/places.hpp"
#include "flaunay/device_memory.hpp"
#include "flaunay/sphere.hpp"
#include "launchers/sphere/cap.cl.hpp"
#include "launchers/sphere/places.cl.hpp"

namespace flaunay {
namespace {

using host::Buffer;
using Ids = std::vector<cl_int>;
using Offsets = std::vector<std::size_t>;

// Computes places, and returns whether the south pole is among them.
template <typename T, typename Kernel>
bool write_places(call::Frame& call, const DevicePoints& points, SphereCoordinates coordinates,
                  const Buffer<cl_double>& places) {
  const std::size_t n = points.count, width = sphere::width_of(coordinates), first = points.first * width;
  const auto given = call.in<T>(points.memory, first + n * width, "points");
  const auto first_wrong = call.runtime.arena().allocate<cl_int>(1),
             first_pole = call.runtime.arena().allocate<cl_int>(1);
  for (const auto& found : {first_wrong, first_pole}) call.runtime.fill(found, 1, static_cast<cl_int>(n));
  call.runtime.map(n, Kernel{.width = static_cast<cl_int>(width),
                             .first = first,
                             .points = given,
                             .places = places.as<cl_double2>(),
                             .first_wrong = first_wrong,
                             .first_pole = first_pole});
  const auto wrong = static_cast<std::size_t>(call.runtime.read_one(first_wrong, 0));
  if (wrong < n) {
    T numbers[3] = {};
    call.runtime.read(given, first + wrong * width, width, numbers);
    const double wide[3] = {numbers[0], numbers[1], numbers[2]};
    sphere::refuse(wide, wrong, coordinates, "point");
  }
  return static_cast<std::size_t>(call.runtime.read_one(first_pole, 0)) < n;
}

bool write_places(call::Frame& call, const DevicePoints& points, SphereCoordinates coordinates,
                  const Buffer<cl_double>& places) {
  return points.precision == Precision::float64
             ? write_places<cl_double, kernels::places_of_doubles>(call, points, coordinates, places)
             : write_places<cl_float, kernels::places_of_floats>(call, points, coordinates, places);
}

// The hulls of all sets, on the host.
struct Hulls {
  Ids vertices, edges;  // edges: 3 t + the corner opposite, of the triangle at the edge from a vertex
  std::vector<cl_double2> places;
};

Hulls read_hulls(call::Frame& call, const DeviceTriangulation& planar, const Buffer<cl_double>& places,
                 const Buffer<cl_int>& triangles, const Buffer<cl_int>& neighbors) {
  host::Runtime& runtime = call.runtime;
  const std::size_t vertices = planar.hull_offsets.back();
  const auto hull = call.in<cl_int>(planar.hull, vertices, "hull");
  const auto edge_from = runtime.arena().allocate<cl_int>(planar.points);
  const auto edges = runtime.arena().allocate<cl_int>(vertices);
  const auto hull_places = runtime.arena().allocate<cl_double2>(vertices);
  runtime.map(3 * planar.triangle_offsets.back(),
              kernels::open_edges{.triangles = triangles, .neighbors = neighbors, .edge_from = edge_from});
  runtime.map(vertices, kernels::gather_hull{.hull = hull,
                                             .places = places.as<cl_double2>(),
                                             .edge_from = edge_from,
                                             .hull_places = hull_places,
                                             .edges = edges});
  Hulls found{Ids(vertices), Ids(vertices), std::vector<cl_double2>(vertices)};
  runtime.read_later(hull, 0, vertices, found.vertices.data());
  runtime.read_later(edges, 0, vertices, found.edges.data());
  runtime.read_later(hull_places, 0, vertices, found.places.data());
  runtime.finish();
  return found;
}

// The caps of all sets.
struct Caps {
  Ids triangles, neighbors;     // neighbours are numbered as in the result
  std::vector<cl_int2> links;   // of a corner in the plane's triangles, as numbered in the result
  Offsets triangle_offsets{0};  // of all triangles of the sets
};

Caps make_caps(const Hulls& hulls, const DeviceTriangulation& planar) {
  Caps caps;
  for (std::size_t s = 0; s + 1 < planar.hull_offsets.size(); ++s) {
    const std::size_t first = planar.hull_offsets[s], end = planar.hull_offsets[s + 1];
    const std::size_t triangles = planar.triangle_offsets[s + 1] - planar.triangle_offsets[s];
    const auto corner = static_cast<cl_int>(3 * planar.triangle_offsets[s]);
    sphere::PlanarSet set{{}, {}, -1};
    std::vector<sphere::OpenEdge> open;
    for (std::size_t i = first; i < end; ++i) {
      set.hull.push_back(hulls.vertices[i]);
      set.places.push_back({hulls.places[i].s[0], hulls.places[i].s[1]});
      const std::size_t next = i + 1 == end ? first : i + 1;
      if (triangles > 0) open.push_back({hulls.vertices[i], hulls.vertices[next], hulls.edges[i] - corner});
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

Ids narrow(const Offsets& offsets) { return {offsets.begin(), offsets.end()}; }

void write_triangles(call::Frame& call, DeviceSphericalTriangulation& result) {
  const DeviceTriangulation& planar = result.planar;
  const std::size_t n = planar.points, planar_triangles = planar.triangle_offsets.back();
  const auto places = call.in<cl_double>(result.places, 2 * n, "places");
  const auto from = call.in<cl_int>(planar.triangles, 3 * planar_triangles, "triangles in the plane");
  const auto beyond = call.in<cl_int>(planar.neighbors, 3 * planar_triangles, "neighbors in the plane");
  Caps caps = make_caps(read_hulls(call, planar, places, from, beyond), planar);
  const std::size_t rows = caps.triangle_offsets.back(), links = caps.links.size();
  const auto triangles = call.output<cl_int>(result.triangles, 6 * n, "triangles").buffer(3 * rows);
  const auto neighbors = call.output<cl_int>(result.neighbors, 6 * n, "neighbors").buffer(3 * rows);
  call.check_distinct();
  host::Runtime& runtime = call.runtime;
  host::Arena& arena = runtime.arena();
  runtime.map(rows,
              kernels::place_sphere_rows{.sets = static_cast<cl_int>(caps.triangle_offsets.size() - 1),
                                         .sums = runtime.upload(arena, narrow(caps.triangle_offsets)),
                                         .plane_sums = runtime.upload(arena, narrow(planar.triangle_offsets)),
                                         .plane_triangles = from,
                                         .plane_neighbors = beyond,
                                         .cap_triangles = runtime.upload(arena, std::move(caps.triangles)),
                                         .cap_neighbors = runtime.upload(arena, std::move(caps.neighbors)),
                                         .triangles = triangles,
                                         .neighbors = neighbors});
  runtime.map(links, kernels::link_cap{.links = runtime.upload(arena, std::move(caps.links)),
                                       .neighbors = neighbors});
  result.triangle_offsets = std::move(caps.triangle_offsets);
}

// The points again, for the host.
template <typename T>
std::vector<double> read_points(call::Frame& call, const DevicePoints& points,
                                SphereCoordinates coordinates) {
  const std::size_t width = sphere::width_of(coordinates), first = points.first * width;
  std::vector<T> given(points.count * width);
  call.runtime.read(call.in<T>(points.memory, first + given.size(), "points"), first, given.size(),
                    given.data());
  return {given.begin(), given.end()};
}

template <typename T>
void write(call::Frame& call, DeviceBuffer& to, std::size_t most, const char* what, std::vector<T> values) {
  call::write_result(call.runtime, call.output<T>(to, most, what).buffer(values.size()), std::move(values));
}

void write_all(call::Frame& call, SphericalTriangulation mesh, DeviceSphericalTriangulation& result) {
  const std::size_t n = mesh.representatives.size();
  write<cl_int>(call, result.triangles, 6 * n, "triangles", std::move(mesh.triangles));
  write<cl_int>(call, result.neighbors, 6 * n, "neighbors", std::move(mesh.neighbors));
  write<cl_int>(call, result.representatives, n, "representatives", std::move(mesh.representatives));
  result.triangle_offsets = std::move(mesh.triangle_offsets);
  result.statistics = std::move(mesh.statistics);
}

}  // namespace

void triangulate_sphere(Triangulator& triangulator, const DevicePoints& points, SphereCoordinates coordinates,
                        DeviceSphericalTriangulation& result, const Enqueue& enqueue) {
  call::Implementation& self = TriangulatorAccess::implementation(triangulator);
  const std::size_t n = points.count;
  Enqueue first = enqueue, rest = enqueue;
  first.event = nullptr;
  rest.wait_for.clear();
  std::vector<double> for_host;
  call::take_turn(self, enqueue, [&] {
    check_enumerator(coordinates);
    call::Frame call(self, call::with_doubles(self, self.on_device()), first);
    call.check(points, "points");
    check_count(n, "points", kMostPointsAtOnce);
    call.begin();
    result.point_offsets = call.offsets(points);
    result.triangle_offsets.assign(result.point_offsets.size(), 0);
    result.statistics = {};
    if (n == 0) return;
    const auto places = call.out<cl_double>(result.places, 2 * n, "places");
    call.check_distinct();
    if (write_places(call, points, coordinates, places)) {
      for_host = points.precision == Precision::float64 ? read_points<cl_double>(call, points, coordinates)
                                                        : read_points<cl_float>(call, points, coordinates);
    }
    call.end();
  });
  SphericalTriangulation mesh;
  if (!for_host.empty()) {
    mesh = triangulate_sphere(triangulator, for_host.data(), result.point_offsets, coordinates);
  }
  call::take_turn(self, [&] {
    if (n > 0 && for_host.empty()) {
      DevicePoints in_plane;
      in_plane.memory = result.places.memory();
      in_plane.count = n;
      in_plane.offsets = result.point_offsets;
      Parts parts;
      parts.neighbors = parts.hull = parts.representatives = true;
      result.planar.representatives = result.representatives;
      Enqueue between = rest;
      between.event = nullptr;
      call::triangulate(self, in_plane, result.planar, parts, between);
      result.representatives = result.planar.representatives;
      result.statistics = result.planar.statistics;
    }
    // Copies alone need no doubles.
    call::Engine& device = self.on_device();
    call::Frame call(self, for_host.empty() ? call::with_doubles(self, device) : call::Place{device, &device},
                     rest);
    call.begin();
    if (!for_host.empty()) {
      write_all(call, std::move(mesh), result);
    } else if (n > 0) {
      write_triangles(call, result);
    }
    call.end();
  });
}

}  // namespace flaunay
