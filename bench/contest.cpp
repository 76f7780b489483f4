#include "contest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "peer.hpp"

namespace flaunay::bench {
namespace {

std::string on(const Entry& entry) { return fmt::format("{} on {}", entry.name(), input_name(*entry.input)); }

Json result_of(const Entry& entry) {
  Json row = identity(entry);
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
    const Stopwatch watch;
    const research::Triangulation mesh = call(triangulator, input, options);
    const double seconds = watch.seconds();
    const Statistics& statistics = mesh.statistics;
    Outcome outcome{seconds,
                    statistics.triangles,
                    {{"kernel_launches", statistics.kernel_launches},
                     {"host_waits", statistics.host_waits},
                     {"undecided", statistics.undecided}}};
    if (!mesh.levels.empty()) outcome.details["levels"] = mesh.levels.size();
    return outcome;
  };
  return std::make_shared<Implementation>(Implementation{name, run, options});
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
      chosen.push_back(std::make_shared<Implementation>(Implementation{peer.name, peer.run}));
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

Entries make_entries(const Implementations& implementations, const std::vector<Input>& inputs) {
  Entries entries;
  for (const Input& input : inputs) {
    for (const auto& implementation : implementations) entries.push_back({implementation, &input});
  }
  return entries;
}

Entries try_peers(const Implementations& peers, const std::vector<Input>& inputs, double limit) {
  Entries entries = make_entries(peers, inputs);
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

Entries by_input(Entries entries, const Entries& more) {
  append(entries, more);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.input < b.input; });
  return entries;
}

void measure(Entries& entries, int runs, double limit) {
  std::vector<Job> jobs;
  std::vector<Entry*> measured;
  for (Entry& entry : entries) {
    if (!entry.skipped.empty()) continue;
    jobs.push_back({on(entry),
                    [&entry] {
                      entry.outcome = entry.implementation->run(*entry.input);
                      return entry.outcome.seconds;
                    },
                    entry.name() + " on " + entry.input->distribution});
    measured.push_back(&entry);
  }
  run_interleaved(jobs, runs, limit);
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    measured[j]->seconds = jobs[j].seconds;
    measured[j]->skipped = jobs[j].skipped;
  }
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
  for (const Entry& entry : entries) {
    if (!entry.skipped.empty()) continue;
    const Entry*& chosen = expected.emplace(entry.input, &entry).first->second;
    if (entry.name() == kCgal) chosen = &entry;
  }
  bool all_agree = !expected.empty();
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

Json identity(const Entry& entry) {
  return {
      {"implementation", entry.name()}, {"distribution", entry.input->distribution}, {"n", entry.input->n}};
}

void add_entries(Json& tables, const Entries& entries, const Json& keys) {
  for (const char* table : {"results", "skipped"}) tables.emplace(table, Json::array());
  for (const Entry& entry : entries) {
    Json row = entry.skipped.empty() ? result_of(entry) : identity(entry);
    row.update(keys);
    if (!entry.skipped.empty()) row["reason"] = entry.skipped;
    tables[entry.skipped.empty() ? "results" : "skipped"].push_back(row);
  }
}

}  // namespace flaunay::bench
