// Queries for triangles, nearest points and interpolated values, against twins by brute force in exact
// arithmetic.
//
// Suites named Small... have tiny inputs, for slow simulators: tests/oclgrind.sh.
#include <fmt/format.h>
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "locate/locator.hpp"
#include "tests/locate/support.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::locate {
namespace {

struct Answers {
  std::vector<cl_int> triangles, nearest;
  std::vector<double> values;
};

Answers ask(Runtime& runtime, const Case& input, const std::vector<double>& values) {
  Arena own(runtime.memory());
  if (runtime.sizes().separate_buffers) own.separate_buffers();
  Arena::Scope scope(runtime.arena());
  const Locator locator = make_locator(runtime, own, upload_mesh(runtime, input));
  const std::size_t m = input.query_count();
  const auto queries = upload(runtime, input.queries);
  const auto triangles = guarded<cl_int>(runtime, m), points = guarded<cl_int>(runtime, m);
  const auto results = guarded<cl_double>(runtime, m);
  locate(runtime, locator, queries, m, input.query_offsets, triangles);
  nearest(runtime, locator, queries, m, input.query_offsets, points);
  interpolate(runtime, locator, upload(runtime, values), queries, m, input.query_offsets, results);
  return {download(runtime, triangles, m), download(runtime, points, m), download(runtime, results, m)};
}

bool contains(const Case& input, std::size_t t, const double* q) {
  for (int k = 0; k < 3; ++k) {
    if (reference_orient2d(input.point(input.corner(t, k)), input.point(input.corner(t, (k + 1) % 3)), q) < 0)
      return false;
  }
  return true;
}

mpq_class distance(const double* a, const double* b) {
  const mpq_class x = mpq_class(a[0]) - mpq_class(b[0]), y = mpq_class(a[1]) - mpq_class(b[1]);
  return x * x + y * y;
}

cl_int triangle_twin(const Case& input, std::size_t set, const double* q) {
  for (std::size_t t = input.mesh.triangle_offsets[set]; t < input.mesh.triangle_offsets[set + 1]; ++t) {
    if (contains(input, t, q)) return static_cast<cl_int>(t);
  }
  return -1;
}

cl_int nearest_twin(const Case& input, std::size_t set, const double* q) {
  cl_int best = -1;
  mpq_class least;
  for (std::size_t i = input.offsets[set]; i < input.offsets[set + 1]; ++i) {
    const auto index = static_cast<cl_int>(i);
    const mpq_class d = distance(input.point(index), q);
    const auto place = [&](cl_int p) { return std::make_pair(input.point(p)[0], input.point(p)[1]); };
    if (best < 0 || d < least || (d == least && place(index) < place(best))) {
      best = index;
      least = d;
    }
  }
  return best;
}

mpq_class area(const double* a, const double* b, const double* c) {
  return (mpq_class(a[0]) - mpq_class(c[0])) * (mpq_class(b[1]) - mpq_class(c[1])) -
         (mpq_class(a[1]) - mpq_class(c[1])) * (mpq_class(b[0]) - mpq_class(c[0]));
}

double value_twin(const Case& input, cl_int triangle, const std::vector<double>& values, const double* q) {
  if (triangle < 0) return std::nan("");
  mpq_class sum = 0, whole = 0;
  for (int k = 0; k < 3; ++k) {
    const auto t = static_cast<std::size_t>(triangle);
    const mpq_class weight =
        area(input.point(input.corner(t, (k + 1) % 3)), input.point(input.corner(t, (k + 2) % 3)), q);
    whole += weight;
    sum += weight * mpq_class(values[static_cast<std::size_t>(input.corner(t, k))]);
  }
  return mpq_class(sum / whole).get_d();
}

void check_answers(const Case& input, const std::vector<std::string>& names = tunings()) {
  const std::vector<double> values = values_for(input.size());
  std::vector<cl_int> triangles, points;
  std::vector<double> results;
  for (std::size_t s = 0; s < input.sets(); ++s) {
    for (std::size_t i = input.query_offsets[s]; i < input.query_offsets[s + 1]; ++i) {
      triangles.push_back(triangle_twin(input, s, input.query(i)));
      points.push_back(nearest_twin(input, s, input.query(i)));
      results.push_back(value_twin(input, triangles.back(), values, input.query(i)));
    }
  }
  std::unique_ptr<Answers> first;
  for (const std::string& name : names) {
    SCOPED_TRACE("tuning " + name);
    const Answers answers = ask(Runtimes::get(name), input, values);
    EXPECT_TRUE(same(answers.triangles, triangles));
    EXPECT_TRUE(same(answers.nearest, points));
    for (std::size_t i = 0; i < results.size(); ++i) {
      ASSERT_EQ(std::isnan(answers.values[i]), std::isnan(results[i])) << i;
      if (triangles[i] < 0) continue;
      ASSERT_NEAR(answers.values[i], results[i], 0x1p-38) << i;
      if (distance(input.point(points[i]), input.query(i)) == 0) {
        ASSERT_EQ(answers.values[i], values[static_cast<std::size_t>(
                                         input.mesh.representatives[static_cast<std::size_t>(points[i])])]);
      }
    }
    if (first) {
      // As bytes, since NaN is not equal to itself.
      const auto bytes = [](const std::vector<double>& numbers) {
        return std::string(reinterpret_cast<const char*>(numbers.data()), 8 * numbers.size());
      };
      EXPECT_EQ(bytes(first->values), bytes(answers.values));
    } else {
      first = std::make_unique<Answers>(answers);
    }
  }
}

TEST(SmallLocate, NestedSets) {
  const Case input = nested_case(9, 2);
  check_answers(input);
}

TEST(SmallLocate, ASetWithATree) {
  const Case input = make_case(make_fixture("uniform", 300, 6), 3, 7);
  check_answers(input);
}

TEST(SmallLocate, Grid) {
  const Case input = make_case(make_fixture("grid", 25, 8), 8, 9);
  check_answers(input);
}

TEST(SmallLocate, NothingAtAll) {
  for (const Offsets& offsets : {Offsets{0}, Offsets{0, 0}, Offsets{0, 0, 0}}) {
    Case input;
    input.offsets = input.query_offsets = offsets;
    input.triangulate();
    check_answers(input);
  }
}

/// Answers with queries sorted and not, which must be the same bytes.
void check_orders(const Case& input) {
  const std::vector<double> values = values_for(input.size());
  std::unique_ptr<Answers> first;
  for (const std::string& name : tunings()) {
    Runtime& runtime = Runtimes::get(name);
    const Tuning before = tuning_of(runtime);
    for (const std::size_t least : {std::size_t{0}, input.query_count() + 1}) {
      SCOPED_TRACE(fmt::format("tuning {}, sorted from {} on", name, least));
      Tuning tuning = before;
      tuning.sorted_queries_least = least;
      runtime.set_sizes(std::make_shared<Tuning>(tuning));
      const Answers answers = ask(runtime, input, values);
      if (!first) first = std::make_unique<Answers>(answers);
      EXPECT_TRUE(same(answers.triangles, first->triangles));
      EXPECT_TRUE(same(answers.nearest, first->nearest));
      EXPECT_EQ(
          std::memcmp(answers.values.data(), first->values.data(), sizeof(double) * answers.values.size()),
          0);
    }
    runtime.set_sizes(std::make_shared<Tuning>(before));
  }
}

TEST(SmallLocate, TheOrderOfQueriesDoesNotShow) {
  const Case input = case_of_trees(270, 2);
  check_orders(input);
  check_answers(input);
}

TEST(Locate, TheOrderOfManyQueriesDoesNotShow) {
  const Case input = case_of_trees(2000, 500);
  ASSERT_GT(input.query_count(), tuning_for(host::find_device(""))->sorted_queries_least);
  check_orders(input);
}

TEST(Locate, EveryFixture) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Case input = make_case(fixture.make(330, 11), 30, 12);
    check_answers(input);
  }
}

TEST(Locate, ManySets) {
  const Case input = nested_case(100, 12);
  check_answers(input);
}

/// Three points, seen from everywhere.
TEST(Locate, EveryQueryOfATriangle) {
  Case input;
  Coordinates queries;
  for (int x = -4; x <= 16; ++x) {
    for (int y = -4; y <= 16; ++y) queries.insert(queries.end(), {x * 0.5, y * 0.5});
  }
  input.add({0, 0, 4, 0, 0, 4}, queries);
  input.triangulate();
  check_answers(input);
}

/// Each cell's middle is as near to four points, and each edge's to two.
TEST(Locate, EveryQueryOfAGrid) {
  Case input;
  Coordinates points, queries;
  for (int x = 0; x < 7; ++x) {
    for (int y = 0; y < 7; ++y) points.insert(points.end(), {x * 1.0, y * 1.0});
  }
  for (int x = -2; x <= 14; ++x) {
    for (int y = -2; y <= 14; ++y) queries.insert(queries.end(), {x * 0.5, y * 0.5});
  }
  input.add(points, queries);
  input.triangulate();
  check_answers(input);
}

/// Magnitudes of all kinds, in which queries may be finer and farther than points.
TEST(Locate, Magnitudes) {
  const Coordinates points = make_fixture("uniform", 60, 13);
  for (const double factor : {0x1p960, 0x1p-900, 0x1p300, 0x1p-300, 1.0}) {
    SCOPED_TRACE(factor);
    Case input = make_case(testing::scaled(points, factor), 6, 14);
    if (factor == 1.0) {
      for (const double q : {0x1p-450, 0x1p450, 0x1p508}) {
        input.queries.insert(input.queries.end(), {0.5, q, -q, 0.5, q, q});
        input.query_offsets.back() += 3;
        check_answers(input);
        input.queries.resize(input.queries.size() - 6);
        input.query_offsets.back() -= 3;
      }
    }
    check_answers(input);
  }
}

std::string message_of(const std::function<void()>& action, ErrorKind kind) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  return "no error";
}

TEST(SmallErrors, QueriesThatCannotBeDecided) {
  Runtime& runtime = Runtimes::get("own");
  const auto message = [&](const Coordinates& queries, ErrorKind kind = ErrorKind::input,
                           Offsets offsets = {}) {
    Case input;
    input.add({0, 0, 1, 0, 0, 1}, queries);
    input.triangulate();
    if (!offsets.empty()) input.query_offsets = offsets;
    return message_of([&] { ask(runtime, input, {1, 2, 3}); }, kind);
  };
  EXPECT_EQ(message({0.5, 0.5, 0, std::nan("")}), "query 1 is not finite: (0, nan)");
  EXPECT_EQ(message({HUGE_VAL, 0.5, 0, std::nan("")}), "query 0 is not finite: (inf, 0.5)");
  EXPECT_NE(message({0.5, 0.5, 0, 0, 0.25, 0x1p-1070}).find("query 2 is too fine to be exact: it has y = "),
            std::string::npos);
  EXPECT_NE(message({0.5, 0.5, 0x1p1023, 0x1p-10}).find("query 1 is too far to be exact: it has x = "),
            std::string::npos);
  EXPECT_NE(message({0.5, 0.5}, ErrorKind::usage, {0, 2}).find("end with 2; there are 1 queries"),
            std::string::npos);
  EXPECT_NE(message({0.5, 0.5}, ErrorKind::usage, {0, 1, 1}).find("of 2 sets"), std::string::npos);
}

TEST(SmallErrors, MeshesThatAreNone) {
  Runtime& runtime = Runtimes::get("own");
  const Case whole = make_case(make_fixture("uniform", 20, 16), 3, 17);
  const auto message = [&](const std::function<void(Triangulation&)>& change) {
    Case input = whole;
    change(input.mesh);
    return message_of([&] { ask(runtime, input, values_for(input.size())); }, ErrorKind::input);
  };
  const std::string triangle = "triangle 3 is not that of a triangulation";
  const auto starts = [&](const std::string& text, const std::string& with) {
    return text.substr(0, with.size()) == with;
  };
  EXPECT_TRUE(starts(message([](Triangulation& m) { m.triangles[10] = 20; }), "triangle"));
  EXPECT_TRUE(starts(message([](Triangulation& m) { m.triangles[10] = -1; }), "triangle"));
  EXPECT_TRUE(starts(message([](Triangulation& m) { m.triangles[10] = m.triangles[9]; }), "triangle"));
  EXPECT_TRUE(
      starts(message([](Triangulation& m) { std::swap(m.neighbors[9], m.neighbors[10]); }), triangle));
  EXPECT_TRUE(starts(message([](Triangulation& m) { m.neighbors[9] = 3; }), triangle));
  EXPECT_TRUE(starts(message([](Triangulation& m) { m.neighbors[9] = 100000; }), triangle));
  EXPECT_TRUE(starts(message([](Triangulation& m) { m.neighbors[9] = -2; }), triangle));
  EXPECT_TRUE(starts(message([](Triangulation& m) { m.hull[2] = 20; }), "hull vertex 2"));
  EXPECT_TRUE(starts(message([](Triangulation& m) { m.representatives[4] = -1; }), "representative 4"));
  EXPECT_EQ(message([](Triangulation&) {}), "no error");
  Case larger = whole;
  larger.mesh.triangle_offsets.back() = 41;
  EXPECT_TRUE(starts(message_of([&] { ask(runtime, larger, {}); }, ErrorKind::input),
                     "20 points cannot have 41 triangles"));
}

/// Cells of such meshes mean nothing, but there are some. (Not for oclgrind: a vertex that has several cells
/// then gets any of them.)
TEST(Errors, CellsOfMeshesThatAreNone) {
  Runtime& runtime = Runtimes::get("own");
  const Case whole = make_case(make_fixture("uniform", 20, 16), 3, 17);
  const std::vector<std::function<void(Triangulation&)>> changes = {
      [](Triangulation& m) { m.triangles[10] = 20; },
      [](Triangulation& m) { m.triangles[10] = -1; },
      [](Triangulation& m) { m.triangles[10] = m.triangles[9]; },
      [](Triangulation& m) { std::swap(m.neighbors[9], m.neighbors[10]); },
      [](Triangulation& m) { m.neighbors[9] = 3; },
      [](Triangulation& m) { m.neighbors[9] = 100000; },
      [](Triangulation& m) { m.neighbors[9] = -2; },
      [](Triangulation& m) { m.hull[2] = 20; },
      [](Triangulation& m) { m.representatives[4] = -1; },
  };
  for (const auto& change : changes) {
    Case input = whole;
    change(input.mesh);
    dual(runtime, input);
  }
}

/// Points at wrong places: answers mean nothing, but there are some.
TEST(SmallErrors, WalksEndWhateverThePoints) {
  Case input = make_case(make_fixture("uniform", 80, 18), 20, 19);
  FixtureRandom random(20);
  for (double& c : input.points) c = random.unit();
  ask(Runtimes::get("own"), input, values_for(input.size()));
}

/// A NaN at a corner does not show where that corner has no weight.
TEST(SmallLocate, ValuesThatAreNotFinite) {
  Case input;
  input.add({0, 0, 4, 0, 0, 4}, {0, 0, 2, 2, 4, 0, 1, 1, 0, 4});
  input.triangulate();
  const Answers answers = ask(Runtimes::get("own"), input, {std::nan(""), 2, HUGE_VAL});
  EXPECT_TRUE(std::isnan(answers.values[0]));
  EXPECT_EQ(answers.values[1], HUGE_VAL);
  EXPECT_EQ(answers.values[2], 2);
  EXPECT_TRUE(std::isnan(answers.values[3]));
  EXPECT_EQ(answers.values[4], HUGE_VAL);
}

/// Checked where it is checked without the twins, which would take too long.
TEST(Locate, AMillionQueries) {
  const std::size_t n = 1000000;
  FixtureRandom random(21);
  Case input;
  Coordinates queries;
  for (std::size_t i = 0; i < 2 * n; ++i) queries.push_back(random.unit() * 1.02 - 0.51);
  const Coordinates points = make_fixture("uniform", n, 22);
  double low = points[0], high = points[0];
  for (const double c : points) low = std::min(low, c), high = std::max(high, c);
  for (double& q : queries) q = (low + high) / 2 + q * (high - low);
  for (std::size_t i = 0; i < 1000; ++i) queries[i] = points[i];
  input.add(points, queries);
  input.triangulate();
  const Answers answers = ask(Runtimes::get("own"), input, values_for(n));
  for (std::size_t i = 0; i < n; i += i < 500 ? 10 : 997) {
    const cl_int t = answers.triangles[i];
    const double* const q = input.query(i);
    if (t < 0) {
      EXPECT_TRUE(q[0] < low + 0.02 * (high - low) || q[0] > high - 0.02 * (high - low) ||
                  q[1] < low + 0.02 * (high - low) || q[1] > high - 0.02 * (high - low));
    } else {
      EXPECT_TRUE(contains(input, static_cast<std::size_t>(t), q)) << i;
    }
    if (i >= 500 && i % 9970 != 500) continue;
    double least = HUGE_VAL;
    std::size_t nearest_point = 0;
    for (std::size_t p = 0; p < n; ++p) {
      const double d = std::hypot(points[2 * p] - q[0], points[2 * p + 1] - q[1]);
      if (d < least) least = d, nearest_point = p;
    }
    EXPECT_EQ(answers.nearest[i], static_cast<cl_int>(nearest_point));
  }
}

TEST(Kernels, AllAreLaunched) {
  std::set<std::string> launched;
  Runtime& runtime = Runtimes::get("own");
  runtime.set_profiling(true);
  const Case input = case_of_trees(270, 500);
  ASSERT_GT(input.query_count(), tuning_for(host::find_device(""))->sorted_queries_least);
  ask(runtime, input, values_for(input.size()));
  dual(runtime, input);
  for (const auto& [name, time] : runtime.kernel_times()) launched.insert(name);
  runtime.set_profiling(false);
  std::size_t kernels = 0;
  for (const char* const file : {"locate/locate", "voronoi/voronoi"}) {
    const std::string source = host::kernel_source(file);
    const std::regex pattern("\nkernel void (\\w+)\\(");
    for (std::sregex_iterator it(source.begin(), source.end(), pattern), end; it != end; ++it) {
      EXPECT_EQ(launched.count((*it)[1]), 1u) << (*it)[1] << " of " << file << ".cl";
      ++kernels;
    }
  }
  EXPECT_EQ(kernels, 17u);
}

}  // namespace
}  // namespace flaunay::locate
