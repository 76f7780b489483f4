// Batches of points that are inserted, removed and moved: after each the triangulation is that of a call on
// all points, and its changes are told.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/fixtures.hpp"
#include "tests/support/shared_triangulator.hpp"
#include "tests/updates/mirror.hpp"

namespace flaunay::testing {
namespace {

Triangulator& reference() {
  static Triangulator host("host");
  return host;
}

// Small meshes would be triangulated anew by nearly every batch.
const char* const kTuning = "inserted_percent=1000000,removed_percent=90,moved_percent=90";
Triangulator& changing() { return triangulator_with(kTuning); }

Mirror mirror_of(const std::vector<double>& coordinates) { return {changing(), reference(), coordinates}; }

std::vector<std::int32_t> numbers_of(const Mirror& mirror) {
  std::vector<std::int32_t> numbers;
  for (const auto& [v, p] : mirror.points) numbers.push_back(v);
  return numbers;
}

// Some of the points that there are, in any order.
std::vector<std::int32_t> some_of(const Mirror& mirror, std::size_t count, FixtureRandom& random) {
  std::vector<std::int32_t> numbers = numbers_of(mirror);
  random.shuffle(numbers);
  numbers.resize(std::min(count, numbers.size()));
  return numbers;
}

// Random batches on points of a small grid, which has all degeneracies, and places outside of it.
void run_batches(Mirror& mirror, std::uint64_t seed, int batches, std::int64_t side, std::int64_t most) {
  FixtureRandom random(seed);
  const auto place = [&] {
    const std::int64_t reach = random.integer(0, 9) == 0 ? 3 * side : side;
    return static_cast<double>(random.integer(-reach, reach)) / 2;
  };
  for (int batch = 0; batch < batches; ++batch) {
    SCOPED_TRACE("batch " + std::to_string(batch) + " of seed " + std::to_string(seed));
    const auto count = static_cast<std::size_t>(random.integer(1, most));
    const std::int64_t kind = random.integer(0, 2);
    if (kind == 0) {
      std::vector<double> coordinates;
      for (std::size_t i = 0; i < 2 * count; ++i) coordinates.push_back(place());
      mirror.insert(coordinates);
    } else {
      const std::vector<std::int32_t> numbers = some_of(mirror, count, random);
      if (kind == 1) {
        mirror.remove(numbers);
      } else {
        std::vector<double> coordinates;
        for (const std::int32_t v : numbers) {
          const Mirror::Point at = mirror.points.at(v);
          const bool is_near = random.integer(0, 3) != 0;
          for (const double x : at) {
            coordinates.push_back(is_near ? x + static_cast<double>(random.integer(-8, 8)) / 16 : place());
          }
        }
        mirror.move(numbers, coordinates);
      }
    }
    mirror.check();
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(SmallUpdates, OnePointAfterTheOther) {
  Mirror mirror = mirror_of({});
  mirror.check();
  for (const auto& p : std::vector<Mirror::Point>{{0, 0},
                                                  {0, 0},
                                                  {2, 0},
                                                  {1, 0},
                                                  {1, 1},
                                                  {1, -1},
                                                  {3, 0},
                                                  {1, 0.5},
                                                  {-1, 0},
                                                  {1, 0.25},
                                                  {5, 5},
                                                  {1, 1}}) {
    mirror.insert({p[0], p[1]});
    mirror.check();
  }
  for (const std::int32_t v : {3, 0, 1, 4, 11, 10, 5, 7, 9, 2, 6, 8}) {
    mirror.remove({v});
    mirror.check();
  }
  EXPECT_EQ(mirror.mesh.point_count(), 0);
  EXPECT_EQ(mirror.mesh.numbers(), 12);
}

TEST(SmallUpdates, RandomBatches) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Mirror mirror = mirror_of({});
    run_batches(mirror, seed, 12, 4, 6);
  }
}

TEST(Updates, RandomBatches) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Mirror mirror = mirror_of(all_fixtures()[seed % all_fixtures().size()].make(60, seed));
    run_batches(mirror, seed, 20, seed % 3 == 0 ? 3 : 200, seed % 2 == 0 ? 4 : 40);
  }
}

// Some points of each fixture are made, others inserted, some removed again, all moved a little and back.
TEST(Updates, Fixtures) {
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Coordinates all = fixture.make(150, 7);
    const std::size_t half = all.size() / 4 * 2;
    Mirror mirror = mirror_of({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(half)});
    mirror.insert({all.begin() + static_cast<std::ptrdiff_t>(half), all.end()});
    mirror.check();
    FixtureRandom random(1);
    mirror.remove(some_of(mirror, 20, random));
    mirror.check();
    const std::vector<std::int32_t> numbers = numbers_of(mirror);
    std::vector<double> before, after;
    for (const auto& [v, p] : mirror.points) {
      before.insert(before.end(), p.begin(), p.end());
      for (const double x : p) after.push_back(x + std::ldexp(x, -12));
    }
    mirror.move(numbers, after);
    mirror.check();
    mirror.move(numbers, before);
    mirror.check();
    mirror.remove(numbers);
    mirror.check();
    if (HasFailure()) return;
  }
}

TEST(SmallUpdates, PointsSplitConstraints) {
  const std::vector<double> square = {0, 0, 8, 0, 8, 8, 0, 8, 4, 3};
  Mirror mirror(changing(), reference(), square, {0, 1, 1, 2, 2, 3, 3, 0, 0, 2});
  mirror.check();
  mirror.insert({4, 0, 2, 2, 6, 6, 4, 4, 1, 5, 9, 4, 8, 4, 2, 2});
  mirror.check();
  mirror.remove({4, 9});
  mirror.check();
  mirror.move({10}, {5, 1});
  mirror.check();
  for (const std::int32_t v : {0, 5, 6}) {
    try {
      mirror.mesh.remove(&v, 1);
      ADD_FAILURE() << v;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_NE(std::string(error.what())
                    .find("point " + std::to_string(v) + " cannot be removed: it is on segment"),
                std::string::npos)
          << error.what();
    }
  }
  mirror.check();
}

// Whatever way a batch takes: constraints are the same as before, and their vertices stay.
TEST(SmallUpdates, ConstraintsStay) {
  for (Triangulator* const by : {&triangulator(), &changing()}) {
    // Twenty points on a line, and one that is not, which leaves them and comes back.
    std::vector<double> line;
    for (int i = 0; i < 20; ++i) line.insert(line.end(), {static_cast<double>(i), 0});
    line.insert(line.end(), {3, 5});
    Mirror mirror(*by, reference(), line, {0, 19});
    const auto check = [&] {
      mirror.check();
      EXPECT_GE(mirror.mesh.constraints().segments.size(), 19u);
      for (const std::int32_t v : {0, 7, 19}) EXPECT_THROW(mirror.mesh.remove(&v, 1), Error);
    };
    mirror.remove({20});
    check();
    mirror.insert({3, -5, 6.5, 0});
    check();
    mirror.move({21}, {50, 0});
    check();
    mirror.insert({7.5, 0, -4, 0});
    check();
    mirror.move({21}, {3, 5});
    check();
    // Another scale; more points than are inserted or removed one by one; a point with too many triangles.
    mirror.insert({0x1p400, 1});
    check();
    mirror.remove({25});
    std::vector<double> circle = {1e6, 1e6};
    for (int i = 0; i < 60; ++i) circle.insert(circle.end(), {1e6 + std::cos(i), 1e6 + std::sin(i)});
    mirror.insert(circle);
    check();
    mirror.remove({26});
    check();
    std::vector<std::int32_t> all(60);
    std::iota(all.begin(), all.end(), 27);
    mirror.remove(all);
    check();
    if (HasFailure()) return;
  }
  // A point with a smaller number comes to the end of a constraint.
  Mirror mirror(triangulator(), reference(), {0, 0, 0, 0, 1, 0, 0, 1}, {2, 3});
  mirror.move({0}, {1, 0});
  mirror.check();
  EXPECT_EQ(mirror.mesh.constraints().edges, (std::vector<std::int32_t>{3, 0}));
  mirror.remove({2});
  mirror.check();
}

// A callback ends a batch that triangulates anew: nothing has changed.
TEST(SmallUpdates, ErrorsInTheMiddle) {
  for (const bool is_flat : {false, true}) {
    SCOPED_TRACE(is_flat);
    for (const bool checks_between : {false, true}) {
      bool is_armed = false;
      int errors = 0;
      ConstrainedOptions options;
      options.progress = [&](const std::string&, int, double) {
        if (!std::exchange(is_armed, false)) return;
        ++errors;
        throw Interrupted();
      };
      std::vector<double> coordinates = {0, 0, 8, 0, 4, 0, 6, 0, 4, 0};
      if (!is_flat) coordinates.insert(coordinates.end(), {0, 8, 3, 5, 3, 5});
      Mirror mirror(triangulator(), reference(), coordinates, {0, 1}, options);
      mirror.checks_between = checks_between;
      std::vector<double> more;
      for (int i = 0; i < 40; ++i) more.insert(more.end(), {i % 7 + 0.5, static_cast<double>(i % 5)});
      for (int k = 1; k <= 2; ++k) {
        is_armed = true;
        EXPECT_TRUE(mirror.insert(more).is_anew);
        mirror.check();
        EXPECT_FALSE(mirror.insert({2.25, 1.5, 5, 0}).is_anew);
        mirror.check();
        is_armed = true;
        EXPECT_TRUE(mirror.remove(mirror.without_ends(numbers_of(mirror))).is_anew);
        mirror.check();
        EXPECT_EQ(errors, 2 * k);
      }
    }
  }
}

TEST(Updates, RandomConstraints) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    FixtureRandom random(seed);
    // A star of segments, and free points.
    std::vector<double> coordinates = {0, 0};
    std::vector<std::int32_t> segments;
    for (std::int32_t k = 1; k <= 9; ++k) {
      const double angle = k * 0.69, radius = 20 + 10 * static_cast<double>(k % 3);
      coordinates.insert(coordinates.end(),
                         {std::round(radius * std::cos(angle)), std::round(radius * std::sin(angle))});
      segments.insert(segments.end(), {0, k});
    }
    for (int i = 0; i < 60; ++i) coordinates.push_back(static_cast<double>(random.integer(-30, 30)));
    Mirror mirror(changing(), reference(), coordinates, segments);
    for (int batch = 0; batch < 12; ++batch) {
      SCOPED_TRACE("batch " + std::to_string(batch));
      if (batch % 3 == 0) {
        std::vector<double> more;
        for (int i = 0; i < 20; ++i) more.push_back(static_cast<double>(random.integer(-35, 35)));
        mirror.insert(more);
      } else {
        const std::vector<std::int32_t> numbers = mirror.without_ends(some_of(mirror, 12, random));
        if (batch % 3 == 1) {
          mirror.remove(numbers);
        } else {
          std::vector<double> places;
          for (std::size_t i = 0; i < 2 * numbers.size(); ++i) {
            places.push_back(static_cast<double>(random.integer(-35, 35)));
          }
          mirror.move(numbers, places);
        }
      }
      mirror.check();
      if (HasFailure()) return;
    }
  }
}

// Bad input is named, and changes nothing.
TEST(SmallUpdates, BadInput) {
  Mirror mirror = mirror_of({0, 0, 1, 0, 0, 1, 1, 1, 0.5, 0.25});
  const auto expect_error = [&](const auto& call, const std::string& text) {
    try {
      call();
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
    mirror.check();
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto insert = [&](std::vector<double> coordinates) {
    return [&, coordinates] { mirror.mesh.insert(coordinates.data(), coordinates.size() / 2); };
  };
  const auto remove = [&](std::vector<std::int32_t> numbers) {
    return [&, numbers] { mirror.mesh.remove(numbers.data(), numbers.size()); };
  };
  expect_error(insert({3, 3, nan, 1}), "point 1 is not finite");
  expect_error(insert({3, std::numeric_limits<double>::infinity()}), "point 0 is not finite");
  expect_error(insert({3, 3, 0x1p300, 0x1p-300}), "differ too much");
  expect_error(remove({1, 5}), "entry 1 of the batch is point 5, which does not exist");
  expect_error(remove({-1}), "entry 0 of the batch is point -1, which does not exist");
  expect_error(remove({2, 3, 2}), "entry 2 of the batch is point 2, which is there twice");
  const std::int32_t moved = 4;
  const std::vector<double> bad = {0, nan}, far = {0x1p300, 0x1p-300};
  expect_error([&] { mirror.mesh.move(&moved, bad.data(), 1); }, "not finite");
  expect_error([&] { mirror.mesh.move(&moved, far.data(), 1); }, "differ too much");
  mirror.remove({4});
  expect_error(remove({4}), "was removed before");
  // Magnitudes that need another scale than those before.
  mirror.insert({0x1p400, 1});
  mirror.check();
  mirror.remove({5});
  mirror.insert({0x1p-300, 0x1p-320});
  mirror.check();
  // The same sets, as far as they are supported.
  const std::vector<double> square = {0, 0, 1, 0, 1, 1};
  const std::vector<std::int32_t> edge = {0, 1};
  Constraints constraints;
  constraints.segments = edge.data();
  constraints.segment_count = 1;
  ConstrainedOptions options;
  options.outside = Outside::hull;
  EXPECT_THROW(DynamicTriangulation(triangulator(), square.data(), 3, constraints, options), Error);
}

TEST(Updates, MovingEverything) {
  FixtureRandom random(3);
  std::vector<double> coordinates;
  for (int i = 0; i < 2000; ++i) coordinates.push_back(random.unit());
  Mirror mirror = mirror_of(coordinates);
  for (const double step : {1e-5, 1e-3, 1e-2, 1e-1}) {
    SCOPED_TRACE(step);
    std::vector<double> places;
    for (const auto& [v, p] : mirror.points) {
      for (const double x : p) places.push_back(x + step * (random.unit() - 0.5));
    }
    mirror.move(numbers_of(mirror), places);
    mirror.check();
  }
  // Mirrored, everything turns over; rotated by half a turn, nothing does.
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> places;
    for (const auto& [v, p] : mirror.points) places.insert(places.end(), {-p[0], sign * p[1]});
    mirror.move(numbers_of(mirror), places);
    mirror.check();
  }
}

// As it is for users: some of these batches change the mesh, others triangulate anew.
TEST(Updates, LargeBatchesTriangulateAnew) {
  FixtureRandom random(4);
  std::vector<double> coordinates, more;
  for (int i = 0; i < 600; ++i) coordinates.push_back(random.unit());
  Mirror mirror(triangulator(), reference(), coordinates);
  for (const int count : {1, 20, 600, 1}) {
    more.clear();
    for (int i = 0; i < 2 * count; ++i) more.push_back(2 * random.unit() - 0.5);
    EXPECT_EQ(mirror.insert(more).is_anew, count == 600);
    mirror.check();
  }
  for (const std::size_t count : {1, 20, 400, 1}) {
    EXPECT_EQ(mirror.remove(some_of(mirror, count, random)).is_anew, count == 400);
    mirror.check();
  }
}

TEST(Updates, HaveTheSameRowsEverywhere) {
  const Coordinates all = all_fixtures()[0].make(4000, 5);
  const auto run = [&](Triangulator& by) {
    DynamicTriangulation mesh(by, all.data(), 1000);
    mesh.insert(all.data() + 2000, 100);
    std::vector<std::int32_t> numbers;
    for (std::int32_t v = 0; v < 1000; v += 9) numbers.push_back(v);
    mesh.remove(numbers.data(), numbers.size());
    mesh.insert(all.data() + 2200, 120);
    for (std::int32_t& v : numbers) ++v;
    std::vector<double> places(all.begin() + 4000,
                               all.begin() + 4000 + 2 * static_cast<std::ptrdiff_t>(numbers.size()));
    mesh.move(numbers.data(), places.data(), numbers.size());
    return mesh.rows();
  };
  const TriangleRows expected = run(changing());
  const ScopedEnvironment tuning("FLAUNAY_TUNING", kTuning);
  for (const char* threads : {"1", "2", "3"}) {
    const ScopedEnvironment count("FLAUNAY_THREADS", threads);
    Triangulator host("host");
    const TriangleRows rows = run(host);
    EXPECT_EQ(rows.triangles, expected.triangles);
    EXPECT_EQ(rows.neighbors, expected.neighbors);
  }
}

}  // namespace
}  // namespace flaunay::testing
