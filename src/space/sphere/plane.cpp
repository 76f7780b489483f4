#include "space/sphere/plane.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "mesh/corners.hpp"

namespace flaunay::sphere {
namespace {

using Ids = std::vector<std::int32_t>;

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

// Whether a triangle turns left in the plane, as none does that closes the gap around the pole.
bool is_in_plane(const Triangulation& mesh, std::size_t t) {
  Point corners[3];
  for (std::size_t k = 0; k < 3; ++k) corners[k] = place_at(mesh.places, index(mesh.triangles[3 * t + k]));
  if (std::any_of(corners, corners + 3, is_pole)) return false;
  return kernel::orient_sign(corners[0], corners[1], corners[2], ORIENT_BOUND) > 0;
}

// Appends the border of the triangles from a row on: its corners, counter-clockwise, from its first point on.
void append_border(const std::vector<double>& places, std::size_t first_row, Triangulation& planar) {
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::size_t c = 3 * first_row; c < planar.neighbors.size(); ++c) {
    if (planar.neighbors[c] >= 0) continue;
    edges.push_back(mesh::edge_opposite(planar.triangles, c));
  }
  std::sort(edges.begin(), edges.end());
  const auto first = std::min_element(edges.begin(), edges.end(), [&](const auto& a, const auto& b) {
    return kernel::comes_before(place_at(places, index(a.first)), place_at(places, index(b.first))) != 0;
  });
  const std::size_t end = planar.hull.size() + edges.size();
  for (auto edge = first; planar.hull.size() < end;) {
    planar.hull.push_back(edge->first);
    edge = std::lower_bound(edges.begin(), edges.end(), std::pair(edge->second, std::int32_t{0}));
    if (edge == edges.end()) break;  // of arrays that are no triangulation's
  }
}

// Appends the vertices of a set whose points are all on a line in the plane, in their order there.
void append_line(const Triangulation& mesh, std::size_t s, Ids& hull) {
  const std::size_t begin = hull.size();
  for (std::size_t i = mesh.point_offsets[s]; i < mesh.point_offsets[s + 1]; ++i) {
    if (index(mesh.representatives[i]) == i && !is_pole(place_at(mesh.places, i)))
      hull.push_back(static_cast<std::int32_t>(i));
  }
  std::sort(
      hull.begin() + static_cast<std::ptrdiff_t>(begin), hull.end(), [&](std::int32_t a, std::int32_t b) {
        return kernel::comes_before(place_at(mesh.places, index(a)), place_at(mesh.places, index(b))) != 0;
      });
}

}  // namespace

Plane make_plane(const std::vector<double>& places, const std::vector<std::size_t>& offsets, bool has_pole) {
  Plane plane;
  plane.poles.resize(offsets.size() - 1);
  for (std::size_t s = 0; has_pole && s + 1 < offsets.size(); ++s) {
    for (std::size_t i = offsets[s]; i < offsets[s + 1]; ++i) {
      if (is_pole(place_at(places, i))) plane.poles[s].push_back(static_cast<std::int32_t>(i));
    }
  }
  if (std::all_of(plane.poles.begin(), plane.poles.end(), [](const Ids& ids) { return ids.empty(); })) {
    plane.all = &places;
    plane.offsets = offsets;
    return plane;
  }
  plane.offsets = {0};
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    for (std::size_t i = offsets[s]; i < offsets[s + 1]; ++i) {
      const Point p = place_at(places, i);
      if (is_pole(p)) continue;
      plane.some.insert(plane.some.end(), {p.x, p.y});
      plane.points.push_back(static_cast<std::int32_t>(i));
    }
    plane.offsets.push_back(plane.points.size());
  }
  return plane;
}

void number_by_points(const Plane& plane, std::size_t n, Triangulation& planar) {
  if (plane.all != nullptr) return;
  const auto point = [&](std::int32_t v) { return plane.points[static_cast<std::size_t>(v)]; };
  for (Ids* ids : {&planar.triangles, &planar.hull})
    std::transform(ids->begin(), ids->end(), ids->begin(), point);
  Ids representatives(n);
  for (std::size_t i = 0; i < plane.points.size(); ++i) {
    representatives[static_cast<std::size_t>(point(static_cast<std::int32_t>(i)))] =
        point(planar.representatives[i]);
  }
  for (const Ids& poles : plane.poles) {
    for (const std::int32_t i : poles) representatives[static_cast<std::size_t>(i)] = poles.front();
  }
  planar.representatives = std::move(representatives);
}

Triangulation planar_part(const Plane& plane, const Triangulation& mesh) {
  Triangulation planar;
  planar.triangle_offsets = planar.hull_offsets = {0};
  planar.triangles.reserve(mesh.triangles.size());
  planar.neighbors.reserve(mesh.triangles.size());
  for (std::size_t s = 0; s + 1 < mesh.point_offsets.size(); ++s) {
    // Rows are those of the plane, and then those around the pole.
    const std::size_t first = mesh.triangle_offsets[s], to = planar.triangle_offsets.back();
    std::size_t rows = first, end = mesh.triangle_offsets[s + 1];
    while (rows < end) {
      const std::size_t middle = rows + (end - rows) / 2;
      if (is_in_plane(mesh, middle)) {
        rows = middle + 1;
      } else {
        end = middle;
      }
    }
    const auto begin = static_cast<std::ptrdiff_t>(3 * first), last = static_cast<std::ptrdiff_t>(3 * rows);
    planar.triangles.insert(planar.triangles.end(), mesh.triangles.begin() + begin,
                            mesh.triangles.begin() + last);
    planar.neighbors.resize(3 * (to + rows - first));
    std::transform(
        mesh.neighbors.begin() + begin, mesh.neighbors.begin() + last, &planar.neighbors[3 * to],
        [&](std::int32_t t) { return index(t) >= rows ? -1 : t - static_cast<std::int32_t>(first - to); });
    if (rows > first) {
      append_border(mesh.places, to, planar);
    } else {
      append_line(mesh, s, planar.hull);
    }
    planar.triangle_offsets.push_back(to + rows - first);
    planar.hull_offsets.push_back(planar.hull.size());
  }
  planar.representatives = mesh.representatives;
  if (plane.all == nullptr) {
    Ids numbers(mesh.representatives.size(), -1);
    for (std::size_t i = 0; i < plane.points.size(); ++i)
      numbers[index(plane.points[i])] = static_cast<std::int32_t>(i);
    planar.representatives = plane.points;
    const auto point = [&](std::int32_t i) { return mesh.representatives[index(i)]; };
    std::transform(plane.points.begin(), plane.points.end(), planar.representatives.begin(), point);
    for (Ids* ids : {&planar.triangles, &planar.hull, &planar.representatives})
      std::transform(ids->begin(), ids->end(), ids->begin(),
                     [&](std::int32_t i) { return numbers[index(i)]; });
  }
  return planar;
}

}  // namespace flaunay::sphere
