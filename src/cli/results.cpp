#include "cli/results.hpp"

#include "cli/options.hpp"
#include "io/mesh.hpp"

namespace flaunay::cli {

void add_results(CLI::App* command, ResultPaths& paths) {
  add_path(command, "-o,--output", paths.mesh,
           "Mesh: .ele (with .node beside it), .off, .ply, .vtu, .obj, .npy or .svg");
  add_path(command, "--triangles", paths.triangles, "Triangles: .npy, int32, 3 point indices a row");
  add_path(command, "--neighbors", paths.neighbors,
           "Neighbours: .npy, int32, the triangle opposite to each vertex, -1 on the hull");
  add_path(command, "--hull", paths.hull, "Hull: .npy, int32, counter-clockwise");
  add_path(command, "--duplicates", paths.duplicates,
           "Duplicates: .npy, int32, for each point the one that represents it");
  add_path(command, "--stats", paths.stats, "Statistics: .json");
}

void announce(OutputFiles& outputs, const ResultPaths& paths) {
  outputs.add_mesh(paths.mesh);
  for (const std::string& path : {paths.triangles, paths.neighbors, paths.hull, paths.duplicates}) {
    outputs.add(path, ".npy");
  }
  outputs.add(paths.stats, ".json");
}

namespace {

void write_mesh_files(const ResultPaths& paths, const io::Points& points, const Triangulation& mesh) {
  if (!paths.mesh.empty()) io::write_mesh(paths.mesh, points, mesh);
  if (!paths.triangles.empty()) io::write_npy_int32(paths.triangles, mesh.triangles, 3);
  if (!paths.neighbors.empty()) io::write_npy_int32(paths.neighbors, mesh.neighbors, 3);
  if (!paths.hull.empty()) io::write_npy_int32(paths.hull, mesh.hull, 0);
  if (!paths.duplicates.empty()) io::write_npy_int32(paths.duplicates, mesh.representatives, 0);
}

}  // namespace

void write_results(const ResultPaths& paths, const io::Points& points, const Triangulation& mesh,
                   RunFacts& facts, Progress& progress, OutputFiles& outputs) {
  Stopwatch stopwatch;
  progress.update("writing");
  write_mesh_files(paths, points, mesh);
  facts.writing_seconds = stopwatch.seconds();
  if (!paths.stats.empty()) write_text(paths.stats, statistics_json(mesh.statistics, facts));
  outputs.keep();
  progress.finish();
}

}  // namespace flaunay::cli
