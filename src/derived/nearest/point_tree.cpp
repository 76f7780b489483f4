#include "derived/nearest/point_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "predicates/nearness.h"

namespace flaunay::nearest {
namespace {

constexpr std::int32_t kLeaf = 8;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Squared distances of scaled coordinates neither overflow nor underflow. With e = 2^-53, two differences and
// their squares have relative errors below 3.1 e each, and the sum adds one more. So of two that differ by
// more than this part of the larger one, the smaller one belongs to the nearer point.
constexpr double kApart = 16 * DOUBLE_ROUNDOFF;

bool is_surely_less(double a, double b) { return a < b - kApart * b; }

}  // namespace

/// The search for one query at a time.
class Search {
 public:
  Search(const PointTree& tree, const points::QueryScaling& scaling, std::size_t count)
      : tree_(tree), unit_(scaling.frames[0].unit), bound_(scaling.nearness_bound), count_(count) {
    found_.reserve(count);
  }

  /// Finds the points nearest to a scaled query, but none that is surely farther away than the limit says,
  /// which is squared.
  void find(double x, double y, double limit) {
    x_ = x;
    y_ = y;
    limit_ = limit;
    found_.clear();
    if (!tree_.nodes_.empty()) visit(0, 0, 0);
    if (count_ > 1) std::sort_heap(found_.begin(), found_.end(), before_);
  }

  struct Found {
    double square;
    double x, y;
    std::int32_t point;
  };
  const std::vector<Found>& found() const { return found_; }

 private:
  /// dx, dy: how far at least the points of a node are away along both axes.
  void visit(std::int32_t at, double dx, double dy) {
    const PointTree::Node& node = tree_.nodes_[static_cast<std::size_t>(at)];
    if (node.upper == 0) return look_at(node);
    const double beyond = (node.axis == 0 ? x_ : y_) - unit_ * node.cut;
    visit(beyond < 0 ? at + 1 : node.upper, dx, dy);
    (node.axis == 0 ? dx : dy) = std::abs(beyond);
    if (!is_surely_less(limit_, dx * dx + dy * dy)) visit(beyond < 0 ? node.upper : at + 1, dx, dy);
  }

  void look_at(const PointTree::Node& leaf) {
    // A leaf that is larger has one place, with its points in the order of indices.
    const auto most =
        static_cast<std::int32_t>(std::min<std::size_t>(count_, std::numeric_limits<std::int32_t>::max()));
    const std::int32_t last =
        leaf.last - leaf.first > kLeaf ? std::min(leaf.last, leaf.first + most) : leaf.last;
    for (std::int32_t i = leaf.first; i < last; ++i) {
      const PointTree::Entry& entry = tree_.entries_[static_cast<std::size_t>(i)];
      const double px = unit_ * entry.x, py = unit_ * entry.y, dx = px - x_, dy = py - y_;
      const double square = dx * dx + dy * dy;
      if (is_surely_less(limit_, square)) continue;
      add({square, px, py, entry.point});
    }
  }

  void add(const Found& one) {
    if (found_.size() == count_) {
      if (!before_(one, found_.front())) return;
      if (count_ > 1) std::pop_heap(found_.begin(), found_.end(), before_);
      found_.back() = one;
    } else {
      found_.push_back(one);
    }
    if (count_ > 1) std::push_heap(found_.begin(), found_.end(), before_);
    if (found_.size() == count_) limit_ = std::min(limit_, found_.front().square);
  }

  struct Before {
    const Search& search;
    bool operator()(const Found& a, const Found& b) const {
      if (is_surely_less(a.square, b.square)) return true;
      if (is_surely_less(b.square, a.square)) return false;
      const int sign = kernel::nearness_sign(kernel::double2{a.x, a.y}, kernel::double2{b.x, b.y},
                                             kernel::double2{search.x_, search.y_}, search.bound_);
      if (sign != 0) return sign < 0;
      return std::tie(a.x, a.y, a.point) < std::tie(b.x, b.y, b.point);
    }
  };

  const PointTree& tree_;
  const double unit_;
  const float bound_;
  const std::size_t count_;
  double x_ = 0, y_ = 0, limit_ = 0;
  std::vector<Found> found_;  // with more than one to find a heap, the farthest first
  const Before before_{*this};
};

PointTree::PointTree(const double* coordinates, std::size_t n) {
  const geometry::Magnitudes magnitudes = geometry::inspect(coordinates, 0, n);
  const geometry::Scaling scaling = geometry::scaling_for(coordinates, 0, n, magnitudes);
  range_ = {{magnitudes}, {scaling.shift}};
  const kernel::scaling scale = scaling.powers();
  entries_.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    // Zeros are positive, so that equal places are equal.
    entries_.push_back({kernel::scaled(coordinates[2 * i], scale) + 0.0,
                        kernel::scaled(coordinates[2 * i + 1], scale) + 0.0, static_cast<std::int32_t>(i)});
  }
  nodes_.reserve(2 * (n / kLeaf + 1));
  if (n > 0) make_nodes(0, static_cast<std::int32_t>(n));
}

void PointTree::make_nodes(std::int32_t first, std::int32_t last) {
  const std::size_t at = nodes_.size();
  nodes_.push_back({0, first, last, 0, 0});
  if (last - first <= kLeaf) return;
  const auto begin = entries_.begin() + first, end = entries_.begin() + last;
  double least_x = kInfinity, most_x = -kInfinity, least_y = kInfinity, most_y = -kInfinity;
  for (auto entry = begin; entry != end; ++entry) {
    least_x = std::min(least_x, entry->x);
    most_x = std::max(most_x, entry->x);
    least_y = std::min(least_y, entry->y);
    most_y = std::max(most_y, entry->y);
  }
  const bool is_y = most_y - least_y > most_x - least_x;
  if (least_x == most_x && least_y == most_y) {
    std::sort(begin, end, [](const Entry& a, const Entry& b) { return a.point < b.point; });
    return;
  }
  const std::int32_t middle = first + (last - first) / 2;
  const auto cut = entries_.begin() + middle;
  if (is_y) {
    std::nth_element(begin, cut, end, [](const Entry& a, const Entry& b) { return a.y < b.y; });
  } else {
    std::nth_element(begin, cut, end, [](const Entry& a, const Entry& b) { return a.x < b.x; });
  }
  nodes_[at].cut = is_y ? cut->y : cut->x;
  nodes_[at].axis = is_y ? 1 : 0;
  make_nodes(first, middle);
  nodes_[at].upper = static_cast<std::int32_t>(nodes_.size());
  make_nodes(middle, last);
}

void PointTree::find(const double* queries, std::size_t first, std::size_t last,
                     const points::QueryScaling& scaling, const NeighborOptions& options,
                     Neighbors& result) const {
  const std::size_t count = options.count;
  const kernel::scaling scale = scaling.frames[0].scale;
  const int shift = range_.shifts[0] + std::ilogb(scaling.frames[0].unit);
  const double limit = std::ldexp(options.max_distance, shift);
  Search search(*this, scaling, std::min(count, entries_.size()));
  for (std::size_t i = first; i < last; ++i) {
    search.find(kernel::scaled(queries[2 * i], scale), kernel::scaled(queries[2 * i + 1], scale),
                limit * limit);
    std::size_t place = i * count;
    for (const auto& one : search.found()) {
      const double distance = std::ldexp(std::sqrt(one.square), -shift);
      if (distance > options.max_distance) break;
      result.points[place] = one.point;
      result.distances[place] = distance;
      ++place;
    }
  }
}

}  // namespace flaunay::nearest
