// Violations, and the words in which they name points and triangles.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>

namespace flaunay::verification {

/// The first violation that a part of the check found; ends it.
struct Violation {
  std::string problem;
};

template <typename... Arguments>
[[noreturn]] void violate(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  throw Violation{fmt::format(text, std::forward<Arguments>(arguments)...)};
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

}  // namespace flaunay::verification
