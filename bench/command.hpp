// What all subcommands share: their options, the tables that they print, and the records that they write.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "timing.hpp"

namespace flaunay::bench {

/// Objects keep the order in which their keys were added.
using Json = nlohmann::ordered_json;

/// How often and on what to measure, and where the record goes.
struct Measurement {
  int runs = 5;
  std::string device, json_path;
};

/// What a subcommand has measured.
struct Result {
  DeviceInfo device;
  /// Tables: each key has a list of rows, and each row is an object. Numbers are rounded when it is written.
  Json tables = Json::object();
  std::set<std::string> not_printed = {};  ///< tables that only the record has
  Json facts = Json::object();             ///< more about all of the record
  bool agree = true;                       ///< whether all implementations agree; if not, the exit code is 1
};

/// The work of the chosen subcommand, given the command line as the record shows it; returns the exit code.
using Action = std::function<int(const std::string& command_line)>;

/// Measures, prints the tables, and writes the record if one was asked for.
int measure_and_record(const std::string& subcommand, const std::string& command_line,
                       const Measurement& measurement, const std::function<Result()>& measure);

/// What was compiled, as git describes it.
const char* commit();

/// Adds a subcommand with --json and --device; its Request derives from Measurement.
template <typename Request>
CLI::App* add_command(CLI::App& app, Action& action, const std::string& name, const std::string& description,
                      const std::string& help, const std::shared_ptr<Request>& request,
                      Result (*measure)(const Request& request)) {
  CLI::App* command = app.add_subcommand(name, description);
  command->footer(help);
  command->add_option("--json", request->json_path,
                      "write the record here; bench/plot.py RECORD.json -o FILE.svg draws it");
  command->add_option("--device", request->device, "device, as for flaunay triangulate");
  command->callback([name, request, measure, &action] {
    action = [=](const std::string& line) {
      return measure_and_record(name, line, *request, [&] { return measure(*request); });
    };
  });
  return command;
}

/// Adds an option that shows its default value; numbers have to be positive.
template <typename Value>
CLI::Option* add_option(CLI::App* command, const std::string& name, Value& value,
                        const std::string& description) {
  return command->add_option(name, value, description)->check(CLI::PositiveNumber)->capture_default_str();
}

/// A list separated by commas; its numbers have to be positive.
template <typename Value>
CLI::Option* add_option(CLI::App* command, const std::string& name, std::vector<Value>& values,
                        const std::string& description) {
  CLI::Option* option = command->add_option(name, values, description)->delimiter(',')->capture_default_str();
  if (std::is_arithmetic_v<Value>) option->check(CLI::PositiveNumber);
  return option;
}

void add_runs_option(CLI::App* command, int& runs);
void add_sizes_option(CLI::App* command, std::vector<std::size_t>& sizes,
                      const std::string& description = "numbers of points");
void add_distributions_option(CLI::App* command, std::vector<std::string>& distributions);
void add_modes_option(CLI::App* command, std::vector<std::string>& modes);

// ---- Rows

/// Adds seconds_median, seconds_min and seconds_max.
void add_seconds(Json& row, const std::vector<double>& seconds);

/// The value, or null.
Json json_of(const std::optional<double>& value);

/// a / b, if both are there.
std::optional<double> ratio(std::optional<double> a, std::optional<double> b);

/// A row of the table "targets". Where less is better, the goal is less than `at_least`, which then is the
/// most that is allowed.
Json target(const std::string& what, const std::string& implementation, double at_least, double goal,
            const std::optional<double>& measured);

}  // namespace flaunay::bench
