#include <fmt/format.h>

#include <memory>
#include <string>

#include "cli/commands.hpp"
#include "cli/options.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/results.hpp"
#include "flaunay/flaunay.hpp"
#include "io/points.hpp"

namespace flaunay::cli {

namespace {

struct TriangulateRequest {
  std::string input;
  ResultPaths results;
  Mode mode = Mode::hybrid;
  Cut cut = Cut::interquartile;
  Hull dividing_paths = Hull::prune;
  int partition_levels = 0;
  int threads = 0;
  bool count = false;
  std::string device;
  bool profile = false;
  bool quiet = false;
};

// Whether regions are divided by paths.
bool has_paths(Mode mode) { return mode != Mode::hybrid && mode != Mode::dwyer; }
bool on_host(Mode mode) { return mode == Mode::recursive || mode == Mode::dwyer; }

// Options that the chosen mode would ignore, or cannot do, are a mistake.
void check_combination(const CLI::App& command, const TriangulateRequest& request) {
  const std::string mode = to_string(request.mode);
  if (on_host(request.mode)) {
    for (const char* option : {"--device", "--profile"}) {
      refuse(command, option, fmt::format("mode {} runs on the host, without a device", mode));
    }
  } else if (request.dividing_paths == Hull::monotone_chain) {
    refuse(command, "--hull-variant", fmt::format("monotone-chain needs --mode recursive, not {}", mode));
  }
  if (!has_paths(request.mode)) {
    for (const char* option : {"--cut", "--hull-variant"}) {
      refuse(command, option, fmt::format("mode {} has no such choice; take --mode flattened", mode));
    }
  }
  if (request.mode == Mode::hybrid) {
    refuse(command, "--count", "mode hybrid does not count; take --mode flattened");
  }
  if (request.mode != Mode::partition) {
    for (const char* option : {"--partition-levels", "--threads"}) {
      refuse(command, option, fmt::format("needs --mode partition, not {}", mode));
    }
  }
}

RunFacts facts_of(const TriangulateRequest& request) {
  RunFacts facts;
  facts.input = request.input;
  facts.mode = to_string(request.mode);
  facts.counted = request.count;
  if (has_paths(request.mode)) {
    facts.cut = to_string(request.cut);
    facts.dividing_paths = to_string(request.dividing_paths);
  }
  return facts;
}

Options options_of(const TriangulateRequest& request, Progress& progress) {
  Options options;
  options.mode = request.mode;
  options.cut = request.cut;
  options.hull = request.dividing_paths;
  options.neighbors = !request.results.neighbors.empty();
  options.profile = request.profile;
  options.count = request.count;
  options.partition_levels = request.partition_levels;
  options.threads = request.threads;
  options.progress = [&progress](const std::string& stage, int level, double done) {
    progress.update(stage, level, done);
  };
  return options;
}

int triangulate(const TriangulateRequest& request) {
  // Everything that can be wrong with the request is found before any work; bad input before a device is
  // opened.
  io::check_points_ending(request.input);
  OutputFiles outputs(request.input);
  announce(outputs, request.results);

  RunFacts facts = facts_of(request);
  Progress progress(!request.quiet);
  Stopwatch stopwatch;

  progress.update("reading");
  const io::Points points = io::read_points(request.input);
  facts.reading_seconds = stopwatch.restart();

  const Options options = options_of(request, progress);
  Triangulation mesh;
  if (on_host(request.mode)) {
    mesh = triangulate_on_host(points.coordinates.data(), {0, points.size()}, options);
  } else {
    progress.update_slow("preparing the device", "compiling kernels, cached for next time");
    Triangulator triangulator(request.device);
    facts.opening_seconds = stopwatch.restart();
    mesh = triangulator.triangulate(points.coordinates.data(), points.size(), options);
  }

  write_results(request.results, points, mesh, facts, progress, outputs);

  if (!request.quiet) {
    print((request.profile ? kernel_table(mesh.statistics) : "") +
          (request.count ? work_table(mesh.statistics) : "") + degenerate_note(mesh.statistics) +
          summary(mesh.statistics, facts));
  }
  return kSuccess;
}

}  // namespace

void add_triangulate(CLI::App& app, Action& action) {
  auto request = std::make_shared<TriangulateRequest>();
  CLI::App* command = app.add_subcommand("triangulate", "Triangulate the points of a file");
  add_input(command, request->input);
  add_results(command, request->results);
  add_choice<Mode>(
      command, "--mode", request->mode,
      "How to divide and conquer; the triangles are the same. recursive and dwyer need no device",
      {Mode::hybrid, Mode::flattened, Mode::recursive_device, Mode::recursive, Mode::partition, Mode::dwyer});
  add_cut(command, request->cut);
  add_hull_variant(
      command, request->dividing_paths, {Hull::prune, Hull::quickhull, Hull::balanced, Hull::monotone_chain},
      "How the dividing paths are computed; the triangles are the same. monotone-chain: mode recursive only");
  command
      ->add_option("--partition-levels", request->partition_levels,
                   "Mode partition: levels on the device; enough for the threads if not given")
      ->check(CLI::Range(1, kMostPartitionLevels));
  add_threads(command, request->threads, "Mode partition: threads on the host; one per core if not given");
  add_device(command, request->device);
  command->add_flag("--profile", request->profile, "Time every kernel");
  command->add_flag("--count", request->count, "Count operations, for a table and for the statistics; slow");
  add_quiet(command, request->quiet);
  command->callback([request, command, &action] {
    check_combination(*command, *request);
    action = [request] { return triangulate(*request); };
  });
}

}  // namespace flaunay::cli
