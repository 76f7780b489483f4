#include "updates/edges.hpp"

#include <algorithm>
#include <utility>

#include "mesh/corners.hpp"

namespace flaunay::updates {
namespace {

std::uint64_t edge_between(std::int32_t a, std::int32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
}
std::int32_t smaller_end(std::uint64_t edge) { return static_cast<std::int32_t>(edge >> 32); }
std::int32_t larger_end(std::uint64_t edge) { return static_cast<std::int32_t>(edge & 0xffffffff); }

}  // namespace

ConstraintEdges::ConstraintEdges(const ConstrainedTriangulation& mesh, std::size_t numbers)
    : edges_(mesh.edge_segments.size()), ends_(numbers, 0) {
  for (std::size_t e = 0; e < mesh.edge_segments.size(); ++e) {
    edges_.emplace(edge_between(mesh.constraint_edges[2 * e], mesh.constraint_edges[2 * e + 1]),
                   mesh.edge_segments[e]);
  }
  for (const std::int32_t v : mesh.constraint_edges) ends_[static_cast<std::size_t>(v)] = 1;
}

LivingConstraints ConstraintEdges::listed(const std::vector<double>& coordinates) const {
  std::vector<std::pair<std::uint64_t, std::int32_t>> sorted(edges_.begin(), edges_.end());
  std::sort(sorted.begin(), sorted.end());
  const auto place = [&](std::int32_t v) {
    const double* const p = &coordinates[2 * static_cast<std::size_t>(v)];
    return std::pair(p[0], p[1]);
  };
  LivingConstraints list;
  for (const auto& [edge, segment] : sorted) {
    std::int32_t a = smaller_end(edge), b = larger_end(edge);
    if (place(b) < place(a)) std::swap(a, b);
    list.edges.insert(list.edges.end(), {a, b});
    list.segments.push_back(segment);
  }
  return list;
}

std::vector<std::int32_t> ConstraintEdges::segments_of_corners(const ConstrainedTriangulation& mesh) const {
  if (empty()) return {};
  std::vector<std::int32_t> of_corners(mesh.triangles.size(), -1);
  for (std::size_t c = 0; c < of_corners.size(); ++c) {
    if (mesh.constrained[c] == 0) continue;
    const auto [from, to] = mesh::edge_opposite(mesh.triangles, c);
    of_corners[c] = edges_.at(edge_between(from, to));
  }
  return of_corners;
}

void ConstraintEdges::split(const std::vector<SplitEdge>& splits, std::size_t numbers) {
  std::unordered_map<std::uint64_t, std::int32_t> vertex_on;
  for (const auto& [from, to, vertex] : splits) vertex_on.emplace(edge_between(from, to), vertex);
  std::unordered_map<std::uint64_t, std::int32_t> parts;
  std::vector<std::uint64_t> gone, waiting;
  for (const auto& [from, to, vertex] : splits) {
    const auto whole = edges_.find(edge_between(from, to));
    if (whole == edges_.end()) continue;
    gone.push_back(whole->first);
    waiting.push_back(whole->first);
    while (!waiting.empty()) {
      const std::uint64_t edge = waiting.back();
      waiting.pop_back();
      if (const auto at = vertex_on.find(edge); at != vertex_on.end()) {
        for (const std::int32_t end : {smaller_end(edge), larger_end(edge)}) {
          waiting.push_back(edge_between(end, at->second));
        }
      } else {
        parts.emplace(edge, whole->second);
      }
    }
  }
  ends_.resize(numbers, 0);
  edges_.reserve(edges_.size() + parts.size());
  // From here on nothing throws.
  for (const auto& split : splits) ends_[static_cast<std::size_t>(split.vertex)] = 1;
  for (const std::uint64_t edge : gone) edges_.erase(edge);
  edges_.merge(parts);
}

}  // namespace flaunay::updates
