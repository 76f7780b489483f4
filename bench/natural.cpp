// flaunay-bench natural: natural-neighbour interpolation beside CGAL's.
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <deque>

#include "command.hpp"
#include "inputs.hpp"
#include "peer.hpp"
#include "timing.hpp"

namespace flaunay::bench::natural {
namespace {

// What CGAL's answers, which have no bound of their own, may differ by.
constexpr double kAgreed = 1e-9;

struct Request : Measurement {
  std::vector<std::size_t> sizes{1000000};
  std::vector<std::string> distributions{"uniform", "kuzmin"};
};

/// Points, queries, a smooth function's values, and the last answers.
struct Data {
  Data(const Request& request, const std::string& name, std::size_t n)
      : points(make_input(name, n).coordinates),
        queries(make_input(name, n, 2).coordinates),
        triangulator(request.device),
        mesh(triangulator.triangulate(points.data(), n)),
        locator(triangulator, points.data(), n, mesh),
        cgal(make_cgal_queries(points)) {
    for (std::size_t i = 0; i < n; ++i)
      values.push_back(std::sin(7 * points[2 * i]) * std::cos(5 * points[2 * i + 1]));
  }

  std::vector<double> points, queries, values;
  Triangulator triangulator;
  Triangulation mesh;
  Locator locator;
  std::unique_ptr<CgalQueries> cgal;
  std::vector<double> sibson, of_cgal;
};

/// NaN if they do not agree on what is outside of the hull.
double largest_difference(const Data& data) {
  double most = 0;
  for (std::size_t i = 0; i < data.sibson.size(); ++i) {
    const double a = data.sibson[i], b = data.of_cgal[i];
    if (std::isnan(a) != std::isnan(b)) return std::nan("");
    if (!std::isnan(a)) most = std::fmax(most, std::fabs(a - b));
  }
  return most;
}

Result measure_natural(const Request& request) {
  Result result;
  std::vector<Job> jobs;
  std::deque<Data> data;
  std::deque<std::vector<double>> processor;
  std::vector<Json> rows;
  const auto add = [&](const char* operation, const char* implementation, const std::string& distribution,
                       std::size_t n, const std::function<double()>& work) {
    std::vector<double>& seconds = processor.emplace_back();
    jobs.push_back(
        {fmt::format("{} of {}, {} {} points", operation, implementation, thousands(n), distribution),
         [&seconds, work] {
           const std::clock_t begin = std::clock();
           const double wall = work();
           seconds.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
           return wall;
         }});
    rows.push_back({{"operation", operation},
                    {"implementation", implementation},
                    {"distribution", distribution},
                    {"n", n},
                    {"queries", n}});
  };
  for (const std::string& distribution : request.distributions) {
    for (const std::size_t n : request.sizes) {
      Data& on = data.emplace_back(request, distribution, n);
      const auto interpolate = [&on, n](Interpolation method) {
        InterpolationOptions options;
        options.method = method;
        const Stopwatch watch;
        auto answers = on.locator.interpolate(on.values.data(), on.queries.data(), n, options);
        const double seconds = watch.seconds();
        if (method == Interpolation::sibson) on.sibson = std::move(answers);
        return seconds;
      };
      add("linear", "flaunay", distribution, n, [=] { return interpolate(Interpolation::linear); });
      add("sibson", "flaunay", distribution, n, [=] { return interpolate(Interpolation::sibson); });
      add("laplace", "flaunay", distribution, n, [=] { return interpolate(Interpolation::laplace); });
      if (!on.cgal) continue;
      add("sibson", "cgal-sorted", distribution, n,
          [&on] { return on.cgal->natural(Start::last_face_sorted, on.queries, on.values, on.of_cgal); });
      add("sibson", "cgal-hierarchy", distribution, n,
          [&on] { return on.cgal->natural(Start::hierarchy, on.queries, on.values, on.of_cgal); });
    }
  }
  run_interleaved(jobs, request.runs);
  result.tables["results"] = Json::array();
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    add_seconds(rows[k], jobs[k].seconds);
    rows[k]["processor_seconds_median"] = summary(processor[k]).median;
    result.tables["results"].push_back(rows[k]);
  }
  result.tables["answers"] = Json::array();
  std::size_t k = 0;
  for (const std::string& distribution : request.distributions) {
    for (const std::size_t n : request.sizes) {
      const Data& on = data[k++];
      if (!on.cgal) continue;
      const double difference = largest_difference(on);
      result.agree &= difference < kAgreed;
      result.tables["answers"].push_back(
          {{"distribution", distribution}, {"n", n}, {"largest_difference", difference}});
    }
  }
  result.device = data.front().triangulator.device();
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = add_command(
      app, action, "natural", "natural-neighbour interpolation beside CGAL's",
      "As many queries as points, from the same distribution, in host memory; the values are a smooth "
      "function. "
      "CGAL's natural_neighbor_coordinates_2 runs on one thread, with exact predicates: once with queries "
      "that are "
      "spatially sorted before, each beginning where the last one ended, and once with a hierarchy. "
      "Processor times are those of all threads of the process; on a GPU, only of the host's. All take "
      "turns. The "
      "exit code is 1 if values differ from CGAL's by more than 1e-9.",
      request, measure_natural);
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::natural
