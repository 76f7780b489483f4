#include "app/command/weighted.hpp"

#include <fmt/format.h>

#include <utility>

#include "app/command/chunks.hpp"
#include "app/command/errors.hpp"
#include "app/command/progress.hpp"
#include "app/files/scan.hpp"

namespace flaunay::cli {

void add_weighted_options(CLI::App* command, WeightedRequest& request) {
  command->add_flag(
      "--weighted", request.is_weighted,
      "Each point has a weight behind x and y: the regular triangulation, of .npy, .txt, .csv and .xyz");
  add_path(command, "--hidden", request.hidden, "With --weighted: points without a power cell: .npy");
}

bool asks_for_weighted(const CLI::App& command, const WeightedRequest& request) {
  if (!request.is_weighted) {
    refuse(command, "--hidden", "needs --weighted");
    return false;
  }
  refuse_all_but(command, {"--weighted", "--hidden"},
                 {"--output", "--triangles", "--neighbors", "--halfedges", "--hull", "--duplicates",
                  "--areas", "--stats", "--device", "--index", "--columns", "--quiet"});
  if (asks_for_chunks(command, command.get_option("--device")->as<std::string>()))
    refuse(command, "--device", "weighted points need one device");
  return true;
}

WeightedPoints read_weighted(const std::string& path, const io::Columns& columns) {
  io::Scan file({path}, {}, "", columns, "weight");
  file.survey([](double) {});
  const auto n = static_cast<std::size_t>(file.size());
  WeightedPoints read;
  read.points.coordinates.resize(2 * n);
  read.weights.resize(n);
  file.read(0, n, read.points.coordinates.data());
  file.read_values(0, n, read.weights.data());
  return read;
}

int triangulate_weighted(const Task& task, const WeightedRequest& request) {
  OutputFiles outputs({task.input});
  announce(outputs, task.results);
  outputs.add(request.hidden, ".npy");

  RunFacts facts;
  facts.input = task.input;
  facts.mode = "blocks";
  Progress progress(!task.quiet);
  Stopwatch stopwatch;
  progress.update("reading");
  const auto [points, weights] = read_weighted(task.input, task.columns);
  const std::size_t n = points.size();
  facts.reading_seconds = stopwatch.restart();
  const io::IndexType index = index_type(task.index, n, task.results);

  progress.update("triangulating");
  Triangulator triangulator(task.device);
  facts.opening_seconds = stopwatch.restart();
  Options options;
  ask_for(task.results, options);
  research::Triangulation mesh;
  static_cast<Triangulation&>(mesh) = naming_files({{"point ", task.input}}, [&, &weights = weights] {
    return triangulator.triangulate(points.coordinates.data(), n, Space::plane().with_weights(weights.data()),
                                    options);
  });

  const auto write = [&] {
    if (!task.results.mesh.empty()) io::write_mesh(outputs, task.results.mesh, {points, mesh});
    write_arrays(kTriangulationArrays, task.results.arrays, mesh, outputs, index);
    if (!request.hidden.empty()) io::write_npy(outputs, request.hidden, mesh.hidden, 1, index);
  };
  write_files(task.results, facts, progress, outputs, write, [&] { return statistics_json(mesh, facts); });
  if (!task.quiet) {
    print(fmt::format("hidden points: {}\n", mesh.hidden.size()) + degenerate_note(mesh.statistics) +
          summary(mesh.statistics, facts));
  }
  return kSuccess;
}

}  // namespace flaunay::cli
