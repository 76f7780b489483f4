// Regular triangulations: the options of `flaunay triangulate` for them, and the work.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/command/results.hpp"

namespace flaunay::cli {

struct WeightedRequest {
  bool is_weighted = false;
  std::string hidden;  ///< the file for hidden points
};

/// Adds --weighted and --hidden.
void add_weighted_options(CLI::App* command, WeightedRequest& request);

/// Whether points have weights. Throws Error(usage) for options that do not go together.
bool asks_for_weighted(const CLI::App& command, const WeightedRequest& request);

struct WeightedPoints {
  io::Points points;
  std::vector<double> weights;
};
/// Reads points and weights. Throws Error(input) that names the place.
WeightedPoints read_weighted(const std::string& path, const io::Columns& columns);

/// Reads, triangulates and writes. Returns the exit code.
int triangulate_weighted(const Task& task, const WeightedRequest& request);

}  // namespace flaunay::cli
