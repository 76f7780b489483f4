#include "tests/fuzz/minimise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>
#include <vector>

namespace flaunay::fuzz {
namespace {

/// The shortest text that reads back to the value. Rounding goes on only as long as texts become shorter, so
/// it ends.
std::size_t length_of(double value) { return fmt::formatted_size("{}", value); }

std::size_t length_of(const Batch& batch) {
  std::size_t length = 0;
  for (const Coordinates& set : batch) {
    for (const double value : set) length += length_of(value);
  }
  return length;
}

double rounded(double value, int digits) {
  return std::strtod(fmt::format("{:.{}e}", value, digits - 1).c_str(), nullptr);
}

constexpr int kDigits[] = {1, 2, 3, 5, 8, 12};

class Minimiser {
 public:
  Minimiser(Batch batch, const Fails& fails, std::size_t most_calls)
      : batch_(std::move(batch)), fails_(fails), calls_left_(most_calls) {}

  Batch run() {
    while (remove_sets() | remove_points() | simplify_all() | simplify_each()) {
    }
    return batch_;
  }

 private:
  /// Goes on with the candidate if it fails too.
  bool accept(Batch candidate) {
    if (calls_left_ == 0) return false;
    --calls_left_;
    if (!fails_(candidate)) return false;
    batch_ = std::move(candidate);
    return true;
  }
  bool accept_if_shorter(Batch candidate) {
    return length_of(candidate) < length_of(batch_) && accept(std::move(candidate));
  }

  /// Removes what is not needed of `count()` elements. without(begin, end): the batch without these.
  template <typename Count, typename Without>
  bool remove_runs(const Count& count, const Without& without) {
    bool removed = false;
    for (std::size_t run = (count() + 1) / 2; run > 0; run /= 2) {
      for (std::size_t begin = 0; begin < count();) {
        const std::size_t end = std::min(begin + run, count());
        if (accept(without(begin, end))) {
          removed = true;
        } else {
          begin = end;
        }
      }
    }
    return removed;
  }
  bool remove_sets() {
    return remove_runs([this] { return batch_.size(); },
                       [this](std::size_t begin, std::size_t end) {
                         Batch fewer = batch_;
                         fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(begin),
                                     fewer.begin() + static_cast<std::ptrdiff_t>(end));
                         return fewer;
                       });
  }
  bool remove_points() {
    bool removed = false;
    for (std::size_t s = 0; s < batch_.size(); ++s) {
      removed |= remove_runs([this, s] { return batch_[s].size() / 2; },
                             [this, s](std::size_t begin, std::size_t end) {
                               Batch fewer = batch_;
                               fewer[s].erase(fewer[s].begin() + static_cast<std::ptrdiff_t>(2 * begin),
                                              fewer[s].begin() + static_cast<std::ptrdiff_t>(2 * end));
                               return fewer;
                             });
    }
    return removed;
  }

  /// Each axis' values of a set become their ranks: their order is all that often matters.
  static Coordinates ranked(const Coordinates& set) {
    Coordinates ranks(set.size());
    for (std::size_t axis = 0; axis < 2; ++axis) {
      std::vector<double> sorted;
      for (std::size_t i = axis; i < set.size(); i += 2) sorted.push_back(set[i]);
      std::sort(sorted.begin(), sorted.end());
      sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
      for (std::size_t i = axis; i < set.size(); i += 2) {
        const auto at = std::lower_bound(sorted.begin(), sorted.end(), set[i]);
        ranks[i] = static_cast<double>(at - sorted.begin());
      }
    }
    return ranks;
  }
  template <typename Change>
  Batch changed(const Change& change) const {
    Batch result = batch_;
    for (Coordinates& set : result) {
      for (double& value : set) value = change(value);
    }
    return result;
  }
  /// Changes all coordinates in the same way.
  bool simplify_all() {
    Batch ranks = batch_;
    for (Coordinates& set : ranks) set = ranked(set);
    bool simpler = accept_if_shorter(std::move(ranks));
    double largest = 0;
    for (const Coordinates& set : batch_) {
      for (const double value : set) largest = std::max(largest, std::fabs(value));
    }
    if (largest > 0) {
      const int exponent = std::ilogb(largest);
      simpler |= accept_if_shorter(changed([=](double v) { return std::ldexp(v, -exponent); }));
    }
    for (const int digits : kDigits) {
      simpler |= accept_if_shorter(changed([=](double v) { return rounded(v, digits); }));
    }
    return simpler;
  }

  /// Changes one coordinate after the other.
  bool simplify_each() {
    bool simpler = false;
    for (std::size_t s = 0; s < batch_.size(); ++s) {
      for (std::size_t i = 0; i < batch_[s].size(); ++i) simpler |= simplify(s, i);
    }
    return simpler;
  }
  bool simplify(std::size_t s, std::size_t i) {
    const double value = batch_[s][i];
    std::vector<double> candidates{0, std::trunc(value)};
    for (const int digits : kDigits) candidates.push_back(rounded(value, digits));
    for (const double candidate : candidates) {
      if (length_of(candidate) >= length_of(value)) continue;
      Batch simpler = batch_;
      simpler[s][i] = candidate;
      if (accept(std::move(simpler))) return true;
    }
    return false;
  }

  Batch batch_;
  const Fails& fails_;
  std::size_t calls_left_;
};

}  // namespace

Batch minimise(Batch batch, const Fails& fails, std::size_t most_calls) {
  return Minimiser(std::move(batch), fails, most_calls).run();
}

std::string fixture_text(const Batch& batch, const std::string& comment) {
  std::string text;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  for (std::size_t s = 0; s < batch.size(); ++s) {
    if (batch.size() > 1) text += fmt::format("# set {}\n", s);
    for (std::size_t i = 0; i < batch[s].size(); i += 2) {
      text += fmt::format("{} {}\n", batch[s][i], batch[s][i + 1]);
    }
  }
  return text;
}

}  // namespace flaunay::fuzz
