#include "constrained/split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "constrained/constrained.hpp"
#include "constrained/crossing.hpp"
#include "constrained/lines.hpp"
#include "flaunay/flaunay.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/point_sets.hpp"

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

// A piece in one of its directions, as one number.
std::int32_t directed(std::int32_t piece, bool backward) { return 2 * piece + (backward ? 1 : 0); }

// What the pieces before a round become in it: piece p becomes children [offsets[p], offsets[p + 1]), which
// are pieces of the next round in their directions along p.
struct Round {
  Ids offsets, children;
};

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
    sorted.resize(points.size());
    std::iota(sorted.begin(), sorted.end(), 0);
  }

  Point unscaled(Point p) const { return {std::ldexp(p.x, -shift), std::ldexp(p.y, -shift)}; }

  // Returns the vertices at these places, which are added where there are none. New ones are numbered in
  // lexicographic order.
  Ids find_or_add(const std::vector<Point>& places) {
    Ids order(places.size()), result(places.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&places](std::int32_t p, std::int32_t q) {
      return kernel::comes_before(places[p], places[q]) != 0;
    });
    const std::size_t before = points.size();
    auto next = sorted.begin();
    for (const std::int32_t p : order) {
      while (next != sorted.end() && kernel::comes_before(points[*next], places[p])) ++next;
      if (next != sorted.end() && points[*next] == places[p]) {
        result[p] = *next;
        continue;
      }
      if (points.size() == before || !(points.back() == places[p])) points.push_back(places[p]);
      result[p] = static_cast<std::int32_t>(points.size()) - 1;
    }
    sorted.resize(points.size());
    std::iota(sorted.begin() + static_cast<std::ptrdiff_t>(before), sorted.end(),
              static_cast<std::int32_t>(before));
    std::inplace_merge(
        sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(before), sorted.end(),
        [this](std::int32_t u, std::int32_t v) { return kernel::comes_before(points[u], points[v]) != 0; });
    return result;
  }

  std::vector<Point> points;
  Ids sorted;  // all, in lexicographic order
  int shift = 0;
  double unit = 0;
};

// Vertices per edge, along it.
struct Crossings {
  Ids edges;    // those that are crossed, ascending
  Ids offsets;  // of the crossed ones
  Ids vertices;
};

// Splits the segments of one set.
class SetSplitter {
 public:
  // segments: their ends as ids of the set, distinct. names: per segment its index, for messages.
  SetSplitter(Vertices& vertices, const std::vector<Piece>& segments, const Ids& names)
      : vertices_(vertices) {
    predicates_.bounds.orient = ORIENT_BOUND;
    pieces_ = segments;
    owners_ = names;
    piece_of_ = remove_equal(pieces_, owners_);
  }

  void run(const SplitLimits& limits, const Ids& segments) {
    while (true) {
      const LineEdges lines = cut_at_vertices(predicates_, points(), pieces_, vertices_.sorted);
      const Pairs pairs = crossing_pairs(predicates_, points(), lines.edges, limits.crossings);
      if (pairs.empty()) return;
      if (rounds() >= limits.rounds) throw_still_crossing(lines, pairs, segments);
      split(lines, crossings(lines.edges, pairs));
    }
  }

  int rounds() const { return static_cast<int>(rounds_.size()); }

  // How many pieces each of the segments has.
  std::vector<std::size_t> count_pieces() const {
    std::vector<std::size_t> counts(pieces_.size(), 1);
    for (auto round = rounds_.rbegin(); round != rounds_.rend(); ++round) {
      std::vector<std::size_t> before(round->offsets.size() - 1, 0);
      for (std::size_t p = 0; p < before.size(); ++p) {
        for (std::int32_t k = round->offsets[p]; k < round->offsets[p + 1]; ++k) {
          before[p] += counts[round->children[k] / 2];
        }
      }
      counts.swap(before);
    }
    std::vector<std::size_t> of_segments;
    for (const std::int32_t p : piece_of_) of_segments.push_back(counts[p]);
    return of_segments;
  }

  // Adds the pieces of a segment, two vertices each.
  void list_pieces(std::size_t segment, Ids& ends) const {
    list(0, directed(piece_of_[segment], false), ends);
  }

 private:
  const Point* points() const { return vertices_.points.data(); }
  Line line(Piece edge) const { return {points()[edge.from], points()[edge.to]}; }

  // Leaves each piece once, with the smallest of its owners, and returns where each one is.
  static Ids remove_equal(std::vector<Piece>& pieces, Ids& owners) {
    Ids order(pieces.size()), place(pieces.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::int32_t p, std::int32_t q) {
      return std::tie(pieces[p].from, pieces[p].to, owners[p]) <
             std::tie(pieces[q].from, pieces[q].to, owners[q]);
    });
    std::vector<Piece> unique;
    Ids unique_owners;
    for (const std::int32_t p : order) {
      if (unique.empty() || unique.back().from != pieces[p].from || unique.back().to != pieces[p].to) {
        unique.push_back(pieces[p]);
        unique_owners.push_back(owners[p]);
      }
      place[p] = static_cast<std::int32_t>(unique.size()) - 1;
    }
    pieces.swap(unique);
    owners.swap(unique_owners);
    return place;
  }

  // Rounding keeps the order of each coordinate. So along an edge, x does not decrease after rounding, and
  // where it is equal, y is still in its order.
  Crossings crossings(const std::vector<Piece>& edges, const Pairs& pairs) {
    std::vector<Point> places;
    places.reserve(pairs.size());
    for (const auto& [e, f] : pairs) {
      places.push_back(round_crossing(line(edges[e]), line(edges[f]), vertices_.unit));
    }
    const Ids vertex_of = vertices_.find_or_add(places);

    std::vector<std::pair<std::int32_t, std::int32_t>> on_edges;
    on_edges.reserve(2 * pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      on_edges.emplace_back(pairs[k].first, vertex_of[k]);
      on_edges.emplace_back(pairs[k].second, vertex_of[k]);
    }
    std::sort(on_edges.begin(), on_edges.end(), [&](const auto& a, const auto& b) {
      if (a.first != b.first) return a.first < b.first;
      const Point p = points()[a.second], q = points()[b.second];
      if (p.x != q.x) return p.x < q.x;
      return points()[edges[a.first].from].y <= points()[edges[a.first].to].y ? p.y < q.y : p.y > q.y;
    });
    on_edges.erase(std::unique(on_edges.begin(), on_edges.end()), on_edges.end());
    Crossings result;
    for (const auto& [edge, vertex] : on_edges) {
      if (result.edges.empty() || result.edges.back() != edge) {
        result.edges.push_back(edge);
        result.offsets.push_back(static_cast<std::int32_t>(result.vertices.size()));
      }
      result.vertices.push_back(vertex);
    }
    result.offsets.push_back(static_cast<std::int32_t>(result.vertices.size()));
    return result;
  }

  // Splits edges at their crossings. What lies between crossed edges of a piece remains one.
  void split(const LineEdges& lines, const Crossings& crossings) {
    Round round;
    std::vector<Piece> children;
    Ids owners;
    const auto add = [&](std::int32_t from, std::int32_t to, std::int32_t owner) {
      if (from == to) return;
      const bool backward = kernel::comes_before(points()[to], points()[from]) != 0;
      if (backward) std::swap(from, to);
      round.children.push_back(backward);
      children.push_back({from, to});
      owners.push_back(owner);
      if (children.size() > kMostIndices / 2) throw_too_many("pieces", children.size(), kMostIndices / 2);
    };
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      round.offsets.push_back(static_cast<std::int32_t>(round.children.size()));
      const std::int32_t end = lines.ranges[2 * p + 1];
      auto crossed = std::lower_bound(crossings.edges.begin(), crossings.edges.end(), lines.ranges[2 * p]);
      std::int32_t from = pieces_[p].from;
      for (; crossed != crossings.edges.end() && *crossed < end; ++crossed) {
        const Piece edge = lines.edges[*crossed];
        add(from, edge.from, owners_[p]);
        from = edge.from;
        const auto k = crossed - crossings.edges.begin();
        for (std::int32_t c = crossings.offsets[k]; c < crossings.offsets[k + 1]; ++c) {
          add(from, crossings.vertices[c], owners_[p]);
          from = crossings.vertices[c];
        }
        add(from, edge.to, owners_[p]);
        from = edge.to;
      }
      add(from, pieces_[p].to, owners_[p]);
    }
    round.offsets.push_back(static_cast<std::int32_t>(round.children.size()));
    pieces_.swap(children);
    owners_.swap(owners);
    const Ids place = remove_equal(pieces_, owners_);
    for (std::size_t k = 0; k < place.size(); ++k)
      round.children[k] = directed(place[k], round.children[k] != 0);
    rounds_.push_back(std::move(round));
  }

  void list(std::size_t round, std::int32_t piece, Ids& ends) const {
    const std::int32_t p = piece / 2;
    const bool backward = piece % 2 != 0;
    if (round == rounds_.size()) {
      const Piece last = pieces_[p];
      ends.insert(ends.end(), {backward ? last.to : last.from, backward ? last.from : last.to});
      return;
    }
    const std::int32_t begin = rounds_[round].offsets[p], end = rounds_[round].offsets[p + 1];
    for (std::int32_t k = begin; k < end; ++k) {
      const std::int32_t child = rounds_[round].children[backward ? begin + end - 1 - k : k];
      list(round + 1, child ^ (backward ? 1 : 0), ends);
    }
  }

  // Names the segments that Crossings::error would name of the pieces.
  [[noreturn]] void throw_still_crossing(const LineEdges& lines, const Pairs& pairs,
                                         const Ids& segments) const {
    Ids owner(lines.edges.size(), std::numeric_limits<std::int32_t>::max());
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      for (std::int32_t e = lines.ranges[2 * p]; e < lines.ranges[2 * p + 1]; ++e) {
        owner[e] = std::min(owner[e], owners_[p]);
      }
    }
    std::tuple<std::int32_t, std::int32_t, std::size_t> first{std::numeric_limits<std::int32_t>::max(), 0, 0};
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto [smaller, larger] = std::minmax(owner[pairs[k].first], owner[pairs[k].second]);
      first = std::min(first, {larger, smaller, k});
    }
    const auto [b, a, k] = first;
    const Piece first_edge = lines.edges[pairs[k].first], second_edge = lines.edges[pairs[k].second];
    const Point place = round_crossing(line(first_edge), line(second_edge), vertices_.unit);
    const Point near = vertices_.unscaled(place);
    throw Error(
        ErrorKind::input,
        fmt::format("segments {} (points {} and {}) and {} (points {} and {}) still cross after {} rounds of "
                    "splitting, near ({:.17g}, {:.17g})",
                    a, segments[2 * a], segments[2 * a + 1], b, segments[2 * b], segments[2 * b + 1],
                    rounds(), near.x, near.y));
  }

  Vertices& vertices_;
  Predicates predicates_;
  std::vector<Piece> pieces_;  // of the next round
  Ids owners_;                 // the smallest segment of each
  Ids piece_of_;               // per segment, in the first round
  std::vector<Round> rounds_;
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
      SetSplitter splitter(vertices, pieces, by_set[set]);
      splitter.run(limits, segments);
      result.rounds = std::max(result.rounds, splitter.rounds());

      const std::size_t added = result.added_points.size() / 2;
      for (auto v = static_cast<std::size_t>(size); v < vertices.points.size(); ++v) {
        const Point point = vertices.unscaled(vertices.points[v]);
        result.added_points.insert(result.added_points.end(), {point.x, point.y});
      }
      const std::size_t all = offsets.back() + result.added_points.size() / 2;
      if (all > kMostIndices) throw_too_many("points", all, kMostIndices);
      const std::vector<std::size_t> pieces_of = splitter.count_pieces();
      const std::size_t total = std::accumulate(pieces_of.begin(), pieces_of.end(), ends.size() / 2);
      if (total > kMostIndices / 2) throw_too_many("pieces", total, kMostIndices / 2);
      for (std::size_t k = 0; k < by_set[set].size(); ++k) {
        const auto s = static_cast<std::size_t>(by_set[set][k]);
        place[s] = ends.size();
        splitter.list_pieces(k, ends);
        counts[s] = (ends.size() - place[s]) / 2;
        for (std::size_t e = place[s]; e < ends.size(); ++e) {
          ends[e] = ends[e] < size ? sets.source[first + ends[e]]
                                   : static_cast<std::int32_t>(offsets.back() + added) + (ends[e] - size);
        }
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
