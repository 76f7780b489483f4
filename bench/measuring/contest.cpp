#include "bench/measuring/contest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "bench/measuring/timing.hpp"
#include "bench/peers/peer.hpp"

namespace flaunay::bench {
namespace {

std::string on(const Entry& entry) { return fmt::format("{} on {}", entry.name(), input_name(*entry.input)); }

Json result_of(const Entry& entry) {
  Json row = entry.row;
  add_seconds(row, entry.seconds);
  const auto n = static_cast<double>(entry.input->n);
  row["nanoseconds_per_point"] = 1e9 * entry.median() / n;
  row["triangles"] = entry.outcome.triangles;
  row["agrees"] = entry.agrees;
  if (entry.bytes_peak != 0) {
    row["bytes_peak"] = entry.bytes_peak;
    row["bytes_per_point"] = static_cast<double>(entry.bytes_peak) / n;
  }
  row.update(entry.outcome.details);
  return row;
}

}  // namespace

std::shared_ptr<const Implementation> implementation(const std::string& name,
                                                     std::function<Outcome(const Input&)> run,
                                                     std::optional<research::Options> options) {
  return std::make_shared<Implementation>(Implementation{name, std::move(run), std::move(options)});
}

Outcome call_on_sets(Triangulator& triangulator, const Input& input, const research::Options& options,
                     std::size_t stride) {
  Outcome outcome;
  const Stopwatch watch;
  for (std::size_t s = 0; s < input.sets(); s += stride) {
    const std::size_t first = input.offsets[s], n = input.offsets[s + 1] - first;
    outcome.triangles +=
        call(triangulator, input.coordinates.data() + 2 * first, n, options).statistics.triangles;
  }
  outcome.seconds = watch.seconds();
  return outcome;
}

std::string implementation_name(const std::string& mode) { return "flaunay-" + mode; }

std::shared_ptr<const Implementation> mode_implementation(Triangulator& triangulator, const std::string& name,
                                                          const research::Options& options) {
  constexpr std::size_t kEnoughForAllKernels = 3000;
  try {
    call(triangulator, make_input("uniform", kEnoughForAllKernels), options);
  } catch (const Error&) {
    // The measured runs fail in the same way, and report it.
  }
  const auto run = [&triangulator, options](const Input& input) {
    research::Triangulation mesh;
    const double seconds = seconds_of([&] { mesh = call(triangulator, input, options); });
    const Statistics& of_call = mesh.statistics;
    Json details{{"kernel_launches", of_call.kernel_launches},
                 {"host_waits", of_call.host_waits},
                 {"undecided", of_call.undecided}};
    if (!mesh.levels.empty()) details["levels"] = mesh.levels.size();
    return Outcome{seconds, of_call.triangles, details};
  };
  return implementation(name, run, options);
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

Implementations peer_implementations(const std::vector<std::string>& names) {
  Implementations chosen;
  for (const Peer& peer : all_peers()) {
    if (std::find(names.begin(), names.end(), peer.name) == names.end()) continue;
    if (peer.run != nullptr) {
      chosen.push_back(implementation(peer.name, peer.run));
    } else {
      fmt::print(stderr, "not measured: {}: this build is without it\n", peer.name);
    }
  }
  return chosen;
}

Implementations modes_and_cgal(Triangulator& triangulator, const std::vector<std::string>& modes) {
  Implementations all = mode_implementations(triangulator, modes);
  append(all, peer_implementations({kCgal}));
  return all;
}

Entry::Entry(std::shared_ptr<const Implementation> one, const Input& on)
    : Job{{{"implementation", one->name}, {"distribution", on.distribution}, {"n", on.n}},
          {},
          one->name + " on " + on.distribution},
      implementation(std::move(one)),
      input(&on) {}

Entries make_entries(const Implementations& implementations, const std::vector<Input>& inputs) {
  Entries entries;
  for (const Input& input : inputs) {
    for (const auto& implementation : implementations) entries.emplace_back(implementation, input);
  }
  return entries;
}

Entries try_peers(const std::vector<std::string>& names, const std::vector<Input>& inputs, double limit) {
  Entries entries = make_entries(peer_implementations(names), inputs);
  std::map<std::pair<std::string, std::string>, std::string> ended;
  Progress progress(entries.size());
  for (Entry& entry : entries) {
    std::string& reason = ended[{entry.name(), entry.input->distribution}];
    progress.step("memory of " + on(entry));
    if (reason.empty()) {
      const Trial trial = try_peer(entry.implementation->run, *entry.input, limit);
      entry.bytes_peak = trial.bytes_peak;
      if (!trial.failure.empty()) reason = fmt::format("{} on {}", trial.failure, input_name(*entry.input));
    }
    entry.skipped = reason;
    if (!reason.empty()) progress.say(fmt::format("not measured: {}: {}", on(entry), reason));
  }
  return entries;
}

Entries beside(Entries peers, const Implementations& own, const std::vector<Input>& inputs) {
  Entries entries = make_entries(own, inputs);
  append(entries, peers);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.input < b.input; });
  return entries;
}

void measure(Entries& entries, int runs, double limit) {
  std::vector<Job*> jobs;
  for (Entry& entry : entries) {
    entry.run = [&entry] {
      entry.outcome = entry.implementation->run(*entry.input);
      return entry.outcome.seconds;
    };
    if (entry.skipped.empty()) jobs.push_back(&entry);
  }
  run_interleaved(jobs, runs, limit);
}

void measure_device_memory(Entries& entries, const std::string& device) {
  DeviceMemory memory(device);
  Progress progress(entries.size());
  for (Entry& entry : entries) {
    progress.step("device memory of " + on(entry));
    const auto& options = entry.implementation->options;
    if (options && entry.skipped.empty()) entry.bytes_peak = memory.peak(*entry.input, *options);
  }
}

bool check_counts(Entries& entries) {
  std::map<const Input*, const Entry*> expected;
  bool all_agree = false;
  for (const Entry& entry : entries) {
    if (!entry.skipped.empty()) continue;
    all_agree = true;
    const Entry*& chosen = expected.emplace(entry.input, &entry).first->second;
    if (entry.name() == kCgal) chosen = &entry;
  }
  for (Entry& entry : entries) {
    if (!entry.skipped.empty()) continue;
    const Entry& other = *expected.at(entry.input);
    entry.agrees = entry.outcome.triangles == other.outcome.triangles;
    if (entry.agrees) continue;
    all_agree = false;
    fmt::print(stderr, "WARNING: {}: {} has {} triangles, {} has {}\n", input_name(*entry.input),
               entry.name(), entry.outcome.triangles, other.name(), other.outcome.triangles);
  }
  return all_agree;
}

std::optional<double> median_of(const Entries& entries, const std::string& implementation,
                                const std::string& distribution, std::size_t n) {
  for (const Entry& entry : entries) {
    if (entry.name() == implementation && entry.input->distribution == distribution && entry.input->n == n &&
        entry.valid()) {
      return entry.median();
    }
  }
  return {};
}

void add_entries(Result& result, Entries& entries, const Json& keys) {
  if (!entries.empty()) result.agree &= check_counts(entries);
  for (const char* table : {"results", "skipped"}) result.tables.emplace(table, Json::array());
  for (const Entry& entry : entries) {
    Json row = entry.skipped.empty() ? result_of(entry) : entry.row;
    row.update(keys);
    if (!entry.skipped.empty()) row["reason"] = entry.skipped;
    result.tables[entry.skipped.empty() ? "results" : "skipped"].push_back(row);
  }
}

}  // namespace flaunay::bench
