// Natural-neighbour interpolation against Voronoi cells in rational arithmetic, which are cut out of the
// plane by bisectors alone.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include "derived/interpolate/natural.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "launchers/interpolate/natural.cl.hpp"
#include "tests/locate/support.hpp"

namespace flaunay::interpolate {
namespace {

using locate::Case;
using locate::Runtimes;
using testing::Coordinates;
using testing::download;
using testing::FixtureRandom;
using testing::guarded;
using testing::make_fixture;
using testing::same;
using testing::upload;

constexpr double kOutside = -77.25;
constexpr NaturalWeights kBoth[] = {NaturalWeights::sibson, NaturalWeights::laplace};

// ---- The twin

struct RationalPoint {
  mpq_class x, y;
};

RationalPoint rational(const double* p) { return {mpq_class(p[0]), mpq_class(p[1])}; }

// The points with a x + b y <= c. neighbor: whose bisector it is, or -1.
struct HalfPlane {
  mpq_class a, b, c;
  int neighbor;
};

HalfPlane nearer_to(const RationalPoint& p, const RationalPoint& than, int neighbor) {
  return {2 * (than.x - p.x), 2 * (than.y - p.y), than.x * than.x + than.y * than.y - p.x * p.x - p.y * p.y,
          neighbor};
}

// A convex polygon: side i leads from corner i to the next one.
struct Polygon {
  std::vector<HalfPlane> sides;
  std::vector<RationalPoint> corners;
};

RationalPoint crossing(const HalfPlane& g, const HalfPlane& h) {
  const mpq_class det = g.a * h.b - g.b * h.a;
  return {(g.c * h.b - g.b * h.c) / det, (g.a * h.c - g.c * h.a) / det};
}

Polygon whole_plane() {
  mpq_class far = 1;
  mpq_mul_2exp(far.get_mpq_t(), far.get_mpq_t(), 3000);
  return {{{0, -1, far, -1}, {1, 0, far, -1}, {0, 1, far, -1}, {-1, 0, far, -1}},
          {{-far, -far}, {far, -far}, {far, far}, {-far, far}}};
}

Polygon clipped(const Polygon& polygon, const HalfPlane& by) {
  const std::size_t n = polygon.corners.size();
  std::vector<int> signs;
  for (const RationalPoint& p : polygon.corners) signs.push_back(sgn(by.c - by.a * p.x - by.b * p.y));
  if (std::all_of(signs.begin(), signs.end(), [](int sign) { return sign >= 0; })) return polygon;
  Polygon rest;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    if (signs[i] > 0 || (signs[i] == 0 && signs[next] > 0)) {
      rest.sides.push_back(polygon.sides[i]);
      rest.corners.push_back(polygon.corners[i]);
    }
    if (signs[i] > 0 && signs[next] <= 0) {
      rest.sides.push_back(by);
      rest.corners.push_back(signs[next] == 0 ? polygon.corners[next] : crossing(polygon.sides[i], by));
    } else if (signs[i] < 0 && signs[next] > 0) {
      rest.sides.push_back(polygon.sides[i]);
      rest.corners.push_back(crossing(polygon.sides[i], by));
    }
  }
  return rest;
}

mpq_class doubled_area(const Polygon& polygon) {
  mpq_class sum = 0;
  for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
    const RationalPoint &p = polygon.corners[i], &q = polygon.corners[(i + 1) % polygon.corners.size()];
    sum += p.x * q.y - p.y * q.x;
  }
  return sum;
}

using Weights = std::map<int, mpq_class>;

Weights normalised(Weights weights) {
  mpq_class sum = 0;
  for (const auto& [point, weight] : weights) sum += weight;
  for (auto& [point, weight] : weights) weight /= sum;
  return weights;
}

int orientation(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c) {
  return sgn((a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x));
}

// The natural neighbours of a query with their weights; none outside of the hull.
Weights natural_twin(const Case& input, std::size_t set, const double* query, NaturalWeights method) {
  const RationalPoint q = rational(query);
  std::map<int, RationalPoint> vertices;
  bool is_inside = false;
  for (std::size_t t = input.mesh.triangle_offsets[set]; t < input.mesh.triangle_offsets[set + 1]; ++t) {
    RationalPoint corner[3];
    for (int k = 0; k < 3; ++k) {
      corner[k] = rational(input.point(input.corner(t, k)));
      vertices[input.corner(t, k)] = corner[k];
    }
    is_inside =
        is_inside || (orientation(corner[0], corner[1], q) >= 0 &&
                      orientation(corner[1], corner[2], q) >= 0 && orientation(corner[2], corner[0], q) >= 0);
  }
  if (!is_inside) return {};
  Polygon cell = whole_plane();
  for (const auto& [point, at] : vertices) {
    if (at.x == q.x && at.y == q.y) return {{point, 1}};
    cell = clipped(cell, nearer_to(q, at, point));
  }
  Weights weights;
  const std::size_t n = cell.corners.size();
  const bool is_bounded = std::all_of(cell.sides.begin(), cell.sides.end(),
                                      [](const HalfPlane& side) { return side.neighbor >= 0; });
  if (!is_bounded) {
    // On an edge of the hull: between the nearest points on both sides of the query on its line.
    const auto& hull = input.mesh.hull;
    const std::size_t first = input.mesh.hull_offsets[set], last = input.mesh.hull_offsets[set + 1];
    for (std::size_t i = first; i < last; ++i) {
      const int from = hull[i], to = hull[i + 1 < last ? i + 1 : first];
      const RationalPoint a = rational(input.point(from)), b = rational(input.point(to));
      const mpq_class dot = (a.x - q.x) * (b.x - q.x) + (a.y - q.y) * (b.y - q.y);
      if (orientation(a, b, q) != 0 || dot > 0) continue;
      const mpq_class part = a.x != b.x ? (q.x - a.x) / (b.x - a.x) : (q.y - a.y) / (b.y - a.y);
      return {{from, 1 - part}, {to, part}};
    }
    ADD_FAILURE() << "a query with an unbounded cell is not on the hull";
    return {};
  }
  for (std::size_t i = 0; i < n; ++i) {
    const int point = cell.sides[i].neighbor;
    const RationalPoint &from = cell.corners[i], &to = cell.corners[(i + 1) % n], &at = vertices[point];
    if (from.x == to.x && from.y == to.y) continue;
    if (method == NaturalWeights::laplace) {
      const mpq_class x = at.x - q.x, y = at.y - q.y;
      weights[point] = ((to.y - from.y) * x - (to.x - from.x) * y) / (x * x + y * y);
    } else {
      // In the query's cell, all places but those of no area are nearest to vertices with sides of it.
      Polygon piece = cell;
      for (const HalfPlane& side : cell.sides) {
        if (side.neighbor != point)
          piece = clipped(piece, nearer_to(at, vertices[side.neighbor], side.neighbor));
      }
      weights[point] = doubled_area(piece);
    }
  }
  return normalised(weights);
}

// ---- The device

struct NaturalAnswers {
  std::vector<double> values, exact_values;  // rows of columns_for
};

constexpr std::size_t kColumns = 3;

// kColumns, and one per point: its weight.
std::size_t columns_for(const Case& input) { return kColumns + input.size(); }

// x, y and numbers at random; then a 1 for the point itself.
std::vector<double> table_for(const Case& input) {
  std::vector<double> table;
  const std::vector<double> random = locate::values_for(input.size());
  for (std::size_t i = 0; i < input.size(); ++i) {
    table.insert(table.end(), {input.points[2 * i], input.points[2 * i + 1], random[i]});
    for (std::size_t k = 0; k < input.size(); ++k) table.push_back(k == i ? 1 : 0);
  }
  return table;
}

// Lists of weights are what values of 1 at one point get.
void check_lists(host::Runtime& runtime, const Case& input, const NaturalLists& lists,
                 const std::vector<double>& results) {
  const std::size_t count = lists.offsets().back(), columns = columns_for(input);
  const auto neighbors = guarded<cl_int>(runtime, count);
  const auto weights = guarded<cl_double>(runtime, count);
  lists.write(neighbors, weights);
  const std::vector<cl_int> points = download(runtime, neighbors, count);
  const std::vector<double> all = download(runtime, weights, count);
  ASSERT_EQ(lists.offsets().size(), input.query_count() + 1);
  for (std::size_t q = 0; q < input.query_count(); ++q) {
    const std::size_t first = lists.offsets()[q], last = lists.offsets()[q + 1];
    std::vector<double> row(input.size(), first == last ? kOutside : 0);
    for (std::size_t k = first; k < last; ++k) row[static_cast<std::size_t>(points[k])] += all[k];
    const double* const expected = results.data() + q * columns + kColumns;
    ASSERT_EQ(row, std::vector<double>(expected, expected + input.size())) << "query " << q;
  }
}

NaturalAnswers ask_natural(host::Runtime& runtime, const Case& input, NaturalWeights method) {
  host::Arena own(runtime.memory());
  host::Arena::Scope scope(runtime.arena());
  const Locator locator = *locate::make_locator(runtime, own, upload_mesh(runtime, input), nullptr);
  const std::size_t m = input.query_count();
  const auto queries = upload(runtime, input.queries), values = upload(runtime, table_for(input));
  const std::size_t columns = columns_for(input);
  const auto results = guarded<cl_double>(runtime, columns * m),
             exact = guarded<cl_double>(runtime, columns * m);
  natural(runtime, locator, method, {values, columns, kOutside}, queries, m, input.query_offsets, results);
  check_lists(runtime, input, {runtime, locator, method, queries, m, input.query_offsets},
              download(runtime, results, columns * m));

  // All by the exact kernel, except outside of the hull, which is not left to it.
  const locate::LocatedQueries located =
      locate::locate_by_place(runtime, locator, queries, m, input.query_offsets, points::kCircleLimits);
  std::vector<cl_int> found(m);
  runtime.read(located.found, 0, m, found.data());
  std::vector<cl_uchar> left;
  for (const cl_int triangle : found) left.push_back(triangle >= 0);
  runtime.copy(results, 0, exact, 0, columns * m);
  runtime.map_in_small_groups(
      m, kernels::interpolate_natural_exactly{
             .placed_queries = located,
             .columns = columns,
             .is_by_vertex = 0,
             .method = static_cast<cl_int>(method),
             .outside = kOutside,
             .records = locator.records,
             .faces = {.points = locator.points, .source = locator.source, .faces = locator.faces},
             .found = located.found,
             .values = values,
             .left = upload(runtime, left),
             .results = exact});
  return {download(runtime, results, columns * m), download(runtime, exact, columns * m)};
}

template <typename T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), sizeof(T) * a.size()) == 0);
}

void check_row(const double* row, std::size_t columns, const std::vector<double>& table,
               const Weights& weights) {
  for (std::size_t c = 0; c < kColumns; ++c) {
    if (weights.empty()) {
      ASSERT_EQ(row[c], kOutside);
      continue;
    }
    mpq_class sum = 0, largest = 0;
    for (const auto& [point, weight] : weights) {
      const mpq_class value = table[columns * static_cast<std::size_t>(point) + c];
      sum += weight * value;
      largest = std::max(largest, mpq_class(abs(value)));
    }
    ASSERT_TRUE(std::isfinite(row[c]));
    ASSERT_LE(abs(mpq_class(row[c]) - sum), largest * mpq_class(NATURAL_ERROR))
        << row[c] << " for " << sum.get_d();
    if (weights.size() == 1) {
      ASSERT_EQ(mpq_class(row[c]), sum);
    }
  }
}

void check_natural(const Case& input) {
  const std::vector<double> table = table_for(input);
  const std::size_t columns = columns_for(input);
  for (const NaturalWeights method : kBoth) {
    SCOPED_TRACE(method == NaturalWeights::sibson ? "Sibson" : "Laplace");
    std::vector<Weights> twins;
    for (std::size_t s = 0; s < input.sets(); ++s) {
      for (std::size_t i = input.query_offsets[s]; i < input.query_offsets[s + 1]; ++i) {
        twins.push_back(natural_twin(input, s, input.query(i), method));
      }
    }
    std::unique_ptr<NaturalAnswers> first;
    for (const std::string& name : locate::tunings()) {
      SCOPED_TRACE("tuning " + name);
      const NaturalAnswers answers = ask_natural(Runtimes::get(name), input, method);
      for (std::size_t i = 0; i < twins.size(); ++i) {
        SCOPED_TRACE("query " + std::to_string(i));
        const double* const row = &answers.values[columns * i];
        const double* const exact = &answers.exact_values[columns * i];
        check_row(row, columns, table, twins[i]);
        check_row(exact, columns, table, twins[i]);
        if (twins[i].empty()) continue;
        std::size_t neighbors = 0;
        mpq_class errors = 0, exact_errors = 0;
        for (std::size_t point = 0; point < input.size(); ++point) {
          const auto found = twins[i].find(static_cast<int>(point));
          if (found == twins[i].end() && row[kColumns + point] == 0 && exact[kColumns + point] == 0) continue;
          const mpq_class weight = found == twins[i].end() ? mpq_class(0) : found->second;
          errors += abs(mpq_class(row[kColumns + point]) - weight);
          exact_errors += abs(mpq_class(exact[kColumns + point]) - weight);
          ASSERT_EQ(exact[kColumns + point] != 0, found != twins[i].end()) << point;
          neighbors += exact[kColumns + point] != 0;
        }
        ASSERT_EQ(neighbors, twins[i].size());
        ASSERT_LE(errors, mpq_class(NATURAL_ERROR)) << errors.get_d();
        ASSERT_LE(exact_errors, mpq_class(NATURAL_ERROR)) << exact_errors.get_d();
      }
      if (!first) first = std::make_unique<NaturalAnswers>(answers);
      EXPECT_TRUE(same_bytes(first->values, answers.values));
      EXPECT_TRUE(same_bytes(first->exact_values, answers.exact_values));
    }
  }
}

// m queries of each kind: a few units in the last place from points, from edges, and from the hull.
Coordinates queries_close_by(const Coordinates& points, std::size_t m, std::uint64_t seed) {
  const Triangulation mesh = testing::triangulator().triangulate(points.data(), points.size() / 2);
  FixtureRandom random(seed);
  Coordinates queries;
  const auto add = [&](double x, double y) {
    // Of zeros, units of a small number.
    for (double* at : {&x, &y}) {
      *at += static_cast<double>(random.integer(-3, 3)) * 0x1p-52 * std::max(std::fabs(*at), 0x1p-60);
    }
    queries.insert(queries.end(), {x, y});
  };
  const auto point = [&](std::int32_t i) { return &points[2 * static_cast<std::size_t>(i)]; };
  const auto add_between = [&](std::int32_t a, std::int32_t b) {
    const double part = static_cast<double>(random.integer(0, 8)) / 8;
    add(point(a)[0] + part * (point(b)[0] - point(a)[0]), point(a)[1] + part * (point(b)[1] - point(a)[1]));
  };
  const auto any = [&](std::size_t n) {
    return static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(n) - 1));
  };
  for (std::size_t i = 0; i < m && !mesh.triangles.empty(); ++i) {
    const std::size_t t = 3 * any(mesh.triangles.size() / 3), h = any(mesh.hull.size());
    add(point(mesh.triangles[t])[0], point(mesh.triangles[t])[1]);
    add_between(mesh.triangles[t], mesh.triangles[t + 1]);
    add_between(mesh.hull[h], mesh.hull[(h + 1) % mesh.hull.size()]);
  }
  return queries;
}

Case natural_case(const Coordinates& points, std::size_t m, std::uint64_t seed) {
  Case result;
  Coordinates queries = locate::make_queries(points, m, seed);
  const Coordinates close = queries_close_by(points, m, seed + 1);
  queries.insert(queries.end(), close.begin(), close.end());
  result.add(points, queries);
  result.triangulate();
  return result;
}

TEST(SmallNatural, NestedSets) { check_natural(locate::nested_case(9, 2)); }

TEST(SmallNatural, Grid) { check_natural(natural_case(make_fixture("grid", 25, 8), 3, 9)); }

TEST(SmallNatural, NothingAtAll) {
  for (const locate::Offsets& offsets : {locate::Offsets{0}, locate::Offsets{0, 0}}) {
    Case input;
    input.offsets = input.query_offsets = offsets;
    input.triangulate();
    check_natural(input);
  }
}

TEST(Natural, AllFixtures) {
  const std::vector<testing::Fixture>& fixtures = testing::all_fixtures();
  // What is exact about them is natively as on devices, and takes most of the time.
  const std::size_t step = testing::tests_native() ? 1 : 4;
  for (std::size_t k = 0; k < fixtures.size(); k += step) {
    SCOPED_TRACE(fixtures[k].name);
    check_natural(natural_case(fixtures[k].make(25, 3), 5, 4));
  }
}

TEST(Natural, Magnitudes) {
  for (const double factor : {1e-290, 1e290}) {
    SCOPED_TRACE(factor);
    const Coordinates points = make_fixture("uniform", 40, 5);
    Case input;
    input.add(testing::scaled(points, factor), testing::scaled(locate::make_queries(points, 5, 6), factor));
    input.triangulate();
    check_natural(input);
  }
}

// The centre of hundreds of cocircular points and a query near one of them: cavities whose triangles form
// long paths.
TEST(Natural, ARing) {
  Coordinates ring;
  const std::int64_t far = 5 * 13 * 17 * 29 * 37;
  for (std::int64_t x = 0; x <= far; ++x) {
    const auto y =
        static_cast<std::int64_t>(std::llround(std::sqrt(static_cast<double>((far - x) * (far + x)))));
    if (x * x + y * y != far * far) continue;
    for (const int sign : {-1, 1}) {
      ring.insert(ring.end(), {static_cast<double>(sign * x), static_cast<double>(y)});
      ring.insert(ring.end(), {static_cast<double>(x), static_cast<double>(sign * y)});
      ring.insert(ring.end(), {static_cast<double>(sign * y), static_cast<double>(-x)});
    }
  }
  Case input;
  input.add(ring, {0, 0, 1e5, -3e5, 0x1p-20, 0x1p-21});
  input.triangulate();
  for (const NaturalWeights method : kBoth) {
    const NaturalAnswers answers = ask_natural(Runtimes::get("own"), input, method);
    // All points but duplicates are neighbours, and linear functions are exact.
    const std::set<cl_int> distinct(input.mesh.representatives.begin(), input.mesh.representatives.end());
    for (std::size_t i = 0; i < input.query_count(); ++i) {
      const std::size_t row = columns_for(input) * i;
      const auto weights = answers.exact_values.begin() + static_cast<std::ptrdiff_t>(row + kColumns);
      EXPECT_EQ(std::count_if(weights, weights + static_cast<std::ptrdiff_t>(input.size()),
                              [](double weight) { return weight != 0; }),
                static_cast<std::ptrdiff_t>(distinct.size()));
      for (std::size_t c = 0; c < 2; ++c) {
        const double error = static_cast<double>(far) * NATURAL_ERROR;
        EXPECT_NEAR(answers.values[row + c], input.query(i)[c], error);
        EXPECT_NEAR(answers.exact_values[row + c], input.query(i)[c], error);
      }
    }
  }
}

}  // namespace
}  // namespace flaunay::interpolate
