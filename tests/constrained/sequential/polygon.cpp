#include "tests/constrained/sequential/polygon.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

#include "geometry/halfedges.hpp"

namespace flaunay::sequential {
using namespace geometry;

namespace {

// Twins that are no half-edges: the base, and the side from a position to the next one in the list.
constexpr std::int32_t kBase = -1;
std::int32_t side_from(std::int32_t position) { return -2 - position; }
std::int32_t position_of(std::int32_t side) { return -2 - side; }

}  // namespace

const std::vector<ChainTriangle>& PolygonTriangulator::triangulate(const std::vector<std::int32_t>& chain) {
  chain_ = &chain;
  result_.clear();
  if (chain.size() <= kGiftWrapped) {
    wrap();
    return result_;
  }
  ++insertions_;
  if (insert_all()) {
    list_triangles();
  } else {
    ++repetitions_;
    wrap();
  }
  return result_;
}

void PolygonTriangulator::wrap() {
  open_.assign(1, {0, static_cast<std::int32_t>(chain_->size()) - 1, kBase});
  while (!open_.empty()) {
    const Open base = open_.back();
    open_.pop_back();
    if (base.to - base.from < 2) continue;
    const std::int32_t j = apex(base.from, base.to);
    result_.push_back({base.from, j, base.to});
    open_.push_back({j, base.to, kBase});
    open_.push_back({base.from, j, kBase});
  }
}

// All vertices between are left of the base, so the circles through its ends and one of them are nested.
std::int32_t PolygonTriangulator::apex(std::int32_t i, std::int32_t k) const {
  std::int32_t best = i + 1;
  for (std::int32_t j = best + 1; j < k; ++j) {
    if (circle(i, k, best, j) > 0) best = j;
  }
  return best;
}

bool PolygonTriangulator::insert_all() {
  choose_order();
  const auto last = static_cast<std::int32_t>(chain_->size()) - 1;
  const std::int32_t first = order_[0];
  triangles_.assign({0, last, first});
  twins_.assign({kBase, side_from(first), side_from(0)});
  free_.clear();
  inside_.assign(chain_->size(), -1);
  inside_[first] = 1;
  inside_[0] = 2;
  for (std::size_t i = 1; i < order_.size(); ++i) insert(order_[i]);
  return is_canonical();
}

// Removes the vertices in random order from the list; they are inserted in the opposite order. A vertex that
// is nearer to the base than its neighbours is not removed before one of them: otherwise polygons could turn
// inside out. The numbers are always the same, so that times are.
void PolygonTriangulator::choose_order() {
  const auto size = static_cast<std::int32_t>(chain_->size()), last = size - 1;
  next_.resize(chain_->size());
  previous_.resize(chain_->size());
  for (std::int32_t k = 0; k < size; ++k) {
    next_[k] = k + 1;
    previous_[k] = k - 1;
  }
  const auto is_nearer = [this, last](std::int32_t v, std::int32_t other) {
    return kernel::cross_sign(point(0), point(last), point(other), point(v)) < 0;
  };
  order_.resize(chain_->size() - 2);
  std::iota(order_.begin(), order_.end(), 1);
  std::minstd_rand random;
  for (std::size_t i = order_.size() - 1; i > 0; --i) {
    std::int32_t v;
    do {
      std::swap(order_[i], order_[random() % (i + 1)]);
      v = order_[i];
    } while (is_nearer(v, previous_[v]) && is_nearer(v, next_[v]));
    next_[previous_[v]] = next_[v];
    previous_[next_[v]] = previous_[v];
  }
}

// Inserts a vertex between its neighbours in the list: removes the triangles whose circles it is in, as far
// as it is connected to them, and fills the hole with triangles at it.
void PolygonTriangulator::insert(std::int32_t u) {
  const std::int32_t before = previous_[u], after = next_[u];
  open_.assign(1, {before, after, inside_[before]});
  std::int32_t beside = side_from(before);
  while (!open_.empty()) {
    const Open edge = open_.back();
    open_.pop_back();
    if (edge.beyond >= 0) {
      const std::int32_t x = triangles_[previous_halfedge(edge.beyond)];
      if (orient(edge.from, edge.to, u) <= 0 || circle(edge.from, edge.to, u, x) > 0) {
        open_.push_back({x, edge.to, twins_[previous_halfedge(edge.beyond)]});
        open_.push_back({edge.from, x, twins_[next_halfedge(edge.beyond)]});
        free_.push_back(edge.beyond / 3);
        continue;
      }
    }
    auto h = static_cast<std::int32_t>(triangles_.size());
    if (free_.empty()) {
      triangles_.resize(triangles_.size() + 3);
      twins_.resize(triangles_.size());
    } else {
      h = 3 * free_.back();
      free_.pop_back();
    }
    triangles_[h] = edge.from;
    triangles_[h + 1] = edge.to;
    triangles_[h + 2] = u;
    attach(h, edge.beyond);
    attach(h + 2, beside);
    beside = h + 1;
  }
  attach(beside, side_from(u));
  next_[before] = previous_[after] = u;
}

void PolygonTriangulator::attach(std::int32_t halfedge, std::int32_t beyond) {
  twins_[halfedge] = beyond;
  if (beyond >= 0) {
    twins_[beyond] = halfedge;
  } else if (beyond != kBase) {
    inside_[position_of(beyond)] = halfedge;
  }
}

// Triangles that are all counter-clockwise and have a polygon as their border, as these have, do not overlap.
// If also all edges between them are canonical, they are the polygon's only such triangulation.
bool PolygonTriangulator::is_canonical() const {
  const auto halfedges = static_cast<std::int32_t>(triangles_.size());
  for (std::int32_t h = 0; h < halfedges; h += 3) {
    if (orient(triangles_[h], triangles_[h + 1], triangles_[h + 2]) <= 0) return false;
  }
  for (std::int32_t h = 0; h < halfedges; ++h) {
    if (twins_[h] < h) continue;
    const std::int32_t* const t = &triangles_[h - h % 3];
    if (circle(t[0], t[1], t[2], triangles_[previous_halfedge(twins_[h])]) > 0) return false;
  }
  return true;
}

void PolygonTriangulator::list_triangles() {
  result_.resize(triangles_.size() / 3);
  for (std::size_t t = 0; t < result_.size(); ++t) {
    std::copy_n(&triangles_[3 * t], 3, result_[t].begin());
    std::sort(result_[t].begin(), result_[t].end());
  }
  std::sort(result_.begin(), result_.end(), [](const ChainTriangle& a, const ChainTriangle& b) {
    return a[0] != b[0] ? a[0] < b[0] : a[2] > b[2];
  });
}

}  // namespace flaunay::sequential
