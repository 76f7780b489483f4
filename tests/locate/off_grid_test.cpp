// Queries in fixed point: their predicates, on the grid of points and off it, against exact arithmetic; and
// answers for queries that are just on the grid, just off it, and far off it.
#include "locate/off_grid.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "derived/locate/read_back.hpp"
#include "points/download.hpp"
#include "tests/locate/support.hpp"
#include "tests/support/test_kernels.hpp"

namespace flaunay::locate {
namespace {

constexpr cl_long kLastPlace = (cl_long{1} << kernel::COORDINATE_BITS) - 1;

/// Points a and b, and a query in the caller's units, of which 2^-shift are a place.
struct OffGridCase {
  cl_long a[2], b[2];
  double q[2];
};

int sign_of(const mpq_class& x) { return sgn(x); }

mpq_class squared(const cl_long* a, const mpq_class* q) {
  const mpq_class x = q[0] - mpq_class(a[0]), y = q[1] - mpq_class(a[1]);
  return x * x + y * y;
}

cl_long place_twin(const mpq_class& x) {
  const mpz_class towards_zero = x.get_num() / x.get_den();
  if (towards_zero > kLastPlace) return kLastPlace;
  if (towards_zero < -kLastPlace) return -kLastPlace;
  return towards_zero.get_si();
}

/// How many cases of each kind there were.
struct OffGridCounts {
  int on_grid = 0, straight = 0, as_near = 0, decided = 0, far = 0;
};

OffGridCounts check_off_grid(const std::vector<OffGridCase>& cases, int shift) {
  const testing::TestKernels kernels;
  const auto runtime = testing::make_tuned_runtime("fixed_point=1");
  const std::size_t n = cases.size();
  std::vector<cl_long> points;
  std::vector<double> queries;
  for (const OffGridCase& each : cases) {
    points.insert(points.end(), {each.a[0], each.a[1], each.b[0], each.b[1]});
    queries.insert(queries.end(), {each.q[0], each.q[1]});
  }
  Arena::Scope scope(runtime->arena());
  const auto placed = guarded<cl_long>(*runtime, 2 * n);
  const auto results = guarded<cl_int>(*runtime, 6 * n);
  testing::map_unchecked(*runtime, "off_grid", "off_grid_cases", n, shift, upload(*runtime, points),
                         upload(*runtime, queries), placed, results);
  const auto places = download(*runtime, placed, 2 * n);
  const auto found = download(*runtime, results, 6 * n);
  OffGridCounts counts;
  for (std::size_t i = 0; i < n; ++i) {
    SCOPED_TRACE(i);
    const OffGridCase& c = cases[i];
    mpq_class q[2];
    bool on_grid = true;
    for (int k = 0; k < 2; ++k) {
      q[k] = mpq_class(c.q[k]);
      if (shift >= 0) {
        mpq_mul_2exp(q[k].get_mpq_t(), q[k].get_mpq_t(), static_cast<mp_bitcnt_t>(shift));
      } else {
        mpq_div_2exp(q[k].get_mpq_t(), q[k].get_mpq_t(), static_cast<mp_bitcnt_t>(-shift));
      }
      const cl_long place = place_twin(q[k]);
      EXPECT_EQ(places[2 * i + static_cast<std::size_t>(k)], place);
      on_grid = on_grid && q[k] == mpq_class(place);
    }
    const mpq_class turn = (mpq_class(c.b[0]) - mpq_class(c.a[0])) * (q[1] - mpq_class(c.a[1])) -
                           (mpq_class(c.b[1]) - mpq_class(c.a[1])) * (q[0] - mpq_class(c.a[0]));
    const int orient = sign_of(turn), near = sign_of(squared(c.a, q) - squared(c.b, q));
    const cl_int* const result = &found[6 * i];
    EXPECT_EQ(result[0], orient);
    EXPECT_EQ(result[1], near);
    EXPECT_EQ(result[2], on_grid);
    counts.on_grid += on_grid;
    counts.straight += orient == 0;
    counts.as_near += near == 0;
    counts.far += abs(q[0]) > kLastPlace || abs(q[1]) > kLastPlace;
    if (!on_grid) continue;
    EXPECT_EQ(result[3], orient);
    EXPECT_EQ(result[4], near);
    EXPECT_TRUE(result[5] == near || result[5] == UNDECIDED);
    counts.decided += result[5] != UNDECIDED;
  }
  return counts;
}

class OffGridRandom {
 public:
  explicit OffGridRandom(std::uint64_t seed) : random_(seed) {}
  cl_long integer(int bits) { return random_.integer(-(cl_long{1} << bits) + 1, (cl_long{1} << bits) - 1); }
  int below(int end) { return static_cast<int>(random_.integer(0, end - 1)); }
  /// With up to 53 bits, and an exponent in the range.
  double number(int low, int high) {
    const double x = std::ldexp(1 + random_.unit(), low + below(high - low + 1));
    return below(2) ? x : -x;
  }

 private:
  FixtureRandom random_;
};

bool tests_no_device() { return testing::tests_native(); }

TEST(SmallOffGrid, PredicatesOfAnyQueries) {
  if (tests_no_device()) GTEST_SKIP() << "natively there is no fixed point";
  OffGridRandom random(1);
  for (const int shift : {0, 7, -300, 900}) {
    std::vector<OffGridCase> cases;
    for (int i = 0; i < 2000; ++i) {
      const int bits = 1 + random.below(62);
      OffGridCase each{
          {random.integer(bits), random.integer(bits)}, {random.integer(bits), random.integer(bits)}, {}};
      const int low = i % 2 ? -12 : 0, high = i % 4 == 3 ? kernel::FARTHER_PLACES - 1 : bits;
      for (double& x : each.q) x = std::ldexp(random.number(std::min(low, high), high), -shift);
      if (i % 5 == 0) each.q[i % 2] = 0;
      if (i % 7 == 0) each.q[0] = std::ldexp(static_cast<double>(each.a[0] >> 10 << 10), -shift);
      cases.push_back(each);
    }
    cases.push_back({{kLastPlace, kLastPlace}, {-kLastPlace, -kLastPlace}, {0, 0}});
    cases.push_back({{kLastPlace, -kLastPlace},
                     {-kLastPlace, kLastPlace},
                     {std::ldexp(-0x1p124, -shift), std::ldexp(0x1p-64, -shift)}});
    cases.push_back(
        {{kLastPlace, -kLastPlace},
         {-kLastPlace, kLastPlace},
         {std::ldexp(0x1.fffffffffffffp124, -shift), std::ldexp(-0x1.fffffffffffffp124, -shift)}});
    const OffGridCounts counts = check_off_grid(cases, shift);
    EXPECT_GT(counts.on_grid, 50);
    EXPECT_GT(counts.decided, 30);
    EXPECT_GT(counts.far, 100);
  }
}

/// Queries between two points, on their line or as near to both, and a little off that.
TEST(SmallOffGrid, PredicatesOfTies) {
  if (tests_no_device()) GTEST_SKIP() << "natively there is no fixed point";
  OffGridRandom random(2);
  std::vector<OffGridCase> cases;
  for (int i = 0; i < 4000; ++i) {
    const int bits = 2 + random.below(44);
    OffGridCase each{
        {random.integer(bits), random.integer(bits)}, {random.integer(bits), random.integer(bits)}, {}};
    // The middle, or that turned by a quarter about a; both may lie between places.
    for (int k = 0; k < 2; ++k) each.q[k] = 0.5 * static_cast<double>(each.a[k] + each.b[k]);
    if (i % 3 == 0) {
      const cl_long x = each.b[0] - each.a[0], y = each.b[1] - each.a[1];
      each.q[0] -= 0.5 * static_cast<double>(y), each.q[1] += 0.5 * static_cast<double>(x);
    }
    if (i % 3 == 1) each.q[random.below(2)] += random.number(-8, -8) > 0 ? 0x1p-8 : -0x1p-8;
    cases.push_back(each);
  }
  for (int i = 0; i < 100; ++i) {
    // The largest that are symmetric about 0, and the query as little off it as can be.
    const cl_long x = random.integer(62), y = random.integer(62);
    cases.push_back({{x, y}, {-x, -y}, {i % 2 ? 0 : 0x1p-64, i % 4 < 2 ? 0 : -0x1p-64}});
    cases.push_back({{x, y}, {-y, x}, {i % 2 ? 0 : 0x1p-64, i % 4 < 2 ? 0 : -0x1p-64}});
  }
  const OffGridCounts counts = check_off_grid(cases, 0);
  EXPECT_GT(counts.straight, 1000);
  EXPECT_GT(counts.as_near, 2000);
  EXPECT_GT(counts.on_grid, 300);
}

Magnitudes spanning(int lowest, int largest) { return {largest, lowest, kernel::NO_BAD}; }

TEST(SmallOffGrid, FramesHoldPointsAndQueries) {
  const int point_shift = 61;
  const Magnitudes points = spanning(-53, 0);
  // What the two fill together, just and not quite.
  const QueryScaling fits = *fixed_point_scaling(points, spanning(-61, -3), point_shift);
  EXPECT_FALSE(fits.is_off_grid);
  EXPECT_EQ(fits.frames[0].shift, 61);
  EXPECT_EQ(fixed_point_scaling(points, spanning(-53, 8), point_shift)->frames[0].shift, 53);
  EXPECT_FALSE(fixed_point_scaling(points, spanning(-53, 8), point_shift)->is_off_grid);
  EXPECT_TRUE(fixed_point_scaling(points, spanning(-53, 9), point_shift)->is_off_grid);
  EXPECT_TRUE(fixed_point_scaling(points, spanning(-62, -3), point_shift)->is_off_grid);
  // Points stay on the grid, and leave one more place for queries beyond.
  EXPECT_EQ(fixed_point_scaling(points, spanning(-70, 9), point_shift)->frames[0].shift, 60);
  EXPECT_EQ(fixed_point_scaling(spanning(-61, 0), spanning(-70, 9), point_shift)->frames[0].shift, 61);
  EXPECT_EQ(fixed_point_scaling(points, spanning(-70, -20), point_shift)->frames[0].shift, 61);
  // The ends of the range.
  EXPECT_TRUE(fixed_point_scaling(spanning(-61, 0), spanning(-125, 63), point_shift)->is_off_grid);
  EXPECT_FALSE(fixed_point_scaling(spanning(-61, 0), spanning(-126, 63), point_shift));
  EXPECT_FALSE(fixed_point_scaling(spanning(-61, 0), spanning(-125, 64), point_shift));
  // Filters are exact on coordinates of few bits.
  EXPECT_EQ(fixed_point_scaling(spanning(0, 9), spanning(0, 9), 52)->nearness_bound, 0);
  EXPECT_GT(fixed_point_scaling(spanning(0, 9), spanning(-1, 9), 52)->nearness_bound, 0);
}

/// A locator in fixed point has all that it was made of, but for points that are equal to others.
TEST(SmallOffGrid, MeshesAreReadBack) {
  if (tests_no_device()) GTEST_SKIP() << "natively there is no fixed point";
  Runtime& runtime = Runtimes::get("fixed_point=1");
  Coordinates doubled = make_fixture("grid", 25, 2);
  doubled.insert(doubled.end(), doubled.begin(), doubled.begin() + 20);
  for (const double factor : {1.0, 0x1p300}) {
    Case input;
    input.add({}, {});
    input.add(testing::scaled(make_fixture("uniform", 60, 1), factor), {});
    input.add({2, 3}, {});
    input.add({1, 1, 1, 1, 1, 1}, {});
    input.add(testing::scaled(doubled, 1 / factor), {});
    input.add(make_fixture("collinear", 9, 3), {});
    input.add({}, {});
    input.triangulate();
    Arena own(runtime.memory());
    Arena::Scope scope(runtime.arena());
    const Locator locator = *make_locator(runtime, own, upload_mesh(runtime, input), nullptr);
    const DeviceMesh mesh = read_back(runtime, locator, runtime);
    const auto read = [&runtime](const auto& from) { return points::download(runtime, from, from.size()); };
    EXPECT_EQ(mesh.point_offsets, input.offsets);
    EXPECT_EQ(mesh.triangle_offsets, input.mesh.triangle_offsets);
    EXPECT_EQ(mesh.hull_offsets, input.mesh.hull_offsets);
    EXPECT_EQ(read(mesh.triangles), input.mesh.triangles);
    EXPECT_EQ(read(mesh.neighbors), input.mesh.neighbors);
    EXPECT_EQ(read(mesh.hull), input.mesh.hull);
    const std::vector<double> coordinates = read(mesh.coordinates);
    ASSERT_EQ(coordinates.size(), input.points.size());
    for (std::size_t i = 0; i < input.size(); ++i) {
      if (input.mesh.representatives[i] != static_cast<std::int32_t>(i)) continue;
      EXPECT_EQ(coordinates[2 * i], input.points[2 * i]) << i;
      EXPECT_EQ(coordinates[2 * i + 1], input.points[2 * i + 1]) << i;
    }
  }
}

}  // namespace
}  // namespace flaunay::locate
