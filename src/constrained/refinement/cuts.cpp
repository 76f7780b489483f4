#include "constrained/refinement/cuts.hpp"

#include <algorithm>
#include <cmath>

namespace flaunay::constrained {
namespace {

using kernel::block_cut;
using kernel::double2;

// Gaps are looked for between these quantiles.
constexpr double kLowQuantile = 0.3, kHighQuantile = 0.7;
// Places that are nearly the same have no leaf each.
constexpr int kMostDepth = 60;

// At least kManyPlaces places are cut this many times before threads share the parts.
constexpr std::size_t kManyPlaces = 4096;
constexpr int kLevelsBefore = 4;

class Cutting {
 public:
  Cutting(std::vector<double2>& places, std::size_t most, Cuts how)
      : places_(places), most_(most), how_(how) {}

  // A tree of the places in a range, the root first; leaves are numbered from left to right.
  std::vector<block_cut> cut_all(std::size_t begin, std::size_t end, int depth) {
    cuts_.resize(1);
    cut(0, begin, end, depth);
    return std::move(cuts_);
  }

  // Cuts a range once. middle: where places beyond the cut begin, or the end if it is a leaf.
  block_cut cut_once(std::size_t begin, std::size_t end, int depth, std::size_t& middle) {
    if (end - begin > most_ && depth < kMostDepth) {
      const block_cut found = how_ == Cuts::medians ? median(begin, end) : gap(begin, end);
      const auto beyond =
          std::partition(at(begin), at(end), [&](double2 p) { return along(p, found.axis) < found.at; });
      middle = static_cast<std::size_t>(beyond - places_.begin());
      if (middle > begin && middle < end) return found;
    }
    middle = end;
    return {0, -1, 0};
  }

 private:
  static double along(double2 p, int axis) { return axis == 0 ? p.x : p.y; }

  void cut(std::size_t node, std::size_t begin, std::size_t end, int depth) {
    std::size_t middle;
    block_cut made = cut_once(begin, end, depth, middle);
    made.child = middle == end ? leaves_++ : static_cast<int>(cuts_.size());
    cuts_[node] = made;
    if (middle == end) return;
    cuts_.resize(cuts_.size() + 2);
    cut(static_cast<std::size_t>(made.child), begin, middle, depth + 1);
    cut(static_cast<std::size_t>(made.child) + 1, middle, end, depth + 1);
  }

  std::vector<double2>::iterator at(std::size_t i) {
    return places_.begin() + static_cast<std::ptrdiff_t>(i);
  }

  block_cut median(std::size_t begin, std::size_t end) {
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (std::size_t i = begin; i < end; ++i) {
      for (int k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], along(places_[i], k));
        high[k] = std::max(high[k], along(places_[i], k));
      }
    }
    const int axis = high[1] - low[1] > high[0] - low[0];
    const auto middle = at((begin + end) / 2);
    std::nth_element(at(begin), middle, at(end),
                     [&](double2 p, double2 q) { return along(p, axis) < along(q, axis); });
    return {along(*middle, axis), axis, 0};
  }

  // A gap is the interval that some consecutive places span: about half of the square root of their number.
  block_cut gap(std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin,
                      width = std::max<std::size_t>(
                          1, static_cast<std::size_t>(std::sqrt(static_cast<double>(n)) / 2));
    const auto first = static_cast<std::ptrdiff_t>(kLowQuantile * static_cast<double>(n)),
               last = static_cast<std::ptrdiff_t>(kHighQuantile * static_cast<double>(n));
    block_cut best = {0, 0, 0};
    double widest = -1;
    for (int axis = 0; axis < 2; ++axis) {
      values_.clear();
      for (std::size_t i = begin; i < end; ++i) values_.push_back(along(places_[i], axis));
      const auto low = values_.begin() + first, high = values_.begin() + last;
      std::nth_element(values_.begin(), low, values_.end());
      std::nth_element(low, high, values_.end());
      std::sort(low, high);
      for (auto i = static_cast<std::size_t>(first); i + width <= static_cast<std::size_t>(last); ++i) {
        const double wide = values_[i + width] - values_[i];
        if (wide > widest) {
          widest = wide;
          best = {values_[i] + wide / 2, axis, 0};
        }
      }
    }
    return best;
  }

  std::vector<double2>& places_;
  std::vector<double> values_;
  std::size_t most_;
  Cuts how_;
  std::vector<block_cut> cuts_;
  int leaves_ = 0;
};

}  // namespace

std::vector<block_cut> cut_plane(host::Runtime& runtime, std::vector<double2> places, std::size_t most,
                                 Cuts how) {
  struct Range {
    std::size_t begin, end, node;
    int depth;
    std::size_t middle = 0;
    std::vector<block_cut> cuts{};
  };
  const auto each = [&](std::vector<Range>& ranges, const auto& work) {
    runtime.share(ranges.size(), [&](std::size_t k) {
      Cutting cutting(places, most, how);
      work(cutting, ranges[k]);
    });
  };
  std::vector<block_cut> cuts(1);
  std::vector<Range> ranges{{0, places.size(), 0, 0}};
  for (int level = 0; level < (places.size() < kManyPlaces ? 0 : kLevelsBefore); ++level) {
    each(ranges, [](Cutting& cutting, Range& range) {
      range.cuts = {cutting.cut_once(range.begin, range.end, range.depth, range.middle)};
    });
    std::vector<Range> next;
    for (const auto& [begin, end, node, depth, middle, made] : ranges) {
      cuts[node] = made[0];
      if (middle == end) {
        next.push_back({begin, end, node, depth});
        continue;
      }
      cuts[node].child = static_cast<int>(cuts.size());
      next.push_back({begin, middle, cuts.size(), depth + 1});
      next.push_back({middle, end, cuts.size() + 1, depth + 1});
      cuts.resize(cuts.size() + 2);
    }
    ranges = std::move(next);
  }
  each(ranges, [](Cutting& cutting, Range& range) {
    range.cuts = cutting.cut_all(range.begin, range.end, range.depth);
  });
  int leaves = 0;
  for (const Range& range : ranges) {
    const auto shift = static_cast<int>(cuts.size()) - 1, first = leaves;
    for (std::size_t k = 0; k < range.cuts.size(); ++k) {
      block_cut made = range.cuts[k];
      leaves += made.axis < 0 ? 1 : 0;
      made.child += made.axis < 0 ? first : shift;
      if (k == 0) cuts[range.node] = made;
      if (k > 0) cuts.push_back(made);
    }
  }
  return cuts;
}

std::size_t leaves_of(const std::vector<block_cut>& cuts) { return (cuts.size() + 1) / 2; }

}  // namespace flaunay::constrained
