#include "constrained/split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "constrained/constrained.hpp"
#include "constrained/crossing.hpp"
#include "constrained/lines.hpp"
#include "constrained/point_tree.hpp"
#include "constrained/snap.hpp"
#include "flaunay/flaunay.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/point_sets.hpp"
#include "geometry/sort.hpp"

namespace flaunay::constrained {
namespace {

using Ids = std::vector<std::int32_t>;

constexpr std::size_t kMostIndices = std::numeric_limits<std::int32_t>::max();

[[noreturn]] void throw_too_many(const char* what, std::size_t count, std::size_t most) {
  throw Error(ErrorKind::input,
              fmt::format("splitting segments makes {} {}, which are too many for 32-bit indices: at "
                          "most {} are possible",
                          count, what, most));
}

[[noreturn]] void throw_too_many_places(std::size_t most) {
  throw Error(
      ErrorKind::input,
      fmt::format("segments cross at more than {} places, for which memory or 32-bit indices do not suffice",
                  most));
}

// Points of one set, scaled so that the largest exponent is that of the predicates' range: then all of the
// range is below it.
struct Vertices {
  Vertices(const double* coordinates, const PointSets& sets, std::size_t set) {
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

  Point unscaled(Point p) const { return {std::ldexp(p.x, -shift), std::ldexp(p.y, -shift)}; }
  bool is_added(std::int32_t v) const { return static_cast<std::size_t>(v) >= given; }

  // Returns the vertices at these distinct places, in lexicographic order, which are added where there are
  // none.
  Ids find_or_add(const std::vector<Point>& places) {
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

  std::vector<Point> points;
  Ids sorted;             // all, in lexicographic order
  std::size_t given = 0;  // so many points are the caller's
  int shift = 0;
  double unit = 0;
};

// Half the distance of the doubles that are as large as the largest coordinates of scaled points: rounding
// moves no place by more than that, in each coordinate.
constexpr double kHalfSpacing = 0x1p196;
static_assert(kernel::LARGEST_EXPONENT == 249);

// Crossings of edges, merged at once where they are rounded to one place.
class Crossings {
 public:
  Crossings(const Vertices& vertices, const Predicates& predicates, const std::vector<Piece>& edges,
            std::size_t most)
      : vertices_(vertices), predicates_(predicates), edges_(edges), most_(most) {}

  // Adds two edges that cross. Returns whether to go on: not if many pairs cross at places that are hubs.
  bool add(std::int32_t e, std::int32_t f) {
    const Line p = line(e), q = line(f);
    const std::int32_t k = find_or_add(round_crossing(p, q, vertices_.unit));
    Place& place = places_[k];
    place.reach = std::max(place.reach, reach(p, q));
    ++place.pairs;
    if (place.pairs == kPairsOfHub && are_exactly_there(p, q, place.at)) {
      place.is_hub = true;
      pairs_of_hubs_ += kPairsOfHub;
    }
    if (place.is_hub && ++pairs_of_hubs_ > kFirstPairs + kPairsPerPlace * (edges_.size() + places_.size())) {
      return false;
    }
    for (const std::int32_t edge : {e, f}) {
      meetings_.push_back(static_cast<std::uint64_t>(edge) << 32 | static_cast<std::uint32_t>(k));
    }
    if (meetings_.size() >= merge_at_) merge();
    return true;
  }

  bool empty() const { return places_.empty(); }

  // Places at which many edges cross exactly, in lexicographic order.
  std::vector<Point> hubs() const {
    std::vector<Point> hubs;
    for (const Place& place : places_) {
      if (place.is_hub) hubs.push_back(place.at);
    }
    std::sort(hubs.begin(), hubs.end(), [](Point p, Point q) { return kernel::comes_before(p, q) != 0; });
    return hubs;
  }

  // Makes vertices of the places. Rounding keeps the order of each coordinate. So along an edge, x does not
  // decrease after rounding, and where it is equal, y is still in its order. are_apart: whether no two
  // vertices that follow each other are so near that something else may be between them.
  Chains chains(Vertices& vertices, bool& are_apart) {
    merge();
    const Ids order = sorted_places();
    std::vector<Point> sorted;
    sorted.reserve(order.size());
    for (const std::int32_t k : order) sorted.push_back(places_[k].at);
    const Ids vertex_of = vertices.find_or_add(sorted);
    Ids rank(places_.size());
    for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<std::int32_t>(k);

    Chains chains;
    chains.offsets.reserve(edges_.size() + 1);
    chains.offsets.push_back(0);
    chains.vertices.reserve(meetings_.size());
    are_apart = true;
    Ids ranks;
    auto next = meetings_.begin();
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      ranks.clear();
      for (; next != meetings_.end() && *next >> 32 == e; ++next) {
        ranks.push_back(rank[static_cast<std::uint32_t>(*next)]);
      }
      std::sort(ranks.begin(), ranks.end());
      if (vertices.points[edges_[e].to].y < vertices.points[edges_[e].from].y) turn_equal_x(sorted, ranks);
      double reach = 0;
      Point last = vertices.points[edges_[e].from];
      const auto measure = [&](Point p, double reach_of_p) {
        are_apart &= std::max(std::fabs(p.x - last.x), std::fabs(p.y - last.y)) > std::max(reach, reach_of_p);
        last = p;
        reach = reach_of_p;
      };
      for (const std::int32_t r : ranks) {
        chains.vertices.push_back(vertex_of[r]);
        measure(sorted[r], places_[order[r]].reach);
      }
      if (!ranks.empty()) measure(vertices.points[edges_[e].to], 0);
      chains.offsets.push_back(chains.vertices.size());
    }
    return chains;
  }

 private:
  // So many pairs of edges make a place a hub, if they cross there exactly.
  static constexpr std::uint32_t kPairsOfHub = 64;
  // Edges are cut at hubs, and searched again, if hubs have more pairs than these.
  static constexpr std::size_t kFirstPairs = 10000, kPairsPerPlace = 8;
  static constexpr std::size_t kFirstMerge = 1 << 20;

  struct Place {
    Point at;
    double reach;  // see reach()
    std::uint32_t pairs;
    bool is_hub;
  };

  Line line(std::int32_t e) const {
    return {vertices_.points[edges_[e].from], vertices_.points[edges_[e].to]};
  }

  bool are_exactly_there(const Line& p, const Line& q, Point at) const {
    return predicates_.orient(p.a, p.b, at) == 0 && predicates_.orient(q.a, q.b, at) == 0;
  }

  // If nothing else is so near to a crossing on its edges, then nothing that its edges do not meet is within
  // 2 kHalfSpacing of it: see docs/constrained.md. A line at that distance meets one of the edges within 2
  // sqrt(2) kHalfSpacing / sin(angle / 2).
  static double reach(const Line& p, const Line& q) {
    const double px = p.b.x - p.a.x, py = p.b.y - p.a.y, qx = q.b.x - q.a.x, qy = q.b.y - q.a.y;
    const double left = px * qy, right = py * qx;
    const double cross = std::fabs(left - right) - 0x1p-50 * (std::fabs(left) + std::fabs(right));
    if (cross <= 0) return HUGE_VAL;
    return 32 * kHalfSpacing * ((std::fabs(px) + std::fabs(py)) * ((std::fabs(qx) + std::fabs(qy)) / cross));
  }

  std::int32_t find_or_add(Point place) {
    if (table_.size() < 2 * places_.size() + 2) grow();
    std::size_t slot = hash(place) & (table_.size() - 1);
    for (; table_[slot] >= 0; slot = (slot + 1) & (table_.size() - 1)) {
      if (places_[table_[slot]].at == place) return table_[slot];
    }
    if (places_.size() >= most_) throw_too_many_places(most_);
    table_[slot] = static_cast<std::int32_t>(places_.size());
    places_.push_back({place, 0, 0, false});
    return table_[slot];
  }
  static std::uint64_t hash(Point p) {
    std::uint64_t x, y;
    std::memcpy(&x, &p.x, sizeof x);
    std::memcpy(&y, &p.y, sizeof y);
    // Of large odd numbers; the upper bits of a product depend on all bits.
    const std::uint64_t product = (x ^ (x >> 29)) * 0x9e3779b97f4a7c15 + (y ^ (y >> 31)) * 0xc2b2ae3d27d4eb4f;
    return product ^ product >> 32;
  }
  void grow() {
    table_.assign(std::max<std::size_t>(64, 2 * table_.size()), -1);
    for (std::size_t k = 0; k < places_.size(); ++k) {
      std::size_t slot = hash(places_[k].at) & (table_.size() - 1);
      while (table_[slot] >= 0) slot = (slot + 1) & (table_.size() - 1);
      table_[slot] = static_cast<std::int32_t>(k);
    }
  }

  // An edge meets a place only once, however many it crosses there.
  void merge() {
    std::sort(meetings_.begin(), meetings_.end());
    meetings_.erase(std::unique(meetings_.begin(), meetings_.end()), meetings_.end());
    merge_at_ = std::max(kFirstMerge, 2 * meetings_.size());
  }

  Ids sorted_places() const {
    std::vector<Keyed> order;
    order.reserve(places_.size());
    for (std::size_t k = 0; k < places_.size(); ++k) {
      order.push_back({sort_key(places_[k].at.x), static_cast<std::int32_t>(k)});
    }
    sort_by_key(order);
    for (auto begin = order.begin(), end = begin; begin != order.end(); begin = end) {
      while (end != order.end() && end->key == begin->key) ++end;
      std::sort(begin, end, [this](const Keyed& p, const Keyed& q) {
        return places_[p.index].at.y < places_[q.index].at.y;
      });
    }
    Ids result;
    result.reserve(order.size());
    for (const Keyed& k : order) result.push_back(k.index);
    return result;
  }

  static void turn_equal_x(const std::vector<Point>& sorted, Ids& ranks) {
    for (auto begin = ranks.begin(), end = begin; begin != ranks.end(); begin = end) {
      while (end != ranks.end() && sorted[*end].x == sorted[*begin].x) ++end;
      std::reverse(begin, end);
    }
  }

  const Vertices& vertices_;
  const Predicates& predicates_;
  const std::vector<Piece>& edges_;
  std::size_t most_;
  std::vector<Place> places_;
  Ids table_;                            // places by their hash
  std::vector<std::uint64_t> meetings_;  // edges, and places on them
  std::size_t merge_at_ = kFirstMerge;
  std::size_t pairs_of_hubs_ = 0;
};

// Splits the segments of one set.
class SetSplitter {
 public:
  // segments: their ends as ids of the set, distinct.
  SetSplitter(Vertices& vertices, const std::vector<Piece>& segments) : vertices_(vertices) {
    predicates_.bounds.orient = ORIENT_BOUND;
    pieces_ = segments;
    piece_of_ = remove_equal(pieces_);
  }

  void run(const SplitLimits& limits) {
    while (true) {
      lines_ = cut_at_vertices(predicates_, points(), pieces_, vertices_.sorted);
      Crossings crossings(vertices_, predicates_, lines_.edges, limits.places);
      bool is_complete = true;
      find_crossings(predicates_, points(), lines_.edges,
                     [&](std::int32_t e, std::int32_t f) { return is_complete = crossings.add(e, f); });
      if (is_complete) {
        if (vertices_.points.size() > vertices_.given || !crossings.empty()) lead_through(crossings);
        return;
      }
      vertices_.find_or_add(crossings.hubs());
    }
  }

  bool is_snapped() const { return is_snapped_; }

  // Adds the pieces of a segment, two vertices each. What lies between the edges that others cross is one.
  void list_pieces(std::size_t segment, Ids& ends) const {
    const std::int32_t p = piece_of_[segment];
    std::int32_t from = pieces_[p].from;
    const auto add = [&](std::int32_t to) {
      if (from != to) ends.insert(ends.end(), {from, to});
      from = to;
    };
    for (std::int32_t e = chains_.offsets.empty() ? lines_.ranges[2 * p + 1] : lines_.ranges[2 * p];
         e < lines_.ranges[2 * p + 1]; ++e) {
      const Piece edge = lines_.edges[e];
      const auto begin = chains_.offsets[e], end = chains_.offsets[e + 1];
      if (begin == end && !vertices_.is_added(edge.from) && !vertices_.is_added(edge.to)) continue;
      add(edge.from);
      for (auto k = begin; k < end; ++k) add(chains_.vertices[k]);
      add(edge.to);
    }
    add(pieces_[p].to);
  }

 private:
  const Point* points() const { return vertices_.points.data(); }
  Line line(Piece edge) const { return {points()[edge.from], points()[edge.to]}; }

  // Leaves each piece once, and returns where each one is.
  static Ids remove_equal(std::vector<Piece>& pieces) {
    Ids order(pieces.size()), place(pieces.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::int32_t p, std::int32_t q) {
      return std::tie(pieces[p].from, pieces[p].to) < std::tie(pieces[q].from, pieces[q].to);
    });
    std::vector<Piece> unique;
    for (const std::int32_t p : order) {
      if (unique.empty() || unique.back().from != pieces[p].from || unique.back().to != pieces[p].to) {
        unique.push_back(pieces[p]);
      }
      place[p] = static_cast<std::int32_t>(unique.size()) - 1;
    }
    pieces.swap(unique);
    return place;
  }

  // Leads edges through the places of their crossings; and if parts of them cross then, through all vertices
  // whose cells they meet.
  void lead_through(Crossings& crossings) {
    const std::size_t exact = vertices_.points.size();
    bool are_apart = false;
    chains_ = crossings.chains(vertices_, are_apart);
    if ((are_apart && points_are_apart(exact)) || !parts_cross()) return;
    is_snapped_ = true;
    chains_ = snap(predicates_, vertices_.points, lines_.edges, vertices_.unit);
  }

  // Whether no point is so near to an edge, one of them having moved, that it may be on its other side now.
  // count: so many vertices have their exact places.
  bool points_are_apart(std::size_t count) const {
    constexpr double kLargest = 0x1p250;
    const auto has_moved = [this](std::size_t e) { return chains_.offsets[e] != chains_.offsets[e + 1]; };
    Ids all(count), ends;
    std::iota(all.begin(), all.end(), 0);
    for (std::size_t e = 0; e < lines_.edges.size(); ++e) {
      if (has_moved(e)) ends.insert(ends.end(), {lines_.edges[e].from, lines_.edges[e].to});
    }
    const PointTree all_points(points(), std::move(all), kLargest),
        moved_ends(points(), std::move(ends), kLargest);
    bool are_apart = true;
    for (std::size_t e = 0; e < lines_.edges.size() && are_apart; ++e) {
      const Piece edge = lines_.edges[e];
      (has_moved(e) ? all_points : moved_ends).visit_near(line(edge), 4 * kHalfSpacing, [&](std::int32_t v) {
        are_apart &= v == edge.from || v == edge.to;
      });
    }
    return are_apart;
  }

  // Whether parts of edges between the vertices on them cross.
  bool parts_cross() const {
    std::vector<Piece> parts;
    parts.reserve(lines_.edges.size() + chains_.vertices.size());
    for (std::size_t e = 0; e < lines_.edges.size(); ++e) {
      std::int32_t from = lines_.edges[e].from;
      const auto add = [&](std::int32_t to) {
        if (from != to) {
          const bool backward = kernel::comes_before(points()[to], points()[from]) != 0;
          parts.push_back(backward ? Piece{to, from} : Piece{from, to});
        }
        from = to;
      };
      for (auto k = chains_.offsets[e]; k < chains_.offsets[e + 1]; ++k) add(chains_.vertices[k]);
      add(lines_.edges[e].to);
    }
    remove_equal(parts);
    const LineEdges lines = cut_at_vertices(predicates_, points(), parts, vertices_.sorted);
    bool found = false;
    find_crossings(predicates_, points(), lines.edges, [&found](std::int32_t, std::int32_t) {
      found = true;
      return false;
    });
    return found;
  }

  Vertices& vertices_;
  Predicates predicates_;
  std::vector<Piece> pieces_;
  Ids piece_of_;  // per segment
  LineEdges lines_;
  Chains chains_;  // of edges; none if nothing crosses
  bool is_snapped_ = false;
};

// Segments by their sets; those of length zero are left out.
std::vector<Ids> segments_of_sets(const std::vector<std::size_t>& offsets, const Ids& representatives,
                                  const Ids& segments) {
  std::vector<Ids> by_set(offsets.size() - 1);
  for (std::size_t s = 0; s < segments.size() / 2; ++s) {
    if (representatives[segments[2 * s]] == representatives[segments[2 * s + 1]]) continue;
    const auto end =
        std::upper_bound(offsets.begin(), offsets.end(), static_cast<std::size_t>(segments[2 * s]));
    by_set[static_cast<std::size_t>(end - offsets.begin()) - 1].push_back(static_cast<std::int32_t>(s));
  }
  return by_set;
}

}  // namespace

Split split(const double* coordinates, const std::vector<std::size_t>& offsets, const Ids& segments,
            const SplitLimits& limits) {
  const PointSets sets = ingest(coordinates, offsets);
  check_segments(offsets, segments);
  const std::vector<Ids> by_set = segments_of_sets(offsets, sets.representatives, segments);
  Ids rank(offsets.back());
  for (std::size_t i = 0; i < sets.source.size(); ++i) rank[sets.source[i]] = static_cast<std::int32_t>(i);

  Split result;
  result.added_offsets.assign(1, 0);
  // The pieces of each segment begin here in `ends`, in the order of sets.
  std::vector<std::size_t> place(segments.size() / 2, 0), counts(segments.size() / 2, 0);
  Ids ends;
  for (std::size_t set = 0; set < by_set.size(); ++set) {
    if (!by_set[set].empty()) {
      Vertices vertices(coordinates, sets, set);
      const auto first = sets.set_offsets[set], size = sets.set_offsets[set + 1] - first;
      std::vector<Piece> pieces;
      for (const std::int32_t s : by_set[set]) {
        const auto [from, to] = std::minmax(rank[sets.representatives[segments[2 * s]]],
                                            rank[sets.representatives[segments[2 * s + 1]]]);
        pieces.push_back({from - first, to - first});
      }
      SetSplitter splitter(vertices, pieces);
      splitter.run(limits);
      result.is_snapped |= splitter.is_snapped();

      // The index of each vertex; those of added ones are in lexicographic order.
      std::size_t next = offsets.back() + result.added_points.size() / 2;
      const std::size_t all = next + vertices.points.size() - static_cast<std::size_t>(size);
      if (all > kMostIndices) throw_too_many("points", all, kMostIndices);
      Ids index(vertices.points.size());
      for (const std::int32_t v : vertices.sorted) {
        if (vertices.is_added(v)) {
          const Point point = vertices.unscaled(vertices.points[v]);
          result.added_points.insert(result.added_points.end(), {point.x, point.y});
        }
        index[v] = vertices.is_added(v) ? static_cast<std::int32_t>(next++) : sets.source[first + v];
      }
      for (std::size_t k = 0; k < by_set[set].size(); ++k) {
        const auto s = static_cast<std::size_t>(by_set[set][k]);
        place[s] = ends.size();
        splitter.list_pieces(k, ends);
        if (ends.size() > kMostIndices) throw_too_many("pieces", ends.size() / 2, kMostIndices / 2);
        counts[s] = (ends.size() - place[s]) / 2;
        for (std::size_t e = place[s]; e < ends.size(); ++e) ends[e] = index[ends[e]];
      }
    }
    result.added_offsets.push_back(result.added_points.size() / 2);
  }

  result.pieces.reserve(ends.size());
  result.piece_offsets.assign(1, 0);
  for (std::size_t s = 0; s < counts.size(); ++s) {
    const std::int32_t from = segments[2 * s], to = segments[2 * s + 1];
    const bool backward = rank[sets.representatives[to]] < rank[sets.representatives[from]];
    if (counts[s] == 0) result.pieces.insert(result.pieces.end(), {from, to});
    for (std::size_t e = place[s]; e < place[s] + 2 * counts[s]; e += 2) {
      result.pieces.insert(result.pieces.end(), {ends[backward ? e + 1 : e], ends[backward ? e : e + 1]});
    }
    result.piece_offsets.push_back(static_cast<std::int32_t>(result.pieces.size() / 2));
  }
  return result;
}

AllPoints join_added(const double* coordinates, const std::vector<std::size_t>& offsets, const Split& split) {
  AllPoints all;
  const std::size_t n = offsets.back(), added = split.added_points.size() / 2;
  all.coordinates.reserve(2 * (n + added));
  all.index.reserve(n + added);
  all.place.resize(n + added);
  all.offsets.push_back(0);
  const auto add = [&all](const double* from, std::size_t begin, std::size_t end, std::size_t first_index) {
    all.coordinates.insert(all.coordinates.end(), from + 2 * begin, from + 2 * end);
    for (std::size_t i = begin; i < end; ++i) {
      all.place[first_index + i] = static_cast<std::int32_t>(all.index.size());
      all.index.push_back(static_cast<std::int32_t>(first_index + i));
    }
  };
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    add(coordinates, offsets[s], offsets[s + 1], 0);
    add(split.added_points.data(), split.added_offsets[s], split.added_offsets[s + 1], n);
    all.offsets.push_back(all.index.size());
  }
  return all;
}

}  // namespace flaunay::constrained
