// flaunay-bench periodic: points on a torus, beside CGAL's triangulation of them, and beside as many in the
// plane.
#include <cmath>
#include <deque>
#include <random>

#include "bench/measuring/command.hpp"
#include "bench/measuring/jobs.hpp"
#include "bench/peers/peer.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/verify.hpp"

namespace flaunay::bench::periodic {
namespace {

std::vector<double> random_places(std::size_t n, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> places(2 * n);
  for (double& x : places) x = uniform(engine);
  return places;
}

struct Data {
  Data(Triangulator& triangulator, std::size_t number)
      : n(number),
        points(random_places(n, 1)),
        queries(random_places(n, 2)),
        values(n, 1.0),
        mesh(triangulator.triangulate(points.data(), n, Space::torus({}))),
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
    const auto mesh = triangulator.triangulate(on.points.data(), on.n, Space::torus({}));
    return Outcome(watch.seconds(), mesh.triangles.size() / 3);
  });
  if (run_cgal_periodic != nullptr)
    add(
        "triangulate", [&] { return run_cgal_periodic(on.points); }, "cgal");
  add("triangulate in the plane",
      [&] { return seconds_of([&] { triangulator.triangulate(on.points.data(), on.n); }); });
  add("cylinder", [&] {
    return seconds_of([&] { triangulator.triangulate(on.points.data(), on.n, Space::torus({1, HUGE_VAL})); });
  });
  add("verify", [&] {
    return seconds_of([&] { verify(on.mesh.places.data(), on.mesh.point_offsets, on.mesh.space, on.mesh); });
  });
  add("locator", [&] { return seconds_of([&] { Locator(triangulator, on.mesh); }); });
  const double* const queries = on.queries.data();
  add("locate", [&, queries] { return seconds_of([&] { on.locator.locate(queries, on.n); }); });
  add("nearest", [&, queries] { return seconds_of([&] { on.locator.nearest(queries, on.n); }); });
  add("linear",
      [&, queries] { return seconds_of([&] { on.locator.interpolate(on.values.data(), queries, on.n); }); });
}

Result measure_periodic(const Request& request) {
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
    if (row["operation"] == "triangulate")
      result.agree &= job.details["triangles"] == 2 * row["n"].get<std::size_t>();
  }
  return result;
}

const Subcommand kSubcommand(
    "periodic", "triangulations of uniform points on a torus beside CGAL's, and queries",
    R"(From host memory to host memory; as many queries as points. CGAL's points are sorted in the time that is measured.
The exit code is 1 if a triangulation has not 2 n triangles.)",
    measure_periodic, [](Options& options, Request&) {
      options.sizes({100000, 1000000}).runs();
    });

}  // namespace
}  // namespace flaunay::bench::periodic
