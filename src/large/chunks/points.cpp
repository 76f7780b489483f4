#include "large/chunks/points.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace flaunay::chunks {

void ChunkPoints::add(kernel::double2 p, std::int64_t id, const OpenEdge* its_edges, std::size_t count) {
  if (edge_offsets.empty()) edge_offsets.push_back(0);
  coordinates.insert(coordinates.end(), {p.x, p.y});
  ids.push_back(id);
  edges.insert(edges.end(), its_edges, its_edges + count);
  edge_offsets.push_back(edges.size());
}

void ChunkPoints::sort() {
  if (std::is_sorted(ids.begin(), ids.end())) return;
  std::vector<std::size_t> order(size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  ChunkPoints sorted;
  for (const std::size_t i : order) {
    sorted.add(point(i), ids[i], edges.data() + edge_offsets[i], edge_count(i));
    if (has_values()) sorted.values.push_back(values[i]);
  }
  *this = std::move(sorted);
}

}  // namespace flaunay::chunks
