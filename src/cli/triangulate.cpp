#include <fmt/format.h>

#include <memory>
#include <string>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "flaunay/flaunay.hpp"
#include "io/mesh.hpp"
#include "io/points.hpp"

namespace flaunay::cli {

namespace {

struct TriangulateRequest {
  std::string input;
  std::string mesh;
  std::string triangles;
  std::string neighbors;
  std::string hull;
  std::string duplicates;
  std::string stats;
  std::string mode = "flattened";
  std::string cut = "iqr";
  std::string device;
  bool profile = false;
  bool quiet = false;
};

void write_outputs(const TriangulateRequest& request, const io::Points& points, const Triangulation& mesh) {
  if (!request.mesh.empty()) io::write_mesh(request.mesh, points, mesh);
  if (!request.triangles.empty()) io::write_npy_int32(request.triangles, mesh.triangles, 3);
  if (!request.neighbors.empty()) io::write_npy_int32(request.neighbors, mesh.neighbors, 3);
  if (!request.hull.empty()) io::write_npy_int32(request.hull, mesh.hull, 0);
  if (!request.duplicates.empty()) io::write_npy_int32(request.duplicates, mesh.representatives, 0);
}

int triangulate(const TriangulateRequest& request) {
  // Everything that can be wrong with the request is found before any work; bad input before a device is
  // opened.
  io::check_points_ending(request.input);
  OutputFiles outputs(request.input);
  outputs.add_mesh(request.mesh);
  outputs.add(request.triangles, ".npy");
  outputs.add(request.neighbors, ".npy");
  outputs.add(request.hull, ".npy");
  outputs.add(request.duplicates, ".npy");
  outputs.add(request.stats, ".json");

  RunFacts facts;
  facts.input = request.input;
  facts.mode = request.mode;
  facts.cut = request.cut;
  Progress progress(!request.quiet);
  Stopwatch stopwatch;

  progress.update("reading");
  const io::Points points = io::read_points(request.input);
  facts.reading_seconds = stopwatch.restart();

  progress.update_slow("preparing the device", "compiling kernels, cached for next time");
  Triangulator triangulator(request.device);
  facts.opening_seconds = stopwatch.restart();

  Options options;
  options.cut = request.cut == "alternate" ? Cut::alternate : Cut::interquartile;
  options.neighbors = !request.neighbors.empty();
  options.profile = request.profile;
  options.progress = [&progress](const std::string& stage, int level, double done) {
    progress.update(stage, level, done);
  };
  const Triangulation mesh = triangulator.triangulate(points.coordinates.data(), points.size(), options);

  stopwatch.restart();
  progress.update("writing");
  write_outputs(request, points, mesh);
  facts.writing_seconds = stopwatch.seconds();
  if (!request.stats.empty()) write_text(request.stats, statistics_json(mesh.statistics, facts));
  outputs.keep();
  progress.finish();

  if (!request.quiet) {
    print((request.profile ? kernel_table(mesh.statistics) : "") + degenerate_note(mesh.statistics) +
          summary(mesh.statistics, facts));
  }
  return kSuccess;
}

}  // namespace

void add_triangulate(CLI::App& app, Action& action) {
  auto request = std::make_shared<TriangulateRequest>();
  CLI::App* command = app.add_subcommand("triangulate", "Triangulate the points of a file");
  command
      ->add_option("input", request->input,
                   "Points: .npy, .node, .xy, .txt, .csv, .bin, or - for text from standard input")
      ->required();
  // An empty path, as from an unset shell variable, is a mistake and not "no output".
  const CLI::Validator not_empty(
      [](std::string& path) { return path.empty() ? std::string("the path is empty") : std::string(); },
      "PATH");
  const auto add_output = [&](const std::string& option, std::string& path, const std::string& description) {
    command->add_option(option, path, description)->check(not_empty);
  };
  add_output("-o,--output", request->mesh,
             "Mesh: .ele (with .node beside it), .off, .ply, .vtu, .obj, .npy or .svg");
  add_output("--triangles", request->triangles, "Triangles: .npy, int32, 3 point indices a row");
  add_output("--neighbors", request->neighbors,
             "Neighbours: .npy, int32, the triangle opposite to each vertex, -1 on the hull");
  add_output("--hull", request->hull, "Hull: .npy, int32, counter-clockwise");
  add_output("--duplicates", request->duplicates,
             "Duplicates: .npy, int32, for each point the one that represents it");
  add_output("--stats", request->stats, "Statistics: .json");
  command->add_option("--mode", request->mode, "How to divide and conquer")
      ->check(CLI::IsMember({"flattened"}))
      ->capture_default_str();
  command
      ->add_option("--cut", request->cut, "Cut across the longer interquartile range, or alternate x and y")
      ->check(CLI::IsMember({"iqr", "alternate"}))
      ->capture_default_str();
  command->add_option("--device", request->device,
                      "OpenCL device: part of its name, or #k; see flaunay devices");
  command->add_flag("--profile", request->profile, "Time every kernel");
  command->add_flag("--quiet", request->quiet, "No progress and no final line");
  command->callback([request, &action] { action = [request] { return triangulate(*request); }; });
}

}  // namespace flaunay::cli
