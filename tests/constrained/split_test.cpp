// Splitting segments where they cross: everything against the definition in rational numbers, without any
// shared code.
#include "constrained/crossings/split.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/constrained/check.hpp"
#include "tests/constrained/native.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/integer_points.hpp"

namespace flaunay::testing {
namespace {

using constrained::Split;
using constrained::split;
using Offsets = std::vector<std::size_t>;

struct Spot {
  mpq_class x, y;
  bool operator<(const Spot& other) const { return x != other.x ? x < other.x : y < other.y; }
  bool operator==(const Spot& other) const { return x == other.x && y == other.y; }
};

mpq_class power(int exponent) {
  mpq_class result = 1;
  if (exponent >= 0) {
    result <<= static_cast<mp_bitcnt_t>(exponent);
  } else {
    result >>= static_cast<mp_bitcnt_t>(-exponent);
  }
  return result;
}

// floor(log2 |value|)
int exponent_of(const mpq_class& value) {
  const mpq_class magnitude = abs(value);
  int exponent = static_cast<int>(mpz_sizeinbase(magnitude.get_num_mpz_t(), 2)) -
                 static_cast<int>(mpz_sizeinbase(magnitude.get_den_mpz_t(), 2));
  while (power(exponent) > magnitude) --exponent;
  while (power(exponent + 1) <= magnitude) ++exponent;
  return exponent;
}

// To the nearest multiple of the unit with at most 53 bits; half way to the even one.
mpq_class rounded(const mpq_class& value, const mpq_class& unit) {
  if (value == 0) return 0;
  const mpq_class spacing = std::max(power(exponent_of(value) - 52), unit);
  const mpq_class ratio = value / spacing;
  mpz_class below;
  mpz_fdiv_q(below.get_mpz_t(), ratio.get_num_mpz_t(), ratio.get_den_mpz_t());
  const mpq_class rest = ratio - below, half(1, 2);
  const bool up = rest > half || (rest == half && mpz_odd_p(below.get_mpz_t()) != 0);
  return mpq_class(below + (up ? 1 : 0)) * spacing;
}

mpq_class turn(const Spot& a, const Spot& b, const Spot& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The definition, for one set. Polylines have all points on them.
class Reference {
 public:
  Reference(const Coordinates& points, const Segments& segments) {
    mpq_class largest;
    for (std::size_t i = 0; i < points.size(); i += 2) {
      known_.insert({points[i], points[i + 1]});
      largest =
          std::max({largest, mpq_class(abs(mpq_class(points[i]))), mpq_class(abs(mpq_class(points[i + 1])))});
    }
    unit_ = largest == 0 ? power(-1074) : power(std::max(exponent_of(largest) - 504, -1074));
    for (std::size_t s = 0; s < segments.size(); s += 2) {
      Spot a = spot(points, segments[s]), b = spot(points, segments[s + 1]);
      if (b < a) std::swap(a, b);
      lines_.push_back(refined({a, b}));
    }
    if (!find_places()) return;
    straight_ = true;
    const std::vector<std::vector<Spot>> whole = lines_;
    for (auto& line : lines_) line = led(line);
    if (!parts_cross()) return;
    is_snapped = true;
    straight_ = false;
    lines_ = whole;
    for (auto& line : lines_) line = led(line);
    EXPECT_FALSE(parts_cross());
  }

  // Of a polyline, with all points on it.
  std::vector<Spot> refined(const std::vector<Spot>& line) const {
    std::vector<Spot> result(1, line[0]);
    for (std::size_t k = 1; k < line.size(); ++k) {
      const Spot &a = line[k - 1], &b = line[k];
      if (a == b) continue;
      std::vector<Spot> on;
      for (const Spot& p : known_) {
        if (std::min(a, b) < p && p < std::max(a, b) && turn(a, b, p) == 0) on.push_back(p);
      }
      if (b < a) std::reverse(on.begin(), on.end());
      result.insert(result.end(), on.begin(), on.end());
      result.push_back(b);
    }
    return result;
  }

  const std::vector<std::vector<Spot>>& lines() const { return lines_; }
  const mpq_class& unit() const { return unit_; }

  bool has_crossings() const { return crossings != 0; }

  bool is_snapped = false;
  std::size_t crossings = 0;  // of edges
  std::vector<Spot> added;

 private:
  struct Crossing {
    mpq_class along;
    Spot place;
    bool operator<(const Crossing& other) const { return along < other.along; }
  };

  static Spot spot(const Coordinates& points, std::int32_t i) { return {points[2 * i], points[2 * i + 1]}; }

  static bool cross(const Spot& a, const Spot& b, const Spot& c, const Spot& d) {
    return sgn(turn(c, d, a)) * sgn(turn(c, d, b)) < 0 && sgn(turn(a, b, c)) * sgn(turn(a, b, d)) < 0;
  }

  // Finds where edges cross. Returns whether they do.
  bool find_places() {
    for (const auto& line : lines_) {
      for (std::size_t k = 1; k < line.size(); ++k) edges_[std::minmax(line[k - 1], line[k])];
    }
    std::set<Spot> places;
    for (auto e = edges_.begin(); e != edges_.end(); ++e) {
      for (auto f = edges_.begin(); f != e; ++f) {
        const auto& [a, b] = e->first;
        const auto& [c, d] = f->first;
        if (!cross(a, b, c, d)) continue;
        ++crossings;
        const mpq_class ca = turn(c, d, a), cb = turn(c, d, b), ac = turn(a, b, c), ad = turn(a, b, d);
        const mpq_class t = ca / (ca - cb);
        const Spot place{rounded(a.x + t * (b.x - a.x), unit_), rounded(a.y + t * (b.y - a.y), unit_)};
        places.insert(place);
        e->second.push_back({t, place});
        f->second.push_back({ac / (ac - ad), place});
      }
    }
    for (const Spot& place : places) {
      if (known_.insert(place).second) added.push_back(place);
    }
    for (auto& [edge, crossed] : edges_) std::sort(crossed.begin(), crossed.end());
    return !places.empty();
  }

  // Leads the edges of a polyline through vertices.
  std::vector<Spot> led(const std::vector<Spot>& line) const {
    std::vector<Spot> result(1, line[0]);
    for (std::size_t k = 1; k < line.size(); ++k) {
      const auto ends = std::minmax(line[k - 1], line[k]);
      std::vector<Spot> chain;
      if (straight_) {
        for (const Crossing& c : edges_.at(ends)) chain.push_back(c.place);
      } else {
        chain = snapped(ends.first, ends.second);
      }
      if (line[k] < line[k - 1]) std::reverse(chain.begin(), chain.end());
      result.insert(result.end(), chain.begin(), chain.end());
      result.push_back(line[k]);
    }
    return refined(result);
  }

  bool parts_cross() const {
    std::set<std::pair<Spot, Spot>> parts;
    for (const auto& line : lines_) {
      for (std::size_t k = 1; k < line.size(); ++k) parts.insert(std::minmax(line[k - 1], line[k]));
    }
    for (auto p = parts.begin(); p != parts.end(); ++p) {
      for (auto q = parts.begin(); q != p; ++q) {
        if (cross(p->first, p->second, q->first, q->second)) return true;
      }
    }
    return false;
  }

  // What is rounded to a coordinate.
  struct Cell {
    mpq_class low, high;
    bool is_closed;
  };
  Cell cell(const mpq_class& value) const {
    const double number = value.get_d();
    const mpq_class above = std::max(mpq_class(mpq_class(std::nextafter(number, HUGE_VAL)) - value), unit_);
    const mpq_class below = std::max(mpq_class(value - mpq_class(std::nextafter(number, -HUGE_VAL))), unit_);
    const mpq_class low = value - below / 2, high = value + above / 2;
    return {low, high, rounded(low, unit_) == value && rounded(high, unit_) == value};
  }

  // Whether an edge has a place that is rounded to a vertex: a part of it from a + t (b - a) on.
  bool meets_cell(const Spot& a, const Spot& b, const Spot& vertex) const {
    mpq_class first = 0, last = 1;
    bool has_first = true, has_last = true;
    const auto clip = [&](const mpq_class& from, const mpq_class& to, const Cell& cell) {
      if (from == to) {
        const bool is_in =
            cell.is_closed ? cell.low <= from && from <= cell.high : cell.low < from && from < cell.high;
        if (!is_in) last = -1;
        return;
      }
      mpq_class begin = (cell.low - from) / (to - from), end = (cell.high - from) / (to - from);
      if (end < begin) std::swap(begin, end);
      if (begin > first) has_first = cell.is_closed;
      if (begin == first) has_first = has_first && cell.is_closed;
      if (end < last) has_last = cell.is_closed;
      if (end == last) has_last = has_last && cell.is_closed;
      first = std::max(first, begin);
      last = std::min(last, end);
    };
    clip(a.x, b.x, cell(vertex.x));
    clip(a.y, b.y, cell(vertex.y));
    return first < last || (first == last && has_first && has_last);
  }

  std::vector<Spot> snapped(const Spot& a, const Spot& b) const {
    std::vector<Spot> chain, beside;
    const bool descends = b.y < a.y;
    const auto ahead = [descends](const Spot& p, const Spot& q) {
      return p.x != q.x ? p.x < q.x : descends ? p.y > q.y : p.y < q.y;
    };
    for (const Spot& v : known_) {
      if (v == a || v == b) continue;
      if (meets_cell(a, b, v)) {
        chain.push_back(v);
      } else if (!ahead(v, a) && !ahead(b, v)) {
        beside.push_back(v);
      }
    }
    std::sort(chain.begin(), chain.end(), ahead);
    chain.insert(chain.begin(), a);
    chain.push_back(b);
    // As long as a vertex is on the wrong side of a part, the farthest one becomes a vertex of the chain.
    for (bool is_right = false; !is_right;) {
      is_right = true;
      for (std::size_t k = 1; k < chain.size() && is_right; ++k) {
        const Spot *farthest = nullptr, &from = chain[k - 1], &to = chain[k];
        for (const Spot& v : beside) {
          if (!ahead(from, v) || !ahead(v, to)) continue;
          const mpq_class side = turn(from, to, v);
          if (sgn(side) * sgn(turn(a, b, v)) >= 0) continue;
          if (farthest == nullptr || abs(side) > abs(mpq_class(turn(from, to, *farthest)))) farthest = &v;
        }
        if (farthest != nullptr) {
          is_right = false;
          ++turns_;
          chain.insert(chain.begin() + static_cast<std::ptrdiff_t>(k), Spot(*farthest));
        }
      }
    }
    return {chain.begin() + 1, chain.end() - 1};
  }

 public:
  int turns() const { return turns_; }

 private:
  bool straight_ = true;
  mutable int turns_ = 0;  // vertices around which edges go
  std::map<std::pair<Spot, Spot>, std::vector<Crossing>> edges_;
  std::set<Spot> known_;
  std::vector<std::vector<Spot>> lines_;
  mpq_class unit_;
};

// Whether a point is at most so far from a segment, in each coordinate.
bool is_near(const Spot& p, const Spot& a, const Spot& b, const mpq_class& distance) {
  mpq_class low = 0, high = 1;
  const auto clip = [&](const mpq_class& from, const mpq_class& to, const mpq_class& at) {
    if (from == to) {
      if (abs(mpq_class(at - from)) > distance) high = -1;
      return;
    }
    mpq_class first = (at - distance - from) / (to - from), last = (at + distance - from) / (to - from);
    if (last < first) std::swap(first, last);
    low = std::max(low, first);
    high = std::min(high, last);
  };
  clip(a.x, b.x, p.x);
  clip(a.y, b.y, p.y);
  return low <= high;
}

// What a set of a result has, by itself.
struct SetResult {
  std::vector<Spot> added;
  std::vector<std::vector<Spot>> lines;
};

// Of a segment, its pieces without their directions, which are its own.
Segments pieces_of(const Coordinates& points, const Split& result, const Segments& segments, std::size_t s) {
  const auto place = [&points](std::int32_t i) {
    return std::make_pair(points[2 * static_cast<std::size_t>(i)],
                          points[2 * static_cast<std::size_t>(i) + 1]);
  };
  Segments pieces(result.pieces.begin() + 2 * result.piece_offsets[s],
                  result.pieces.begin() + 2 * result.piece_offsets[s + 1]);
  if (place(segments[2 * s + 1]) < place(segments[2 * s])) {
    for (std::size_t k = 0; k < pieces.size(); k += 2) std::swap(pieces[k], pieces[k + 1]);
  }
  return pieces;
}

std::vector<Spot> polyline(const Coordinates& points, const Split& result, const Segments& segments,
                           std::size_t s) {
  const auto spot = [&](std::int32_t i) -> Spot {
    const auto k = static_cast<std::size_t>(i), n = points.size() / 2;
    const double* p = k < n ? &points[2 * k] : &result.added_points[2 * (k - n)];
    return {p[0], p[1]};
  };
  std::vector<Spot> line;
  const Segments pieces = pieces_of(points, result, segments, s);
  for (std::size_t p = 0; p < pieces.size(); p += 2) {
    const Spot a = spot(pieces[p]), b = spot(pieces[p + 1]);
    if (line.empty()) line.push_back(a);
    EXPECT_TRUE(line.back() == a) << "a gap in segment " << s;
    line.push_back(b);
  }
  return line;
}

// What the cases of a test were.
struct Tally {
  std::size_t crossings = 0;
  int snapped = 0, turns = 0;
};

// Splits the segments of one set, and compares with the definition. Returns whether anything was split.
bool expect_split(const Coordinates& points, const Segments& segments, Tally* tally = nullptr) {
  const Split result = split(points.data(), {0, points.size() / 2}, segments);
  const Reference reference(points, segments);
  EXPECT_EQ(result.is_snapped, reference.is_snapped);
  if (tally != nullptr) {
    tally->crossings += reference.crossings;
    tally->snapped += reference.is_snapped ? 1 : 0;
    tally->turns += reference.turns();
  }
  std::vector<Spot> added;
  for (std::size_t k = 0; k < result.added_points.size(); k += 2) {
    added.push_back({result.added_points[k], result.added_points[k + 1]});
    EXPECT_FALSE(std::signbit(result.added_points[k]) && result.added_points[k] == 0);
  }
  EXPECT_TRUE(added == reference.added)
      << added.size() << " added, " << reference.added.size() << " expected";
  EXPECT_EQ(result.added_offsets, (Offsets{0, added.size()}));

  mpq_class largest = 0;
  for (const double c : points) largest = std::max(largest, mpq_class(abs(mpq_class(c))));
  const mpq_class step = std::max(mpq_class(largest * power(-53)), power(-1075));
  for (std::size_t s = 0; s < segments.size() / 2; ++s) {
    const std::vector<Spot> line = polyline(points, result, segments, s);
    EXPECT_TRUE(reference.refined(line) == reference.lines()[s]) << "segment " << s;
    for (const Spot& p : line) {
      EXPECT_TRUE(is_near(p, line.front(), line.back(), step)) << "segment " << s;
    }
    if (line.size() > 2) {
      EXPECT_TRUE(reference.has_crossings());
    }
  }
  return reference.has_crossings();
}

// That the triangulation with the pieces as constraints is right.
void expect_triangulation(const Coordinates& points, const Offsets& offsets, const Segments& segments) {
  const Split result = split(points.data(), offsets, segments);
  const constrained::AllPoints all = constrained::join_added(points.data(), offsets, result);
  Segments pieces;
  for (const std::int32_t i : result.pieces) pieces.push_back(all.place[i]);
  const Triangulation delaunay = delaunay_of(all.coordinates, all.offsets);
  const ConstrainedTriangulation triangulation = insert(all.coordinates, all.offsets, delaunay, pieces);
  expect_edges(expected_edges(all.coordinates, all.offsets, delaunay, pieces), triangulation);
  expect_canonical(all.coordinates, delaunay, triangulation);
}

Coordinates random_points(FixtureRandom& random, std::size_t n, double scale) {
  Coordinates points;
  for (std::size_t i = 0; i < 2 * n; ++i) points.push_back((random.unit() - 0.5) * scale);
  return points;
}

TEST(SmallSplit, RandomSegmentsInSmallBoxes) {
  FixtureRandom random(1);
  Tally tally;
  for (int round = 0; round < 600; ++round) {
    SCOPED_TRACE(round);
    const auto n = static_cast<std::size_t>(random.integer(2, 14));
    const Coordinates points =
        random_integer_points(n, static_cast<int>(random.integer(2, 9)), static_cast<std::uint64_t>(round));
    const Segments segments = random_segments(random, n, static_cast<std::size_t>(random.integer(0, 12)));
    expect_split(points, segments, &tally);
    expect_triangulation(points, {0, n}, segments);
    if (HasFailure()) return;
  }
  EXPECT_GT(tally.crossings, 500u);
}

TEST(SmallSplit, RandomSegments) {
  FixtureRandom random(2);
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE(round);
    const std::size_t n = 24;
    const Coordinates points = random_points(random, n, 1);
    const Segments segments = random_segments(random, n, 20);
    expect_split(points, segments);
    expect_triangulation(points, {0, n}, segments);
    if (HasFailure()) return;
  }
}

// So near to each other that rounding moves pieces across each other, again and again.
TEST(SmallSplit, NearlyParallel) {
  FixtureRandom random(3);
  Tally tally;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    // Ends on two small grids of the finest coordinates there are.
    const int side = static_cast<int>(random.integer(2, 8));
    Coordinates points;
    Segments segments;
    for (std::int32_t s = 0; s < 8; ++s) {
      for (const double place : {1.0, 1.0 + 0x1p-46}) {
        points.push_back(place + static_cast<double>(random.integer(0, side)) * 0x1p-52);
        points.push_back(place + static_cast<double>(random.integer(0, side)) * 0x1p-52);
      }
      segments.insert(segments.end(), {2 * s, 2 * s + 1});
    }
    expect_split(points, segments, &tally);
    expect_triangulation(points, {0, points.size() / 2}, segments);
    if (HasFailure()) return;
  }
  EXPECT_GE(tally.snapped, 10);
}

// All coordinates are large integers, so crossings are rounded to a coarse grid.
TEST(SmallSplit, CoarseGrid) {
  FixtureRandom random(4);
  Tally tally;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const std::size_t n = 16;
    Coordinates points;
    for (std::size_t i = 0; i < 2 * n; ++i) {
      points.push_back(0x1p52 + static_cast<double>(random.integer(0, 60)));
    }
    const Segments segments = random_segments(random, n, 16);
    expect_split(points, segments, &tally);
    expect_triangulation(points, {0, n}, segments);
    if (HasFailure()) return;
  }
  EXPECT_GE(tally.snapped, 3);
}

// Long segments move by more than the size of short ones near the origin, where doubles are dense. So their
// chords would pass these on the wrong side, although they do not meet the cells of their ends.
TEST(SmallSplit, UnevenGrid) {
  FixtureRandom random(10);
  Tally tally;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    Coordinates points;
    const auto add = [&points](double x, double y) { points.insert(points.end(), {x, y}); };
    const auto tiny = [&random](int exponent) { return std::ldexp(random.unit() - 0.5, exponent); };
    for (int k = 0; k < 12; ++k) {
      const double near_x = tiny(-50), near_y = tiny(-53);
      add(near_x, near_y);
      add(near_x + tiny(-56), near_y + tiny(-56));
    }
    const double far = 1 + random.unit(), slope = round % 4 < 2 ? 0 : random.unit() - 0.5;
    add(-far, -far * slope);
    add(far, far * slope + tiny(-53));
    for (const double x : {-0.75, 0.75}) {
      add(x, -1 - random.unit());
      add(x + 0.1 * random.unit(), 1 + random.unit());
    }
    if (round % 2 != 0) {
      for (std::size_t i = 0; i < points.size(); i += 2) std::swap(points[i], points[i + 1]);
    }
    Segments segments;
    for (std::int32_t s = 0; s < static_cast<std::int32_t>(points.size() / 4); ++s) {
      segments.insert(segments.end(), {2 * s, 2 * s + 1});
    }
    expect_split(points, segments, &tally);
    expect_triangulation(points, {0, points.size() / 2}, segments);
    if (HasFailure()) return;
  }
  EXPECT_GE(tally.snapped, 5);
  EXPECT_GE(tally.turns, 5);
}

// Segments between points that are rounded onto one line: they overlap but for that.
TEST(SmallSplit, NearlyOnOneLine) {
  FixtureRandom random(11);
  Tally tally;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const auto n = static_cast<std::size_t>(random.integer(6, 12));
    const double slope = 1 / static_cast<double>(random.integer(3, 9));
    Coordinates points;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = random.unit();
      points.insert(points.end(), {x, x * slope});
    }
    const Segments segments = random_segments(random, n, 8);
    expect_split(points, segments, &tally);
    expect_triangulation(points, {0, n}, segments);
    if (HasFailure()) return;
  }
  EXPECT_GE(tally.snapped, 3);
}

// Segments (0, i h) to (1, (k - i) h), which all cross within a few units in the last place of each other.
struct Pencil {
  explicit Pencil(std::int32_t k) {
    for (std::int32_t i = 0; i < k; ++i) {
      points.insert(points.end(), {0, i * 1e-13, 1, (k - i) * 1e-13});
      segments.insert(segments.end(), {2 * i, 2 * i + 1});
    }
  }
  Coordinates points;
  Segments segments;
};

TEST(SmallSplit, Pencils) {
  for (const std::int32_t k : {5, 12, 20}) {
    SCOPED_TRACE(k);
    const Pencil pencil(k);
    expect_split(pencil.points, pencil.segments);
    expect_triangulation(pencil.points, {0, pencil.points.size() / 2}, pencil.segments);
  }
}

// Segments that all go through nearly one place, or through one, which is a point or is not.
TEST(SmallSplit, Stars) {
  FixtureRandom random(5);
  for (const double shift : {0.0, 0x1p-50, 0.01}) {
    for (const bool with_centre : {false, true}) {
      SCOPED_TRACE(shift);
      Coordinates points;
      Segments segments;
      for (std::int32_t s = 0; s < 12; ++s) {
        const double x = static_cast<double>(random.integer(-64, 64)), y = 1 + static_cast<double>(s);
        points.insert(points.end(), {x + shift * random.unit(), y, -x, -y + shift * random.unit()});
        segments.insert(segments.end(), {2 * s + s % 2, 2 * s + 1 - s % 2});
      }
      if (with_centre) points.insert(points.end(), {0, 0});
      EXPECT_EQ(expect_split(points, segments), !with_centre || shift != 0);
      expect_triangulation(points, {0, points.size() / 2}, segments);
    }
  }
}

TEST(SmallSplit, GridsOfLines) {
  for (const double factor : {1.0, 1.0 / 3}) {
    Coordinates points;
    Segments segments;
    for (std::int32_t s = 0; s < 10; ++s) {
      const double at = factor * s;
      points.insert(points.end(), {at, -factor, at, 11 * factor, -factor, at, 11 * factor, at});
      segments.insert(segments.end(), {4 * s, 4 * s + 1, 4 * s + 2, 4 * s + 3});
    }
    EXPECT_TRUE(expect_split(points, segments));
    const Split result = split(points.data(), {0, points.size() / 2}, segments);
    EXPECT_EQ(result.added_points.size(), 200u);
    EXPECT_EQ(result.pieces.size(), 2 * 2 * 110u);
    expect_triangulation(points, {0, points.size() / 2}, segments);
  }
}

TEST(SmallSplit, AllMagnitudes) {
  FixtureRandom random(6);
  for (const double factor :
       {0x1p-1074, 0x1p-1070, 0x1p-1040, 0x1p-1020, 0x1p-600, 0x1p-504, 0x1p-255, 0x1p600, 0x1p1019}) {
    SCOPED_TRACE(factor);
    for (int round = 0; round < 10; ++round) {
      Coordinates points =
          scaled(random_integer_points(16, 4 + round % 2 * 5, static_cast<std::uint64_t>(round)), factor);
      // Beside these, crossings are rounded to multiples of the smallest factors.
      if (factor == 0x1p-504) points.insert(points.end(), {1, 0, 0, 1});
      const Segments segments = random_segments(random, 16, 12);
      expect_split(points, segments);
      expect_triangulation(points, {0, points.size() / 2}, segments);
      if (HasFailure()) return;
    }
  }
  // Numbers of few bits, where the distance of doubles is not that of their magnitudes.
  expect_split(scaled({4, 4, 5, 0, 3, 7, 3, 6}, 0x1p-1074), {2, 1, 3, 0, 0, 2});
  for (int round = 0; round < 400; ++round) {
    SCOPED_TRACE(round);
    const Coordinates points =
        scaled(random_integer_points(6, 3 + round % 7, static_cast<std::uint64_t>(round)), 0x1p-1074);
    expect_split(points, random_segments(random, 6, 4));
    if (HasFailure()) return;
  }
  // Points of very different magnitudes, and crossings much nearer to zero than they are.
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE(round);
    Coordinates points;
    for (int i = 0; i < 24; ++i) {
      const double scale = std::ldexp(1, static_cast<int>(random.integer(-220, 220)));
      points.insert(points.end(), {(random.unit() - 0.5) * scale, (random.unit() - 0.5) * scale});
    }
    points.insert(points.end(),
                  {-0x1p230, -0x1.8p230, 0x1p230, 0x1.8p230, -0x1p230, 0x1p230, 0x1.8p230, -0x1.8p230});
    Segments segments = random_segments(random, 24, 10);
    segments.insert(segments.end(), {24, 25, 26, 27});
    expect_split(points, segments);
    expect_triangulation(points, {0, 28}, segments);
    if (HasFailure()) return;
  }
}

// Segments that overlap, with crossings on what they have in common, and points on them.
TEST(SmallSplit, OverlapsAndTouches) {
  FixtureRandom random(7);
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    Coordinates points;
    for (int i = 0; i < 12; ++i) {
      const double t = static_cast<double>(random.integer(0, 12));
      points.insert(points.end(), {3 * t, 2 * t});
    }
    for (int i = 0; i < 8; ++i) {
      points.insert(points.end(),
                    {static_cast<double>(random.integer(0, 36)), static_cast<double>(random.integer(0, 24))});
    }
    Segments segments;
    for (int s = 0; s < 8; ++s) {
      const int first = s < 4 ? 0 : 12, last = s < 4 ? 11 : 19;
      segments.push_back(static_cast<std::int32_t>(random.integer(first, last)));
      segments.push_back(static_cast<std::int32_t>(random.integer(first, last)));
    }
    expect_split(points, segments);
    expect_triangulation(points, {0, 20}, segments);
    if (HasFailure()) return;
  }
}

TEST(SmallSplit, DoesNotDependOnTheOrderOfSegments) {
  FixtureRandom random(8);
  for (int round = 0; round < 30; ++round) {
    const Coordinates points = random_points(random, 60, 1);
    const Segments segments = random_segments(random, 60, 60);
    const Split expected = split(points.data(), {0, 60}, segments);
    std::vector<std::size_t> order;
    for (std::size_t s = 0; s < segments.size() / 2; ++s) order.push_back(s);
    random.shuffle(order);
    Segments others;
    for (const std::size_t s : order) {
      const auto turned = static_cast<std::size_t>(random.integer(0, 1));
      others.insert(others.end(), {segments[2 * s + turned], segments[2 * s + 1 - turned]});
    }
    const Split result = split(points.data(), {0, 60}, others);
    EXPECT_EQ(result.added_points, expected.added_points);
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (segments[2 * order[k]] != segments[2 * order[k] + 1]) {
        EXPECT_EQ(pieces_of(points, result, others, k), pieces_of(points, expected, segments, order[k]));
      }
    }
  }
}

// Several sets in one call: as each on its own, whatever the magnitudes of the others.
TEST(SmallSplit, SeveralSets) {
  FixtureRandom random(9);
  Coordinates points;
  Offsets offsets = {0};
  std::vector<Coordinates> sets;
  std::vector<Segments> segments_of;
  for (int s = 0; s < 20; ++s) {
    const auto n = static_cast<std::size_t>(random.integer(0, 14));
    Coordinates set =
        scaled(random_integer_points(n, 9, 100 + static_cast<std::uint64_t>(s)), s % 3 == 0   ? 0x1p-400
                                                                                 : s % 3 == 1 ? 1
                                                                                              : 0x1p400);
    sets.push_back(set);
    segments_of.push_back(s % 4 == 0 ? Segments{} : random_segments(random, n, 9));
    points.insert(points.end(), set.begin(), set.end());
    offsets.push_back(points.size() / 2);
  }
  // Segments of all sets in turns.
  Segments segments;
  std::vector<std::pair<std::size_t, std::size_t>> origin;
  for (std::size_t k = 0; k < 9; ++k) {
    for (std::size_t s = 0; s < sets.size(); ++s) {
      if (2 * k >= segments_of[s].size()) continue;
      for (const std::size_t end : {2 * k, 2 * k + 1}) {
        segments.push_back(static_cast<std::int32_t>(offsets[s]) + segments_of[s][end]);
      }
      origin.emplace_back(s, k);
    }
  }
  const Split result = split(points.data(), offsets, segments);
  ASSERT_EQ(result.added_offsets.size(), offsets.size());
  std::vector<Split> alone;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    alone.push_back(split(sets[s].data(), {0, sets[s].size() / 2}, segments_of[s]));
    const auto added = result.added_points.begin();
    EXPECT_EQ(Coordinates(added + static_cast<std::ptrdiff_t>(2 * result.added_offsets[s]),
                          added + static_cast<std::ptrdiff_t>(2 * result.added_offsets[s + 1])),
              alone[s].added_points);
  }
  const auto n = static_cast<std::int32_t>(offsets.back());
  for (std::size_t k = 0; k < origin.size(); ++k) {
    const auto [s, own] = origin[k];
    const Split& other = alone[s];
    const auto own_n = static_cast<std::int32_t>(sets[s].size() / 2);
    Segments expected;
    for (std::int32_t p = 2 * other.piece_offsets[own]; p < 2 * other.piece_offsets[own + 1]; ++p) {
      const std::int32_t v = other.pieces[p];
      expected.push_back(v < own_n ? static_cast<std::int32_t>(offsets[s]) + v
                                   : n + static_cast<std::int32_t>(result.added_offsets[s]) + v - own_n);
    }
    EXPECT_EQ(Segments(result.pieces.begin() + 2 * result.piece_offsets[k],
                       result.pieces.begin() + 2 * result.piece_offsets[k + 1]),
              expected);
  }
  expect_triangulation(points, offsets, segments);
}

TEST(SmallSplit, Errors) {
  const Coordinates points = {0, 0, 4, 4, 0, 4, 4, 0, 1, 0, 1, 4, 8, 8};
  const auto message = [&points](const Segments& segments, const constrained::SplitLimits& limits) {
    return error_of(ErrorKind::input, [&] {
      split(points.data(), {0, points.size() / 2}, segments, limits);
    });
  };
  EXPECT_EQ(message({2, 3, 0, 1, 4, 5}, {8}),
            "splitting segments makes more than 8 pieces, for which memory or 32-bit indices do not suffice");
  EXPECT_EQ(message({2, 3, 0, 1, 4, 5}, {9}), "no error");
  // How many more there may be is asked once, and only if it matters.
  int asked = 0;
  const auto up_to = [&asked](std::size_t most) { return [&asked, most] { return ++asked, most; }; };
  EXPECT_EQ(message({2, 3, 0, 1, 4, 5}, {9, up_to(0)}), "no error");
  EXPECT_EQ(asked, 0);
  EXPECT_EQ(message({2, 3, 0, 1, 4, 5}, {2, up_to(9)}), "no error");
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(message({2, 3, 0, 1, 4, 5}, {2, up_to(8)}), message({2, 3, 0, 1, 4, 5}, {8}));
}

// What must not take a square number of steps: one segment across many, a grid of lines, parallel lines, a
// bundle of segments through nearly one place, and rays and segments that overlap without crossings.
TEST(Split, ManySegments) {
  const std::int32_t n = 30000;
  const auto run = [](const Coordinates& points, const Segments& segments) {
    return split(points.data(), {0, points.size() / 2}, segments);
  };
  Coordinates comb = {-1, 0.125, n + 1.0, 0.375}, parallel, star = {0, 0};
  Segments across = {0, 1}, lines, rays;
  for (std::int32_t i = 0; i < n; ++i) {
    comb.insert(comb.end(), {double(i), -1 - i % 7 * 0.25, i + 0.25, 1 + i % 5 * 0.25});
    across.insert(across.end(), {2 * i + 2, 2 * i + 3});
    parallel.insert(parallel.end(), {double(i), 0, n + double(i), n * 1.0});
    lines.insert(lines.end(), {2 * i, 2 * i + 1});
    const double angle = 2 * M_PI * i / n;
    star.insert(star.end(), {std::cos(angle), std::sin(angle)});
    rays.insert(rays.end(), {0, i + 1});
  }
  const Split combed = run(comb, across);
  EXPECT_EQ(combed.added_points.size(), 2 * static_cast<std::size_t>(n));
  EXPECT_EQ(combed.piece_offsets[1], n + 1);
  EXPECT_TRUE(run(parallel, lines).added_points.empty());
  EXPECT_TRUE(run(star, rays).added_points.empty());
  // Diameters through a point, and the same without it.
  Segments diameters;
  for (std::int32_t i = 0; i < n / 2; ++i) {
    for (const std::size_t k : {0, 1}) star[2 * (n / 2 + i + 1) + k] = -star[2 * (i + 1) + k];
    diameters.insert(diameters.end(), {i + 1, n / 2 + i + 1});
  }
  EXPECT_TRUE(run(star, diameters).added_points.empty());
  Segments few(diameters.begin(), diameters.begin() + 2000);
  const Split through = run(Coordinates(star.begin() + 2, star.end()), [&few] {
    Segments shifted = few;
    for (std::int32_t& v : shifted) --v;
    return shifted;
  }());
  EXPECT_EQ(through.added_points, (Coordinates{0, 0}));
}

TEST(Split, LargePencils) {
  for (const std::int32_t k : {100, 400}) {
    SCOPED_TRACE(k);
    const Pencil pencil(k);
    expect_triangulation(pencil.points, {0, pencil.points.size() / 2}, pencil.segments);
  }
}

// So many segments cross at a few places that their pairs cannot be listed.
TEST(Split, LargeStars) {
  const std::int32_t stars = 5, rays = 4000;
  Coordinates points, centres;
  Segments segments;
  for (std::int32_t star = 0; star < stars; ++star) {
    const double centre = 8.0 * star;
    centres.insert(centres.end(), {centre, 0});
    for (std::int32_t ray = 0; ray < rays; ++ray) {
      const double x = 1 - std::ldexp(ray, -12), y = 1.5;
      points.insert(points.end(), {centre + x, y, centre - x, -y});
      segments.insert(segments.end(), {2 * (rays * star + ray), 2 * (rays * star + ray) + 1});
    }
  }
  const Split result = split(points.data(), {0, points.size() / 2}, segments);
  EXPECT_EQ(result.added_points, centres);
  EXPECT_EQ(result.pieces.size(), 2 * segments.size());
}

TEST(Split, LargeGrid) {
  Coordinates points;
  Segments segments;
  for (std::int32_t s = 0; s < 500; ++s) {
    points.insert(points.end(), {double(s), -1, double(s), 500, -1, double(s), 500, double(s)});
    segments.insert(segments.end(), {4 * s, 4 * s + 1, 4 * s + 2, 4 * s + 3});
  }
  const Split result = split(points.data(), {0, points.size() / 2}, segments);
  EXPECT_EQ(result.added_points.size(), 500000u);
  EXPECT_FALSE(result.is_snapped);
}

}  // namespace
}  // namespace flaunay::testing
