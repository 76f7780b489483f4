// A triangulation's files, alike for all subcommands that make one.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "flaunay/flaunay.hpp"
#include "io/points.hpp"

namespace flaunay::cli {

/// Where each result goes; empty: nowhere.
struct ResultPaths {
  std::string mesh;
  std::string triangles;
  std::string neighbors;
  std::string hull;
  std::string duplicates;
  std::string stats;

  std::vector<std::string> all() const { return {mesh, triangles, neighbors, hull, duplicates, stats}; }
};

void add_results(CLI::App* command, ResultPaths& paths);

/// Announces all of them, the statistics too.
void announce(OutputFiles& outputs, const ResultPaths& paths);

/// Writes all of them and keeps them; the statistics last, which say how long the others took. Ends the
/// progress.
void write_results(const ResultPaths& paths, const io::Points& points, const Triangulation& mesh,
                   RunFacts& facts, Progress& progress, OutputFiles& outputs);

}  // namespace flaunay::cli
