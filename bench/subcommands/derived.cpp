// flaunay-bench derived: computing from a triangulation, compared with triangulating: Voronoi cells,
// relaxation, rasters, contours, and interpolation, with natural neighbours compared with CGAL.
#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <numeric>

#include "bench/measuring/command.hpp"
#include "bench/measuring/jobs.hpp"
#include "bench/peers/peer.hpp"
#include "flaunay/terrain.hpp"

namespace flaunay::bench::derived {
namespace {

struct DerivedRequest : Request {
  std::vector<std::size_t> columns{1, 7};
  std::size_t iterations = 4;
  bool with_cgal = false;
};

constexpr double kUnitSquare[] = {0, 0, 1, 0, 1, 1, 0, 1};

/// Points, as many queries, a mesh of the points, rows of values of smooth functions, and the last answers.
struct Data {
  Data(const std::string& device, const Input& input, std::size_t number_of_columns)
      : distribution(input.distribution),
        n(input.n),
        columns(number_of_columns),
        points(input.coordinates),
        queries(make_input(distribution, n, 2).coordinates),
        triangulator(device),
        mesh(triangulator.triangulate(points.data(), n)),
        locator(triangulator, points.data(), n, mesh) {
    for (std::size_t i = 0; i < n * columns; ++i) {
      const double* const p = &points[2 * (i / columns)];
      values.push_back(std::sin(7 * p[0] + static_cast<double>(i % columns)) * std::cos(5 * p[1]));
    }
    gradients = locator.gradients(values.data(), columns);
  }

  std::string distribution;
  std::size_t n, columns;
  std::vector<double> points, queries, values, gradients;
  Triangulator triangulator;
  Triangulation mesh;
  Locator locator;
  std::vector<double> sibson, of_cgal, areas, pixels;
};

MeshView view(const Data& on) {
  return {on.points.data(), on.n, on.mesh.triangles.data(), on.mesh.neighbors.data(),
          on.mesh.triangles.size() / 3};
}

/// NaN if one is NaN where the other is not.
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) != std::isnan(b[i])) return std::nan("");
    most = std::fmax(most, std::fabs(a[i] - b[i]));
  }
  return most;
}

void add_jobs(Jobs& jobs, Data& on, const DerivedRequest& request) {
  Triangulator& triangulator = on.triangulator;
  const double* const points = on.points.data();
  const auto add = [&](const std::string& operation, const std::function<Outcome()>& run,
                       const char* implementation = "flaunay") {
    Json row{{"operation", operation}, {"implementation", implementation}, {"distribution", on.distribution}};
    row.update({{"n", on.n}, {"queries", on.n}, {"columns", on.columns}});
    jobs.push_back({row, run});
  };
  const auto add_method = [&](const char* name, Interpolation method, std::vector<double>* answers = nullptr,
                              bool with_gradients = false) {
    add(name, [&on, method, answers, with_gradients] {
      InterpolationOptions options;
      options.method = method;
      options.columns = on.columns;
      if (with_gradients) options.gradients = on.gradients.data();
      const Stopwatch watch;
      std::vector<double> all = on.locator.interpolate(on.values.data(), on.queries.data(), on.n, options);
      const double seconds = watch.seconds();
      if (answers != nullptr) *answers = std::move(all);
      return seconds;
    });
  };
  const auto add_call = [&](const std::string& name, const auto& work) {
    add(name, [work] { return seconds_of(work); });
  };
  const std::size_t n = on.n, iterations = request.iterations;
  add_call("triangulate", [&triangulator, points, n] { triangulator.triangulate(points, n); });
  if (on.columns == request.columns.front()) {
    add_call("voronoi", [&on, points, n] { on.triangulator.voronoi(points, n, on.mesh); });
    add_call("clipped voronoi", [&on, points, n] {
      on.areas = on.triangulator.clipped_voronoi(points, n, on.mesh, kUnitSquare, 4).areas;
    });
    const auto relax = [&triangulator, points, n, iterations] {
      triangulator.relax(points, n, kUnitSquare, 4, iterations);
    };
    add_call(fmt::format("relax, {} iterations", iterations), relax);
    add_call("raster, 1.6 pixels per point", [&on, n] {
      const auto side = static_cast<std::size_t>(std::sqrt(1.6 * static_cast<double>(n)));
      const double step = 1 / static_cast<double>(side);
      on.pixels.resize(side * side);
      rasterize(on.triangulator, view(on), on.values.data(),
                {step / 2, 1 - step / 2, step, -step, side, side}, {}, on.pixels.data());
    });
    add_call("contours at 20 heights", [&on] {
      std::vector<double> heights;
      for (int k = 0; k < 20; ++k) heights.push_back(-0.95 + 0.1 * k);
      trace_contours(on.triangulator, view(on), on.values.data(), heights);
    });
    add_call("locator", [&on, points, n] { Locator(on.triangulator, points, n, on.mesh); });
  }
  add_call("gradients", [&on] { on.locator.gradients(on.values.data(), on.columns); });
  add_method("linear", Interpolation::linear);
  add_method("nearest", Interpolation::nearest);
  add_method("clough-tocher, gradients given", Interpolation::clough_tocher, nullptr, true);
  add_method("clough-tocher", Interpolation::clough_tocher);
  add_method("laplace", Interpolation::laplace);
  add_method("sibson", Interpolation::sibson, &on.sibson);
  if (make_cgal_queries == nullptr || !request.with_cgal || on.columns != 1) return;
  for (const auto& [name, start] :
       {std::pair{"cgal-sorted", Start::last_face_sorted}, {"cgal-hierarchy", Start::hierarchy}}) {
    const std::shared_ptr<CgalQueries> cgal = make_cgal_queries(on.points, start);
    add(
        "sibson", [&on, cgal] { return cgal->natural(on.queries, on.values, on.of_cgal); }, name);
  }
}

Result measure_derived(const DerivedRequest& request) {
  constexpr double kAreaTolerance = 1e-9;
  constexpr double kAgreedOfCgal = 1e-9;  // whose answers have no bound of their own
  Jobs jobs;
  std::deque<Data> inputs;
  for (const Input& input : make_inputs(request.distributions, request.sizes)) {
    for (const std::size_t columns : request.columns) {
      add_jobs(jobs, inputs.emplace_back(request.device, input, columns), request);
    }
  }
  measure(jobs, request.runs);
  for (Job& job : jobs) {
    const auto plain =
        median_of(jobs, changed(job.row, {{"operation", "triangulate"}, {"implementation", "flaunay"}}));
    job.details["of_triangulate"] = job.median() / *plain;
  }
  Result result(inputs.front().triangulator.device());
  add_rows(result, jobs);
  for (const Data& on : inputs) {
    const double beyond = std::accumulate(on.areas.begin(), on.areas.end(), -1.0);
    if (!on.areas.empty() && on.distribution == "uniform") result.agree &= std::abs(beyond) < kAreaTolerance;
    if (on.of_cgal.empty()) continue;
    const double difference = largest_difference(on.sibson, on.of_cgal);
    result.agree &= difference < kAgreedOfCgal;
    result.tables["answers"].push_back(
        {{"distribution", on.distribution}, {"n", on.n}, {"largest_difference", difference}});
  }
  return result;
}

const Subcommand kSubcommand(
    "derived",
    "Voronoi cells, relaxation, rasters and interpolation beside a triangulation, and CGAL's natural "
    "neighbours",
    R"(From host memory to host memory. Cells are clipped to the unit square, which relaxation has for its box, too.
Queries are as many as points, from the same distribution, and values are smooth functions. 'clough-tocher' estimates
its gradients in each call, as 'gradients' does. CGAL's natural_neighbor_coordinates_2 runs on one thread, with exact
predicates: once with queries that are spatially sorted before, each beginning where the last one ended, and once with
a hierarchy. The exit code is 1 if the areas of uniform points' cells do not add up to that of the square, or if
Sibson's values differ from CGAL's by more than 1e-9. bench/python.py measures beside SciPy.)",
    measure_derived, [](Options& options, DerivedRequest& request) {
      options.sizes({100000, 1000000})
          .distributions({"uniform"})
          .add("--columns", request.columns, "numbers of values per point")
          .add("--iterations", request.iterations, "iterations of each call of relax")
          .flag("--cgal", request.with_cgal,
                "CGAL beside Sibson's with one value per point, which takes long")
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::derived
