// Triangulations on other surfaces than the plane: the options of `flaunay triangulate` for them, and the
// work.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/command/results.hpp"
#include "flaunay/periodic.hpp"

namespace flaunay::cli {

struct SurfaceRequest {
  std::vector<double> period;  ///< x, y and perhaps a shear; empty without --period
  bool is_sphere = false;
  std::string offsets;  ///< the file for the corners' periods
};

/// Adds --period, whose numbers are a period.
void add_period(CLI::App* command, std::vector<double>& period, const std::string& description);
Period period_of(const std::vector<double>& numbers);

/// Adds --period, --offsets and --sphere.
void add_surface_options(CLI::App* command, SurfaceRequest& request);

/// Whether the options ask for another surface. Throws Error(usage) for options that do not go together.
bool asks_for_surface(const CLI::App& command, const SurfaceRequest& request);

/// Reads, triangulates and writes. points: the file for places, if there is one. Returns the exit code.
int triangulate_surface(const Task& task, const SurfaceRequest& request, const std::string& points);

}  // namespace flaunay::cli
