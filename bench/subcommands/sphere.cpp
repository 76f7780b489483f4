// flaunay-bench sphere: points on a sphere, beside CGAL's triangulation of them, and beside as many in the
// plane.
#include "flaunay/sphere.hpp"

#include <cmath>
#include <deque>
#include <random>

#include "bench/measuring/command.hpp"
#include "bench/measuring/jobs.hpp"
#include "bench/peers/peer.hpp"
#include "flaunay/verify.hpp"

namespace flaunay::bench::sphere {
namespace {

constexpr SphereCoordinates kDirections = SphereCoordinates::directions;

/// Unit vectors without a preferred direction: CGAL takes ten times as long for others.
std::vector<double> random_directions(std::size_t n, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> directions(3 * n);
  for (std::size_t i = 0; i < directions.size(); i += 3) {
    double* const p = &directions[i];
    for (std::size_t k = 0; k < 3; ++k) p[k] = normal(engine);
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (std::size_t k = 0; k < 3; ++k) p[k] /= length;
  }
  return directions;
}

struct Data {
  Data(Triangulator& triangulator, std::size_t number)
      : n(number),
        points(random_directions(n, 1)),
        queries(random_directions(n, 2)),
        values(n, 1.0),
        mesh(triangulator.triangulate(points.data(), n, Space::sphere(kDirections))),
        locator(triangulator, mesh) {}

  std::size_t n;
  std::vector<double> points, queries, values;
  Triangulation mesh;
  Locator locator;
};

void add_jobs(Jobs& jobs, Triangulator& triangulator, Data& on) {
  const auto add = [&](const char* operation, const std::function<Outcome()>& run,
                       const char* implementation = "flaunay") {
    jobs.push_back({{{"operation", operation}, {"implementation", implementation}, {"n", on.n}}, run});
  };
  add("triangulate", [&] {
    const Stopwatch watch;
    const auto mesh = triangulator.triangulate(on.points.data(), on.n, Space::sphere(kDirections));
    return Outcome(watch.seconds(), mesh.triangles.size() / 3);
  });
  if (run_cgal_on_sphere != nullptr)
    add(
        "triangulate", [&] { return run_cgal_on_sphere(on.points); }, "cgal");
  add("triangulate places",
      [&] { return seconds_of([&] { triangulator.triangulate(on.mesh.places.data(), on.n); }); });
  add("cells", [&] { return seconds_of([&] { triangulator.voronoi(on.mesh); }); });
  add("verify", [&] {
    return seconds_of([&] { verify(on.points.data(), {0, on.n}, Space::sphere(kDirections), on.mesh); });
  });
  add("locator", [&] { return seconds_of([&] { Locator(triangulator, on.mesh); }); });
  const double* const queries = on.queries.data();
  add("locate", [&, queries] { return seconds_of([&] { on.locator.locate(queries, on.n); }); });
  add("nearest", [&, queries] { return seconds_of([&] { on.locator.nearest(queries, on.n); }); });
  add("linear",
      [&, queries] { return seconds_of([&] { on.locator.interpolate(on.values.data(), queries, on.n); }); });
}

Result measure_sphere(const Request& request) {
  Triangulator triangulator(request.device);
  Jobs jobs;
  std::deque<Data> inputs;
  for (const std::size_t n : request.sizes)
    add_jobs(jobs, triangulator, inputs.emplace_back(triangulator, n));
  measure(jobs, request.runs);
  Result result(triangulator.device());
  add_rows(result, jobs);
  for (const Job& job : jobs) {
    const Json& row = job.row;
    if (row["operation"] == "triangulate") {
      result.agree &= job.details["triangles"] == 2 * row["n"].get<std::size_t>() - 4;
    }
  }
  return result;
}

const Subcommand kSubcommand(
    "sphere", "triangulations of random directions beside CGAL's, their cells, and queries",
    R"(From host memory to host memory; as many queries as points. 'triangulate places' is the part of a triangulation
in the plane. CGAL's points are projected to the sphere by its traits and spatially sorted in the time that is measured.
The exit code is 1 if a triangulation has not 2 n - 4 triangles. bench/python.py measures beside SciPy.)",
    measure_sphere, [](Options& options, Request&) {
      options.sizes({100000, 1000000}).runs();
    });

}  // namespace
}  // namespace flaunay::bench::sphere
