// flaunay-bench modes: flaunay's modes beside each other, by number of points.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "contest.hpp"
#include "inputs.hpp"
#include "options.hpp"
#include "plot.hpp"
#include "record.hpp"
#include "timing.hpp"

namespace flaunay::bench {
namespace {

struct Request {
  std::vector<std::size_t> sizes;
  std::vector<std::string> distributions{"uniform"};
  std::vector<std::string> modes = mode_names();
  std::vector<std::string> hulls{"prune"};
  double limit = 10;
  std::size_t count_up_to = 131072;
  Measurement measurement;
};

/// A mode with a hull on one input.
struct Row {
  std::string mode, hull;
  std::string variant;  // the name of both in tables and plots
  const Input* input;
  std::size_t bytes_peak = 0;  // of the device
  Statistics statistics = {};
  Work work = {};  // empty if not counted
  std::string skipped = {};
  Summary seconds = {};
};

/// Dwyer's algorithm has no dividing paths, so variants of them make no difference to it.
bool has_hulls(const std::string& mode) { return mode != "dwyer"; }

std::vector<Row> make_rows(const Request& request, const std::vector<Input>& inputs) {
  std::vector<Row> rows;
  for (const Input& input : inputs) {
    for (const std::string& mode : request.modes) {
      for (const std::string& hull : request.hulls) {
        if (!has_hulls(mode) && hull != request.hulls.front()) continue;
        const bool named = has_hulls(mode) && request.hulls.size() > 1;
        rows.push_back({mode, hull, named ? mode + "/" + hull : mode, &input});
      }
    }
  }
  return rows;
}

Options options_of(const Row& row) {
  Options options;
  options.mode = mode_named(row.mode);
  options.hull = hull_named(row.hull);
  return options;
}

/// Errors are those of the measured runs too, where they are reported.
void prepare(Triangulator& triangulator, const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    if (row.input != rows.front().input) break;
    try {
      prepare_mode(triangulator, options_of(row));
    } catch (const Error&) {
      continue;
    }
  }
}

void measure(Triangulator& triangulator, std::vector<Row>& rows, int runs, double limit) {
  std::vector<Job> jobs;
  for (Row& row : rows) {
    Job job{fmt::format("{} on {}", row.variant, input_name(*row.input)), [&triangulator, &row] {
              const Stopwatch watch;
              Triangulation mesh = run_mode(triangulator, *row.input, options_of(row));
              const double seconds = watch.seconds();
              row.statistics = std::move(mesh.statistics);
              return seconds;
            }};
    job.series = row.variant + " on " + row.input->distribution;
    jobs.push_back(std::move(job));
  }
  run_interleaved(jobs, runs, limit);
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    rows[j].skipped = jobs[j].skipped;
    if (rows[j].skipped.empty()) rows[j].seconds = summary(jobs[j].seconds);
  }
}

void measure_device_memory(std::vector<Row>& rows, const std::string& device) {
  DeviceMemory memory(device);
  Progress progress(rows.size());
  for (Row& row : rows) {
    progress.step(fmt::format("device memory: {} on {}", row.variant, input_name(*row.input)));
    if (row.skipped.empty()) row.bytes_peak = memory.peak(*row.input, options_of(row));
  }
}

void count_work(Triangulator& triangulator, std::vector<Row>& rows, std::size_t up_to) {
  Progress progress(rows.size());
  for (Row& row : rows) {
    progress.step(fmt::format("counting operations: {} on {}", row.variant, input_name(*row.input)));
    if (!row.skipped.empty() || row.input->n > up_to) continue;
    Options options = options_of(row);
    options.count = true;
    row.work = run_mode(triangulator, *row.input, options).statistics.work;
  }
}

bool counted(const Work& work) { return !work.levels.empty(); }

/// All levels and what precedes them, by component.
Work::Components sum(const Work& work) {
  Work::Components total = work.start;
  for (const Work::Components& level : work.levels) {
    for (std::size_t c = 0; c < kComponents; ++c) {
      total[c].arithmetic += level[c].arithmetic;
      total[c].depths += level[c].depths;
      total[c].orientations += level[c].orientations;
      total[c].circles += level[c].circles;
      total[c].critical_path += level[c].critical_path;
    }
  }
  return total;
}

std::uint64_t operations(const Work& work) {
  std::uint64_t total = 0;
  for (const OperationCounts& counts : sum(work)) total += counts.operations();
  return total;
}

nlohmann::json work_record(const Work& work) {
  static const char* const kNames[kComponents] = {"cut", "hull", "merge", "split", "endgame"};
  nlohmann::json result{{"operations", operations(work)}};
  const Work::Components total = sum(work);
  for (std::size_t c = 0; c < kComponents; ++c) {
    result[kNames[c]] = {{"operations", total[c].operations()},
                         {"operations_with_bounds", total[c].operations_with_bounds()},
                         {"critical_path", total[c].critical_path}};
  }
  return result;
}

void print_table(const std::vector<Row>& rows) {
  fmt::print("{:<28} {:<12} {:>9} {:>10} {:>10} {:>10} {:>8} {:>8} {:>6} {:>8} {:>9} {:>8}\n", "mode",
             "distribution", "n", "median s", "min s", "max s", "ns/pt", "launches", "waits", "bytes/pt",
             "undecided", "ops/pt");
  for (const Row& row : rows) {
    fmt::print("{:<28} {:<12} {:>9} ", row.variant, row.input->distribution, row.input->n);
    if (!row.skipped.empty()) {
      fmt::print("not measured: {}\n", row.skipped);
      continue;
    }
    const auto n = static_cast<double>(row.input->n);
    const Statistics& s = row.statistics;
    fmt::print(
        "{:>10.6f} {:>10.6f} {:>10.6f} {:>8.0f} {:>8} {:>6} {:>8.0f} {:>9} {:>8}\n", row.seconds.median,
        row.seconds.low, row.seconds.high, 1e9 * row.seconds.median / n, s.kernel_launches, s.host_waits,
        static_cast<double>(row.bytes_peak) / n, s.undecided,
        counted(row.work) ? fmt::format("{:.0f}", static_cast<double>(operations(row.work)) / n) : "-");
  }
}

/// Median seconds by size.
using Curve = std::map<std::size_t, double>;

/// By variant, in the order of the rows.
std::vector<std::pair<std::string, Curve>> curves_of(const std::vector<Row>& rows,
                                                     const std::string& distribution) {
  std::vector<std::pair<std::string, Curve>> curves;
  for (const Row& row : rows) {
    if (!row.skipped.empty() || row.input->distribution != distribution) continue;
    auto curve = std::find_if(curves.begin(), curves.end(),
                              [&](const auto& candidate) { return candidate.first == row.variant; });
    if (curve == curves.end()) curve = curves.insert(curves.end(), {row.variant, {}});
    curve->second[row.input->n] = row.seconds.median;
  }
  return curves;
}

/// Where the order of two variants changes.
struct Crossover {
  std::string distribution;
  std::string below, above;  // the faster one on either side
  double n;
  bool of_fastest;  // no other variant is faster there
};

/// Seconds at n between measured sizes, by a power law between neighbours; NaN outside of them.
double interpolated(const Curve& curve, double n) {
  for (auto next = curve.begin(); next != curve.end(); ++next) {
    const auto size = static_cast<double>(next->first);
    if (size < n) continue;
    if (size == n || next == curve.begin()) return size == n ? next->second : std::nan("");
    const auto before = std::prev(next);
    const double share = std::log(n / static_cast<double>(before->first)) /
                         std::log(size / static_cast<double>(before->first));
    return std::exp((1 - share) * std::log(before->second) + share * std::log(next->second));
  }
  return std::nan("");
}

bool anything_faster(const std::vector<std::pair<std::string, Curve>>& curves, double n, double seconds) {
  constexpr double kRounding = 1e-9;
  return std::any_of(curves.begin(), curves.end(), [&](const auto& curve) {
    return interpolated(curve.second, n) < seconds * (1 - kRounding);
  });
}

/// Crossovers of two curves between sizes that both have. Differences within noise are no order: the curves
/// cross between the last size with one clear order and the first with the other.
std::vector<Crossover> crossovers_of(const std::pair<std::string, Curve>& a,
                                     const std::pair<std::string, Curve>& b) {
  constexpr double kNoise = 0.03;
  std::vector<Crossover> result;
  double previous_n = 0, previous_ratio = 0;
  for (const auto& [size, seconds] : a.second) {
    const auto other = b.second.find(size);
    if (other == b.second.end()) continue;
    const double n = std::log(static_cast<double>(size)), ratio = std::log(seconds / other->second);
    if (std::abs(ratio) < kNoise) continue;
    if (previous_ratio * ratio < 0) {
      const double share = previous_ratio / (previous_ratio - ratio);
      const double crossing = std::exp(previous_n + share * (n - previous_n));
      const bool a_below = previous_ratio < 0;
      result.push_back({"", a_below ? a.first : b.first, a_below ? b.first : a.first, crossing, false});
    }
    previous_n = n;
    previous_ratio = ratio;
  }
  return result;
}

std::vector<Crossover> find_crossovers(const std::vector<Row>& rows,
                                       const std::vector<std::string>& distributions) {
  std::vector<Crossover> all;
  for (const std::string& distribution : distributions) {
    const auto curves = curves_of(rows, distribution);
    for (std::size_t i = 0; i < curves.size(); ++i) {
      for (std::size_t j = i + 1; j < curves.size(); ++j) {
        for (Crossover crossover : crossovers_of(curves[i], curves[j])) {
          crossover.distribution = distribution;
          crossover.of_fastest =
              !anything_faster(curves, crossover.n, interpolated(curves[i].second, crossover.n));
          all.push_back(crossover);
        }
      }
    }
  }
  return all;
}

void print_crossovers(const std::vector<Crossover>& crossovers) {
  if (crossovers.empty()) fmt::print("no two modes clearly cross between these sizes\n");
  for (const Crossover& c : crossovers) {
    fmt::print("{}: {} is faster below about {:.0f} points, {} above{}\n", c.distribution, c.below, c.n,
               c.above, c.of_fastest ? " (the fastest of all there)" : "");
  }
}

nlohmann::json crossover_record(const std::vector<Crossover>& crossovers) {
  nlohmann::json result = nlohmann::json::array();
  for (const Crossover& c : crossovers) {
    result.push_back({{"distribution", c.distribution},
                      {"faster_below", c.below},
                      {"faster_above", c.above},
                      {"n", std::round(c.n)},
                      {"of_fastest", c.of_fastest}});
  }
  return result;
}

nlohmann::json result_record(const Row& row) {
  const Statistics& s = row.statistics;
  nlohmann::json result{{"implementation", "flaunay-" + row.mode},
                        {"mode", row.mode},
                        {"distribution", row.input->distribution},
                        {"n", row.input->n},
                        {"kernel_launches", s.kernel_launches},
                        {"host_waits", s.host_waits},
                        {"bytes_peak", row.bytes_peak},
                        {"undecided", s.undecided},
                        {"triangles", s.triangles},
                        {"levels", s.levels.size()}};
  if (has_hulls(row.mode)) result["hull"] = row.hull;
  if (counted(row.work)) result["work"] = work_record(row.work);
  add_seconds(result, row.seconds);
  return result;
}

void add_results(nlohmann::json& file, const std::vector<Row>& rows) {
  file["results"] = nlohmann::json::array();
  file["skipped"] = nlohmann::json::array();
  for (const Row& row : rows) {
    if (row.skipped.empty()) {
      file["results"].push_back(result_record(row));
    } else {
      file["skipped"].push_back({{"mode", row.mode},
                                 {"hull", row.hull},
                                 {"distribution", row.input->distribution},
                                 {"n", row.input->n},
                                 {"reason", row.skipped}});
    }
  }
}

plot::Lines panel_of(const std::vector<Row>& rows, const std::vector<Crossover>& crossovers,
                     const Request& request, const std::string& distribution) {
  plot::Lines panel;
  panel.title = request.distributions.size() > 1 ? distribution : "";
  panel.x = size_axis(request.sizes);
  panel.y = {"time per point", plot::Scale::log10, plot::Unit::seconds};
  for (const Row& row : rows) {
    if (!row.skipped.empty() || row.input->distribution != distribution) continue;
    add_time_per_point(panel, row.variant, row.input->n, row.seconds);
  }
  for (const Crossover& c : crossovers) {
    if (c.distribution != distribution || !c.of_fastest) continue;
    panel.references.push_back({fmt::format("{} | {} at {:.0f}", c.below, c.above, c.n), c.n});
  }
  return panel;
}

plot::Figure figure_of(const std::vector<Row>& rows, const std::vector<Crossover>& crossovers,
                       const Request& request, const DeviceInfo& device) {
  plot::Figure figure;
  figure.title = request.distributions.size() > 1
                     ? "Time by mode"
                     : fmt::format("Time by mode, {} points", request.distributions.front());
  figure.subtitle = measured_on(device, request.measurement.runs);
  for (const std::string& distribution : request.distributions) {
    figure.panels.push_back(panel_of(rows, crossovers, request, distribution));
  }
  return figure;
}

/// Whether all modes have as many triangles on each input; says loudly where not.
bool counts_agree(const std::vector<Row>& rows) {
  bool agree = true;
  std::map<const Input*, const Row*> first;
  for (const Row& row : rows) {
    if (!row.skipped.empty()) continue;
    const Row& expected = *first.emplace(row.input, &row).first->second;
    agree &= same_count(*row.input, expected.variant, expected.statistics.triangles, row.variant,
                        row.statistics.triangles);
  }
  return agree;
}

int run(const Request& request, const std::string& command) {
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  std::vector<Row> rows = make_rows(request, inputs);
  Triangulator triangulator(measurement.device);
  prepare(triangulator, rows);
  measure(triangulator, rows, measurement.runs, request.limit);
  measure_device_memory(rows, measurement.device);
  count_work(triangulator, rows, request.count_up_to);

  const std::vector<Crossover> crossovers = find_crossovers(rows, request.distributions);
  print_table(rows);
  print_crossovers(crossovers);
  nlohmann::json file = record(triangulator.device(), command, measurement.runs);
  add_results(file, rows);
  file["crossovers"] = crossover_record(crossovers);
  write_files(measurement, file, [&] { return figure_of(rows, crossovers, request, triangulator.device()); });
  return counts_agree(rows) ? kSuccess : kFailure;
}

}  // namespace

void add_modes(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  request->sizes = powers_of_two(8, 20);
  CLI::App* command = app.add_subcommand("modes", "flaunay's modes beside each other, by number of points");
  command->footer(
      "Times are from points in host memory to triangles and neighbours in host memory; all modes and inputs "
      "take "
      "turns, and the first run of each is not counted. bytes/pt is device memory. Crossovers are "
      "interpolated "
      "between sizes by power laws, where differences are above 3 %. Operations are those of "
      "docs/counting.md, counted in a run of its own.");
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  command->add_option("--hulls", request->hulls, "which variants of the dividing paths; dwyer has none")
      ->delimiter(',')
      ->check(CLI::IsMember(hull_names()))
      ->capture_default_str();
  add_limit_option(command, request->limit,
                   "a mode whose first run takes more seconds is not run at larger sizes");
  command->add_option("--count-up-to", request->count_up_to, "largest size whose operations are counted")
      ->capture_default_str();
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
