// Violations, and the words in which they name points and triangles.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>

#include "prove/delaunay_proof.hpp"

namespace flaunay::prove {

/// The first violation that a part of the check found; ends it.
struct Violation {
  std::string problem;
};

template <typename... Arguments>
[[noreturn]] void violate(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  throw Violation{fmt::format(text, std::forward<Arguments>(arguments)...)};
}

/// Ends the check unless the condition holds.
template <typename... Arguments>
void require(bool holds, fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  if (!holds) violate(text, std::forward<Arguments>(arguments)...);
}

/// Runs checks. Returns the violation that ends them, or nothing.
template <typename Checks>
std::string problem_in(const Checks& checks) {
  try {
    checks();
  } catch (const Violation& violation) {
    return violation.problem;
  }
  return {};
}
template <typename Checks>
void run_checks(VerifyReport& report, const Checks& checks) {
  report.problem = problem_in(checks);
  report.ok = report.problem.empty();
}

/// A point with its index in the input.
struct Vertex {
  std::uint64_t id = 0;
  double at[2] = {0, 0};
};

inline bool is_same_place(const Vertex& a, const Vertex& b) {
  return a.at[0] == b.at[0] && a.at[1] == b.at[1];
}
inline bool is_before(const Vertex& a, const Vertex& b) {
  return a.at[0] != b.at[0] ? a.at[0] < b.at[0] : a.at[1] < b.at[1];
}

inline std::string describe(const Vertex& vertex) {
  return fmt::format("point {} at ({}, {})", vertex.id, vertex.at[0], vertex.at[1]);
}
inline std::string describe_triangle(std::uint64_t row, const Vertex& a, const Vertex& b, const Vertex& c) {
  return fmt::format("triangle {} with points {}, {}, {} at ({}, {}), ({}, {}), ({}, {})", row, a.id, b.id,
                     c.id, a.at[0], a.at[1], b.at[0], b.at[1], c.at[0], c.at[1]);
}

/// Euler's formula. Follows from the checks before; a safeguard against an error in them.
inline void check_count(const VerifyReport& report) {
  const std::size_t expected = 2 * report.distinct_points - 2 - report.hull_vertices;
  if (report.triangles == expected) return;
  violate("there are {} triangles, but {} distinct points with {} on the boundary must have {}",
          report.triangles, report.distinct_points, report.hull_vertices, expected);
}

}  // namespace flaunay::prove
