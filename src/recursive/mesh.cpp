#include "recursive/mesh.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace flaunay::recursive {
namespace {

using Ids = std::vector<std::int32_t>;

std::int32_t next_of(std::int32_t halfedge) { return halfedge % 3 == 2 ? halfedge - 2 : halfedge + 1; }

std::int32_t apex_of(const Ids& triangles, std::int32_t halfedge) {
  return triangles[next_of(next_of(halfedge))];
}

// A stable counting sort of `order` by key(element), keys in 0..keys-1.
template <typename Key>
Ids sorted_by(const Ids& order, std::size_t keys, const Key& key) {
  std::vector<std::size_t> first(keys + 1, 0);
  for (const std::int32_t i : order) ++first[key(i) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  Ids sorted(order.size());
  for (const std::int32_t i : order) sorted[first[key(i)]++] = i;
  return sorted;
}

// Turns each row so that its smallest index comes first, and orders rows by set.
void order_rows(const PointSets& sets, Ids& triangles, Ids& twins) {
  const std::size_t count = triangles.size() / 3;
  Ids order(count);
  std::iota(order.begin(), order.end(), 0);
  if (sets.set_offsets.size() > 2) {
    std::vector<std::int32_t> set_of_id(sets.points.size());
    for (std::size_t s = 0; s + 1 < sets.set_offsets.size(); ++s) {
      std::fill(set_of_id.begin() + sets.set_offsets[s], set_of_id.begin() + sets.set_offsets[s + 1],
                static_cast<std::int32_t>(s));
    }
    order = sorted_by(order, sets.set_offsets.size(),
                      [&](std::int32_t t) { return set_of_id[triangles[3 * t]]; });
  }
  Ids place(triangles.size()), rows(triangles.size());
  for (std::size_t t = 0; t < count; ++t) {
    const std::int32_t* row = &triangles[3 * order[t]];
    int first = 0;
    for (int k = 1; k < 3; ++k) {
      if (sets.source[row[k]] < sets.source[row[first]]) first = k;
    }
    for (int k = 0; k < 3; ++k) {
      const int from = (first + k) % 3;
      rows[3 * t + k] = row[from];
      place[3 * order[t] + from] = static_cast<std::int32_t>(3 * t + k);
    }
  }
  Ids moved(twins.size());
  for (std::size_t h = 0; h < twins.size(); ++h) moved[place[h]] = twins[h] < 0 ? -1 : place[twins[h]];
  triangles = std::move(rows);
  twins = std::move(moved);
}

}  // namespace

Ids match_edges(const Ids& triangles) {
  Ids twins(triangles.size(), -1);
  if (triangles.empty()) return twins;
  const std::size_t keys =
      static_cast<std::size_t>(*std::max_element(triangles.begin(), triangles.end())) + 1;
  const auto from = [&](std::int32_t h) { return triangles[h]; };
  const auto to = [&](std::int32_t h) { return triangles[next_of(h)]; };
  Ids order(triangles.size());
  std::iota(order.begin(), order.end(), 0);
  order = sorted_by(order, keys, [&](std::int32_t h) { return std::max(from(h), to(h)); });
  order = sorted_by(order, keys, [&](std::int32_t h) { return std::min(from(h), to(h)); });
  for (std::size_t k = 1; k < order.size(); ++k) {
    if (from(order[k - 1]) == to(order[k]) && to(order[k - 1]) == from(order[k])) {
      twins[order[k - 1]] = order[k];
      twins[order[k]] = order[k - 1];
    }
  }
  return twins;
}

void canonicalize(const PointSets& sets, Ids& triangles, Ids& twins) {
  std::vector<char> dissolved(triangles.size(), 0);
  std::vector<std::int32_t> in_cells;
  for (std::size_t h = 0; h < triangles.size(); ++h) {
    const std::int32_t twin = twins[h];
    if (twin < static_cast<std::int32_t>(h)) continue;
    const std::size_t t = h / 3 * 3;
    const int side =
        sets.predicates.circle(sets.points[triangles[t]], sets.points[triangles[t + 1]],
                               sets.points[triangles[t + 2]], sets.points[apex_of(triangles, twin)]);
    if (side > 0) throw Error(ErrorKind::internal, "an edge is not Delaunay; please report the input");
    if (side == 0) {
      dissolved[h] = dissolved[twin] = 1;
      in_cells.push_back(static_cast<std::int32_t>(h / 3));
    }
  }
  std::vector<char> done(in_cells.empty() ? 0 : triangles.size() / 3, 0);
  Ids cell, polygon, outer;
  for (const std::int32_t seed : in_cells) {
    if (done[seed]) continue;
    cell.assign(1, seed);
    done[seed] = 1;
    std::int32_t start = -1;
    for (std::size_t k = 0; k < cell.size(); ++k) {
      for (std::int32_t h = 3 * cell[k]; h < 3 * cell[k] + 3; ++h) {
        if (!dissolved[h]) {
          if (start < 0 || triangles[h] < triangles[start]) start = h;
        } else if (!done[twins[h] / 3]) {
          done[twins[h] / 3] = 1;
          cell.push_back(twins[h] / 3);
        }
      }
    }
    std::sort(cell.begin(), cell.end());
    // Around the polygon, from the smallest vertex.
    polygon.clear();
    outer.clear();
    std::int32_t h = start;
    do {
      polygon.push_back(triangles[h]);
      outer.push_back(twins[h]);
      h = next_of(h);
      while (dissolved[h]) h = next_of(twins[h]);
    } while (h != start);
    if (polygon.size() != cell.size() + 2) {
      throw Error(ErrorKind::internal, "a cocircular cell has a hole; please report the input");
    }
    const auto join = [&twins](std::int32_t a, std::int32_t b) {
      twins[a] = b;
      if (b >= 0) twins[b] = a;
    };
    for (std::size_t k = 0; k < cell.size(); ++k) {
      const std::int32_t t = 3 * cell[k];
      triangles[t] = polygon[0];
      triangles[t + 1] = polygon[k + 1];
      triangles[t + 2] = polygon[k + 2];
      join(t, k == 0 ? outer[0] : 3 * cell[k - 1] + 2);
      join(t + 1, outer[k + 1]);
      if (k + 1 == cell.size()) join(t + 2, outer[k + 2]);
      dissolved[t] = dissolved[t + 1] = dissolved[t + 2] = 0;
    }
  }
}

Triangulation finish(const PointSets& sets, Ids triangles, Ids twins, const Options& options) {
  if (twins.size() != triangles.size()) twins = match_edges(triangles);
  canonicalize(sets, triangles, twins);
  order_rows(sets, triangles, twins);

  Triangulation result;
  const std::size_t set_count = sets.set_offsets.size() - 1;
  result.triangle_offsets.assign(set_count + 1, 0);
  result.hull_offsets.assign(set_count + 1, 0);
  Ids hull_next(sets.points.size(), -1);
  for (std::size_t h = 0; h < triangles.size(); ++h) {
    if (twins[h] < 0) hull_next[triangles[h]] = triangles[next_of(static_cast<std::int32_t>(h))];
  }
  std::size_t t = 0;
  for (std::size_t s = 0; s < set_count; ++s) {
    while (t < triangles.size() / 3 && triangles[3 * t] < sets.set_offsets[s + 1]) ++t;
    result.triangle_offsets[s + 1] = t;
    const std::int32_t first = sets.set_offsets[s];
    if (t == result.triangle_offsets[s]) {
      for (std::int32_t id = first; id < sets.set_offsets[s + 1]; ++id)
        result.hull.push_back(sets.source[id]);
    } else {
      std::int32_t id = first;
      do {
        result.hull.push_back(sets.source[id]);
        id = hull_next[id];
      } while (id != first);
    }
    result.hull_offsets[s + 1] = result.hull.size();
  }
  if (options.neighbors) {
    result.neighbors.resize(triangles.size());
    for (std::size_t h = 0; h < triangles.size(); ++h) {
      const std::int32_t twin = twins[next_of(static_cast<std::int32_t>(h))];
      result.neighbors[h] = twin < 0 ? -1 : twin / 3;
    }
  }
  for (std::int32_t& id : triangles) id = sets.source[id];
  result.triangles = std::move(triangles);
  result.representatives = sets.representatives;
  Statistics& statistics = result.statistics;
  statistics.device = "host";
  statistics.points = sets.representatives.size();
  statistics.duplicates = statistics.points - sets.points.size();
  statistics.triangles = result.triangles.size() / 3;
  statistics.hull_vertices = result.hull.size();
  return result;
}

}  // namespace flaunay::recursive
