#include "verify/verify.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "io/mesh.hpp"
#include "io/points.hpp"

namespace flaunay::cli {

namespace {

struct VerifyRequest {
  std::string points;
  std::string triangles;
  std::string neighbors;
};

int verify(const VerifyRequest& request) {
  io::check_points_ending(request.points);
  Progress progress(true);
  progress.update("reading");
  const io::Points points = io::read_points(request.points);
  const std::vector<std::int32_t> triangles = io::read_triangles(request.triangles);
  std::vector<std::int32_t> neighbors;
  if (!request.neighbors.empty()) neighbors = io::read_neighbors(request.neighbors);

  progress.update("verifying");
  const Stopwatch stopwatch;
  const VerifyReport report =
      request.neighbors.empty()
          ? flaunay::verify(points.coordinates.data(), points.size(), triangles)
          : flaunay::verify(points.coordinates.data(), points.size(), triangles, neighbors);
  const double seconds = stopwatch.seconds();
  progress.finish();

  // The problem goes to standard error first, because standard output may be closed.
  if (!report.ok) {
    report_error("flaunay", kFailure, fmt::format("{}: {}", request.triangles, report.problem));
  }
  print(
      fmt::format("{}: {} points, {} distinct, {} triangles, {} hull vertices, {} cocircular edges; "
                  "{} exact evaluations, {:.3f} s\n",
                  report.ok ? "right" : "wrong", report.points, report.distinct_points, report.triangles,
                  report.hull_vertices, report.cocircular_edges, report.exact_evaluations, seconds));
  return report.ok ? kSuccess : kFailure;
}

}  // namespace

void add_verify(CLI::App& app, Action& action) {
  auto request = std::make_shared<VerifyRequest>();
  CLI::App* command =
      app.add_subcommand("verify", "Check with exact arithmetic that triangles are a Delaunay triangulation");
  command->add_option("points", request->points, "The points, in any format that triangulate reads")
      ->required();
  command->add_option("triangles", request->triangles, "The triangles: .npy, .ele, .off, .obj or .ply")
      ->required();
  command->add_option("--neighbors", request->neighbors, "Neighbours to check too: .npy");
  command->callback([request, &action] { action = [request] { return verify(*request); }; });
  command->footer("The exit code is 0 if the triangles are a Delaunay triangulation, 1 if they are not.");
}

}  // namespace flaunay::cli
