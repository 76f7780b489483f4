#include "modes/recursive/quickhull.hpp"

#include <cmath>
#include <cstring>
#include <utility>

#include "flattened/limits.h"

namespace flaunay::recursive {
using namespace geometry;
using namespace statistics;

namespace {

// The finaliser of SplitMix64 (Steele, Lea and Flood, 2014), on the bits of u.
std::uint64_t scramble(double u) {
  std::uint64_t z;
  std::memcpy(&z, &u, sizeof z);
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

// Whether u value p comes before q in a random order.
bool comes_first(double p, double q) {
  const std::uint64_t hash_p = scramble(p), hash_q = scramble(q);
  return hash_p != hash_q ? hash_p < hash_q : p < q;
}

// Calls use(p, q) for every pair of points in positions 2k and 2k + 1, both below the chord.
template <typename Belows, typename Use>
void for_each_pair(Belows& below, const Use& use) {
  for (std::size_t k = 0; k + 1 < below.size(); ++k) {
    auto& p = below[k];
    auto& q = below[k + 1];
    if (p.position % 2 == 0 && q.position == p.position + 1) use(p, q);
  }
}

}  // namespace

Path Quickhull::run(const HullPoint& first, const HullPoint& last, const std::vector<HullPoint>& points,
                    int& rounds) {
  path_.assign(1, first);
  extend(first, last, points, 0);
  path_.push_back(last);
  return take_path(false, rounds);
}

Path Quickhull::go_on(const Path& path, BelowChords below, int& rounds) {
  for (std::size_t v = 0; v < path.size(); ++v) {
    path_.push_back(path[v]);
    if (below[v].empty()) continue;
    const std::size_t points = below[v].size();
    note_segment(points, 0);
    split(path[v], path[v + 1], std::move(below[v]), points, 0);
  }
  return take_path(true, rounds);
}

// Returns the finished path, and counts the critical path of its rounds.
Path Quickhull::take_path(bool first_is_known, int& rounds) {
  for (std::size_t round = 0; round < round_sizes_.size(); ++round) {
    const std::size_t m = round_sizes_[round];
    const bool is_known = first_is_known && round == 0;
    counter_.critical_path((is_known ? 0 : kernel::DEPTH_OPERATIONS) + log2_ceiling(m) + 2 + scan_depth(m));
    if (round >= balanced_from_)
      counter_.critical_path(kernel::TILT_OPERATIONS + log2_ceiling(m) + 2 + kernel::DEPTH_OPERATIONS);
  }
  rounds = static_cast<int>(round_sizes_.size());
  round_sizes_.clear();
  return std::exchange(path_, {});
}

void Quickhull::note_segment(std::size_t points, std::size_t round) {
  if (round == round_sizes_.size()) round_sizes_.push_back(0);
  round_sizes_[round] += points;
}

// Appends the vertices between a and b to the path.
void Quickhull::extend(const HullPoint& a, const HullPoint& b, const std::vector<HullPoint>& points,
                       std::size_t round) {
  if (points.empty()) return;
  note_segment(points.size(), round);
  std::vector<Below> below = points_below(a, b, points);
  if (!below.empty()) split(a, b, std::move(below), points.size(), round);
}

// Appends the vertices between a and b. below: the points below the chord; points: the number of points of
// the segment.
void Quickhull::split(const HullPoint& a, const HullPoint& b, std::vector<Below> below, std::size_t points,
                      std::size_t round) {
  if (round >= balanced_from_) tilt(a.u(), points, below);
  const HullPoint e = deepest(below);
  if (round >= balanced_from_) drop_hidden(e, below);

  // Points with the same u as the new vertex are above it, so they are dropped.
  std::vector<HullPoint> left, right;
  for (const Below& p : below) {
    if (p.dropped) continue;
    counter_.arithmetic(2);
    if (p.point.u() < e.u()) left.push_back(p.point);
    if (p.point.u() > e.u()) right.push_back(p.point);
  }
  extend(a, e, left, round + 1);
  path_.push_back(e);
  extend(e, b, right, round + 1);
}

std::vector<Below> Quickhull::points_below(const HullPoint& a, const HullPoint& b,
                                           const std::vector<HullPoint>& points) {
  std::vector<Below> below;
  for (std::size_t i = 0; i < points.size(); ++i) {
    counter_.depth();
    const Depth depth = line_.depth(predicates_, a, b, points[i]);
    if (depth.sign > 0) below.push_back({points[i], depth.value, i});
  }
  return below;
}

// Among points of equal rank, takes the first in a random order of u, so that flat chords split evenly; among
// points of equal u the lowest, so that the others of this u can be dropped.
HullPoint Quickhull::deepest(const std::vector<Below>& below) {
  const auto is_deeper = [this](const Below& a, const Below& b) {
    if (a.rank != b.rank) return a.rank > b.rank;
    if (a.point.u() != b.point.u()) return comes_first(a.point.u(), b.point.u());
    return a.point.id != b.point.id && line_.is_lower(a.point, b.point);
  };
  const Below* best = &below[0];
  for (const Below& other : below) {
    if (is_deeper(other, *best)) best = &other;
  }
  counter_.arithmetic(below.size() - 1);
  return best->point;
}

// Ranks points by their depth below a line that is parallel to a random pair. On either side of the vertex
// that results, about half of the pairs keep at most one of their points (Bhattacharya and Sen 1997). Pairs
// of equal u have no slope and are not drawn.
void Quickhull::tilt(double origin, std::size_t points, std::vector<Below>& below) {
  const Below* first = nullptr;
  const Below* second = nullptr;
  for_each_pair(below, [&](const Below& p, const Below& q) {
    if (p.point.u() == q.point.u()) return;
    if (first) counter_.arithmetic();
    if (first && !comes_first(p.point.u(), first->point.u())) return;
    first = &p;
    second = &q;
  });
  if (!first) return;
  counter_.arithmetic(kernel::TILT_OPERATIONS * points);
  const double slope = (second->rank - first->rank) / (second->point.u() - first->point.u());
  for (Below& b : below) {
    const double tilted = b.rank - slope * (b.point.u() - origin);
    if (std::isfinite(tilted)) b.rank = tilted;
  }
}

// Drops points that cannot be vertices: of a pair on the same side of e, the point nearer to e can only be a
// vertex if it is below the chord between e and the other point.
void Quickhull::drop_hidden(const HullPoint& e, std::vector<Below>& below) {
  for_each_pair(below, [&](Below& one, Below& two) {
    const bool swapped = one.point.u() > two.point.u();
    Below& p = swapped ? two : one;
    Below& q = swapped ? one : two;
    const bool left = q.point.u() < e.u();
    counter_.arithmetic(2);
    if (!(p.point.u() < q.point.u()) || !(left || p.point.u() > e.u())) return;
    counter_.depth();
    const Point &a = p.point.projection, &b = q.point.projection, &middle = e.projection;
    const Depth depth = left ? predicates_.depth_filtered(a, middle, b, line_.planar())
                             : predicates_.depth_filtered(middle, b, a, line_.planar());
    if (depth.sign <= 0) (left ? q : p).dropped = true;
  });
}

bool Quickhull::is_strict(const HullPoint& before, const HullPoint& p, const HullPoint& after) {
  counter_.arithmetic(2);
  if (before.u() == p.u() || after.u() == p.u()) {
    counter_.arithmetic(kernel::LOWER_OPERATIONS);
    return line_.is_lower(p, before.u() == p.u() ? before : after);
  }
  counter_.depth();
  return line_.depth(predicates_, before, after, p).sign > 0;
}

// A vertex needs no second test as long as its neighbours stay.
void Quickhull::strict(Path& path) {
  std::vector<char> is_changed(path.size(), 1);
  for (int round = 1;; ++round) {
    if (round == kernel::CLEAN_UP_ROUNDS) {
      int ignored = 0;
      path = run(path.front(), path.back(), path, ignored);
      is_changed.assign(path.size(), 1);
    }
    Path kept;
    std::vector<char> is_kept_changed;
    bool lost_last = false;
    for (std::size_t k = 0; k < path.size(); ++k) {
      const bool inner = k > 0 && k + 1 < path.size();
      if (inner && is_changed[k] && !is_strict(path[k - 1], path[k], path[k + 1])) {
        is_kept_changed.back() = 1;
        lost_last = true;
        continue;
      }
      kept.push_back(path[k]);
      is_kept_changed.push_back(lost_last);
      lost_last = false;
    }
    counter_.critical_path(2 + kernel::DEPTH_OPERATIONS + scan_depth(path.size()));
    if (kept.size() == path.size()) return;
    path = std::move(kept);
    is_changed = std::move(is_kept_changed);
  }
}

}  // namespace flaunay::recursive
