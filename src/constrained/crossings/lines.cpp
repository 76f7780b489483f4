#include "constrained/crossings/lines.hpp"

#include <algorithm>
#include <numeric>

#include "geometry/sort.hpp"

namespace flaunay::constrained {
using namespace geometry;

namespace {

// 1 if q's direction is counter-clockwise of p's, -1 if it is clockwise, 0 if they are parallel. The
// directions of pieces lie in a half-plane.
int compare_slopes(const Point* points, Piece p, Piece q) {
  return kernel::cross_sign(points[p.from], points[p.to], points[q.from], points[q.to]);
}

// At most this many doubles, with a margin, lie between the rounded slopes of parallel pieces.
constexpr std::uint64_t kSlopeErrors = 16;

// Overlapping pieces form one line. Sorted by slope, across and along lines, the pieces of a line are
// consecutive.
class LineFinder {
 public:
  LineFinder(const Predicates& predicates, const Point* points, const std::vector<Piece>& pieces)
      : predicates_(predicates), points_(points), pieces_(pieces) {}

  // line_of: per piece. Pieces whose rounded slopes are apart need no exact comparison.
  std::vector<Piece> find(std::vector<std::int32_t>& line_of) const {
    std::vector<Keyed> order;
    order.reserve(pieces_.size());
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      order.push_back({sort_key(slope(pieces_[p])), static_cast<std::int32_t>(p)});
    }
    sort_by_key(order);
    std::vector<Piece> lines;
    line_of.resize(pieces_.size());
    for (auto begin = order.begin(), end = begin; begin != order.end(); begin = end) {
      for (++end; end != order.end() && end->key - (end - 1)->key <= kSlopeErrors; ++end) {
      }
      if (end - begin > 1) {
        std::sort(begin, end, [this](const Keyed& p, const Keyed& q) {
          const int side = compare_lines(pieces_[p.index], pieces_[q.index]);
          return side != 0 ? side > 0 : comes_before(pieces_[p.index].from, pieces_[q.index].from);
        });
      }
      for (auto p = begin; p != end; ++p) {
        const Piece piece = pieces_[p->index];
        if (p == begin || !comes_before(piece.from, lines.back().to) ||
            compare_lines(lines.back(), piece) != 0) {
          lines.push_back(piece);
        } else if (comes_before(lines.back().to, piece.to)) {
          lines.back().to = piece.to;
        }
        line_of[p->index] = static_cast<std::int32_t>(lines.size()) - 1;
      }
    }
    return lines;
  }

 private:
  bool comes_before(std::int32_t u, std::int32_t v) const {
    return kernel::comes_before(points_[u], points_[v]) != 0;
  }
  // Wrong by the rounding of two differences and a quotient: less than 4 units in the last place.
  double slope(Piece p) const {
    const Point a = points_[p.from], b = points_[p.to];
    return a.x == b.x ? HUGE_VAL : (b.y - a.y) / (b.x - a.x) + 0.0;
  }
  // 0 on one line.
  int compare_lines(Piece p, Piece q) const {
    const int slope = compare_slopes(points_, p, q);
    return slope != 0 ? slope : predicates_.orient(points_[p.from], points_[p.to], points_[q.from]);
  }

  Predicates predicates_;
  const Point* points_;
  const std::vector<Piece>& pieces_;
};

}  // namespace

std::vector<Piece> join_pieces(const Predicates& predicates, const Point* points,
                               const std::vector<Piece>& pieces, std::vector<std::int32_t>& line_of) {
  return LineFinder(predicates, points, pieces).find(line_of);
}

LineEdges cut_at_vertices(const Predicates& predicates, const Point* points, const std::vector<Piece>& pieces,
                          const std::vector<std::int32_t>& vertices) {
  std::vector<std::int32_t> line_of;
  const std::vector<Piece> lines = join_pieces(predicates, points, pieces, line_of);
  const Pairs inner = inner_vertices(predicates, points, lines, vertices);
  LineEdges result;
  result.edges.reserve(lines.size() + inner.size());
  std::vector<std::int32_t> first_edge(lines.size() + 1);
  auto next = inner.begin();
  for (std::size_t l = 0; l < lines.size(); ++l) {
    first_edge[l] = static_cast<std::int32_t>(result.edges.size());
    std::int32_t from = lines[l].from;
    for (; next != inner.end() && next->first == static_cast<std::int32_t>(l); ++next) {
      result.edges.push_back({from, next->second});
      from = next->second;
    }
    result.edges.push_back({from, lines[l].to});
  }
  first_edge[lines.size()] = static_cast<std::int32_t>(result.edges.size());

  result.ranges.reserve(2 * pieces.size());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const auto begin = result.edges.begin() + first_edge[line_of[p]];
    const auto end = result.edges.begin() + first_edge[line_of[p] + 1];
    // The edge that begins at a vertex, or the end.
    const auto edge_from = [&](std::int32_t vertex) {
      const auto edge = std::partition_point(begin, end, [points, vertex](Piece e) {
        return kernel::comes_before(points[e.from], points[vertex]) != 0;
      });
      return static_cast<std::int32_t>(edge - result.edges.begin());
    };
    result.ranges.insert(result.ranges.end(), {edge_from(pieces[p].from), edge_from(pieces[p].to)});
  }
  return result;
}

// Pieces skip the edges that earlier ones have, by shortcuts to the next edge without a piece.
std::vector<std::int32_t> first_pieces(std::size_t edges, const std::vector<std::int32_t>& ranges) {
  std::vector<std::int32_t> first(edges, -1), next(edges + 1);
  std::iota(next.begin(), next.end(), 0);
  const auto next_free = [&next](std::int32_t e) {
    while (next[e] != e) e = next[e] = next[next[e]];
    return e;
  };
  for (std::size_t p = 0; p < ranges.size() / 2; ++p) {
    const std::int32_t end = ranges[2 * p + 1];
    for (std::int32_t e = next_free(ranges[2 * p]); e < end; e = next_free(e)) {
      first[e] = static_cast<std::int32_t>(p);
      next[e] = e + 1;
    }
  }
  return first;
}

}  // namespace flaunay::constrained
