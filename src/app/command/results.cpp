#include "app/command/results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/files/formats.hpp"

namespace flaunay::cli {
namespace {

bool is_in_chunks(std::size_t k) {
  return std::find(kMeshArrayIndices.begin(), kMeshArrayIndices.end(), k) != kMeshArrayIndices.end();
}

}  // namespace

std::string option_of(std::string_view name) {
  // For users, representatives tell duplicates.
  std::string option = fmt::format("--{}", name == "representatives" ? "duplicates" : name);
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

std::vector<std::string> ResultPaths::all() const {
  std::vector<std::string> paths = {mesh};
  paths.insert(paths.end(), arrays.begin(), arrays.end());
  paths.push_back(stats);
  return paths;
}

void add_results(CLI::App* command, ResultPaths& paths) {
  add_path(command, "-o,--output", paths.mesh,
           fmt::format("Mesh: {}; .ele has a .node beside it; - is .off on standard output",
                       io::endings_for(io::Use::write_mesh)));
  add_result_arrays(command, paths);
}

void add_result_arrays(CLI::App* command, ResultPaths& paths, bool in_chunks) {
  for_each_array([&](const auto& array, std::size_t k) {
    if (in_chunks && !is_in_chunks(k)) return;
    add_array(command, array, paths.arrays[k]);
  });
  add_path(command, "--stats", paths.stats, "Statistics: .json");
}

void ask_for(const ResultPaths& paths, Options& options) {
  for_each_array([&](const auto& array, std::size_t k) {
    if (array.option != nullptr) options.*array.option = !paths.arrays[k].empty();
  });
}

std::array<std::string, io::kMeshArrays> mesh_paths(const ResultPaths& paths) {
  for_each_array([&](const auto& array, std::size_t k) {
    if (paths.arrays[k].empty() || is_in_chunks(k)) return;
    throw Error(ErrorKind::usage,
                fmt::format("{}: triangulations in chunks do not have it; it needs all points at once",
                            option_of(array.name)));
  });
  std::array<std::string, io::kMeshArrays> found;
  for (std::size_t k = 0; k < found.size(); ++k) found[k] = paths.arrays[kMeshArrayIndices[k]];
  return found;
}

void announce(OutputFiles& outputs, const ResultPaths& paths, bool with_constraints) {
  outputs.add_mesh(paths.mesh, with_constraints);
  for (const std::string& path : paths.arrays) outputs.add(path, ".npy");
  outputs.add(paths.stats, ".json");
}

void write_files(const ResultPaths& paths, RunFacts& facts, Progress& progress, OutputFiles& outputs,
                 const std::function<void()>& write, const std::function<std::string()>& statistics) {
  const Stopwatch stopwatch;
  progress.update("writing");
  write();
  outputs.write_out();
  facts.writing_seconds = stopwatch.seconds();
  if (!paths.stats.empty()) outputs.open(paths.stats).print("{}", statistics());
  outputs.commit();
  progress.finish();
}

void write_results(const ResultPaths& paths, const io::Points& points, const research::Triangulation& mesh,
                   RunFacts& facts, Progress& progress, OutputFiles& outputs, io::IndexType index) {
  const auto write = [&] {
    if (!paths.mesh.empty()) io::write_mesh(outputs, paths.mesh, {points, mesh});
    write_arrays(kTriangulationArrays, paths.arrays, mesh, outputs, index);
  };
  write_files(paths, facts, progress, outputs, write, [&] { return statistics_json(mesh, facts); });
}

}  // namespace flaunay::cli
