// flaunay-bench interpolation and natural: the methods of interpolation beside each other and what they are
// made of, and natural neighbours beside CGAL's.
#include <algorithm>
#include <cmath>
#include <deque>

#include "bench/measuring/inputs.hpp"
#include "bench/measuring/timing.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench::interpolation {
namespace {

/// Points, as many queries, and a mesh of the points.
struct Data {
  Data(const Request& request, const std::string& distribution, std::size_t number)
      : n(number),
        points(make_input(distribution, n).coordinates),
        queries(make_input(distribution, n, 2).coordinates),
        triangulator(request.device),
        mesh(triangulator.triangulate(points.data(), n)),
        locator(triangulator, points.data(), n, mesh) {}

  /// Rows of values of smooth functions.
  std::vector<double> rows(std::size_t columns) const {
    std::vector<double> all;
    for (std::size_t i = 0; i < n * columns; ++i) {
      const double* const p = &points[2 * (i / columns)];
      all.push_back(std::sin(7 * p[0] + static_cast<double>(i % columns)) * std::cos(5 * p[1]));
    }
    return all;
  }
  std::vector<double> interpolate(const std::vector<double>& values, Interpolation method,
                                  std::size_t columns = 1, const double* gradients = nullptr) {
    InterpolationOptions options;
    options.method = method;
    options.columns = columns;
    options.gradients = gradients;
    return locator.interpolate(values.data(), queries.data(), n, options);
  }

  std::size_t n;
  std::vector<double> points, queries;
  Triangulator triangulator;
  Triangulation mesh;
  Locator locator;
};

/// NaN if one is NaN where the other is not.
double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) != std::isnan(b[i])) return std::nan("");
    most = std::fmax(most, std::fabs(a[i] - b[i]));
  }
  return most;
}

// ---- interpolation

struct MethodsRequest : Request {
  std::vector<std::size_t> columns{1, 7};
};

Result measure_methods(const MethodsRequest& request) {
  constexpr double kAgreed = 0.01;  // of smooth values, where points are close
  Result result;
  std::vector<Job> jobs;
  std::deque<Data> data;
  std::deque<std::vector<double>> kept;
  for (const std::size_t n : request.sizes) {
    Data& on = data.emplace_back(request, "uniform", n);
    const auto add = [&](const char* operation, std::size_t columns, const auto& work) {
      jobs.push_back({{{"operation", operation}, {"n", n}, {"queries", n}, {"columns", columns}},
                      [work] { return seconds_of(work); }});
    };
    add("triangulate", 0, [&on, n] { on.triangulator.triangulate(on.points.data(), n); });
    add("locator", 0, [&on, n] { Locator(on.triangulator, on.points.data(), n, on.mesh); });
    for (const std::size_t columns : request.columns) {
      const std::vector<double>& values = kept.emplace_back(on.rows(columns));
      const std::vector<double>& gradients = kept.emplace_back(on.locator.gradients(values.data(), columns));
      add("gradients", columns, [&on, &values, columns] { on.locator.gradients(values.data(), columns); });
      const auto add_method = [&](const char* name, Interpolation method, const double* of_values = nullptr) {
        add(name, columns, [&on, &values, method, columns, of_values] {
          on.interpolate(values, method, columns, of_values);
        });
      };
      add_method("linear", Interpolation::linear);
      add_method("nearest", Interpolation::nearest);
      add_method("clough-tocher, gradients given", Interpolation::clough_tocher, gradients.data());
      add_method("clough-tocher", Interpolation::clough_tocher);
      result.agree &=
          largest_difference(on.interpolate(values, Interpolation::linear, columns),
                             on.interpolate(values, Interpolation::clough_tocher, columns)) < kAgreed;
    }
  }
  measure_rows(jobs, request.runs, true);
  result.tables["results"] = rows_of(jobs);
  result.device = data.front().triangulator.device();
  return result;
}

const Subcommand kMethods(
    "interpolation", "the methods of interpolation beside each other",
    "Uniform points and as many other uniform queries, in host memory. The values are a smooth function. "
    "'clough-tocher' estimates its gradients in each call, as 'gradients' does. Processor times are those of "
    "all "
    "threads of the process; on a GPU, only of the host's. All take turns. The exit code is 1 if smooth and "
    "linear values differ by more than 0.01 anywhere. bench/interpolation.py measures beside SciPy.",
    measure_methods, [](Options& options, MethodsRequest& request) {
      options.sizes({100000, 1000000})
          .add("--columns", request.columns, "numbers of values per point")
          .runs();
    });

// ---- natural

/// What is asked of one input, and the last answers.
struct Natural : Data {
  Natural(const Request& request, const std::string& name, std::size_t number)
      : Data(request, name, number),
        distribution(name),
        values(rows(1)),
        cgal(make_cgal_queries == nullptr ? nullptr : make_cgal_queries(points)) {}

  std::string distribution;
  std::vector<double> values;
  std::unique_ptr<CgalQueries> cgal;
  std::vector<double> sibson, of_cgal;
};

void add_jobs(std::vector<Job>& jobs, Natural& on) {
  const auto add = [&](const char* operation, const char* implementation, const auto& run) {
    jobs.push_back({{{"operation", operation},
                     {"implementation", implementation},
                     {"distribution", on.distribution},
                     {"n", on.n},
                     {"queries", on.n}},
                    run});
  };
  const auto by = [&on](Interpolation method) {
    return [&on, method] {
      std::vector<double> answers;
      const double seconds = seconds_of([&] { answers = on.interpolate(on.values, method); });
      if (method == Interpolation::sibson) on.sibson = std::move(answers);
      return seconds;
    };
  };
  add("linear", "flaunay", by(Interpolation::linear));
  add("sibson", "flaunay", by(Interpolation::sibson));
  add("laplace", "flaunay", by(Interpolation::laplace));
  if (!on.cgal) return;
  const auto by_cgal = [&on](Start start) {
    return [&on, start] { return on.cgal->natural(start, on.queries, on.values, on.of_cgal); };
  };
  add("sibson", "cgal-sorted", by_cgal(Start::last_face_sorted));
  add("sibson", "cgal-hierarchy", by_cgal(Start::hierarchy));
}

Result measure_natural(const Request& request) {
  constexpr double kAgreed = 1e-9;  // CGAL's answers have no bound of their own
  std::vector<Job> jobs;
  std::deque<Natural> inputs;
  for (const std::string& distribution : request.distributions) {
    for (const std::size_t n : request.sizes) add_jobs(jobs, inputs.emplace_back(request, distribution, n));
  }
  measure_rows(jobs, request.runs, true);
  Result result(inputs.front().triangulator.device(), {"results", "answers"});
  result.tables["results"] = rows_of(jobs);
  for (const Natural& on : inputs) {
    if (!on.cgal) continue;
    const double difference = largest_difference(on.sibson, on.of_cgal);
    result.agree &= difference < kAgreed;
    result.tables["answers"].push_back(
        {{"distribution", on.distribution}, {"n", on.n}, {"largest_difference", difference}});
  }
  return result;
}

const Subcommand kNatural("natural", "natural-neighbour interpolation beside CGAL's",
                          "As many queries as points, from the same distribution, in host memory; the values "
                          "are a smooth function. "
                          "CGAL's natural_neighbor_coordinates_2 runs on one thread, with exact predicates: "
                          "once with queries that are "
                          "spatially sorted before, each beginning where the last one ended, and once with a "
                          "hierarchy. Processor times "
                          "are those of all threads of the process; on a GPU, only of the host's. All take "
                          "turns. The exit code is 1 if "
                          "values differ from CGAL's by more than 1e-9.",
                          measure_natural, [](Options& options, Request&) {
                            options.sizes({1000000}).distributions({"uniform", "kuzmin"}).runs();
                          });

}  // namespace
}  // namespace flaunay::bench::interpolation
