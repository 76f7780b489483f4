// Triangulations in other spaces than the plane, and of points with weights: the options of `flaunay
// triangulate` for them, and the work.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/command/results.hpp"

namespace flaunay::cli {

struct SpaceRequest {
  std::vector<double> period;         ///< x, y and perhaps a shear; empty without --period
  SpaceKind kind = SpaceKind::plane;  ///< that of a flag; with a period, a torus
  bool is_weighted = false;
  std::string offsets;  ///< the file for the corners' periods
  std::string hidden;   ///< the file for hidden points

  bool is_periodic() const { return !period.empty(); }
  /// Whether points lie in another space than the plane, or have weights.
  bool is_in_space() const { return is_weighted || kind != SpaceKind::plane || is_periodic(); }
};

/// The space that is asked for, without weights.
Space space_of(const SpaceRequest& request);

/// Adds --period, --offsets, --sphere and --weighted.
void add_space_options(CLI::App* command, SpaceRequest& request);

/// Throws Error(usage) for options that do not go with the space that is asked for. others: those that go
/// with all.
void check_space_options(const CLI::App& command, const SpaceRequest& request,
                         const std::vector<std::string>& others);

/// Whether the options of triangulate ask for another space, or for weights. Throws Error(usage) for options
/// that do not go together.
bool asks_for_space(const CLI::App& command, const SpaceRequest& request);

struct WeightedPoints {
  io::Points points;
  std::vector<double> weights;
};
/// Reads points, and their weights if they have some. Throws Error(input) that names the place.
WeightedPoints read_weighted_points(const std::string& path, const io::Columns& columns, bool is_weighted);

/// Reads, triangulates and writes. places: the file for places, if there is one. Returns the exit code.
int triangulate_in_space(const Task& task, const SpaceRequest& request, const std::string& places);

}  // namespace flaunay::cli
