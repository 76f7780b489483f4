// flaunay-bench device: what a device takes for launches, waits, loads and arithmetic, for predictions of
// times.
#include "host/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "calls.hpp"
#include "command.hpp"
#include "host/runtime.hpp"
#include "launchers/call/probe.cl.hpp"
#include "timing.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::bench::device {
namespace {

using host::Buffer;
using host::Runtime;

struct Request : Measurement {
  std::vector<std::size_t> working_sets{32 << 10, 1 << 20, 16 << 20, 256 << 20};
  std::size_t launches = 200;
  std::size_t steps = 100000;
  std::size_t work_items = 1 << 18;
  std::size_t copied_bytes = 256 << 20;
};

/// What is measured, once; returns the value in the row's unit.
struct Probe {
  std::string what, unit;
  std::function<double()> measure;
};

template <typename Run>
double seconds_of(Runtime& runtime, const Run& run) {
  runtime.finish();
  const Stopwatch watch;
  run();
  runtime.finish();
  return watch.seconds();
}

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

class Probes {
 public:
  Probes(Runtime& runtime, const Request& request)
      : runtime_(runtime), request_(request), ends_(runtime.arena().allocate<cl_int>(1)) {
    add_launches();
    for (const std::size_t bytes : request.working_sets) add_loads(bytes);
    add_arithmetic();
    add_copies();
  }
  const std::vector<Probe>& all() const { return all_; }

 private:
  void launch_nothing() { runtime_.launch(1, 1, 1, kernels::do_nothing{.ends = ends_}); }

  void add_launches() {
    const auto count = static_cast<double>(request_.launches);
    all_.push_back({"launch", "s", [this, count] {
                      return seconds_of(runtime_,
                                        [this] {
                                          for (std::size_t k = 0; k < request_.launches; ++k)
                                            launch_nothing();
                                        }) /
                             count;
                    }});
    all_.push_back({"launch and wait", "s", [this, count] {
                      return seconds_of(runtime_,
                                        [this] {
                                          for (std::size_t k = 0; k < request_.launches; ++k) {
                                            launch_nothing();
                                            runtime_.read_one(ends_, 0);
                                          }
                                        }) /
                             count;
                    }});
  }

  void add_loads(std::size_t bytes) {
    const auto next = runtime_.upload(runtime_.arena(), random_cycle(bytes));
    const auto steps = static_cast<cl_int>(request_.steps);
    all_.push_back(
        {fmt::format("load that waits for a load, of {} KiB", bytes >> 10), "s", [this, next, steps] {
           return seconds_of(runtime_,
                             [&] {
                               runtime_.launch(
                                   1, 1, 1,
                                   kernels::follow_chain{.steps = steps, .next = next, .ends = ends_});
                             }) /
                  steps;
         }});
  }

  void add_arithmetic() {
    const auto results = runtime_.arena().allocate<cl_double>(request_.work_items);
    const auto compute = [this, results](std::size_t work_items, std::size_t steps) {
      constexpr double kFactor = 0.5;
      return seconds_of(runtime_, [&] {
        runtime_.map(work_items,
                     kernels::compute_chain{
                         .steps = static_cast<cl_int>(steps), .factor = kFactor, .results = results});
      });
    };
    constexpr std::size_t kOperationsPerStep = 2, kStepsOfMany = 2000;
    all_.push_back({"operation of fp64 that waits for another", "s", [this, compute] {
                      return compute(1, request_.steps) /
                             static_cast<double>(kOperationsPerStep * request_.steps);
                    }});
    all_.push_back({"operations of fp64, many work-items", "1/s", [this, compute] {
                      return static_cast<double>(kOperationsPerStep * kStepsOfMany * request_.work_items) /
                             compute(request_.work_items, kStepsOfMany);
                    }});
  }

  void add_copies() {
    const std::size_t bytes = request_.copied_bytes;
    const auto from = runtime_.arena().allocate<cl_uchar>(bytes),
               to = runtime_.arena().allocate<cl_uchar>(bytes);
    runtime_.fill(from, bytes, cl_uchar{0});
    const auto rate = [this](std::size_t moved, const std::function<void()>& copy) {
      return static_cast<double>(moved) / seconds_of(runtime_, copy);
    };
    all_.push_back({"bytes read and written by a copy", "1/s", [this, rate, from, to, bytes] {
                      return rate(2 * bytes, [&] { runtime_.copy(from, 0, to, 0, bytes); });
                    }});
    const auto on_host = std::make_shared<std::vector<cl_uchar>>(bytes);
    all_.push_back({"bytes to the device", "1/s", [this, rate, to, bytes, on_host] {
                      return rate(bytes, [&] { runtime_.write(to, 0, bytes, on_host->data()); });
                    }});
    all_.push_back({"bytes to the host", "1/s", [this, rate, from, bytes, on_host] {
                      return rate(bytes, [&] { runtime_.read(from, 0, bytes, on_host->data()); });
                    }});
  }

  Runtime& runtime_;
  const Request& request_;
  Buffer<cl_int> ends_;
  std::vector<Probe> all_;
};

Result measure_all(const Request& request) {
  const std::string name = opencl_device(request.device);
  const auto device = host::find_device(name);
  Runtime runtime(device, tuning_for(device));
  const Probes probes(runtime, request);
  Result result{Triangulator(name).device()};
  result.facts["compute_units"] = result.device.compute_units;
  result.facts["clock_mhz"] = result.device.clock_mhz;
  result.tables["results"] = Json::array();
  for (const Probe& probe : probes.all()) {
    probe.measure();
    std::vector<double> values;
    for (int run = 0; run < request.runs; ++run) values.push_back(probe.measure());
    const Summary of_all = summary(values);
    result.tables["results"].push_back({{"what", probe.what},
                                        {"unit", probe.unit},
                                        {"median", of_all.median},
                                        {"least", of_all.low},
                                        {"most", of_all.high}});
  }
  return result;
}

Result measure_device(const Request& request) {
  try {
    return measure_all(request);
  } catch (const host::DeviceError& error) {
    throw Error(ErrorKind::device, error.what());
  }
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command =
      add_command(app, action, "device", "what launches, waits, loads and arithmetic take on a device",
                  "One work-item follows a chain of loads, each of which needs the one before, through "
                  "working sets of several "
                  "sizes; another computes with the result just computed. bench/predict.py takes the record "
                  "in place of what its "
                  "machine files assume.",
                  request, measure_device);
  add_option(command, "--working-sets", request->working_sets, "bytes that chains of loads go through");
  add_option(command, "--launches", request->launches, "launches of a run");
  add_option(command, "--steps", request->steps, "steps of a chain");
  add_option(command, "--work-items", request->work_items, "work-items that compute side by side");
  add_option(command, "--copied-bytes", request->copied_bytes, "bytes of a copy");
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::device
