// flaunay-bench interpolation: the methods of interpolation beside each other, and what they are made of.
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <deque>

#include "command.hpp"
#include "inputs.hpp"
#include "timing.hpp"

namespace flaunay::bench::interpolation {
namespace {

struct Request : Measurement {
  std::vector<std::size_t> sizes{100000, 1000000};
  std::vector<std::size_t> columns{1, 7};
};

struct NamedMethod {
  const char* name;
  Interpolation method;
  bool are_given;
};
constexpr NamedMethod kMethods[] = {{"linear", Interpolation::linear, false},
                                    {"nearest", Interpolation::nearest, false},
                                    {"clough-tocher, gradients given", Interpolation::clough_tocher, true},
                                    {"clough-tocher", Interpolation::clough_tocher, false}};

/// Points, queries, and rows of values.
struct Data {
  explicit Data(const Request& request, std::size_t n)
      : points(make_input("uniform", n).coordinates),
        queries(make_input("uniform", n, 2).coordinates),
        triangulator(request.device),
        mesh(triangulator.triangulate(points.data(), n)),
        locator(triangulator, points.data(), n, mesh) {}

  std::size_t size() const { return points.size() / 2; }
  std::vector<double> rows(std::size_t columns) const {
    std::vector<double> all;
    for (std::size_t i = 0; i < size() * columns; ++i) {
      const double* const p = &points[2 * (i / columns)];
      all.push_back(std::sin(7 * p[0] + static_cast<double>(i % columns)) * std::cos(5 * p[1]));
    }
    return all;
  }

  std::vector<double> points, queries;
  Triangulator triangulator;
  Triangulation mesh;
  Locator locator;
};

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::fmax(most, std::fabs(a[i] - b[i]));
  return most;
}

Result measure_interpolation(const Request& request) {
  Result result;
  std::vector<Job> jobs;
  std::deque<Data> data;
  std::deque<std::vector<double>> kept, processor;
  std::vector<Json> rows;
  const auto add = [&](const std::string& operation, std::size_t n, std::size_t columns,
                       const std::function<void()>& work) {
    std::vector<double>& seconds = processor.emplace_back();
    jobs.push_back(
        {fmt::format("{}, {} points, {} columns", operation, thousands(n), columns), [&seconds, work] {
           const std::clock_t begin = std::clock();
           const Stopwatch watch;
           work();
           seconds.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
           return watch.seconds();
         }});
    rows.push_back({{"operation", operation}, {"n", n}, {"queries", n}, {"columns", columns}});
  };
  for (const std::size_t n : request.sizes) {
    Data& on = data.emplace_back(request, n);
    add("triangulate", n, 0, [&on] { on.triangulator.triangulate(on.points.data(), on.size()); });
    add("locator", n, 0, [&on] { Locator(on.triangulator, on.points.data(), on.size(), on.mesh); });
    for (const std::size_t columns : request.columns) {
      const std::vector<double>& values = kept.emplace_back(on.rows(columns));
      const std::vector<double>& gradients = kept.emplace_back(on.locator.gradients(values.data(), columns));
      add("gradients", n, columns, [&on, &values, columns] { on.locator.gradients(values.data(), columns); });
      for (const NamedMethod& named : kMethods) {
        InterpolationOptions options;
        options.method = named.method;
        options.columns = columns;
        if (named.are_given) options.gradients = gradients.data();
        add(named.name, n, columns, [&on, &values, options] {
          on.locator.interpolate(values.data(), on.queries.data(), on.size(), options);
        });
      }
      // Smooth values: methods are near each other where points are close.
      InterpolationOptions options;
      options.columns = columns;
      const auto linear = on.locator.interpolate(values.data(), on.queries.data(), on.size(), options);
      options.method = Interpolation::clough_tocher;
      const auto smooth = on.locator.interpolate(values.data(), on.queries.data(), on.size(), options);
      result.agree &= largest_difference(linear, smooth) < 0.01;
    }
  }
  run_interleaved(jobs, request.runs);
  result.tables["results"] = Json::array();
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    add_seconds(rows[k], jobs[k].seconds);
    rows[k]["processor_seconds_median"] = summary(processor[k]).median;
    result.tables["results"].push_back(rows[k]);
  }
  result.device = data.front().triangulator.device();
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = add_command(
      app, action, "interpolation", "the methods of interpolation beside each other",
      "Uniform points and as many other uniform queries, in host memory. The values are a smooth function. "
      "'clough-tocher' estimates its gradients in each call, as 'gradients' does. Processor times are those "
      "of "
      "all threads of the process; on a GPU, only of the host's. All take turns. The exit code is 1 if "
      "smooth "
      "and linear values differ by more than 0.01 anywhere. bench/interpolation.py measures beside SciPy.",
      request, measure_interpolation);
  add_sizes_option(command, request->sizes);
  add_option(command, "--columns", request->columns, "numbers of values per point");
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::interpolation
