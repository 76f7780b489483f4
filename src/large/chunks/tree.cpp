#include "large/chunks/tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "points/cut_tree.h"
#include "points/sampled_cuts.h"

namespace flaunay::chunks {
namespace {

using kernel::cut_node;
using kernel::double2;
using Sample = std::vector<double2>::iterator;

// The leaves below a node that are on its low side.
struct LowShare {
  std::size_t leaves, of;

  double low() const { return static_cast<double>(leaves) / static_cast<double>(of); }
  double high() const { return static_cast<double>(of - leaves) / static_cast<double>(of); }
};

LowShare low_share(std::size_t leaves) { return {leaves / 2, leaves}; }

double along(double2 p, int axis) { return axis == 1 ? p.y : p.x; }

bool goes_high(double2 p, const cut_node& cut) {
  const kernel::point_keys keys = kernel::keys_of(p);
  return kernel::goes_high(&keys, &cut) != 0;
}

// Before all but one of the samples in the order of the node's axis, which is (x, y) or (y, -x).
bool comes_before(double2 p, double2 q, int axis) {
  return axis == 1 ? std::pair(p.y, -p.x) < std::pair(q.y, -q.x) : std::pair(p.x, p.y) < std::pair(q.x, q.y);
}

double sample_at(Sample begin, Sample end, std::size_t place, int axis) {
  const Sample at = begin + static_cast<std::ptrdiff_t>(place);
  std::nth_element(begin, at, end, [axis](double2 p, double2 q) { return along(p, axis) < along(q, axis); });
  return along(*at, axis);
}

// The distance between the quartiles.
double spread(Sample begin, Sample end, int axis) {
  const auto size = static_cast<std::size_t>(end - begin);
  const double low = sample_at(begin, end, size / 4, axis);
  return sample_at(begin, end, size - 1 - size / 4, axis) - low;
}

// The points up to p in the order of (x, y) go low.
cut_node behind(double2 p) {
  cut_node node = kernel::node_of(0, p);
  ++node.minor;
  return node;
}

// share: of the samples, on the low side.
cut_node cut_at_quantile(Sample begin, Sample end, const LowShare& share) {
  const int axis = spread(begin, end, 1) > spread(begin, end, 0) ? 1 : 0;
  const auto order = [axis](double2 p, double2 q) { return comes_before(p, q, axis); };
  const auto size = static_cast<std::size_t>(end - begin);
  const Sample quantile = begin + static_cast<std::ptrdiff_t>(size * share.leaves / share.of);
  std::nth_element(begin, quantile, end, order);
  const double2 pivot = *quantile;
  if (std::any_of(begin, end, [&](double2 p) { return order(p, pivot); }))
    return kernel::node_of(axis, pivot);
  // If many equal samples come first, the cut comes after them.
  std::optional<double2> next;
  std::for_each(begin, end, [&](double2 p) {
    if (order(pivot, p) && (!next || order(p, *next))) next = p;
  });
  return next ? kernel::node_of(axis, *next) : behind(pivot);
}

// The longest stretch of some sqrt(m) consecutive samples, of m, is cut in its middle. A cut shall leave each
// side at least kLeastOfShare of its share of the samples, and at most kMostOfEqual times as many samples as
// it would have if all leaves were equal.
constexpr double kLeastOfShare = 0.6;
constexpr double kMostOfEqual = 1.4;

struct Gap {
  double extent = 0, middle = 0;
  int axis = 0;
};

void widen(Gap& widest, std::vector<double>& values, const LowShare& share, double per_leaf, int axis) {
  std::sort(values.begin(), values.end());
  const std::size_t size = values.size();
  const auto all = static_cast<double>(size);
  const std::size_t stretch = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(all)));
  const double equal = per_leaf * static_cast<double>(share.of);
  const auto least = [&](double own, double other) {
    return std::min(std::max(kLeastOfShare * own * all, all - kMostOfEqual * other * equal), own * all);
  };
  const double least_low = least(share.low(), share.high()), least_high = least(share.high(), share.low());
  for (std::size_t i = 0; i + stretch < size; ++i) {
    const double below = static_cast<double>(i) + 0.5 * static_cast<double>(stretch);
    if (below < least_low || below > all - least_high) continue;
    const double extent = values[i + stretch] - values[i];
    if (extent > widest.extent) widest = {extent, values[i] + 0.5 * extent, axis};
  }
}

// per_leaf: the samples of each leaf if all were equal.
std::optional<cut_node> cut_in_gap(Sample begin, Sample end, const LowShare& share, double per_leaf) {
  Gap widest;
  std::vector<double> values;
  for (int axis = 0; axis < 2; ++axis) {
    values.clear();
    std::for_each(begin, end, [&](double2 p) { values.push_back(along(p, axis)); });
    widen(widest, values, share, per_leaf, axis);
  }
  if (!(widest.extent > 0) || !std::isfinite(widest.middle)) return std::nullopt;
  cut_node node = kernel::node_of(widest.axis, {widest.middle, widest.middle});
  node.minor = 0;  // all points that are as high as the cut go high
  return node;
}

}  // namespace

ChunkTree::ChunkTree(std::size_t leaves, std::vector<cut_node> nodes)
    : leaves_(leaves), nodes_(std::move(nodes)) {
  while (std::size_t{1} << depth_ < leaves) ++depth_;
  nodes_.resize(std::size_t{1} << depth_);
  if (leaves == nodes_.size()) return;
  numbers_.resize(nodes_.size());
  number(1, 0, leaves);
}

ChunkTree ChunkTree::of_leaves(std::vector<double2> samples, std::size_t leaves, Cuts cuts) {
  ChunkTree tree(leaves, {});
  const double per_leaf = static_cast<double>(samples.size()) / static_cast<double>(leaves);
  tree.cut(1, leaves, samples.begin(), samples.end(), cuts, per_leaf);
  return tree;
}

void ChunkTree::number(std::size_t node, std::size_t first, std::size_t count) {
  if (node >= nodes_.size()) {
    numbers_[node - nodes_.size()] = first;
    return;
  }
  const std::size_t low = count == 1 ? 1 : low_share(count).leaves;
  number(2 * node, first, low);
  number(2 * node + 1, count == 1 ? first : first + low, count == 1 ? 1 : count - low);
}

ChunkTree ChunkTree::around(kernel::double2 p) {
  ChunkTree tree;
  tree.leaves_ = 4;
  tree.depth_ = 2;
  const cut_node before = kernel::node_of(0, p);
  tree.nodes_ = {cut_node{}, before, before, behind(p)};
  return tree;
}

void ChunkTree::cut(std::size_t node, std::size_t leaves, Sample begin, Sample end, Cuts cuts,
                    double per_leaf) {
  if (node >= nodes_.size()) return;
  cut_node& own = nodes_[node];
  if (leaves == 1) {
    own = kernel::node_of(0, whole_plane().high);
    cut(2 * node, 1, begin, end, cuts, per_leaf);
    cut(2 * node + 1, 1, end, end, cuts, per_leaf);
    return;
  }
  const LowShare share = low_share(leaves);
  if (begin == end) {
    own = kernel::node_of(0, {0, 0});
  } else {
    const std::optional<cut_node> in_gap =
        cuts == Cuts::in_gaps ? cut_in_gap(begin, end, share, per_leaf) : std::nullopt;
    own = in_gap ? *in_gap : cut_at_quantile(begin, end, share);
  }
  const Sample split = std::partition(begin, end, [&](double2 p) { return !goes_high(p, own); });
  cut(2 * node, share.leaves, begin, split, cuts, per_leaf);
  cut(2 * node + 1, share.of - share.leaves, split, end, cuts, per_leaf);
}

void ChunkTree::find_leaves(const double* coordinates, std::size_t count, std::size_t* leaves) const {
  int found[DESCENTS];
  for (std::size_t first = 0; first < count; first += DESCENTS) {
    const std::size_t size = std::min<std::size_t>(DESCENTS, count - first);
    kernel::find_leaves(0, static_cast<int>(size), coordinates + 2 * first, nodes_.data(), depth_, found);
    for (std::size_t k = 0; k < size; ++k) {
      leaves[first + k] = numbers_.empty() ? static_cast<std::size_t>(found[k]) : numbers_[found[k]];
    }
  }
}

kernel::vertex_box ChunkTree::rectangle(std::size_t leaf, kernel::vertex_box whole) const {
  // If several leaves of the heap are one leaf, the first of them has all points.
  const std::size_t place =
      numbers_.empty() ? leaf
                       : static_cast<std::size_t>(std::lower_bound(numbers_.begin(), numbers_.end(), leaf) -
                                                  numbers_.begin());
  for (std::size_t node = (std::size_t{1} << depth_) + place; node > 1; node /= 2) {
    whole = kernel::cut_rectangle(whole, nodes_[node / 2], static_cast<int>(node % 2), kernel::scale_of(0));
  }
  return whole;
}

kernel::vertex_box whole_plane() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {{-kInfinity, -kInfinity}, {kInfinity, kInfinity}};
}

}  // namespace flaunay::chunks
