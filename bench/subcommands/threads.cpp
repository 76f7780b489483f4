// flaunay-bench threads: what more threads are worth, of the host's or of the driver's.
#include <fmt/format.h>

#include <cstdlib>

#include "bench/measuring/contest.hpp"
#include "bench/measuring/processes.hpp"

namespace flaunay::bench::threads {
namespace {

// The host reads the first, PoCL the second.
constexpr const char* kVariables[] = {"FLAUNAY_THREADS", "POCL_MAX_PTHREAD_COUNT"};
/// The goal for k threads is this share of k.
constexpr double kGoalEfficiency = 0.9;

struct ThreadsRequest : Request {
  std::vector<int> counts{1, 2};
};

/// All entries on so many threads.
struct Team {
  int threads;
  Entries entries;
};

/// What the child process does: measures once, and tells the times in the order of the entries.
std::string measure_here(const ThreadsRequest& request, const std::vector<Input>& inputs, int threads) {
  for (const char* const variable : kVariables) setenv(variable, std::to_string(threads).c_str(), 1);
  Triangulator triangulator(request.device);
  Entries entries = make_entries(mode_implementations(triangulator, request.modes, threads), inputs);
  measure(entries, 1);
  Json told{{"compute_units", triangulator.device().compute_units}};
  for (const Entry& entry : entries) {
    told["entries"].push_back({{"seconds", entry.seconds},
                               {"triangles", entry.outcome.triangles},
                               {"details", entry.outcome.details},
                               {"skipped", entry.skipped}});
  }
  return told.dump();
}

/// Adds the times of one child process to the team's.
void measure_in_child(const ThreadsRequest& request, const std::vector<Input>& inputs, Team& team) {
  const Answer answer = ask_child([&] { return measure_here(request, inputs, team.threads); });
  if (!answer.failure.empty()) {
    throw Error(ErrorKind::device,
                fmt::format("the process with {} threads {}", team.threads, answer.failure));
  }
  const Json told = Json::parse(answer.text);
  if (told.at("compute_units") != team.threads) {
    fmt::print(stderr, "WARNING: with {}={} the device has {} compute units\n", kVariables[1], team.threads,
               told.at("compute_units").get<int>());
  }
  for (std::size_t e = 0; e < team.entries.size(); ++e) {
    const Json& from = told.at("entries").at(e);
    Entry& entry = team.entries[e];
    entry.outcome = {0, from.at("triangles"), from.at("details")};
    entry.skipped = from.at("skipped");
    append(entry.seconds, from.at("seconds").get<std::vector<double>>());
  }
}

/// Each entry on the first number of threads and on the others.
Json speedups_of(const std::vector<Team>& teams) {
  Json speedups = Json::array();
  const Team& first = teams.front();
  for (std::size_t e = 0; e < first.entries.size(); ++e) {
    for (std::size_t t = 1; t < teams.size(); ++t) {
      const Entry &slow = first.entries[e], &fast = teams[t].entries[e];
      if (!slow.valid() || !fast.valid()) continue;
      speedups.push_back(slow.row);
      speedups.back()["from_threads"] = first.threads;
      speedups.back()["to_threads"] = teams[t].threads;
      speedups.back()["speedup"] = slow.median() / fast.median();
      speedups.back()["goal"] = kGoalEfficiency * teams[t].threads / first.threads;
    }
  }
  return speedups;
}

Result measure_threads(const ThreadsRequest& request) {
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  Implementations named;
  for (const std::string& mode : request.modes) {
    named.push_back(implementation(implementation_name(mode), {}));
  }
  std::vector<Team> teams;
  for (const int threads : request.counts) teams.push_back({threads, make_entries(named, inputs)});
  for (int round = 0; round < request.runs; ++round) {
    for (Team& team : teams) measure_in_child(request, inputs, team);
  }
  // Only now, since child processes are to be made without a device.
  Result result(Triangulator(request.device).device());
  for (Team& team : teams) add_entries(result, team.entries, {{"threads", team.threads}});
  result.tables["speedups"] = speedups_of(teams);
  return result;
}

const Subcommand kSubcommand(
    "threads", "what more threads of the host or of the driver are worth",
    fmt::format(
        "{} are read when work begins, so each number of threads has processes of its own: in each round "
        "one for every number, which runs everything once without counting and once that counts. Mode "
        "partition has as many host threads, too. The goal is a speedup of {:g} for each thread. Drivers "
        "other than PoCL do not know these variables; a warning says so where the number of compute "
        "units does not follow it.",
        fmt::join(kVariables, " and "), kGoalEfficiency),
    measure_threads, [](Options& options, ThreadsRequest& request) {
      options.add("--counts", request.counts, "numbers of threads; speedups are over the first")
          .sizes({1000000})
          .distributions({"uniform"})
          .modes()
          .runs();
    });

}  // namespace
}  // namespace flaunay::bench::threads
