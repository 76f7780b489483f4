// flaunay-bench paper: the experiments of Blelloch, Miller and Talmor (1996), made again.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <thread>

#include "commands.hpp"
#include "io/file.hpp"
#include "options.hpp"
#include "paper_figures.hpp"
#include "paper_report.hpp"
#include "paper_runs.hpp"
#include "record.hpp"

namespace flaunay::bench {
namespace {

using namespace paper;

struct Request {
  Plan plan;
  std::string directory = "bench/results";
  std::string device;
};

// ---- Data

constexpr const char* kCountColumns =
    "arithmetic,depths,orientations,circles,operations,operations_with_bounds,critical_path";

std::string key_of(const Run& run) {
  return fmt::format("{},{},{},{},{}", run.distribution, run.n, run.instance, run.method.algorithm,
                     cut_name(run.method.cut));
}

/// A row for each component that did something.
void append_rows(io::OutputFile& file, const Run& run, const std::string& level,
                 const Work::Components& components) {
  for (std::size_t c = 0; c < kComponents; ++c) {
    const OperationCounts& counts = components[c];
    if (counts.operations() == 0 && counts.critical_path == 0) continue;
    file.print("{},{},{},{},{},{},{},{},{},{}\n", key_of(run), component_name(c), level, counts.arithmetic,
               counts.depths, counts.orientations, counts.circles, counts.operations(),
               counts.operations_with_bounds(), counts.critical_path);
  }
}

/// Whether the tables have this run level by level.
bool by_level(const Experiment& experiment, const Run& run) {
  return run.n == experiment.largest() && run.method.algorithm == kDefault.algorithm;
}

void write_runs(const std::string& path, const Experiment& experiment) {
  io::OutputFile file(path);
  file.print("distribution,n,instance,algorithm,cut,component,level,{}\n", kCountColumns);
  for (const Run& run : experiment.runs()) {
    append_rows(file, run, "all", totals(run.work));
    if (!by_level(experiment, run)) continue;
    append_rows(file, run, "start", run.work.start);
    for (std::size_t l = 0; l < run.work.levels.size(); ++l) {
      append_rows(file, run, fmt::format("{}", l), run.work.levels[l]);
    }
  }
  file.commit();
}

void write_levels(const std::string& path, const Experiment& experiment) {
  io::OutputFile file(path);
  file.print(
      "distribution,n,instance,algorithm,cut,level,regions,internal_points,corners,largest_region,"
      "path_vertices,operations,operations_so_far,critical_path\n");
  for (const Run& run : experiment.runs()) {
    if (!by_level(experiment, run)) continue;
    for (std::size_t l = 0; l < run.levels.size(); ++l) {
      const LevelStatistics& level = run.levels[l];
      const OperationCounts counts = total(run.work.levels[l]);
      file.print("{},{},{},{},{},{},{},{},{:.0f},{}\n", key_of(run), l, level.regions, level.internal_points,
                 level.corners, level.largest_region, level.path_vertices, counts.operations(),
                 operations_until(run, l + 1), counts.critical_path);
    }
  }
  file.commit();
}

void write_endgame_sizes(const std::string& path, const Experiment& experiment) {
  io::OutputFile file(path);
  file.print("distribution,n,cut,corners,regions\n");
  for (const std::string& distribution : distributions()) {
    for (const Cut cut : {Cut::interquartile, Cut::alternate}) {
      const auto histogram =
          endgame_histogram(experiment, distribution, experiment.largest(), {kDefault.algorithm, cut});
      for (std::size_t k = 0; k < histogram.size(); ++k) {
        if (histogram[k] == 0) continue;
        file.print("{},{},{},{},{}\n", distribution, experiment.largest(), cut_name(cut), k, histogram[k]);
      }
    }
  }
  file.commit();
}

// ---- The kernels beside the twin

Work::Components without_sorting(const Work& work) {
  Work unsorted = work;
  unsorted.start[at(Component::cut)] = {};
  return totals(unsorted);
}

double ratio(const OperationCounts& a, const OperationCounts& b) {
  return b.operations() == 0 ? 1 : static_cast<double>(a.operations()) / static_cast<double>(b.operations());
}

CrossCheck cross_check(Triangulator& triangulator, const Run& twin) {
  Options options = options_of(twin.method);
  options.mode = Mode::flattened;
  const std::vector<double> coordinates = instance_coordinates(twin.distribution, twin.n, twin.instance);
  const Work work = triangulator.triangulate(coordinates.data(), twin.n, options).statistics.work;
  const Work::Components of_kernels = without_sorting(work), of_twin = without_sorting(twin.work);
  CrossCheck check{twin.distribution, twin.n, ratio(total(of_kernels), total(of_twin)), {}};
  for (std::size_t c = 0; c < kComponents; ++c) check.by_component[c] = ratio(of_kernels[c], of_twin[c]);
  return check;
}

std::vector<CrossCheck> cross_checks(Triangulator& triangulator, const Experiment& experiment) {
  constexpr int kEnough = 14;
  const Plan& plan = experiment.plan();
  const std::size_t n = std::size_t{1} << std::max(plan.smallest, std::min(plan.largest, kEnough));
  std::vector<CrossCheck> checks;
  for (const std::string& distribution : distributions()) {
    checks.push_back(cross_check(triangulator, experiment.run(distribution, n, kDefault, 0)));
    fmt::print("kernels / twin, {} {} points: {:.4f} of the operations\n", n, distribution,
               checks.back().all);
    if (std::abs(checks.back().all - 1) > kAgreeingRatio) {
      fmt::print(stderr, "WARNING: kernels and twin count differently on {} points\n", distribution);
    }
  }
  return checks;
}

// ---- The command

void make_directory(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) io::fail(path, "cannot be made: {}", error.message());
}

void write_text(const std::string& path, const std::string& text) {
  io::OutputFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

int run(const Request& request, const std::string& command) {
  const auto path = [&](const std::string& name) { return request.directory + "/" + name; };
  make_directory(request.directory);
  check_writable({path("paper.md")});
  const Experiment experiment(request.plan);

  DeviceInfo device;
  std::vector<CrossCheck> checks;
  std::string unchecked;
  try {
    Triangulator triangulator(request.device);
    device = triangulator.device();
    checks = cross_checks(triangulator, experiment);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::device || !request.device.empty()) throw;
    unchecked = error.what();
    fmt::print(stderr, "the kernels are not checked against the twin: {}\n", unchecked);
  }

  write_runs(path("paper-runs.csv"), experiment);
  write_levels(path("paper-levels.csv"), experiment);
  write_endgame_sizes(path("paper-endgame.csv"), experiment);
  const std::vector<NamedFigure> all_figures = figures(experiment);
  for (const NamedFigure& figure : all_figures) plot::write(path(figure.file), figure.figure);
  write_text(path("paper.md"), report(experiment, all_figures, checks, unchecked,
                                      record(device, command, request.plan.instances)));
  fmt::print("{} and its figures are written\n", path("paper.md"));
  return kSuccess;
}

}  // namespace

void add_paper(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  request->plan.threads = std::max(1u, std::thread::hardware_concurrency());
  CLI::App* command =
      app.add_subcommand("paper", "the experiments of Blelloch, Miller and Talmor (1996), made again");
  command->footer(
      "Counts operations in the recursive twin and in Dwyer's algorithm, both on the host, on the paper's "
      "four "
      "distributions at every power of two from the smallest to the largest; writes paper.md, which sets the "
      "paper's claims beside what was measured, its figures (SVG), and the data (CSV). The kernels are "
      "checked "
      "against the twin once, if there is a device.");
  command->add_option("--output", request->directory, "the folder to write into")->capture_default_str();
  command->add_option("--instances", request->plan.instances, "point sets of each distribution and size")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--smallest", request->plan.smallest, "least number of points, as a power of two")
      ->check(CLI::Range(6, 24))
      ->capture_default_str();
  command->add_option("--largest", request->plan.largest, "greatest number of points, as a power of two")
      ->check(CLI::Range(6, 24))
      ->capture_default_str();
  command->add_option("--threads", request->plan.threads, "host threads")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_device_option(command, request->device);
  command->callback([request, &action] {
    if (request->plan.smallest > request->plan.largest) {
      throw CLI::ValidationError("--smallest", "is greater than --largest");
    }
    action = [request](const std::string& line) { return run(*request, line); };
  });
}

}  // namespace flaunay::bench
