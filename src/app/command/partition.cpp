#include <memory>
#include <string>

#include "app/command/commands.hpp"
#include "app/command/compiling.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/partition_folder.hpp"
#include "app/command/progress.hpp"
#include "app/command/report.hpp"
#include "app/files/formats.hpp"
#include "app/files/region.hpp"
#include "files/temporary.hpp"
#include "flaunay/research.hpp"

namespace flaunay::cli {

namespace {

struct PartitionRequest {
  std::string input;
  io::Columns columns;
  std::string folder;
  std::string picture;
  int levels = 0;
  Cut cut = Cut::interquartile;
  Hull dividing_paths = Hull::prune;
  std::string device;
  bool force = false;
  bool quiet = false;
};

research::Partition compute(const PartitionRequest& request, const io::Points& points, RunFacts& facts,
                            Progress& progress) {
  research::Options options;
  options.cut = request.cut;
  options.hull = request.dividing_paths;
  options.progress = progress.callback();
  progress.update_slow("preparing the device", kCompiling);
  const Stopwatch stopwatch;
  Triangulator triangulator(request.device);
  facts.opening_seconds = stopwatch.seconds();
  research::Options silent = options;
  silent.progress = nullptr;
  facts.compiling_seconds = compile_kernels(points.size(), Mode::flattened, [&](std::size_t n) {
    research::partition(triangulator, points.coordinates.data(), n, request.levels, silent);
  });
  return research::partition(triangulator, points.coordinates.data(), points.size(), request.levels, options);
}

int partition(const PartitionRequest& request) {
  io::format_of(request.input, io::Use::read_points);
  // The folder comes first, because the picture may be in it.
  const io::Temporary folder = make_partition_folder(request.folder, request.input, request.force);
  check_no_partition_file(request.folder, request.picture);
  OutputFiles outputs({request.input});
  announce_partition(outputs, request.folder);
  outputs.add(request.picture, ".svg");

  RunFacts facts;
  facts.what_was_done = "partitioned";
  Progress progress(!request.quiet);
  Stopwatch stopwatch;
  progress.update("reading");
  const io::Points points = io::read_points(request.input, request.columns);
  facts.reading_seconds = stopwatch.seconds();

  const research::Partition result = compute(request, points, facts, progress);

  stopwatch.restart();
  progress.update("writing");
  write_partition(outputs, request.folder, points, result,
                  {request.input, request.levels, request.cut, request.dividing_paths});
  if (!request.picture.empty()) io::write_partition_svg(outputs, request.picture, points, result);
  outputs.commit();
  facts.writing_seconds = stopwatch.seconds();
  progress.finish();

  if (!request.quiet) print(partition_summary(result, facts));
  return kSuccess;
}

}  // namespace

void add_partition(CLI::App& app, Action& action) {
  auto request = std::make_shared<PartitionRequest>();
  CLI::App* command = app.add_subcommand(
      "partition", "Cut the triangulation of a file's points into regions for other programs to solve");
  add_input(command, request->input, request->columns);
  command->add_option("--levels", request->levels, "Number of levels; there are up to 2^levels regions")
      ->check(CLI::Range(0, kMostPartitionLevels))
      ->required();
  add_path(command, "-o,--output", request->folder,
           "Folder for the regions (.node and .poly), the finished triangles (.npy) and partition.json")
      ->required();
  command->add_flag("--force", request->force,
                    "Replace a partition that is in the folder, with the solutions of its regions");
  add_path(command, "--picture", request->picture, "A picture of the regions: .svg");
  add_cut(command, request->cut);
  add_hull_variant(command, request->dividing_paths, {Hull::prune, Hull::quickhull, Hull::balanced},
                   "How dividing paths are computed; the regions do not depend on it");
  add_device(command, request->device);
  add_quiet(command, request->quiet);
  command->footer(examples({"flaunay partition points.npy --levels 4 -o regions --picture regions.svg"}) +
                  "\nflaunay assemble joins the solved regions.");
  command->callback([request, &action] { action = [request] { return partition(*request); }; });
}

}  // namespace flaunay::cli
