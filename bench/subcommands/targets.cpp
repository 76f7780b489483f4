// flaunay-bench targets: everything the project promises of its speed and memory, measured in one run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/measuring/command.hpp"
#include "bench/measuring/processes.hpp"
#include "bench/measuring/triangulators.hpp"

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

/// The slowest distribution's time over the fastest one's.
std::optional<double> spread_of(const Jobs& jobs, const std::string& name, std::size_t n) {
  std::vector<std::optional<double>> medians;
  for (const std::string& distribution : kPaperDistributions) {
    medians.push_back(median_of(jobs, {{"implementation", name}, {"distribution", distribution}, {"n", n}}));
  }
  // Nothing is less than any time.
  const auto [fastest, slowest] = std::minmax_element(medians.begin(), medians.end());
  return ratio(*slowest, *fastest);
}

/// The targets of one implementation.
void add_targets_of(Json& targets, const std::string& name, const Sizes& sizes, const Jobs& jobs,
                    const Jobs& growth, const Input& sets, double bytes_per_point) {
  const auto median = [](const Jobs& of, const std::string& implementation, const std::string& distribution,
                         std::size_t n) {
    return median_of(of, {{"implementation", implementation}, {"distribution", distribution}, {"n", n}});
  };
  const auto seconds = [&](const std::string& distribution, std::size_t n) {
    return median(jobs, name, distribution, n);
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
          ratio(median(jobs, kCgal, distribution, n), seconds(distribution, n)));
    }
  }
  add(fmt::format("CGAL's time / ours, {} uniform", largest), 3.5, 5,
      ratio(median(growth, kCgal, kUniform, sizes.largest), median(growth, name, kUniform, sizes.largest)));
  for (const std::string& distribution : kPaperDistributions) {
    const auto on_one_core = median(jobs, name + kOneThread, distribution, sizes.base);
    if (!on_one_core) continue;
    add(fmt::format("CGAL's time / ours on one core, {} {}", base, distribution), 2, 2.5,
        ratio(median(jobs, kCgal, distribution, sizes.base), on_one_core));
  }
  for (const std::size_t n : {sizes.base, sizes.large}) {
    add("slowest / fastest distribution, " + thousands(n), 1.3, 1.15, spread_of(jobs, name, n));
  }
  add(fmt::format("growth {} to {} uniform / n log n", base, largest), 1.25, 1.1,
      ratio(ratio(median(growth, name, kUniform, sizes.largest), median(growth, name, kUniform, sizes.base)),
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

Result measure_targets(const TargetsRequest& request) {
  const Sizes sizes = request.quick ? Sizes{2000, 4000, 8000, 100, 200} : Sizes{};
  const std::vector<Input> base = make_inputs(kPaperDistributions, {sizes.base}),
                           large = make_inputs(kPaperDistributions, {sizes.large}),
                           call = make_inputs({kUniform}, {sizes.call});
  std::vector<Input> alone = make_inputs(kDegenerateDistributions, {sizes.base}), growing;
  alone.push_back(equal_sets(sizes.base / sizes.set, sizes.set));
  Triangulator triangulator(request.device);
  const Implementations own = mode_implementations(triangulator, request.modes);
  Implementations all = own;
  append(all, peer_implementations({kCgal}));
  Implementations with_single = all;
  std::optional<Triangulator> single;
  // Only the host has threads of its own: other devices use the threads of the process.
  if (std::count(request.modes.begin(), request.modes.end(), "blocks") > 0 &&
      triangulator.device().name == "host") {
    single = triangulator_with("FLAUNAY_THREADS", "1", "host");
    const std::string name = implementation_name("blocks") + kOneThread;
    with_single.push_back(mode_implementation(*single, name, options_of("blocks")));
  }
  // Everything beside each other but for the largest input: that would empty every cache and take most of the
  // memory, so it is measured only beside the one that its growth is over.
  Jobs jobs = make_jobs(with_single, base), growth;
  append(jobs, make_jobs(all, large));
  append(jobs, make_jobs(own, alone));
  append(jobs, make_jobs(all, call));
  measure(jobs, request.runs, 0);
  measure_device_memory(jobs, request.device);
  if (!request.without_largest) {
    growing = make_inputs({kUniform}, {sizes.base, sizes.largest});
    growth = make_jobs(all, growing);
    measure(growth, request.runs, 0);
  }
  Result result(triangulator.device());
  add_rows(result, jobs);
  add_rows(result, growth);
  for (const std::string& mode : request.modes) {
    double bytes_per_point = 0;
    for (const Job& job : jobs) {
      const bool is_own = job.row["implementation"] == implementation_name(mode),
                 is_base = job.input >= base.data() && job.input < base.data() + base.size();
      if (is_own && is_base)
        bytes_per_point = std::max(bytes_per_point, job.details.value("bytes_per_point", 0.0));
    }
    add_targets_of(result.tables["targets"], implementation_name(mode), sizes, jobs, growth, alone.back(),
                   bytes_per_point);
  }
  return result;
}

const Subcommand kSubcommand(
    "targets", "all targets of speed and memory: at least, goal, measured",
    R"(Times are from points in memory to triangles and neighbours in memory, CGAL's too. Memory is the greatest over
the paper's distributions, with a triangulator that has held nothing before.)",
    measure_targets, [](Options& options, TargetsRequest& request) {
      options.modes()
          .quick("a few thousand points")
          .flag("--without-largest", request.without_largest, "leave 16M points, and so growth, out")
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::targets
