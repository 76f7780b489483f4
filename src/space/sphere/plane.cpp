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

// The corners of the border of triangles, counter-clockwise, from its first point on.
Ids border_of(const std::vector<double>& places, const Triangulation& planar) {
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::size_t c = 0; c < planar.neighbors.size(); ++c) {
    if (planar.neighbors[c] >= 0) continue;
    edges.push_back(mesh::edge_opposite(planar.triangles, c));
  }
  std::sort(edges.begin(), edges.end());
  const auto first = std::min_element(edges.begin(), edges.end(), [&](const auto& a, const auto& b) {
    return kernel::comes_before(place_at(places, index(a.first)), place_at(places, index(b.first))) != 0;
  });
  Ids border;
  for (auto edge = first; border.size() < edges.size();) {
    border.push_back(edge->first);
    edge = std::lower_bound(edges.begin(), edges.end(), std::pair(edge->second, std::int32_t{0}));
    if (edge == edges.end()) break;  // of arrays that are no triangulation's
  }
  return border;
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
  // Rows are those of the plane, and then those around the pole.
  std::size_t rows = 0, end = mesh.triangles.size() / 3;
  while (rows < end) {
    const std::size_t middle = rows + (end - rows) / 2;
    if (is_in_plane(mesh, middle)) {
      rows = middle + 1;
    } else {
      end = middle;
    }
  }
  Triangulation planar;
  const auto corners = static_cast<std::ptrdiff_t>(3 * rows);
  planar.triangles.assign(mesh.triangles.begin(), mesh.triangles.begin() + corners);
  planar.neighbors.assign(mesh.neighbors.begin(), mesh.neighbors.begin() + corners);
  for (std::int32_t& t : planar.neighbors) {
    if (index(t) >= rows) t = -1;
  }
  planar.representatives = mesh.representatives;
  planar.hull = border_of(mesh.places, planar);
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
  planar.triangle_offsets = {0, rows};
  planar.hull_offsets = {0, planar.hull.size()};
  return planar;
}

}  // namespace flaunay::sphere
