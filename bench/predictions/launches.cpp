// flaunay-bench launches: what a call launches, how many work-items that are, and their longest chains of
// steps.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "bench/measuring/calls.hpp"
#include "bench/measuring/command.hpp"
#include "bench/measuring/processes.hpp"

namespace flaunay::bench::launches {
namespace {

using research::LaunchStatistics;
using research::Record;
using Launches = std::vector<LaunchStatistics>;

struct LaunchesRequest : Request {
  std::string tuning;
  std::size_t most_lines = 200;
};

// The share of the work that is done by the launches of which "work_items_of_most_work" is said.
constexpr double kMostWork = 0.9;

// Kernels whose steps are not those of merges: they walk along hulls.
const std::set<std::string> kWalkHulls = {"mark_outside", "write_hulls"};
// Kernels that merge the parts of blocks, not the blocks.
const std::set<std::string> kSolveBlocks = {"solve_blocks", "merge_parts",  "finish_parts",
                                            "walk_seams",   "finish_walks", "sew_seams"};

/// One call whose kernels counted their steps, and others that were timed.
struct Call {
  Statistics statistics;        ///< of the last timed call
  Launches launches;            ///< with steps, and with the least time of each
  std::vector<double> seconds;  ///< of the timed calls
};

std::size_t steps_of_work_item(const LaunchStatistics& launch) {
  return std::max<std::size_t>(launch.longest_chain, launch.elements);
}

// Steps of merges one after the other, as launches are: from the leaves to the result, or from solved blocks.
std::uint64_t merge_chain(const Launches& launches, bool from_leaves) {
  std::uint64_t sum = 0;
  for (const LaunchStatistics& launch : launches) {
    const bool is_left_out =
        kWalkHulls.count(launch.kernel) > 0 || (!from_leaves && kSolveBlocks.count(launch.kernel) > 0);
    if (!is_left_out) sum += launch.longest_chain;
  }
  return sum;
}

// The largest w such that launches of at least w work-items do most of the work: the time that they keep the
// device's cores busy. A launch with few work-items leaves some idle.
std::size_t work_items_of_most_work(Launches launches, std::size_t units) {
  const auto core_seconds = [&](const LaunchStatistics& launch) {
    return launch.seconds * static_cast<double>(std::min(launch.work_items, units));
  };
  std::sort(launches.begin(), launches.end(),
            [](const LaunchStatistics& a, const LaunchStatistics& b) { return a.work_items > b.work_items; });
  double all = 0, done = 0;
  for (const LaunchStatistics& launch : launches) all += core_seconds(launch);
  for (const LaunchStatistics& launch : launches) {
    done += core_seconds(launch);
    if (done >= kMostWork * all) return launch.work_items;
  }
  return 0;
}

Call measure_call(Triangulator& triangulator, const std::string& mode, const Input& input, int runs) {
  Call result;
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

// ---- Tables. Rows begin with the keys of their call.

Json summary_of(Json row, const Call& call, std::size_t units) {
  LaunchStatistics longest;
  for (const LaunchStatistics& launch : call.launches) {
    if (longest.kernel.empty() || steps_of_work_item(launch) > steps_of_work_item(longest)) longest = launch;
  }
  row.update({{"kernel_launches", call.statistics.kernel_launches},
              {"host_waits", call.statistics.host_waits},
              {"bytes_to_device", call.statistics.bytes_to_device},
              {"bytes_to_host", call.statistics.bytes_to_host},
              {"merge_chain", merge_chain(call.launches, true)},
              {"merge_chain_above_blocks", merge_chain(call.launches, false)},
              {"longest_chain", steps_of_work_item(longest)},
              {"longest_chain_kernel", longest.kernel},
              {"work_items_of_most_work", work_items_of_most_work(call.launches, units)}});
  add_seconds(row, call.seconds);
  return row;
}

void add_launches(Json& rows, const Json& keys, const Launches& launches) {
  for (std::size_t k = 0; k < launches.size(); ++k) {
    const LaunchStatistics& launch = launches[k];
    rows.push_back(keys);
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
void add_kernels(Json& rows, const Json& keys, const Launches& launches) {
  std::map<std::string, Launches> by_kernel;
  for (const LaunchStatistics& launch : launches) by_kernel[launch.kernel].push_back(launch);
  std::vector<Json> own;
  for (const auto& [kernel, its] : by_kernel) {
    const auto [least, most] = std::minmax_element(
        its.begin(), its.end(), [](const auto& a, const auto& b) { return a.work_items < b.work_items; });
    std::uint64_t chain = 0, steps = 0;
    double seconds = 0;
    for (const LaunchStatistics& launch : its) {
      chain += steps_of_work_item(launch);
      steps += launch.steps;
      seconds += launch.seconds;
    }
    own.push_back(keys);
    own.back().update({{"kernel", kernel},
                       {"launches", its.size()},
                       {"work_items_least", least->work_items},
                       {"work_items_most", most->work_items},
                       {"chains_one_after_the_other", chain},
                       {"steps", steps},
                       {"seconds", seconds}});
  }
  std::stable_sort(own.begin(), own.end(),
                   [](const Json& a, const Json& b) { return a.at("seconds") > b.at("seconds"); });
  for (const Json& row : own) rows.push_back(row);
}

Result measure_launches(const LaunchesRequest& request) {
  constexpr int kReplace = 1;
  if (!request.tuning.empty()) setenv("FLAUNAY_TUNING", request.tuning.c_str(), kReplace);
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  Triangulator triangulator(opencl_device(request.device));
  Result result(triangulator.device(), {"results", "kernels", "launches"});
  result.facts = {{"tuning", variable("FLAUNAY_TUNING")},
                  {"device_type", result.device.type},
                  {"compute_units", result.device.compute_units}};
  Json& tables = result.tables;
  for (const std::string& mode : request.modes) {
    for (const Input& input : inputs) {
      const Call call = measure_call(triangulator, mode, input, request.runs);
      const Json keys{{"mode", mode}, {"distribution", input.distribution}, {"n", input.n}};
      tables["results"].push_back(summary_of(keys, call, result.device.compute_units));
      add_kernels(tables["kernels"], keys, call.launches);
      add_launches(tables["launches"], keys, call.launches);
    }
  }
  if (tables["launches"].size() > request.most_lines) result.not_printed.insert("launches");
  return result;
}

const Subcommand kSubcommand(
    "launches", "what a call launches: work-items, longest chains of steps, waits and bytes",
    fmt::format(
        "Counts do not depend on the machine, but on the sizes that a device's kind has: --tuning gpu counts "
        "on "
        "any OpenCL device what a GPU would do, and bench/predictions/predict.py predicts times from the "
        "record. "
        "longest_chain is the most steps of a block, of a merge, or of a walk along a hull, counted in a "
        "build "
        "of the kernels of its own (docs/counting.md); elements is the most that a work-item of another "
        "kernel "
        "goes through. merge_chain is the sum of the longest chains of merges, one launch after the other: "
        "from "
        "the leaves to the result, and from solved blocks. Launches of at least work_items_of_most_work "
        "work-items do {:g} % of the work, by time and busy cores. Times are those of calls that do not "
        "count, "
        "the least of each launch. Kernels count on OpenCL devices only, so --device host is refused.",
        100 * kMostWork),
    measure_launches, [](Options& options, LaunchesRequest& request) {
      options.sizes({1000000})
          .distributions({"uniform", "kuzmin", "line"})
          .modes()
          .add("--tuning", request.tuning, "sizes as FLAUNAY_TUNING has them, such as gpu")
          .add("--most-lines", request.most_lines, "more launches are in the record only", kAny)
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::launches
