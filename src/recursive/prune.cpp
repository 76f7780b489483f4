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
  counter.arithmetic(2 * points.size());
  counter.critical_path(2 + reduce_depth(kBucket) + scan_depth(points.size()));
  return candidates;
}

}  // namespace

Prune::Prune(const Predicates& predicates, const Line& line, const Path& path, bool keep_on, Counter& counter)
    : predicates_(predicates),
      line_(line),
      path_(path),
      keep_on_(keep_on),
      counter_(counter),
      band_(widest_band()) {}

// A height above which nothing can be below a chord: a chord of length l between heights h and k stays below
// max(h, k) + l^2 / 4. Greater by more than the rounding of depths; infinite for planar hulls, whose heights
// have no zero.
double Prune::widest_band() {
  constexpr double kSlack = 1 + 0x1p-20;
  double band = line_.planar() ? std::numeric_limits<double>::infinity() : 0;
  for (std::size_t k = 0; k + 1 < path_.size(); ++k) {
    const double across = std::fmax(std::fabs(path_[k].s() - line_.q), std::fabs(path_[k + 1].s() - line_.q));
    const double along = path_[k + 1].u() - path_[k].u();
    band = std::fmax(band, kSlack * (across * across + 0.25 * along * along));
  }
  counter_.arithmetic(10 * (path_.size() - 1));
  counter_.critical_path(10 + reduce_depth(path_.size()));
  return band;
}

bool Prune::is_above_band(const HullPoint& p) {
  counter_.arithmetic(3);
  return (p.s() - line_.q) * (p.s() - line_.q) > band_;
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
    bool searched = false;
    std::size_t low = 0;
    for (std::size_t i = begin; i < std::min(points.size(), begin + kBucket); ++i) {
      const double u = points[i].u();
      if (is_above_band(points[i])) continue;
      if (!searched) {
        low = search_path(path_, u, counter_);
        searched = true;
      } else {
        const auto step_if = [this](bool go) {
          counter_.arithmetic();
          return go;
        };
        while (low + 1 < path_.size() && step_if(path_[low + 1].u() <= u)) ++low;
        while (low > 0 && step_if(path_[low].u() > u)) --low;
      }
      kept[i] = held_against(points[i], low);
    }
  }
  counter_.critical_path(3 + reduce_depth(path_.size()) + 1 + 18 + scan_depth(points.size()));
  return kept;
}

std::vector<Kept> Prune::unsorted(const std::vector<HullPoint>& points) {
  std::vector<Kept> kept(points.size(), Kept::no);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_above_band(points[i])) continue;
    kept[i] = held_against(points[i], search_path(path_, points[i].u(), counter_));
  }
  return kept;
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
