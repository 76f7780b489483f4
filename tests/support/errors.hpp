// The errors of calls that cannot do what they are asked for.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::testing {

/// The text of the error of this kind that a call throws, or "no error".
inline std::string error_of(ErrorKind kind, const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  return "no error";
}

/// What a text is to have: one phrase, or several in braces.
struct Phrases : std::vector<std::string> {
  using vector::vector;
  Phrases(const std::vector<std::string>& parts) : vector(parts) {}
  Phrases(const char* part) : vector{part} {}
  Phrases(const std::string& part) : vector{part} {}
};

/// That a call throws an error of this kind, whose text has these parts.
inline void expect_error(ErrorKind kind, const Phrases& parts, const std::function<void()>& call) {
  const std::string text = error_of(kind, call);
  EXPECT_NE(text, "no error");
  for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << text;
}

}  // namespace flaunay::testing
