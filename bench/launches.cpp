// flaunay-bench launches: what a call launches, how many work-items that are, and their longest chains of
// steps.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <map>

#include "calls.hpp"
#include "command.hpp"

namespace flaunay::bench::launches {
namespace {

using research::LaunchStatistics;
using research::Record;

struct Request : Measurement {
  std::vector<std::size_t> sizes{1000000};
  std::vector<std::string> distributions{"uniform", "kuzmin", "line"};
  std::vector<std::string> modes{to_string(kDefaultMode)};
  std::string tuning;
  std::size_t most_lines = 200;
};

// The share of the work that is done by the launches of which "work_items_of_most_work" is said.
constexpr double kMostWork = 0.9;

// Kernels whose steps are not those of merges: they walk along hulls.
bool walks_hulls(const std::string& kernel) { return kernel == "mark_outside" || kernel == "write_hulls"; }

// Kernels that merge the parts of blocks, not the blocks.
bool solves_blocks(const std::string& kernel) {
  return kernel == "solve_blocks" || kernel == "merge_parts" || kernel == "finish_parts" ||
         kernel == "walk_seams" || kernel == "finish_walks" || kernel == "sew_seams";
}

/// One call whose kernels counted their steps, and others that were timed.
struct Call {
  std::string mode;
  const Input* input = nullptr;
  Statistics statistics;                   ///< of the last timed call
  std::vector<LaunchStatistics> launches;  ///< with steps, and with the least time of each
  std::vector<double> seconds;             ///< of the timed calls
};

std::size_t steps_of_work_item(const LaunchStatistics& launch) {
  return std::max<std::size_t>(launch.longest_chain, launch.elements);
}

// Steps of merges one after the other, as launches are: from the leaves to the result, or from solved blocks.
std::uint64_t merge_chain(const std::vector<LaunchStatistics>& launches, bool from_leaves) {
  std::uint64_t sum = 0;
  for (const LaunchStatistics& launch : launches) {
    const bool is_left_out = walks_hulls(launch.kernel) || (!from_leaves && solves_blocks(launch.kernel));
    if (!is_left_out) sum += launch.longest_chain;
  }
  return sum;
}

// The time that a launch keeps the device's cores busy. A launch with few work-items leaves some idle.
double core_seconds(const LaunchStatistics& launch, std::size_t units) {
  return launch.seconds * static_cast<double>(std::min(launch.work_items, units));
}

// The largest w such that launches of at least w work-items do most of the work.
std::size_t work_items_of_most_work(std::vector<LaunchStatistics> launches, std::size_t units) {
  std::sort(launches.begin(), launches.end(),
            [](const LaunchStatistics& a, const LaunchStatistics& b) { return a.work_items > b.work_items; });
  double all = 0, done = 0;
  for (const LaunchStatistics& launch : launches) all += core_seconds(launch, units);
  for (const LaunchStatistics& launch : launches) {
    done += core_seconds(launch, units);
    if (done >= kMostWork * all) return launch.work_items;
  }
  return 0;
}

Call measure_call(Triangulator& triangulator, const std::string& mode, const Input& input, int runs) {
  Call result{mode, &input, {}, {}, {}};
  research::Options options = options_of(mode);
  options.record = Record::steps;
  result.launches = call(triangulator, input, options).launches;
  options.record = Record::launches;
  options.profile = true;
  for (int run = -1; run < runs; ++run) {
    research::Triangulation mesh = call(triangulator, input, options);
    if (mesh.launches.size() != result.launches.size()) {
      throw Error(ErrorKind::device, "two calls on the same points had different numbers of launches");
    }
    if (run < 0) continue;
    for (std::size_t k = 0; k < mesh.launches.size(); ++k) {
      double& seconds = result.launches[k].seconds;
      seconds = run == 0 ? mesh.launches[k].seconds : std::min(seconds, mesh.launches[k].seconds);
    }
    result.seconds.push_back(mesh.statistics.seconds);
    result.statistics = std::move(mesh.statistics);
  }
  return result;
}

// ---- Tables

Json identity(const Call& call) {
  return {{"mode", call.mode}, {"distribution", call.input->distribution}, {"n", call.input->n}};
}

Json summary_of(const Call& call, std::size_t units) {
  Json row = identity(call);
  row["kernel_launches"] = call.statistics.kernel_launches;
  row["host_waits"] = call.statistics.host_waits;
  row["bytes_to_device"] = call.statistics.bytes_to_device;
  row["bytes_to_host"] = call.statistics.bytes_to_host;
  row["merge_chain"] = merge_chain(call.launches, true);
  row["merge_chain_above_blocks"] = merge_chain(call.launches, false);
  const auto longest = std::max_element(call.launches.begin(), call.launches.end(),
                                        [](const LaunchStatistics& a, const LaunchStatistics& b) {
                                          return steps_of_work_item(a) < steps_of_work_item(b);
                                        });
  row["longest_chain"] = longest == call.launches.end() ? 0 : steps_of_work_item(*longest);
  row["longest_chain_kernel"] = longest == call.launches.end() ? "" : longest->kernel;
  row["work_items_of_most_work"] = work_items_of_most_work(call.launches, units);
  add_seconds(row, call.seconds);
  return row;
}

void add_launches(Json& rows, const Call& call) {
  for (std::size_t k = 0; k < call.launches.size(); ++k) {
    const LaunchStatistics& launch = call.launches[k];
    rows.push_back(identity(call));
    rows.back().update({{"launch", k},
                        {"kernel", launch.kernel},
                        {"work_items", launch.work_items},
                        {"group", launch.group},
                        {"busy", launch.busy},
                        {"elements", launch.elements},
                        {"bytes", launch.bytes},
                        {"longest_chain", launch.longest_chain},
                        {"steps", launch.steps},
                        {"seconds", launch.seconds}});
  }
}

// All launches of a kernel in one row, the kernels that take most time first.
void add_kernels(Json& rows, const Call& call) {
  struct Sum {
    std::size_t launches = 0, least = 0, most = 0;
    std::uint64_t chain = 0, steps = 0;
    double seconds = 0;
  };
  std::map<std::string, Sum> sums;
  for (const LaunchStatistics& launch : call.launches) {
    Sum& sum = sums[launch.kernel];
    sum.least = sum.launches == 0 ? launch.work_items : std::min(sum.least, launch.work_items);
    sum.most = std::max(sum.most, launch.work_items);
    ++sum.launches;
    sum.chain += steps_of_work_item(launch);
    sum.steps += launch.steps;
    sum.seconds += launch.seconds;
  }
  std::vector<std::pair<std::string, Sum>> sorted(sums.begin(), sums.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second.seconds > b.second.seconds; });
  for (const auto& [kernel, sum] : sorted) {
    rows.push_back(identity(call));
    rows.back().update({{"kernel", kernel},
                        {"launches", sum.launches},
                        {"work_items_least", sum.least},
                        {"work_items_most", sum.most},
                        {"chains_one_after_the_other", sum.chain},
                        {"steps", sum.steps},
                        {"seconds", sum.seconds}});
  }
}

Result measure_launches(const Request& request) {
  constexpr int kReplace = 1;
  if (!request.tuning.empty()) setenv("FLAUNAY_TUNING", request.tuning.c_str(), kReplace);
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  Triangulator triangulator(opencl_device(request.device));
  Result result{triangulator.device()};
  const char* const tuning = std::getenv("FLAUNAY_TUNING");
  result.facts["tuning"] = tuning == nullptr ? "" : tuning;
  result.facts["device_type"] = result.device.type;
  result.facts["compute_units"] = result.device.compute_units;
  for (const char* table : {"results", "kernels", "launches"}) result.tables[table] = Json::array();
  for (const std::string& mode : request.modes) {
    for (const Input& input : inputs) {
      const Call call = measure_call(triangulator, mode, input, request.runs);
      result.tables["results"].push_back(summary_of(call, result.device.compute_units));
      add_kernels(result.tables["kernels"], call);
      add_launches(result.tables["launches"], call);
    }
  }
  if (result.tables["launches"].size() > request.most_lines) result.not_printed.insert("launches");
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = add_command(
      app, action, "launches", "what a call launches: work-items, longest chains of steps, waits and bytes",
      fmt::format(
          "Counts do not depend on the machine, but on the sizes that a device's kind has: --tuning gpu "
          "counts on any OpenCL device what a GPU would do, and bench/predict.py predicts times from the "
          "record. longest_chain is the most steps of a block, of a merge, or of a walk along a hull, "
          "counted "
          "in a build of the kernels of its own (docs/counting.md); elements is the most that a work-item of "
          "another kernel goes through. merge_chain is the sum of the longest chains of merges, one launch "
          "after the other: from the leaves to the result, and from solved blocks. Launches of at least "
          "work_items_of_most_work work-items do {:g} % of the work, by time and busy cores. Times are those "
          "of calls that do not count, the least of each launch. Kernels count on OpenCL devices only, so "
          "--device "
          "host is refused.",
          100 * kMostWork),
      request, measure_launches);
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  command->add_option("--tuning", request->tuning, "sizes as FLAUNAY_TUNING has them, such as gpu");
  command->add_option("--most-lines", request->most_lines, "more launches are in the record only")
      ->capture_default_str();
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::launches
