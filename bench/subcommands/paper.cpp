// flaunay-bench paper: the experiments of Blelloch, Miller and Talmor (1996), made again. Counts operations;
// bench/plot.py sets the paper's claims beside them and draws the figures.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <map>
#include <mutex>
#include <thread>

#include "bench/measuring/command.hpp"
#include "bench/measuring/triangulators.hpp"

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
  research::Options options =
      dwyer ? bench::options_of("dwyer") : bench::options_of("recursive", method.algorithm);
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

research::Triangulation call_on_host(const Input& input, const research::Options& options) {
  return research::triangulate_on_host(input.coordinates.data(), input.offsets, options);
}

// ---- Quantities of a run

/// Sums over the work before the first cut and all levels, by component.
research::Work::Components totals(const research::Work& work) {
  research::Work::Components sums = work.start;
  for (const research::Work::Components& level : work.levels) {
    for (std::size_t c = 0; c < research::kComponents; ++c) sums[c] += level[c];
  }
  return sums;
}

research::OperationCounts total(const research::Work::Components& components) {
  research::OperationCounts sum;
  for (const research::OperationCounts& counts : components) sum += counts;
  return sum;
}

double operations(const research::Work::Components& components) {
  return static_cast<double>(total(components).operations());
}

double operations_of(const research::Work::Components& components, Component component) {
  return static_cast<double>(components[static_cast<std::size_t>(component)].operations());
}

/// Comparisons before the first cut, which bring the points in order.
double sorting(const Run& run) { return operations_of(run.work.start, Component::cut); }

/// The operations before the first cut and in this many levels.
double operations_until(const Run& run, std::size_t levels) {
  double sum = operations(run.work.start);
  for (std::size_t l = 0; l < std::min(levels, run.work.levels.size()); ++l) {
    sum += operations(run.work.levels[l]);
  }
  return sum;
}

/// Zeros where a run has no such level.
research::LevelStatistics level_of(const Run& run, std::size_t level) {
  return level < run.levels.size() ? run.levels[level] : research::LevelStatistics{};
}

double largest_region(const Run& run, std::size_t level) {
  return static_cast<double>(level_of(run, level).largest_region);
}

/// Quantities of a run that depend on levels.
Json quantities_by_level(const Run& run, double of_dwyer) {
  // Levels until there are as many regions as a coarse partition would have; all if there never are.
  constexpr std::size_t kCoarseRegions = 16;
  std::size_t coarse = 0;
  while (coarse < run.levels.size() && run.levels[coarse].regions < kCoarseRegions) ++coarse;
  double worst_decline = 0;
  for (std::size_t l = 1; l < run.levels.size(); ++l) {
    worst_decline = std::max(worst_decline, largest_region(run, l) / largest_region(run, l - 1));
  }
  const std::size_t last = std::max<std::size_t>(run.levels.size(), 1) - 1;
  const double decline = last == 0 ? 1 : largest_region(run, last) / largest_region(run, 0);
  return {{"sorting_over_dwyer", sorting(run) / of_dwyer},
          {"coarse_levels", static_cast<double>(coarse)},
          {"coarse_unsorted_over_dwyer", (operations_until(run, coarse) - sorting(run)) / of_dwyer},
          // The factor by which the largest region shrinks per level: the worst one and the geometric mean.
          {"worst_decline", worst_decline},
          {"mean_decline", std::pow(decline, 1 / static_cast<double>(std::max<std::size_t>(last, 1)))}};
}

/// All that is said of a run of n points, beside Dwyer's algorithm on the same ones.
Json quantities_of(const Run& run, const Run& dwyer, double n, bool is_largest, bool by_level) {
  const research::Work::Components components = totals(run.work);
  const double all = operations(components), of_dwyer = operations(totals(dwyer.work));
  const auto depth = static_cast<double>(total(components).critical_path);
  Json quantities{{"operations_per_point", all / n},
                  {"over_dwyer", all / of_dwyer},
                  {"depth", depth},
                  {"parallelism", all / depth}};
  if (!is_largest) return quantities;
  quantities.update({{"sorting", sorting(run) / n},
                     {"cuts", (operations_of(components, Component::cut) - sorting(run)) / n},
                     {"hull", operations_of(components, Component::hull) / n},
                     {"merge", operations_of(components, Component::merge) / n},
                     {"split", operations_of(components, Component::split) / n},
                     {"endgame", operations_of(components, Component::endgame) / n}});
  return by_level ? changed(quantities, quantities_by_level(run, of_dwyer)) : quantities;
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
  /// Summarises quantity(run, Dwyer's run) over the instances.
  template <typename Quantity>
  Summary summary_of(std::size_t method, const Quantity& quantity) const {
    std::vector<double> values;
    for (const Runs& runs : instances) values.push_back(quantity(runs[method], runs[0]));
    return summary(values);
  }
  /// The median, minimum and maximum of each quantity over the instances.
  Json row(std::size_t method, bool is_largest) const {
    const auto all_of = [&](const Run& run, const Run& dwyer) {
      return quantities_of(run, dwyer, static_cast<double>(n), is_largest, kMethods[method].by_level);
    };
    Json result = identity(method);
    const Json first = all_of(instances[0][method], instances[0][0]);
    for (const auto& [key, value] : first.items()) {
      const Summary of_all = summary_of(
          method, [&, &name = key](const Run& run, const Run& dwyer) { return all_of(run, dwyer)[name]; });
      result[key] = {of_all.median, of_all.low, of_all.high};
    }
    return result;
  }
};

/// Medians, level by level: the work before the level, and the regions that are cut at it.
Json levels_row(const Inputs& inputs, std::size_t method) {
  std::size_t most = 0;
  for (const Runs& runs : inputs.instances) most = std::max(most, runs[method].work.levels.size());
  Json row = inputs.identity(method);
  for (std::size_t level = 0; level <= most; ++level) {
    const auto add = [&](const char* name, const auto& quantity) {
      row[name].push_back(inputs.summary_of(method, quantity).median);
    };
    add("work_before_over_dwyer", [level](const Run& run, const Run& dwyer) {
      return operations_until(run, level) / operations(totals(dwyer.work));
    });
    if (level == most) break;
    add("largest_region", [level](const Run& run, const Run&) { return largest_region(run, level); });
    add("region_sizes_per_point", [level, n = static_cast<double>(inputs.n)](const Run& run, const Run&) {
      const research::LevelStatistics of_level = level_of(run, level);
      return static_cast<double>(of_level.internal_points + of_level.corners) / n;
    });
  }
  return row;
}

/// How many regions have how many corners when the end game begins, all instances together.
Json endgame_row(const Inputs& inputs, std::size_t method) {
  std::map<std::size_t, std::uint64_t> regions;  // by corners
  for (const Runs& runs : inputs.instances) {
    const std::vector<std::uint64_t>& sizes = runs[method].work.endgame_sizes;
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      if (sizes[k] > 0) regions[k] += sizes[k];
    }
  }
  Json row = inputs.identity(method);
  for (const auto& [corners, count] : regions) {
    row["corners"].push_back(corners);
    row["regions"].push_back(count);
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
  if (request.smallest > request.largest) {
    throw Error(ErrorKind::usage, "--smallest is greater than --largest");
  }
  const std::vector<Inputs> all = triangulate_all(request);
  Result result;
  Json& tables = result.tables;
  for (const char* table : {"results", "levels", "endgame"}) tables[table] = Json::array();
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
  return result;
}

const Subcommand kSubcommand(
    "paper", "the experiments of Blelloch, Miller and Talmor (1996), made again",
    R"(Counts operations in the recursive twin and in Dwyer's algorithm, both on the host, on the paper's four
distributions at every power of two from the smallest to the largest (variants that the paper has not, at the largest
only). bench/plot.py RECORD.json -o FILE.md sets the paper's claims beside what was measured, and draws the figures.
tests/statistics/work_test.cpp holds the kernels' counts to the twin's.)",
    measure_paper, [](Options& options, PaperRequest& request) {
      const CLI::Range exponents(6, 24);
      options.add("--instances", request.runs, "point sets of each distribution and size")
          .add("--smallest", request.smallest, "least number of points, as a power of two", exponents)
          .add("--largest", request.largest, "greatest number of points, as a power of two", exponents)
          .add("--threads", request.threads, "host threads");
    });

}  // namespace
}  // namespace flaunay::bench::paper
