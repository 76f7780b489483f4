// Interpolation by every method, several columns at once, against sequential twins.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include "derived/interpolate/interpolate.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "blocks/run.hpp"
#include "host/opencl/programs.hpp"
#include "tests/locate/support.hpp"

namespace flaunay::locate {
namespace {

using interpolate::Table;

const double kOutside = -7.25;

/// A locator on a runtime, with what it needs.
struct Located {
  Located(const std::string& tuning, const Case& case_of_test)
      : runtime(Runtimes::get(tuning)), own(runtime.memory()), input(case_of_test) {
    const host::Arena::Scope scope(runtime.arena());
    locator = *make_locator(runtime, own, upload_mesh(runtime, input), blocks::run);
  }

  /// method(runtime, locator, table, queries...) is one of derived/interpolate/interpolate.hpp.
  template <typename Method>
  std::vector<double> values_by(const Method& method, const std::vector<double>& values,
                                std::size_t columns) {
    const host::Arena::Scope scope(runtime.arena());
    const std::size_t m = input.query_count();
    const auto results = guarded<cl_double>(runtime, m * columns);
    method(runtime, locator, Table{upload(runtime, values), columns, kOutside},
           upload(runtime, input.queries), m, input.query_offsets, results);
    return download(runtime, results, m * columns);
  }

  template <typename Answer>
  std::vector<cl_int> located(const Answer& answer) {
    const host::Arena::Scope scope(runtime.arena());
    const std::size_t m = input.query_count();
    const auto found = guarded<cl_int>(runtime, m);
    *answer(runtime, locator, upload(runtime, input.queries), m, input.query_offsets, found);
    return download(runtime, found, m);
  }
  /// Per query; that these are right is the subject of locate_test.cpp.
  std::vector<cl_int> triangles() { return located(locate::locate); }
  std::vector<cl_int> nearest() { return located(locate::nearest); }

  Runtime& runtime;
  host::Arena own;
  const Case& input;
  Locator locator;
};

/// Of the locator's arena: one set and more, all fixtures, nothing at all.
std::vector<Case> cases(std::size_t n, std::size_t m) {
  std::vector<Case> all{nested_case(n, m), case_of_trees(3 * n, m)};
  Case nothing;
  nothing.triangulate();
  all.push_back(nothing);
  nothing.add({}, {0, 0, 1, 2});
  nothing.triangulate();
  all.push_back(nothing);
  return all;
}

std::string bytes_of(const std::vector<double>& numbers) {
  return std::string(reinterpret_cast<const char*>(numbers.data()), sizeof(double) * numbers.size());
}

/// Returns the results. Their bytes must not depend on the tuning, nor those of a column on the others.
template <typename Method>
std::vector<double> consistent(const Case& input, const Method& method, const std::vector<double>& values,
                               std::size_t columns) {
  std::vector<double> first;
  for (const std::string& tuning : tunings()) {
    SCOPED_TRACE("tuning " + tuning);
    Located located(tuning, input);
    const std::vector<double> results = located.values_by(method, values, columns);
    if (tuning == tunings()[0]) {
      first = results;
      for (std::size_t c = 0; c < columns && columns > 1; ++c) {
        std::vector<double> column, expected;
        for (std::size_t i = c; i < values.size(); i += columns) column.push_back(values[i]);
        for (std::size_t i = c; i < results.size(); i += columns) expected.push_back(results[i]);
        EXPECT_EQ(bytes_of(located.values_by(method, column, 1)), bytes_of(expected)) << "column " << c;
      }
    }
    EXPECT_EQ(bytes_of(results), bytes_of(first));
  }
  return first;
}

using Weights = std::vector<mpq_class>;

Weights weights_at(const Case& input, std::size_t t, const double* q) {
  Weights weights;
  mpq_class whole = 0;
  for (int k = 0; k < 3; ++k) {
    weights.push_back(
        area(input.point(input.corner(t, (k + 1) % 3)), input.point(input.corner(t, (k + 2) % 3)), q));
    whole += weights.back();
  }
  for (mpq_class& weight : weights) weight /= whole;
  return weights;
}

void check_linear(const Case& input, std::size_t columns) {
  const std::vector<double> values = values_for(input.size() * columns);
  const std::vector<double> results = consistent(input, interpolate::linear, values, columns);
  const std::vector<cl_int> triangles = Located("own", input).triangles();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto t = static_cast<std::size_t>(triangles[i]);
    const Weights weights = triangles[i] < 0 ? Weights{} : weights_at(input, t, input.query(i));
    for (std::size_t c = 0; c < columns; ++c) {
      if (triangles[i] < 0) {
        ASSERT_EQ(results[i * columns + c], kOutside);
        continue;
      }
      mpq_class sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::size_t>(input.corner(t, static_cast<int>(k)));
        sum += weights[k] * mpq_class(values[corner * columns + c]);
      }
      ASSERT_NEAR(results[i * columns + c], sum.get_d(), 0x1p-38) << i << ", " << c;
    }
  }
}

void check_nearest(const Case& input, std::size_t columns) {
  const std::vector<double> values = values_for(input.size() * columns);
  const std::vector<double> results = consistent(input, interpolate::nearest, values, columns);
  const std::vector<cl_int> points = Located("own", input).nearest();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t c = 0; c < columns; ++c) {
      const double expected =
          points[i] < 0 ? kOutside : values[static_cast<std::size_t>(points[i]) * columns + c];
      ASSERT_EQ(results[i * columns + c], expected) << i << ", " << c;
    }
  }
}

TEST(SmallInterpolation, LinearAndNearest) {
  for (const Case& input : cases(12, 2)) {
    for (const std::size_t columns : {1u, 3u}) {
      check_linear(input, columns);
      check_nearest(input, columns);
    }
  }
}

TEST(Interpolation, LinearAndNearest) {
  for (const Case& input : cases(150, 20)) {
    for (const std::size_t columns : {1u, 3u, 7u}) {
      check_linear(input, columns);
      check_nearest(input, columns);
    }
  }
}

TEST(Interpolation, LinearInEveryFixture) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    check_linear(make_case(fixture.make(330, 11), 12, 13), 2);
  }
}

// ---- Gradients

constexpr double kTolerance = 1e-6;

interpolate::Gradients estimated(double tolerance = kTolerance, std::size_t iterations = 400) {
  return {false, {}, tolerance, iterations};
}

std::vector<double> gradients_of(const std::string& tuning, const Case& input,
                                 const std::vector<double>& values, std::size_t columns,
                                 const interpolate::Gradients& wanted = estimated()) {
  Located located(tuning, input);
  const host::Arena::Scope scope(located.runtime.arena());
  const auto results = guarded<cl_double>(located.runtime, 2 * values.size());
  interpolate::estimate_gradients(located.runtime, located.locator,
                                  Table{upload(located.runtime, values), columns, kOutside}, wanted, results);
  return download(located.runtime, results, 2 * values.size());
}

/// By Gauss and Seidel's iteration until nothing changes, as SciPy does it.
std::vector<double> gradient_twin(const Case& input, const std::vector<double>& values) {
  // Each point's edges, and what of its equations does not change.
  struct Spoke {
    std::int32_t v, u;
    long double ex, ey, cube;
  };
  std::vector<Spoke> spokes;
  for (std::size_t c = 0; c < input.mesh.triangles.size(); ++c) {
    // Edges at the border are edges of one triangle.
    const std::int32_t a = input.mesh.triangles[c], b = input.corner(c / 3, static_cast<int>((c + 1) % 3));
    spokes.push_back({a, b, 0, 0, 0});
    if (input.mesh.neighbors[c - c % 3 + (c + 2) % 3] < 0) spokes.push_back({b, a, 0, 0, 0});
  }
  std::sort(spokes.begin(), spokes.end(),
            [](const Spoke& p, const Spoke& q) { return std::tie(p.v, p.u) < std::tie(q.v, q.u); });
  std::vector<double> g(2 * input.size(), kOutside);
  for (Spoke& spoke : spokes) {
    spoke.ex = input.point(spoke.u)[0] - input.point(spoke.v)[0];
    spoke.ey = input.point(spoke.u)[1] - input.point(spoke.v)[1];
    const long double length = std::hypot(spoke.ex, spoke.ey);
    spoke.cube = length * length * length;
    g[2 * spoke.v] = g[2 * spoke.v + 1] = 0;
  }
  std::vector<double> before;
  for (int sweep = 0; sweep < 80 && g != before; ++sweep) {
    before = g;
    for (std::size_t i = 0; i < spokes.size();) {
      const std::int32_t v = spokes[i].v;
      long double xx = 0, xy = 0, yy = 0, x = 0, y = 0;
      for (; i < spokes.size() && spokes[i].v == v; ++i) {
        const auto& [from, u, ex, ey, cube] = spokes[i];
        const long double s = 6 * (values[u] - values[v]) - 2 * (ex * g[2 * u] + ey * g[2 * u + 1]);
        xx += 4 * ex * ex / cube;
        xy += 4 * ex * ey / cube;
        yy += 4 * ey * ey / cube;
        x += s * ex / cube;
        y += s * ey / cube;
      }
      const long double determinant = xx * yy - xy * xy;
      g[2 * v] = static_cast<double>((yy * x - xy * y) / determinant);
      g[2 * v + 1] = static_cast<double>((xx * y - xy * x) / determinant);
    }
  }
  return g;
}

/// The largest component, of points that have gradients.
double largest(const std::vector<double>& gradients) {
  double most = 0;
  for (const double g : gradients) most = std::max(most, g == kOutside ? 0 : std::fabs(g));
  return most;
}

void check_gradients(const Case& input, std::size_t columns, double tolerance = kTolerance) {
  const std::vector<double> values = values_for(input.size() * columns);
  std::vector<double> first;
  for (const std::string& tuning : tunings()) {
    SCOPED_TRACE("tuning " + tuning);
    const std::vector<double> results = gradients_of(tuning, input, values, columns, estimated(tolerance));
    if (tuning == tunings()[0]) first = results;
    EXPECT_EQ(bytes_of(results), bytes_of(first));
  }
  for (std::size_t c = 0; c < columns; ++c) {
    std::vector<double> column, found;
    for (std::size_t i = c; i < values.size(); i += columns) {
      column.push_back(values[i]);
      found.insert(found.end(), {first[2 * i], first[2 * i + 1]});
    }
    const std::vector<double> expected = gradient_twin(input, column);
    const double most = largest(expected);
    double worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ASSERT_EQ(found[i] == kOutside, expected[i] == kOutside) << i;
      worst = std::max(worst, std::fabs(found[i] - expected[i]));
    }
    EXPECT_LE(worst, kTolerance * most);
  }
}

TEST(SmallGradients, Sets) {
  for (const Case& input : cases(12, 1)) check_gradients(input, 2);
}

TEST(Gradients, Sets) {
  for (const Case& input : cases(200, 1)) {
    for (const std::size_t columns : {1u, 3u, 7u}) check_gradients(input, columns);
  }
}

TEST(Gradients, EveryFixture) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Case input = make_case(fixture.make(330, 11), 1, 12);
    const std::string name = fixture.name;
    if (name == "slender") {
      // The slopes across are lost, in the twin too.
      for (const double g : gradients_of("own", input, values_for(input.size()), 1)) {
        ASSERT_TRUE(std::isfinite(g));
      }
      continue;
    }
    // Where points lie on all scales, the largest gradients reach far, and their error is a large part of
    // others.
    check_gradients(input, 1, name == "log-spiral" ? 0 : kTolerance);
  }
}

/// Sets that do not fit one scale have units of their own.
TEST(SmallGradients, SetsOfEveryScale) {
  const std::vector<double> points = make_fixture("uniform", 40, 3);
  std::vector<double> values;
  Case both;
  for (const int shift : {-500, 500}) {
    std::vector<double> scaled = points;
    for (double& x : scaled) x = std::ldexp(x, shift);
    both.add(scaled, {});
    for (const double value : values_for(points.size() / 2)) values.push_back(value);
  }
  both.triangulate();
  const std::vector<double> found = gradients_of("own", both, values, 1);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_EQ(std::ldexp(found[points.size() + i], 1000), found[i]) << i;
}

/// A linear function's gradients are found as they are, however few iterations are made beyond those needed.
TEST(SmallGradients, OfALinearFunction) {
  const Case input = make_case(make_fixture("uniform", 60, 3), 1, 4);
  std::vector<double> values;
  for (std::size_t i = 0; i < input.size(); ++i) {
    values.push_back(3 * input.points[2 * i] - 5 * input.points[2 * i + 1] + 7);
  }
  const auto error_after = [&](double tolerance, std::size_t iterations) {
    const auto found = gradients_of("own", input, values, 1, estimated(tolerance, iterations));
    double worst = 0;
    for (std::size_t i = 0; i < input.size(); ++i) {
      worst = std::max({worst, std::fabs(found[2 * i] - 3), std::fabs(found[2 * i + 1] + 5)});
    }
    return worst;
  };
  EXPECT_EQ(error_after(1e-6, 0), 5);
  EXPECT_GT(error_after(1e-6, 3), 1e-3);
  EXPECT_LT(error_after(1e-6, 400), 1e-5);
  EXPECT_GT(error_after(1e-6, 400), 1e-10);
  EXPECT_LT(error_after(0, 400), 1e-12);
}

// ---- Clough-Tocher

std::vector<double> clough_tocher(Located& located, const std::vector<double>& values, std::size_t columns,
                                  const std::vector<double>* gradients = nullptr) {
  return located.values_by(
      [&](Runtime& runtime, Locator& locator, const auto&... all) {
        interpolate::Gradients wanted = estimated();
        if (gradients != nullptr) wanted = {true, upload(runtime, *gradients)};
        const auto& [table, queries, m, offsets, results] = std::tie(all...);
        interpolate::clough_tocher(runtime, locator, table, wanted, queries, m, offsets, results);
      },
      values, columns);
}

/// The formulas as SciPy has them, with the three directions by the neighbours' centroids.
double clough_tocher_twin(const Case& input, std::size_t t, const double* q,
                          const std::vector<double>& values, const std::vector<double>& gradients) {
  using Number = long double;
  const double* p[3];
  Number f[3], d[3][3], b[3], g[3];
  const Weights weights = weights_at(input, t, q);
  for (int k = 0; k < 3; ++k) {
    const auto corner = static_cast<std::size_t>(input.corner(t, k));
    p[k] = &input.points[2 * corner];
    f[k] = values[corner];
    b[k] = weights[static_cast<std::size_t>(k)].get_d();
  }
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      const auto corner = static_cast<std::size_t>(input.corner(t, k));
      d[k][j] = gradients[2 * corner] * (Number(p[j][0]) - p[k][0]) +
                gradients[2 * corner + 1] * (Number(p[j][1]) - p[k][1]);
    }
  }
  for (int k = 0; k < 3; ++k) {
    const std::int32_t beyond = input.mesh.neighbors[3 * t + static_cast<std::size_t>(k)];
    g[k] = -0.5L;
    if (beyond < 0) continue;
    mpq_class c[3] = {0, 0, 0};
    for (int j = 0; j < 3; ++j) {
      const Weights of_corner =
          weights_at(input, t, input.point(input.corner(static_cast<std::size_t>(beyond), j)));
      for (std::size_t i = 0; i < 3; ++i) c[i] += of_corner[i] / 3;
    }
    const mpq_class &last = c[(k + 2) % 3], &next = c[(k + 1) % 3];
    g[k] = mpq_class((2 * last + next - 1) / (2 - 3 * last - 3 * next)).get_d();
  }
  const Number c3000 = f[0], c0300 = f[1], c0030 = f[2];
  const Number c2100 = (d[0][1] + 3 * c3000) / 3, c2010 = (d[0][2] + 3 * c3000) / 3;
  const Number c1200 = (d[1][0] + 3 * c0300) / 3, c0210 = (d[1][2] + 3 * c0300) / 3;
  const Number c1020 = (d[2][0] + 3 * c0030) / 3, c0120 = (d[2][1] + 3 * c0030) / 3;
  const Number c2001 = (c2100 + c2010 + c3000) / 3, c0201 = (c1200 + c0300 + c0210) / 3,
               c0021 = (c1020 + c0120 + c0030) / 3;
  const Number c0111 =
      (g[0] * (-c0300 + 3 * c0210 - 3 * c0120 + c0030) + (-c0300 + 2 * c0210 - c0120 + c0021 + c0201)) / 2;
  const Number c1011 =
      (g[1] * (-c0030 + 3 * c1020 - 3 * c2010 + c3000) + (-c0030 + 2 * c1020 - c2010 + c2001 + c0021)) / 2;
  const Number c1101 =
      (g[2] * (-c3000 + 3 * c2100 - 3 * c1200 + c0300) + (-c3000 + 2 * c2100 - c1200 + c2001 + c0201)) / 2;
  const Number c1002 = (c1101 + c1011 + c2001) / 3, c0102 = (c1101 + c0111 + c0201) / 3,
               c0012 = (c1011 + c0111 + c0021) / 3;
  const Number c0003 = (c1002 + c0102 + c0012) / 3;
  const Number least = std::min({b[0], b[1], b[2]});
  const Number b1 = b[0] - least, b2 = b[1] - least, b3 = b[2] - least, b4 = 3 * least;
  return static_cast<double>(b1 * b1 * b1 * c3000 + 3 * b1 * b1 * b2 * c2100 + 3 * b1 * b1 * b3 * c2010 +
                             3 * b1 * b1 * b4 * c2001 + 3 * b1 * b2 * b2 * c1200 + 6 * b1 * b2 * b4 * c1101 +
                             3 * b1 * b3 * b3 * c1020 + 6 * b1 * b3 * b4 * c1011 + 3 * b1 * b4 * b4 * c1002 +
                             b2 * b2 * b2 * c0300 + 3 * b2 * b2 * b3 * c0210 + 3 * b2 * b2 * b4 * c0201 +
                             3 * b2 * b3 * b3 * c0120 + 6 * b2 * b3 * b4 * c0111 + 3 * b2 * b4 * b4 * c0102 +
                             b3 * b3 * b3 * c0030 + 3 * b3 * b3 * b4 * c0021 + 3 * b3 * b4 * b4 * c0012 +
                             b4 * b4 * b4 * c0003);
}

void check_clough_tocher(const Case& input, std::size_t columns, double error = 0x1p-36) {
  const std::vector<double> values = values_for(input.size() * columns);
  const std::vector<double> gradients = values_for(2 * input.size() * columns);
  const std::vector<cl_int> triangles = Located("own", input).triangles();
  std::vector<double> results;
  for (const std::string& tuning : tunings()) {
    SCOPED_TRACE("tuning " + tuning);
    Located located(tuning, input);
    const auto found = clough_tocher(located, values, columns, &gradients);
    if (tuning == tunings()[0]) results = found;
    EXPECT_EQ(bytes_of(found), bytes_of(results));
  }
  for (std::size_t c = 0; c < columns; ++c) {
    std::vector<double> column, slopes;
    for (std::size_t i = c; i < values.size(); i += columns) {
      column.push_back(values[i]);
      slopes.insert(slopes.end(), {gradients[2 * i], gradients[2 * i + 1]});
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const double result = results[i * columns + c];
      if (triangles[i] < 0) {
        ASSERT_EQ(result, kOutside);
        continue;
      }
      const auto t = static_cast<std::size_t>(triangles[i]);
      double longest = 1;
      for (int k = 0; k < 3; ++k) {
        const double *a = input.point(input.corner(t, k)), *b = input.point(input.corner(t, (k + 1) % 3));
        longest = std::max(longest, std::hypot(a[0] - b[0], a[1] - b[1]));
        if (a[0] == input.query(i)[0] && a[1] == input.query(i)[1]) {
          ASSERT_EQ(result, column[static_cast<std::size_t>(input.corner(t, k))]);
        }
      }
      const double expected = clough_tocher_twin(input, t, input.query(i), column, slopes);
      ASSERT_NEAR(result, expected, error * longest) << i << " of " << c;
    }
  }
}

TEST(SmallInterpolation, CloughTocher) {
  for (const Case& input : cases(12, 2)) {
    for (const std::size_t columns : {1u, 3u}) check_clough_tocher(input, columns);
  }
}

TEST(Interpolation, CloughTocher) {
  for (const Case& input : cases(150, 20)) {
    for (const std::size_t columns : {1u, 3u, 7u}) check_clough_tocher(input, columns);
  }
}

TEST(Interpolation, CloughTocherInEveryFixture) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    check_clough_tocher(make_case(fixture.make(330, 11), 12, 13), 2);
  }
}

/// With their gradients, quadratic polynomials are interpolated as they are; with estimated ones, linear
/// ones.
TEST(SmallInterpolation, CloughTocherOfPolynomials) {
  const Case input = make_case(make_fixture("uniform", 80, 5), 20, 6);
  const auto quadratic = [](double x, double y) {
    return 1 + 2 * x - 3 * y + 4 * x * x - 5 * x * y + 6 * y * y;
  };
  const auto linear = [](double x, double y) { return 1 + 2 * x - 3 * y; };
  std::vector<double> values, gradients, linear_values;
  for (std::size_t i = 0; i < input.size(); ++i) {
    const double x = input.points[2 * i], y = input.points[2 * i + 1];
    values.push_back(quadratic(x, y));
    linear_values.push_back(linear(x, y));
    gradients.insert(gradients.end(), {2 + 8 * x - 5 * y, -3 - 5 * x + 12 * y});
  }
  Located located("own", input);
  const std::vector<double> exact = clough_tocher(located, values, 1, &gradients);
  const std::vector<double> flat = clough_tocher(located, linear_values, 1);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (exact[i] == kOutside) continue;
    ++inside;
    const double x = input.query(i)[0], y = input.query(i)[1];
    EXPECT_NEAR(exact[i], quadratic(x, y), 1e-12);
    EXPECT_NEAR(flat[i], linear(x, y), 1e-5);
  }
  EXPECT_GT(inside, 30u);
}

/// The slopes across edges, by difference quotients from both sides.
double largest_jump(const Case& mesh, bool is_linear) {
  Case input = mesh;
  constexpr double kStep = 1e-8;
  input.queries.clear();
  for (std::size_t t = 0; t < input.mesh.triangles.size() / 3; ++t) {
    for (int k = 0; k < 3; ++k) {
      if (input.mesh.neighbors[3 * t + static_cast<std::size_t>(k)] < 0) continue;
      const double *a = input.point(input.corner(t, (k + 1) % 3)),
                   *b = input.point(input.corner(t, (k + 2) % 3));
      const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
      const double x = 0.6 * a[0] + 0.4 * b[0], y = 0.6 * a[1] + 0.4 * b[1];
      const double dx = kStep * (a[1] - b[1]) / length, dy = kStep * (b[0] - a[0]) / length;
      input.queries.insert(input.queries.end(), {x - dx, y - dy, x, y, x + dx, y + dy});
    }
  }
  input.query_offsets = {0, input.query_count()};
  Located located("own", input);
  const std::vector<double> values = values_for(input.size());
  const auto f =
      is_linear ? located.values_by(interpolate::linear, values, 1) : clough_tocher(located, values, 1);
  double most = 0;
  for (std::size_t i = 0; i < f.size(); i += 3) {
    most = std::max(most, std::fabs((f[i + 2] - f[i + 1]) - (f[i + 1] - f[i])) / kStep);
  }
  return most;
}

TEST(SmallInterpolation, CloughTocherIsSmooth) {
  for (const char* const name : {"uniform", "grid"}) {
    Case input = make_case(make_fixture(name, 36, 7), 1, 8);
    EXPECT_GT(largest_jump(input, true), 1);
    EXPECT_LT(largest_jump(input, false), 0.05);
  }
}

/// Only the units of gradients depend on those of points.
TEST(SmallInterpolation, Scales) {
  const Case small = nested_case(20, 3);
  const std::vector<double> values = values_for(small.size());
  for (const int shift : {-400, 300}) {
    Case large = small;
    for (double& x : large.points) x = std::ldexp(x, shift);
    for (double& x : large.queries) x = std::ldexp(x, shift);
    Located one("own", small), other("own", large);
    EXPECT_EQ(bytes_of(clough_tocher(one, values, 1)), bytes_of(clough_tocher(other, values, 1)));
    std::vector<double> found = gradients_of("own", large, values, 1);
    const std::vector<double> expected = gradients_of("own", small, values, 1);
    for (double& g : found) g = g == kOutside ? g : std::ldexp(g, shift);
    EXPECT_EQ(bytes_of(found), bytes_of(expected));
    Located located("own", large);
    std::vector<double> slopes = expected;
    for (double& g : slopes) g = std::ldexp(g, -shift);
    EXPECT_EQ(bytes_of(clough_tocher(located, values, 1, &slopes)), bytes_of(clough_tocher(one, values, 1)));
  }
}

/// A NaN shows where it counts.
TEST(SmallInterpolation, ValuesThatAreNotFinite) {
  Case input;
  input.add({0, 0, 4, 0, 0, 4, 4, 4}, {0, 0, 4, 0, 1, 1, 3, 3.5});
  input.triangulate();
  const std::vector<double> values{std::nan(""), 2, 3, 4}, slopes(8, 1.0);
  Located located("own", input);
  const auto results = clough_tocher(located, values, 1, &slopes);
  EXPECT_TRUE(std::isnan(results[0]));
  EXPECT_EQ(results[1], 2);
  EXPECT_TRUE(std::isnan(results[2]));
}

TEST(InterpolationKernels, AllAreLaunched) {
  std::set<std::string> launched;
  const Case input = nested_case(30, 3);
  Located located("own", input);
  located.runtime.set_profiling(true);
  const std::vector<double> values = values_for(input.size());
  located.values_by(interpolate::linear, values, 1);
  located.values_by(interpolate::nearest, values, 1);
  const std::vector<double> gradients = gradients_of("own", input, values, 1);
  clough_tocher(located, values, 1, &gradients);
  // Vertices that are all in their places, as if there were images of others.
  const std::vector<double> expected = clough_tocher(located, values, 1);
  std::vector<cl_int> in_place(located.locator.points.size());
  std::iota(in_place.begin(), in_place.end(), 0);
  located.locator.in_place = located.runtime.upload(located.own, std::move(in_place));
  EXPECT_EQ(bytes_of(expected), bytes_of(clough_tocher(located, values, 1)));
  for (const auto& [name, time] : located.runtime.kernel_times()) launched.insert(name);
  located.runtime.set_profiling(false);
  std::size_t kernels = 0;
  for (const char* const file :
       {"interpolate/clough_tocher", "interpolate/gradients", "interpolate/linear"}) {
    const std::string source = host::kernel_source(file);
    const std::regex pattern("\nkernel void (\\w+)\\(");
    for (std::sregex_iterator it(source.begin(), source.end(), pattern), end; it != end; ++it) {
      EXPECT_EQ(launched.count((*it)[1]), 1u) << (*it)[1] << " of " << file << ".cl";
      ++kernels;
    }
  }
  EXPECT_EQ(kernels, 9u);
}

}  // namespace
}  // namespace flaunay::locate
