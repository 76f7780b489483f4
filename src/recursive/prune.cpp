#include "recursive/prune.hpp"

#include <cmath>
#include <limits>

#include "recursive/quickhull.hpp"

namespace flaunay::recursive {
namespace {

// Candidates from which on it pays to prune them by candidates of their own.
constexpr std::size_t kManyCandidates = 256;

// Of each bucket the point nearest to the line.
std::vector<HullPoint> candidates_of(const Line& line, const std::vector<HullPoint>& points,
                                     Counter& counter) {
  std::vector<HullPoint> candidates;
  double best = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = line.planar() ? points[i].s() : std::fabs(points[i].s() - line.q);
    if (i % kBucket == 0) {
      candidates.push_back(points[i]);
      best = distance;
    } else if (distance < best) {
      candidates.back() = points[i];
      best = distance;
    }
  }
  counter.arithmetic((line.planar() ? 1 : 2) * points.size());
  counter.critical_path(2 + reduce_depth(kBucket) + scan_depth(points.size()));
  return candidates;
}

}  // namespace

Prune::Prune(const Predicates& predicates, const Line& line, const Path& path, bool keep_on, Counter& counter)
    : predicates_(predicates), line_(line), path_(path), keep_on_(keep_on), counter_(counter) {
  make_bands();
}

// A chord of length l between heights h and k stays below max(h, k) + l^2 / 4; of a planar hull, whose
// heights have no zero, below max(h, k). Greater by more than the rounding of depths.
void Prune::make_bands() {
  constexpr double kSlack = 1 + 0x1p-20;
  bands_.assign(path_.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k + 1 < path_.size(); ++k) {
    if (line_.planar()) {
      bands_[k] = std::fmax(path_[k].s(), path_[k + 1].s());
    } else {
      const double across =
          std::fmax(std::fabs(path_[k].s() - line_.q), std::fabs(path_[k + 1].s() - line_.q));
      const double along = path_[k + 1].u() - path_[k].u();
      bands_[k] = kSlack * (across * across + 0.25 * along * along);
    }
  }
  const std::uint64_t operations = line_.planar() ? 1 : 9;
  counter_.arithmetic(operations * (path_.size() - 1));
  counter_.critical_path(operations);
}

bool Prune::is_above_band(const HullPoint& p, std::size_t low) {
  if (line_.planar()) {
    counter_.arithmetic();
    return p.s() > bands_[low];
  }
  counter_.arithmetic(3);
  return (p.s() - line_.q) * (p.s() - line_.q) > bands_[low];
}

std::size_t search_path(const Path& path, double u, Counter& counter) {
  std::size_t low = 0, high = path.size();
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    counter.arithmetic();
    (path[middle].u() <= u ? low : high) = middle;
  }
  return low;
}

// p against the chord that begins with vertex `low`.
Kept Prune::held_against(const HullPoint& p, std::size_t low) {
  const HullPoint& v = path_[low];
  const bool is_last = low + 1 == path_.size();
  counter_.arithmetic();
  if (v.u() == p.u()) {
    if (p.id == v.id) return keep_on_ || (low != 0 && !is_last) ? Kept::yes : Kept::end;
    if (keep_on_) return is_last ? Kept::yes : Kept::no;
    counter_.arithmetic(4);
    return line_.is_lower(p.place, v.place) ? Kept::yes : Kept::no;
  }
  counter_.depth();
  const int sign = predicates_.depth(v.place, path_[low + 1].place, p.place, line_.q, line_.planar()).sign;
  return sign > 0 || (keep_on_ && sign == 0) ? Kept::yes : Kept::no;
}

std::vector<Kept> Prune::sorted(const std::vector<HullPoint>& points) {
  std::vector<Kept> kept(points.size(), Kept::no);
  for (std::size_t begin = 0; begin < points.size(); begin += kBucket) {
    const std::size_t end = std::min(points.size(), begin + kBucket);
    std::size_t low = search_path(path_, points[begin].u(), counter_);
    const std::size_t last_low = end - begin > 1 ? walk(low, points[end - 1].u()) : low;
    for (std::size_t i = begin; i < end; ++i) {
      if (low != last_low) low = walk(low, points[i].u());
      if (!is_above_band(points[i], low)) kept[i] = held_against(points[i], low);
    }
  }
  counter_.critical_path(2 * reduce_depth(path_.size()) + 3 + 1 + 18 + scan_depth(points.size()));
  return kept;
}

std::vector<Kept> Prune::unsorted(const std::vector<HullPoint>& points) {
  std::vector<Kept> kept(points.size(), Kept::no);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t low = search_path(path_, points[i].u(), counter_);
    if (!is_above_band(points[i], low)) kept[i] = held_against(points[i], low);
  }
  return kept;
}

// From a vertex to the last one with u no greater than the given one.
std::size_t Prune::walk(std::size_t low, double u) {
  const auto compared = [this](bool result) {
    counter_.arithmetic();
    return result;
  };
  while (low + 1 < path_.size() && compared(path_[low + 1].u() <= u)) ++low;
  while (low > 0 && compared(path_[low].u() > u)) --low;
  return low;
}

std::vector<HullPoint> pick(const std::vector<HullPoint>& points, const std::vector<Kept>& kept) {
  std::vector<HullPoint> picked;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (kept[i] == Kept::yes) picked.push_back(points[i]);
  }
  return picked;
}

Path chord_path(const Predicates& predicates, const Line& line, const HullPoint& first, const HullPoint& last,
                const std::vector<HullPoint>& points, Counter& counter, LevelStatistics& statistics) {
  std::vector<HullPoint> candidates = candidates_of(line, points, counter);
  statistics.candidates += candidates.size();
  if (candidates.size() > kManyCandidates) {
    const Path path = chord_path(predicates, line, first, last, candidates, counter, statistics);
    candidates = pick(candidates, Prune(predicates, line, path, false, counter).sorted(candidates));
  }
  int rounds = 0;
  const Path path =
      Quickhull(predicates, line, counter).run(first, last, candidates, kMostQuickhullRounds, rounds);
  statistics.candidate_rounds = std::max(statistics.candidate_rounds, rounds);
  return path;
}

}  // namespace flaunay::recursive
