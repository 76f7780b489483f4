// What is promised of a figure, and whether it is kept.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace flaunay::bench {

struct Target {
  std::string what, implementation;
  double at_least, goal;  ///< at most, where less is better: then the goal is less
  std::optional<double> measured;

  bool more_is_better() const { return goal > at_least; }
  /// How far it is, as a share of what it must be at least.
  double reached(double value) const { return more_is_better() ? value / at_least : at_least / value; }
  const char* verdict() const;
};

/// a / b, if both are there.
std::optional<double> ratio(std::optional<double> a, std::optional<double> b);

/// "4M", "10k", "300"
std::string thousands(std::size_t n);

void print_targets(const std::vector<Target>& targets);

nlohmann::json record_of(const std::vector<Target>& targets);

}  // namespace flaunay::bench
