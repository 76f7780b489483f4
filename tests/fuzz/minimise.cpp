#include "tests/fuzz/minimise.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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

std::size_t length_of(const SegmentBatch& batch) {
  std::size_t length = 0;
  for (const SegmentSet& set : batch) {
    for (const double value : set.points) length += length_of(value);
  }
  return length;
}

double rounded(double value, int digits) {
  return std::strtod(fmt::format("{:.{}e}", value, digits - 1).c_str(), nullptr);
}

constexpr int kDigits[] = {1, 2, 3, 5, 8, 12};

class Minimiser {
 public:
  Minimiser(SegmentBatch batch, const SegmentsFail& fails, std::size_t most_calls)
      : batch_(std::move(batch)), fails_(fails), calls_left_(most_calls) {}

  SegmentBatch run() {
    while (remove_sets() | remove_segments() | remove_points() | simplify_all() | simplify_each()) {
    }
    return batch_;
  }

 private:
  /// Goes on with the candidate if it fails too.
  bool accept(SegmentBatch candidate) {
    if (calls_left_ == 0) return false;
    --calls_left_;
    if (!fails_(candidate)) return false;
    batch_ = std::move(candidate);
    return true;
  }
  bool accept_if_shorter(SegmentBatch candidate) {
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
                         SegmentBatch fewer = batch_;
                         fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(begin),
                                     fewer.begin() + static_cast<std::ptrdiff_t>(end));
                         return fewer;
                       });
  }
  bool remove_points() {
    bool removed = false;
    for (std::size_t s = 0; s < batch_.size(); ++s) {
      removed |= remove_runs([this, s] { return batch_[s].points.size() / 2; },
                             [this, s](std::size_t begin, std::size_t end) {
                               SegmentBatch fewer = batch_;
                               fewer[s] = without_points(batch_[s], begin, end);
                               return fewer;
                             });
    }
    return removed;
  }
  static SegmentSet without_points(const SegmentSet& set, std::size_t begin, std::size_t end) {
    SegmentSet fewer{set.points, {}};
    fewer.points.erase(fewer.points.begin() + static_cast<std::ptrdiff_t>(2 * begin),
                       fewer.points.begin() + static_cast<std::ptrdiff_t>(2 * end));
    const auto first = static_cast<std::int32_t>(begin), last = static_cast<std::int32_t>(end);
    const auto stays = [=](std::int32_t v) { return v < first || v >= last; };
    for (std::size_t i = 0; i + 1 < set.segments.size(); i += 2) {
      if (!stays(set.segments[i]) || !stays(set.segments[i + 1])) continue;
      for (std::size_t k = i; k < i + 2; ++k) {
        fewer.segments.push_back(set.segments[k] < first ? set.segments[k]
                                                         : set.segments[k] - (last - first));
      }
    }
    return fewer;
  }
  bool remove_segments() {
    bool removed = false;
    for (std::size_t s = 0; s < batch_.size(); ++s) {
      removed |= remove_runs([this, s] { return batch_[s].segments.size() / 2; },
                             [this, s](std::size_t begin, std::size_t end) {
                               SegmentBatch fewer = batch_;
                               auto& segments = fewer[s].segments;
                               segments.erase(segments.begin() + static_cast<std::ptrdiff_t>(2 * begin),
                                              segments.begin() + static_cast<std::ptrdiff_t>(2 * end));
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
  SegmentBatch changed(const Change& change) const {
    SegmentBatch result = batch_;
    for (SegmentSet& set : result) {
      for (double& value : set.points) value = change(value);
    }
    return result;
  }
  /// Changes all coordinates in the same way.
  bool simplify_all() {
    SegmentBatch ranks = batch_;
    for (SegmentSet& set : ranks) set.points = ranked(set.points);
    bool simpler = accept_if_shorter(std::move(ranks));
    double largest = 0;
    for (const SegmentSet& set : batch_) {
      for (const double value : set.points) largest = std::max(largest, std::fabs(value));
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
      for (std::size_t i = 0; i < batch_[s].points.size(); ++i) simpler |= simplify(s, i);
    }
    return simpler;
  }
  bool simplify(std::size_t s, std::size_t i) {
    const double value = batch_[s].points[i];
    std::vector<double> candidates{0, std::trunc(value)};
    for (const int digits : kDigits) candidates.push_back(rounded(value, digits));
    for (const double candidate : candidates) {
      if (length_of(candidate) >= length_of(value)) continue;
      SegmentBatch simpler = batch_;
      simpler[s].points[i] = candidate;
      if (accept(std::move(simpler))) return true;
    }
    return false;
  }

  SegmentBatch batch_;
  const SegmentsFail& fails_;
  std::size_t calls_left_;
};

}  // namespace

SegmentBatch minimise(SegmentBatch batch, const SegmentsFail& fails, std::size_t most_calls) {
  return Minimiser(std::move(batch), fails, most_calls).run();
}

Batch minimise(Batch batch, const Fails& fails, std::size_t most_calls) {
  const auto points_alone = [](const SegmentBatch& sets) {
    Batch points;
    for (const SegmentSet& set : sets) points.push_back(set.points);
    return points;
  };
  SegmentBatch sets;
  for (Coordinates& points : batch) sets.push_back({std::move(points), {}});
  const SegmentsFail fail = [&](const SegmentBatch& candidate) { return fails(points_alone(candidate)); };
  return points_alone(minimise(std::move(sets), fail, most_calls));
}

namespace {

std::string as_comment(const std::string& begin, const std::string& comment) {
  std::string text;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) text += begin + line + "\n";
  return text;
}

}  // namespace

std::string fixture_text(const Batch& batch, const std::string& comment) {
  std::string text = as_comment("# ", comment);
  for (std::size_t s = 0; s < batch.size(); ++s) {
    if (batch.size() > 1) text += fmt::format("# set {}\n", s);
    for (std::size_t i = 0; i < batch[s].size(); i += 2) {
      text += fmt::format("{} {}\n", batch[s][i], batch[s][i + 1]);
    }
  }
  return text;
}

std::string test_text(const SegmentBatch& batch, const std::string& comment) {
  Coordinates points;
  std::vector<std::size_t> offsets{0};
  std::vector<std::int32_t> segments;
  for (const SegmentSet& set : batch) {
    for (const std::int32_t v : set.segments)
      segments.push_back(static_cast<std::int32_t>(offsets.back()) + v);
    points.insert(points.end(), set.points.begin(), set.points.end());
    offsets.push_back(points.size() / 2);
  }
  return as_comment("// ", comment) + fmt::format("expect_right(Sets({{{}}}, {{{}}}), {{{}}});\n",
                                                  fmt::join(points, ", "), fmt::join(offsets, ", "),
                                                  fmt::join(segments, ", "));
}

}  // namespace flaunay::fuzz
