// Whether two arrays are the same, to the sign of each zero, and two triangulations.
#pragma once

#include <CL/cl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "flaunay/result_arrays.hpp"
#include "tests/support/reference.hpp"

namespace flaunay::testing {

inline bool equal_elements(const cl_double2& a, const cl_double2& b) {
  return a.s[0] == b.s[0] && a.s[1] == b.s[1] && std::signbit(a.s[0]) == std::signbit(b.s[0]) &&
         std::signbit(a.s[1]) == std::signbit(b.s[1]);
}
inline bool equal_elements(const cl_uint2& a, const cl_uint2& b) {
  return a.s[0] == b.s[0] && a.s[1] == b.s[1];
}
inline bool equal_elements(const cl_int2& a, const cl_int2& b) {
  return a.s[0] == b.s[0] && a.s[1] == b.s[1];
}
template <typename T>
bool equal_elements(const T& a, const T& b) {
  return a == b;
}

/// One line where whole vectors would fill the screen.
template <typename T>
::testing::AssertionResult same(const std::vector<T>& found, const std::vector<T>& expected) {
  if (found.size() != expected.size()) {
    return ::testing::AssertionFailure() << found.size() << " elements instead of " << expected.size();
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!equal_elements(found[i], expected[i])) {
      auto result = ::testing::AssertionFailure() << "element " << i << " of " << found.size();
      if constexpr (std::is_arithmetic_v<T>) result << " is " << +found[i] << " instead of " << +expected[i];
      return result;
    }
  }
  return ::testing::AssertionSuccess();
}

/// The offsets of sets, and the numbers that statistics have of points and results.
template <typename Result, typename Expected>
void expect_same_sizes(const Result& found, const Expected& expected) {
  EXPECT_EQ(found.triangle_offsets, expected.triangle_offsets);
  EXPECT_EQ(found.hull_offsets, expected.hull_offsets);
  EXPECT_EQ(found.statistics.points, expected.statistics.points);
  EXPECT_EQ(found.statistics.duplicates, expected.statistics.duplicates);
  EXPECT_EQ(found.statistics.triangles, expected.statistics.triangles);
  EXPECT_EQ(found.statistics.hull_vertices, expected.statistics.hull_vertices);
}

/// The order of rows is the mode's own; everything else must agree.
inline void expect_same_but_for_order(const Triangulation& found, const Triangulation& expected) {
  EXPECT_TRUE(linked_rows(found.triangles, found.neighbors) ==
              linked_rows(expected.triangles, expected.neighbors))
      << "triangles or neighbours differ";
  EXPECT_EQ(found.hull, expected.hull);
  EXPECT_EQ(found.representatives, expected.representatives);
  expect_same_sizes(found, expected);
}

/// All arrays of two triangulations.
inline void expect_same_arrays(const Triangulation& found, const Triangulation& expected) {
  for_each_array([&](const auto& array, std::size_t) {
    EXPECT_TRUE(same(found.*array.values, expected.*array.values)) << array.name;
  });
#define FLAUNAY_EXPECT_SAME(type, name, ...) EXPECT_TRUE(same(found.name, expected.name)) << #name;
  FLAUNAY_SPACE_ARRAYS(FLAUNAY_EXPECT_SAME)
#undef FLAUNAY_EXPECT_SAME
  expect_same_sizes(found, expected);
}

inline void expect_same_arrays(const ConstrainedTriangulation& found,
                               const ConstrainedTriangulation& expected) {
  expect_same_arrays(static_cast<const Triangulation&>(found), expected);
  for_each_array(kConstrainedArrays, [&](const auto& array, std::size_t) {
    EXPECT_TRUE(same(found.*array.values, expected.*array.values)) << array.name;
  });
}

}  // namespace flaunay::testing
