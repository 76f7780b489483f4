#include "constrained/refinement/sets.hpp"

#include <algorithm>

namespace flaunay::constrained {
namespace {

using Ids = std::vector<std::int32_t>;

template <typename T>
std::vector<T> part_of(const std::vector<T>& all, std::size_t first, std::size_t count) {
  if (all.empty()) return {};
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

// Writes the result of set s into the result of all sets. points: the number of points before refinement.
void write_set(const RefinedMesh& own, const SetNumbers& set, std::size_t points, const RefinedOffsets& sets,
               std::size_t s, RefinedMesh& all) {
  const std::size_t first_triangle = sets.triangles[s];
  const auto write = [](auto& to, const auto& from, std::size_t first, std::size_t by) {
    const auto shift = static_cast<std::int32_t>(by);
    for (std::size_t i = 0; i < from.size(); ++i) to[first + i] = from[i] + (from[i] < 0 ? 0 : shift);
  };
  // Without branches, which could not be predicted.
  const std::array<std::int32_t, 3> shifts = set.shifts(points + sets.added[s]);
  const auto splits = static_cast<std::int32_t>(set.points),
             added = static_cast<std::int32_t>(set.points + set.splits);
  for (std::size_t i = 0; i < own.triangles.size(); ++i) {
    const std::int32_t v = own.triangles[i];
    all.triangles[3 * first_triangle + i] = v + shifts[(v >= splits ? 1 : 0) + (v >= added ? 1 : 0)];
  }
  write(all.neighbors, own.neighbors, 3 * first_triangle, first_triangle);
  write(all.edges, own.edges, 3 * first_triangle, set.first_edge);
  write(all.parents, own.parents, first_triangle, set.first_triangle);
  std::copy(own.added.begin(), own.added.end(),
            all.added.begin() + static_cast<std::ptrdiff_t>(2 * sets.added[s]));
}

// Adds the report of a set to the report of all sets. first_triangle: of the set.
void add_report(const RefinedMesh& own, std::size_t first_triangle, RefinedMesh& all) {
  for (const std::int32_t t : own.report.bad_triangles)
    all.report.bad_triangles.push_back(t + static_cast<std::int32_t>(first_triangle));
  all.report.excuses.insert(all.report.excuses.end(), own.report.excuses.begin(), own.report.excuses.end());
  all.report.rounds = std::max(all.report.rounds, own.report.rounds);
  all.report.added_points += own.report.added_points;
  all.report.split_points += own.report.split_points;
  all.before_smoothing.add(own.before_smoothing);
}

}  // namespace

std::vector<SetNumbers> numbers_of_sets(const MeshToRefine& mesh, const std::vector<std::size_t>& offsets,
                                        const ConstrainedTriangulation& result) {
  std::vector<SetNumbers> sets(offsets.size() - 1);
  std::size_t edges = 0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    SetNumbers& set = sets[s];
    set.first_point = offsets[s];
    set.points = offsets[s + 1] - offsets[s];
    set.first_split = offsets.back();
    if (!result.added_offsets.empty()) {
      set.first_split += result.added_offsets[s];
      set.splits = result.added_offsets[s + 1] - result.added_offsets[s];
    }
    set.first_triangle = result.triangle_offsets[s];
    set.triangles = result.triangle_offsets[s + 1] - set.first_triangle;
    // They are numbered in the order of triangles.
    set.first_edge = edges;
    for (std::size_t c = 3 * set.first_triangle; c < 3 * (set.first_triangle + set.triangles); ++c)
      edges = std::max(edges, static_cast<std::size_t>(mesh.edges[c] + 1));
    set.edges = edges - set.first_edge;
  }
  return sets;
}

MeshToRefine mesh_of_set(const MeshToRefine& all, const SetNumbers& set, std::vector<double>& coordinates) {
  const auto append = [&](std::size_t first, std::size_t count) {
    coordinates.insert(coordinates.end(), all.coordinates + 2 * first, all.coordinates + 2 * (first + count));
  };
  append(set.first_point, set.points);
  append(set.first_split, set.splits);
  MeshToRefine mesh;
  mesh.coordinates = coordinates.data();
  mesh.points = set.points + set.splits;
  mesh.triangles = part_of(all.triangles, 3 * set.first_triangle, 3 * set.triangles);
  mesh.neighbors = part_of(all.neighbors, 3 * set.first_triangle, 3 * set.triangles);
  mesh.edges = part_of(all.edges, 3 * set.first_triangle, 3 * set.triangles);
  mesh.edge_ends = part_of(all.edge_ends, 2 * set.first_edge, 2 * set.edges);
  mesh.kept_edges = part_of(all.kept_edges, set.first_edge, set.edges);
  mesh.largest_areas = part_of(all.largest_areas, set.first_triangle, set.triangles);
  for (Ids* vertices : {&mesh.triangles, &mesh.edge_ends}) {
    for (std::int32_t& v : *vertices) v = set.own(v);
  }
  const auto shift = [](Ids& values, std::size_t by) {
    for (std::int32_t& value : values) value = value < 0 ? value : value - static_cast<std::int32_t>(by);
  };
  shift(mesh.neighbors, set.first_triangle);
  shift(mesh.edges, set.first_edge);
  return mesh;
}

RefinedMesh join_sets(host::Runtime& threads, const std::vector<SetNumbers>& sets,
                      std::vector<RefinedMesh>& parts, std::size_t points, const ShareSets& share,
                      RefinedOffsets& offsets) {
  RefinedMesh joined;
  for (const RefinedMesh& part : parts) {
    add_report(part, offsets.triangles.back(), joined);
    offsets.triangles.push_back(offsets.triangles.back() + part.parents.size());
    offsets.added.push_back(offsets.added.back() + part.added.size() / 2);
  }
  for (Ids* array : {&joined.triangles, &joined.neighbors, &joined.edges})
    threads.resize(*array, 3 * offsets.triangles.back());
  threads.resize(joined.parents, offsets.triangles.back());
  threads.resize(joined.added, 2 * offsets.added.back());
  share(sets.size(), [&](std::size_t s) {
    write_set(parts[s], sets[s], points, offsets, s, joined);
    parts[s] = {};
  });
  return joined;
}

}  // namespace flaunay::constrained
