// The runs of flaunay-bench paper, and the quantities that its figures and claims are made of.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "timing.hpp"

namespace flaunay::bench::paper {

/// How a set of points is triangulated.
struct Method {
  std::string algorithm;  ///< "dwyer", or what the dividing paths are computed by
  Cut cut;
};

/// flaunay as it is, the algorithm as the paper has it, and the sequential rival.
inline const Method kDefault{"prune", Cut::interquartile};
inline const Method kPublished{"balanced", Cut::alternate};
inline const Method kDwyer{"dwyer", Cut::alternate};

const std::vector<Method>& methods();

/// "prune, interquartile cuts"; "Dwyer's algorithm"
std::string method_name(const Method& method);
const char* cut_name(Cut cut);

Options options_of(const Method& method);

/// The paper's four distributions.
const std::vector<std::string>& distributions();

/// One method on one instance of a distribution.
struct Run {
  std::string distribution;
  std::size_t n = 0;
  int instance = 0;
  Method method;
  Work work;
  std::vector<LevelStatistics> levels;
};

/// What is measured, and on how many threads.
struct Plan {
  int smallest = 10, largest = 17;  ///< exponents of two
  int instances = 5;
  unsigned threads = 1;
};

/// The same on every machine.
std::vector<double> instance_coordinates(const std::string& distribution, std::size_t n, int instance);

/// All distributions, sizes, instances and methods.
class Experiment {
 public:
  /// Triangulates them all.
  explicit Experiment(const Plan& plan);

  const Plan& plan() const { return plan_; }
  std::vector<std::size_t> sizes() const;
  std::size_t largest() const { return std::size_t{1} << plan_.largest; }
  const std::vector<Run>& runs() const { return runs_; }
  const Run& run(const std::string& distribution, std::size_t n, const Method& method, int instance) const;

 private:
  std::size_t first_run(std::size_t n, std::size_t distribution, int instance) const;
  void triangulate(std::size_t n, std::size_t distribution, int instance);

  Plan plan_;
  std::vector<Run> runs_;
};

/// A number that a run has, given Dwyer's run on the same points.
using Quantity = std::function<double(const Run& run, const Run& dwyer)>;

/// Over all instances.
Summary summarize(const Experiment& experiment, const std::string& distribution, std::size_t n,
                  const Method& method, const Quantity& quantity);

/// The median for each distribution.
std::vector<double> medians(const Experiment& experiment, std::size_t n, const Method& method,
                            const Quantity& quantity);

// ---- Quantities

constexpr std::size_t at(Component component) { return static_cast<std::size_t>(component); }
const char* component_name(std::size_t component);

/// All levels and what precedes them, by component; paths of levels add up.
Work::Components totals(const Work& work);
OperationCounts total(const Work::Components& components);

double operations(const Run& run);
double critical_path(const Run& run);
double component_operations(const Run& run, Component component);
/// Comparisons made before the first cut to have the points in order.
double sorting_operations(const Run& run);

double operations_per_point(const Run& run, const Run& dwyer);
double work_ratio(const Run& run, const Run& dwyer);
double parallelism(const Run& run, const Run& dwyer);

/// Operations of what precedes the first cut and of so many levels.
double operations_until(const Run& run, std::size_t levels);
/// How many levels it takes until there are so many regions; all of them if there never are.
std::size_t levels_until_regions(const Run& run, std::size_t regions);
/// As many as a coarse partition would have: operations until then relative to Dwyer's total, with sorting
/// and after it, and the levels that it takes.
constexpr std::size_t kCoarseRegions = 16;
double coarse_work(const Run& run, const Run& dwyer);
double coarse_work_after_sorting(const Run& run, const Run& dwyer);
double coarse_levels(const Run& run, const Run& dwyer);
/// Of the deepest recursion among the instances.
std::size_t most_levels(const Experiment& experiment, const std::string& distribution, std::size_t n,
                        const Method& method);

/// Zero where a run has no such level.
double largest_region(const Run& run, std::size_t level);
/// Internal points and corners of all regions, a point.
double subproblem_sizes(const Run& run, std::size_t level);
/// The greatest of a run's levels.
double most_corners_per_point(const Run& run, const Run& dwyer);

/// Corners of the regions without internal points.
struct EndgameSizes {
  double mean = 0, median = 0, largest = 0;
  double share_over_50 = 0;
};
EndgameSizes endgame_sizes(const std::vector<std::uint64_t>& histogram);
double largest_cycle(const Run& run, const Run& dwyer);
/// All instances in one histogram.
std::vector<std::uint64_t> endgame_histogram(const Experiment& experiment, const std::string& distribution,
                                             std::size_t n, const Method& method);

/// By what the largest region shrinks from level to level.
struct Decline {
  double mean = 1;   ///< geometric
  double worst = 0;  ///< of a single level
};
Decline decline_of_largest_region(const Run& run);

}  // namespace flaunay::bench::paper
