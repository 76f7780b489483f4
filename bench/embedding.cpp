// flaunay-bench embedding: calls from device memory to device memory, and what is derived of their results.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.hpp"
#include "contest.hpp"
#include "embedding_runs.hpp"
#include "io/generate.hpp"
#include "options.hpp"
#include "plot.hpp"
#include "record.hpp"
#include "target.hpp"

namespace flaunay::bench {
namespace {

struct Request {
  std::vector<std::size_t> sizes{10000, 100000, 1000000};
  std::size_t far_walks = 10000;
  bool quick = false;
  Measurement measurement;
};

const char* help() {
  return "Uniform points whose coordinates are float32 values, so that both precisions are the same "
         "points, and as many uniform queries.\n\n"
         "triangulate:\n"
         "  host: Statistics::seconds of the host's interface, which the command uses: from points in "
         "host memory to results in host memory\n"
         "  host, kernels: the sum of its kernels' times, by Options::profile\n"
         "  device: from the call to the completion of its event, in the caller's context and queue, from "
         "points in a buffer to results in buffers, which are kept from call to call\n"
         "  device, kernels: the sum of its kernels' times, by Enqueue::profile on a profiling queue\n"
         "The host's results always have the hull and the representatives.\n\n"
         "The rest, device: from the call to the completion of its event, queries and results in buffers. "
         "locator: making a Locator, its memory included; interpolate: values of float64; voronoi: "
         "circumcentres and cells.\n"
         "cgal: one thread, from queries in memory to indices in memory, its triangulation made before. "
         "Walks begin at the face where the last one ended, with queries as they come ('last face', of "
         "which --far-walks are measured and the time scaled) or spatially sorted, which is included; "
         "'hierarchy': Triangulation_hierarchy_2, with queries as they come.\n\n"
         "All take turns; the first run of each is not counted; what is over soon is repeated within a "
         "run. The exit code is 1 if numbers of triangles differ, if a query is in another triangle than "
         "CGAL says (unless on an edge), its nearest point is not as near, or a cell has another number of "
         "corners; a missed target does not change it.";
}

std::vector<double> uniform_points(std::size_t n, std::uint64_t seed) {
  return io::generate("uniform", n, seed).coordinates;
}

std::vector<double> rounded_to_float(std::vector<double> values) {
  for (double& value : values) value = static_cast<double>(static_cast<float>(value));
  return values;
}

/// Everything that is measured at one size.
struct Size {
  Size(Caller& caller, std::size_t n, std::size_t far_walks)
      : coordinates(rounded_to_float(uniform_points(n, 1))),
        triangulation(caller, coordinates),
        queries(caller, coordinates, uniform_points(n, 2), far_walks) {}
  std::vector<double> coordinates;
  TriangulationRuns triangulation;
  QueryRuns queries;
};

std::vector<std::unique_ptr<Size>> make_sizes(Caller& caller, const Request& request) {
  std::vector<std::size_t> sizes = request.quick ? std::vector<std::size_t>{500, 3000} : request.sizes;
  std::sort(sizes.begin(), sizes.end());
  std::vector<std::unique_ptr<Size>> all;
  for (const std::size_t n : sizes) all.push_back(std::make_unique<Size>(caller, n, request.far_walks));
  return all;
}

std::string description(const Timed& row) {
  std::string text = row.operation + ", " + row.implementation;
  if (!row.parts.empty()) text += ", " + row.parts;
  return text + ", " + row.precision;
}

std::vector<Timed> measure(const std::vector<std::unique_ptr<Size>>& sizes, int runs) {
  std::vector<Timed> rows;
  for (const auto& size : sizes) {
    append(rows, size->triangulation.rows());
    append(rows, size->queries.rows());
  }
  std::vector<Job> jobs;
  for (const Timed& row : rows) {
    jobs.push_back({fmt::format("{}, {} points", description(row), row.n),
                    [&row] { return mean_of_repeated(row.run); }, description(row)});
  }
  run_interleaved(jobs, runs);
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    // A part of it that fails leaves nothing to compare.
    if (!jobs[j].skipped.empty()) throw Error(ErrorKind::internal, jobs[j].name + ": " + jobs[j].skipped);
    rows[j].seconds = jobs[j].seconds;
  }
  return rows;
}

// ---- Ratios

/// One way of triangulating, beside the host's.
struct Cost {
  std::string parts, precision;
  std::size_t n;
  double device, device_kernels, host, host_kernels;

  double over_host_kernels() const { return device / host_kernels; }
};

double median_of(const std::vector<Timed>& rows, const std::string& implementation, const Timed& like,
                 const std::string& precision) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Timed& candidate) {
    return candidate.operation == like.operation && candidate.implementation == implementation &&
           candidate.parts == like.parts && candidate.precision == precision && candidate.n == like.n;
  });
  return row->median();
}

std::vector<Cost> costs_of(const std::vector<Timed>& rows) {
  std::vector<Cost> costs;
  for (const Timed& row : rows) {
    if (row.operation != "triangulate" || row.implementation != "device") continue;
    costs.push_back({row.parts, row.precision, row.n, row.median(),
                     median_of(rows, "device, kernels", row, row.precision),
                     median_of(rows, "host", row, "float64"),
                     median_of(rows, "host, kernels", row, "float64")});
  }
  return costs;
}

std::vector<Target> targets_of(const std::vector<Cost>& costs) {
  constexpr double kMost = 1.05;
  std::vector<Target> targets;
  for (const Cost& cost : costs) {
    if (cost.n != costs.back().n || cost.precision != "float64") continue;
    targets.push_back({fmt::format("device to device / host's kernels, {}", thousands(cost.n)), cost.parts,
                       kMost, kMost, cost.over_host_kernels()});
  }
  return targets;
}

// ---- What is shown of it

void print_rows(const std::vector<Timed>& rows) {
  fmt::print("{:<12} {:<24} {:<21} {:<9} {:>9} {:>11} {:>11} {:>11} {:>8}\n", "operation", "implementation",
             "parts", "precision", "n", "median s", "min s", "max s", "ns/each");
  for (const Timed& row : rows) {
    const Summary seconds = summary(row.seconds);
    fmt::print("{:<12} {:<24} {:<21} {:<9} {:>9} {:>11.6f} {:>11.6f} {:>11.6f} {:>8.0f}{}\n", row.operation,
               row.implementation, row.parts, row.precision, row.n, seconds.median, seconds.low, seconds.high,
               1e9 * seconds.median / static_cast<double>(row.count),
               row.measured < row.count ? fmt::format("  scaled from {}", row.measured) : "");
  }
}

void print_costs(const std::vector<Cost>& costs) {
  fmt::print("\n{:<21} {:<9} {:>9} {:>11} {:>11} {:>11} {:>13} {:>22}\n", "parts", "precision", "n",
             "device ms", "its kernels", "host ms", "its kernels", "device / host's kernels");
  for (const Cost& cost : costs) {
    fmt::print("{:<21} {:<9} {:>9} {:>11.3f} {:>11.3f} {:>11.3f} {:>13.3f} {:>22.3f}\n", cost.parts,
               cost.precision, cost.n, 1e3 * cost.device, 1e3 * cost.device_kernels, 1e3 * cost.host,
               1e3 * cost.host_kernels, cost.over_host_kernels());
  }
}

void print_calls(const std::vector<Calls>& calls) {
  fmt::print("\n{:<21} {:<9} {:>9} {:<7} {:>10} {:>8} {:>13} {:>15} {:>11}\n", "parts", "precision", "n",
             "call", "host waits", "launches", "bytes to host", "bytes to device", "allocations");
  for (const Calls& both : calls) {
    for (const auto& [name, s] : {std::pair("first", &both.first), std::pair("second", &both.second)}) {
      fmt::print("{:<21} {:<9} {:>9} {:<7} {:>10} {:>8} {:>13} {:>15} {:>11}\n", both.parts, both.precision,
                 both.n, name, s->host_waits, s->kernel_launches, s->bytes_to_host, s->bytes_to_device,
                 s->device_allocations);
    }
  }
}

nlohmann::json record_of(const std::vector<Timed>& rows) {
  nlohmann::json result = nlohmann::json::array();
  for (const Timed& row : rows) {
    result.push_back({{"operation", row.operation},
                      {"implementation", row.implementation},
                      {"precision", row.precision},
                      {"n", row.n},
                      {"count", row.count},
                      {"measured", row.measured}});
    if (!row.parts.empty()) result.back()["parts"] = row.parts;
    add_seconds(result.back(), summary(row.seconds));
  }
  return result;
}

nlohmann::json record_of(const std::vector<Cost>& costs) {
  nlohmann::json result = nlohmann::json::array();
  for (const Cost& cost : costs) {
    result.push_back({{"parts", cost.parts},
                      {"precision", cost.precision},
                      {"n", cost.n},
                      {"device_over_host_kernels", cost.over_host_kernels()},
                      {"device_over_own_kernels", cost.device / cost.device_kernels},
                      {"device_over_host", cost.device / cost.host}});
  }
  return result;
}

nlohmann::json record_of(const Statistics& statistics) {
  return {{"host_waits", statistics.host_waits},
          {"kernel_launches", statistics.kernel_launches},
          {"bytes_to_host", statistics.bytes_to_host},
          {"bytes_to_device", statistics.bytes_to_device},
          {"device_allocations", statistics.device_allocations}};
}

nlohmann::json record_of(const std::vector<Calls>& calls) {
  nlohmann::json result = nlohmann::json::array();
  for (const Calls& both : calls) {
    result.push_back({{"parts", both.parts},
                      {"precision", both.precision},
                      {"n", both.n},
                      {"first", record_of(both.first)},
                      {"second", record_of(both.second)}});
  }
  return result;
}

/// Bars of the largest size, in groups by parts and precision, or by operation.
plot::Bars bars_of(const std::vector<Timed>& rows, bool triangulating) {
  plot::Bars bars;
  bars.values = true;
  // Titles of their own, so that the ranges are too.
  bars.y = {triangulating ? "time of a call" : "time for all points or queries",
            triangulating ? plot::Scale::linear : plot::Scale::log10, plot::Unit::seconds};
  for (const Timed& row : rows) {
    if (row.n != rows.back().n || (row.operation == "triangulate") != triangulating) continue;
    const std::string name = triangulating ? row.parts + ", " + row.precision : row.operation;
    auto group = std::find_if(bars.groups.begin(), bars.groups.end(),
                              [&](const plot::BarGroup& candidate) { return candidate.name == name; });
    if (group == bars.groups.end()) group = bars.groups.insert(group, {name, {}});
    const Summary seconds = summary(row.seconds);
    group->bars.push_back({row.implementation, {seconds.median}, seconds.low, seconds.high});
  }
  return bars;
}

plot::Figure figure_of(const std::vector<Timed>& rows, const Request& request, const DeviceInfo& device) {
  plot::Figure figure;
  figure.title = fmt::format("Embedded: {} points in device memory", rows.back().n);
  figure.subtitle = measured_on(device, request.measurement.runs);
  plot::Bars triangulating = bars_of(rows, true), queries = bars_of(rows, false);
  triangulating.title = "triangulate";
  queries.title = "what is derived";
  figure.panels = {triangulating, queries};
  figure.columns = 1;
  figure.panel_width = 1100;
  return figure;
}

int run(const Request& request, const std::string& command) {
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  Caller caller(measurement.device);
  const auto sizes = make_sizes(caller, request);
  std::vector<Calls> calls;
  for (const auto& size : sizes) append(calls, size->triangulation.first_calls());
  const std::vector<Timed> rows = measure(sizes, measurement.runs);

  bool all_agree = true;
  for (const auto& size : sizes)
    all_agree = size->triangulation.agree() && size->queries.agree() && all_agree;
  const std::vector<Cost> costs = costs_of(rows);
  const std::vector<Target> targets = targets_of(costs);
  print_rows(rows);
  print_costs(costs);
  print_calls(calls);
  print_targets(targets);
  const DeviceInfo device = caller.host().device();
  nlohmann::json file = record(device, command, measurement.runs);
  file["agrees"] = all_agree;
  file["results"] = record_of(rows);
  file["ratios"] = record_of(costs);
  file["calls"] = record_of(calls);
  file["targets"] = record_of(targets);
  write_files(measurement, file, [&] { return figure_of(rows, request, device); });
  return all_agree ? kSuccess : kFailure;
}

}  // namespace

void add_embedding(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command =
      app.add_subcommand("embedding", "from device memory to device memory, and queries, beside CGAL's");
  command->footer(help());
  add_sizes_option(command, request->sizes, "numbers of points, and of queries");
  command->add_option("--far-walks", request->far_walks, "most queries whose walks begin far away")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--quick", request->quick, "a few thousand points: shows that it works, and no more");
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
