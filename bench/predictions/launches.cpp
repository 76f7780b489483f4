// flaunay-bench launches: the launches of a call, their numbers of work-items, and their longest chains of
// steps.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>

#include "bench/measuring/command.hpp"
#include "bench/measuring/processes.hpp"
#include "bench/measuring/triangulators.hpp"
#include "constrained/refinement/refine.hpp"
#include "host/opencl/device.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::bench::launches {
namespace {

using research::LaunchStatistics;
using research::Record;
using Launches = std::vector<LaunchStatistics>;

struct LaunchesRequest : Request {
  std::string tuning;
  double min_angle = 0;
};

// "work_items_of_most_work" refers to the launches that do this share of the work.
constexpr double kMostWork = 0.9;

// Kernels whose steps are not steps of merges: they walk along hulls, compare vertices, or share a merge.
const std::set<std::string> kNoMergeSteps = {"mark_outside", "write_hulls", "sew_seams", "wrap_stars",
                                             "join_stars"};
// Kernels that merge the parts of blocks, not the blocks.
const std::set<std::string> kSolveBlocks = {"solve_blocks", "solve_local_parts", "finish_local_parts",
                                            "merge_parts",  "finish_parts",      "walk_seams",
                                            "finish_walks"};

std::size_t steps_of_work_item(const LaunchStatistics& launch) {
  return std::max<std::size_t>(launch.longest_chain, launch.elements);
}

// Steps of merges one after the other, as launches are: from the leaves to the result, or from solved blocks.
std::uint64_t merge_chain(const Launches& launches, bool from_leaves) {
  std::uint64_t sum = 0;
  for (const LaunchStatistics& launch : launches) {
    const bool is_left_out =
        kNoMergeSteps.count(launch.kernel) > 0 || (!from_leaves && kSolveBlocks.count(launch.kernel) > 0);
    if (!is_left_out) sum += launch.longest_chain;
  }
  return sum;
}

// The largest w such that launches of at least w work-items do most of the work: the time that they keep the
// device's cores busy. A launch with few work-items leaves some idle.
std::size_t work_items_of_most_work(const Launches& launches, std::size_t units) {
  std::map<std::size_t, double, std::greater<>> core_seconds;  // by work-items
  double all = 0, done = 0;
  for (const LaunchStatistics& launch : launches) {
    const double own = launch.seconds * static_cast<double>(std::min(launch.work_items, units));
    core_seconds[launch.work_items] += own;
    all += own;
  }
  for (const auto& [work_items, seconds] : core_seconds) {
    done += seconds;
    if (done >= kMostWork * all) return work_items;
  }
  return 0;
}

/// A call whose kernels count their steps, and others that are timed; the least time of each launch.
Launches measure_call(Triangulator& triangulator, const std::string& mode, const Input& input, int runs,
                      Json& summary_row) {
  research::Options options = options_of(mode);
  options.record = Record::steps;
  Launches launches = call(triangulator, input, options).launches;
  options.record = Record::launches;
  options.profile = true;
  std::vector<double> seconds;
  for (int run = -1; run < runs; ++run) {
    const research::Triangulation mesh = call(triangulator, input, options);
    if (mesh.launches.size() != launches.size()) {
      throw Error(ErrorKind::device, "two calls on the same points had different numbers of launches");
    }
    if (run < 0) continue;
    for (std::size_t k = 0; k < launches.size(); ++k) {
      double& least = launches[k].seconds;
      least = run == 0 ? mesh.launches[k].seconds : std::min(least, mesh.launches[k].seconds);
    }
    seconds.push_back(mesh.statistics.seconds);
    summary_row.update({{"kernel_launches", mesh.statistics.kernel_launches},
                        {"host_waits", mesh.statistics.host_waits},
                        {"bytes_to_device", mesh.statistics.bytes_to_device},
                        {"bytes_to_host", mesh.statistics.bytes_to_host}});
  }
  add_seconds(summary_row, seconds);
  return launches;
}

/// The points' triangulation, whose hull must stay.
constrained::MeshToRefine mesh_of(const Input& input) {
  constrained::MeshToRefine mesh;
  mesh.coordinates = input.coordinates.data();
  mesh.points = input.n;
  Triangulation delaunay = Triangulator("host").triangulate(mesh.coordinates, mesh.points);
  mesh.triangles = std::move(delaunay.triangles);
  mesh.neighbors = std::move(delaunay.neighbors);
  mesh.edges.assign(mesh.triangles.size(), -1);
  for (std::size_t h = 0; h < mesh.edges.size(); ++h) {
    if (mesh.neighbors[h] >= 0) continue;
    mesh.edges[h] = static_cast<std::int32_t>(mesh.edge_ends.size() / 2);
    const std::size_t t = h - h % 3;
    append(mesh.edge_ends, {mesh.triangles[t + (h + 1) % 3], mesh.triangles[t + (h + 2) % 3]});
  }
  return mesh;
}

/// The refinement of the points' triangulation, from the host's memory to it.
Launches refine(host::Runtime& runtime, const Input& input, double min_angle, Json& summary_row) {
  const constrained::MeshToRefine mesh = mesh_of(input);
  Refinement wanted;
  wanted.min_angle = min_angle;
  constrained::refine(runtime, mesh, wanted);  // compiles the kernels
  runtime.set_profiling(true);
  runtime.record_launches();
  runtime.reset_accounts();
  const Stopwatch watch;
  constrained::refine(runtime, mesh, wanted);
  add_seconds(summary_row, {watch.seconds()});
  Launches launches;
  for (const host::Launch& launch : runtime.recorded_launches()) {
    launches.push_back(
        {launch.kernel, launch.work_items, launch.group, launch.busy, launch.elements, launch.bytes});
    launches.back().seconds = launch.seconds;
  }
  const host::Accounts& accounts = runtime.accounts();
  summary_row.update({{"kernel_launches", accounts.launches},
                      {"host_waits", accounts.waits},
                      {"bytes_to_device", accounts.bytes_to_device},
                      {"bytes_to_host", accounts.bytes_to_host}});
  runtime.stop_recording();
  runtime.set_profiling(false);
  return launches;
}

Result measure_launches(const LaunchesRequest& request) {
  constexpr int kReplace = 1;
  if (!request.tuning.empty()) setenv("FLAUNAY_TUNING", request.tuning.c_str(), kReplace);
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  Triangulator triangulator(opencl_device(request.device));
  Result result(triangulator.device());
  result.facts = {{"tuning", variable("FLAUNAY_TUNING")},
                  {"device_type", result.device.type},
                  {"compute_units", result.device.compute_units}};
  std::unique_ptr<host::Runtime> refining;
  if (request.min_angle > 0) {
    const auto device = host::find_device(opencl_device(request.device));
    refining = std::make_unique<host::Runtime>(device, settings_for(device));
  }
  for (const std::string& mode : refining ? std::vector<std::string>{"refinement"} : request.modes) {
    for (const Input& input : inputs) {
      const Json keys{{"mode", mode}, {"distribution", input.distribution}, {"n", input.n}};
      Json row = keys;
      const Launches launches = refining ? refine(*refining, input, request.min_angle, row)
                                         : measure_call(triangulator, mode, input, request.runs, row);
      const auto longest = std::max_element(
          launches.begin(), launches.end(),
          [](const auto& a, const auto& b) { return steps_of_work_item(a) < steps_of_work_item(b); });
      row.update(
          {{"merge_chain", merge_chain(launches, true)},
           {"merge_chain_above_blocks", merge_chain(launches, false)},
           {"longest_chain", steps_of_work_item(*longest)},
           {"longest_chain_kernel", longest->kernel},
           {"work_items_of_most_work", work_items_of_most_work(launches, result.device.compute_units)}});
      result.tables["results"].push_back(row);
      for (std::size_t k = 0; k < launches.size(); ++k) {
        const LaunchStatistics& launch = launches[k];
        result.tables["launches"].push_back(changed(keys, {{"launch", k},
                                                           {"kernel", launch.kernel},
                                                           {"work_items", launch.work_items},
                                                           {"group", launch.group},
                                                           {"busy", launch.busy},
                                                           {"elements", launch.elements},
                                                           {"bytes", launch.bytes},
                                                           {"longest_chain", launch.longest_chain},
                                                           {"steps", launch.steps},
                                                           {"seconds", launch.seconds}}));
      }
    }
  }
  result.not_printed.insert("launches");
  return result;
}

const Subcommand kSubcommand(
    "launches", "what a call launches: work-items, longest chains of steps, waits and bytes",
    R"(Counts do not depend on the machine, but on the sizes that a device's kind has: --tuning gpu counts on any
OpenCL device what a GPU would do. The record has all launches, from which bench/predictions/predict.py makes a table
of kernels and predicts times. longest_chain is the most steps of a block, of a merge, or of a walk along a hull,
counted in a build of the kernels of its own (docs/counting.md); elements is the most that a work-item of another
kernel goes through. merge_chain is the sum of the longest chains of merges, one launch after the other: from the
leaves to the result, and from solved blocks. Launches of at least work_items_of_most_work work-items do 90 % of the
work, by time and busy cores. Times are those of calls that do not count, the least of each launch. With --device host
the counts are those of the host's kernels, which have no work-groups. With --min-angle, a refinement is counted in
place of modes, from a triangulation in host memory to a mesh there, once; its kernels count no steps.)",
    measure_launches, [](Options& options, LaunchesRequest& request) {
      options.sizes({1000000})
          .distributions({"uniform", "kuzmin", "line"})
          .modes()
          .add("--tuning", request.tuning, "sizes as FLAUNAY_TUNING has them, such as gpu")
          .add("--min-angle", request.min_angle, "degrees: counts a refinement", CLI::NonNegativeNumber)
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::launches
