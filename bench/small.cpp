// flaunay-bench small: calls on few points.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

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
  std::vector<std::string> distributions{"uniform"};
  std::vector<std::string> modes{default_mode_name()};
  Measurement measurement;
};

const char* help() {
  return "Whole calls with a triangulator that is kept, repeated within a run. All implementations and "
         "inputs take turns, and the first run of each is not counted. The exit code is 1 if numbers of "
         "triangles differ from CGAL's.";
}

plot::Figure figure_of(const std::vector<Entry>& entries, const Request& request, const DeviceInfo& device) {
  plot::Figure figure;
  figure.title = "Few points in a call";
  figure.subtitle = measured_on(device, request.measurement.runs);
  for (const std::string& distribution : request.distributions) {
    figure.panels.push_back(time_per_point_panel(entries, request.sizes, distribution));
  }
  return figure;
}

int run(const Request& request, const std::string& command) {
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  Triangulator triangulator(measurement.device);
  const std::vector<Implementation> implementations = modes_and_cgal(triangulator, request.modes);
  std::vector<Entry> entries = make_entries(implementations, inputs);
  measure(entries, implementations, measurement.runs);

  const bool all_agree = check_counts(entries);
  print_entries(entries);
  nlohmann::json file = record(triangulator.device(), command, measurement.runs);
  add_entries(file, entries);
  write_files(measurement, file, [&] { return figure_of(entries, request, triangulator.device()); });
  return all_agree ? kSuccess : kFailure;
}

}  // namespace

void add_small(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = app.add_subcommand("small", "calls on few points");
  command->footer(help());
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
