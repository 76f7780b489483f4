// Checks of results that end with the first problem, which is told in words.
#pragma once

#include <fmt/format.h>

#include <string>

namespace flaunay::geometry {

struct Problem {
  std::string text;
};

/// Throws Problem unless the condition holds.
template <typename... Values>
void require(bool holds, const char* text, const Values&... values) {
  if (!holds) throw Problem{fmt::format(fmt::runtime(text), values...)};
}

/// The problem that the checks end with; empty if there is none.
template <typename Checks>
std::string problem_in(const Checks& checks) {
  try {
    checks();
  } catch (const Problem& problem) {
    return problem.text;
  }
  return {};
}

}  // namespace flaunay::geometry
