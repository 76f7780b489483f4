// flaunay-bench device: times of a device for launches, waits, loads and arithmetic, for predictions.
#include "host/opencl/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "bench/measuring/command.hpp"
#include "bench/measuring/triangulators.hpp"
#include "host/runtime.hpp"
#include "launchers/call/probe.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::bench::device {
namespace {

struct DeviceRequest : Request {
  std::vector<std::size_t> working_sets{32 << 10, 1 << 20, 16 << 20, 256 << 20};
  std::size_t launches = 200;
  std::size_t steps = 100000;
  std::size_t work_items = 1 << 18;
  std::size_t copied_bytes = 256 << 20;
};

// A chain through all lines of the working set in random order, so that nothing is fetched before it is asked
// for.
std::vector<cl_int> random_cycle(std::size_t bytes) {
  constexpr std::size_t kLine = 128 / sizeof(cl_int);
  const std::size_t lines = std::max<std::size_t>(1, bytes / sizeof(cl_int) / kLine);
  std::vector<std::size_t> order(lines);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 random(1);
  for (std::size_t i = lines; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  std::vector<cl_int> next(lines * kLine);
  for (std::size_t i = 0; i < lines; ++i) {
    next[order[i] * kLine] = static_cast<cl_int>(order[(i + 1) % lines] * kLine);
  }
  return next;
}

Result measure_device(const DeviceRequest& request) {
  const std::string name = opencl_device(request.device);
  const auto found = host::find_device(name);
  host::Runtime runtime(found, settings_for(found));
  Result result(Triangulator(name).device());
  result.facts = {{"compute_units", result.device.compute_units}, {"clock_mhz", result.device.clock_mhz}};

  Jobs jobs;
  // Measures work of this many operations: seconds per operation, or operations per second.
  const auto add = [&](const std::string& what, const char* unit, std::size_t operations,
                       const std::function<void()>& work) {
    const Json row{{"what", what}, {"unit", unit}, {"operations", operations}};
    jobs.push_back({row, [&runtime, work] {
                      runtime.finish();
                      return seconds_of([&] {
                        work();
                        runtime.finish();
                      });
                    }});
  };

  const auto ends = runtime.arena().allocate<cl_int>(1);
  const auto launch = [&, ends](bool waits) {
    for (std::size_t k = 0; k < request.launches; ++k) {
      runtime.launch(1, 1, 1, kernels::do_nothing{.ends = ends});
      if (waits) runtime.read_one(ends, 0);
    }
  };
  add("launch", "s", request.launches, [&] { launch(false); });
  add("launch and wait", "s", request.launches, [&] { launch(true); });

  const auto steps = static_cast<cl_int>(request.steps);
  for (const std::size_t bytes : request.working_sets) {
    const auto next = runtime.upload(runtime.arena(), random_cycle(bytes));
    add(fmt::format("load that waits for a load, of {} KiB", bytes >> 10), "s", request.steps, [&, next] {
      runtime.launch(1, 1, 1, kernels::follow_chain{.steps = steps, .next = next, .ends = ends});
    });
  }

  constexpr std::size_t kOperationsPerStep = 2, kStepsOfMany = 2000;
  const auto results = runtime.arena().allocate<cl_double>(request.work_items);
  const auto compute = [&](std::size_t work_items, std::size_t of_each) {
    runtime.map(work_items, kernels::compute_chain{
                                .steps = static_cast<cl_int>(of_each), .factor = 0.5, .results = results});
  };
  add("operation of fp64 that waits for another", "s", kOperationsPerStep * request.steps,
      [&] { compute(1, request.steps); });
  add("operations of fp64, many work-items", "1/s", kOperationsPerStep * kStepsOfMany * request.work_items,
      [&] { compute(request.work_items, kStepsOfMany); });

  const std::size_t bytes = request.copied_bytes;
  const auto from = runtime.arena().allocate<cl_uchar>(bytes), to = runtime.arena().allocate<cl_uchar>(bytes);
  runtime.fill(from, bytes, cl_uchar{0});
  std::vector<cl_uchar> on_host(bytes);
  add("bytes read and written by a copy", "1/s", 2 * bytes, [&] { runtime.copy(from, 0, to, 0, bytes); });
  add("bytes to the device", "1/s", bytes, [&] { runtime.write(to, 0, bytes, on_host.data()); });
  add("bytes to the host", "1/s", bytes, [&] { runtime.read(from, 0, bytes, on_host.data()); });
  measure(jobs, request.runs);
  for (Job& job : jobs) {
    const auto operations = job.row["operations"].get<double>();
    const bool is_rate = job.row["unit"] == "1/s";
    for (double& seconds : job.seconds) seconds = is_rate ? operations / seconds : seconds / operations;
    const Summary values = summary(job.seconds);
    result.tables["results"].push_back({{"what", job.row["what"]},
                                        {"unit", job.row["unit"]},
                                        {"median", values.median},
                                        {"least", values.low},
                                        {"most", values.high}});
  }
  return result;
}

const Subcommand kSubcommand(
    "device", "what launches, waits, loads and arithmetic take on a device",
    R"(One work-item follows a chain of loads, each of which needs the one before, through working sets of several
sizes; another computes with the result just computed. bench/predictions/predict.py takes the record in place of what
its machine files assume.)",
    measure_device, [](Options& options, DeviceRequest& request) {
      options.add("--working-sets", request.working_sets, "bytes that chains of loads go through")
          .add("--launches", request.launches, "launches of a run")
          .add("--steps", request.steps, "steps of a chain")
          .add("--work-items", request.work_items, "work-items that compute side by side")
          .add("--copied-bytes", request.copied_bytes, "bytes of a copy")
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::device
