// What the fuzzers of the library have in common: cases by seed and number until the time is over.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tests/support/fixtures.hpp"

namespace flaunay::fuzz {

class Fuzzer {
 public:
  virtual ~Fuzzer() = default;
  /// Makes a case and tries it. If something is wrong, prints the least that fails and returns false.
  virtual bool run(testing::FixtureRandom& random) = 0;
  /// What was tried, for the last line.
  virtual std::string summary() const = 0;
};

/// The command that repeats the case at hand.
const char* case_name();
/// Begins the time that one check may take. If it does not end, or if the process ends, the case is named.
void start_check();

/// PROGRAM [--seconds N] [--seed S] [--first CASE]. Each case depends on the seed and its number alone, so
/// --first repeats one. Returns the exit code.
int run_fuzzer(int argc, char** argv, const std::string& program, const std::string& description,
               const std::function<std::unique_ptr<Fuzzer>()>& make);

template <typename Derived>
int run_fuzzer(int argc, char** argv, const std::string& program, const std::string& description) {
  return run_fuzzer(argc, argv, program, description, [] { return std::make_unique<Derived>(); });
}

}  // namespace flaunay::fuzz
