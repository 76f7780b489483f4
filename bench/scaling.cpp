// flaunay-bench scaling: time per point over many sizes, flaunay's modes beside CGAL.
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

constexpr int kLeastExponent = 1, kMostExponent = 30;

struct Request {
  int least = 10, most = 24, cgal_most = 22;
  std::vector<std::string> distributions{"uniform", "kuzmin", "line"};
  std::vector<std::string> modes{default_mode_name()};
  double limit = 60;
  Measurement measurement;
};

const char* help() {
  return "Times are from points in memory to triangles and neighbours in memory; all implementations and "
         "inputs take turns, the first run of each is not counted, and what is over soon is repeated within "
         "a run. The exit code is 1 if numbers of triangles differ from CGAL's.";
}

/// CGAL is not run beyond its largest size.
void limit_cgal(std::vector<Entry>& entries, int most) {
  for (Entry& entry : entries) {
    if (entry.implementation != kCgal || entry.input->n <= std::size_t{1} << most) continue;
    entry.skipped = fmt::format("more than 2^{} points", most);
  }
}

plot::Figure figure_of(const std::vector<Entry>& entries, const Request& request, const DeviceInfo& device) {
  plot::Figure figure;
  figure.title = "Time per point by number of points";
  figure.subtitle = measured_on(device, request.measurement.runs);
  for (const std::string& distribution : request.distributions) {
    figure.panels.push_back(
        time_per_point_panel(entries, powers_of_two(request.least, request.most), distribution));
  }
  return figure;
}

int run(const Request& request, const std::string& command) {
  if (request.least > request.most) throw Error(ErrorKind::usage, "--least is greater than --most");
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  const std::vector<Input> inputs =
      make_inputs(request.distributions, powers_of_two(request.least, request.most));
  Triangulator triangulator(measurement.device);
  const std::vector<Implementation> implementations = modes_and_cgal(triangulator, request.modes);
  std::vector<Entry> entries = make_entries(implementations, inputs);
  limit_cgal(entries, request.cgal_most);
  measure(entries, implementations, measurement.runs, request.limit);

  const bool all_agree = check_counts(entries);
  print_entries(entries);
  nlohmann::json file = record(triangulator.device(), command, measurement.runs);
  add_entries(file, entries);
  write_files(measurement, file, [&] { return figure_of(entries, request, triangulator.device()); });
  return all_agree ? kSuccess : kFailure;
}

void add_exponent_option(CLI::App* command, const std::string& name, int& exponent,
                         const std::string& description) {
  command->add_option(name, exponent, description)
      ->check(CLI::Range(kLeastExponent, kMostExponent))
      ->capture_default_str();
}

}  // namespace

void add_scaling(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = app.add_subcommand("scaling", "time per point over many sizes, modes beside CGAL");
  command->footer(help());
  add_exponent_option(command, "--least", request->least, "least number of points, as a power of two");
  add_exponent_option(command, "--most", request->most, "greatest number of points, as a power of two");
  add_exponent_option(command, "--cgal-most", request->cgal_most, "the same for CGAL");
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  add_limit_option(command, request->limit, "what takes more seconds is not run at larger sizes");
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
