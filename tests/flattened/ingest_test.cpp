// The stage `ingest`: checks, scales, sorts and renumbers points.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/flattened/support.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/ingest_twin.hpp"

namespace flaunay::flattened {
namespace {

void check_ingest(Runtime& runtime, const Coordinates& coordinates, const std::vector<std::size_t>& offsets) {
  Call call(runtime);
  const testing::IngestTwin twin = testing::ingest_twin(coordinates, offsets);
  std::vector<std::int32_t> representatives(coordinates.size() / 2);
  const PointTable table = ingest(call.work, coordinates.data(), offsets, representatives.data());
  EXPECT_EQ(table.input_count, coordinates.size() / 2);
  EXPECT_EQ(table.sets, offsets.size() - 1);
  ASSERT_EQ(table.count, twin.points.size());
  EXPECT_TRUE(same(call.read(table.points, table.count), twin.points));
  EXPECT_TRUE(same(call.read(table.source, table.count), twin.source));
  EXPECT_TRUE(same(call.read(table.set_of_id, table.count), twin.set_of_id));
  EXPECT_TRUE(same(call.read(table.set_offsets, table.sets + 1), twin.set_offsets));
  EXPECT_TRUE(same(call.read(table.y_order, table.count), twin.y_order));
  EXPECT_TRUE(same(representatives, twin.representatives));
  // Products of 3, 2 and 4 coordinates are exact if they have so few bits.
  EXPECT_EQ(call.work.bounds.hull == 0, twin.bits <= 16) << twin.bits;
  EXPECT_EQ(call.work.bounds.orient == 0, twin.bits <= 25) << twin.bits;
  EXPECT_EQ(call.work.bounds.circle == 0, twin.bits <= 11) << twin.bits;
}

TEST(SmallIngest, SortsDuplicatesOfSeveralSets) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(1);
    check_ingest(runtime, {-0.0, 0.0, 0.0, -0.0, 1.0, -0.0, 1.0, 0.0}, {0, 4});
    check_ingest(runtime, {2.5, -1.5}, {0, 0, 1, 1, 1});
    for (std::size_t n = 2; n <= 40; n += 19) {
      check_ingest(runtime, coarse_points(n, 2, random), {0, n});
      check_ingest(runtime, coarse_points(n, 2, random), {0, 0, n / 3, n / 3, n / 2, n, n});
    }
  });
}

TEST(Ingest, SortsAndRenumbers) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(2);
    for (const int values : {1, 5, 1000}) {
      check_ingest(runtime, coarse_points(3000, values, random), {0, 3000});
      for (const std::size_t sets : {2, 50, 3000}) {
        const auto offsets = random_offsets(sets, 6000 / static_cast<std::int64_t>(sets), random);
        check_ingest(runtime, coarse_points(offsets.back(), values, random), offsets);
      }
    }
    for (const char* const name : {"uniform", "kuzmin", "half-duplicates", "log-spiral", "columns"}) {
      SCOPED_TRACE(name);
      check_ingest(runtime, make_fixture(name, 5000, 3), {0, 5000});
    }
  });
}

TEST(Ingest, ScalesByAPowerOfTwo) {
  under_each_tuning([](Runtime& runtime) {
    const Coordinates uniform = make_fixture("uniform", 200, 4);
    for (const double factor :
         {1e150, 1e-150, 1e300, 1e-300, 0x1p-1000, 0x1p249, 0x1p250, 0x1p-203, 0x1p-204}) {
      SCOPED_TRACE(factor);
      check_ingest(runtime, testing::scaled(uniform, factor), {0, 200});
    }
    // Subnormal numbers, and the two ends of the range of magnitudes.
    check_ingest(runtime, {0x1p-1074, 0.0, -0x1.8p-1073, 0x1p-1050, 0.0, 0.0}, {0, 3});
    check_ingest(runtime, {0x1p249, 0.0, 0x1p-255, 1.0, -1.0, 0x1p-100}, {0, 3});
    check_ingest(runtime, {0x1p1023, 0.0, 0x1p519, 0x1.8p664, -0x1.8p565, 0x1p600}, {0, 3});
    check_ingest(runtime, {0x1p-570, 0.0, 0x1p-1074, 0x1p-800, -0x1p-900, 0x1p-700}, {0, 3});
    for (const int bits : {11, 12, 16, 17, 25, 26}) {
      SCOPED_TRACE(bits);
      check_ingest(runtime, {1.0, std::ldexp(1.0, bits - 1), 3.0, 0.0}, {0, 2});
    }
  });
}

TEST(SmallIngest, NamesTheFirstPointThatCannotBe) {
  under_each_tuning([](Runtime& runtime) {
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      Coordinates points(60, 1.0);
      points[2 * 23] = bad;
      points[2 * 17 + 1] = bad;
      Call call(runtime);
      std::vector<std::int32_t> representatives(30);
      testing::expect_error(ErrorKind::input, {"point 17 "}, [&] {
        ingest(call.work, points.data(), {0, 30}, representatives.data());
      });
    }
    Call call(runtime);
    std::int32_t representatives[2];
    const double far[] = {0x1p250, 0.0, 1.0, 0x1p-255};
    EXPECT_THROW(ingest(call.work, far, {0, 2}, representatives), Error);
  });
}

}  // namespace
}  // namespace flaunay::flattened
