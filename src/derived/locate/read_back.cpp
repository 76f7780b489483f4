#include "derived/locate/read_back.hpp"

#include <cmath>
#include <numeric>

namespace flaunay::locate {
namespace {

template <typename T>
std::vector<T> read_all(host::Runtime& runtime, const Buffer<T>& from, std::size_t count) {
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

ReadMesh read_back(host::Runtime& runtime, const Locator& locator) {
  const std::size_t sets = locator.sets, triangles = locator.faces.size(), hull = locator.hull.size();
  const host::Runtime::Settled settled(runtime);
  const auto firsts = read_all(runtime, locator.first_vertices, sets + 1);
  const auto vertices = static_cast<std::size_t>(firsts.back());
  const auto records = read_all(runtime, locator.records, sets);
  const auto places = read_all(runtime, locator.points.as<cl_long2>(), vertices);
  const auto source = read_all(runtime, locator.source, vertices);
  const auto hull_places = read_all(runtime, locator.hull_points.as<cl_long2>(), hull);
  const auto faces = read_all(runtime, locator.faces, triangles);

  ReadMesh mesh;
  Triangulation& made = mesh.triangulation;
  made.hull = read_all(runtime, locator.hull, hull);
  mesh.point_offsets = locator.point_offsets;
  mesh.coordinates.resize(2 * mesh.point_offsets.back());
  made.representatives.resize(mesh.point_offsets.back());
  std::iota(made.representatives.begin(), made.representatives.end(), 0);
  made.triangle_offsets = made.hull_offsets = {0};
  for (std::size_t s = 0; s < sets; ++s) {
    const auto first = static_cast<std::size_t>(records[s].hull),
               end = static_cast<std::size_t>(records[s].hull_end);
    made.triangle_offsets.push_back(made.triangle_offsets.back() +
                                    static_cast<std::size_t>(records[s].triangles));
    made.hull_offsets.push_back(end);
    if (first == end) continue;
    const int shift = locator.range.shift(s);
    for (std::size_t i = mesh.point_offsets[s]; i < mesh.point_offsets[s + 1]; ++i) {
      for (std::size_t k = 0; k < 2; ++k) {
        mesh.coordinates[2 * i + k] = std::ldexp(static_cast<double>(hull_places[first].s[k]), -shift);
      }
    }
    write_coordinates(hull_places, made.hull, first, end, shift, mesh.coordinates);
    write_coordinates(places, source, static_cast<std::size_t>(firsts[s]),
                      static_cast<std::size_t>(firsts[s + 1]), shift, mesh.coordinates);
  }
  for (const kernel::face& face : faces) {
    for (int k = 0; k < 3; ++k) {
      made.triangles.push_back(source[static_cast<std::size_t>(face.corner[k])]);
      made.neighbors.push_back(face.neighbor[k]);
    }
  }
  return mesh;
}

}  // namespace flaunay::locate
