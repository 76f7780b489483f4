#include "app/command/results.hpp"

#include "app/command/options.hpp"
#include "app/files/formats.hpp"
#include "app/files/mesh.hpp"

namespace flaunay::cli {

std::vector<std::string> ResultPaths::all() const {
  std::vector<std::string> paths = {mesh};
  paths.insert(paths.end(), arrays.begin(), arrays.end());
  paths.push_back(stats);
  return paths;
}

void add_results(CLI::App* command, ResultPaths& paths) {
  add_path(command, "-o,--output", paths.mesh, fmt::format("Mesh: {}", io::endings_for(io::Use::write_mesh)));
  add_result_arrays(command, paths);
}

void add_result_arrays(CLI::App* command, ResultPaths& paths) {
  for (std::size_t k = 0; k < kArrayFiles.size(); ++k) {
    add_path(command, kArrayFiles[k].option, paths.arrays[k], kArrayFiles[k].description);
  }
  add_path(command, "--stats", paths.stats, "Statistics: .json");
}

void ask_for(const ResultPaths& paths, Options& options) {
  for (std::size_t k = 0; k < kArrayFiles.size(); ++k) {
    const auto computed_if = kArrayFiles[k].computed_if;
    if (computed_if != nullptr) options.*computed_if = !paths.arrays[k].empty();
  }
}

void announce(OutputFiles& outputs, const ResultPaths& paths, bool with_constraints) {
  outputs.add_mesh(paths.mesh, with_constraints);
  for (const std::string& path : paths.arrays) outputs.add(path, ".npy");
  outputs.add(paths.stats, ".json");
}

void write_arrays(const ResultPaths& paths, const Triangulation& mesh, OutputFiles& outputs,
                  io::IndexType index) {
  for (std::size_t k = 0; k < kArrayFiles.size(); ++k) {
    const ArrayFile& file = kArrayFiles[k];
    if (paths.arrays[k].empty()) continue;
    io::write_npy_indices(outputs.files(), paths.arrays[k], mesh.*file.values, file.columns, index);
  }
}

void commit_with_statistics(const ResultPaths& paths, const research::Triangulation& mesh,
                            const RunFacts& facts, OutputFiles& outputs) {
  if (!paths.stats.empty()) outputs.files().open(paths.stats).print("{}", statistics_json(mesh, facts));
  outputs.files().commit();
}

void write_results(const ResultPaths& paths, const io::Points& points, const research::Triangulation& mesh,
                   RunFacts& facts, Progress& progress, OutputFiles& outputs, io::IndexType index) {
  Stopwatch stopwatch;
  progress.update("writing");
  if (!paths.mesh.empty()) io::write_mesh(outputs.files(), paths.mesh, {points, mesh});
  write_arrays(paths, mesh, outputs, index);
  outputs.files().write_out();
  facts.writing_seconds = stopwatch.seconds();
  commit_with_statistics(paths, mesh, facts, outputs);
  progress.finish();
}

}  // namespace flaunay::cli
