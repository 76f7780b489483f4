// Queries for triangles, nearest points and interpolated values, against twins by brute force in exact
// arithmetic.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include <fmt/format.h>
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "blocks/run.hpp"
#include "derived/interpolate/interpolate.hpp"
#include "derived/locate/levels.hpp"
#include "derived/locate/locator.hpp"
#include "flaunay/neighbors.hpp"
#include "host/opencl/programs.hpp"
#include "locate/nearest_search.h"
#include "locate/off_grid.h"
#include "prove/exact.hpp"
#include "tests/locate/support.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::locate {
namespace {

bool is_fixed_point(const Runtime& runtime) { return runtime.capabilities().fixed_point; }

/// Those of tests that compute in fixed point, too, which is not done natively.
std::vector<std::string> tunings_with_fixed_point() {
  std::vector<std::string> names = tunings();
  if (names.size() > 1 && !testing::tests_native()) {
    names.insert(names.end(), {"fixed_point=1", "small,fixed_point=1", "gpu,fixed_point=1"});
  }
  return names;
}

/// In fixed point without values.
struct Answers {
  std::vector<cl_int> triangles, nearest;
  std::vector<double> values;
};

Fitted<Answers> ask_if_it_fits(Runtime& runtime, const Case& input, const std::vector<double>& values) {
  Arena own(runtime.memory());
  Arena::Scope scope(runtime.arena());
  Fitted<Locator> fitted = make_locator(runtime, own, upload_mesh(runtime, input), blocks::run);
  if (!fitted) return fitted.too_wide();
  Locator locator = *std::move(fitted);
  const std::size_t m = input.query_count();
  const auto queries = upload(runtime, input.queries);
  const auto triangles = guarded<cl_int>(runtime, m), points = guarded<cl_int>(runtime, m);
  const auto results = guarded<cl_double>(runtime, m);
  const Fitted<Done> located = locate(runtime, locator, queries, m, input.query_offsets, triangles);
  if (!located) return located.too_wide();
  const Fitted<Done> found = nearest(runtime, locator, queries, m, input.query_offsets, points);
  if (!found) return found.too_wide();
  Answers answers{download(runtime, triangles, m), download(runtime, points, m), {}};
  if (is_fixed_point(runtime)) return answers;
  interpolate::linear(runtime, locator, {upload(runtime, values), 1, std::nan("")}, queries, m,
                      input.query_offsets, results);
  answers.values = download(runtime, results, m);
  return answers;
}

Answers ask(Runtime& runtime, const Case& input, const std::vector<double>& values) {
  return *ask_if_it_fits(runtime, input, values);
}

/// The triangles of queries by a locator for constraints, of which there are none, that has left out
/// triangles from `kept` on.
std::vector<cl_int> ask_constrained(Runtime& runtime, const Case& input, std::size_t kept) {
  Arena own(runtime.memory());
  Arena::Scope scope(runtime.arena());
  Locator locator = *make_locator(runtime, own, upload_mesh(runtime, input), blocks::run);
  constrain(runtime, own, std::vector<cl_uchar>(3 * kept), locator);
  const std::size_t m = input.query_count();
  const auto triangles = guarded<cl_int>(runtime, m);
  *locate(runtime, locator, upload(runtime, input.queries), m, input.query_offsets, triangles);
  return download(runtime, triangles, m);
}

bool contains(const Case& input, std::size_t t, const double* q) {
  static ExactPredicates exact;
  for (int k = 0; k < 3; ++k) {
    if (exact.orient2d(input.point(input.corner(t, k)), input.point(input.corner(t, (k + 1) % 3)), q) < 0)
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
  double about_least = 0;
  for (std::size_t i = input.offsets[set]; i < input.offsets[set + 1]; ++i) {
    const auto index = static_cast<cl_int>(i);
    // Most points are out of question by rounded numbers, if these neither overflow nor underflow.
    const double x = input.point(index)[0] - q[0], y = input.point(index)[1] - q[1], about = x * x + y * y;
    if (about_least > 1e-290 && about > 1.001 * about_least && about < 1e300) continue;
    const mpq_class d = distance(input.point(index), q);
    const auto place = [&](cl_int p) { return std::make_pair(input.point(p)[0], input.point(p)[1]); };
    if (best < 0 || d < least || (d == least && place(index) < place(best))) {
      best = index;
      least = d;
      about_least = about;
    }
  }
  return best;
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

/// Whether a set's points do not fit into fixed point, or its queries are very much finer or farther away.
bool is_too_wide(const Case& input, std::size_t set) {
  const Magnitudes points =
      geometry::inspect(input.points.data(), input.offsets[set], input.offsets[set + 1]);
  const Magnitudes of_queries =
      geometry::inspect(input.queries.data(), input.query_offsets[set], input.query_offsets[set + 1]);
  return bits_of(points) > kernel::COORDINATE_BITS ||
         points.lowest - of_queries.lowest > kernel::FINER_PLACES ||
         of_queries.largest - points.largest > kernel::FINER_PLACES - 2;
}

/// Answers; in fixed point none if these refuse what is too wide.
Fitted<Answers> checked_answers(Runtime& runtime, const Case& input, const std::vector<double>& values) {
  Fitted<Answers> answers = ask_if_it_fits(runtime, input, values);
  if (answers) return answers;
  bool is_any = false;
  for (std::size_t s = 0; s < input.sets(); ++s) is_any = is_any || is_too_wide(input, s);
  EXPECT_TRUE(is_fixed_point(runtime) && is_any);
  return answers;
}

/// expected: by the twin, for answers that are right otherwise.
void check_values(const Case& input, const Answers& answers, const std::vector<double>& expected,
                  const std::vector<double>& values) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(std::isnan(answers.values[i]), std::isnan(expected[i])) << i;
    if (answers.triangles[i] < 0) continue;
    ASSERT_NEAR(answers.values[i], expected[i], 0x1p-38) << i;
    if (distance(input.point(answers.nearest[i]), input.query(i)) == 0) {
      ASSERT_EQ(answers.values[i],
                values[static_cast<std::size_t>(
                    input.mesh.representatives[static_cast<std::size_t>(answers.nearest[i])])]);
    }
  }
}

/// Returns how many of the tunings that compute in fixed point did.
int check_answers(const Case& input, const std::vector<std::string>& names = tunings_with_fixed_point()) {
  int in_fixed_point = 0;
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
    Runtime& runtime = Runtimes::get(name);
    const Fitted<Answers> all = checked_answers(runtime, input, values);
    if (!all) continue;
    const Answers& answers = *all;
    EXPECT_TRUE(same(answers.triangles, triangles));
    EXPECT_TRUE(same(answers.nearest, points));
    in_fixed_point += is_fixed_point(runtime);
    if (is_fixed_point(runtime)) continue;
    check_values(input, answers, results, values);
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
  return in_fixed_point;
}

/// That they are answered in fixed point, too.
void check_all_answers(const Case& input) {
  const auto names = tunings_with_fixed_point();
  const auto fixed = std::count_if(names.begin(), names.end(),
                                   [](const auto& name) { return is_fixed_point(Runtimes::get(name)); });
  EXPECT_EQ(check_answers(input), fixed);
}

TEST(SmallLocate, NestedSets) {
  const Case input = nested_case(9, 2);
  check_answers(input);
}

TEST(SmallLocate, ASetWithATree) {
  const Case input = make_case(make_fixture("uniform", 300, 6), 3, 7);
  check_all_answers(input);
}

TEST(SmallLocate, Grid) {
  const Case input = make_case(make_fixture("grid", 25, 8), 8, 9);
  check_all_answers(input);
}

TEST(SmallLocate, NothingAtAll) {
  for (const Offsets& offsets : {Offsets{0}, Offsets{0, 0}, Offsets{0, 0, 0}}) {
    Case input;
    input.offsets = input.query_offsets = offsets;
    input.triangulate();
    check_answers(input);
  }
}

/// Answers with queries sorted and not, which must be the same bytes. In fixed point, if the points fit.
void check_orders(const Case& input) {
  const std::vector<double> values = values_for(input.size());
  std::unique_ptr<Answers> first;
  for (const std::string& name : tunings_with_fixed_point()) {
    Runtime& runtime = Runtimes::get(name);
    const Tuning before = tuning_of(runtime);
    for (const std::size_t least : {std::size_t{0}, input.query_count() + 1}) {
      SCOPED_TRACE(fmt::format("tuning {}, sorted from {} on", name, least));
      Tuning tuning = before;
      tuning.sorted_queries_least = least;
      runtime.set_sizes(std::make_shared<Tuning>(tuning));
      const Fitted<Answers> all = checked_answers(runtime, input, values);
      if (!all) continue;
      const Answers& answers = *all;
      if (!first) first = std::make_unique<Answers>(answers);
      EXPECT_TRUE(same(answers.triangles, first->triangles));
      EXPECT_TRUE(same(answers.nearest, first->nearest));
      if (is_fixed_point(runtime)) continue;
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
  const Case fits = make_case(make_fixture("uniform", 270, 28), 4, 29);
  check_orders(fits);
  check_all_answers(fits);
}

TEST(Locate, TheOrderOfManyQueriesDoesNotShow) {
  const Case input = case_of_trees(2000, 500);
  ASSERT_GT(input.query_count(), settings_for(host::find_device("")).sizes->tuning().sorted_queries_least);
  check_orders(input);
}

TEST(Locate, EveryFixture) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Case input = make_case(fixture.make(330, 11), 10, 12);
    check_answers(input);
  }
}

TEST(Locate, ManySets) {
  const Case input = nested_case(100, 12);
  check_answers(input);
}

/// Queries of a circle around (0, 0) with this radius: at its centre, very near it, inside, on the line
/// through the leftmost point, and far outside.
Coordinates circle_queries(double radius, std::size_t m, std::uint64_t seed) {
  FixtureRandom random(seed);
  Coordinates queries{0, 0, -radius, 0, -radius / 3, 0, -3 * radius, 0};
  for (const double reach : {0x1p-50, 0x1p-20, 0.7, 1.4, 1e6}) {
    for (std::size_t i = 0; i < 2 * m; ++i) queries.push_back(radius * reach * (2 * random.unit() - 1));
  }
  return queries;
}

double radius_of(const Coordinates& points) { return points.empty() ? 1 : std::hypot(points[0], points[1]); }

/// Sets in which some vertices have very many neighbours, or walks lead past very many points, with queries
/// for which that matters. `n` points each, or a few.
Case case_of_hubs(std::size_t n, std::size_t m) {
  Case result;
  const auto add = [&](const Coordinates& points) {
    Coordinates queries = make_queries(points, m, result.sets());
    const Coordinates more = circle_queries(radius_of(points), m, result.sets());
    queries.insert(queries.end(), more.begin(), more.end());
    result.add(points, queries);
  };
  add(make_fixture("integer-circle", n, 1));
  add({});
  add({3, 4, 0, 0});
  add(make_fixture("circle", n, 2));
  add(make_fixture("star", n, 3));
  add(make_fixture("integer-star", n / 8, 4));
  Coordinates doubled = make_fixture("integer-circle", n / 2, 5);
  doubled.insert(doubled.end(), doubled.begin(), doubled.end());
  add(doubled);
  add(make_fixture("apex", n, 6));
  add(make_fixture("collinear", n, 7));
  Coordinates ellipse = make_fixture("circle", n, 8);
  for (std::size_t i = 1; i < ellipse.size(); i += 2) ellipse[i] /= 2;
  add(ellipse);
  // The centre's neighbour is near, so that it is not clear by far.
  Coordinates near_centre = make_fixture("star", n, 9);
  near_centre.insert(near_centre.end(), {0x1p-10, 0});
  add(near_centre);
  result.triangulate();
  return result;
}

TEST(SmallLocate, Hubs) {
  const Case input = case_of_hubs(96, 2);
  check_answers(input);
}

TEST(Locate, Hubs) {
  const Case input = case_of_hubs(1200, 8);
  check_answers(input);
}

TEST(Locate, TheOrderOfQueriesOfHubsDoesNotShow) {
  const Case input = case_of_hubs(3000, 300);
  check_orders(input);
}

TEST(SmallLevels, SampleSizes) {
  const SampleSizes sizes = sample_sizes({700, 5, 90}, 4);
  EXPECT_EQ(sizes.levels, 3u);
  EXPECT_EQ(sizes.sets, 3u);
  EXPECT_EQ(sizes.offsets, (Offsets{0, 175, 176, 198, 241, 241, 246, 256, 256, 257}));
  EXPECT_EQ(sample_sizes({3}, 4).levels, 0u);
  EXPECT_EQ(sample_sizes({4}, 4).levels, 1u);
  EXPECT_EQ(sample_sizes({}, 4).levels, 0u);
}

template <typename T>
std::vector<T> all_of(Runtime& runtime, const host::Buffer<T>& buffer) {
  std::vector<T> values(buffer.size());
  runtime.read(buffer, 0, values.size(), values.data());
  return values;
}

/// A locator's arrays that the search through levels reads, in the test's memory.
struct LocatorOnHost {
  LocatorOnHost(Runtime& runtime, const Locator& locator)
      : points(all_of(runtime, locator.points)),
        hull_points(all_of(runtime, locator.hull_points)),
        faces(all_of(runtime, locator.faces)),
        clearances(all_of(runtime, locator.clearances)),
        source(all_of(runtime, locator.source)),
        hull(all_of(runtime, locator.hull)),
        records(all_of(runtime, locator.records)) {}

  kernel::star_mesh with(const std::vector<cl_int>& starts, const std::vector<kernel::fan_part>& fans) const {
    return {reinterpret_cast<const kernel::double2*>(points.data()), faces.data(), clearances.data(),
            starts.data(), fans.data()};
  }

  std::vector<cl_double2> points, hull_points;
  std::vector<kernel::face> faces;
  std::vector<cl_int> clearances, source, hull;
  std::vector<kernel::mesh_set> records;
};

/// What the search through levels looks at on average, for queries of one set. Its answers must be those of
/// nearest().
double looked_at(const Case& input) {
  Runtime& runtime = Runtimes::get("own");
  Arena own(runtime.memory());
  Arena::Scope scope(runtime.arena());
  Locator locator = *make_locator(runtime, own, upload_mesh(runtime, input), blocks::run);
  const std::size_t m = input.query_count();
  const auto answers = guarded<cl_int>(runtime, m);
  *nearest(runtime, locator, upload(runtime, input.queries), m, input.query_offsets, answers);
  if (locator.levels.count == 0) make_levels(runtime, locator);
  const std::vector<cl_int> expected = download(runtime, answers, m);
  const Levels& levels = locator.levels;
  const LocatorOnHost mesh(runtime, locator), samples(runtime, *locator.samples);
  const auto starts = all_of(runtime, levels.stars.starts);
  const auto sample_starts = all_of(runtime, levels.sample_stars.starts);
  const auto fans = all_of(runtime, levels.stars.fans);
  const auto sample_fans = all_of(runtime, levels.sample_stars.fans);
  const auto below = all_of(runtime, levels.below);
  const auto boxes = all_of(runtime, levels.boxes);
  const kernel::level_meshes on{static_cast<int>(levels.count),
                                static_cast<int>(levels.sets),
                                samples.records.data(),
                                samples.source.data(),
                                below.data(),
                                reinterpret_cast<const kernel::double2*>(samples.hull_points.data()),
                                samples.hull.data(),
                                samples.with(sample_starts, sample_fans)};
  const int vertices = static_cast<int>(starts.size());
  double sum = 0;
  for (std::size_t i = 0; i < m; ++i) {
    const double* const q = input.query(i);
    kernel::uint looked = 0;
    const int found = kernel::nearest_by_levels({q[0], q[1]}, 0, 0, vertices, vertices, NEARNESS_BOUND, 1,
                                                mesh.with(starts, fans), boxes.data(), on, &looked);
    EXPECT_EQ(mesh.source[static_cast<std::size_t>(found)], expected[i]) << i;
    sum += looked;
  }
  return sum / static_cast<double>(m);
}

/// The box around vertices, or around boxes of the level below.
template <typename Low, typename High>
kernel::vertex_box box_twin(std::size_t first, std::size_t last, const Low& low, const High& high) {
  kernel::vertex_box box{low(first), high(first)};
  for (std::size_t i = first + 1; i < last; ++i) {
    box.low = {std::min(box.low.x, low(i).x), std::min(box.low.y, low(i).y)};
    box.high = {std::max(box.high.x, high(i).x), std::max(box.high.y, high(i).y)};
  }
  return box;
}

void check_boxes(const LocatorOnHost& mesh, std::size_t vertices,
                 const std::vector<kernel::vertex_box>& boxes) {
  constexpr auto kFan = static_cast<std::size_t>(kernel::BOX_FAN);
  const auto point = [&](std::size_t v) { return kernel::double2{mesh.points[v].s[0], mesh.points[v].s[1]}; };
  std::vector<kernel::vertex_box> expected;
  for (std::size_t v = 0; v < vertices; v += kFan) {
    expected.push_back(box_twin(v, std::min(vertices, v + kFan), point, point));
  }
  std::size_t begin = 0;
  while (expected.size() - begin > 1) {
    const std::size_t end = expected.size();
    for (std::size_t b = begin; b < end; b += kFan) {
      expected.push_back(box_twin(
          b, std::min(end, b + kFan), [&](std::size_t i) { return expected[i].low; },
          [&](std::size_t i) { return expected[i].high; }));
    }
    begin = end;
  }
  ASSERT_EQ(boxes.size(), expected.size());
  EXPECT_EQ(std::memcmp(boxes.data(), expected.data(), boxes.size() * sizeof boxes[0]), 0);
}

/// The triangle behind t in a fan, counter-clockwise about the fan's first vertex; -1 if there is none.
int next_in_fan(const LocatorOnHost& mesh, int t, int* first) {
  const auto place = [&](int v) {
    const cl_double2 p = mesh.points[static_cast<std::size_t>(v)];
    return std::make_pair(p.s[0], p.s[1]);
  };
  const kernel::face f = mesh.faces[static_cast<std::size_t>(t)];
  int k = 0;
  for (int c = 1; c < 3; ++c) {
    if (place(f.corner[c]) < place(f.corner[k])) k = c;
  }
  *first = f.corner[k];
  const int u = f.neighbor[(k + 1) % 3];
  if (u < 0) return -1;
  const kernel::face g = mesh.faces[static_cast<std::size_t>(u)];
  for (const int apex : g.corner) {
    if (apex == f.corner[0] || apex == f.corner[1] || apex == f.corner[2]) continue;
    double p[4][2];
    for (int c = 0; c < 3; ++c) std::tie(p[c][0], p[c][1]) = place(f.corner[c]);
    std::tie(p[3][0], p[3][1]) = place(apex);
    return *first >= 0 && place(*first) < place(apex) &&
                   testing::reference_incircle(p[0], p[1], p[2], p[3]) == 0
               ? u
               : -1;
  }
  return -1;
}

void check_fans(const LocatorOnHost& mesh, const std::vector<kernel::fan_part>& fans) {
  ASSERT_EQ(fans.size(), mesh.faces.size());
  for (std::size_t t = 0; t < fans.size(); ++t) {
    int vertex = -1, other = -1, last = static_cast<int>(t);
    const bool is_part = next_in_fan(mesh, last, &vertex) >= 0;
    for (int next = last; next >= 0;) {
      last = next;
      next = next_in_fan(mesh, last, &other);
      if (other != vertex) break;
    }
    ASSERT_EQ(fans[t].vertex, is_part ? vertex : -1) << t;
    ASSERT_EQ(fans[t].last, last) << t;
  }
}

/// What is made for the levels: boxes, fans, and the triangles where stars begin.
TEST(Levels, BoxesFansAndStarsAreThoseOfTwins) {
  if (is_fixed_point(Runtimes::get("own"))) GTEST_SKIP() << "the twins compute with doubles";
  for (const char* const name : {"grid", "integer-circle", "uniform", "star"}) {
    for (const std::size_t n : {9, 64, 65, 700}) {
      SCOPED_TRACE(fmt::format("{} points of {}", n, name));
      Runtime& runtime = Runtimes::get("small");
      Arena own(runtime.memory());
      Arena::Scope scope(runtime.arena());
      const Case input = make_case(make_fixture(name, n, 3), 0, 4);
      Locator locator = *make_locator(runtime, own, upload_mesh(runtime, input), blocks::run);
      make_levels(runtime, locator);
      const LocatorOnHost mesh(runtime, locator);
      const auto starts = all_of(runtime, locator.levels.stars.starts);
      check_boxes(mesh, starts.size(), all_of(runtime, locator.levels.boxes));
      check_fans(mesh, all_of(runtime, locator.levels.stars.fans));
      for (std::size_t t = 0; t < mesh.faces.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
          const auto v = static_cast<std::size_t>(mesh.faces[t].corner[k]);
          // The edge that leaves the vertex is on the hull.
          if (mesh.faces[t].neighbor[(k + 2) % 3] < 0) {
            ASSERT_EQ(starts[v], static_cast<cl_int>(t));
          }
          const kernel::face begin = mesh.faces[static_cast<std::size_t>(starts[v])];
          ASSERT_EQ(std::count(begin.corner, begin.corner + 3, mesh.faces[t].corner[k]), 1);
        }
      }
    }
  }
}

/// A box is left out only if all of it is farther than the point; and mostly if it is.
TEST(Levels, BoxesAreLeftOutByACertainMargin) {
  FixtureRandom random(5);
  const auto any = [&] { return std::ldexp(random.unit() - 0.5, static_cast<int>(random.integer(-3, 3))); };
  int beyond = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x[2] = {any(), any()}, y[2] = {any(), any()};
    const kernel::vertex_box box{{std::min(x[0], x[1]), std::min(y[0], y[1])},
                                 {std::max(x[0], x[1]), std::max(y[0], y[1])}};
    const kernel::double2 q{any(), any()};
    const double nearest[2] = {std::clamp(q.x, box.low.x, box.high.x),
                               std::clamp(q.y, box.low.y, box.high.y)};
    const double query[2] = {q.x, q.y};
    // A point as near as the box but for a few units in the last place, or any.
    kernel::double2 best{nearest[0], nearest[1]};
    if (i % 2 == 0) {
      best.x = q.x + (best.x - q.x) * (1 + 0x1p-50 * static_cast<double>(random.integer(-9, 9)));
    } else {
      best = {any(), any()};
    }
    const double of_best[2] = {best.x, best.y};
    const mpq_class box_distance = distance(nearest, query), best_distance = distance(of_best, query);
    const bool is_left_out = kernel::is_beyond(box, kernel::squared_distance(best, q), q, 1);
    if (is_left_out) {
      ASSERT_GT(box_distance, best_distance) << i;
    }
    if (box_distance > best_distance * mpq_class(1 + 0x1p-40)) {
      ASSERT_TRUE(is_left_out) << i;
    }
    beyond += is_left_out;
  }
  EXPECT_GT(beyond, 2000);
}

/// With constraints, walks that are given up go on straight.
TEST(SmallConstrained, WalksStraight) {
  for (const std::string& tuning : tunings()) {
    for (const char* const name : {"grid", "integer-circle", "uniform", "star"}) {
      SCOPED_TRACE(tuning + ", " + name);
      const Case input = make_case(make_fixture(name, 60, 6), 5, 7);
      const std::size_t triangles = input.mesh.triangles.size() / 3;
      const auto runtime = testing::make_tuned_runtime(tuning);
      for (const std::size_t most : {1, 1000}) {
        Tuning tuned = tuning_of(*runtime);
        tuned.walk_most = most;
        runtime->set_sizes(std::make_shared<Tuning>(tuned));
        for (const std::size_t kept : {triangles, triangles / 2}) {
          const std::vector<cl_int> found = ask_constrained(*runtime, input, kept);
          for (std::size_t i = 0; i < input.query_count(); ++i) {
            const cl_int twin = triangle_twin(input, 0, input.query(i));
            ASSERT_EQ(found[i], twin < static_cast<cl_int>(kept) ? twin : -1) << most << ", " << kept;
          }
        }
      }
    }
  }
}

/// The tuning of the levels changes no answer, whatever it is.
TEST(Levels, AnyTuningHasTheSameAnswers) {
  const Case input = make_case(make_fixture("star", 40, 6), 5, 7);
  const auto runtime = testing::make_tuned_runtime("own");
  for (const std::size_t ratio : {0, 1, 3, 1000000}) {
    for (const std::size_t from : {0, 1, 30}) {
      Tuning tuning = tuning_of(*runtime);
      tuning.level_ratio = ratio;
      tuning.levels_from = from;
      tuning.walk_most = 1;
      runtime->set_sizes(std::make_shared<Tuning>(tuning));
      const Answers answers = ask(*runtime, input, values_for(input.size()));
      for (std::size_t i = 0; i < input.query_count(); ++i) {
        ASSERT_EQ(answers.nearest[i], nearest_twin(input, 0, input.query(i))) << ratio << ", " << from;
      }
    }
  }
}

/// Of 16 times as many points, a query looks at some more, on one more level: not at 16 times as many.
TEST(Levels, StepsGrowByTheLogarithm) {
  if (is_fixed_point(Runtimes::get("own"))) GTEST_SKIP() << "the twin computes with doubles";
  for (const char* const name : {"integer-circle", "circle", "star", "apex", "uniform"}) {
    for (const double reach : {0.0, 0x1p-30, 0.7, 1e6}) {
      SCOPED_TRACE(fmt::format("{}, {}", name, reach));
      double looked[2];
      for (int k = 0; k < 2; ++k) {
        const Coordinates points = make_fixture(name, k == 0 ? 2250 : 36000, 3);
        FixtureRandom random(4);
        Coordinates queries;
        const double radius = radius_of(points);
        for (int i = 0; i < 600; ++i) queries.push_back(reach * radius * (2 * random.unit() - 1));
        Case input;
        input.add(points, queries);
        input.triangulate();
        looked[k] = looked_at(input);
      }
      EXPECT_LT(looked[0], 200);
      EXPECT_LT(looked[1], looked[0] + 100);
    }
  }
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
  check_all_answers(input);
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
  check_all_answers(input);
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

/// No scaling is right for all sets; queries of one are finer or farther than its points.
TEST(Locate, SetsOfEveryScale) {
  Case input;
  for (const double factor : {0x1p960, 0x1p-900, 1.0, 0x1p-300}) {
    for (const char* const name : {"uniform", "grid", "collinear"}) {
      const Coordinates points = make_fixture(name, 40, 16);
      input.add(testing::scaled(points, factor), testing::scaled(make_queries(points, 3, 17), factor));
    }
  }
  input.add(make_fixture("kuzmin", 40, 18), {0.5, 0x1p508, -0x1p450, 0.5, 0, 0});
  input.add(make_fixture("kuzmin", 40, 19), {0.5, 0x1p-450, 0x1p-450, 0, 0.25, 0.5});
  input.add({}, {0x1p1000, 1});
  input.triangulate();
  check_answers(input);
}

/// One scaling for the points, but not for all queries.
TEST(Locate, QueriesOfEveryScale) {
  Case input;
  input.add(make_fixture("uniform", 40, 20), {0.5, 0x1p508, 0.25, 0.75});
  input.add(make_fixture("uniform", 40, 21), {0.5, 0x1p-900, 0.25, 0.75});
  input.triangulate();
  check_answers(input);
}

/// Points of all the bits that fixed point has, with queries on the grid, between its places and beyond it.
TEST(SmallLocate, FixedPointIsFull) {
  const double large = 0x1p61;
  const Coordinates square = {-large, -large, large, -large, large + 0x1p9, large, -large, large, 0, 0,
                              1,      0,      0,     1};
  Case input;
  input.add(square,
            {0.25, 0.25, 0.5, 0.5, 0.5, 0x1p-20, 0x1p-64, 0x1p-64, 0.5, 0, 0.5, -0x1p-64, 1, 1, 1, 0x1p-64});
  input.add(square,
            {0, 0, 1, 0, large, 0, large + 0x1p9, large, large + 0x1p10, large, 0, -large, 0, 3 * large});
  input.add(square, {0x1p70, 0.5, 0.5, 0x1p123, -0x1p80, 0x1p80, 0x1p62, 0x1p62, -0x1p61, -0x1p61});
  // Of one place, whose middle is as near to all corners, and beside it.
  input.add({0, 0, 1, 0, 0, 1, 1, 1, -large, 0, large, 0},
            {0.5, 0.5, 0.5, 0.5 - 0x1p-50, 0.5 + 0x1p-50, 0.5, 0.5, 0.25, 0.25, 0.5, 0.5, 1, 1, 0.5});
  // The nearest place of the grid is the last one of the four.
  input.add({0, 0, -1, 0, 0, -1, -1, -1, -large, 0, large, 0}, {-0.5, -0.5, -0.5, 0, 0, -0.5});
  // On one line.
  input.add({-large, 1, 0, 1, 1, 1, 2, 1, large, 1},
            {0.5, 0.5, 0.5 + 0x1p-40, 0, 1.5 - 0x1p-40, 7, 0x1p100, 3});
  input.triangulate();
  check_all_answers(input);
  // One place more.
  input.add({-large, 0, large, 0, 0.5, 0.5}, {0, 0});
  input.triangulate();
  EXPECT_EQ(check_answers(input), 0);
}

/// Queries at equal distances between points in double precision, and normal ones: some of either are finer
/// than points.
TEST(Locate, QueriesBetweenPlaces) {
  for (const char* const name : {"uniform", "grid", "integer-circle", "collinear", "circle", "star"}) {
    SCOPED_TRACE(name);
    const Coordinates points = make_fixture(name, 200, 30);
    const double radius = radius_of(points);
    FixtureRandom random(31);
    Coordinates queries;
    for (int i = 0; i < 600; ++i) queries.push_back(radius * ((i * 7) % 600 + 1) / 599.0 * (i % 3 - 1));
    for (int i = 0; i < 600; ++i) {
      queries.push_back(radius * std::sqrt(-2 * std::log(1 - random.unit())) *
                        std::cos(6.28 * random.unit()));
    }
    // Beside points, by less than a place.
    for (std::size_t i = 0; i < 100; ++i) queries.push_back(points[i] + (i % 2 ? 1e-20 : -1e-20));
    for (int i = 0; i < 100; ++i) queries.push_back(1e-17 * radius * (random.unit() - 0.5));
    Case input;
    input.add(points, queries);
    input.triangulate();
    check_all_answers(input);
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
  Case sets;
  sets.add({0, 0, 1, 0, 0, 1}, {0.5, 0.5, 0x1p1000, 1});
  sets.add({0, 0, 0x1p900, 0, 0, 0x1p900}, {0x1p1000, 1, 0, 0x1p-1070});
  sets.triangulate();
  EXPECT_NE(message_of([&] { ask(runtime, sets, values_for(6)); }, ErrorKind::input)
                .find("query 3 is too fine to be exact: it has y = "),
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

/// Cells of such meshes mean nothing, but there are some. (A vertex that has several cells then gets any of
/// them.)
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
  if (is_fixed_point(Runtimes::get("own"))) GTEST_SKIP() << "values are interpolated with doubles";
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
TEST(Locate, HundredsOfThousandsOfQueries) {
  const std::size_t n = 200000;
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
      const double x = points[2 * p] - q[0], y = points[2 * p + 1] - q[1], d = x * x + y * y;
      if (d < least) least = d, nearest_point = p;
    }
    EXPECT_EQ(answers.nearest[i], static_cast<cl_int>(nearest_point));
  }
}

/// Those that are launched for queries off the grid, in a mesh that needs levels.
std::set<std::string> kernels_in_fixed_point() {
  std::set<std::string> launched;
  Runtime& runtime = Runtimes::get("fixed_point=1");
  runtime.set_profiling(true);
  Case input;
  input.add(make_fixture("integer-circle", 3000, 1), {0.1, 0x1p-50, 0, 0, 0.5, 1e20});
  input.triangulate();
  ask(runtime, input, values_for(input.size()));
  for (const auto& [name, time] : runtime.kernel_times()) launched.insert(name);
  runtime.set_profiling(false);
  return launched;
}

TEST(Kernels, AllAreLaunched) {
  std::set<std::string> launched;
  Runtime& runtime = Runtimes::get("own");
  runtime.set_profiling(true);
  const Case input = case_of_trees(270, 500);
  ASSERT_GT(input.query_count(), settings_for(host::find_device("")).sizes->tuning().sorted_queries_least);
  ask(runtime, input, values_for(input.size()));
  const Case hubs = case_of_hubs(3000, 8);
  ask(runtime, hubs, values_for(hubs.size()));
  ask_constrained(runtime, make_case(make_fixture("uniform", 60, 6), 5, 7), 1);
  dual(runtime, input);
  for (const auto& [name, time] : runtime.kernel_times()) launched.insert(name);
  runtime.set_profiling(false);
  std::vector<const char*> files{"locate/locate", "locate/levels", "voronoi/voronoi"};
  std::size_t expected = 28;
  if (!testing::tests_native() && !is_fixed_point(runtime)) {
    files.push_back("locate/fixed_point");
    expected += 3;
    for (const std::string& name : kernels_in_fixed_point()) launched.insert(name);
  }
  std::size_t kernels = 0;
  for (const char* const file : files) {
    const std::string source = host::kernel_source(file);
    const std::regex pattern("\nkernel void (\\w+)\\(");
    for (std::sregex_iterator it(source.begin(), source.end(), pattern), end; it != end; ++it) {
      EXPECT_EQ(launched.count((*it)[1]), 1u) << (*it)[1] << " of " << file << ".cl";
      ++kernels;
    }
  }
  EXPECT_EQ(kernels, expected);
}

// Points of integer coordinates with duplicates, among them many on one circle, times a power of two.
struct Integers {
  std::vector<std::int64_t> at;
  std::vector<double> scaled(double scale) const {
    std::vector<double> result;
    for (const std::int64_t x : at) result.push_back(static_cast<double>(x) * scale);
    return result;
  }
  std::size_t size() const { return at.size() / 2; }
};

Integers some_integers(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  const std::int64_t circle[][2] = {{0, 5},  {3, 4},  {4, 3},  {5, 0}, {4, -3},
                                    {3, -4}, {0, -5}, {-3, 4}, {-5, 0}};
  Integers result;
  for (std::size_t i = 0; i < n; ++i) {
    const auto draw = [&](int size) {
      return static_cast<std::int64_t>(random() % static_cast<unsigned>(size));
    };
    const std::int64_t* const on_circle = circle[draw(9)];
    const bool is_on_circle = draw(3) == 0;
    result.at.push_back(is_on_circle ? on_circle[0] : draw(13) - 6);
    result.at.push_back(is_on_circle ? on_circle[1] : draw(13) - 6);
  }
  return result;
}

TEST(SmallPointTree, FindsTheNearestInTheirOrder) {
  Triangulator triangulator("host");
  for (const std::size_t n : {0, 1, 2, 9, 40, 300}) {
    const Integers points = some_integers(n, 1), queries = some_integers(30, 2);
    for (const double scale : {1.0, 0x1p-500, 0x1p500}) {
      PointTree tree(triangulator, points.scaled(scale).data(), n);
      for (const std::size_t count : {1, 2, 7, 50}) {
        const NeighborOptions options{count, 4 * scale};
        const std::vector<double> asked = queries.scaled(scale);
        const Neighbors all = tree.nearest(asked.data(), queries.size(), {count});
        const Neighbors near = tree.nearest(asked.data(), queries.size(), options);
        ASSERT_EQ(all.points.size(), count * queries.size());
        for (std::size_t q = 0; q < queries.size(); ++q) {
          std::vector<std::array<std::int64_t, 4>> expected;
          for (std::size_t i = 0; i < n; ++i) {
            const std::int64_t x = points.at[2 * i], y = points.at[2 * i + 1], dx = x - queries.at[2 * q],
                               dy = y - queries.at[2 * q + 1];
            expected.push_back({dx * dx + dy * dy, x, y, static_cast<std::int64_t>(i)});
          }
          std::sort(expected.begin(), expected.end());
          for (std::size_t k = 0; k < count; ++k) {
            const std::size_t place = q * count + k;
            const bool is_there = k < n, is_near = is_there && expected[k][0] <= 16;
            EXPECT_EQ(all.points[place], is_there ? expected[k][3] : -1);
            EXPECT_EQ(near.points[place], is_near ? expected[k][3] : -1);
            const double distance =
                is_there ? std::sqrt(static_cast<double>(expected[k][0])) * scale : INFINITY;
            EXPECT_DOUBLE_EQ(all.distances[place], distance);
            EXPECT_DOUBLE_EQ(near.distances[place], is_near ? distance : INFINITY);
          }
        }
      }
    }
  }
}

TEST(SmallPointTree, DistancesThatRoundToTheSameAreCompared) {
  // From the origin, the second point is nearer by less than doubles can tell.
  const double points[] = {1, 0x1p-30, 1, 0x1.fffffp-31, 1, 0x1.fffffp-31}, origin[] = {0, 0};
  Triangulator triangulator("host");
  const Neighbors found = PointTree(triangulator, points, 3).nearest(origin, 1, {3});
  EXPECT_EQ(found.distances, std::vector<double>(3, 1.0));
  EXPECT_EQ(found.points, (std::vector<std::int32_t>{1, 2, 0}));
}

TEST(SmallPointTree, SaysWhatIsWrong) {
  Triangulator triangulator("host");
  const double points[] = {0, 0, 1, 0, 1, NAN}, far[] = {0, 0, 1e300, 0x1p-1000};
  EXPECT_THROW(PointTree(triangulator, points, 3), Error);
  PointTree tree(triangulator, points, 2);
  const auto message = [&](const double* queries, const NeighborOptions& options) -> std::string {
    try {
      tree.nearest(queries, 2, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(points, {0}).find("1 or more"), std::string::npos);
  EXPECT_NE(message(points, {1, -1}).find("0 or more"), std::string::npos);
  EXPECT_NE(message(points, {1, NAN}).find("0 or more"), std::string::npos);
  EXPECT_NE(message(points + 2, {1}).find("query 1 is not finite"), std::string::npos);
  EXPECT_NE(message(far, {1}).find("query 1 is too"), std::string::npos);
  EXPECT_NE(message(nullptr, {1}).find("NULL"), std::string::npos);
}

}  // namespace
}  // namespace flaunay::locate
