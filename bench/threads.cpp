// flaunay-bench threads: what more threads of the driver are worth.
#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "child.hpp"
#include "commands.hpp"
#include "contest.hpp"
#include "inputs.hpp"
#include "options.hpp"
#include "plot.hpp"
#include "record.hpp"

namespace flaunay::bench {
namespace {

constexpr const char* kVariable = "POCL_MAX_PTHREAD_COUNT";
/// The goal for k threads is this share of k.
constexpr double kGoalEfficiency = 0.9;

struct Request {
  std::vector<int> counts{1, 2};
  std::vector<std::size_t> sizes{1000000};
  std::vector<std::string> distributions{"uniform"};
  std::vector<std::string> modes{default_mode_name()};
  Measurement measurement;
};

std::string help() {
  return fmt::format(
      "{} is read when the driver is loaded, so each number of threads has processes of its own: in each "
      "round "
      "one for every number, which runs everything once without counting and once that counts. Mode "
      "partition "
      "has as many host threads, too. The goal is a speedup of {:g} for each thread. Drivers other than PoCL "
      "do not know the variable; a warning says so where the number of compute units does not follow it.",
      kVariable, kGoalEfficiency);
}

/// All entries on so many threads.
struct Team {
  int threads;
  std::vector<Entry> entries;
};

std::vector<Team> make_teams(const Request& request, const std::vector<Input>& inputs) {
  std::vector<Implementation> named;
  for (const std::string& mode : request.modes) named.push_back({implementation_name(mode), {}});
  std::vector<Team> teams;
  for (const int threads : request.counts) teams.push_back({threads, make_entries(named, inputs)});
  return teams;
}

/// What the child process does: measures once, and tells the times in the order of the entries.
std::string measure_here(const Request& request, Team team) {
  setenv(kVariable, std::to_string(team.threads).c_str(), 1);
  Triangulator triangulator(request.measurement.device);
  const std::vector<Implementation> implementations =
      mode_implementations(triangulator, request.modes, team.threads);
  measure(team.entries, implementations, 1);
  nlohmann::json told{{"compute_units", triangulator.device().compute_units}};
  for (const Entry& entry : team.entries) {
    told["entries"].push_back(
        {{"seconds", entry.seconds}, {"triangles", entry.triangles}, {"skipped", entry.skipped}});
  }
  return told.dump();
}

/// Adds the times of one child process to the team's.
void measure_in_child(const Request& request, Team& team) {
  const Answer answer = ask_child([&] { return measure_here(request, team); });
  if (!answer.failure.empty()) {
    throw Error(ErrorKind::device,
                fmt::format("the process with {} threads {}", team.threads, answer.failure));
  }
  const auto told = nlohmann::json::parse(answer.text);
  if (told.at("compute_units") != team.threads) {
    fmt::print(stderr, "WARNING: with {}={} the device has {} compute units\n", kVariable, team.threads,
               told.at("compute_units").get<int>());
  }
  for (std::size_t e = 0; e < team.entries.size(); ++e) {
    const auto& from = told.at("entries").at(e);
    Entry& entry = team.entries[e];
    entry.triangles = from.at("triangles");
    entry.skipped = from.at("skipped");
    for (const double seconds : from.at("seconds")) entry.seconds.push_back(seconds);
  }
}

/// One entry on the first number of threads and on another.
struct Speedup {
  const Entry* entry;
  int from, to;
  double ratio;

  double goal() const { return kGoalEfficiency * to / from; }
};

std::vector<Speedup> speedups_of(const std::vector<Team>& teams) {
  std::vector<Speedup> speedups;
  const Team& first = teams.front();
  for (std::size_t e = 0; e < first.entries.size(); ++e) {
    for (std::size_t t = 1; t < teams.size(); ++t) {
      const Entry &slow = first.entries[e], &fast = teams[t].entries[e];
      if (!slow.valid() || !fast.valid()) continue;
      speedups.push_back({&slow, first.threads, teams[t].threads,
                          summary(slow.seconds).median / summary(fast.seconds).median});
    }
  }
  return speedups;
}

void print_speedups(const std::vector<Speedup>& speedups) {
  fmt::print("\n{:<24} {:<18} {:>9} {:>10} {:>9} {:>9}\n", "implementation", "distribution", "n", "threads",
             "speedup", "goal");
  for (const Speedup& s : speedups) {
    fmt::print("{:<24} {:<18} {:>9} {:>10} {:>9.2f} {:>9.2f}\n", s.entry->implementation,
               s.entry->input->distribution, s.entry->input->n, fmt::format("{} -> {}", s.from, s.to),
               s.ratio, s.goal());
  }
}

nlohmann::json record_of(const std::vector<Speedup>& speedups) {
  nlohmann::json result = nlohmann::json::array();
  for (const Speedup& s : speedups) {
    result.push_back({{"implementation", s.entry->implementation},
                      {"distribution", s.entry->input->distribution},
                      {"n", s.entry->input->n},
                      {"from_threads", s.from},
                      {"to_threads", s.to},
                      {"speedup", s.ratio},
                      {"goal", s.goal()}});
  }
  return result;
}

/// The entries of all teams, each row with its number of threads.
void add_teams(nlohmann::json& file, const std::vector<Team>& teams) {
  for (const char* key : {"results", "skipped"}) file[key] = nlohmann::json::array();
  for (const Team& team : teams) {
    nlohmann::json own;
    add_entries(own, team.entries);
    for (const char* key : {"results", "skipped"}) {
      for (nlohmann::json& row : own[key]) {
        row["threads"] = team.threads;
        file[key].push_back(row);
      }
    }
  }
}

plot::Figure figure_of(const std::vector<Team>& teams, const std::vector<Input>& inputs,
                       const Request& request, const DeviceInfo& device) {
  plot::Figure figure;
  figure.title = "Time by number of threads";
  figure.subtitle = measured_on(device, request.measurement.runs);
  for (const Input& input : inputs) {
    plot::Bars panel;
    panel.title = input_name(input);
    panel.y = {"time", plot::Scale::linear, plot::Unit::seconds};
    panel.values = true;
    for (const Team& team : teams) {
      panel.groups.push_back(time_bars(team.entries, input, fmt::format("threads: {}", team.threads)));
    }
    figure.panels.push_back(panel);
  }
  return figure;
}

int run(const Request& request, const std::string& command) {
  const Measurement& measurement = request.measurement;
  check_writable(measurement);
  const std::vector<Input> inputs = make_inputs(request.distributions, request.sizes);
  std::vector<Team> teams = make_teams(request, inputs);
  for (int round = 0; round < measurement.runs; ++round) {
    for (Team& team : teams) measure_in_child(request, team);
  }

  const std::vector<Speedup> speedups = speedups_of(teams);
  for (const Team& team : teams) {
    fmt::print("threads: {}\n", team.threads);
    print_entries(team.entries);
  }
  print_speedups(speedups);
  // Only now, since child processes are to be made without a device.
  const DeviceInfo device = Triangulator(measurement.device).device();
  nlohmann::json file = record(device, command, measurement.runs);
  add_teams(file, teams);
  file["speedups"] = record_of(speedups);
  write_files(measurement, file, [&] { return figure_of(teams, inputs, request, device); });
  return kSuccess;
}

}  // namespace

void add_threads(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  CLI::App* command = app.add_subcommand("threads", "what more threads of the driver are worth");
  command->footer(help());
  command->add_option("--counts", request->counts, "numbers of threads; speedups are over the first")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_modes_option(command, request->modes);
  add_measurement_options(command, request->measurement);
  set_action(command, action, request, run);
}

}  // namespace flaunay::bench
