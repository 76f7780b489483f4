#include "constrained/refinement/cuts.hpp"

#include <algorithm>
#include <cmath>

#include "refinement/leaves.h"

namespace flaunay::constrained {
namespace {

using kernel::block_cut;
using kernel::double2;

// Gaps are looked for between these quantiles.
constexpr double kLowQuantile = 0.3, kHighQuantile = 0.7;
// Places that are nearly the same have no leaf each.
constexpr int kMostDepth = 60;

class Cutting {
 public:
  Cutting(std::vector<double2> places, std::size_t most, Cuts how)
      : places_(std::move(places)), most_(most), how_(how), cuts_(1) {
    cut(0, 0, places_.size(), 0);
  }
  std::vector<block_cut> cuts() { return std::move(cuts_); }

 private:
  static double along(double2 p, int axis) { return axis == 0 ? p.x : p.y; }

  void cut(std::size_t node, std::size_t begin, std::size_t end, int depth) {
    cuts_[node] = {0, -1, leaves_};
    if (end - begin > most_ && depth < kMostDepth) {
      const block_cut found = how_ == Cuts::medians ? median(begin, end) : gap(begin, end);
      const auto middle =
          std::partition(at(begin), at(end), [&](double2 p) { return along(p, found.axis) < found.at; });
      const auto first = static_cast<std::size_t>(middle - places_.begin());
      if (first > begin && first < end) {
        const std::size_t child = cuts_.size();
        cuts_.resize(child + 2);
        cuts_[node] = {found.at, found.axis, static_cast<int>(child)};
        cut(child, begin, first, depth + 1);
        cut(child + 1, first, end, depth + 1);
        return;
      }
    }
    ++leaves_;
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

  // A gap is what some consecutive places span, about half of the square root of all.
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

  std::vector<double2> places_;
  std::vector<double> values_;
  std::size_t most_;
  Cuts how_;
  std::vector<block_cut> cuts_;
  int leaves_ = 0;
};

}  // namespace

std::vector<block_cut> cut_plane(std::vector<double2> places, std::size_t most, Cuts how) {
  return Cutting(std::move(places), most, how).cuts();
}

std::size_t leaf_of(const std::vector<block_cut>& cuts, double2 place) {
  return static_cast<std::size_t>(kernel::leaf_at(cuts.data(), place));
}

std::size_t leaves_of(const std::vector<block_cut>& cuts) { return (cuts.size() + 1) / 2; }

}  // namespace flaunay::constrained
