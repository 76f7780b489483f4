// What refinements are asked for, as kernels get it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "constrained/refinement/bounds.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::constrained {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// One bit more or less would make other meshes.
TEST(RefinementBounds, AreTheSameBitsEverywhere) {
  const struct {
    double degrees;
    QualityBounds bounds;
  } known[] = {
      {0, {0, 0, 0x1.2c7434fc16e71p-1}},
      {1, {0x1.3f61d03ea6500p-12, 0x1.b36fd6be990e7p+5, 0x1.2c7434fc16e71p-1}},
      {20.7, {0x1.ffc5c47c8e891p-4, 0x1.4ce8bbb27350fp+1, 0x1.2015d6bb42b7dp-1}},
      {25, {0x1.6dc915b87d3c7p-3, 0x1.1240469571127p+1, 0x1.a7179607d231cp-2}},
      {28.6, {0x1.d54a7163719abp-3, 0x1.dd0e4942ae43bp+0, 0x1.2c7d938024487p-2}},
      {30, {0.25, 0x1.c5d13fb29f137p+0, 0.25}},
      {34, {0x1.40339088d34bfp-2, 0x1.8dbc556b8d529p+0, 0x1.1f65632b56590p-3}},
  };
  for (const auto& [degrees, expected] : known) {
    const QualityBounds bounds = quality_bounds(degrees);
    EXPECT_EQ(bounds.squared_sine, expected.squared_sine) << degrees;
    EXPECT_EQ(bounds.off_centre, expected.off_centre) << degrees;
    EXPECT_EQ(bounds.squared_cosine, expected.squared_cosine) << degrees;
  }
}

TEST(RefinementBounds, AreWhatTheyAreDefinedAs) {
  for (double degrees = 0x1p-10; degrees <= 34; degrees += 0.0078125) {
    const QualityBounds bounds = quality_bounds(degrees);
    const double radians = degrees * std::acos(-1.0) / 180,
                 lens = 2 * std::fmax(radians, std::acos(-1.0) / 9);
    EXPECT_NEAR(bounds.squared_sine, std::pow(std::sin(radians), 2), 0x1p-52);
    EXPECT_NEAR(bounds.squared_cosine, std::pow(std::cos(lens), 2), 0x1p-51);
    EXPECT_NEAR(bounds.off_centre * std::tan(radians / 2), 0.475, 1e-6);
    for (const double square : {bounds.squared_sine, bounds.squared_cosine}) {
      EXPECT_EQ(std::ldexp(square, 56), std::floor(std::ldexp(square, 56)));
    }
  }
  EXPECT_EQ(quality_bounds(1e-9).squared_sine, 0);
}

TEST(RefinementBounds, RefuseAnglesAndAreasThatMakeNoSense) {
  for (const double degrees : {-1e-9, 34.0001, 60.0, HUGE_VAL, kNan}) {
    EXPECT_THROW(quality_bounds(degrees), Error) << degrees;
  }
  const double areas[] = {0, 1e-300, HUGE_VAL, -1e-300, kNan};
  EXPECT_NO_THROW(check_areas(areas, 3, "seed"));
  try {
    check_areas(areas, 4, "seed");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_STREQ(error.what(), "seed 3: the largest area is -1e-300, but it can be 0, for any, or more");
  }
  EXPECT_THROW(check_areas(areas + 4, 1, "seed"), Error);
}

}  // namespace
}  // namespace flaunay::constrained
