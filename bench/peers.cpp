// flaunay-bench peers: flaunay beside other triangulators on the same points.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "inputs.hpp"
#include "peer.hpp"
#include "plot.hpp"
#include "record.hpp"
#include "timing.hpp"

namespace flaunay::bench {
namespace {

struct Request {
  std::vector<std::size_t> sizes{10000, 1000000};
  std::vector<std::string> distributions{"uniform", "normal", "kuzmin", "line"};
  std::vector<std::string> modes{"flattened", "partition"};
  std::vector<std::string> peers;
  int runs = 5;
  double limit = 60;
  std::string device, json_path, plot_path;
};

/// One implementation on one input.
struct Row {
  std::string implementation;
  const Input* input;
  std::size_t triangles = 0;
  std::size_t bytes_peak = 0;
  std::string skipped = {};
  std::vector<double> seconds = {};
  bool agrees = true;  // as many triangles as flaunay

  bool of_flaunay() const { return implementation.rfind("flaunay-", 0) == 0; }
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
      "must "
      "have as many triangles as flaunay; if not, a warning says so, the row is not in the plot, and the "
      "exit code is 1.";
  return text;
}

/// Runs each peer once in a process of its own. The rows of those that are too slow or fail are marked;
/// larger inputs of the same distribution are not tried then.
std::vector<Row> try_peers(const std::vector<Peer>& peers, const std::vector<Input>& inputs, double limit) {
  std::vector<Row> rows;
  std::map<std::pair<std::string, std::string>, std::string> ended;
  Progress progress(peers.size() * inputs.size());
  for (const Input& input : inputs) {
    for (const Peer& peer : peers) {
      Row row{peer.name, &input};
      std::string& reason = ended[{peer.name, input.distribution}];
      progress.step(fmt::format("memory of {}: {}", peer.name, input_name(input)));
      if (reason.empty()) {
        const Trial trial = try_peer(peer, input.points, limit);
        row.triangles = trial.run.triangles;
        row.bytes_peak = trial.bytes_peak;
        if (!trial.failure.empty()) reason = fmt::format("{} on {}", trial.failure, input_name(input));
      }
      row.skipped = reason;
      if (!reason.empty()) {
        progress.say(fmt::format("not measured: {} on {}: {}", peer.name, input_name(input), reason));
      }
      rows.push_back(row);
    }
  }
  return rows;
}

Job flaunay_job(Triangulator& triangulator, Mode mode, Row& row) {
  return {fmt::format("{} on {}", row.implementation, input_name(*row.input)), [&triangulator, mode, &row] {
            Options options;
            options.mode = mode;
            const Stopwatch watch;
            const Triangulation mesh = run_mode(triangulator, row.input->points, options);
            const double seconds = watch.seconds();
            row.triangles = mesh.statistics.triangles;
            return seconds;
          }};
}

Job peer_job(const Peer& peer, Row& row) {
  return {fmt::format("{} on {}", row.implementation, input_name(*row.input)), [&peer, &row] {
            const PeerRun run = peer.run(row.input->points);
            row.triangles = run.triangles;
            return run.seconds;
          }};
}

/// Measures all rows that are not skipped.
void measure(std::vector<Row>& rows, const std::vector<Peer>& peers, Triangulator& triangulator, int runs) {
  std::vector<Job> jobs;
  std::vector<Row*> measured;
  for (Row& row : rows) {
    if (!row.skipped.empty()) continue;
    if (row.of_flaunay()) {
      jobs.push_back(flaunay_job(triangulator, mode_named(row.implementation.substr(8)), row));
    } else {
      const auto peer = std::find_if(peers.begin(), peers.end(), [&](const Peer& candidate) {
        return candidate.name == row.implementation;
      });
      jobs.push_back(peer_job(*peer, row));
    }
    jobs.back().series = jobs.back().name;
    measured.push_back(&row);
  }
  run_interleaved(jobs, runs);
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    measured[j]->seconds = jobs[j].seconds;
    measured[j]->skipped = jobs[j].skipped;
  }
}

/// Device memory by mode and input, with a triangulator that has held nothing larger before: it keeps what it
/// has for the next call. Rows are in ascending order of size.
void measure_device_memory(std::vector<Row>& rows, const Request& request) {
  for (const std::string& mode : request.modes) {
    Triangulator fresh(request.device);
    Options options;
    options.mode = mode_named(mode);
    for (Row& row : rows) {
      if (row.implementation != "flaunay-" + mode || !row.skipped.empty()) continue;
      row.bytes_peak = run_mode(fresh, row.input->points, options).statistics.device_bytes_peak;
    }
  }
}

/// Rows by input, and within an input flaunay's first.
std::vector<Row> in_order(std::vector<Row> rows) {
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return a.input != b.input ? a.input < b.input : a.of_flaunay() > b.of_flaunay();
  });
  return rows;
}

std::vector<Row> flaunay_rows(const std::vector<std::string>& modes, const std::vector<Input>& inputs) {
  std::vector<Row> rows;
  for (const Input& input : inputs) {
    for (const std::string& mode : modes) rows.push_back({"flaunay-" + mode, &input});
  }
  return rows;
}

std::vector<Peer> chosen_peers(const std::vector<std::string>& names) {
  std::vector<Peer> chosen;
  for (const Peer& peer : all_peers()) {
    if (std::find(names.begin(), names.end(), peer.name) == names.end()) continue;
    if (peer.run) {
      chosen.push_back(peer);
    } else {
      fmt::print(stderr, "not measured: {}: this build is without it\n", peer.name);
    }
  }
  return chosen;
}

/// Marks the rows that have not as many triangles as flaunay's first, and says so loudly. Whether there are
/// none.
bool check_counts(std::vector<Row>& rows) {
  bool all_agree = true;
  std::map<const Input*, const Row*> expected;
  for (Row& row : rows) {
    if (!row.skipped.empty()) continue;
    const Row& first = *expected.emplace(row.input, &row).first->second;
    row.agrees = row.triangles == first.triangles;
    if (row.agrees) continue;
    all_agree = false;
    fmt::print(stderr, "WARNING: {}: {} has {} triangles, {} has {}\n", input_name(*row.input),
               row.implementation, row.triangles, first.implementation, first.triangles);
  }
  return all_agree;
}

void print_table(const std::vector<Row>& rows) {
  fmt::print("{:<24} {:<16} {:>9} {:>10} {:>10} {:>10} {:>8} {:>10} {:>9}\n", "implementation",
             "distribution", "n", "median s", "min s", "max s", "ns/pt", "triangles", "bytes/pt");
  for (const Row& row : rows) {
    fmt::print("{:<24} {:<16} {:>9} ", row.implementation, row.input->distribution, row.input->n);
    if (!row.skipped.empty()) {
      fmt::print("not measured: {}\n", row.skipped);
      continue;
    }
    const Summary seconds = summary(row.seconds);
    const auto n = static_cast<double>(row.input->n);
    fmt::print("{:>10.5f} {:>10.5f} {:>10.5f} {:>8.0f} {:>10} {:>9.0f}{}\n", seconds.median, seconds.low,
               seconds.high, 1e9 * seconds.median / n, row.triangles, static_cast<double>(row.bytes_peak) / n,
               row.agrees ? "" : "  WRONG NUMBER OF TRIANGLES");
  }
}

/// The rows of one input that were measured with a right result: time for a wrong one says nothing.
std::vector<const Row*> valid_rows(const std::vector<Row>& rows, const Input& input) {
  std::vector<const Row*> result;
  for (const Row& row : rows) {
    if (row.input == &input && row.skipped.empty() && row.agrees) result.push_back(&row);
  }
  return result;
}

const Row* fastest(const std::vector<const Row*>& rows, bool of_flaunay) {
  const Row* best = nullptr;
  for (const Row* row : rows) {
    if (row->of_flaunay() != of_flaunay) continue;
    if (best == nullptr || summary(row->seconds).median < summary(best->seconds).median) best = row;
  }
  return best;
}

/// Which of flaunay's modes is best on each input, and how it compares. Printed and returned for the record.
nlohmann::json compare(const std::vector<Row>& rows, const std::vector<Input>& inputs) {
  nlohmann::json best = nlohmann::json::array();
  for (const Input& input : inputs) {
    const auto valid = valid_rows(rows, input);
    const Row *own = fastest(valid, true), *other = fastest(valid, false);
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

nlohmann::json results(const std::vector<Row>& rows) {
  nlohmann::json results = nlohmann::json::array();
  for (const Row& row : rows) {
    if (!row.skipped.empty()) continue;
    results.push_back({{"implementation", row.implementation},
                       {"distribution", row.input->distribution},
                       {"n", row.input->n},
                       {"bytes_peak", row.bytes_peak},
                       {"triangles", row.triangles},
                       {"agrees", row.agrees}});
    add_seconds(results.back(), summary(row.seconds));
  }
  return results;
}

nlohmann::json skipped(const std::vector<Row>& rows) {
  nlohmann::json skipped = nlohmann::json::array();
  for (const Row& row : rows) {
    if (row.skipped.empty()) continue;
    skipped.push_back({{"implementation", row.implementation},
                       {"distribution", row.input->distribution},
                       {"n", row.input->n},
                       {"reason", row.skipped}});
  }
  return skipped;
}

plot::Panel lines_panel(const std::vector<Row>& rows, const Request& request,
                        const std::string& distribution) {
  plot::Lines panel;
  panel.title = distribution;
  panel.x = size_axis(request.sizes);
  panel.y = {"time per point", plot::Scale::log10, plot::Unit::seconds};
  std::vector<std::string> names;
  for (const Row& row : rows) {
    if (!row.skipped.empty() || !row.agrees || row.input->distribution != distribution) continue;
    auto name = std::find(names.begin(), names.end(), row.implementation);
    if (name == names.end()) {
      name = names.insert(names.end(), row.implementation);
      panel.series.push_back({row.implementation, {}, {}});
    }
    plot::Series& series = panel.series[static_cast<std::size_t>(name - names.begin())];
    const Summary seconds = summary(row.seconds);
    const auto n = static_cast<double>(row.input->n);
    series.x.push_back(n);
    series.y.push_back(seconds.median / n);
    series.low.push_back(seconds.low / n);
    series.high.push_back(seconds.high / n);
  }
  return panel;
}

plot::Panel bars_panel(const std::vector<Row>& rows, const std::vector<Input>& inputs) {
  plot::Bars panel;
  panel.y = {"time", plot::Scale::linear, plot::Unit::seconds};
  panel.values = true;
  for (const Input& input : inputs) {
    panel.groups.push_back({input.distribution, {}});
    for (const Row* row : valid_rows(rows, input)) {
      const Summary seconds = summary(row->seconds);
      panel.groups.back().bars.push_back({row->implementation, {seconds.median}, seconds.low, seconds.high});
    }
  }
  return panel;
}

/// With one size bars beside each other, with several lines by size.
plot::Figure figure(const std::vector<Row>& rows, const std::vector<Input>& inputs, const Request& request,
                    const DeviceInfo& device) {
  plot::Figure figure;
  figure.subtitle = measured_on(device, request.runs);
  if (request.sizes.size() == 1) {
    figure.title = fmt::format("Delaunay triangulation of {} points", request.sizes.front());
    figure.panels.push_back(bars_panel(rows, inputs));
    return figure;
  }
  figure.title = "Delaunay triangulation by number of points";
  for (const std::string& distribution : request.distributions) {
    figure.panels.push_back(lines_panel(rows, request, distribution));
  }
  return figure;
}

int run(const Request& request, const std::string& command) {
  check_writable({request.json_path, request.plot_path});
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  const std::vector<Peer> peers = chosen_peers(request.peers);
  // Before there is a device, whose driver has threads: a child process gets none of them.
  std::vector<Row> rows = try_peers(peers, inputs, request.limit);
  const std::vector<Row> own = flaunay_rows(request.modes, inputs);
  rows.insert(rows.end(), own.begin(), own.end());
  rows = in_order(std::move(rows));

  Triangulator triangulator(request.device);
  for (const std::string& mode : request.modes) {
    Options options;
    options.mode = mode_named(mode);
    prepare_mode(triangulator, options);
  }
  measure(rows, peers, triangulator, request.runs);
  measure_device_memory(rows, request);

  const bool all_agree = check_counts(rows);
  print_table(rows);
  nlohmann::json file = record(triangulator.device(), command, request.runs);
  file["best"] = compare(rows, inputs);
  file["results"] = results(rows);
  file["skipped"] = skipped(rows);
  if (!request.json_path.empty()) write_record(request.json_path, file);
  if (!request.plot_path.empty()) {
    plot::write(request.plot_path, figure(rows, inputs, request, triangulator.device()));
  }
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
  command->add_option("--sizes", request->sizes, "numbers of points")->delimiter(',')->capture_default_str();
  command->add_option("--distributions", request->distributions, "which (see flaunay generate --help)")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--modes", request->modes, "flaunay's modes")
      ->delimiter(',')
      ->check(CLI::IsMember(mode_names()))
      ->capture_default_str();
  command->add_option("--peers", request->peers, "which others")
      ->delimiter(',')
      ->check(CLI::IsMember(peer_names))
      ->capture_default_str();
  command->add_option("--runs", request->runs, "counted runs of each")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--limit", request->limit, "seconds that a run of another implementation may take")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--device", request->device, "device, as for flaunay triangulate");
  command->add_option("--json", request->json_path, "write the results here");
  command->add_option("--plot", request->plot_path, "write a plot here, as SVG");
  command->callback(
      [request, &action] { action = [request](const std::string& line) { return run(*request, line); }; });
}

}  // namespace flaunay::bench
