#include "recursive/quickhull.hpp"

#include <cmath>
#include <cstring>

namespace flaunay::recursive {

struct Quickhull::Below {
  HullPoint point;
  double rank;           // the greatest becomes a vertex
  std::size_t position;  // in the segment, of all of its points
  bool dropped = false;
};

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

// Calls use(p, q) for every pair of points in positions 2k and 2k + 1, both below the chord, p before q in u.
// Pairs of equal u are none: the lower one is a rival of the other, and says nothing of what lies between two
// vertices.
template <typename Belows, typename Use>
void for_each_pair(Belows& below, const Use& use) {
  for (std::size_t k = 0; k + 1 < below.size(); ++k) {
    auto& p = below[k];
    auto& q = below[k + 1];
    if (p.position % 2 != 0 || q.position != p.position + 1 || p.point.u() == q.point.u()) continue;
    if (p.point.u() < q.point.u()) {
      use(p, q);
    } else {
      use(q, p);
    }
  }
}

}  // namespace

Path Quickhull::run(const HullPoint& first, const HullPoint& last, const std::vector<HullPoint>& points,
                    std::size_t balanced_from, int& rounds) {
  balanced_from_ = balanced_from;
  round_sizes_.clear();
  path_.assign(1, first);
  extend(first, last, points, 0);
  path_.push_back(last);
  for (std::size_t round = 0; round < round_sizes_.size(); ++round) {
    const std::size_t m = round_sizes_[round];
    counter_.critical_path(18 + reduce_depth(m) + 2 + scan_depth(m));
    if (round >= balanced_from_) counter_.critical_path(3 + reduce_depth(m) + 3 + 18);
  }
  rounds = static_cast<int>(round_sizes_.size());
  return std::move(path_);
}

// Appends what lies between a and b.
void Quickhull::extend(const HullPoint& a, const HullPoint& b, const std::vector<HullPoint>& points,
                       std::size_t round) {
  if (points.empty()) return;
  if (round == round_sizes_.size()) round_sizes_.push_back(0);
  round_sizes_[round] += points.size();

  std::vector<Below> below = points_below(a, b, points);
  if (below.empty()) return;
  if (round >= balanced_from_) tilt(a.u(), below);
  const HullPoint e = deepest(below);
  if (round >= balanced_from_) drop_hidden(e, below);

  // Points that share u with the new vertex are above it, and go.
  std::vector<HullPoint> left, right;
  for (const Below& b_k : below) {
    if (b_k.dropped) continue;
    if (b_k.point.u() < e.u()) left.push_back(b_k.point);
    if (b_k.point.u() > e.u()) right.push_back(b_k.point);
  }
  counter_.arithmetic(2 * below.size());
  extend(a, e, left, round + 1);
  path_.push_back(e);
  extend(e, b, right, round + 1);
}

std::vector<Quickhull::Below> Quickhull::points_below(const HullPoint& a, const HullPoint& b,
                                                      const std::vector<HullPoint>& points) {
  std::vector<Below> below;
  for (std::size_t i = 0; i < points.size(); ++i) {
    counter_.depth();
    if (points[i].id == a.id || points[i].id == b.id) continue;
    const Depth depth = predicates_.depth(a.place, b.place, points[i].place, line_.q, line_.planar());
    if (depth.sign > 0) below.push_back({points[i], depth.value, i});
  }
  return below;
}

// Of equal rank the one of the smaller hash, so that flat chords split evenly; of equal u, the lower one, so
// that what else shares that u can be dropped.
HullPoint Quickhull::deepest(const std::vector<Below>& below) {
  const auto is_deeper = [this](const Below& a, const Below& b) {
    if (a.rank != b.rank) return a.rank > b.rank;
    const double u = a.point.u(), v = b.point.u();
    if (u == v) return a.point.id != b.point.id && line_.is_lower(a.point.place, b.point.place);
    const std::uint64_t hash_u = scramble(u), hash_v = scramble(v);
    return hash_u != hash_v ? hash_u < hash_v : u < v;
  };
  const Below* best = &below[0];
  for (const Below& other : below) {
    if (is_deeper(other, *best)) best = &other;
  }
  counter_.arithmetic(below.size() - 1);
  return best->point;
}

// Ranks points by their depth below a line that is parallel to a random pair: the vertex there leaves on one
// side at least one point of half of the pairs, whichever they are (Bhattacharya and Sen 1997).
void Quickhull::tilt(double origin, std::vector<Below>& below) {
  double slope = 0;
  std::uint64_t least = 0;
  bool found = false;
  for_each_pair(below, [&](const Below& p, const Below& q) {
    counter_.arithmetic(4);
    const std::uint64_t hash = scramble((p.position < q.position ? p : q).point.u());
    if (found && hash >= least) return;
    found = true;
    least = hash;
    slope = (q.rank - p.rank) / (q.point.u() - p.point.u());
  });
  if (!found) return;
  counter_.arithmetic(3 * below.size());
  for (Below& b : below) {
    const double tilted = b.rank - slope * (b.point.u() - origin);
    if (std::isfinite(tilted)) b.rank = tilted;
  }
}

// In a pair on one side of e, the point nearer to e is no vertex if it is not below the chord of the other
// and e.
void Quickhull::drop_hidden(const HullPoint& e, std::vector<Below>& below) {
  for_each_pair(below, [&](Below& p, Below& q) {
    const bool left = q.point.u() < e.u();
    if (!left && !(p.point.u() > e.u())) return;
    counter_.depth();
    const Depth depth =
        left ? predicates_.depth_filtered(p.point.place, e.place, q.point.place, line_.q, line_.planar())
             : predicates_.depth_filtered(e.place, q.point.place, p.point.place, line_.q, line_.planar());
    if (depth.sign <= 0) (left ? q : p).dropped = true;
  });
}

void Quickhull::strict(Path& path) {
  std::size_t before;
  do {
    before = path.size();
    Path kept(1, path.front());
    for (std::size_t k = 1; k + 1 < path.size(); ++k) {
      counter_.depth();
      const Depth depth =
          predicates_.depth(path[k - 1].place, path[k + 1].place, path[k].place, line_.q, line_.planar());
      if (depth.sign > 0) kept.push_back(path[k]);
    }
    kept.push_back(path.back());
    counter_.critical_path(18 + scan_depth(path.size()));
    path = std::move(kept);
  } while (path.size() < before);
}

}  // namespace flaunay::recursive
