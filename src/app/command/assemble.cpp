#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/command/commands.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/partition_folder.hpp"
#include "app/command/progress.hpp"
#include "app/command/report.hpp"
#include "app/command/results.hpp"
#include "app/files/formats.hpp"
#include "flaunay/research.hpp"
#include "host/native/threads.hpp"

namespace flaunay::cli {

namespace {

struct AssembleRequest {
  std::string input;
  io::Columns columns;
  std::string folder;
  ResultPaths results;
  bool solve = false;
  int threads = 0;
  bool quiet = false;
};

// The path of each region's solution; empty if the region is to be solved here.
std::vector<std::string> find_solutions(const PartitionReader& reader, bool solve) {
  std::vector<std::string> paths;
  for (std::size_t r = 0; r < reader.regions(); ++r) paths.push_back(reader.solution_path(r));
  const auto first = std::find(paths.begin(), paths.end(), "");
  if (first != paths.end() && !solve) {
    throw Error(ErrorKind::input,
                fmt::format("{}.npy: is missing, and so are .ele and .1.ele; {} of {} regions have no "
                            "solution (--solve computes what is missing)",
                            reader.stem(static_cast<std::size_t>(first - paths.begin())),
                            std::count(paths.begin(), paths.end(), ""), paths.size()));
  }
  return paths;
}

std::vector<std::int32_t> solve_region(const io::Points& points, const research::Region& region) {
  std::vector<double> own;
  for (const std::int32_t index : region.points) {
    const double* point = &points.coordinates[2 * static_cast<std::size_t>(index)];
    own.insert(own.end(), point, point + 2);
  }
  research::Options options;
  options.mode = Mode::dwyer;
  options.neighbors = false;
  return research::triangulate_on_host(own.data(), {0, region.points.size()}, options).triangles;
}

// The library's messages name a region by its number or speak of "the parts".
std::vector<ElementFile> files_of(const PartitionReader& reader, const std::vector<std::string>& paths) {
  std::vector<ElementFile> files = {{"the parts ", reader.description_path()}};
  for (std::size_t r = 0; r < paths.size(); ++r) {
    files.push_back({fmt::format("region {}: ", r), paths[r].empty() ? reader.stem(r) + ".node" : paths[r]});
  }
  return files;
}

int assemble(const AssembleRequest& request) {
  io::format_of(request.input, io::Use::read_points);
  for (const std::string& path : request.results.all()) check_no_partition_file(request.folder, path);
  OutputFiles outputs({request.input});
  announce(outputs, request.results);
  const PartitionReader reader(request.folder);
  const std::vector<std::string> paths = find_solutions(reader, request.solve);

  RunFacts facts;
  facts.input = request.input;
  facts.mode = "assemble";
  facts.what_was_done = "assembled";
  Progress progress(!request.quiet);
  Stopwatch stopwatch;
  progress.update("reading");
  const io::Points points = io::read_points(request.input, request.columns);
  const research::Partition partition = reader.read(request.input, points);
  std::vector<std::vector<std::int32_t>> solutions(paths.size());
  std::vector<std::size_t> unsolved;
  for (std::size_t r = 0; r < paths.size(); ++r) {
    if (paths[r].empty()) {
      unsolved.push_back(r);
    } else {
      solutions[r] = io::read_triangles(paths[r]);
    }
  }
  facts.reading_seconds = stopwatch.restart();

  progress.update("solving");
  host::Threads(static_cast<std::size_t>(request.threads)).share_each(unsolved.size(), [&](std::size_t k) {
    solutions[unsolved[k]] = solve_region(points, partition.regions[unsolved[k]]);
  });
  facts.solving_seconds = stopwatch.seconds();

  Options options;
  ask_for(request.results, options);
  options.progress = progress.callback();
  research::Triangulation mesh;
  static_cast<Triangulation&>(mesh) = naming_files(files_of(reader, paths), [&] {
    return research::assemble(points.coordinates.data(), points.size(), partition, solutions, options);
  });

  write_results(request.results, points, mesh, facts, progress, outputs);

  if (!request.quiet) print(degenerate_note(mesh.statistics) + summary(mesh.statistics, facts));
  return kSuccess;
}

}  // namespace

void add_assemble(CLI::App& app, Action& action) {
  auto request = std::make_shared<AssembleRequest>();
  CLI::App* command = app.add_subcommand(
      "assemble", "Join the solved regions of a partition to the triangulation of all points");
  add_input(command, request->input, request->columns);
  command->add_option("partition", request->folder, "The folder that flaunay partition wrote")->required();
  add_results(command, request->results);
  CLI::Option* solve =
      command->add_flag("--solve", request->solve, "Solve the regions that have no solution");
  add_threads(command, request->threads, "Threads for --solve; default: one per core")->needs(solve);
  add_quiet(command, request->quiet);
  command->footer(
      examples({"flaunay assemble points.npy regions --solve --triangles t.npy"}) +
      "\nA region's solution is any Delaunay triangulation of the points of region-00000.node, up to their "
      "convex hull, in a file beside it: region-00000.npy (int32, 3 positions per row), region-00000.ele or "
      "region-00000.1.ele (the format of Triangle).");
  command->callback([request, &action] { action = [request] { return assemble(*request); }; });
}

}  // namespace flaunay::cli
