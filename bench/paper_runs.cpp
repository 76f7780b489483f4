#include "paper_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "inputs.hpp"
#include "io/generate.hpp"
#include "recursive/threads.hpp"

namespace flaunay::bench::paper {
namespace {

bool same(const Method& a, const Method& b) { return a.algorithm == b.algorithm && a.cut == b.cut; }

double operations(const Work::Components& components) {
  return static_cast<double>(total(components).operations());
}

}  // namespace

const std::vector<Method>& methods() {
  static const std::vector<Method> kMethods = {{"quickhull", Cut::interquartile},
                                               {"balanced", Cut::interquartile},
                                               kDefault,
                                               {"monotone-chain", Cut::interquartile},
                                               {"quickhull", Cut::alternate},
                                               kPublished,
                                               {"prune", Cut::alternate},
                                               kDwyer};
  return kMethods;
}

const char* cut_name(Cut cut) { return cut == Cut::alternate ? "alternate" : "interquartile"; }

std::string method_name(const Method& method) {
  if (same(method, kDwyer)) return "Dwyer's algorithm";
  return fmt::format("{}, {} cuts", method.algorithm, cut_name(method.cut));
}

Options options_of(const Method& method) {
  Options options;
  options.count = true;
  options.neighbors = false;
  options.cut = method.cut;
  options.mode = same(method, kDwyer) ? Mode::dwyer : Mode::recursive;
  if (options.mode == Mode::recursive) options.hull = hull_named(method.algorithm);
  return options;
}

const std::vector<std::string>& distributions() { return kPaperDistributions; }

std::vector<double> instance_coordinates(const std::string& distribution, std::size_t n, int instance) {
  return io::generate(distribution, n, static_cast<std::uint64_t>(instance) + 1).coordinates;
}

Experiment::Experiment(const Plan& plan) : plan_(plan) {
  const std::vector<std::size_t> all_sizes = sizes();
  const auto instances = static_cast<std::size_t>(plan.instances);
  const std::size_t inputs_of_a_size = distributions().size() * instances;
  const std::size_t inputs = all_sizes.size() * inputs_of_a_size;
  runs_.resize(inputs * methods().size());
  Progress progress(inputs);
  std::mutex progress_mutex;
  recursive::for_each_index(inputs, static_cast<int>(plan.threads), [&](std::size_t index) {
    // Largest first, so that no thread begins a long one when the others have ended.
    const std::size_t n = all_sizes[all_sizes.size() - 1 - index / inputs_of_a_size];
    const std::size_t distribution = index % inputs_of_a_size / instances;
    const auto instance = static_cast<int>(index % instances);
    {
      const std::lock_guard<std::mutex> lock(progress_mutex);
      progress.step(fmt::format("{}, {} points, instance {}, {} methods", distributions()[distribution], n,
                                instance + 1, methods().size()));
    }
    triangulate(n, distribution, instance);
  });
}

std::vector<std::size_t> Experiment::sizes() const {
  std::vector<std::size_t> result;
  for (int power = plan_.smallest; power <= plan_.largest; ++power) result.push_back(std::size_t{1} << power);
  return result;
}

std::size_t Experiment::first_run(std::size_t n, std::size_t distribution, int instance) const {
  std::size_t size = 0;
  while (std::size_t{1} << (plan_.smallest + static_cast<int>(size)) < n) ++size;
  const std::size_t input =
      (size * distributions().size() + distribution) * static_cast<std::size_t>(plan_.instances) +
      static_cast<std::size_t>(instance);
  return input * methods().size();
}

void Experiment::triangulate(std::size_t n, std::size_t distribution, int instance) {
  const std::vector<double> coordinates = instance_coordinates(distributions()[distribution], n, instance);
  for (std::size_t m = 0; m < methods().size(); ++m) {
    const Method& method = methods()[m];
    Statistics statistics = triangulate_on_host(coordinates.data(), {0, n}, options_of(method)).statistics;
    runs_[first_run(n, distribution, instance) + m] = {
        distributions()[distribution], n, instance, method, std::move(statistics.work),
        std::move(statistics.levels)};
  }
}

const Run& Experiment::run(const std::string& distribution, std::size_t n, const Method& method,
                           int instance) const {
  const auto d = std::find(distributions().begin(), distributions().end(), distribution);
  const auto m = std::find_if(methods().begin(), methods().end(),
                              [&](const Method& candidate) { return same(candidate, method); });
  return runs_.at(first_run(n, static_cast<std::size_t>(d - distributions().begin()), instance) +
                  static_cast<std::size_t>(m - methods().begin()));
}

Summary summarize(const Experiment& experiment, const std::string& distribution, std::size_t n,
                  const Method& method, const Quantity& quantity) {
  std::vector<double> values;
  for (int i = 0; i < experiment.plan().instances; ++i) {
    values.push_back(
        quantity(experiment.run(distribution, n, method, i), experiment.run(distribution, n, kDwyer, i)));
  }
  return summary(std::move(values));
}

std::vector<double> medians(const Experiment& experiment, std::size_t n, const Method& method,
                            const Quantity& quantity) {
  std::vector<double> values;
  for (const std::string& distribution : distributions()) {
    values.push_back(summarize(experiment, distribution, n, method, quantity).median);
  }
  return values;
}

const char* component_name(std::size_t component) {
  static const char* const kNames[kComponents] = {"cut", "hull", "merge", "split", "endgame"};
  return kNames[component];
}

Work::Components totals(const Work& work) {
  Work::Components sums = work.start;
  for (const Work::Components& level : work.levels) {
    for (std::size_t c = 0; c < kComponents; ++c) sums[c] += level[c];
  }
  return sums;
}

OperationCounts total(const Work::Components& components) {
  OperationCounts sum;
  for (const OperationCounts& counts : components) sum += counts;
  return sum;
}

double operations(const Run& run) { return operations(totals(run.work)); }

double critical_path(const Run& run) { return static_cast<double>(total(totals(run.work)).critical_path); }

double component_operations(const Run& run, Component component) {
  return static_cast<double>(totals(run.work)[at(component)].operations());
}

double sorting_operations(const Run& run) {
  return static_cast<double>(run.work.start[at(Component::cut)].operations());
}

double operations_per_point(const Run& run, const Run&) {
  return operations(run) / static_cast<double>(run.n);
}

double work_ratio(const Run& run, const Run& dwyer) { return operations(run) / operations(dwyer); }

double parallelism(const Run& run, const Run&) { return operations(run) / critical_path(run); }

double operations_until(const Run& run, std::size_t levels) {
  double sum = operations(run.work.start);
  for (std::size_t l = 0; l < std::min(levels, run.work.levels.size()); ++l) {
    sum += operations(run.work.levels[l]);
  }
  return sum;
}

std::size_t levels_until_regions(const Run& run, std::size_t regions) {
  std::size_t level = 0;
  while (level < run.levels.size() && run.levels[level].regions < regions) ++level;
  return level;
}

double coarse_work(const Run& run, const Run& dwyer) {
  return operations_until(run, levels_until_regions(run, kCoarseRegions)) / operations(dwyer);
}

double coarse_work_after_sorting(const Run& run, const Run& dwyer) {
  return coarse_work(run, dwyer) - sorting_operations(run) / operations(dwyer);
}

double coarse_levels(const Run& run, const Run&) {
  return static_cast<double>(levels_until_regions(run, kCoarseRegions));
}

std::size_t most_levels(const Experiment& experiment, const std::string& distribution, std::size_t n,
                        const Method& method) {
  return static_cast<std::size_t>(
      summarize(experiment, distribution, n, method, [](const Run& run, const Run&) {
        return static_cast<double>(run.work.levels.size());
      }).high);
}

double largest_region(const Run& run, std::size_t level) {
  return level < run.levels.size() ? static_cast<double>(run.levels[level].largest_region) : 0;
}

double subproblem_sizes(const Run& run, std::size_t level) {
  if (level >= run.levels.size()) return 0;
  const LevelStatistics& statistics = run.levels[level];
  return static_cast<double>(statistics.internal_points + statistics.corners) / static_cast<double>(run.n);
}

double most_corners_per_point(const Run& run, const Run&) {
  std::size_t most = 0;
  for (const LevelStatistics& level : run.levels) most = std::max(most, level.corners);
  return static_cast<double>(most) / static_cast<double>(run.n);
}

EndgameSizes endgame_sizes(const std::vector<std::uint64_t>& histogram) {
  double regions = 0, corners = 0, over_50 = 0;
  EndgameSizes sizes;
  for (std::size_t k = 0; k < histogram.size(); ++k) {
    const auto count = static_cast<double>(histogram[k]), size = static_cast<double>(k);
    if (count == 0) continue;
    regions += count;
    corners += count * size;
    if (k > 50) over_50 += count;
    sizes.largest = size;
  }
  if (regions == 0) return sizes;
  sizes.mean = corners / regions;
  sizes.share_over_50 = over_50 / regions;
  double below = 0;
  for (std::size_t k = 0; k < histogram.size() && below < regions / 2; ++k) {
    below += static_cast<double>(histogram[k]);
    sizes.median = static_cast<double>(k);
  }
  return sizes;
}

double largest_cycle(const Run& run, const Run&) { return endgame_sizes(run.work.endgame_sizes).largest; }

std::vector<std::uint64_t> endgame_histogram(const Experiment& experiment, const std::string& distribution,
                                             std::size_t n, const Method& method) {
  std::vector<std::uint64_t> sum;
  for (int i = 0; i < experiment.plan().instances; ++i) {
    const std::vector<std::uint64_t>& one = experiment.run(distribution, n, method, i).work.endgame_sizes;
    sum.resize(std::max(sum.size(), one.size()));
    for (std::size_t k = 0; k < one.size(); ++k) sum[k] += one[k];
  }
  return sum;
}

Decline decline_of_largest_region(const Run& run) {
  Decline decline;
  std::size_t last = 0;
  while (last + 1 < run.levels.size()) {
    ++last;
    decline.worst = std::max(decline.worst, largest_region(run, last) / largest_region(run, last - 1));
  }
  if (last > 0) {
    decline.mean =
        std::pow(largest_region(run, last) / largest_region(run, 0), 1 / static_cast<double>(last));
  }
  return decline;
}

}  // namespace flaunay::bench::paper
