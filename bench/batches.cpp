// flaunay-bench batches: many sets in one call, beside loops over the same sets.
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
#include "target.hpp"

namespace flaunay::bench {
namespace {

struct Request {
  std::size_t points = 1000000;
  std::size_t loop_sets = 20000;
  std::vector<std::string> modes{default_mode_name()};
  bool quick = false;
  Measurement measurement;
};

const char* help() {
  return "Batches of the same number of points: sets of 100, sets of 1,000, and sets of all sizes, with a "
         "heavy tail and with empty, collinear, gridded and all equal ones among them. Times are from "
         "points in memory to triangles and neighbours in memory:\n"
         "  flaunay-MODE: one call for all sets\n"
         "  flaunay-MODE-loop: a call for each set, one after the other, with a triangulator that is "
         "kept; releasing each result is included\n"
         "  cgal: a loop over the sets on one core; the triangulation object and all arrays are used "
         "again\n"
         "One set of as many points is beside them. A loop of flaunay's calls over more than --loop-sets "
         "sets takes evenly chosen ones, and its time is scaled by their number; the record says how many "
         "it was. All take turns; the first run of each is not counted; what is over soon is repeated "
         "within a run. The exit code is 1 if numbers of triangles differ from CGAL's; a missed target "
         "does not change it.";
}

/// The target is for the first of them.
std::vector<Input> make_batches(std::size_t points) {
  std::vector<Input> batches;
  for (const std::size_t size : {100, 1000}) {
    batches.push_back(equal_sets(std::max<std::size_t>(1, points / size), size));
  }
  batches.push_back(heavy_tailed_sets(points));
  return batches;
}

std::size_t sets_of(const Input& input) { return input.offsets.size() - 1; }

// ---- A loop of calls

std::string loop_name(const std::string& mode) { return implementation_name(mode) + "-loop"; }

/// Sets s with s % stride == 0 are measured.
std::size_t loop_stride(const Input& batch, std::size_t most) { return (sets_of(batch) + most - 1) / most; }

std::size_t sets_in_loop(const Input& batch, std::size_t most) {
  const std::size_t stride = loop_stride(batch, most);
  return (sets_of(batch) + stride - 1) / stride;
}

/// The triangles of the sets that the loop leaves out, so that the numbers of all can be compared.
std::size_t triangles_left_out(const Triangulation& mesh, std::size_t stride) {
  std::size_t triangles = 0;
  for (std::size_t s = 0; s + 1 < mesh.triangle_offsets.size(); ++s) {
    if (s % stride != 0) triangles += mesh.triangle_offsets[s + 1] - mesh.triangle_offsets[s];
  }
  return triangles;
}

Outcome run_loop(Triangulator& triangulator, const Input& batch, const Options& options, std::size_t most) {
  const std::size_t stride = loop_stride(batch, most);
  std::size_t triangles = 0;
  const Stopwatch watch;
  for (std::size_t s = 0; s < sets_of(batch); s += stride) {
    const std::size_t first = batch.offsets[s], n = batch.offsets[s + 1] - first;
    triangles += triangulator.triangulate(batch.points.coordinates.data() + 2 * first, n, options)
                     .statistics.triangles;
  }
  const double seconds = watch.seconds();
  if (stride == 1) return {seconds, triangles};
  triangles += triangles_left_out(run_mode(triangulator, batch, options), stride);
  const double share = static_cast<double>(sets_in_loop(batch, most)) / static_cast<double>(sets_of(batch));
  return {seconds / share, triangles};
}

std::vector<Implementation> loops(Triangulator& triangulator, const Request& request) {
  std::vector<Implementation> implementations;
  for (const std::string& mode : request.modes) {
    Options options;
    options.mode = mode_named(mode);
    implementations.push_back({loop_name(mode), [&triangulator, options, &request](const Input& batch) {
                                 return run_loop(triangulator, batch, options, request.loop_sets);
                               }});
  }
  return implementations;
}

// ---- One call beside all else

/// Seconds of everything for a batch.
struct Comparison {
  std::string mode;
  const Input* batch;
  std::size_t loop_sets;  ///< of which the loop's time was taken
  std::optional<double> one_call, loop, cgal, one_set, cgal_one_set;

  std::optional<double> cgal_over_one_call() const { return ratio(cgal, one_call); }
  std::optional<double> loop_over_one_call() const { return ratio(loop, one_call); }
  std::optional<double> one_call_over_one_set() const { return ratio(one_call, one_set); }
  std::optional<double> cgal_over_its_one_set() const { return ratio(cgal, cgal_one_set); }
};

std::vector<Comparison> compare(const std::vector<Entry>& entries, const std::vector<Input>& batches,
                                const Input& one_set, const Request& request) {
  std::vector<Comparison> comparisons;
  for (const Input& batch : batches) {
    for (const std::string& mode : request.modes) {
      const auto seconds = [&](const std::string& implementation, const Input& input) {
        return median_of(entries, implementation, input.distribution, input.n);
      };
      const std::string own = implementation_name(mode);
      comparisons.push_back({mode, &batch, sets_in_loop(batch, request.loop_sets), seconds(own, batch),
                             seconds(loop_name(mode), batch), seconds(kCgal, batch), seconds(own, one_set),
                             seconds(kCgal, one_set)});
    }
  }
  return comparisons;
}

std::string text_of(const std::optional<double>& value) {
  return value ? fmt::format("{:.3g}", *value) : "-";
}

void print_comparisons(const std::vector<Comparison>& comparisons) {
  fmt::print("\n{:<12} {:<24} {:>10} {:>10} {:>10} {:>24} {:>20} {:>19}\n", "mode", "batch", "one call s",
             "loop s", "CGAL s", "CGAL's loop / one call", "own loop / one call", "one call / one set");
  for (const Comparison& c : comparisons) {
    fmt::print("{:<12} {:<24} {:>10} {:>10} {:>10} {:>24} {:>20} {:>19}\n", c.mode, c.batch->distribution,
               text_of(c.one_call), text_of(c.loop), text_of(c.cgal), text_of(c.cgal_over_one_call()),
               text_of(c.loop_over_one_call()), text_of(c.one_call_over_one_set()));
    if (c.loop_sets < sets_of(*c.batch)) {
      fmt::print("{:<12} own loop: scaled from {} of {} sets\n", "", c.loop_sets, sets_of(*c.batch));
    }
  }
}

nlohmann::json json_of(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json record_of(const std::vector<Comparison>& comparisons) {
  nlohmann::json result = nlohmann::json::array();
  for (const Comparison& c : comparisons) {
    result.push_back({{"implementation", implementation_name(c.mode)},
                      {"batch", c.batch->distribution},
                      {"sets", sets_of(*c.batch)},
                      {"n", c.batch->n},
                      {"loop_sets_measured", c.loop_sets},
                      {"cgal_loop_over_one_call", json_of(c.cgal_over_one_call())},
                      {"own_loop_over_one_call", json_of(c.loop_over_one_call())},
                      {"one_call_over_one_set", json_of(c.one_call_over_one_set())},
                      {"cgal_loop_over_its_one_set", json_of(c.cgal_over_its_one_set())}});
  }
  return result;
}

std::vector<Target> targets_of(const std::vector<Comparison>& comparisons, const Input& first_batch) {
  std::vector<Target> targets;
  for (const Comparison& c : comparisons) {
    if (c.batch != &first_batch) continue;
    targets.push_back({fmt::format("CGAL's loop / one call, {}", c.batch->distribution),
                       implementation_name(c.mode), 1.5, 3, c.cgal_over_one_call()});
  }
  return targets;
}

/// The loops of small calls take so much longer that the axis is logarithmic.
plot::Figure figure_of(const std::vector<Entry>& entries, const std::vector<Input>& batches,
                       const Input& one_set, const Request& request, const DeviceInfo& device) {
  plot::Bars bars;
  bars.y = {"time", plot::Scale::log10, plot::Unit::seconds};
  bars.values = true;
  for (const Input& batch : batches) bars.groups.push_back(time_bars(entries, batch, batch.distribution));
  bars.groups.push_back(time_bars(entries, one_set, "one set"));
  plot::Figure figure;
  figure.title = fmt::format("{} points in many sets", one_set.n);
  figure.subtitle = measured_on(device, request.measurement.runs);
  figure.panels.push_back(bars);
  return figure;
}

int run(const Request& request, const std::string& command) {
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  const std::size_t points = request.quick ? std::min<std::size_t>(request.points, 3000) : request.points;
  const std::vector<Input> batches = make_batches(points);
  const std::vector<Input> one_set{make_input("uniform", points)};
  Triangulator triangulator(measurement.device);
  std::vector<Implementation> implementations = modes_and_cgal(triangulator, request.modes);
  const std::vector<Entry> of_one_set = make_entries(implementations, one_set);
  append(implementations, loops(triangulator, request));
  std::vector<Entry> entries = make_entries(implementations, batches);
  append(entries, of_one_set);
  measure(entries, implementations, measurement.runs);

  const bool all_agree = check_counts(entries);
  const std::vector<Comparison> comparisons = compare(entries, batches, one_set.front(), request);
  const std::vector<Target> targets = targets_of(comparisons, batches.front());
  print_entries(entries);
  print_comparisons(comparisons);
  print_targets(targets);
  nlohmann::json file = record(triangulator.device(), command, measurement.runs);
  add_entries(file, entries);
  file["ratios"] = record_of(comparisons);
  file["targets"] = record_of(targets);
  write_files(measurement, file,
              [&] { return figure_of(entries, batches, one_set.front(), request, triangulator.device()); });
  return all_agree ? kSuccess : kFailure;
}

}  // namespace

void add_batches(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = app.add_subcommand("batches", "many sets in one call, beside loops over the same sets");
  command->footer(help());
  command->add_option("--points", request->points, "of all sets of a batch together")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--loop-sets", request->loop_sets, "most sets that a loop of flaunay's calls takes")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_modes_option(command, request->modes);
  command->add_flag("--quick", request->quick, "3,000 points: shows that it works, and no more");
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
