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
#include "constrained/segment_grid.hpp"
#include "constrained/snap.hpp"
#include "flaunay/flaunay.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/point_sets.hpp"
#include "geometry/sort.hpp"

namespace flaunay::constrained {
namespace {

using Ids = std::vector<std::int32_t>;

constexpr std::size_t kMostIndices = std::numeric_limits<std::int32_t>::max();

[[noreturn]] void throw_too_many_points(std::size_t count) {
  throw Error(ErrorKind::input,
              fmt::format("splitting segments makes {} points, which are too many for 32-bit indices: at "
                          "most {} are possible",
                          count, kMostIndices));
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

// Scaled coordinates are below the first of these. The second is half the distance of the largest ones:
// rounding moves no place by more than that, in each coordinate.
constexpr double kLargest = 0x1p250;
constexpr double kHalfSpacing = 0x1p-54 * kLargest;
static_assert(kernel::LARGEST_EXPONENT == 249);

// Crossings of edges, merged where they are rounded to one place.
class Crossings {
 public:
  // patience: hubs may have so many times as many pairs.
  Crossings(const Vertices& vertices, const Predicates& predicates, const std::vector<Piece>& edges,
            std::size_t most, std::size_t patience)
      : vertices_(vertices), predicates_(predicates), edges_(edges), most_(most), patience_(patience) {}

  // Adds two edges that cross. Returns whether to go on: not if many pairs cross at places that are hubs.
  bool add(std::int32_t e, std::int32_t f) {
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

  bool empty() const { return all_.empty(); }

  // Places at which many edges cross exactly, in lexicographic order.
  std::vector<Point> hubs() const {
    std::vector<Point> hubs = hubs_;
    std::sort(hubs.begin(), hubs.end(), [](Point p, Point q) { return kernel::comes_before(p, q) != 0; });
    hubs.erase(std::unique(hubs.begin(), hubs.end(), [](Point p, Point q) { return p == q; }), hubs.end());
    return hubs;
  }

  // Makes vertices of the places. Rounding keeps the order of each coordinate. So along an edge, x does not
  // decrease after rounding, and where it is equal, y is still in its order. are_apart: whether no two
  // vertices that follow each other are so near that something else may be between them.
  Chains chains(Vertices& vertices, bool& are_apart) {
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

 private:
  // So many pairs of edges make a place a hub, if they cross there exactly and come soon after each other.
  static constexpr std::uint32_t kPairsOfHub = 64;
  static constexpr std::size_t kRecent = 256;
  // Edges are cut at hubs, and searched again, if hubs have more pairs than these, edges and places together.
  static constexpr std::size_t kFirstPairs = 10000;
  static constexpr std::size_t kFirstMerge = 1 << 22;

  // Edges that meet a place. The second is -1 if an odd number does.
  struct Crossing {
    Point at;
    double reach;  // see reach()
    std::int32_t e, f;
  };
  struct Recent {
    Point at;
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

  static std::uint64_t hash(Point p) {
    std::uint64_t x, y;
    std::memcpy(&x, &p.x, sizeof x);
    std::memcpy(&y, &p.y, sizeof y);
    // By large odd numbers; the upper bits of a product depend on all bits.
    return (x * 0x9e3779b97f4a7c15 + y * 0xc2b2ae3d27d4eb4f) >> 32;
  }

  // In lexicographic order of places.
  std::vector<Keyed> sorted() const {
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

  // An edge meets a place only once, however many it crosses there.
  void merge() {
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
    if (merged.size() > most_) throw_too_many_pieces(most_);
    all_.swap(merged);
    merge_at_ = std::max(kFirstMerge, 2 * all_.size());
  }

  static void turn_equal_x(const std::vector<Point>& places, Ids::iterator first, Ids::iterator last) {
    for (auto begin = first, end = first; begin != last; begin = end) {
      while (end != last && places[*end].x == places[*begin].x) ++end;
      std::reverse(begin, end);
    }
  }

  const Vertices& vertices_;
  const Predicates& predicates_;
  const std::vector<Piece>& edges_;
  std::size_t most_, patience_;
  std::vector<Crossing> all_;
  std::size_t merge_at_ = kFirstMerge;
  std::size_t places_ = 0;  // as of the last merge
  std::vector<Recent> recent_ = std::vector<Recent>(kRecent);
  std::vector<Point> hubs_;
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
    for (std::size_t patience = 1;; patience *= 2) {
      cut();
      Crossings crossings(vertices_, predicates_, edges_.edges, limits.pieces, patience);
      bool is_complete = true;
      find_all_crossings(edges_.edges,
                         [&](std::int32_t e, std::int32_t f) { return is_complete = crossings.add(e, f); });
      if (is_complete) {
        if (vertices_.points.size() > vertices_.given || !crossings.empty()) lead_through(crossings, limits);
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
    for (std::int32_t e = chains_.offsets.empty() ? edges_.ranges[2 * p + 1] : edges_.ranges[2 * p];
         e < edges_.ranges[2 * p + 1]; ++e) {
      const Piece edge = edges_.edges[e];
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

  std::vector<Line> lines(const std::vector<Piece>& pieces) const {
    std::vector<Line> lines;
    lines.reserve(pieces.size());
    for (const Piece piece : pieces) lines.push_back(line(piece));
    return lines;
  }

  // Makes edges of the pieces, which are cut at the vertices on them.
  void cut() {
    edges_.edges = pieces_;
    edges_.ranges.clear();
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(pieces_.size()); ++p) {
      edges_.ranges.insert(edges_.ranges.end(), {p, p + 1});
    }
    // Pieces that overlap have an end of one inside of the other.
    if (find_near()) return;
    edges_ = cut_at_vertices(predicates_, points(), pieces_, vertices_.sorted);
    find_near();
  }

  // Finds the vertices near edges, unless one is on an edge. Returns whether it is certain that none is.
  bool find_near() {
    constexpr std::size_t kMostNear = 4;
    const std::size_t most = kMostNear * (edges_.edges.size() + vertices_.points.size());
    const std::vector<Line> all = lines(edges_.edges);
    double largest = 0;
    for (const auto& [a, b] : all) {
      largest = std::max({largest, std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
    }
    // Crossings move by at most a quarter of this.
    const double distance = 0x1p-51 * largest;
    near_.clear();
    bool is_over = false;
    const FoundPair add = [&](std::int32_t e, std::int32_t v) {
      const Piece edge = edges_.edges[e];
      if (v == edge.from || v == edge.to) return true;
      near_.emplace_back(e, v);
      is_over = near_.size() > most || is_inside(edge, v);
      return !is_over;
    };
    near_is_complete_ = SegmentGrid(all).find_near(vertices_.points, distance, add);
    if (!near_is_complete_ && !is_over) {
      near_.clear();
      near_is_complete_ = find_near_by_tree(all, distance, add);
    }
    return near_is_complete_;
  }

  // Whether a vertex is on an edge; not at its ends.
  bool is_inside(Piece edge, std::int32_t v) const {
    const auto [a, b] = line(edge);
    const Point p = points()[v];
    return kernel::comes_before(a, p) && kernel::comes_before(p, b) && predicates_.orient(a, b, p) == 0;
  }

  bool find_near_by_tree(const std::vector<Line>& all, double distance, const FoundPair& found) const {
    // A long edge meets O(sqrt(n)) boxes. Where boxes do not tell points apart, it takes less to look for
    // what crosses.
    const double most = 64.0 * (edges_.edges.size() + vertices_.points.size()) +
                        16.0 * edges_.edges.size() * std::sqrt(vertices_.points.size());
    Ids ids(vertices_.points.size());
    std::iota(ids.begin(), ids.end(), 0);
    const PointTree tree(points(), std::move(ids), kLargest);
    std::size_t boxes = 0;
    bool is_complete = true;
    for (std::size_t e = 0; e < all.size() && is_complete; ++e) {
      boxes += tree.visit_near(all[e], distance, [&](std::int32_t v) {
        is_complete = is_complete && found(static_cast<std::int32_t>(e), v);
      });
      is_complete &= static_cast<double>(boxes) <= most;
    }
    return is_complete;
  }

  void find_all_crossings(const std::vector<Piece>& edges, const FoundPair& found) const {
    const std::vector<Line> all = lines(edges);
    if (!SegmentGrid(all).find_crossings(predicates_, found))
      find_crossings(predicates_, points(), edges, found);
  }

  // Leads edges through the places of their crossings; and if parts of them cross then, through all vertices
  // whose cells they meet.
  void lead_through(Crossings& crossings, const SplitLimits& limits) {
    bool are_apart = false;
    chains_ = crossings.chains(vertices_, are_apart);
    if ((are_apart && points_are_apart()) || !parts_cross()) return;
    is_snapped_ = true;
    chains_ = snap(predicates_, vertices_.points, edges_.edges, vertices_.unit, limits.pieces);
  }

  // Whether no point is so near to an edge, one of them having moved, that it may be on its other side now.
  bool points_are_apart() const {
    if (!near_is_complete_) return false;
    std::vector<bool> is_end_of_moved(vertices_.points.size(), false);
    const auto has_moved = [this](std::size_t e) { return chains_.offsets[e] != chains_.offsets[e + 1]; };
    for (std::size_t e = 0; e < edges_.edges.size(); ++e) {
      if (has_moved(e)) is_end_of_moved[edges_.edges[e].from] = is_end_of_moved[edges_.edges[e].to] = true;
    }
    return std::none_of(near_.begin(), near_.end(), [&](const auto& pair) {
      return has_moved(static_cast<std::size_t>(pair.first)) || is_end_of_moved[pair.second];
    });
  }

  // Whether parts of edges between the vertices on them cross.
  bool parts_cross() const {
    std::vector<Piece> parts;
    parts.reserve(edges_.edges.size() + chains_.vertices.size());
    for (std::size_t e = 0; e < edges_.edges.size(); ++e) {
      std::int32_t from = edges_.edges[e].from;
      const auto add = [&](std::int32_t to) {
        if (from != to) {
          const bool backward = kernel::comes_before(points()[to], points()[from]) != 0;
          parts.push_back(backward ? Piece{to, from} : Piece{from, to});
        }
        from = to;
      };
      for (auto k = chains_.offsets[e]; k < chains_.offsets[e + 1]; ++k) add(chains_.vertices[k]);
      add(edges_.edges[e].to);
    }
    remove_equal(parts);
    const LineEdges cut_parts = cut_at_vertices(predicates_, points(), parts, vertices_.sorted);
    bool found = false;
    find_all_crossings(cut_parts.edges, [&found](std::int32_t, std::int32_t) {
      found = true;
      return false;
    });
    return found;
  }

  Vertices& vertices_;
  Predicates predicates_;
  std::vector<Piece> pieces_;
  Ids piece_of_;  // per segment
  LineEdges edges_;
  // Vertices near edges, but not on them: an edge and a vertex each.
  Pairs near_;
  bool near_is_complete_ = false;
  Chains chains_;  // of edges; none if nothing crosses
  bool is_snapped_ = false;
};

// Segments by their sets; those of length zero are left out.
std::vector<Ids> segments_of_sets(const double* coordinates, const std::vector<std::size_t>& offsets,
                                  const Ids& segments) {
  std::vector<Ids> by_set(offsets.size() - 1);
  std::size_t set = 0;
  for (std::size_t s = 0; s < segments.size() / 2; ++s) {
    const auto from = static_cast<std::size_t>(segments[2 * s]),
               to = static_cast<std::size_t>(segments[2 * s + 1]);
    if (coordinates[2 * from] == coordinates[2 * to] && coordinates[2 * from + 1] == coordinates[2 * to + 1])
      continue;
    if (from < offsets[set] || from >= offsets[set + 1]) {
      set =
          static_cast<std::size_t>(std::upper_bound(offsets.begin(), offsets.end(), from) - offsets.begin()) -
          1;
    }
    by_set[set].push_back(static_cast<std::int32_t>(s));
  }
  return by_set;
}

// Whether some of the segments may cross.
bool may_cross(const double* coordinates, const Ids& segments, const Ids& of_set, int shift) {
  std::vector<Line> lines;
  lines.reserve(of_set.size());
  const auto point = [coordinates, shift](std::int32_t i) -> Point {
    const double* p = coordinates + 2 * static_cast<std::size_t>(i);
    return shift == 0 ? Point{p[0], p[1]} : Point{std::ldexp(p[0], shift), std::ldexp(p[1], shift)};
  };
  for (const std::int32_t s : of_set) {
    const Point a = point(segments[2 * static_cast<std::size_t>(s)]),
                b = point(segments[2 * static_cast<std::size_t>(s) + 1]);
    const bool is_forward = kernel::comes_before(a, b) != 0;
    lines.push_back({is_forward ? a : b, is_forward ? b : a});
  }
  Predicates predicates;
  predicates.bounds.orient = ORIENT_BOUND;
  bool found = false;
  const bool is_complete =
      SegmentGrid(lines).find_crossings(predicates, [&found](std::int32_t, std::int32_t) {
        found = true;
        return false;
      });
  return found || !is_complete;
}

}  // namespace

Split split(const double* coordinates, const std::vector<std::size_t>& offsets, const Ids& segments,
            const SplitLimits& limits) {
  check_offsets(offsets);
  check_coordinates(coordinates, offsets.back());
  const SetScalings scalings = set_scalings(
      coordinates, offsets,
      [coordinates](std::size_t first, std::size_t last) { return inspect(coordinates, first, last); });
  check_segments(offsets, segments);
  const std::vector<Ids> by_set = segments_of_sets(coordinates, offsets, segments);

  Split result;
  result.added_offsets.assign(1, 0);
  // The pieces of each segment that is in a set with crossings begin here in `ends`, in the order of sets.
  std::vector<std::size_t> place(segments.size() / 2, 0), counts(segments.size() / 2, 0);
  Ids ends;
  for (std::size_t set = 0; set < by_set.size(); ++set) {
    if (may_cross(coordinates, segments, by_set[set], scalings.shift(set))) {
      const std::size_t first = offsets[set];
      const PointSets points = ingest(coordinates + 2 * first, {0, offsets[set + 1] - first});
      Vertices vertices(coordinates + 2 * first, points, 0);
      Ids rank(offsets[set + 1] - first);
      for (std::size_t i = 0; i < points.source.size(); ++i)
        rank[points.source[i]] = static_cast<std::int32_t>(i);
      const auto id = [&](std::int32_t i) {
        return rank[points.representatives[static_cast<std::size_t>(i) - first]];
      };
      std::vector<Piece> pieces;
      for (const std::int32_t s : by_set[set]) {
        const std::int32_t from = id(segments[2 * s]), to = id(segments[2 * s + 1]);
        pieces.push_back({std::min(from, to), std::max(from, to)});
      }
      SetSplitter splitter(vertices, pieces);
      splitter.run(limits);
      result.is_snapped |= splitter.is_snapped();

      // The index of each vertex; those of added ones are in lexicographic order.
      std::size_t next = offsets.back() + result.added_points.size() / 2;
      const std::size_t all = next + vertices.points.size() - vertices.given;
      if (all > kMostIndices) throw_too_many_points(all);
      Ids index(vertices.points.size());
      for (const std::int32_t v : vertices.sorted) {
        if (vertices.is_added(v)) {
          const Point point = vertices.unscaled(vertices.points[v]);
          result.added_points.insert(result.added_points.end(), {point.x, point.y});
        }
        index[v] = vertices.is_added(v) ? static_cast<std::int32_t>(next++)
                                        : static_cast<std::int32_t>(first) + points.source[v];
      }
      for (std::size_t k = 0; k < by_set[set].size(); ++k) {
        const auto s = static_cast<std::size_t>(by_set[set][k]);
        place[s] = ends.size();
        splitter.list_pieces(k, ends);
        if (ends.size() / 2 > limits.pieces) throw_too_many_pieces(limits.pieces);
        counts[s] = (ends.size() - place[s]) / 2;
        for (std::size_t e = place[s]; e < ends.size(); ++e) ends[e] = index[ends[e]];
      }
    }
    result.added_offsets.push_back(result.added_points.size() / 2);
  }

  const auto comes_first = [coordinates](std::int32_t u, std::int32_t v) {
    const double *p = coordinates + 2 * static_cast<std::size_t>(u),
                 *q = coordinates + 2 * static_cast<std::size_t>(v);
    return p[0] != q[0] ? p[0] < q[0] : p[1] < q[1];
  };
  result.pieces.reserve(ends.size());
  result.piece_offsets.assign(1, 0);
  for (std::size_t s = 0; s < counts.size(); ++s) {
    const std::int32_t from = segments[2 * s], to = segments[2 * s + 1];
    const bool backward = comes_first(to, from);
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
