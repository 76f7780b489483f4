// flaunay-bench small: calls on few points, and many small sets in one call.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.hpp"
#include "contest.hpp"
#include "inputs.hpp"
#include "options.hpp"
#include "plot.hpp"
#include "record.hpp"

namespace flaunay::bench {
namespace {

struct Request {
  std::vector<std::size_t> sizes{32, 100, 1024, 4096};
  std::size_t batch_points = 1000000;
  std::vector<std::string> distributions{"uniform"};
  std::vector<std::string> modes{default_mode_name()};
  Measurement measurement;
};

const char* help() {
  return "Whole calls with a triangulator that is kept, repeated within a run; then batches: sets of 100 "
         "points, sets of 1,000, and sets of all sizes with empty and degenerate ones among them. flaunay "
         "takes a batch in one call, CGAL in a loop. The same number of points as one set is beside them. "
         "All implementations and inputs take turns, and the first run of each is not counted. The exit code "
         "is 1 if numbers of triangles differ from CGAL's.";
}

/// Small sets, and one set of as many points.
std::vector<Input> make_batches(std::size_t points) {
  std::vector<Input> batches;
  for (const std::size_t size : {100, 1000}) {
    batches.push_back(equal_sets(std::max<std::size_t>(1, points / size), size));
  }
  batches.push_back(heavy_tailed_sets(points));
  batches.push_back(make_input("uniform", points));
  return batches;
}

/// An implementation's time for a batch beside its own for one set and beside CGAL's loop.
struct Comparison {
  std::string implementation;
  const Input* batch;
  std::optional<double> times_one_set, times_cgal;
};

std::vector<Comparison> compare(const std::vector<Entry>& entries, const Input& one_set) {
  std::vector<Comparison> comparisons;
  for (const Entry& entry : entries) {
    if (entry.input == &one_set || !entry.valid()) continue;
    const Input& batch = *entry.input;
    const double seconds = summary(entry.seconds).median;
    const auto times = [&](std::optional<double> other) {
      return other ? seconds / *other : std::optional<double>();
    };
    comparisons.push_back({entry.implementation, &batch,
                           times(median_of(entries, entry.implementation, one_set.distribution, one_set.n)),
                           times(median_of(entries, kCgal, batch.distribution, batch.n))});
  }
  return comparisons;
}

std::string text_of(const std::optional<double>& ratio) {
  return ratio ? fmt::format("{:.2f}", *ratio) : "-";
}

void print_comparisons(const std::vector<Comparison>& comparisons) {
  fmt::print("\n{:<24} {:<24} {:>14} {:>18}\n", "implementation", "batch", "times one set",
             "times CGAL's loop");
  for (const Comparison& c : comparisons) {
    fmt::print("{:<24} {:<24} {:>14} {:>18}\n", c.implementation, c.batch->distribution,
               text_of(c.times_one_set), text_of(c.times_cgal));
  }
}

nlohmann::json record_of(const std::vector<Comparison>& comparisons) {
  nlohmann::json result = nlohmann::json::array();
  for (const Comparison& c : comparisons) {
    result.push_back({{"implementation", c.implementation},
                      {"batch", c.batch->distribution},
                      {"sets", c.batch->offsets.size() - 1},
                      {"n", c.batch->n}});
    if (c.times_one_set) result.back()["times_one_set"] = *c.times_one_set;
    if (c.times_cgal) result.back()["times_cgal"] = *c.times_cgal;
  }
  return result;
}

plot::Figure figure_of(const std::vector<Entry>& calls, const std::vector<Entry>& batch_entries,
                       const std::vector<Input>& batches, const Request& request, const DeviceInfo& device) {
  plot::Figure figure;
  figure.title = "Few points in a call, and many small sets in one";
  figure.subtitle = measured_on(device, request.measurement.runs);
  for (const std::string& distribution : request.distributions) {
    figure.panels.push_back(time_per_point_panel(calls, request.sizes, distribution));
  }
  plot::Bars bars;
  bars.title = fmt::format("{} points in sets, and in one", request.batch_points);
  bars.y = {"time", plot::Scale::linear, plot::Unit::seconds};
  bars.values = true;
  for (const Input& batch : batches) {
    const bool one_set = batch.offsets.size() == 2;
    bars.groups.push_back(time_bars(batch_entries, batch, one_set ? "one set" : batch.distribution));
  }
  figure.panels.push_back(bars);
  return figure;
}

int run(const Request& request, const std::string& command) {
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  const std::vector<Input> batches = make_batches(request.batch_points);
  Triangulator triangulator(measurement.device);
  const std::vector<Implementation> implementations = modes_and_cgal(triangulator, request.modes);
  // Apart, so that batches do not empty the caches between small calls.
  std::vector<Entry> calls = make_entries(implementations, inputs);
  measure(calls, implementations, measurement.runs);
  std::vector<Entry> of_batches = make_entries(implementations, batches);
  measure(of_batches, implementations, measurement.runs);

  const bool calls_agree = check_counts(calls), batches_agree = check_counts(of_batches);
  std::vector<Entry> all = calls;
  append(all, of_batches);
  const std::vector<Comparison> comparisons = compare(of_batches, batches.back());
  print_entries(all);
  print_comparisons(comparisons);
  nlohmann::json file = record(triangulator.device(), command, measurement.runs);
  add_entries(file, all);
  file["batches"] = record_of(comparisons);
  write_files(measurement, file,
              [&] { return figure_of(calls, of_batches, batches, request, triangulator.device()); });
  return calls_agree && batches_agree ? kSuccess : kFailure;
}

}  // namespace

void add_small(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = app.add_subcommand("small", "calls on few points, and many small sets in one call");
  command->footer(help());
  add_sizes_option(command, request->sizes);
  command->add_option("--batch-points", request->batch_points, "points of all sets of a batch together")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
