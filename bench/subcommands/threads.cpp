// flaunay-bench threads: the speed-up by more threads, of the host or of the driver.
#include <fmt/format.h>

#include <cstdlib>

#include "bench/measuring/command.hpp"
#include "bench/measuring/processes.hpp"
#include "bench/measuring/triangulators.hpp"

namespace flaunay::bench::threads {
namespace {

// The host reads the first, PoCL the second.
constexpr const char* kVariables[] = {"FLAUNAY_THREADS", "POCL_MAX_PTHREAD_COUNT"};
/// The goal for k threads is this share of k.
constexpr double kGoalEfficiency = 0.9;

struct ThreadsRequest : Request {
  std::vector<int> counts{1, 2};
};

/// One call in a process of its own, after one that is not counted.
Outcome run_on_threads(const ThreadsRequest& request, const std::string& mode, const Input& input,
                       int threads) {
  const Answer answer = ask_child([&] {
    for (const char* const name : kVariables) setenv(name, std::to_string(threads).c_str(), 1);
    Triangulator triangulator(request.device);
    const Implementation own = mode_implementations(triangulator, {mode}, threads).front();
    own.run(input);
    const Outcome outcome = own.run(input);
    return Json{outcome.seconds, outcome.details, triangulator.device().compute_units}.dump();
  });
  if (!answer.failure.empty()) {
    throw Error(ErrorKind::device, fmt::format("the process with {} threads {}", threads, answer.failure));
  }
  const Json told = Json::parse(answer.text);
  if (told[2] != threads) {
    fmt::print(stderr, "WARNING: with {}={} the device has {} compute units\n", kVariables[1], threads,
               told[2].dump());
  }
  return {told[0].get<double>(), told[1]};
}

Result measure_threads(const ThreadsRequest& request) {
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  Jobs jobs;
  for (const int threads : request.counts) {
    for (const std::string& mode : request.modes) {
      const auto run = [&request, mode, threads](const Input& input) {
        return run_on_threads(request, mode, input, threads);
      };
      for (Job& job : make_jobs({{implementation_name(mode), run}}, inputs)) {
        job.row["threads"] = threads;
        jobs.push_back(std::move(job));
      }
    }
  }
  measure(jobs, request.runs, 0);
  // Only now, since child processes are to be made without a device.
  Result result(Triangulator(request.device).device());
  for (Job& job : jobs) {
    const int threads = job.row["threads"], first = request.counts.front();
    const auto slow = median_of(jobs, changed(job.row, {{"threads", first}}));
    if (!slow || !job.valid() || threads == first) continue;
    job.details["speedup"] = *slow / job.median();
    job.details["goal"] = kGoalEfficiency * threads / first;
  }
  add_rows(result, jobs);
  return result;
}

const Subcommand kThreads(
    "threads", "what more threads of the host or of the driver are worth",
    R"(FLAUNAY_THREADS and POCL_MAX_PTHREAD_COUNT are read when work begins, so each run has a process of its own,
which runs once without counting and once that counts. Mode partition has as many host threads, too. The goal is a
speedup of 0.9 for each thread. Drivers other than PoCL do not know these variables; a warning says so where the
number of compute units does not follow it.)",
    measure_threads, [](Options& options, ThreadsRequest& request) {
      options.add("--counts", request.counts, "numbers of threads; speedups are over the first")
          .sizes({1000000})
          .distributions({"uniform"})
          .modes()
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::threads
