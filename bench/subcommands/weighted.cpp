// flaunay-bench weighted: regular triangulations and arrays derived from them, compared with CGAL and with
// Delaunay triangulations.
#include "flaunay/weighted.hpp"

#include <cmath>
#include <deque>
#include <map>
#include <random>

#include "bench/measuring/command.hpp"
#include "bench/measuring/jobs.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench::weighted {
namespace {

/// Uniform points, with weights up to `areas` times a point's mean area; 2.3 hides about a third of them.
struct Data {
  Data(Triangulator& triangulator, std::size_t number, double areas)
      : n(number), points(2 * n), weights(n), offsets{0, n} {
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> unit(0, 1);
    for (double& x : points) x = unit(engine);
    for (double& weight : weights) weight = unit(engine) * areas / static_cast<double>(n);
    options.neighbors = true;
    mesh = triangulator.triangulate(points.data(), n, Space::plane().with_weights(weights.data()), options);
  }

  std::size_t n;
  std::vector<double> points, weights;
  std::vector<std::size_t> offsets;
  flaunay::Options options;
  Triangulation mesh;
};

constexpr double kBox[] = {0, 0, 1, 0, 1, 1, 0, 1};

void add_jobs(Jobs& jobs, Triangulator& triangulator, Data& on) {
  const auto add = [&](const char* operation, const std::function<Outcome()>& run,
                       const char* implementation = "flaunay") {
    jobs.push_back({{{"operation", operation},
                     {"implementation", implementation},
                     {"n", on.n},
                     {"hidden", on.mesh.hidden.size()}},
                    run});
  };
  const double *const points = on.points.data(), *const weights = on.weights.data();
  add("triangulate", [&, points, weights] {
    const Stopwatch watch;
    const auto mesh =
        triangulator.triangulate(points, on.n, Space::plane().with_weights(weights), on.options);
    return Outcome(watch.seconds(), mesh.triangles.size() / 3);
  });
  if (run_cgal_weighted != nullptr)
    add(
        "triangulate", [&] { return run_cgal_weighted(on.points, on.weights); }, "cgal");
  add("triangulate without weights",
      [&, points] { return seconds_of([&] { triangulator.triangulate(points, on.n, on.options); }); });
  add("hiding triangles", [&, points] {
    return seconds_of([&] { hiding_triangles(triangulator, points, on.offsets, on.mesh); });
  });
  add("cells", [&, points, weights] {
    return seconds_of([&] { triangulator.clipped_voronoi(points, weights, on.n, on.mesh, kBox, 4); });
  });
}

Result measure_weighted(const Request& request) {
  Triangulator triangulator(request.device);
  Jobs jobs;
  std::deque<Data> inputs;
  for (const std::size_t n : request.sizes) {
    for (const double areas : {0.5, 2.3}) {
      add_jobs(jobs, triangulator, inputs.emplace_back(triangulator, n, areas));
    }
  }
  measure(jobs, request.runs);
  Result result(triangulator.device());
  add_rows(result, jobs);
  std::map<std::pair<std::size_t, std::size_t>, Json> triangles;
  for (const Job& job : jobs) {
    if (job.row["operation"] != "triangulate") continue;
    Json& first = triangles[{job.row["n"], job.row["hidden"]}];
    if (first.is_null()) first = job.details["triangles"];
    result.agree &= first == job.details["triangles"];
  }
  return result;
}

const Subcommand kSubcommand(
    "weighted", "regular triangulations of weighted points beside CGAL's, what hides points, and power cells",
    R"(From host memory to host memory: uniform points with few hidden ones, and with a third of them hidden. CGAL sorts
points spatially in the time that is measured. The exit code is 1 if the numbers of triangles differ.)",
    measure_weighted, [](Options& options, Request&) {
      options.sizes({100000, 1000000}).runs();
    });

}  // namespace
}  // namespace flaunay::bench::weighted
