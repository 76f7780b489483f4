// flaunay-bench cells: clipped Voronoi cells and relaxation, beside a triangulation and the dual.
#include <cmath>
#include <numeric>

#include "bench/measuring/inputs.hpp"
#include "bench/measuring/timing.hpp"

namespace flaunay::bench::cells {
namespace {

struct CellsRequest : Request {
  int iterations = 4;
};

Result measure_cells(const CellsRequest& request) {
  constexpr double kBox[] = {0, 0, 1, 0, 1, 1, 0, 1};
  constexpr double kAreaTolerance = 1e-9;
  Triangulator triangulator(request.device);
  Result result(triangulator.device());
  for (const std::size_t n : request.sizes) {
    const std::vector<double> coordinates = make_input("uniform", n).coordinates;
    const double* const points = coordinates.data();
    const Triangulation mesh = triangulator.triangulate(points, n);
    const auto clip = [&] { return triangulator.clipped_voronoi(points, n, mesh, kBox, 4); };
    std::vector<Job> jobs;
    const auto add = [&](const char* name, const auto& work, int times = 1) {
      jobs.push_back({{{"points", n}, {"call", name}}, [=] { return seconds_of(work) / times; }});
    };
    add("triangulate", [&] { triangulator.triangulate(points, n); });
    add("voronoi", [&] { triangulator.voronoi(points, n, mesh); });
    add("clipped voronoi", clip);
    const auto iterations = static_cast<std::size_t>(request.iterations);
    add(
        "relax, per iteration", [&] { triangulator.relax(points, n, kBox, 4, iterations); },
        request.iterations);
    measure_rows(jobs, request.runs);
    for (Job& job : jobs) {
      job.row["of_triangulate"] = job.median() / jobs.front().median();
      result.tables["results"].push_back(job.row);
    }
    const std::vector<double> areas = clip().areas;
    result.agree &= std::abs(std::accumulate(areas.begin(), areas.end(), -1.0)) < kAreaTolerance;
  }
  return result;
}

const Subcommand kSubcommand("cells", "Voronoi cells clipped to a box, and Lloyd's relaxation",
                             "Uniform points and the unit square, from host memory to host memory. "
                             "triangulate: the call that the others "
                             "begin with, but for relax, which has it in each iteration. relax: seconds per "
                             "iteration of one call. All "
                             "take turns; the first run of each is not counted. The exit code is 1 if the "
                             "areas of the cells do not add "
                             "up to that of the square.",
                             measure_cells, [](Options& options, CellsRequest& request) {
                               options.sizes({100000, 1000000})
                                   .add("--iterations", request.iterations,
                                        "iterations of each call of relax")
                                   .runs();
                             });

}  // namespace
}  // namespace flaunay::bench::cells
