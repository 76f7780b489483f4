#include "bench/measuring/triangulators.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <utility>

#include "bench/measuring/command.hpp"
#include "bench/measuring/processes.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench {
namespace {

using research::Hull;

constexpr Hull kHulls[] = {Hull::prune, Hull::quickhull, Hull::balanced, Hull::monotone_chain};

void set_bytes_peak(Job& job, std::size_t bytes) {
  job.details["bytes_peak"] = bytes;
  job.details["bytes_per_point"] = static_cast<double>(bytes) / static_cast<double>(job.input->n);
}

std::size_t resident_bytes() {
  std::size_t all = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

std::vector<std::string> mode_names() {
  std::vector<std::string> names;
  for (const research::ModeInfo& mode : research::list_modes()) names.emplace_back(mode.name);
  return names;
}

std::vector<std::string> hull_names() {
  std::vector<std::string> names;
  for (const Hull hull : kHulls) names.emplace_back(research::to_string(hull));
  return names;
}

const research::ModeInfo& mode_named(const std::string& name) {
  for (const research::ModeInfo& mode : research::list_modes()) {
    if (name == mode.name) return mode;
  }
  throw Error(ErrorKind::usage, fmt::format("no mode is called '{}'", name));
}

research::Options options_of(const std::string& mode, const std::string& hull) {
  research::Options options;
  options.mode = mode_named(mode).mode;
  for (const Hull one : kHulls) {
    if (hull == research::to_string(one)) options.hull = one;
  }
  return options;
}

std::string opencl_device(const std::string& given) {
  const char* const named = std::getenv("FLAUNAY_DEVICE");
  if (!given.empty() || (named != nullptr && *named != '\0')) return given;
  return Triangulator().device().platform == "without OpenCL" ? "#0" : given;
}

research::Triangulation call(Triangulator& triangulator, const Input& input,
                             const research::Options& options) {
  return research::triangulate(triangulator, input.coordinates.data(), input.offsets, options);
}

std::string implementation_name(const std::string& mode) { return "flaunay-" + mode; }

Implementation mode_implementation(Triangulator& triangulator, const std::string& name,
                                   const research::Options& options) {
  constexpr std::size_t kEnoughForAllKernels = 3000;
  try {
    call(triangulator, make_input("uniform", kEnoughForAllKernels), options);
  } catch (const Error&) {
    // The measured runs fail in the same way, and report it.
  }
  const auto run = [&triangulator, options](const Input& input) {
    research::Triangulation mesh;
    Outcome outcome(seconds_of([&] { mesh = call(triangulator, input, options); }));
    outcome.details = {{"triangles", mesh.statistics.triangles},
                       {"kernel_launches", mesh.statistics.kernel_launches},
                       {"host_waits", mesh.statistics.host_waits},
                       {"undecided", mesh.statistics.undecided}};
    if (!mesh.levels.empty()) outcome.details["levels"] = mesh.levels.size();
    return outcome;
  };
  return {name, run, options};
}

Implementations mode_implementations(Triangulator& triangulator, const std::vector<std::string>& modes,
                                     int threads) {
  Implementations implementations;
  for (const std::string& mode : modes) {
    research::Options options = options_of(mode);
    if (options.mode == research::Mode::partition) options.threads = threads;
    implementations.push_back(mode_implementation(triangulator, implementation_name(mode), options));
  }
  return implementations;
}

Outcome call_on_sets(Triangulator& triangulator, const Input& input, const research::Options& options) {
  std::size_t triangles = 0;
  const Stopwatch watch;
  for (std::size_t s = 0; s < input.sets(); ++s) {
    const std::size_t first = input.offsets[s], n = input.offsets[s + 1] - first;
    const double* const coordinates = input.coordinates.data() + 2 * first;
    triangles += research::triangulate(triangulator, coordinates, n, options).statistics.triangles;
  }
  return {watch.seconds(), triangles};
}

Implementations peer_implementations(const std::vector<std::string>& names) {
  Implementations chosen;
  for (const std::string& name : names) {
    const std::vector<Peer>& all = all_peers();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const Peer& peer) { return peer.name == name; });
    if (found == all.end()) {
      fmt::print(stderr, "not measured: {}: this build is without it\n", name);
    } else {
      chosen.push_back({name, found->run});
    }
  }
  return chosen;
}

Implementations modes_and_cgal(Triangulator& triangulator, const std::vector<std::string>& modes) {
  Implementations all = mode_implementations(triangulator, modes);
  append(all, peer_implementations({kCgal}));
  return all;
}

Jobs make_jobs(const Implementations& implementations, const std::vector<Input>& inputs) {
  Jobs jobs;
  for (const Input& input : inputs) {
    for (const Implementation& one : implementations) {
      jobs.push_back({{{"implementation", one.name}, {"distribution", input.distribution}, {"n", input.n}},
                      [run = one.run, &input] { return run(input); },
                      one.name + " on " + input.distribution,
                      input_name(input),
                      &input,
                      one.options});
    }
  }
  return jobs;
}

Jobs try_peers(const std::vector<std::string>& names, const std::vector<Input>& inputs, double limit,
               std::size_t most) {
  Jobs jobs = make_jobs(peer_implementations(names), inputs);
  std::map<std::string, std::string> ended;  // why, by series
  Progress progress(jobs.size());
  for (Job& job : jobs) {
    std::string& reason = ended[job.series];
    progress.step("memory of " + job.title());
    if (job.input->n > most) reason = fmt::format("more than {} points", most);
    if (reason.empty()) {
      const Answer answer = ask_child(
          [&] {
            // Freed memory that the allocator keeps would be used again without being seen.
            malloc_trim(0);
            const std::size_t before = resident_bytes();
            job.run();
            return std::to_string(before);
          },
          limit);
      const std::size_t before = answer.text.empty() ? answer.resident_peak : std::stoull(answer.text);
      set_bytes_peak(job, std::max(answer.resident_peak, before) - before);
      if (!answer.failure.empty()) reason = fmt::format("{} {}", job.title(), answer.failure);
    }
    job.skipped = reason;
  }
  return jobs;
}

Jobs beside(Jobs peers, const Implementations& own, const std::vector<Input>& inputs) {
  Jobs jobs = make_jobs(own, inputs);
  append(jobs, peers);
  std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.input < b.input; });
  return jobs;
}

void measure_device_memory(Jobs& jobs, const std::string& device) {
  Progress progress(jobs.size());
  for (Job& job : jobs) {
    progress.step("device memory of " + job.title());
    if (!job.options || !job.skipped.empty()) continue;
    Triangulator triangulator(device);
    const std::size_t bytes = call(triangulator, *job.input, *job.options).statistics.device_bytes_peak;
    if (bytes > 0) set_bytes_peak(job, bytes);
  }
}

}  // namespace flaunay::bench
