// flaunay-bench peers: flaunay beside other triangulators on the same points.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "contest.hpp"
#include "inputs.hpp"
#include "options.hpp"
#include "peer.hpp"
#include "plot.hpp"
#include "record.hpp"
#include "timing.hpp"

namespace flaunay::bench {
namespace {

struct Request {
  std::vector<std::size_t> sizes{10000, 1000000};
  std::vector<std::string> distributions = kPaperDistributions;
  std::vector<std::string> modes{"flattened", default_mode_name()};
  std::vector<std::string> peers;
  double limit = 60;
  Measurement measurement;
};

std::string help() {
  std::string text =
      "Triangulation alone: from an array of coordinates in memory to a triangulation in memory; making "
      "points, "
      "building kernels and releasing the result are not included. All implementations and inputs take "
      "turns, and "
      "the first run of each is not counted.\n\n"
      "What each time includes:\n"
      "  flaunay-MODE: all of Triangulator::triangulate, the way to the device and back too: points to "
      "triangles "
      "and neighbours in host arrays\n";
  for (const Peer& peer : all_peers()) {
    text += fmt::format("  {}{}: {}\n", peer.name, peer.run ? "" : " (this build is without it)",
                        peer.description);
  }
  text +=
      "\nbytes_peak: for flaunay the most device memory held at once, without host arrays; for the others "
      "what "
      "one run in a process of its own adds to the resident memory at its peak.\n"
      "Peers with more than --limit seconds are not run on this or larger sizes of the distribution. All "
      "must have as many triangles as CGAL, or as flaunay's first mode where CGAL is not run; if not, a "
      "warning says so, the entry is not in the plot, and the exit code is 1.";
  return text;
}

void measure_device_memory(std::vector<Entry>& entries, const std::string& device) {
  DeviceMemory memory(device);
  for (Entry& entry : entries) {
    if (!entry.of_flaunay() || !entry.skipped.empty()) continue;
    Options options;
    options.mode = mode_named(mode_of(entry.implementation));
    entry.bytes_peak = memory.peak(*entry.input, options);
  }
}

const Entry* fastest(const std::vector<const Entry*>& entries, bool of_flaunay) {
  const Entry* best = nullptr;
  for (const Entry* entry : entries) {
    if (entry->of_flaunay() != of_flaunay) continue;
    if (best == nullptr || summary(entry->seconds).median < summary(best->seconds).median) best = entry;
  }
  return best;
}

/// Which of flaunay's modes is best on each input, and how it compares. Printed and returned for the record.
nlohmann::json compare(const std::vector<Entry>& entries, const std::vector<Input>& inputs) {
  nlohmann::json best = nlohmann::json::array();
  for (const Input& input : inputs) {
    const auto valid = valid_entries(entries, input);
    const Entry *own = fastest(valid, true), *other = fastest(valid, false);
    if (own == nullptr) continue;
    best.push_back({{"distribution", input.distribution}, {"n", input.n}, {"flaunay", own->implementation}});
    fmt::print("{}: {} is flaunay's best", input_name(input), own->implementation);
    if (other != nullptr) {
      const double ratio = summary(own->seconds).median / summary(other->seconds).median;
      best.back()["peer"] = other->implementation;
      best.back()["ratio"] = ratio;
      fmt::print(", with {:.2f} times the time of {}", ratio, other->implementation);
    }
    fmt::print("\n");
  }
  return best;
}

plot::Panel bars_panel(const std::vector<Entry>& entries, const std::vector<Input>& inputs) {
  plot::Bars panel;
  panel.y = {"time", plot::Scale::linear, plot::Unit::seconds};
  panel.values = true;
  for (const Input& input : inputs) {
    panel.groups.push_back(time_bars(entries, input, input.distribution));
  }
  return panel;
}

/// With one size bars beside each other, with several lines by size.
plot::Figure figure(const std::vector<Entry>& entries, const std::vector<Input>& inputs,
                    const Request& request, const DeviceInfo& device) {
  plot::Figure figure;
  figure.subtitle = measured_on(device, request.measurement.runs);
  if (request.sizes.size() == 1) {
    figure.title = fmt::format("Delaunay triangulation of {} points", request.sizes.front());
    figure.panels.push_back(bars_panel(entries, inputs));
    return figure;
  }
  figure.title = "Delaunay triangulation by number of points";
  for (const std::string& distribution : request.distributions) {
    figure.panels.push_back(time_per_point_panel(entries, request.sizes, distribution));
  }
  return figure;
}

int run(const Request& request, const std::string& command) {
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  const std::vector<Peer> peers = chosen_peers(request.peers);
  // Before there is a device: see ask_child.
  std::vector<Entry> entries = try_peers(peers, inputs, request.limit);

  Triangulator triangulator(measurement.device);
  std::vector<Implementation> implementations = mode_implementations(triangulator, request.modes);
  entries = by_input(make_entries(implementations, inputs), entries);
  append(implementations, implementations_of(peers));
  measure(entries, implementations, measurement.runs);
  measure_device_memory(entries, measurement.device);

  const bool all_agree = check_counts(entries);
  print_entries(entries);
  nlohmann::json file = record(triangulator.device(), command, measurement.runs);
  file["best"] = compare(entries, inputs);
  add_entries(file, entries);
  write_files(measurement, file, [&] { return figure(entries, inputs, request, triangulator.device()); });
  return all_agree ? kSuccess : kFailure;
}

}  // namespace

void add_peers(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  std::vector<std::string> peer_names;
  for (const Peer& peer : all_peers()) peer_names.push_back(peer.name);
  request->peers = peer_names;
  CLI::App* command = app.add_subcommand("peers", "flaunay beside other triangulators on the same points");
  command->footer(help());
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  command->add_option("--peers", request->peers, "which others")
      ->delimiter(',')
      ->check(CLI::IsMember(peer_names))
      ->capture_default_str();
  add_limit_option(command, request->limit, "seconds that a run of another implementation may take");
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
