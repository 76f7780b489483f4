// flaunay-bench cliffs: inputs on which one triangulator or another is 10 to 100 times slower.
#include <fmt/format.h>

#include <algorithm>
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

constexpr double kMostTimesUniform = 2;
constexpr const char* kUniform = "uniform";

struct Request {
  std::vector<std::size_t> sizes{100000, 1000000};
  std::vector<std::string> distributions{
      "horizontal",   "collinear",    "thirty-lines",   "power-of-two-span", "one-ulp",
      "circle",       "grid",         "columns",        "parabola",          "integer-circle",
      "mostly-equal", "two-clusters", "half-duplicates"};
  std::vector<std::string> modes{default_mode_name()};
  double limit = 10;
  Measurement measurement;
};

std::string help() {
  return fmt::format(
      "Each time is set beside the same implementation's on as many uniform points; more than {:g} times "
      "that "
      "is a cliff. All implementations and inputs take turns, and the first run of each is not counted. CGAL "
      "is tried in a process of its own, which is ended after --limit seconds. The "
      "exit code is 1 if numbers of triangles differ from CGAL's.",
      kMostTimesUniform);
}

/// An implementation on an input beside itself on uniform points.
struct Cliff {
  const Entry* entry;
  double times_uniform;

  bool within() const { return times_uniform <= kMostTimesUniform; }
};

std::vector<Cliff> find_cliffs(const std::vector<Entry>& entries) {
  std::vector<Cliff> cliffs;
  for (const Entry& entry : entries) {
    const auto uniform = median_of(entries, entry.implementation, kUniform, entry.input->n);
    if (entry.input->distribution == kUniform || !entry.valid() || !uniform) continue;
    cliffs.push_back({&entry, summary(entry.seconds).median / *uniform});
  }
  return cliffs;
}

/// The steepest of each implementation.
std::vector<Cliff> worst_of(const std::vector<Cliff>& cliffs) {
  std::vector<Cliff> worst;
  for (const Cliff& cliff : cliffs) {
    const auto found = std::find_if(worst.begin(), worst.end(), [&](const Cliff& candidate) {
      return candidate.entry->implementation == cliff.entry->implementation;
    });
    if (found == worst.end()) {
      worst.push_back(cliff);
    } else if (found->times_uniform < cliff.times_uniform) {
      *found = cliff;
    }
  }
  return worst;
}

void print_cliffs(const std::vector<Cliff>& cliffs) {
  fmt::print("\n{:<24} {:<18} {:>9} {:>14}\n", "implementation", "distribution", "n", "times uniform");
  for (const Cliff& cliff : cliffs) {
    fmt::print("{:<24} {:<18} {:>9} {:>14.2f}{}\n", cliff.entry->implementation,
               cliff.entry->input->distribution, cliff.entry->input->n, cliff.times_uniform,
               cliff.within() ? "" : "  CLIFF");
  }
  for (const Cliff& cliff : worst_of(cliffs)) {
    fmt::print("{}: at worst {:.2f} times its uniform time, on {}; limit {:g}: {}\n",
               cliff.entry->implementation, cliff.times_uniform, input_name(*cliff.entry->input),
               kMostTimesUniform, cliff.within() ? "kept" : "broken");
  }
}

nlohmann::json record_of(const std::vector<Cliff>& cliffs) {
  nlohmann::json result = nlohmann::json::array();
  for (const Cliff& cliff : cliffs) {
    result.push_back({{"implementation", cliff.entry->implementation},
                      {"distribution", cliff.entry->input->distribution},
                      {"n", cliff.entry->input->n},
                      {"times_uniform", cliff.times_uniform},
                      {"limit", kMostTimesUniform},
                      {"within", cliff.within()}});
  }
  return result;
}

plot::Bars panel_of(const std::vector<Cliff>& cliffs, std::size_t n) {
  plot::Bars panel;
  panel.title = fmt::format("{} points", n);
  panel.y = {"times its own uniform time", plot::Scale::log10};
  panel.values = true;
  for (const Cliff& cliff : cliffs) {
    const Input& input = *cliff.entry->input;
    if (input.n != n) continue;
    if (panel.groups.empty() || panel.groups.back().name != input.distribution) {
      panel.groups.push_back({input.distribution, {}});
    }
    panel.groups.back().bars.push_back({cliff.entry->implementation, {cliff.times_uniform}});
  }
  return panel;
}

plot::Figure figure_of(const std::vector<Cliff>& cliffs, const Request& request, const DeviceInfo& device) {
  plot::Figure figure;
  figure.title = "Inputs on which triangulators are slow";
  figure.subtitle = measured_on(device, request.measurement.runs);
  figure.columns = 1;
  figure.panel_width = 1000;
  for (const std::size_t n : request.sizes) figure.panels.push_back(panel_of(cliffs, n));
  return figure;
}

int run(const Request& request, const std::string& command) {
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  std::vector<std::string> distributions{kUniform};
  distributions.insert(distributions.end(), request.distributions.begin(), request.distributions.end());
  const std::vector<Input> inputs = make_inputs(distributions, request.sizes);
  const std::vector<Peer> peers = chosen_peers({kCgal});
  // Before there is a device: see ask_child.
  const std::vector<Entry> of_peers = try_peers(peers, inputs, request.limit);
  Triangulator triangulator(measurement.device);
  std::vector<Implementation> implementations = mode_implementations(triangulator, request.modes);
  std::vector<Entry> entries = by_input(make_entries(implementations, inputs), of_peers);
  append(implementations, implementations_of(peers));
  measure(entries, implementations, measurement.runs, request.limit);

  const bool all_agree = check_counts(entries);
  const std::vector<Cliff> cliffs = find_cliffs(entries);
  print_entries(entries);
  print_cliffs(cliffs);
  nlohmann::json file = record(triangulator.device(), command, measurement.runs);
  add_entries(file, entries);
  file["cliffs"] = record_of(cliffs);
  file["worst"] = record_of(worst_of(cliffs));
  write_files(measurement, file, [&] { return figure_of(cliffs, request, triangulator.device()); });
  return all_agree ? kSuccess : kFailure;
}

}  // namespace

void add_cliffs(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command =
      app.add_subcommand("cliffs", "inputs on which triangulators are slow, beside uniform points");
  command->footer(help());
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  add_limit_option(command, request->limit,
                   "what takes more seconds is not run at larger sizes, CGAL not at this one either");
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
