#include "derived/voronoi/mend.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "arithmetic/coordinates.h"
#include "geometry/for_each.hpp"
#include "predicates/bounds.h"
#include "voronoi/plain_polygon.h"

namespace flaunay::voronoi {
namespace {

using geometry::for_each_run;
using geometry::Point;
using geometry::operator==;
using kernel::comes_before;

// An edge that is longer than this part of its distance from the cell's point is no matter of rounding,
// unless both ends are so many times as far away as all points lie apart; and what is nearer is small, not
// rounded.
constexpr double kLong = 0x1p-10, kRemote = 0x1p30, kTiny = 0x1p-12;

struct Earlier {
  bool operator()(Point a, Point b) const { return comes_before(a, b); }
};
struct Same {
  bool operator()(Point a, Point b) const { return a == b; }
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

// Whether a polygon, of which no two corners in a row are equal, does not touch itself and is
// counter-clockwise.
bool is_simple(const std::vector<Point>& given) {
  const std::vector<Point> at = in_range(given);
  const std::size_t n = at.size();
  const auto next = [&](std::size_t i) { return i + 1 == n ? 0 : i + 1; };
  std::size_t first = 0, lowest = 0;
  bool is_convex = true;
  std::vector<int> turns(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Point a = at[i], b = at[next(i)], c = at[next(next(i))];
    turns[next(i)] = kernel::orient_sign(a, b, c, ORIENT_BOUND);
    // Straight on, or back.
    if (turns[next(i)] == 0 && comes_before(a, b) != comes_before(b, c)) return false;
    is_convex = is_convex && turns[next(i)] >= 0;
    lowest += comes_before(b, a) && comes_before(b, c) ? 1 : 0;
    if (comes_before(at[i], at[first])) first = i;
  }
  if (turns[first] <= 0) return false;
  if (is_convex) return lowest == 1;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (next(j) != i && meet(at[i], at[next(i)], at[j], at[next(j)])) return false;
    }
  }
  return true;
}

// Leaves out corners that equal the one before, and what is gone along and back.
void tighten(std::vector<Point>& polygon) {
  std::size_t size = 0;
  const auto drop = [&](Point last) {
    while (size > 0 && polygon[size - 1] == last) --size;
    return size > 1 && polygon[size - 2] == last;
  };
  for (const Point p : std::vector<Point>(polygon)) {
    while (drop(p)) --size;
    polygon[size++] = p;
  }
  std::size_t begin = 0;
  while (size - begin > 2) {
    if (polygon[size - 1] == polygon[begin] || polygon[size - 2] == polygon[begin]) {
      --size;
    } else if (polygon[size - 1] == polygon[begin + 1]) {
      ++begin;
    } else {
      break;
    }
  }
  polygon.resize(size);
  polygon.erase(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(begin));
  if (polygon.size() < 3) polygon.clear();
}

// ---------------------------------------------------------------------------------------------------------------------
// All cells

using Edge = std::pair<Point, Point>;  // the earlier end first

class Mender {
 public:
  Mender(host::Runtime& runtime, const double* sites, const std::vector<double>& fixed,
         const std::array<double, 2>& period, Cells& cells)
      : runtime_(runtime.is_native() ? &runtime : nullptr), sites_(sites), period_(period), cells_(cells) {
    for (std::size_t i = 0; i < fixed.size(); i += 2) fixed_.push_back({fixed[i] + 0.0, fixed[i + 1] + 0.0});
    std::sort(fixed_.begin(), fixed_.end(), Earlier());
  }

  void run() {
    const std::size_t n = cells_.offsets.size() - 1;
    std::vector<std::vector<std::size_t>> found(geometry::runs_of(n));
    for_each_run(runtime_, n, [&](std::size_t run, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (is_in_doubt(i)) found[run].push_back(i);
      }
    });
    std::vector<std::size_t> doubtful = joined(found);
    if (doubtful.empty()) return;
    for (std::size_t i = 1; i < n; ++i) reach_ = std::max(reach_, distance(site(i), site(0)));
    sizes_.resize(n);
    for (std::size_t i = 0; i < n; ++i) sizes_[i] = cells_.offsets[i + 1] - cells_.offsets[i];
    while (!doubtful.empty()) {
      edges_.clear();
      for (const std::size_t i : doubtful) look_at(i);
      doubtful = collapse();
    }
    close_up();
  }

  /// Where a corner is now.
  Point moved(Point p) const {
    p = key(p);
    for (auto to = moves_.find(p); to != moves_.end(); to = moves_.find(p)) p = to->second;
    return p;
  }

 private:
  // A corner that goes to another place.
  struct Corner {
    std::size_t cell, at, number;
    std::uint64_t around;  // of the next corner, without that of the one before
  };

  Point site(std::size_t i) const { return {sites_[2 * i], sites_[2 * i + 1]}; }
  std::size_t begin(std::size_t i) const { return static_cast<std::size_t>(cells_.offsets[i]); }
  Point at(std::size_t corner) const {
    return {cells_.vertices[2 * corner], cells_.vertices[2 * corner + 1]};
  }
  // The image in the period.
  Point key(Point p) const {
    const auto reduced = [](double x, double period) {
      return std::isinf(period) ? x + 0.0 : x - period * std::floor(x / period);
    };
    return {reduced(p.x, period_[0]), reduced(p.y, period_[1])};
  }
  bool is_fixed(Point p) const { return std::binary_search(fixed_.begin(), fixed_.end(), p, Earlier()); }

  template <typename T>
  static std::vector<T> joined(const std::vector<std::vector<T>>& parts) {
    std::vector<T> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  bool is_in_doubt(std::size_t i) const {
    const std::int32_t first = cells_.offsets[i], end = cells_.offsets[i + 1];
    return !kernel::is_plain_polygon(site(i), first, end, cells_.vertices.data());
  }

  std::vector<Point> polygon_of(std::size_t i) const {
    std::vector<Point> polygon;
    for (std::size_t k = 0; k < static_cast<std::size_t>(sizes_[i]); ++k) polygon.push_back(at(begin(i) + k));
    return polygon;
  }

  // Lists the edges that have to go.
  void look_at(std::size_t i) {
    std::vector<Point> polygon = polygon_of(i);
    for (const Point& p : polygon) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) return;
    }
    tighten(polygon);
    write(i, polygon);
    if (polygon.empty()) return;
    const auto listed = edges_.size();
    // Relative to what rounding depends on.
    double least = HUGE_VAL;
    Edge shortest;
    Point a = polygon.back();
    for (const Point b : polygon) {
      const double length = distance(a, b);
      const double relative = length / kernel::corner_scale(a, b, site(i));
      const Edge edge = comes_before(a, b) ? Edge{a, b} : Edge{b, a};
      a = b;
      const double away = std::min(distance(edge.first, site(i)), distance(edge.second, site(i)));
      const bool is_long = length > kLong * away && away <= kRemote * reach_;
      if (is_long || (is_fixed(edge.first) && is_fixed(edge.second))) continue;
      if (length <= kTiny * away && relative <= CORNERS_COINCIDE) edges_.push_back(edge);
      if (relative < least || (relative == least && comes_before(edge.first, shortest.first))) {
        least = relative;
        shortest = edge;
      }
    }
    if (edges_.size() > listed || is_simple(polygon)) return;
    if (std::isfinite(least)) {
      edges_.push_back(shortest);
    } else {
      write(i, {});
    }
  }

  void write(std::size_t i, const std::vector<Point>& polygon) {
    sizes_[i] = static_cast<std::int32_t>(polygon.size());
    std::size_t to = 2 * begin(i);
    for (const Point& p : polygon) {
      cells_.vertices[to++] = p.x;
      cells_.vertices[to++] = p.y;
    }
  }

  // Makes one place of the ends of each listed edge. Returns the cells that have changed.
  std::vector<std::size_t> collapse() {
    if (edges_.empty()) return {};
    // Numbers in the order of the places, so that nothing depends on the order of the cells.
    std::vector<Point> ends;
    for (auto& [a, b] : edges_) {
      a = key(a);
      b = key(b);
      ends.insert(ends.end(), {a, b});
    }
    std::sort(ends.begin(), ends.end(), Earlier());
    ends.erase(std::unique(ends.begin(), ends.end(), Same()), ends.end());
    std::unordered_map<Point, std::size_t, Hash, Same> numbers(2 * ends.size());
    for (std::size_t k = 0; k < ends.size(); ++k) numbers.emplace(ends[k], k);

    const std::vector<Corner> corners = corners_at(numbers);
    std::vector<std::uint64_t> around(ends.size(), 0);
    for (const Corner& corner : corners) around[corner.number] += corner.around;
    // Of one place those remain that are fixed, then those on the border, around which cells do not close.
    const auto rank = [&](std::size_t k) { return std::tuple(!is_fixed(ends[k]), around[k] == 0, k); };
    std::vector<std::size_t> to(ends.size());
    for (std::size_t k = 0; k < to.size(); ++k) to[k] = k;
    const auto find = [&](std::size_t k) {
      while (to[k] != k) k = to[k] = to[to[k]];
      return k;
    };
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) {
      return a.first == b.first ? comes_before(a.second, b.second) : comes_before(a.first, b.first);
    });
    for (const auto& [a, b] : edges_) {
      std::size_t p = find(numbers.at(a)), q = find(numbers.at(b));
      if (rank(q) < rank(p)) std::swap(p, q);
      if (!is_fixed(ends[q])) to[q] = p;
    }
    for (std::size_t k = 0; k < ends.size(); ++k) {
      if (find(k) != k) moves_.emplace(ends[k], ends[find(k)]);
    }
    std::vector<std::size_t> changed;
    for (const Corner& corner : corners) {
      if (find(corner.number) == corner.number) continue;
      const Point target = ends[find(corner.number)];
      double* const place = &cells_.vertices[2 * corner.at];
      const auto image = [](double x, double goal, double period) {
        return std::isinf(period) ? goal : goal + period * std::round((x - goal) / period);
      };
      place[0] = image(place[0], target.x, period_[0]);
      place[1] = image(place[1], target.y, period_[1]);
      if (changed.empty() || changed.back() != corner.cell) changed.push_back(corner.cell);
    }
    return changed;
  }

  // In the order of the cells.
  template <typename Numbers>
  std::vector<Corner> corners_at(const Numbers& numbers) const {
    std::vector<std::vector<Corner>> found(geometry::runs_of(sizes_.size()));
    for_each_run(runtime_, sizes_.size(), [&](std::size_t run, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const auto size = static_cast<std::size_t>(sizes_[i]);
        for (std::size_t k = 0; k < size; ++k) {
          const auto number = numbers.find(key(at(begin(i) + k)));
          if (number == numbers.end()) continue;
          const Point before = key(at(begin(i) + (k + size - 1) % size)),
                      next = key(at(begin(i) + (k + 1) % size));
          found[run].push_back({i, begin(i) + k, number->second, Hash()(next) - Hash()(before)});
        }
      }
    });
    return joined(found);
  }

  // Moves polygons up to each other.
  void close_up() {
    std::size_t to = 0;
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
      const std::size_t from = begin(i);
      cells_.offsets[i] = static_cast<std::int32_t>(to);
      for (std::size_t k = 2 * from; k < 2 * (from + static_cast<std::size_t>(sizes_[i])); ++k)
        cells_.vertices[2 * to + (k - 2 * from)] = cells_.vertices[k];
      to += static_cast<std::size_t>(sizes_[i]);
    }
    cells_.offsets.back() = static_cast<std::int32_t>(to);
    cells_.vertices.resize(2 * to);
  }

  host::Runtime* runtime_;
  const double* sites_;
  std::vector<Point> fixed_;
  std::array<double, 2> period_;
  Cells& cells_;
  double reach_ = 0;
  std::vector<std::int32_t> sizes_;
  std::vector<Edge> edges_;
  std::unordered_map<Point, Point, Hash, Same> moves_;
};

}  // namespace

void mend(host::Runtime& runtime, const double* sites, const std::vector<double>& fixed,
          const std::array<double, 2>& period, Cells& cells) {
  Mender(runtime, sites, fixed, period, cells).run();
}

void mend_centres(host::Runtime& runtime, const std::vector<double>& sites,
                  const std::vector<std::int32_t>& offsets, const std::vector<std::int32_t>& corners,
                  const std::vector<std::uint8_t>& unbounded, std::vector<double>& centres) {
  Cells cells{{0}, {}};
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    const auto first = corners.begin() + offsets[i], end = corners.begin() + offsets[i + 1];
    for (auto c = first; unbounded[i] == 0 && c < end; ++c) {
      const auto at = centres.begin() + 2 * static_cast<std::ptrdiff_t>(*c);
      cells.vertices.insert(cells.vertices.end(), at, at + 2);
    }
    cells.offsets.push_back(static_cast<std::int32_t>(cells.vertices.size() / 2));
  }
  Mender mender(runtime, sites.data(), {}, kNoPeriod, cells);
  mender.run();
  for (std::size_t c = 0; c < centres.size(); c += 2) {
    const Point to = mender.moved({centres[c], centres[c + 1]});
    centres[c] = to.x;
    centres[c + 1] = to.y;
  }
}

}  // namespace flaunay::voronoi
