#include "constrained/crossings/split.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "constrained/crossings/crossing_places.hpp"
#include "constrained/crossings/lines.hpp"
#include "constrained/crossings/point_tree.hpp"
#include "constrained/crossings/segment_grid.hpp"
#include "constrained/crossings/segment_set.hpp"
#include "constrained/crossings/snap.hpp"
#include "flaunay/flaunay.hpp"
#include "geometry/arguments.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/point_sets.hpp"
#include "geometry/sort.hpp"

namespace flaunay::constrained {
using namespace geometry;

namespace {

constexpr std::size_t kMostIndices = std::numeric_limits<std::int32_t>::max();

[[noreturn]] void throw_too_many_points(std::size_t count) {
  throw Error(ErrorKind::input,
              fmt::format("splitting segments makes {} points, which are too many for 32-bit indices: at "
                          "most {} are possible",
                          count, kMostIndices));
}

// Splits the segments of one set.
class SetSplitter {
 public:
  // segments: their ends as ids of the set, distinct.
  SetSplitter(Vertices& vertices, const std::vector<Piece>& segments) : vertices_(vertices) {
    predicates_.bounds.orient = ORIENT_BOUND;
    pieces_ = segments;
    piece_of_ = remove_equal(pieces_);
  }

  void run(SplitLimits& limits) {
    for (std::size_t patience = 1;; patience *= 2) {
      cut();
      CrossingPlaces crossings(vertices_, predicates_, edges_.edges, limits, patience);
      bool is_complete = true;
      find_crossings_by_place(predicates_, points(), edges_.edges, [&](std::int32_t e, std::int32_t f) {
        return is_complete = crossings.add(e, f);
      });
      if (is_complete) {
        if (vertices_.points.size() > vertices_.given || !crossings.empty()) lead_through(crossings, limits);
        return;
      }
      vertices_.find_or_add(crossings.hubs());
    }
  }

  bool is_snapped() const { return is_snapped_; }
  // Whether no segment crosses another one or has a vertex inside.
  bool is_as_it_was() const {
    bool is_one_edge = chains_.offsets.empty();
    for (std::size_t r = 0; r < edges_.ranges.size(); r += 2)
      is_one_edge = is_one_edge && edges_.ranges[r + 1] - edges_.ranges[r] == 1;
    return is_one_edge;
  }

  // Adds the pieces of a segment, two vertices each. Consecutive edges that no segment crosses are one piece.
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
    const std::vector<Line> all = lines_of(points(), edges_.edges);
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
    // A long edge meets O(sqrt(n)) boxes. Where boxes do not separate points, searching for crossings takes
    // less time.
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

  // Leads edges through the places of their crossings; and if parts of them cross then, through all vertices
  // whose cells they meet.
  void lead_through(CrossingPlaces& crossings, SplitLimits& limits) {
    bool are_apart = false;
    chains_ = crossings.chains(vertices_, are_apart);
    // Both assume that rounding moves places by at most kHalfSpacing. Subnormal numbers are farther apart.
    const bool is_moved_little = vertices_.unit <= 2 * kHalfSpacing;
    if ((is_moved_little && are_apart && points_are_apart()) || !parts_cross()) return;
    is_snapped_ = true;
    chains_ = snap(predicates_, vertices_.points, edges_.edges, vertices_.unit, limits);
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
    find_crossings_by_place(predicates_, points(), cut_parts.edges, [&found](std::int32_t, std::int32_t) {
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
            SplitLimits limits) {
  check_offsets(offsets);
  check_points(coordinates, offsets.back());
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
      SegmentSet segments_of_set(coordinates, offsets, set, segments, by_set[set]);
      Vertices& vertices = segments_of_set.vertices;
      SetSplitter splitter(vertices, segments_of_set.pieces);
      splitter.run(limits);
      result.is_snapped |= splitter.is_snapped();

      // The index of each vertex; added vertices are numbered in lexicographic order.
      std::size_t next = offsets.back() + result.added_points.size() / 2;
      const std::size_t all = next + vertices.points.size() - vertices.given;
      if (all > kMostIndices) throw_too_many_points(all);
      Ids index(vertices.points.size());
      for (const std::int32_t v : vertices.sorted) {
        if (vertices.is_added(v)) {
          const Point point = vertices.unscaled(vertices.points[v]);
          result.added_points.insert(result.added_points.end(), {point.x, point.y});
        }
        index[v] = vertices.is_added(v) ? static_cast<std::int32_t>(next++) : segments_of_set.index(v);
      }
      for (std::size_t k = 0; k < by_set[set].size(); ++k) {
        const auto s = static_cast<std::size_t>(by_set[set][k]);
        place[s] = ends.size();
        splitter.list_pieces(k, ends);
        check_pieces(ends.size() / 2, limits);
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

std::vector<Point> noded(const std::vector<Point>& path) {
  Ids segments;
  std::vector<double> coordinates;
  for (const Point& p : path) coordinates.insert(coordinates.end(), {p.x, p.y});
  for (std::int32_t i = 1; i < static_cast<std::int32_t>(path.size()); ++i)
    segments.insert(segments.end(), {i - 1, i});
  const Magnitudes magnitudes = inspect(coordinates.data(), 0, path.size());
  if (magnitudes.bad != kernel::NO_BAD) return path;
  if (differ_too_much(magnitudes)) {
    const double unit = std::ldexp(1.0, magnitudes.largest - kernel::MOST_BITS + 1);
    for (double& c : coordinates) {
      if (std::fabs(c) < 0x1p52 * unit) c = std::nearbyint(c / unit) * unit;
    }
  }
  const std::vector<std::size_t> offsets = {0, path.size()};
  const Ids numbers = segments_of_sets(coordinates.data(), offsets, segments)[0];
  SegmentSet set(coordinates.data(), offsets, 0, segments, numbers);
  const std::vector<Piece> given = set.pieces;
  SetSplitter splitter(set.vertices, set.pieces);
  SplitLimits limits;
  splitter.run(limits);
  if (splitter.is_as_it_was()) return path;

  const Point* const points = set.vertices.points.data();
  const auto comes_before = [points](std::int32_t u, std::int32_t v) {
    return kernel::comes_before(points[u], points[v]) != 0;
  };
  // From the smaller end of each segment to the other one.
  Ids ends;
  std::vector<std::size_t> last;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    splitter.list_pieces(k, ends);
    last.push_back(ends.size());
  }
  std::vector<Piece> pieces;
  for (std::size_t e = 0; e < ends.size(); e += 2) {
    const bool is_forward = comes_before(ends[e], ends[e + 1]);
    pieces.push_back({ends[is_forward ? e : e + 1], ends[is_forward ? e + 1 : e]});
  }
  Predicates predicates;
  predicates.bounds.orient = ORIENT_BOUND;
  const auto [edges, ranges] = cut_at_vertices(predicates, points, pieces, set.vertices.sorted);
  Ids all, along;
  std::size_t e = 0;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    along = {given[k].from};
    for (; e < last[k]; e += 2) {
      const std::int32_t first = ranges[e], end = ranges[e + 1];
      const bool is_forward = comes_before(ends[e], ends[e + 1]);
      for (std::int32_t i = first; i < end; ++i)
        along.push_back(is_forward ? edges[i].to : edges[end - 1 - (i - first)].from);
    }
    const double* const from = &coordinates[2 * static_cast<std::size_t>(numbers[k])];
    if (kernel::comes_before({from[2], from[3]}, {from[0], from[1]}))
      std::reverse(along.begin(), along.end());
    all.insert(all.end(), along.begin() + (all.empty() ? 0 : 1), along.end());
  }
  std::vector<Point> result;
  for (const std::int32_t v : all) result.push_back(set.vertices.unscaled(points[v]));
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
