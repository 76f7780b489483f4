#include "derived/voronoi/mend.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "arithmetic/coordinates.h"
#include "geometry/for_each.hpp"
#include "geometry/predicates.hpp"
#include "operations/prefetch.h"
#include "predicates/bounds.h"
#include "voronoi/plain_polygon.h"

namespace flaunay::voronoi {
namespace {

using geometry::for_each_run;
using geometry::Point;
using geometry::operator==;
using kernel::comes_before;
using kernel::fetch;

// An edge stays if it is longer than kLong times its distance from the cell's point, longer than kLongAtAll
// times the largest coordinate, and no farther away than kRemote times the extent of all points: rounding
// cannot have made it. Edges longer than kTiny times their distance are not removed as coincident corners.
constexpr double kLong = 0x1p-10, kLongAtAll = 0x1p-46, kRemote = 0x1p30, kTiny = 0x1p-12;

struct Earlier {
  bool operator()(Point a, Point b) const { return comes_before(a, b); }
};
struct Hash {
  std::size_t operator()(Point p) const {
    std::uint64_t h = kernel::as_ulong(p.x) * 0x9e3779b97f4a7c15 ^ kernel::as_ulong(p.y);
    h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93;
    return h ^ (h >> 29);
  }
};

// The larger difference of coordinates.
double distance(Point a, Point b) { return std::max(std::fabs(b.x - a.x), std::fabs(b.y - a.y)); }

// ---------------------------------------------------------------------------------------------------------------------
// One polygon

// Whether edges from a to b and from c to d have a place in common.
bool meet(Point a, Point b, Point c, Point d) {
  if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x) ||
      std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y))
    return false;
  const auto side = [](Point p, Point q, Point r) { return kernel::orient_sign(p, q, r, ORIENT_BOUND); };
  return side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
}

// Multiplied by a power of two that makes predicates exact, unless coordinates span more than 1,020 places.
std::vector<Point> in_range(std::vector<Point> polygon) {
  double least = HUGE_VAL, most = 0;
  for (const Point& p : polygon) {
    for (const double x : {std::fabs(p.x), std::fabs(p.y)}) {
      most = std::max(most, x);
      if (x > 0) least = std::min(least, x);
    }
  }
  const double end = std::ldexp(1.0, kernel::LARGEST_QUERY_EXPONENT + 1);
  if (most < end && least >= std::ldexp(1.0, kernel::LOWEST_QUERY_EXPONENT + kernel::DOUBLE_BITS))
    return polygon;
  const int shift = kernel::LARGEST_QUERY_EXPONENT - std::ilogb(most);
  for (Point& p : polygon) p = {std::ldexp(p.x, shift), std::ldexp(p.y, shift)};
  return polygon;
}

// Consecutive edges of a polygon: `count` edges from the one that leaves corner `first`.
struct Loop {
  std::size_t first, count;
};

// Which part of the edge from a to b lies before the line through c and d.
double part_before(Point a, Point b, Point c, Point d) {
  const auto side = [&](Point p) { return (d.x - c.x) * (p.y - c.y) - (d.y - c.y) * (p.x - c.x); };
  const double from = std::fabs(side(a)), both = from + std::fabs(side(b));
  return both > 0 ? from / both : 0.5;
}

// Edges i and j cross, and a polygon goes from there to there in two ways. The edges of the shorter one.
Loop shorter_way(const std::vector<Point>& at, std::size_t i, std::size_t j) {
  const std::size_t n = at.size();
  const auto next = [&](std::size_t k) { return k + 1 < n ? k + 1 : 0; };
  const auto length = [&](std::size_t k) { return distance(at[k], at[next(k)]); };
  const double part_i = part_before(at[i], at[next(i)], at[j], at[next(j)]),
               part_j = part_before(at[j], at[next(j)], at[i], at[next(i)]);
  // Both at once, as far as the shorter one.
  std::size_t from_i = i, from_j = j;
  double length_i = (1 - part_i) * length(i) + part_j * length(j),
         length_j = part_i * length(i) + (1 - part_j) * length(j);
  while (true) {
    const bool is_i = length_i < length_j || (length_i == length_j && comes_before(at[i], at[j]));
    std::size_t& k = is_i ? from_i : from_j;
    k = next(k);
    if (k == (is_i ? j : i)) return {is_i ? i : j, (is_i ? j + n - i : i + n - j) % n + 1};
    (is_i ? length_i : length_j) += length(k);
  }
}

// Appends the way between each two edges that are no neighbours and have a place in common, both included.
void find_crossings(const std::vector<Point>& at, std::vector<Loop>& loops) {
  const std::size_t n = at.size();
  // A sweep in the direction in which the polygon is longer.
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (const Point& p : at) {
    low[0] = std::min(low[0], p.x);
    high[0] = std::max(high[0], p.x);
    low[1] = std::min(low[1], p.y);
    high[1] = std::max(high[1], p.y);
  }
  const bool is_wide = high[0] - low[0] >= high[1] - low[1];
  struct Span {
    double begin, end;
    std::size_t edge;
  };
  std::vector<Span> spans(n), open;
  const auto next = [&](std::size_t i) { return i + 1 == n ? 0 : i + 1; };
  for (std::size_t i = 0; i < n; ++i) {
    const double a = is_wide ? at[i].x : at[i].y, b = is_wide ? at[next(i)].x : at[next(i)].y;
    spans[i] = {std::min(a, b), std::max(a, b), i};
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.begin < b.begin; });
  for (const Span& span : spans) {
    open.erase(std::remove_if(open.begin(), open.end(), [&](const Span& s) { return s.end < span.begin; }),
               open.end());
    for (const Span& other : open) {
      const std::size_t i = std::min(span.edge, other.edge), j = std::max(span.edge, other.edge);
      if (next(i) == j || next(j) == i || !meet(at[i], at[next(i)], at[j], at[next(j)])) continue;
      loops.push_back(shorter_way(at, i, j));
    }
    open.push_back(span);
  }
}

// Finds where a polygon touches itself or is not counter-clockwise; empty if it is simple. Consecutive
// corners must not be equal.
std::vector<Loop> find_faults(const std::vector<Point>& given) {
  const std::vector<Point> at = in_range(given);
  const std::size_t n = at.size();
  const auto next = [&](std::size_t i) { return i + 1 == n ? 0 : i + 1; };
  std::vector<Loop> loops;
  std::size_t first = 0, lowest = 0;
  bool is_convex = true;
  std::vector<int> turns(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Point a = at[i], b = at[next(i)], c = at[next(next(i))];
    const int turn = turns[next(i)] = kernel::orient_sign(a, b, c, ORIENT_BOUND);
    // Straight on, or back.
    if (turn == 0 && comes_before(a, b) != comes_before(b, c)) loops.push_back({i, 2});
    is_convex = is_convex && turn >= 0;
    lowest += comes_before(b, a) && comes_before(b, c) ? 1 : 0;
    if (comes_before(at[i], at[first])) first = i;
  }
  if (loops.empty() && is_convex && lowest == 1) return loops;
  find_crossings(at, loops);
  if (loops.empty() && (is_convex || turns[first] <= 0)) loops.push_back({0, n});
  return loops;
}

// ---------------------------------------------------------------------------------------------------------------------
// All cells of a set

// A corner of a polygon: its coordinates, and the number of its place. On a torus, images are one place.
struct Corner {
  Point at;
  std::int32_t place;
};

// Removes corners that equal the one before, and paths that are traversed forth and back.
void tighten(std::vector<Corner>& polygon) {
  std::size_t size = 0;
  const auto is_at = [&](std::size_t i, Point p) { return polygon[i].at == p; };
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Corner corner = polygon[k];
    const auto drop = [&] {
      while (size > 0 && is_at(size - 1, corner.at)) --size;
      return size > 1 && is_at(size - 2, corner.at);
    };
    while (drop()) --size;
    polygon[size++] = corner;
  }
  std::size_t begin = 0;
  while (size - begin > 2) {
    if (is_at(size - 1, polygon[begin].at) || is_at(size - 2, polygon[begin].at)) {
      --size;
    } else if (is_at(size - 1, polygon[begin + 1].at)) {
      ++begin;
    } else {
      break;
    }
  }
  polygon.resize(size);
  polygon.erase(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(begin));
  if (polygon.size() < 3) polygon.clear();
}

class Mender {
 public:
  // can_join: whether cells can become parts of others.
  Mender(host::Runtime& runtime, const double* sites, const std::vector<double>& fixed,
         const kernel::periodic_lattice& lattice, bool can_join, Cells& cells)
      : runtime_(runtime.is_native() ? &runtime : nullptr),
        sites_(sites),
        lattice_(lattice),
        can_join_(can_join),
        cells_(cells) {
    for (std::size_t i = 0; i < fixed.size(); i += 2) fixed_.push_back({fixed[i] + 0.0, fixed[i + 1] + 0.0});
    std::sort(fixed_.begin(), fixed_.end(), Earlier());
  }

  // Mends the cells [first, last) of a set. The result depends on these cells alone.
  void run(std::size_t first, std::size_t last) {
    first_ = first;
    last_ = last;
    Ids doubtful = cells_with([&](std::size_t i) {
      const std::int32_t begin = cells_.offsets[i], end = cells_.offsets[i + 1];
      return !kernel::is_plain_polygon(site(i), begin, end, cells_.vertices.data());
    });
    table_.assign(kLeastTable, -1);
    places_.clear();
    uses_.clear();
    complete_ = open_ = 0;
    passes_ = 0;
    if (doubtful.empty()) return;
    prepare();
    open(doubtful);
    while (!doubtful.empty()) {
      look_at(doubtful);
      doubtful = edges_.empty() ? join() : collapse();
    }
  }

  /// Where a corner of the set's cells is now.
  Point moved(Point p) const {
    const std::int32_t place = lookup(key(p));
    return place < 0 ? p : places_[index(root(place))].at;
  }

  // Moves polygons up to each other.
  void close_up() {
    if (sizes_.empty()) return;
    std::vector<double> vertices;
    vertices.reserve(cells_.vertices.size());
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
      const auto from = cells_.vertices.cbegin() + static_cast<std::ptrdiff_t>(2 * begins_[i]);
      cells_.offsets[i] = static_cast<std::int32_t>(vertices.size() / 2);
      vertices.insert(vertices.end(), from, from + 2 * static_cast<std::ptrdiff_t>(sizes_[i]));
    }
    cells_.offsets.back() = static_cast<std::int32_t>(vertices.size() / 2);
    cells_.vertices = std::move(vertices);
  }

 private:
  using Ids = std::vector<std::int32_t>;
  using Edge = std::pair<std::int32_t, std::int32_t>;  // two places, the earlier one first

  struct Place {
    Point at;
    std::uint64_t around;  // hashes of next corners minus hashes of corners before: 0 if cells close
    std::int32_t root;     // another place if the corners here have moved there
    std::int32_t first, last, count;  // uses_ that are of this place
    bool is_fixed;
  };
  struct Use {
    std::int32_t cell, next;
  };

  static constexpr std::size_t kLeastTable = 64;
  // This many times, only the cells at known places are opened; after that, all cells are.
  static constexpr int kPasses = 3;

  static std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }
  Point site(std::size_t i) const { return {sites_[2 * i], sites_[2 * i + 1]}; }
  Point vertex(std::size_t corner) const {
    return {cells_.vertices[2 * corner], cells_.vertices[2 * corner + 1]};
  }
  // The image in the period.
  Point key(Point p) const {
    p = kernel::moved(p, 0, -vectors(std::floor(p.y / lattice_.period[1])), &lattice_);
    p = kernel::moved(p, -vectors(std::floor(p.x / lattice_.period[0])), 0, &lattice_);
    return {p.x + 0.0, p.y + 0.0};
  }

  template <typename T>
  static std::vector<T> joined(const std::vector<std::vector<T>>& parts) {
    std::vector<T> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  template <typename Has>
  Ids cells_with(const Has& has) const {
    std::vector<Ids> found(geometry::runs_of(last_ - first_));
    for_each_run(runtime_, last_ - first_, [&](std::size_t run, std::size_t begin, std::size_t end) {
      for (std::size_t i = first_ + begin; i < first_ + end; ++i) {
        if (has(i)) found[run].push_back(static_cast<std::int32_t>(i));
      }
    });
    return joined(found);
  }

  void prepare() {
    if (sizes_.empty()) {
      const std::size_t n = cells_.offsets.size() - 1;
      begins_.assign(cells_.offsets.begin(), cells_.offsets.end() - 1);
      sizes_.resize(n);
      for (std::size_t i = 0; i < n; ++i) sizes_[i] = cells_.offsets[i + 1] - cells_.offsets[i];
      ring_.resize(cells_.vertices.size() / 2);
      is_open_.assign(n, 0);
      is_changed_.assign(n, 0);
    }
    Point low = site(first_), high = low;
    for (std::size_t i = first_; i < last_; ++i) {
      const Point p = site(i);
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    reach_ = distance(low, high);
  }

  // ---- Places

  std::size_t slot_of(Point p, std::size_t hash) const {
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = hash & mask;
    while (table_[slot] >= 0 && !(places_[index(table_[slot])].at == p)) slot = (slot + 1) & mask;
    return slot;
  }
  // -1 for a place that no open cell has.
  std::int32_t lookup(Point p) const { return table_[slot_of(p, Hash()(p))]; }

  std::int32_t place_at(Point p, std::size_t hash) {
    const std::size_t slot = slot_of(p, hash);
    if (table_[slot] >= 0) return table_[slot];
    const auto place = static_cast<std::int32_t>(places_.size());
    table_[slot] = place;
    const bool is_fixed = std::binary_search(fixed_.begin(), fixed_.end(), p, Earlier());
    places_.push_back({p, 0, place, -1, -1, 0, is_fixed});
    if (2 * places_.size() > table_.size()) make_table(2 * table_.size());
    return place;
  }

  void make_table(std::size_t size) {
    table_.assign(size, -1);
    for (std::size_t k = 0; k < places_.size(); ++k)
      table_[slot_of(places_[k].at, Hash()(places_[k].at))] = static_cast<std::int32_t>(k);
  }

  std::int32_t root(std::int32_t place) const {
    while (places_[index(place)].root != place) place = places_[index(place)].root;
    return place;
  }
  std::int32_t root(std::int32_t place) {
    while (places_[index(place)].root != place)
      place = places_[index(place)].root = places_[index(places_[index(place)].root)].root;
    return place;
  }

  void add_use(std::int32_t place, std::int32_t cell) {
    Place& at = places_[index(place)];
    const auto use = static_cast<std::int32_t>(uses_.size());
    uses_.push_back({cell, at.first});
    at.first = use;
    if (at.last < 0) at.last = use;
    ++at.count;
  }

  // Finds the places of cells' corners.
  void open(const Ids& cells) {
    std::size_t corners = 0;
    for (const std::int32_t i : cells) corners += index(sizes_[index(i)]);
    // A corner is one of three cells, as a rule.
    std::size_t size = table_.size();
    while (size < places_.size() + corners) size *= 2;
    if (size > table_.size()) make_table(size);
    std::vector<Point> at;
    std::vector<std::size_t> hashes;
    for (const std::int32_t i : cells) {
      const std::size_t begin = begins_[index(i)], count = index(sizes_[index(i)]);
      std::int32_t* const ring = ring_.data() + begin;
      is_open_[index(i)] = 1;
      at.resize(count);
      hashes.resize(count);
      for (std::size_t k = 0; k < count; ++k) {
        at[k] = key(vertex(begin + k));
        hashes[k] = Hash()(at[k]);
        fetch(&table_[hashes[k] & (table_.size() - 1)]);
      }
      for (std::size_t k = 0; k < count; ++k) {
        ring[k] = place_at(at[k], hashes[k]);
        add_use(ring[k], i);
        places_[index(ring[k])].around +=
            hashes[k + 1 < count ? k + 1 : 0] - hashes[k > 0 ? k - 1 : count - 1];
      }
    }
    open_ += cells.size();
    if (open_ == last_ - first_) complete_ = std::numeric_limits<std::size_t>::max();
  }

  // Opens all cells that have a place which is known by now.
  void complete() {
    const bool is_all = ++passes_ > kPasses;
    const Ids found = cells_with([&](std::size_t i) {
      if (is_open_[i] != 0) return false;
      bool has_place = is_all;
      for (std::size_t k = begins_[i]; k < begins_[i] + index(sizes_[i]) && !has_place; ++k)
        has_place = lookup(key(vertex(k))) >= 0;
      return has_place;
    });
    complete_ = places_.size();
    open(found);
  }

  // ---- Polygons

  void read(std::size_t cell, std::vector<Corner>& polygon) const {
    polygon.clear();
    for (std::size_t k = begins_[cell]; k < begins_[cell] + index(sizes_[cell]); ++k)
      polygon.push_back({vertex(k), ring_[k]});
  }

  // Has as many corners as before at most.
  void write(std::size_t cell, const std::vector<Corner>& polygon) {
    sizes_[cell] = static_cast<std::int32_t>(polygon.size());
    std::size_t to = begins_[cell];
    for (const Corner& corner : polygon) {
      cells_.vertices[2 * to] = corner.at.x;
      cells_.vertices[2 * to + 1] = corner.at.y;
      ring_[to++] = corner.place;
    }
  }

  bool is_plain(std::size_t cell) const {
    const std::size_t begin = begins_[cell];
    return kernel::is_plain_polygon(site(cell), 0, sizes_[cell], cells_.vertices.data() + 2 * begin);
  }

  bool is_earlier(std::int32_t a, std::int32_t b) const {
    return comes_before(places_[index(a)].at, places_[index(b)].at);
  }
  // Whatever the order of the places' numbers.
  bool is_earlier(const Edge& a, const Edge& b) const {
    return a.first != b.first ? is_earlier(a.first, b.first) : is_earlier(a.second, b.second);
  }

  // Temporary arrays of look_at for one cell.
  struct Scratch {
    std::vector<Corner> polygon;
    std::vector<Point> at;
    std::vector<double> lengths;
    std::vector<Edge> edges;
    Ids thin;
  };

  // Lists the edges to remove, and the faulty cells that have no removable edge.
  void look_at(const Ids& cells) {
    std::vector<Scratch> scratch(geometry::runs_of(cells.size()));
    for_each_run(runtime_, cells.size(), [&](std::size_t run, std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) look_at(index(cells[k]), scratch[run]);
    });
    edges_.clear();
    thin_.clear();
    for (const Scratch& part : scratch) {
      edges_.insert(edges_.end(), part.edges.begin(), part.edges.end());
      thin_.insert(thin_.end(), part.thin.begin(), part.thin.end());
    }
  }

  void look_at(std::size_t i, Scratch& scratch) {
    std::vector<Corner>& polygon = scratch.polygon;
    read(i, polygon);
    for (const Corner& c : polygon) {
      if (!std::isfinite(c.at.x) || !std::isfinite(c.at.y)) return;
    }
    tighten(polygon);
    write(i, polygon);
    if (is_plain(i)) return;
    const std::size_t n = polygon.size();
    const auto edge = [&](std::size_t k) {
      const std::int32_t a = polygon[k].place, b = polygon[k + 1 < n ? k + 1 : 0].place;
      return is_earlier(b, a) ? Edge{b, a} : Edge{a, b};
    };
    // Lengths relative to the scale of rounding; infinite if the edge stays.
    std::vector<double>& lengths = scratch.lengths;
    lengths.clear();
    const std::size_t listed = scratch.edges.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Point a = polygon[k].at, b = polygon[k + 1 < n ? k + 1 : 0].at;
      const double length = distance(a, b), away = std::min(distance(a, site(i)), distance(b, site(i)));
      const double relative = length / kernel::corner_scale(a, b, site(i));
      const auto [p, q] = edge(k);
      const bool is_long = length > kLong * away && relative > kLongAtAll && away <= kRemote * reach_;
      const bool stays = is_long || (places_[index(p)].is_fixed && places_[index(q)].is_fixed);
      lengths.push_back(stays ? HUGE_VAL : relative);
      if (!stays && length <= kTiny * away && relative <= CORNERS_COINCIDE) scratch.edges.push_back({p, q});
    }
    if (scratch.edges.size() > listed) return;
    scratch.at.clear();
    for (const Corner& c : polygon) scratch.at.push_back(c.at);
    const std::vector<Loop> faults = find_faults(scratch.at);
    const auto shortest = [&](Loop loop) {
      std::size_t least = loop.first;
      for (std::size_t k = loop.first; k < loop.first + loop.count; ++k) {
        const std::size_t at = k % n;
        if (lengths[at] < lengths[least] ||
            (lengths[at] == lengths[least] && is_earlier(edge(at), edge(least))))
          least = at;
      }
      return least;
    };
    for (const Loop& fault : faults) {
      std::size_t least = shortest(fault);
      if (std::isinf(lengths[least]) && !can_join_) least = shortest({0, n});
      if (std::isfinite(lengths[least])) scratch.edges.push_back(edge(least));
    }
    if (!faults.empty() && scratch.edges.size() == listed)
      scratch.thin.push_back(static_cast<std::int32_t>(i));
  }

  // ---- Changes. Each returns the cells that have changed.

  // Makes one place of the ends of each listed edge.
  Ids collapse() {
    const auto is_incomplete = [&](std::int32_t place) { return index(place) >= complete_; };
    for (const auto& [a, b] : edges_) {
      if (is_incomplete(a) || is_incomplete(b)) complete();
    }
    // Two fixed places stay apart, so that the order matters where they are: it is not that of the cells.
    const auto fixed = std::partition(edges_.begin(), edges_.end(), [&](const Edge& edge) {
      return !places_[index(edge.first)].is_fixed && !places_[index(edge.second)].is_fixed;
    });
    std::sort(fixed, edges_.end(), [&](const Edge& a, const Edge& b) { return is_earlier(a, b); });
    // If places become one, fixed places remain before others, then border places, around which cells do not
    // close, then places of many cells.
    const auto is_better = [&](std::int32_t a, std::int32_t b) {
      const Place &p = places_[index(a)], &q = places_[index(b)];
      if (p.is_fixed != q.is_fixed) return p.is_fixed;
      if ((p.around == 0) != (q.around == 0)) return p.around != 0;
      return p.count != q.count ? p.count > q.count : is_earlier(a, b);
    };
    Ids gone;
    for (const auto& [a, b] : edges_) {
      std::int32_t p = root(a), q = root(b);
      if (p == q) continue;
      if (is_better(q, p)) std::swap(p, q);
      if (places_[index(q)].is_fixed) continue;
      places_[index(q)].root = p;
      gone.push_back(q);
    }
    Ids changed;
    for (const std::int32_t q : gone) {
      for (std::int32_t use = places_[index(q)].first; use >= 0; use = uses_[index(use)].next)
        mark_changed(uses_[index(use)].cell, changed);
    }
    for (const std::int32_t q : gone) {
      Place& from = places_[index(q)];
      Place& to = places_[index(from.root = root(q))];
      uses_[index(to.last)].next = from.first;
      to.last = from.last;
      to.count += from.count;
    }
    for_each_run(runtime_, changed.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) move_corners(index(changed[k]));
    });
    // Thin cells may have edges to lose now.
    for (const std::int32_t i : thin_) mark_changed(i, changed);
    for (const std::int32_t i : changed) is_changed_[index(i)] = 0;
    return changed;
  }

  void mark_changed(std::int32_t cell, Ids& changed) {
    if (is_changed_[index(cell)] == 0) changed.push_back(cell);
    is_changed_[index(cell)] = 1;
  }

  void move_corners(std::size_t cell) {
    for (std::size_t k = begins_[cell]; k < begins_[cell] + index(sizes_[cell]); ++k) {
      const std::int32_t to = std::as_const(*this).root(ring_[k]);
      if (to == ring_[k]) continue;
      const Point at = image_near(vertex(k), places_[index(to)].at, lattice_);
      cells_.vertices[2 * k] = at.x;
      cells_.vertices[2 * k + 1] = at.y;
      ring_[k] = to;
    }
  }

  // Makes thin cells without removable edges parts of the cells across their longest edges.
  Ids join() {
    if (thin_.empty() || !can_join_) return {};
    while (complete_ < places_.size()) complete();
    std::sort(thin_.begin(), thin_.end(),
              [&](std::int32_t a, std::int32_t b) { return comes_before(site(index(a)), site(index(b))); });
    Ids changed;
    for (const std::int32_t i : thin_) {
      if (is_changed_[index(i)] == 0) join(i, changed);
    }
    for (const std::int32_t i : changed) is_changed_[index(i)] = 0;
    return changed;
  }

  void join(std::int32_t cell, Ids& changed) {
    std::vector<Corner> thin, other, best;
    read(index(cell), thin);
    sizes_[index(cell)] = 0;
    const std::size_t n = thin.size();
    double longest = 0;
    std::int32_t to = -1;
    for (std::size_t k = 0; k < n; ++k) {
      // Begins where the edge ends, and ends where it begins.
      std::rotate(thin.begin(), thin.begin() + 1, thin.end());
      const double length = distance(thin.back().at, thin.front().at);
      if (to >= 0 && length < longest) continue;
      const std::int32_t found = cell_at(thin, other);
      if (found < 0) continue;
      if (to >= 0 && length == longest && !comes_before(site(index(found)), site(index(to)))) continue;
      longest = length;
      to = found;
      const Point shift = {other.back().at.x - thin.front().at.x, other.back().at.y - thin.front().at.y};
      best = other;
      for (std::size_t c = 1; c + 1 < n; ++c) {
        const Point at = thin[c].at;
        best.push_back(
            {image_near({at.x + shift.x, at.y + shift.y}, places_[index(thin[c].place)].at, lattice_),
             thin[c].place});
      }
    }
    if (to < 0) return;
    begins_[index(to)] = ring_.size();
    ring_.resize(ring_.size() + best.size());
    cells_.vertices.resize(2 * ring_.size());
    write(index(to), best);
    for (const Corner& corner : thin) add_use(corner.place, to);
    mark_changed(to, changed);
  }

  // The cell on the other side of the edge from the last corner to the first; -1 at the border. polygon:
  // becomes its, from where that edge begins.
  std::int32_t cell_at(const std::vector<Corner>& ring, std::vector<Corner>& polygon) const {
    const std::int32_t a = ring.back().place, b = ring.front().place;
    const Place &p = places_[index(a)], &q = places_[index(b)];
    for (std::int32_t use = (p.count < q.count ? p : q).first; use >= 0; use = uses_[index(use)].next) {
      const std::int32_t cell = uses_[index(use)].cell;
      read(index(cell), polygon);
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Corner &from = polygon[k > 0 ? k - 1 : polygon.size() - 1], &end = polygon[k];
        if (from.place != b || end.place != a ||
            !is_one_image(from.at, ring.front().at, end.at, ring.back().at))
          continue;
        std::rotate(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(k), polygon.end());
        return cell;
      }
    }
    return -1;
  }

  // Whether a is as many periods from b as c is from d.
  bool is_one_image(Point a, Point b, Point c, Point d) const {
    return std::fabs((a.x - b.x) - (c.x - d.x)) < lattice_.period[0] / 2 &&
           std::fabs((a.y - b.y) - (c.y - d.y)) < lattice_.period[1] / 2;
  }

  host::Runtime* runtime_;
  const double* sites_;
  std::vector<Point> fixed_;
  kernel::periodic_lattice lattice_;
  bool can_join_;
  Cells& cells_;
  // For all sets. A cell has corners in cells_.vertices, and in ring_ their places if it is open.
  std::vector<std::size_t> begins_;
  Ids sizes_, ring_;
  std::vector<std::uint8_t> is_open_, is_changed_;
  // For the current set.
  std::size_t first_ = 0, last_ = 0;
  double reach_ = 0;
  Ids table_;
  std::vector<Place> places_;
  std::vector<Use> uses_;
  std::size_t complete_ = 0;  // all cells at the places before this one are open
  std::size_t open_ = 0;      // cells
  int passes_ = 0;
  std::vector<Edge> edges_;
  Ids thin_;
};

}  // namespace

void mend(host::Runtime& runtime, const std::vector<std::size_t>& sets, const double* sites,
          const std::vector<double>& fixed, const kernel::periodic_lattice& lattice, Cells& cells) {
  Mender mender(runtime, sites, fixed, lattice, true, cells);
  for (std::size_t s = 0; s + 1 < sets.size(); ++s) mender.run(sets[s], sets[s + 1]);
  mender.close_up();
}

void mend_centres(host::Runtime& runtime, const points::DeviceMesh& mesh, const std::vector<cl_uint>& doubts,
                  const std::vector<double>& sites, const std::vector<std::int32_t>& offsets,
                  const std::vector<std::int32_t>& corners, const std::vector<std::uint8_t>& unbounded,
                  std::vector<double>& centres) {
  Cells cells{{0}, {}};
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    const auto first = corners.begin() + offsets[i], end = corners.begin() + offsets[i + 1];
    for (auto c = first; unbounded[i] == 0 && c < end; ++c) {
      const auto at = centres.begin() + 2 * static_cast<std::ptrdiff_t>(*c);
      cells.vertices.insert(cells.vertices.end(), at, at + 2);
    }
    cells.offsets.push_back(static_cast<std::int32_t>(cells.vertices.size() / 2));
  }
  Mender mender(runtime, sites.data(), {}, kNoPeriod, false, cells);
  for (std::size_t s = 0; s < mesh.sets(); ++s) {
    const std::size_t first = mesh.triangle_offsets[s], end = mesh.triangle_offsets[s + 1];
    if (doubts[first] == doubts[end]) continue;
    mender.run(mesh.point_offsets[s], mesh.point_offsets[s + 1]);
    for (std::size_t c = 2 * first; c < 2 * end; c += 2) {
      const Point to = mender.moved({centres[c], centres[c + 1]});
      centres[c] = to.x;
      centres[c + 1] = to.y;
    }
  }
}

}  // namespace flaunay::voronoi
