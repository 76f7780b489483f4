#include "tests/support/reference.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

namespace flaunay::testing {
namespace {

__extension__ using Int128 = __int128;

template <typename Integer>
struct Point {
  Integer x, y;
};

template <typename Integer>
Integer cross(const Point<Integer>& o, const Point<Integer>& a, const Point<Integer>& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

template <typename Integer>
Integer dot(const Point<Integer>& o, const Point<Integer>& a, const Point<Integer>& b) {
  return (a.x - o.x) * (b.x - o.x) + (a.y - o.y) * (b.y - o.y);
}

template <typename Integer>
bool before(const Point<Integer>& a, const Point<Integer>& b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

/// The doubles as integers, all multiplied by the same power of two (which changes no predicate).
std::vector<mpz_class> scale_to_integers(const double* values, std::size_t count) {
  int smallest = std::numeric_limits<int>::max();
  for (std::size_t i = 0; i < count; ++i) {
    int exponent = 0;
    if (std::frexp(values[i], &exponent) != 0) smallest = std::min(smallest, exponent - 53);
  }
  std::vector<mpz_class> integers(count);
  mp_bitcnt_t trailing_zeros = std::numeric_limits<mp_bitcnt_t>::max();
  for (std::size_t i = 0; i < count; ++i) {
    int exponent = 0;
    const double fraction = std::frexp(values[i], &exponent);
    if (fraction == 0) continue;
    integers[i] = std::ldexp(fraction, 53);
    integers[i] <<= static_cast<mp_bitcnt_t>(exponent - 53 - smallest);
    trailing_zeros = std::min(trailing_zeros, mpz_scan1(integers[i].get_mpz_t(), 0));
  }
  for (mpz_class& integer : integers) {
    if (integer != 0) integer >>= trailing_zeros;
  }
  return integers;
}

/// A rounded number, and by how much at most it differs from the exact one.
struct Rounded {
  double value, error;
};

/// a b + c d, of numbers that are exact but for a rounding each, so their products too: at most 6 roundings
/// of 2^-53.
Rounded sum_of_products(double a, double b, double c, double d) {
  return {a * b + c * d, 0x1p-50 * (std::fabs(a * b) + std::fabs(c * d))};
}

/// a b - c d.
Rounded difference_of_products(Rounded a, Rounded b, Rounded c, Rounded d) {
  const auto error = [](Rounded u, Rounded v) {
    return std::fabs(u.value) * v.error + u.error * (std::fabs(v.value) + v.error) +
           0x1p-50 * std::fabs(u.value * v.value);
  };
  return {a.value * b.value - c.value * d.value, 1.01 * (error(a, b) + error(c, d))};
}

/// Triangulates distinct points; the triangles are in terms of their positions in the list.
template <typename Integer>
class CellWrapper {
 public:
  explicit CellWrapper(const std::vector<Point<Integer>>& points) : points_(points) {
    for (const Point<Integer>& p : points) rounded_.push_back({as_double(p.x), as_double(p.y)});
  }

  TriangleSet run() {
    if (points_.size() < 3) return {};
    // A hull edge: from the lexicographically smallest point to the one that has all others to its left, the
    // nearest if there are several.
    int a = 0;
    for (int i = 1; i < size(); ++i) {
      if (before(points_[i], points_[a])) a = i;
    }
    int b = a == 0 ? 1 : 0;
    for (int i = 0; i < size(); ++i) {
      if (i == a || i == b) continue;
      const Integer turn = cross<Integer>(points_[a], points_[b], points_[i]);
      if (turn < 0 || (turn == 0 && before(points_[i], points_[b]))) b = i;
    }
    std::vector<std::pair<int, int>> open{{a, b}};
    while (!open.empty()) {
      const auto edge = open.back();
      open.pop_back();
      if (done_.count(edge) != 0) continue;
      const std::vector<int> cell = cell_left_of(edge.first, edge.second);
      if (cell.empty()) continue;  // beyond the hull
      for (std::size_t i = 0; i < cell.size(); ++i) {
        const int u = cell[i], v = cell[(i + 1) % cell.size()];
        if (!done_.insert({u, v}).second) throw std::logic_error("reference_delaunay: an edge of two cells");
        open.push_back({v, u});
        if (i > 0 && i + 1 < cell.size()) triangles_.push_back({cell[0], u, v});
      }
    }
    return triangles_;
  }

 private:
  int size() const { return static_cast<int>(points_.size()); }

  /// All points on the empty circle through the Delaunay edge a b and a point to its left: counter-clockwise
  /// from the lexicographically smallest. Empty if there is no point to the left.
  std::vector<int> cell_left_of(int a, int b) const {
    // The circle through a, b and p has its centre on the bisector of a b, at a distance to the left that
    // grows with cot(angle a p b) = dot / cross. The empty circle is that of the smallest.
    std::vector<int> cell;
    Integer best_dot = 0, best_cross = 0;
    Rounded rounded_dot{}, rounded_cross{};
    const Point<double>&u = rounded_[a], &v = rounded_[b];
    for (int p = 0; p < size(); ++p) {
      // Most points are out of question by rounded numbers already; where these overflow, no comparison
      // holds.
      const double ux = u.x - rounded_[p].x, uy = u.y - rounded_[p].y;
      const double vx = v.x - rounded_[p].x, vy = v.y - rounded_[p].y;
      const Rounded about_cross = sum_of_products(ux, vy, -uy, vx),
                    about_dot = sum_of_products(ux, vx, uy, vy);
      if (about_cross.value < -about_cross.error) continue;
      if (!cell.empty()) {
        const Rounded about = difference_of_products(about_dot, rounded_cross, rounded_dot, about_cross);
        if (about_cross.value > about_cross.error && about.value > about.error) continue;
      }
      const Integer p_cross = cross<Integer>(points_[p], points_[a], points_[b]);
      if (p_cross <= 0) continue;
      const Integer p_dot = dot<Integer>(points_[p], points_[a], points_[b]);
      const Integer difference = p_dot * best_cross - best_dot * p_cross;
      if (cell.empty() || difference < 0) {
        cell.assign(1, p);
        best_dot = p_dot;
        best_cross = p_cross;
        rounded_dot = about_dot;
        rounded_cross = about_cross;
      } else if (difference == 0) {
        cell.push_back(p);
      }
    }
    if (cell.empty()) return cell;
    cell.push_back(a);
    cell.push_back(b);
    const auto smallest = std::min_element(cell.begin(), cell.end(),
                                           [this](int p, int q) { return before(points_[p], points_[q]); });
    std::iter_swap(cell.begin(), smallest);
    std::sort(cell.begin() + 1, cell.end(), [&](int p, int q) {  // no three points of a circle are collinear
      return cross<Integer>(points_[cell[0]], points_[p], points_[q]) > 0;
    });
    return cell;
  }

  static double as_double(const mpz_class& integer) { return integer.get_d(); }
  static double as_double(Int128 integer) { return static_cast<double>(integer); }

  const std::vector<Point<Integer>>& points_;
  std::vector<Point<double>> rounded_;  // the same numbers: those that were scaled to integers
  std::set<std::pair<int, int>> done_;  // directed edges of the cells found
  TriangleSet triangles_;
};

/// The corner after c in its triangle.
std::size_t next(std::size_t c) { return c % 3 == 2 ? c - 2 : c + 1; }

TriangleSet normalized(TriangleSet triangles) {
  for (auto& triangle : triangles) {
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace

TriangleSet reference_delaunay(const double* coordinates, std::size_t n) {
  std::map<std::pair<double, double>, std::int32_t> smallest_index;  // -0 and 0 compare equal, as they should
  for (std::size_t i = 0; i < n; ++i) {
    smallest_index.emplace(std::make_pair(coordinates[2 * i], coordinates[2 * i + 1]),
                           static_cast<std::int32_t>(i));
  }
  std::vector<std::int32_t> index;
  std::vector<double> distinct;
  for (const auto& [place, i] : smallest_index) {
    index.push_back(i);
    distinct.push_back(place.first);
    distinct.push_back(place.second);
  }

  const std::vector<mpz_class> integers = scale_to_integers(distinct.data(), distinct.size());
  // With coordinates below 2^30, dot and cross are below 2^63, and their products' difference below 2^127.
  const bool narrow = std::all_of(integers.begin(), integers.end(),
                                  [](const mpz_class& i) { return mpz_sizeinbase(i.get_mpz_t(), 2) <= 30; });
  TriangleSet triangles;
  if (narrow) {
    std::vector<Point<Int128>> points;
    for (std::size_t i = 0; i < integers.size(); i += 2) {
      points.push_back({Int128{integers[i].get_si()}, Int128{integers[i + 1].get_si()}});
    }
    triangles = CellWrapper<Int128>(points).run();
  } else {
    std::vector<Point<mpz_class>> points;
    for (std::size_t i = 0; i < integers.size(); i += 2) points.push_back({integers[i], integers[i + 1]});
    triangles = CellWrapper<mpz_class>(points).run();
  }
  for (auto& triangle : triangles) {
    for (std::int32_t& corner : triangle) corner = index[corner];
  }
  return normalized(std::move(triangles));
}

TriangleSet reference_delaunay(const std::vector<double>& coordinates) {
  return reference_delaunay(coordinates.data(), coordinates.size() / 2);
}

TriangleSet sorted_triangles(const std::vector<std::int32_t>& triangles) {
  TriangleSet result;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    result.push_back({triangles[i], triangles[i + 1], triangles[i + 2]});
  }
  return normalized(std::move(result));
}

std::vector<std::int32_t> flat_triangles(const TriangleSet& triangles) {
  std::vector<std::int32_t> flat;
  for (const auto& triangle : triangles) flat.insert(flat.end(), triangle.begin(), triangle.end());
  return flat;
}

std::vector<std::int32_t> reference_halfedges(const std::vector<std::int32_t>& triangles) {
  const auto edge = [](std::int32_t a, std::int32_t b) {
    return std::uint64_t(std::uint32_t(a)) << 32 | std::uint32_t(b);
  };
  std::vector<std::pair<std::uint64_t, std::int32_t>> sorted;
  sorted.reserve(triangles.size());
  for (std::size_t h = 0; h < triangles.size(); ++h)
    sorted.emplace_back(edge(triangles[h], triangles[next(h)]), static_cast<std::int32_t>(h));
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i - 1].first == sorted[i].first)
      throw std::logic_error("reference_halfedges: an edge of two triangles");
  }
  std::vector<std::int32_t> halfedges;
  halfedges.reserve(triangles.size());
  for (std::size_t h = 0; h < triangles.size(); ++h) {
    const std::uint64_t back = edge(triangles[next(h)], triangles[h]);
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), std::pair(back, 0));
    halfedges.push_back(at != sorted.end() && at->first == back ? at->second : -1);
  }
  return halfedges;
}

std::vector<std::int32_t> reference_neighbors(const std::vector<std::int32_t>& triangles) {
  const std::vector<std::int32_t> halfedges = reference_halfedges(triangles);
  std::vector<std::int32_t> neighbors;
  neighbors.reserve(triangles.size());
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::int32_t beyond = halfedges[next(c)];
    neighbors.push_back(beyond < 0 ? -1 : beyond / 3);
  }
  return neighbors;
}

std::vector<std::int32_t> linked_rows(const std::vector<std::int32_t>& triangles,
                                      const std::vector<std::int32_t>& neighbors) {
  using Row = std::array<std::int32_t, 3>;
  std::vector<std::pair<Row, std::size_t>> sorted;
  for (std::size_t c = 0; c < triangles.size(); c += 3)
    sorted.push_back({{triangles[c], triangles[c + 1], triangles[c + 2]}, c});
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::int32_t> place(sorted.size()), rows;
  for (std::size_t t = 0; t < sorted.size(); ++t) place[sorted[t].second / 3] = static_cast<std::int32_t>(t);
  rows.reserve(2 * triangles.size());
  for (const auto& [row, c] : sorted) {
    rows.insert(rows.end(), row.begin(), row.end());
    for (std::size_t k = c; k < c + 3; ++k) rows.push_back(neighbors[k] < 0 ? -1 : place.at(neighbors[k]));
  }
  return rows;
}

namespace {

mpq_class power_of_two(long exponent) {
  mpz_class power = 1;
  power <<= static_cast<mp_bitcnt_t>(std::labs(exponent));
  return exponent < 0 ? mpq_class(mpz_class(1), power) : mpq_class(power);
}

/// The nearest double, of two the even one.
double rounded(const mpq_class& exact) {
  if (exact < 0) return -rounded(-exact);
  if (exact == 0) return 0;
  const auto bits = [](const mpz_class& of) { return static_cast<long>(mpz_sizeinbase(of.get_mpz_t(), 2)); };
  long exponent = bits(exact.get_num()) - bits(exact.get_den());
  if (exact < power_of_two(exponent)) --exponent;
  const long unit = std::max(exponent - 52, -1074L);
  const mpq_class units = exact / power_of_two(unit);
  mpz_class whole = units.get_num() / units.get_den();
  const mpq_class rest = units - whole, half(1, 2);
  if (rest > half || (rest == half && mpz_odd_p(whole.get_mpz_t()) != 0)) ++whole;
  return std::ldexp(whole.get_d(), static_cast<int>(unit));
}

}  // namespace

std::vector<double> reference_areas(const std::vector<double>& coordinates,
                                    const std::vector<std::int32_t>& triangles) {
  std::vector<double> areas;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    Point<mpq_class> corners[3];
    for (int k = 0; k < 3; ++k) {
      const std::size_t i = 2 * static_cast<std::size_t>(triangles[t + k]);
      corners[k] = {mpq_class(coordinates[i]), mpq_class(coordinates[i + 1])};
    }
    areas.push_back(rounded(cross(corners[0], corners[1], corners[2]) / 2));
  }
  return areas;
}

int reference_orient2d(const double* a, const double* b, const double* c) {
  const double values[] = {a[0], a[1], b[0], b[1], c[0], c[1]};
  const auto z = scale_to_integers(values, 6);
  // As a 3 x 3 determinant, without translation: another way than the code that this is to check.
  const mpz_class determinant = z[0] * (z[3] - z[5]) - z[1] * (z[2] - z[4]) + (z[2] * z[5] - z[3] * z[4]);
  return sgn(determinant);
}

int reference_incircle(const double* a, const double* b, const double* c, const double* d) {
  const double values[] = {a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1]};
  const auto z = scale_to_integers(values, 8);
  // The 4 x 4 determinant of rows (x, y, x^2 + y^2, 1), expanded by the lifts: each times the orientation of
  // the three other points, with alternating signs.
  mpz_class determinant = 0;
  for (int i = 0; i < 4; ++i) {
    const int j = i == 0 ? 1 : 0, k = i <= 1 ? 2 : 1, l = i <= 2 ? 3 : 2;
    const mpz_class orientation = z[2 * j] * (z[2 * k + 1] - z[2 * l + 1]) -
                                  z[2 * j + 1] * (z[2 * k] - z[2 * l]) +
                                  (z[2 * k] * z[2 * l + 1] - z[2 * k + 1] * z[2 * l]);
    const mpz_class lift = z[2 * i] * z[2 * i] + z[2 * i + 1] * z[2 * i + 1];
    if (i % 2 == 0) {
      determinant += lift * orientation;
    } else {
      determinant -= lift * orientation;
    }
  }
  return sgn(determinant);
}

}  // namespace flaunay::testing
