#include "derived/locate/read_back.hpp"

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace flaunay::locate {
namespace {

template <typename T>
std::vector<T> read_all(host::Runtime& runtime, const host::Buffer<T>& from, std::size_t count) {
  std::vector<T> values(count);
  runtime.read(from, 0, count, values.data());
  return values;
}

// The coordinates of places of the grid, by the numbers of their points.
void write_coordinates(const std::vector<cl_long2>& places, const std::vector<cl_int>& points,
                       std::size_t first, std::size_t end, int shift, std::vector<double>& coordinates) {
  for (std::size_t i = first; i < end; ++i) {
    double* const to = &coordinates[2 * static_cast<std::size_t>(points[i])];
    for (int k = 0; k < 2; ++k) to[k] = std::ldexp(static_cast<double>(places[i].s[k]), -shift);
  }
}

}  // namespace

points::DeviceMesh read_back(host::Runtime& from, const Locator& locator, host::Runtime& to) {
  const std::size_t sets = locator.sets, hull = locator.hull.size();
  const host::Runtime::Settled settled(from);
  const auto firsts = read_all(from, locator.first_vertices, sets + 1);
  const auto vertices = static_cast<std::size_t>(firsts.back());
  const auto records = read_all(from, locator.records, sets);
  const auto places = read_all(from, locator.points.as<cl_long2>(), vertices);
  const auto source = read_all(from, locator.source, vertices);
  const auto hull_places = read_all(from, locator.hull_points.as<cl_long2>(), hull);
  const auto faces = read_all(from, locator.faces, locator.faces.size());
  auto hull_vertices = read_all(from, locator.hull, hull);

  points::DeviceMesh mesh;
  mesh.point_offsets = locator.point_offsets;
  mesh.triangle_offsets = mesh.hull_offsets = {0};
  std::vector<double> coordinates(2 * mesh.points());
  for (std::size_t s = 0; s < sets; ++s) {
    const auto first = static_cast<std::size_t>(records[s].hull),
               end = static_cast<std::size_t>(records[s].hull_end);
    mesh.triangle_offsets.push_back(mesh.triangle_count() + static_cast<std::size_t>(records[s].triangles));
    mesh.hull_offsets.push_back(end);
    if (first == end) continue;
    const int shift = locator.range.shift(s);
    for (std::size_t i = mesh.point_offsets[s]; i < mesh.point_offsets[s + 1]; ++i) {
      for (std::size_t k = 0; k < 2; ++k) {
        coordinates[2 * i + k] = std::ldexp(static_cast<double>(hull_places[first].s[k]), -shift);
      }
    }
    write_coordinates(hull_places, hull_vertices, first, end, shift, coordinates);
    write_coordinates(places, source, static_cast<std::size_t>(firsts[s]),
                      static_cast<std::size_t>(firsts[s + 1]), shift, coordinates);
  }
  std::vector<cl_int> representatives(mesh.points()), triangles, neighbors;
  std::iota(representatives.begin(), representatives.end(), 0);
  for (const kernel::face& face : faces) {
    for (int k = 0; k < 3; ++k) {
      triangles.push_back(source[static_cast<std::size_t>(face.corner[k])]);
      neighbors.push_back(face.neighbor[k]);
    }
  }
  mesh.coordinates = to.upload(to.arena(), std::move(coordinates));
  mesh.triangles = to.upload(to.arena(), std::move(triangles));
  mesh.neighbors = to.upload(to.arena(), std::move(neighbors));
  mesh.hull = to.upload(to.arena(), std::move(hull_vertices));
  mesh.representatives = to.upload(to.arena(), std::move(representatives));
  return mesh;
}

}  // namespace flaunay::locate
