#include "modes/recursive/prune.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "flattened/limits.h"
#include "modes/recursive/quickhull.hpp"

namespace flaunay::recursive {
using namespace geometry;
using namespace statistics;

namespace {

// The point nearest to the line in each bucket.
std::vector<HullPoint> candidates_of(const std::vector<HullPoint>& points, Counter& counter) {
  std::vector<HullPoint> candidates;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % kernel::BUCKET == 0) {
      candidates.push_back(points[i]);
    } else if (points[i].height() < candidates.back().height()) {
      candidates.back() = points[i];
    }
  }
  counter.arithmetic(points.size());
  counter.critical_path(log2_ceiling(kernel::BUCKET) + scan_depth(points.size()));
  return candidates;
}

// Computes a path over the internal points that is good enough to prune by.
Path chord_path(const Predicates& predicates, const HullPoints& points, Counter& counter,
                LevelStatistics& statistics) {
  HullPoints thin{points.line, points.first, points.last, candidates_of(points.internal, counter), {}};
  counter.arithmetic(2 * kernel::PROJECT_OPERATIONS);
  statistics.candidates += thin.internal.size();
  if (thin.internal.size() > kernel::MANY_CANDIDATES) {
    LevelStatistics of_candidates;
    LowerHull hull = pruned_hull(predicates, thin, counter, of_candidates);
    statistics.candidates += of_candidates.candidates;
    statistics.candidate_rounds = of_candidates.candidate_rounds + of_candidates.hull_rounds;
    return std::move(hull.path);
  }
  Quickhull quickhull(predicates, points.line, kernel::MOST_QUICKHULL_ROUNDS, counter);
  Path path = quickhull.run(points.first, points.last, thin.internal, statistics.candidate_rounds);
  quickhull.strict(path);
  return path;
}

// Adds each point that is kept to the chord that it is below.
void group(const std::vector<HullPoint>& points, const std::vector<Held>& held, BelowChords& below) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (held[i].kept != Kept::yes) continue;
    std::vector<Below>& segment = below[held[i].chord];
    segment.push_back({points[i], held[i].depth, segment.size()});
  }
}

}  // namespace

Prune::Prune(const Predicates& predicates, const Line& line, const Path& path, bool keep_on, Counter& counter)
    : predicates_(predicates), line_(line), path_(path), keep_on_(keep_on), counter_(counter) {
  make_bands();
}

// A chord of length l between heights h and k stays below max(h, k) + l^2 / 4; in a planar hull, where
// heights have no zero, below max(h, k). The bands are larger by more than the rounding error of depths.
void Prune::make_bands() {
  constexpr double kSlack = 1 + 0x1p-20;
  bands_.assign(path_.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k + 1 < path_.size(); ++k) {
    bands_[k] = std::fmax(path_[k].height(), path_[k + 1].height());
    if (line_.planar()) continue;
    const double along = path_[k + 1].u() - path_[k].u();
    bands_[k] = kSlack * (bands_[k] + 0.25 * along * along);
  }
  counter_.arithmetic(kernel::BAND_OPERATIONS * (path_.size() - 1));
  counter_.critical_path(kernel::BAND_OPERATIONS);
}

bool Prune::is_above_band(const HullPoint& p, std::size_t low) {
  counter_.arithmetic();
  return p.height() > bands_[low];
}

std::size_t search_path(const Path& path, double u) {
  std::size_t low = 0, high = path.size();
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (path[middle].u() <= u ? low : high) = middle;
  }
  return low;
}

// Compares p with the chord that begins at vertex `low`. A point below the last vertex, at the same u, is
// assigned to the chord that ends there. A point below the path at the u of another vertex comes before that
// vertex on the hull. The first round must take it: its mirror image in the line would not be below later
// chords from that vertex.
Held Prune::held_against(const HullPoint& p, std::size_t low) {
  const HullPoint& v = path_[low];
  const std::size_t last = path_.size() - 1;
  counter_.arithmetic();
  if (v.u() == p.u()) {
    if (p.id == v.id) return {keep_on_ ? Kept::yes : Kept::on_path};
    if (keep_on_) return {low == last ? Kept::yes : Kept::no};
    counter_.arithmetic(kernel::LOWER_OPERATIONS);
    if (!line_.is_lower(p, v)) return {};
    return {Kept::yes, std::min(low, last - 1), std::numeric_limits<double>::infinity()};
  }
  counter_.depth();
  const Depth depth = line_.depth(predicates_, path_[low], path_[low + 1], p);
  if (depth.sign < 0 || (depth.sign == 0 && !keep_on_)) return {};
  return {Kept::yes, low, depth.value};
}

// The critical path assumes that all points are compared at the same time, each with a search of its own.
Pruned Prune::run(const HullPoints& points) {
  Pruned pruned{sorted(points.internal), unsorted(points.corners)};
  counter_.critical_path(kernel::PROJECT_OPERATIONS + 2 + 2 * search_comparisons(path_.size()) + 1 + 1 +
                         kernel::LOWER_OPERATIONS + kernel::DEPTH_OPERATIONS +
                         scan_depth(points.internal.size() + points.corners.size()));
  return pruned;
}

std::vector<Held> Prune::sorted(const std::vector<HullPoint>& points) {
  std::vector<Held> held(points.size());
  for (std::size_t begin = 0; begin < points.size(); begin += kernel::BUCKET) {
    const std::size_t end = std::min(points.size(), begin + kernel::BUCKET);
    const auto [least, greatest] = std::minmax({points[begin].u(), points[end - 1].u()});
    std::size_t low = search_path(path_, least);
    const bool one_chord = low + 1 == path_.size() || path_[low + 1].u() > greatest;
    counter_.arithmetic(2 + search_comparisons(path_.size()));
    for (std::size_t i = begin; i < end; ++i) {
      if (!one_chord) low = walk(low, points[i].u());
      if (!is_above_band(points[i], low)) held[i] = held_against(points[i], low);
    }
  }
  return held;
}

std::vector<Held> Prune::unsorted(const std::vector<HullPoint>& points) {
  std::vector<Held> held(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t low = search_path(path_, points[i].u());
    counter_.arithmetic(kernel::PROJECT_OPERATIONS + search_comparisons(path_.size()));
    if (!is_above_band(points[i], low)) held[i] = held_against(points[i], low);
  }
  return held;
}

// Walks from a vertex to the last vertex whose u is not greater than the given one.
std::size_t Prune::walk(std::size_t low, double u) {
  const std::size_t from = low;
  while (low + 1 < path_.size() && path_[low + 1].u() <= u) ++low;
  while (low > 0 && path_[low].u() > u) --low;
  counter_.arithmetic(2 + (low > from ? low - from : from - low));
  return low;
}

LowerHull pruned_hull(const Predicates& predicates, const HullPoints& points, Counter& counter,
                      LevelStatistics& statistics) {
  const Path chords = chord_path(predicates, points, counter, statistics);
  const auto [internal, corners] = Prune(predicates, points.line, chords, false, counter).run(points);
  BelowChords below(chords.size());
  group(points.internal, internal, below);
  group(points.corners, corners, below);

  LowerHull hull;
  for (const Held& held : corners) hull.corners.push_back(held.kept);
  for (const std::vector<Below>& segment : below) statistics.survivors += segment.size();
  // Corners that are kept are projected once more.
  counter.arithmetic(kernel::PROJECT_OPERATIONS * static_cast<std::uint64_t>(std::count(
                                                      hull.corners.begin(), hull.corners.end(), Kept::yes)));
  counter.critical_path(log2_ceiling(chords.size()) * scan_depth(statistics.survivors));

  Quickhull quickhull(predicates, points.line, kernel::MOST_QUICKHULL_ROUNDS, counter);
  hull.path = quickhull.go_on(chords, std::move(below), statistics.hull_rounds);
  quickhull.strict(hull.path);
  return hull;
}

}  // namespace flaunay::recursive
