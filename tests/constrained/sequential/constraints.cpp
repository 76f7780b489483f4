#include "tests/constrained/sequential/constraints.hpp"

#include <algorithm>
#include <utility>

namespace flaunay::sequential {

std::int32_t Constraints::add(std::int32_t a, std::int32_t b, std::int32_t owner) {
  if (comes_before(b, a)) std::swap(a, b);
  edges_.push_back({a, b, owner});
  return static_cast<std::int32_t>(edges_.size()) - 1;
}

void Constraints::link(std::int32_t first, std::int32_t second) {
  if (first < 0 || second < 0) return;
  edges_[first].next = edges_[first].forward = second;
  edges_[second].previous = edges_[second].backward = first;
}

// Follows shortcuts to the end, and makes all of them lead there.
std::int32_t Constraints::end_of_chain(std::int32_t edge, std::int32_t Edge::*shortcut) {
  std::int32_t end = edge;
  while (edges_[end].*shortcut >= 0) end = edges_[end].*shortcut;
  while (edge != end) {
    const std::int32_t next = edges_[edge].*shortcut;
    edges_[edge].*shortcut = end;
    edge = next;
  }
  return end;
}

std::int32_t Constraints::first_of_chain(std::int32_t edge) { return end_of_chain(edge, &Edge::backward); }
std::int32_t Constraints::last_of_chain(std::int32_t edge) { return end_of_chain(edge, &Edge::forward); }

void Constraints::sort() {
  std::vector<std::int32_t> firsts;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (edges_[e].previous < 0) firsts.push_back(static_cast<std::int32_t>(e));
  }
  std::sort(firsts.begin(), firsts.end(), [this](std::int32_t a, std::int32_t b) {
    return std::pair(from(a), to(a)) < std::pair(from(b), to(b));
  });
  number_.resize(edges_.size());
  chain_offsets_.push_back(0);
  for (const std::int32_t first : firsts) {
    for (std::int32_t e = first; e >= 0; e = edges_[e].next) {
      number_[e] = static_cast<std::int32_t>(order_.size());
      order_.push_back(e);
    }
    chain_of_.resize(order_.size(), static_cast<std::int32_t>(chain_offsets_.size()) - 1);
    chain_offsets_.push_back(static_cast<std::int32_t>(order_.size()));
  }
}

std::vector<std::int32_t> Constraints::sorted_edges() const {
  std::vector<std::int32_t> ends;
  ends.reserve(2 * order_.size());
  for (const std::int32_t e : order_) ends.insert(ends.end(), {edges_[e].from, edges_[e].to});
  return ends;
}

std::int32_t Constraints::number_from(std::int32_t edge, std::int32_t vertex) const {
  const auto chain = chain_offsets_.begin() + chain_of_[number_[edge]];
  const auto found =
      std::lower_bound(order_.begin() + chain[0], order_.begin() + chain[1], vertex,
                       [this](std::int32_t e, std::int32_t v) { return comes_before(edges_[e].from, v); });
  return static_cast<std::int32_t>(found - order_.begin());
}

}  // namespace flaunay::sequential
