#include "constrained/crossings/crossing_places.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

namespace flaunay::constrained {
using namespace geometry;

namespace {

// If nothing else is so near to a crossing on its edges, then nothing that its edges do not meet is within
// 2 kHalfSpacing of it: see docs/constrained.md. A line at that distance meets one of the edges within 2
// sqrt(2) kHalfSpacing / sin(angle / 2).
double reach(const Line& p, const Line& q) {
  const double px = p.b.x - p.a.x, py = p.b.y - p.a.y, qx = q.b.x - q.a.x, qy = q.b.y - q.a.y;
  const double left = px * qy, right = py * qx;
  const double cross = std::fabs(left - right) - 0x1p-50 * (std::fabs(left) + std::fabs(right));
  if (cross <= 0) return HUGE_VAL;
  return 32 * kHalfSpacing * ((std::fabs(px) + std::fabs(py)) * ((std::fabs(qx) + std::fabs(qy)) / cross));
}

std::uint64_t hash(Point p) {
  std::uint64_t x, y;
  std::memcpy(&x, &p.x, sizeof x);
  std::memcpy(&y, &p.y, sizeof y);
  // Multiplies by large odd numbers; the upper bits of a product depend on all bits.
  return (x * 0x9e3779b97f4a7c15 + y * 0xc2b2ae3d27d4eb4f) >> 32;
}

void turn_equal_x(const std::vector<Point>& places, Ids::iterator first, Ids::iterator last) {
  for (auto begin = first, end = first; begin != last; begin = end) {
    while (end != last && places[*end].x == places[*begin].x) ++end;
    std::reverse(begin, end);
  }
}

}  // namespace

Vertices::Vertices(const double* coordinates, const PointSets& sets, std::size_t set) {
  const auto begin = static_cast<std::size_t>(sets.set_offsets[set]);
  const auto end = static_cast<std::size_t>(sets.set_offsets[set + 1]);
  int largest = std::numeric_limits<int>::min();
  for (std::size_t i = begin; i < end; ++i) {
    for (const int k : {0, 1}) {
      const double c = coordinates[2 * static_cast<std::size_t>(sets.source[i]) + k];
      if (c != 0) largest = std::max(largest, std::ilogb(c));
    }
  }
  if (largest == std::numeric_limits<int>::min()) largest = 0;
  shift = kernel::LARGEST_EXPONENT - largest;
  // The exponent of the lowest bit of a double.
  constexpr int kLowest = std::numeric_limits<double>::min_exponent - std::numeric_limits<double>::digits;
  unit = std::ldexp(1.0, std::max<int>(kernel::LOWEST_EXPONENT, kLowest + shift));
  for (std::size_t i = begin; i < end; ++i) {
    const double* from = coordinates + 2 * static_cast<std::size_t>(sets.source[i]);
    points.push_back({std::ldexp(from[0], shift) + 0.0, std::ldexp(from[1], shift) + 0.0});
  }
  given = points.size();
  sorted.resize(points.size());
  std::iota(sorted.begin(), sorted.end(), 0);
}

Ids Vertices::find_or_add(const std::vector<Point>& places) {
  Ids result;
  result.reserve(places.size());
  const std::size_t before = points.size();
  auto next = sorted.begin();
  for (const Point place : places) {
    while (next != sorted.end() && kernel::comes_before(points[*next], place)) ++next;
    const bool is_known = next != sorted.end() && points[*next] == place;
    result.push_back(is_known ? *next : static_cast<std::int32_t>(points.size()));
    if (!is_known) points.push_back(place);
  }
  sorted.resize(points.size());
  const auto added = sorted.begin() + static_cast<std::ptrdiff_t>(before);
  std::iota(added, sorted.end(), static_cast<std::int32_t>(before));
  std::inplace_merge(sorted.begin(), added, sorted.end(), [this](std::int32_t u, std::int32_t v) {
    return kernel::comes_before(points[u], points[v]) != 0;
  });
  return result;
}

bool CrossingPlaces::add(std::int32_t e, std::int32_t f) {
  const Line p = line(e), q = line(f);
  const Point at = round_crossing(p, q, vertices_.unit);
  all_.push_back({at, reach(p, q), e, f});
  if (all_.size() >= merge_at_) merge();
  Recent& recent = recent_[hash(at) % kRecent];
  if (!(recent.at == at)) recent = {at, 0, false};
  if (++recent.pairs == kPairsOfHub && are_exactly_there(p, q, at)) {
    recent.is_hub = true;
    hubs_.push_back(at);
  }
  if (recent.is_hub) ++pairs_of_hubs_;
  return pairs_of_hubs_ <= patience_ * (kFirstPairs + edges_.size() + places_);
}

std::vector<Point> CrossingPlaces::hubs() const {
  std::vector<Point> hubs = hubs_;
  std::sort(hubs.begin(), hubs.end(), [](Point p, Point q) { return kernel::comes_before(p, q) != 0; });
  hubs.erase(std::unique(hubs.begin(), hubs.end(), [](Point p, Point q) { return p == q; }), hubs.end());
  return hubs;
}

Chains CrossingPlaces::chains(Vertices& vertices, bool& are_apart) {
  std::vector<std::size_t> ends(edges_.size() + 1, 0);
  for (const Crossing& crossing : all_) {
    ++ends[crossing.e + 1];
    if (crossing.f >= 0) ++ends[crossing.f + 1];
  }
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  // Places in lexicographic order, so that they come to each edge in that order.
  Ids ranks(ends.back());
  std::vector<std::size_t> next(ends.begin(), ends.end() - 1);
  std::vector<Point> places;
  std::vector<double> reaches;
  for (const Keyed& k : sorted()) {
    const Crossing& crossing = all_[k.index];
    if (places.empty() || !(places.back() == crossing.at)) {
      places.push_back(crossing.at);
      reaches.push_back(0);
    }
    reaches.back() = std::max(reaches.back(), crossing.reach);
    const auto rank = static_cast<std::int32_t>(places.size()) - 1;
    for (const std::int32_t e : {crossing.e, crossing.f}) {
      if (e >= 0 && (next[e] == ends[e] || ranks[next[e] - 1] != rank)) ranks[next[e]++] = rank;
    }
  }
  all_ = {};
  const Ids vertex_of = vertices.find_or_add(places);

  Chains chains;
  chains.offsets.reserve(edges_.size() + 1);
  chains.offsets.push_back(0);
  are_apart = true;
  std::size_t kept = 0;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Point from = vertices.points[edges_[e].from], to = vertices.points[edges_[e].to];
    const auto begin = ranks.begin() + static_cast<std::ptrdiff_t>(ends[e]),
               end = ranks.begin() + static_cast<std::ptrdiff_t>(next[e]);
    if (to.y < from.y) turn_equal_x(places, begin, end);
    Point last = from;
    double reach = 0;
    const auto measure = [&](Point p, double reach_of_p) {
      are_apart &= std::max(std::fabs(p.x - last.x), std::fabs(p.y - last.y)) > std::max(reach, reach_of_p);
      last = p;
      reach = reach_of_p;
    };
    for (auto r = begin; r != end; ++r) {
      measure(places[*r], reaches[*r]);
      ranks[kept++] = vertex_of[*r];
    }
    if (begin != end) measure(to, 0);
    chains.offsets.push_back(kept);
  }
  ranks.resize(kept);
  chains.vertices = std::move(ranks);
  return chains;
}

Line CrossingPlaces::line(std::int32_t e) const {
  return {vertices_.points[edges_[e].from], vertices_.points[edges_[e].to]};
}

bool CrossingPlaces::are_exactly_there(const Line& p, const Line& q, Point at) const {
  return predicates_.orient(p.a, p.b, at) == 0 && predicates_.orient(q.a, q.b, at) == 0;
}

std::vector<Keyed> CrossingPlaces::sorted() const {
  std::vector<Keyed> order;
  order.reserve(all_.size());
  for (std::size_t k = 0; k < all_.size(); ++k) {
    order.push_back({sort_key(all_[k].at.x), static_cast<std::int32_t>(k)});
  }
  sort_by_key(order);
  for (auto begin = order.begin(), end = begin; begin != order.end(); begin = end) {
    while (end != order.end() && end->key == begin->key) ++end;
    if (end - begin == 1) continue;
    std::sort(begin, end,
              [this](const Keyed& p, const Keyed& q) { return all_[p.index].at.y < all_[q.index].at.y; });
  }
  return order;
}

void CrossingPlaces::merge() {
  std::vector<Crossing> merged;
  const std::vector<Keyed> order = sorted();
  places_ = 0;
  Ids here;
  for (auto begin = order.begin(), end = begin; begin != order.end(); begin = end) {
    const Point at = all_[begin->index].at;
    double reach = 0;
    here.clear();
    for (; end != order.end() && all_[end->index].at == at; ++end) {
      const Crossing& crossing = all_[end->index];
      reach = std::max(reach, crossing.reach);
      here.push_back(crossing.e);
      if (crossing.f >= 0) here.push_back(crossing.f);
    }
    std::sort(here.begin(), here.end());
    here.erase(std::unique(here.begin(), here.end()), here.end());
    for (std::size_t k = 0; k < here.size(); k += 2) {
      merged.push_back({at, reach, here[k], k + 1 < here.size() ? here[k + 1] : -1});
    }
    ++places_;
  }
  check_pieces(merged.size(), limits_);
  all_.swap(merged);
  merge_at_ = std::max(kFirstMerge, 2 * all_.size());
}

}  // namespace flaunay::constrained
