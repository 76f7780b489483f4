#include "contest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

namespace flaunay::bench {
namespace {

const std::string kOwn = "flaunay-";

double run_repeatedly(const Implementation& implementation, Entry& entry) {
  return mean_of_repeated([&] {
    const Outcome outcome = implementation.run(*entry.input);
    entry.triangles = outcome.triangles;
    return outcome.seconds;
  });
}

Job job_of(const Implementation& implementation, Entry& entry) {
  return {fmt::format("{} on {}", entry.implementation, input_name(*entry.input)),
          [&implementation, &entry] { return run_repeatedly(implementation, entry); },
          fmt::format("{} on {}", entry.implementation, entry.input->distribution)};
}

nlohmann::json identity(const Entry& entry) {
  return {{"implementation", entry.implementation},
          {"distribution", entry.input->distribution},
          {"n", entry.input->n}};
}

nlohmann::json result_of(const Entry& entry) {
  nlohmann::json result = identity(entry);
  result["triangles"] = entry.triangles;
  result["agrees"] = entry.agrees;
  if (entry.bytes_peak != 0) result["bytes_peak"] = entry.bytes_peak;
  add_seconds(result, summary(entry.seconds));
  return result;
}

}  // namespace

std::string implementation_name(const std::string& mode) { return kOwn + mode; }

std::string mode_of(const std::string& implementation) { return implementation.substr(kOwn.size()); }

bool Entry::of_flaunay() const { return implementation.rfind(kOwn, 0) == 0; }

std::vector<Implementation> mode_implementations(Triangulator& triangulator,
                                                 const std::vector<std::string>& modes, int threads) {
  std::vector<Implementation> implementations;
  for (const std::string& mode : modes) {
    Options options;
    options.mode = mode_named(mode);
    if (options.mode == Mode::partition) options.threads = threads;
    prepare_mode(triangulator, options);
    implementations.push_back({implementation_name(mode), [&triangulator, options](const Input& input) {
                                 const Stopwatch watch;
                                 const Triangulation mesh = run_mode(triangulator, input, options);
                                 return Outcome{watch.seconds(), mesh.statistics.triangles};
                               }});
  }
  return implementations;
}

std::vector<Peer> chosen_peers(const std::vector<std::string>& names) {
  std::vector<Peer> chosen;
  for (const Peer& peer : all_peers()) {
    if (std::find(names.begin(), names.end(), peer.name) == names.end()) continue;
    if (peer.run) {
      chosen.push_back(peer);
    } else {
      fmt::print(stderr, "not measured: {}: this build is without it\n", peer.name);
    }
  }
  return chosen;
}

std::vector<Implementation> implementations_of(const std::vector<Peer>& peers) {
  std::vector<Implementation> implementations;
  for (const Peer& peer : peers) implementations.push_back({peer.name, peer.run});
  return implementations;
}

std::vector<Implementation> modes_and_cgal(Triangulator& triangulator,
                                           const std::vector<std::string>& modes) {
  std::vector<Implementation> all = mode_implementations(triangulator, modes);
  append(all, implementations_of(chosen_peers({kCgal})));
  return all;
}

std::vector<Entry> make_entries(const std::vector<Implementation>& implementations,
                                const std::vector<Input>& inputs) {
  std::vector<Entry> entries;
  for (const Input& input : inputs) {
    for (const Implementation& implementation : implementations) {
      entries.push_back({implementation.name, &input});
    }
  }
  return entries;
}

std::vector<Entry> try_peers(const std::vector<Peer>& peers, const std::vector<Input>& inputs, double limit) {
  std::vector<Entry> entries;
  std::map<std::pair<std::string, std::string>, std::string> ended;
  Progress progress(peers.size() * inputs.size());
  for (const Input& input : inputs) {
    for (const Peer& peer : peers) {
      Entry entry{peer.name, &input};
      std::string& reason = ended[{peer.name, input.distribution}];
      progress.step(fmt::format("memory of {}: {}", peer.name, input_name(input)));
      if (reason.empty()) {
        const Trial trial = try_peer(peer, input, limit);
        entry.triangles = trial.outcome.triangles;
        entry.bytes_peak = trial.bytes_peak;
        if (!trial.failure.empty()) reason = fmt::format("{} on {}", trial.failure, input_name(input));
      }
      entry.skipped = reason;
      if (!reason.empty()) {
        progress.say(fmt::format("not measured: {} on {}: {}", peer.name, input_name(input), reason));
      }
      entries.push_back(entry);
    }
  }
  return entries;
}

std::vector<Entry> by_input(std::vector<Entry> entries, const std::vector<Entry>& more) {
  append(entries, more);
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.input < b.input; });
  return entries;
}

void measure(std::vector<Entry>& entries, const std::vector<Implementation>& implementations, int runs,
             double limit) {
  std::vector<Job> jobs;
  std::vector<Entry*> measured;
  for (Entry& entry : entries) {
    if (!entry.skipped.empty()) continue;
    const auto implementation =
        std::find_if(implementations.begin(), implementations.end(),
                     [&](const Implementation& candidate) { return candidate.name == entry.implementation; });
    jobs.push_back(job_of(*implementation, entry));
    measured.push_back(&entry);
  }
  run_interleaved(jobs, runs, limit);
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    measured[j]->seconds = jobs[j].seconds;
    measured[j]->skipped = jobs[j].skipped;
  }
}

bool same_count(const Input& input, const std::string& first, std::size_t expected, const std::string& other,
                std::size_t triangles) {
  if (triangles == expected) return true;
  fmt::print(stderr, "WARNING: {}: {} has {} triangles, {} has {}\n", input_name(input), other, triangles,
             first, expected);
  return false;
}

bool check_counts(std::vector<Entry>& entries) {
  std::map<const Input*, const Entry*> expected;
  for (const Entry& entry : entries) {
    if (!entry.skipped.empty()) continue;
    const Entry*& chosen = expected.emplace(entry.input, &entry).first->second;
    if (entry.implementation == kCgal) chosen = &entry;
  }
  bool all_agree = true;
  for (Entry& entry : entries) {
    if (!entry.skipped.empty()) continue;
    const Entry& other = *expected.at(entry.input);
    entry.agrees = same_count(*entry.input, other.implementation, other.triangles, entry.implementation,
                              entry.triangles);
    all_agree = all_agree && entry.agrees;
  }
  return all_agree;
}

std::optional<double> median_of(const std::vector<Entry>& entries, const std::string& implementation,
                                const std::string& distribution, std::size_t n) {
  for (const Entry& entry : entries) {
    if (entry.implementation != implementation || entry.input->distribution != distribution ||
        entry.input->n != n)
      continue;
    if (entry.valid()) return summary(entry.seconds).median;
  }
  return {};
}

std::vector<const Entry*> valid_entries(const std::vector<Entry>& entries, const Input& input) {
  std::vector<const Entry*> result;
  for (const Entry& entry : entries) {
    if (entry.input == &input && entry.valid()) result.push_back(&entry);
  }
  return result;
}

void print_entries(const std::vector<Entry>& entries) {
  fmt::print("{:<24} {:<22} {:>9} {:>11} {:>11} {:>11} {:>8} {:>10} {:>9}\n", "implementation",
             "distribution", "n", "median s", "min s", "max s", "ns/pt", "triangles", "bytes/pt");
  for (const Entry& entry : entries) {
    const Input& input = *entry.input;
    fmt::print("{:<24} {:<22} {:>9} ", entry.implementation, input.distribution, input.n);
    if (!entry.skipped.empty()) {
      fmt::print("not measured: {}\n", entry.skipped);
      continue;
    }
    const Summary seconds = summary(entry.seconds);
    const auto n = static_cast<double>(input.n);
    const std::string bytes =
        entry.bytes_peak == 0 ? "-" : fmt::format("{:.0f}", static_cast<double>(entry.bytes_peak) / n);
    fmt::print("{:>11.6f} {:>11.6f} {:>11.6f} {:>8.0f} {:>10} {:>9}{}\n", seconds.median, seconds.low,
               seconds.high, 1e9 * seconds.median / n, entry.triangles, bytes,
               entry.agrees ? "" : "  WRONG NUMBER OF TRIANGLES");
  }
}

void add_entries(nlohmann::json& record, const std::vector<Entry>& entries) {
  nlohmann::json& results = record["results"] = nlohmann::json::array();
  nlohmann::json& skipped = record["skipped"] = nlohmann::json::array();
  for (const Entry& entry : entries) {
    if (entry.skipped.empty()) {
      results.push_back(result_of(entry));
    } else {
      skipped.push_back(identity(entry));
      skipped.back()["reason"] = entry.skipped;
    }
  }
}

void add_time_per_point(plot::Lines& panel, const std::string& name, std::size_t size,
                        const Summary& seconds) {
  auto series = std::find_if(panel.series.begin(), panel.series.end(),
                             [&](const plot::Series& candidate) { return candidate.name == name; });
  if (series == panel.series.end()) series = panel.series.insert(series, {name, {}, {}});
  const auto n = static_cast<double>(size);
  series->x.push_back(n);
  series->y.push_back(seconds.median / n);
  series->low.push_back(seconds.low / n);
  series->high.push_back(seconds.high / n);
}

plot::Lines time_per_point_panel(const std::vector<Entry>& entries, const std::vector<std::size_t>& sizes,
                                 const std::string& distribution) {
  plot::Lines panel;
  panel.title = distribution;
  panel.x = size_axis(sizes);
  panel.y = {"time per point", plot::Scale::log10, plot::Unit::seconds};
  for (const Entry& entry : entries) {
    if (!entry.valid() || entry.input->distribution != distribution) continue;
    add_time_per_point(panel, entry.implementation, entry.input->n, summary(entry.seconds));
  }
  return panel;
}

plot::BarGroup time_bars(const std::vector<Entry>& entries, const Input& input, const std::string& name) {
  plot::BarGroup group{name, {}};
  for (const Entry* entry : valid_entries(entries, input)) {
    const Summary seconds = summary(entry->seconds);
    group.bars.push_back({entry->implementation, {seconds.median}, seconds.low, seconds.high});
  }
  return group;
}

}  // namespace flaunay::bench
