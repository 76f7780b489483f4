// Divides the plane into vertical slabs between coordinates of ends, as Balaban does (1995).
//
// The pieces that span a slab include a chain of pieces that do not cross in it, and so have one order from
// its left to its right. All other pieces find the pieces of the chain that they cross by binary search, at
// both of their ends or where they leave the slab, and then go on to the two halves of the slab. A piece that
// spans the slab, but is not in the chain, crosses a piece of the chain, and that pair pays for its way down.
// All other pieces end inside of the slab; so a piece is on O(log n) levels of slabs, at most twice on each.
//
// Before that, wherever a horizontal or vertical line separates pieces but for a few, the two sides are
// searched separately: then short pieces do not meet the chains of pieces far above and below. A crossing is
// on one of the sides, with both of its pieces.
#include "constrained/crossings/pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constrained/crossings/crossing.hpp"
#include "geometry/sort.hpp"

namespace flaunay::constrained {
using namespace geometry;

namespace {

using Ids = std::vector<std::int32_t>;

// Up to this many pieces are all compared with each other.
constexpr std::size_t kFew = 32;
// A line separates pieces if it crosses at most one in this many.
constexpr std::size_t kSeparated = 16;
// If it crosses at most one in this many, no better line is searched.
constexpr std::size_t kWellSeparated = 64;
// The middle of pieces is the median of this many samples.
constexpr std::size_t kSamples = 7;

// Where a piece is at some x: between two numbers; exactly there if they are equal.
struct Height {
  double low, high;
  bool known() const { return low == high; }
};

// Numbers of a chain's pieces: those below a place, and those that are below it or at it.
struct Rank {
  std::size_t below, not_above;
};

class Search {
 public:
  Search(const Predicates& predicates, const Point* points, const std::vector<Piece>& pieces,
         const FoundPair& found)
      : predicates_(predicates), points_(points), pieces_(pieces), found_(found) {}

  void find_crossings() {
    Ids pieces(pieces_.size());
    std::iota(pieces.begin(), pieces.end(), 0);
    run(std::move(pieces), {});
  }
  // Finds the vertices inside of pieces that are not vertical.
  void find_vertices(const Ids& vertices) {
    Ids pieces;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      if (points_[pieces_[k].from].x != points_[pieces_[k].to].x)
        pieces.push_back(static_cast<std::int32_t>(k));
    }
    of_vertices_ = true;
    run(std::move(pieces), vertices);
  }

 private:
  struct Slab {
    double begin, end;
  };
  // The pieces and vertices from these places of the stacks on.
  struct Items {
    std::size_t pieces, vertices;
  };
  struct Spanning {
    std::int32_t piece;
    Height begin, end;
  };
  enum class Axis { x, y };

  Point from(std::int32_t piece) const { return lines_[piece].a; }
  Point to(std::int32_t piece) const { return lines_[piece].b; }
  bool spans(std::int32_t piece, Slab slab) const {
    return from(piece).x <= slab.begin && slab.end <= to(piece).x;
  }

  // Numbers pieces and vertices by place, so that neighbours in the plane are close in memory.
  void run(Ids pieces, const Ids& unsorted_vertices) {
    if (pieces.empty()) return;
    Ids vertices = unsorted_vertices;
    geometry::sort_by_place(pieces, [this](std::int32_t p) { return centre(points_, pieces_[p]); });
    geometry::sort_by_place(vertices, [this](std::int32_t v) { return points_[v]; });
    Slab slab{HUGE_VAL, -HUGE_VAL};
    for (const std::int32_t p : pieces) {
      lines_.push_back({points_[pieces_[p].from], points_[pieces_[p].to]});
      slab.begin = std::min(slab.begin, lines_.back().a.x);
      slab.end = std::max(slab.end, lines_.back().b.x);
    }
    for (const std::int32_t v : vertices) places_.push_back(points_[v]);
    piece_stack_.resize(pieces.size());
    std::iota(piece_stack_.begin(), piece_stack_.end(), 0);
    vertex_stack_.resize(vertices.size());
    std::iota(vertex_stack_.begin(), vertex_stack_.end(), 0);
    pieces_by_place_ = std::move(pieces);
    vertices_by_place_ = std::move(vertices);
    divide(slab, {0, 0});
  }

  // Finds all pairs of items at the top of the stacks that meet in a slab, and removes them.
  void divide(Slab slab, Items items) {
    if (!stopped_ && !compare_few(items)) {
      Axis axis = Axis::x;
      double middle = 0;
      if (find_separation(slab, items, axis, middle)) {
        halve(slab, items, axis, middle);
      } else if (find_middle(slab, items, middle)) {
        take_chain(slab, items);
        halve(slab, items, Axis::x, middle);
      } else {
        finish_slab(slab, items);
      }
    }
    piece_stack_.resize(items.pieces);
    vertex_stack_.resize(items.vertices);
  }

  // Returns whether that suffices.
  bool compare_few(Items items) {
    const std::size_t count = piece_stack_.size() - items.pieces;
    if (of_vertices_ && vertex_stack_.size() == items.vertices) return true;
    if (count > kFew) return false;
    for (std::size_t k = items.pieces; k < piece_stack_.size(); ++k) {
      const std::int32_t p = piece_stack_[k];
      if (of_vertices_) {
        for (std::size_t v = items.vertices; v < vertex_stack_.size(); ++v)
          add_if_inside(p, vertex_stack_[v]);
      } else {
        for (std::size_t j = items.pieces; j < k; ++j) add_if_crossing(p, piece_stack_[j]);
      }
    }
    return true;
  }

  // Items that may meet on the lower side, and on the upper side of a line. The lower side includes the line.
  bool is_low(std::int32_t piece, Axis axis, double middle) const {
    const Point a = from(piece), b = to(piece);
    return axis == Axis::x ? a.x < middle || b.x == middle : std::min(a.y, b.y) <= middle;
  }
  bool is_high(std::int32_t piece, Axis axis, double middle) const {
    const Point a = from(piece), b = to(piece);
    return axis == Axis::x ? b.x > middle : std::max(a.y, b.y) > middle;
  }
  bool is_low_vertex(std::int32_t v, Axis axis, double middle) const {
    return (axis == Axis::x ? places_[v].x : places_[v].y) <= middle;
  }

  void halve(Slab slab, Items items, Axis axis, double middle) {
    const Items top{piece_stack_.size(), vertex_stack_.size()};
    for (const bool high : {false, true}) {
      for (std::size_t k = items.pieces; k < top.pieces; ++k) {
        const std::int32_t p = piece_stack_[k];
        if (high ? is_high(p, axis, middle) : is_low(p, axis, middle)) piece_stack_.push_back(p);
      }
      for (std::size_t k = items.vertices; k < top.vertices; ++k) {
        const std::int32_t v = vertex_stack_[k];
        if (is_low_vertex(v, axis, middle) != high) vertex_stack_.push_back(v);
      }
      Slab half = slab;
      if (axis == Axis::x) (high ? half.begin : half.end) = middle;
      divide(half, top);
    }
  }

  // Looks for a line parallel to an axis that separates most pieces.
  bool find_separation(Slab slab, Items items, Axis& axis, double& middle) const {
    const std::size_t count = piece_stack_.size() - items.pieces;
    std::size_t most = count + count / kSeparated;
    bool found = false;
    for (const Axis candidate : {Axis::y, Axis::x}) {
      double centres[kSamples];
      for (std::size_t k = 0; k < kSamples; ++k) {
        const std::int32_t p = piece_stack_[items.pieces + k * count / kSamples];
        const Point a = from(p), b = to(p);
        centres[k] = candidate == Axis::x ? 0.5 * a.x + 0.5 * b.x : 0.5 * a.y + 0.5 * b.y;
      }
      std::nth_element(centres, centres + kSamples / 2, centres + kSamples);
      const double cut = centres[kSamples / 2];
      if (candidate == Axis::x && (cut <= slab.begin || cut >= slab.end)) continue;
      std::size_t low = 0, high = 0;
      for (std::size_t k = items.pieces; k < piece_stack_.size(); ++k) {
        low += is_low(piece_stack_[k], candidate, cut) ? 1 : 0;
        high += is_high(piece_stack_[k], candidate, cut) ? 1 : 0;
      }
      if (low + high > most || 4 * std::max(low, high) > 3 * count) continue;
      most = low + high;
      axis = candidate;
      middle = cut;
      found = true;
      if (low + high <= count + count / kWellSeparated) break;
    }
    return found;
  }

  // The middle one of all ends, and vertices, that are strictly inside of the slab. Returns whether there is
  // one.
  bool find_middle(Slab slab, Items items, double& middle) {
    inside_.clear();
    const auto add = [&](double x) {
      if (slab.begin < x && x < slab.end) inside_.push_back(x);
    };
    for (std::size_t k = items.pieces; k < piece_stack_.size(); ++k) {
      add(from(piece_stack_[k]).x);
      add(to(piece_stack_[k]).x);
    }
    for (std::size_t k = items.vertices; k < vertex_stack_.size(); ++k) add(places_[vertex_stack_[k]].x);
    if (inside_.empty()) return false;
    const auto half = inside_.begin() + static_cast<std::ptrdiff_t>(inside_.size() / 2);
    std::nth_element(inside_.begin(), half, inside_.end());
    middle = *half;
    return true;
  }

  // Moves pieces that span the slab to chain_, with their heights.
  void take_spanning(Slab slab, Items items) {
    chain_.clear();
    std::size_t kept = items.pieces;
    for (std::size_t k = items.pieces; k < piece_stack_.size(); ++k) {
      const std::int32_t p = piece_stack_[k];
      if (spans(p, slab)) {
        chain_.push_back({p, height(p, slab.begin), height(p, slab.end)});
      } else {
        piece_stack_[kept++] = p;
      }
    }
    piece_stack_.resize(kept);
  }

  // Takes a chain away from the items, and finds its crossings with all others in the slab.
  void take_chain(Slab slab, Items items) {
    take_spanning(slab, items);
    if (chain_.empty()) return;
    std::sort(chain_.begin(), chain_.end(), [this, slab](const Spanning& p, const Spanning& q) {
      const int order = compare_at_begin(slab, p, q);
      return order != 0 ? order < 0 : compare_at_end(slab, p, q) < 0;
    });
    // The last one that goes on beyond the slab.
    std::ptrdiff_t through = -1;
    std::size_t size = 0;
    for (std::size_t k = 0; k < chain_.size(); ++k) {
      const Spanning p = chain_[k];
      const bool goes_on = to(p.piece).x > slab.end;
      const bool fits = (size == 0 || compare_at_end(slab, chain_[size - 1], p) <= 0) &&
                        !(goes_on && through >= 0 &&
                          compare_at_end(slab, chain_[static_cast<std::size_t>(through)], p) == 0);
      if (fits) {
        if (goes_on) through = static_cast<std::ptrdiff_t>(size);
        chain_[size++] = p;
      } else {
        piece_stack_.push_back(p.piece);
      }
    }
    chain_.resize(size);
    if (of_vertices_) {
      for (std::size_t k = items.vertices; k < vertex_stack_.size(); ++k) add_chain_at(vertex_stack_[k]);
    } else {
      for (std::size_t k = items.pieces; k < piece_stack_.size(); ++k) add_crossed(slab, piece_stack_[k]);
    }
  }

  // For a slab that has no end of a piece inside: spanning pieces cross if their order differs at its end.
  // All other items are at its end.
  void finish_slab(Slab slab, Items items) {
    take_spanning(slab, items);
    std::sort(chain_.begin(), chain_.end(), [this, slab](const Spanning& p, const Spanning& q) {
      const int order = of_vertices_ ? 0 : compare_at_begin(slab, p, q);
      return order != 0 ? order < 0 : compare_at_end(slab, p, q) < 0;
    });
    if (of_vertices_) {
      for (std::size_t k = items.vertices; k < vertex_stack_.size(); ++k) add_chain_at(vertex_stack_[k]);
      return;
    }
    for (std::size_t k = 1; k < chain_.size(); ++k) {
      const Spanning p = chain_[k];
      const bool goes_on = to(p.piece).x > slab.end;
      std::size_t place = k;
      while (place > 0 && !stopped_ && compare_at_end(slab, chain_[place - 1], p) > 0) {
        add_if_crossing(p.piece, chain_[place - 1].piece);
        chain_[place] = chain_[place - 1];
        --place;
      }
      chain_[place] = p;
      for (std::size_t tied = place;
           goes_on && tied > 0 && !stopped_ && compare_at_end(slab, chain_[tied - 1], p) == 0; --tied) {
        add_if_crossing(p.piece, chain_[tied - 1].piece);
      }
    }
    for (std::size_t k = items.pieces; k < piece_stack_.size(); ++k) {
      const std::int32_t p = piece_stack_[k];
      const Rank low = rank_of(from(p)), high = rank_of(to(p));
      for (std::size_t c = low.not_above; c < high.below; ++c) add_if_crossing(p, chain_[c].piece);
    }
  }

  // The pieces of the chain that a piece crosses in the slab, but not at its begin. Two that meet at its end
  // cross if both go on.
  void add_crossed(Slab slab, std::int32_t p) {
    const Point a = from(p), b = to(p);
    Rank left, right;
    if (a.x > slab.begin || a.x == b.x) {
      left = rank_of(a);
    } else {
      const Spanning at{p, height(p, slab.begin), {}};
      left = rank([&](const Spanning& q) { return compare_at_begin(slab, at, q); });
    }
    if (b.x < slab.end || a.x == b.x) {
      right = rank_of(b);
    } else {
      const Spanning at{p, {}, height(p, slab.end)};
      right = rank([&](const Spanning& q) { return compare_at_end(slab, at, q); });
    }
    if (b.x > slab.end) std::swap(right.below, right.not_above);
    for (std::size_t k = left.not_above; k < right.below; ++k) add_if_crossing(p, chain_[k].piece);
    for (std::size_t k = right.not_above; k < left.below; ++k) add_if_crossing(p, chain_[k].piece);
  }

  void add_chain_at(std::int32_t v) {
    const Rank at = rank_of(places_[v]);
    for (std::size_t k = at.below; k < at.not_above; ++k) add_if_inside(chain_[k].piece, v);
  }

  Rank rank_of(Point p) const {
    return rank([&](const Spanning& q) { return predicates_.orient(from(q.piece), to(q.piece), p); });
  }
  // side: 1 if the place is above a piece of the chain, -1 if it is below, 0 if it is on it.
  template <typename Side>
  Rank rank(const Side& side) const {
    const auto below =
        std::partition_point(chain_.begin(), chain_.end(), [&](const Spanning& q) { return side(q) > 0; });
    auto not_above = below;
    if (below != chain_.end() && side(*below) == 0) {
      not_above = std::partition_point(below, chain_.end(), [&](const Spanning& q) { return side(q) == 0; });
    }
    return {static_cast<std::size_t>(below - chain_.begin()),
            static_cast<std::size_t>(not_above - chain_.begin())};
  }

  // The height of a piece that is not vertical. From the nearer end, each of five operations has an error of
  // 2^-53 of the difference `way`, and the sum of 2^-53 of itself.
  Height height(std::int32_t piece, double x) const {
    const Point a = from(piece), b = to(piece);
    if (x == a.x || a.y == b.y) return {a.y, a.y};
    if (x == b.x) return {b.y, b.y};
    const double before = x - a.x, after = b.x - x, part = std::min(before, after) / (b.x - a.x);
    const double way = before < after ? part * (b.y - a.y) : part * (a.y - b.y);
    const double y = (before < after ? a.y : b.y) + way;
    const double error = 0x1p-50 * (std::fabs(way) + std::fabs(y));
    return {y - error, y + error};
  }

  int compare_at_begin(Slab slab, const Spanning& p, const Spanning& q) const {
    return compare(p.piece, p.begin, q.piece, q.begin, slab.begin);
  }
  int compare_at_end(Slab slab, const Spanning& p, const Spanning& q) const {
    return compare(p.piece, p.end, q.piece, q.end, slab.end);
  }
  // Which of two pieces is higher at an x that both have.
  int compare(std::int32_t p, Height of_p, std::int32_t q, Height of_q, double x) const {
    if (of_p.high < of_q.low) return -1;
    if (of_p.low > of_q.high) return 1;
    if (of_p.known() && of_q.known()) return 0;
    const Point pa = from(p), pb = to(p), qa = from(q), qb = to(q);
    if (of_p.known()) return predicates_.orient(qa, qb, {x, of_p.low});
    if (of_q.known()) return -predicates_.orient(pa, pb, {x, of_q.low});
    // Neither ends here; so if they do not cross, a piece that is not below at both ends is above.
    const int side_qa = predicates_.orient(pa, pb, qa), side_qb = predicates_.orient(pa, pb, qb);
    if (side_qa * side_qb >= 0) return -(side_qa + side_qb > 0) + (side_qa + side_qb < 0);
    const int side_pa = predicates_.orient(qa, qb, pa), side_pb = predicates_.orient(qa, qb, pb);
    if (side_pa * side_pb >= 0) return (side_pa + side_pb > 0) - (side_pa + side_pb < 0);
    return side_pa * compare_crossing({pa, pb}, {qa, qb}, false, {x, 0});
  }

  void add_if_crossing(std::int32_t p, std::int32_t q) {
    if (stopped_ || !cross(predicates_, lines_[p], lines_[q])) return;
    const auto [first, second] = std::minmax(pieces_by_place_[p], pieces_by_place_[q]);
    stopped_ = !found_(first, second);
  }
  void add_if_inside(std::int32_t p, std::int32_t v) {
    const Point a = from(p), b = to(p), point = places_[v];
    if (a.x < point.x && point.x < b.x && predicates_.orient(a, b, point) == 0)
      found_(pieces_by_place_[p], vertices_by_place_[v]);
  }

  Predicates predicates_;
  const Point* points_;
  const std::vector<Piece>& pieces_;
  const FoundPair& found_;
  bool of_vertices_ = false, stopped_ = false;
  Ids pieces_by_place_, vertices_by_place_;
  std::vector<Line> lines_;    // of pieces, by place
  std::vector<Point> places_;  // of vertices, by place
  Ids piece_stack_, vertex_stack_;
  std::vector<double> inside_;
  std::vector<Spanning> chain_;
};

// The vertices inside of a vertical piece lie between its ends in lexicographic order.
void add_inner_vertices_of_vertical(const Point* points, const std::vector<Piece>& pieces,
                                    const Ids& vertices, Pairs& pairs) {
  const auto before = [points](std::int32_t u, std::int32_t v) {
    return kernel::comes_before(points[u], points[v]) != 0;
  };
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (points[pieces[k].from].x != points[pieces[k].to].x) continue;
    auto v = std::upper_bound(vertices.begin(), vertices.end(), pieces[k].from, before);
    for (; v != vertices.end() && before(*v, pieces[k].to); ++v) {
      pairs.emplace_back(static_cast<std::int32_t>(k), *v);
    }
  }
}

}  // namespace

void find_crossings(const Predicates& predicates, const Point* points, const std::vector<Piece>& pieces,
                    const FoundPair& found) {
  Search(predicates, points, pieces, found).find_crossings();
}

Pairs inner_vertices(const Predicates& predicates, const Point* points, const std::vector<Piece>& pieces,
                     const Ids& vertices) {
  Pairs pairs;
  const FoundPair add = [&pairs](std::int32_t piece, std::int32_t vertex) {
    pairs.emplace_back(piece, vertex);
    return true;
  };
  Search(predicates, points, pieces, add).find_vertices(vertices);
  add_inner_vertices_of_vertical(points, pieces, vertices, pairs);
  std::sort(pairs.begin(), pairs.end(), [points](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first
                              : kernel::comes_before(points[a.second], points[b.second]) != 0;
  });
  return pairs;
}

}  // namespace flaunay::constrained
