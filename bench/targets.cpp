// flaunay-bench targets: everything the project promises of its speed and memory, measured in one run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.hpp"
#include "contest.hpp"
#include "inputs.hpp"
#include "options.hpp"
#include "plot.hpp"
#include "record.hpp"
#include "target.hpp"

namespace flaunay::bench {
namespace {

struct Request {
  std::vector<std::string> modes{default_mode_name()};
  bool quick = false;
  bool without_largest = false;
  Measurement measurement;
};

/// Numbers of points.
struct Sizes {
  std::size_t base = 1000000, large = 4000000, largest = 16000000;
  std::size_t set = 100;
  std::size_t call = 1000;
};

Sizes sizes_of(const Request& request) { return request.quick ? Sizes{2000, 4000, 8000, 100, 200} : Sizes{}; }

constexpr const char* kUniform = "uniform";

// ---- Targets

/// What was measured, and the targets of one implementation made of it.
class Targets {
 public:
  Targets(const Sizes& sizes, const std::vector<Entry>& entries, std::string implementation)
      : sizes_(sizes), entries_(entries), implementation_(std::move(implementation)) {}

  void add_speedups();
  void add_spreads();
  void add_growth(const std::vector<Entry>& growth);
  void add_sets(const Input& sets);
  void add_call();
  void add_memory(double bytes_per_point);
  void add_degenerate();
  std::vector<Target> take() { return std::move(targets_); }

 private:
  std::optional<double> seconds(const std::string& distribution, std::size_t n) const {
    return median_of(entries_, implementation_, distribution, n);
  }
  void add(const std::string& what, double at_least, double goal, std::optional<double> measured) {
    targets_.push_back({what, implementation_, at_least, goal, measured});
  }

  const Sizes& sizes_;
  const std::vector<Entry>& entries_;
  std::string implementation_;
  std::vector<Target> targets_;
};

void Targets::add_speedups() {
  for (const std::size_t n : {sizes_.base, sizes_.large}) {
    for (const std::string& distribution : kPaperDistributions) {
      add(fmt::format("CGAL's time / ours, {} {}", thousands(n), distribution), 2.5, 3.5,
          ratio(median_of(entries_, kCgal, distribution, n), seconds(distribution, n)));
    }
  }
}

void Targets::add_spreads() {
  for (const std::size_t n : {sizes_.base, sizes_.large}) {
    std::optional<double> slowest, fastest;
    for (const std::string& distribution : kPaperDistributions) {
      const auto own = seconds(distribution, n);
      if (!own) return add(fmt::format("slowest / fastest distribution, {}", thousands(n)), 1.3, 1.15, {});
      slowest = std::max(slowest.value_or(*own), *own);
      fastest = std::min(fastest.value_or(*own), *own);
    }
    add(fmt::format("slowest / fastest distribution, {}", thousands(n)), 1.3, 1.15, ratio(slowest, fastest));
  }
}

void Targets::add_growth(const std::vector<Entry>& entries) {
  const auto n_log_n = [](std::size_t n) { return static_cast<double>(n) * std::log2(n); };
  const auto uniform = [&](std::size_t n) { return median_of(entries, implementation_, kUniform, n); };
  const auto growth = ratio(uniform(sizes_.largest), uniform(sizes_.base));
  add(fmt::format("growth {} to {} uniform / n log n", thousands(sizes_.base), thousands(sizes_.largest)),
      1.25, 1.1, ratio(growth, n_log_n(sizes_.largest) / n_log_n(sizes_.base)));
}

void Targets::add_sets(const Input& sets) {
  add(fmt::format("{} in one call / one set of {}", sets.distribution, thousands(sizes_.base)), 1.0, 0.7,
      ratio(seconds(sets.distribution, sets.n), seconds(kUniform, sizes_.base)));
}

void Targets::add_call() {
  const auto call = seconds(kUniform, sizes_.call);
  add(fmt::format("one call with {} points, warm, ms", sizes_.call), 3, 1, ratio(call, 1e-3));
}

void Targets::add_memory(double bytes_per_point) {
  add(fmt::format("device memory, bytes a point, {}", thousands(sizes_.base)), 200, 140, bytes_per_point);
}

void Targets::add_degenerate() {
  for (const std::string& distribution : kDegenerateDistributions) {
    add(fmt::format("{} / uniform, {}", distribution, thousands(sizes_.base)), 1.5, 1.1,
        ratio(seconds(distribution, sizes_.base), seconds(kUniform, sizes_.base)));
  }
}

// ---- Measuring

/// Everything that is measured beside each other; the largest input, which would empty every cache and take
/// most of the memory, only beside the one that its growth is over.
struct Inputs {
  std::vector<Input> with_cgal, alone, call, growth;
  const Input& sets() const { return alone.back(); }
};

Inputs make_all_inputs(const Sizes& sizes, bool without_largest) {
  Inputs inputs;
  inputs.with_cgal = make_inputs(kPaperDistributions, {sizes.base, sizes.large});
  inputs.alone = make_inputs(kDegenerateDistributions, {sizes.base});
  inputs.alone.push_back(equal_sets(sizes.base / sizes.set, sizes.set));
  inputs.call = make_inputs({kUniform}, {sizes.call});
  if (!without_largest) inputs.growth = make_inputs({kUniform}, {sizes.base, sizes.largest});
  return inputs;
}

/// In turns, without the largest input.
std::vector<Entry> measure_most(const Inputs& inputs, const Request& request, DeviceInfo& device) {
  Triangulator triangulator(request.measurement.device);
  device = triangulator.device();
  const std::vector<Implementation> all = modes_and_cgal(triangulator, request.modes);
  const std::vector<Implementation> own(all.begin(),
                                        all.begin() + static_cast<std::ptrdiff_t>(request.modes.size()));
  std::vector<Entry> entries = make_entries(all, inputs.with_cgal);
  append(entries, make_entries(own, inputs.alone));
  append(entries, make_entries(all, inputs.call));
  measure(entries, all, request.measurement.runs);
  return entries;
}

std::vector<Entry> measure_growth(const Inputs& inputs, const Request& request) {
  if (inputs.growth.empty()) return {};
  Triangulator triangulator(request.measurement.device);
  const std::vector<Implementation> own = mode_implementations(triangulator, request.modes);
  std::vector<Entry> entries = make_entries(own, inputs.growth);
  measure(entries, own, request.measurement.runs);
  return entries;
}

/// The greatest of the paper's distributions.
double memory_per_point(const std::vector<Input>& inputs, std::size_t n, const std::string& mode,
                        const std::string& device) {
  DeviceMemory memory(device);
  Options options;
  options.mode = mode_named(mode);
  std::size_t peak = 0;
  for (const Input& input : inputs) {
    if (input.n == n) peak = std::max(peak, memory.peak(input, options));
  }
  return static_cast<double>(peak) / static_cast<double>(n);
}

std::vector<Target> targets_of(const std::vector<Entry>& most, const std::vector<Entry>& growth,
                               const Inputs& inputs, const Sizes& sizes, const Request& request) {
  std::vector<Target> all;
  for (const std::string& mode : request.modes) {
    Targets targets(sizes, most, implementation_name(mode));
    targets.add_speedups();
    targets.add_spreads();
    targets.add_growth(growth);
    targets.add_sets(inputs.sets());
    targets.add_call();
    targets.add_memory(memory_per_point(inputs.with_cgal, sizes.base, mode, request.measurement.device));
    targets.add_degenerate();
    for (Target& target : targets.take()) all.push_back(std::move(target));
  }
  return all;
}

// ---- What is shown of it

plot::Figure figure_of(const std::vector<Target>& targets, const Request& request, const DeviceInfo& device) {
  plot::Bars panel;
  panel.y = {"how far (100 %: what it must be at least)", plot::Scale::log10, plot::Unit::percent};
  panel.comparison_name = "goal";
  for (const Target& t : targets) {
    if (!t.measured) continue;
    auto group = std::find_if(panel.groups.begin(), panel.groups.end(),
                              [&](const plot::BarGroup& candidate) { return candidate.name == t.what; });
    if (group == panel.groups.end()) group = panel.groups.insert(group, {t.what, {}});
    plot::Bar bar{t.implementation, {t.reached(*t.measured)}};
    bar.comparison = t.reached(t.goal);
    group->bars.push_back(bar);
  }
  plot::Figure figure;
  figure.title = "Targets";
  figure.subtitle = measured_on(device, request.measurement.runs);
  figure.panels.push_back(panel);
  figure.panel_width = 1100;
  figure.panel_height = 560;
  return figure;
}

int run(const Request& request, const std::string& command) {
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  const Sizes sizes = sizes_of(request);
  const Inputs inputs = make_all_inputs(sizes, request.without_largest);
  DeviceInfo device;
  std::vector<Entry> most = measure_most(inputs, request, device);
  std::vector<Entry> growth = measure_growth(inputs, request);
  const bool most_agree = check_counts(most), growth_agrees = check_counts(growth);
  const std::vector<Target> targets = targets_of(most, growth, inputs, sizes, request);

  std::vector<Entry> entries = most;
  append(entries, growth);
  print_entries(entries);
  print_targets(targets);
  nlohmann::json file = record(device, command, measurement.runs);
  add_entries(file, entries);
  file["targets"] = record_of(targets);
  write_files(measurement, file, [&] { return figure_of(targets, request, device); });
  return most_agree && growth_agrees ? kSuccess : kFailure;
}

const char* help() {
  return "Times are from points in memory to triangles and neighbours in memory, CGAL's too; medians of runs "
         "in turns, the first of each not counted; what is over soon is repeated within a run. Memory is the "
         "greatest over the paper's distributions, with a triangulator that has held nothing larger. The "
         "exit "
         "code is 1 if numbers of triangles differ from CGAL's; a missed target does not change it.";
}

}  // namespace

void add_targets(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command =
      app.add_subcommand("targets", "all targets of speed and memory: at least, goal, measured");
  command->footer(help());
  add_modes_option(command, request->modes);
  command->add_flag("--quick", request->quick, "a few thousand points: shows that it works, and no more");
  command->add_flag("--without-largest", request->without_largest, "leave 16M points, and so growth, out");
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
