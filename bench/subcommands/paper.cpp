// flaunay-bench paper: the experiments of Blelloch, Miller and Talmor (1996), made again. Counts operations;
// bench/plot.py sets the paper's claims beside them and draws the figures.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <mutex>
#include <thread>

#include "bench/measuring/calls.hpp"
#include "bench/measuring/timing.hpp"

namespace flaunay::bench::paper {
namespace {

using research::Component;
using research::Cut;

/// Exponents of two, and host threads; `runs` is the number of point sets of each distribution and size.
struct PaperRequest : Request {
  int smallest = 10, largest = 17;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
};

/// How a set of points is triangulated.
struct Method {
  std::string algorithm;  ///< "dwyer", or the hull that computes the dividing paths
  Cut cut;
  bool at_all_sizes = false;  ///< if not, at the largest only
  bool by_level = false;      ///< whether the record has it level by level
};

/// Dwyer's algorithm is the first, because all others are set beside it.
const std::vector<Method> kMethods = {
    {"dwyer", Cut::alternate, true},          {"quickhull", Cut::interquartile},
    {"balanced", Cut::interquartile},         {"prune", Cut::interquartile, true, true},
    {"monotone-chain", Cut::interquartile},   {"quickhull", Cut::alternate},
    {"balanced", Cut::alternate, true, true}, {"prune", Cut::alternate, false, true},
};
constexpr std::size_t kDefaultMethod = 3;

bool is_measured(const Method& method, std::size_t n, const PaperRequest& request) {
  return method.at_all_sizes || n == std::size_t{1} << request.largest;
}

research::Options options_of(const Method& method) {
  const bool dwyer = method.algorithm == "dwyer";
  research::Options options = bench::options_of(dwyer ? "dwyer" : "recursive");
  if (!dwyer) options.hull = hull_named(method.algorithm);
  options.count = true;
  options.neighbors = false;
  options.cut = method.cut;
  return options;
}

/// One method on one set of points.
struct Run {
  research::Work work;
  std::vector<research::LevelStatistics> levels;
};

/// The runs of all methods on one set of points.
using Runs = std::vector<Run>;

// ---- Quantities of a run

double operations(const research::Work::Components& components) {
  return static_cast<double>(total(components).operations());
}

/// Comparisons before the first cut, which bring the points in order.
double sorting(const Run& run) {
  return static_cast<double>(run.work.start[static_cast<std::size_t>(Component::cut)].operations());
}

/// Operations of what precedes the first cut and of so many levels.
double operations_until(const Run& run, std::size_t levels) {
  double sum = operations(run.work.start);
  for (std::size_t l = 0; l < std::min(levels, run.work.levels.size()); ++l) {
    sum += operations(run.work.levels[l]);
  }
  return sum;
}

/// Levels until there are as many regions as a coarse partition would have; all if there never are.
std::size_t coarse_levels(const Run& run) {
  constexpr std::size_t kCoarseRegions = 16;
  std::size_t level = 0;
  while (level < run.levels.size() && run.levels[level].regions < kCoarseRegions) ++level;
  return level;
}

/// Zero where a run has no such level.
double largest_region(const Run& run, std::size_t level) {
  return level < run.levels.size() ? static_cast<double>(run.levels[level].largest_region) : 0;
}

double region_sizes(const Run& run, std::size_t level) {
  if (level >= run.levels.size()) return 0;
  return static_cast<double>(run.levels[level].internal_points + run.levels[level].corners);
}

using Quantities = std::vector<std::pair<const char*, double>>;

/// What a run of n points took by level.
Quantities quantities_by_level(const Run& run, double of_dwyer, double n) {
  double most_corners = 0, worst_decline = 0;
  for (std::size_t l = 0; l < run.levels.size(); ++l) {
    most_corners = std::max(most_corners, static_cast<double>(run.levels[l].corners));
    if (l > 0) worst_decline = std::max(worst_decline, largest_region(run, l) / largest_region(run, l - 1));
  }
  const std::size_t last = std::max<std::size_t>(run.levels.size(), 1) - 1, coarse = coarse_levels(run);
  const double decline = last == 0 ? 1 : largest_region(run, last) / largest_region(run, 0);
  const double until_coarse = operations_until(run, coarse);
  return {
      {"sorting_over_dwyer", sorting(run) / of_dwyer},
      {"coarse_levels", static_cast<double>(coarse)},
      {"coarse_over_dwyer", until_coarse / of_dwyer},
      {"coarse_unsorted_over_dwyer", (until_coarse - sorting(run)) / of_dwyer},
      {"most_corners_per_point", most_corners / n},
      {"largest_endgame", static_cast<double>(std::max<std::size_t>(run.work.endgame_sizes.size(), 1) - 1)},
      // By what the largest region shrinks from level to level, at worst and as a geometric mean.
      {"worst_decline", worst_decline},
      {"mean_decline", std::pow(decline, 1 / static_cast<double>(std::max<std::size_t>(last, 1)))}};
}

/// All that is said of a run of n points, beside Dwyer's algorithm on the same ones.
Quantities quantities_of(const Run& run, const Run& dwyer, double n, bool is_largest, bool by_level) {
  const research::Work::Components components = totals(run.work);
  const double all = operations(components), of_dwyer = operations(totals(dwyer.work));
  const auto depth = static_cast<double>(total(components).critical_path);
  Quantities quantities = {{"operations_per_point", all / n},
                           {"over_dwyer", all / of_dwyer},
                           {"depth", depth},
                           {"parallelism", all / depth}};
  if (!is_largest) return quantities;
  const auto per_point = [&](Component component, double without = 0) {
    return (static_cast<double>(components[static_cast<std::size_t>(component)].operations()) - without) / n;
  };
  append(quantities, {{"sorting", sorting(run) / n},
                      {"cuts", per_point(Component::cut, sorting(run))},
                      {"hull", per_point(Component::hull)},
                      {"merge", per_point(Component::merge)},
                      {"split", per_point(Component::split)},
                      {"endgame", per_point(Component::endgame)}});
  if (by_level) append(quantities, quantities_by_level(run, of_dwyer, n));
  return quantities;
}

// ---- Rows

/// All instances of a distribution and size.
struct Inputs {
  std::string distribution;
  std::size_t n;
  std::vector<Runs> instances;

  Json identity(std::size_t method) const {
    const bool alternate = kMethods[method].cut == Cut::alternate;
    return {{"distribution", distribution},
            {"n", n},
            {"algorithm", kMethods[method].algorithm},
            {"cut", alternate ? "alternate" : "interquartile"}};
  }
  /// Of each quantity the median of the instances, the minimum and the maximum.
  Json row(std::size_t method, bool is_largest) const {
    std::vector<Quantities> all;
    for (const Runs& runs : instances) {
      const bool by_level = kMethods[method].by_level;
      all.push_back(quantities_of(runs[method], runs[0], static_cast<double>(n), is_largest, by_level));
    }
    Json result = identity(method);
    for (std::size_t q = 0; q < all[0].size(); ++q) {
      std::vector<double> values;
      for (const Quantities& of_instance : all) values.push_back(of_instance[q].second);
      const Summary of_all = summary(values);
      result[all[0][q].first] = {of_all.median, of_all.low, of_all.high};
    }
    return result;
  }
};

/// Medians, level by level: what was done before the level, and the regions that are cut at it.
Json levels_row(const Inputs& inputs, std::size_t method) {
  std::size_t most = 0;
  for (const Runs& runs : inputs.instances) most = std::max(most, runs[method].work.levels.size());
  Json row = inputs.identity(method);
  for (std::size_t level = 0; level <= most; ++level) {
    const auto add = [&](const char* name, const auto& quantity) {
      std::vector<double> values;
      for (const Runs& runs : inputs.instances) values.push_back(quantity(runs[method], runs[0]));
      row[name].push_back(summary(values).median);
    };
    add("work_before_over_dwyer", [level](const Run& run, const Run& dwyer) {
      return operations_until(run, level) / operations(totals(dwyer.work));
    });
    if (level == most) break;
    add("largest_region", [level](const Run& run, const Run&) { return largest_region(run, level); });
    add("region_sizes_per_point", [level, n = static_cast<double>(inputs.n)](const Run& run, const Run&) {
      return region_sizes(run, level) / n;
    });
  }
  return row;
}

/// How many regions have how many corners when the end game begins, all instances together.
Json endgame_row(const Inputs& inputs, std::size_t method) {
  std::vector<std::uint64_t> histogram;
  for (const Runs& runs : inputs.instances) {
    const std::vector<std::uint64_t>& sizes = runs[method].work.endgame_sizes;
    histogram.resize(std::max(histogram.size(), sizes.size()));
    for (std::size_t k = 0; k < sizes.size(); ++k) histogram[k] += sizes[k];
  }
  Json row = inputs.identity(method);
  row["corners"] = Json::array();
  row["regions"] = Json::array();
  for (std::size_t k = 0; k < histogram.size(); ++k) {
    if (histogram[k] == 0) continue;
    row["corners"].push_back(k);
    row["regions"].push_back(histogram[k]);
  }
  return row;
}

// ---- The kernels beside the twin

/// The kernels' operations on one input relative to those of the recursive twin. Sorting is left out, because
/// devices sort by radix.
Json cross_check_row(Triangulator& triangulator, const std::string& distribution, std::size_t n) {
  const auto unsorted = [](research::Work work) {
    work.start[static_cast<std::size_t>(Component::cut)] = {};
    return totals(work);
  };
  const auto ratio_of = [](const research::OperationCounts& a, const research::OperationCounts& b) {
    return b.operations() == 0 ? 1
                               : static_cast<double>(a.operations()) / static_cast<double>(b.operations());
  };
  const Input input = make_input(distribution, n);
  const research::Options of_twin = options_of(kMethods[kDefaultMethod]);
  research::Options of_kernels = of_twin;
  of_kernels.mode = research::Mode::flattened;
  of_kernels.finish = research::Finish::levels;
  const auto kernels = unsorted(call(triangulator, input, of_kernels).work);
  const auto twin = unsorted(call_on_host(input, of_twin).work);
  Json row{{"distribution", distribution}, {"n", n}, {"all", ratio_of(total(kernels), total(twin))}};
  for (std::size_t c = 0; c < research::kComponents; ++c) {
    row[component_name(c)] = ratio_of(kernels[c], twin[c]);
  }
  return row;
}

// ---- The experiment

/// Triangulates everything on several threads, the largest inputs first, so that no thread begins a long one
/// when the others have ended.
std::vector<Inputs> triangulate_all(const PaperRequest& request) {
  const auto instances = static_cast<std::size_t>(request.runs);
  std::vector<Inputs> all;
  for (const std::size_t n : powers_of_two(request.smallest, request.largest)) {
    for (const std::string& distribution : kPaperDistributions) {
      all.push_back({distribution, n, std::vector<Runs>(instances)});
    }
  }
  const std::size_t count = all.size() * instances;
  Progress progress(count);
  std::mutex progress_mutex;
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) {
      Inputs& inputs = all[(count - 1 - k) / instances];
      const std::size_t instance = k % instances;
      {
        const std::lock_guard<std::mutex> lock(progress_mutex);
        progress.step(fmt::format("{}, {} points, instance {}", inputs.distribution, inputs.n, instance + 1));
      }
      const Input input = make_input(inputs.distribution, inputs.n, instance + 1);
      for (const Method& method : kMethods) {
        Run& run = inputs.instances[instance].emplace_back();
        if (!is_measured(method, inputs.n, request)) continue;
        research::Triangulation mesh = call_on_host(input, options_of(method));
        run = {std::move(mesh.work), std::move(mesh.levels)};
      }
    }
  };
  std::vector<std::future<void>> threads;
  for (unsigned t = 0; t < request.threads; ++t) threads.push_back(std::async(std::launch::async, work));
  for (std::future<void>& thread : threads) thread.get();
  return all;
}

Result measure_paper(const PaperRequest& request) {
  constexpr int kCheckedExponent = 14;
  if (request.smallest > request.largest) {
    throw Error(ErrorKind::usage, "--smallest is greater than --largest");
  }
  const std::vector<Inputs> all = triangulate_all(request);
  Result result({}, {"results", "levels", "endgame", "cross_check"});
  Json& tables = result.tables;
  for (const Inputs& inputs : all) {
    const bool largest = inputs.n == std::size_t{1} << request.largest;
    for (std::size_t m = 0; m < kMethods.size(); ++m) {
      if (!is_measured(kMethods[m], inputs.n, request)) continue;
      tables["results"].push_back(inputs.row(m, largest));
      if (!largest || !kMethods[m].by_level) continue;
      tables["levels"].push_back(levels_row(inputs, m));
      // The regions depend on the cuts alone.
      if (kMethods[m].algorithm == kMethods[kDefaultMethod].algorithm) {
        tables["endgame"].push_back(endgame_row(inputs, m));
      }
    }
  }
  try {
    Triangulator triangulator(request.device);
    result.device = triangulator.device();
    const int exponent = std::max(request.smallest, std::min(request.largest, kCheckedExponent));
    for (const std::string& distribution : kPaperDistributions) {
      tables["cross_check"].push_back(
          cross_check_row(triangulator, distribution, std::size_t{1} << exponent));
    }
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::device || !request.device.empty()) throw;
    fmt::print(stderr, "the kernels are not checked against the twin: {}\n", error.what());
  }
  return result;
}

const Subcommand kSubcommand(
    "paper", "the experiments of Blelloch, Miller and Talmor (1996), made again",
    "Counts operations in the recursive twin and in Dwyer's algorithm, both on the host, on the paper's four "
    "distributions at every power of two from the smallest to the largest (variants that the paper has not, "
    "at "
    "the largest only). bench/plot.py RECORD.json -o FILE.md sets the paper's claims beside what was "
    "measured, "
    "and draws the figures. The kernels are checked against the twin once, if there is a device.",
    measure_paper, [](Options& options, PaperRequest& request) {
      const CLI::Range exponents(6, 24);
      options.add("--instances", request.runs, "point sets of each distribution and size")
          .add("--smallest", request.smallest, "least number of points, as a power of two", exponents)
          .add("--largest", request.largest, "greatest number of points, as a power of two", exponents)
          .add("--threads", request.threads, "host threads");
    });

}  // namespace
}  // namespace flaunay::bench::paper
