// flaunay-bench targets: everything the project promises of its speed and memory, measured in one run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/measuring/contest.hpp"
#include "bench/measuring/processes.hpp"

namespace flaunay::bench::targets {
namespace {

struct TargetsRequest : Request {
  bool without_largest = false;
};

/// Numbers of points.
struct Sizes {
  std::size_t base = 1000000, large = 4000000, largest = 16000000;
  std::size_t set = 100;
  std::size_t call = 1000;
};

constexpr const char* kUniform = "uniform";
constexpr const char* kOneThread = ", 1 thread";

/// Everything that is measured, beside each other but for the largest input: that would empty every cache and
/// take most of the memory, so it is measured only beside the one that its growth is over.
struct Inputs {
  Inputs(const Sizes& sizes, bool without_largest)
      : base(make_inputs(kPaperDistributions, {sizes.base})),
        large(make_inputs(kPaperDistributions, {sizes.large})),
        alone(make_inputs(kDegenerateDistributions, {sizes.base})),
        call(make_inputs({kUniform}, {sizes.call})) {
    alone.push_back(equal_sets(sizes.base / sizes.set, sizes.set));
    if (!without_largest) growth = make_inputs({kUniform}, {sizes.base, sizes.largest});
  }
  std::vector<Input> base, large, alone, call, growth;
};

/// The greatest of the paper's distributions.
double memory_per_point(const std::vector<Input>& inputs, const std::string& mode,
                        const std::string& device) {
  DeviceMemory memory(device);
  double most = 0;
  for (const Input& input : inputs) {
    const auto peak = static_cast<double>(memory.peak(input, options_of(mode)));
    most = std::max(most, peak / static_cast<double>(input.n));
  }
  return most;
}

/// The slowest distribution's time over the fastest one's.
std::optional<double> spread_of(const Entries& entries, const std::string& name, std::size_t n) {
  std::optional<double> slowest, fastest;
  for (const std::string& distribution : kPaperDistributions) {
    const auto own = median_of(entries, name, distribution, n);
    if (!own) return {};
    slowest = std::max(slowest.value_or(*own), *own);
    fastest = std::min(fastest.value_or(*own), *own);
  }
  return ratio(slowest, fastest);
}

/// The targets of one implementation.
void add_targets_of(Json& targets, const std::string& name, const Sizes& sizes, const Entries& entries,
                    const Entries& growth, const Input& sets, double bytes_per_point) {
  const auto seconds = [&](const std::string& distribution, std::size_t n) {
    return median_of(entries, name, distribution, n);
  };
  const auto add = [&](const std::string& what, double at_least, double goal,
                       const std::optional<double>& measured) {
    targets.push_back(target(what, name, at_least, goal, measured));
  };
  const auto n_log_n = [](std::size_t n) { return static_cast<double>(n) * std::log2(n); };
  const std::string base = thousands(sizes.base), largest = thousands(sizes.largest);
  const auto uniform = seconds(kUniform, sizes.base);

  for (const std::size_t n : {sizes.base, sizes.large}) {
    for (const std::string& distribution : kPaperDistributions) {
      add(fmt::format("CGAL's time / ours, {} {}", thousands(n), distribution), 3.5, 5,
          ratio(median_of(entries, kCgal, distribution, n), seconds(distribution, n)));
    }
  }
  add(fmt::format("CGAL's time / ours, {} uniform", largest), 3.5, 5,
      ratio(median_of(growth, kCgal, kUniform, sizes.largest),
            median_of(growth, name, kUniform, sizes.largest)));
  for (const std::string& distribution : kPaperDistributions) {
    const auto on_one_core = median_of(entries, name + kOneThread, distribution, sizes.base);
    if (!on_one_core) continue;
    add(fmt::format("CGAL's time / ours on one core, {} {}", base, distribution), 2, 2.5,
        ratio(median_of(entries, kCgal, distribution, sizes.base), on_one_core));
  }
  for (const std::size_t n : {sizes.base, sizes.large}) {
    add("slowest / fastest distribution, " + thousands(n), 1.3, 1.15, spread_of(entries, name, n));
  }
  add(fmt::format("growth {} to {} uniform / n log n", base, largest), 1.25, 1.1,
      ratio(ratio(median_of(growth, name, kUniform, sizes.largest),
                  median_of(growth, name, kUniform, sizes.base)),
            n_log_n(sizes.largest) / n_log_n(sizes.base)));
  add(fmt::format("{} in one call / one set of {}", sets.distribution, base), 1.0, 0.7,
      ratio(seconds(sets.distribution, sets.n), uniform));
  add(fmt::format("one call with {} points, warm, ms", sizes.call), 3, 1,
      ratio(seconds(kUniform, sizes.call), 1e-3));
  add("device memory, bytes per point, " + base, 200, 140, bytes_per_point);
  for (const std::string& distribution : kDegenerateDistributions) {
    // Its points are exactly cocircular, by tens of thousands.
    const double goal = distribution == "integer-circle" ? 1.2 : 1.1;
    add(fmt::format("{} / uniform, {}", distribution, base), 1.5, goal,
        ratio(seconds(distribution, sizes.base), uniform));
  }
}

/// A triangulator on one thread. Only the host has one: other devices' threads are those of the process.
std::unique_ptr<Triangulator> on_one_thread(const Triangulator& like) {
  if (like.device().name != "host") return nullptr;
  const WithVariable threads("FLAUNAY_THREADS", "1");
  return std::make_unique<Triangulator>("host");
}

Result measure_targets(const TargetsRequest& request) {
  const Sizes sizes = request.quick ? Sizes{2000, 4000, 8000, 100, 200} : Sizes{};
  const Inputs inputs(sizes, request.without_largest);
  Result result;
  Entries most, growth;
  {
    Triangulator triangulator(request.device);
    result.device = triangulator.device();
    const Implementations own = mode_implementations(triangulator, request.modes);
    Implementations all = own;
    append(all, peer_implementations({kCgal}));
    const bool has_host_mode = std::count(request.modes.begin(), request.modes.end(), "blocks") > 0;
    const std::unique_ptr<Triangulator> single = has_host_mode ? on_one_thread(triangulator) : nullptr;
    Implementations with_single = all;
    if (single) {
      const std::string name = implementation_name("blocks") + kOneThread;
      with_single.push_back(mode_implementation(*single, name, options_of("blocks")));
    }
    most = make_entries(with_single, inputs.base);
    append(most, make_entries(all, inputs.large));
    append(most, make_entries(own, inputs.alone));
    append(most, make_entries(all, inputs.call));
    measure(most, request.runs);
  }
  if (!request.without_largest) {
    Triangulator triangulator(request.device);
    growth = make_entries(modes_and_cgal(triangulator, request.modes), inputs.growth);
    measure(growth, request.runs);
  }
  add_entries(result, most);
  add_entries(result, growth);
  for (const std::string& mode : request.modes) {
    add_targets_of(result.tables["targets"], implementation_name(mode), sizes, most, growth,
                   inputs.alone.back(), memory_per_point(inputs.base, mode, request.device));
  }
  return result;
}

const Subcommand kSubcommand("targets", "all targets of speed and memory: at least, goal, measured",
                             "Times are from points in memory to triangles and neighbours in memory, CGAL's "
                             "too; medians of runs in turns, "
                             "the first of each not counted; what is over soon is repeated within a run. "
                             "Memory is the greatest over the "
                             "paper's distributions, with a triangulator that has held nothing larger. The "
                             "exit code is 1 if numbers of "
                             "triangles differ from CGAL's; a missed target does not change it.",
                             measure_targets, [](Options& options, TargetsRequest& request) {
                               options.modes()
                                   .quick("a few thousand points")
                                   .flag("--without-largest", request.without_largest,
                                         "leave 16M points, and so growth, out")
                                   .runs();
                             });

}  // namespace
}  // namespace flaunay::bench::targets
