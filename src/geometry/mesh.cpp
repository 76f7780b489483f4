#include "geometry/mesh.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "geometry/cells.hpp"
#include "geometry/halfedges.hpp"

namespace flaunay::geometry {
namespace {

using Ids = std::vector<std::int32_t>;

// Sorts rows stably by set. Returns the new row of each old row, or an empty vector if no row changes.
Ids places_by_set(const PointSets& sets, const Ids& triangles, std::vector<std::size_t>& triangle_offsets) {
  const std::size_t set_count = sets.set_offsets.size() - 1;
  const std::size_t rows = triangles.size() / 3;
  triangle_offsets.assign(set_count + 1, 0);
  if (set_count == 1) {
    triangle_offsets[1] = rows;
    return {};
  }
  Ids set_of_id(sets.points.size());
  for (std::size_t s = 0; s < set_count; ++s) {
    std::fill(set_of_id.begin() + sets.set_offsets[s], set_of_id.begin() + sets.set_offsets[s + 1],
              static_cast<std::int32_t>(s));
  }
  bool sorted = true;
  for (std::size_t t = 0; t < rows; ++t) {
    const std::int32_t set = set_of_id[triangles[3 * t]];
    ++triangle_offsets[set + 1];
    sorted = sorted && (t == 0 || set_of_id[triangles[3 * (t - 1)]] <= set);
  }
  std::partial_sum(triangle_offsets.begin(), triangle_offsets.end(), triangle_offsets.begin());
  if (sorted) return {};
  std::vector<std::size_t> next(triangle_offsets);
  Ids places(rows);
  for (std::size_t t = 0; t < rows; ++t) {
    places[t] = static_cast<std::int32_t>(next[set_of_id[triangles[3 * t]]]++);
  }
  return places;
}

// Writes the rows for the caller: indices of input points, beginning with the smallest, and the triangles
// opposite to them.
void write_rows(const PointSets& sets, const Mesh& mesh, const Ids& places, bool with_neighbors,
                Triangulation& result) {
  const auto rows = static_cast<std::int32_t>(mesh.triangles.size() / 3);
  const auto place = [&places](std::int32_t t) { return places.empty() ? t : places[t]; };
  result.triangles.resize(mesh.triangles.size());
  if (with_neighbors) result.neighbors.resize(mesh.triangles.size());
  for (std::int32_t t = 0; t < rows; ++t) {
    std::array<std::int32_t, 3> row;
    for (int k = 0; k < 3; ++k) row[k] = sets.source[mesh.triangles[3 * t + k]];
    int from = static_cast<int>(std::min_element(row.begin(), row.end()) - row.begin());
    for (std::int32_t to = 3 * place(t), end = to + 3; to < end; ++to) {
      const int opposite = from == 2 ? 0 : from + 1;
      result.triangles[to] = row[from];
      if (with_neighbors) {
        const std::int32_t twin = mesh.twins[3 * t + opposite];
        result.neighbors[to] = twin < 0 ? -1 : place(twin / 3);
      }
      from = opposite;
    }
  }
}

// The hull of each set, counter-clockwise from its first point; a set without triangles is its own hull.
void write_hulls(const PointSets& sets, const Mesh& mesh, Triangulation& result) {
  Ids next(sets.points.size(), -1);
  for (std::size_t h = 0; h < mesh.twins.size(); ++h) {
    if (mesh.twins[h] >= 0) continue;
    next[mesh.triangles[h]] = mesh.triangles[next_halfedge(static_cast<std::int32_t>(h))];
  }
  const std::size_t set_count = sets.set_offsets.size() - 1;
  result.hull_offsets.assign(set_count + 1, 0);
  for (std::size_t s = 0; s < set_count; ++s) {
    const std::int32_t first = sets.set_offsets[s], end = sets.set_offsets[s + 1];
    if (result.triangle_offsets[s] == result.triangle_offsets[s + 1]) {
      result.hull.insert(result.hull.end(), sets.source.begin() + first, sets.source.begin() + end);
    } else {
      std::int32_t id = first;
      do {
        result.hull.push_back(sets.source[id]);
        id = next[id];
      } while (id != first);
    }
    result.hull_offsets[s + 1] = result.hull.size();
  }
}

void canonicalize(const PointSets& sets, Mesh& mesh) {
  CellFinder finder(sets.predicates, sets.points.data(), mesh);
  Cell cell;
  while (finder.next(cell)) fan_cell(cell, {}, mesh);
}

}  // namespace

void write_halfedges(const Options& options, Triangulation& result) {
  const std::vector<std::int32_t>& neighbors = result.neighbors;
  if (options.halfedges) {
    result.halfedges.assign(neighbors.size(), -1);
    for (std::int32_t h = 0; h < static_cast<std::int32_t>(neighbors.size()); ++h) {
      // The triangle across half-edge h is opposite to the vertex before it.
      const std::int32_t beyond = neighbors[previous_halfedge(h)];
      if (beyond < 0) continue;
      for (std::int32_t k = 3 * beyond; k < 3 * beyond + 3; ++k) {
        // Two triangles share at most one edge.
        if (neighbors[k] == h / 3) result.halfedges[h] = next_halfedge(k);
      }
    }
  }
  if (!options.neighbors) result.neighbors.clear();
}

bool find_twins(const Ids& triangles, Ids& twins) {
  twins.assign(triangles.size(), -1);
  if (triangles.empty()) return true;
  const auto vertices = static_cast<std::size_t>(*std::max_element(triangles.begin(), triangles.end())) + 1;
  const auto halfedges = static_cast<std::int32_t>(triangles.size());
  // Groups half-edges by their smaller vertex, then sorts each group by the larger one.
  struct Edge {
    std::int32_t larger;
    std::int32_t halfedge;
  };
  const auto ends = [&triangles](std::int32_t h) {
    return std::minmax(triangles[h], triangles[next_halfedge(h)]);
  };
  std::vector<std::int32_t> first(vertices + 1, 0);
  for (std::int32_t h = 0; h < halfedges; ++h) ++first[ends(h).first + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Edge> edges(triangles.size());
  std::vector<std::int32_t> place(first.begin(), first.end() - 1);
  for (std::int32_t h = 0; h < halfedges; ++h) {
    const auto [smaller, larger] = ends(h);
    edges[place[smaller]++] = {larger, h};
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto begin = edges.begin() + first[v], end = edges.begin() + first[v + 1];
    std::sort(begin, end, [](const Edge& a, const Edge& b) { return a.larger < b.larger; });
    for (auto edge = begin; edge != end;) {
      auto after = edge + 1;
      while (after != end && after->larger == edge->larger) ++after;
      if (after - edge > 2) return false;
      if (after - edge == 2) {
        const std::int32_t a = edge->halfedge, b = (edge + 1)->halfedge;
        if (triangles[a] == triangles[b]) return false;
        twins[a] = b;
        twins[b] = a;
      }
      edge = after;
    }
  }
  return true;
}

Ids match_edges(const Ids& triangles) {
  Ids twins;
  if (!find_twins(triangles, twins)) {
    throw Error(ErrorKind::internal, "triangles overlap; please report the input");
  }
  return twins;
}

Triangulation finish(const PointSets& sets, Ids triangles, Ids twins, const Options& options) {
  if (twins.size() != triangles.size()) twins = match_edges(triangles);
  Mesh mesh{std::move(triangles), std::move(twins)};
  canonicalize(sets, mesh);

  Triangulation result;
  const Ids places = places_by_set(sets, mesh.triangles, result.triangle_offsets);
  write_rows(sets, mesh, places, options.neighbors || options.halfedges, result);
  write_halfedges(options, result);
  write_hulls(sets, mesh, result);
  result.representatives = sets.representatives;
  Statistics& statistics = result.statistics;
  statistics.device = "host";
  statistics.points = sets.representatives.size();
  statistics.duplicates = statistics.points - sets.points.size();
  statistics.triangles = result.triangles.size() / 3;
  statistics.hull_vertices = result.hull.size();
  return result;
}

}  // namespace flaunay::geometry
