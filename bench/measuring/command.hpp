// Registration and options that all subcommands share.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "bench/measuring/result.hpp"

namespace flaunay::bench {

/// The number of runs, the inputs, and the file for the record. Each subcommand has options for some of
/// these; subcommands with options of their own derive from it.
struct Request {
  int runs = 5;
  std::string device, json_path, program;
  std::vector<std::size_t> sizes;
  std::vector<std::string> distributions, modes;
  double limit = 60;
  bool quick = false;
};

/// The names that --modes takes: every mode, the default first.
std::vector<std::string> mode_names();

/// Adds options to a subcommand. All show their default values.
class Options {
  using Texts = std::vector<std::string>;

 public:
  Options(CLI::App& app, Request& request);

  /// Lists are separated by commas. Numbers have to be positive unless there is another check.
  template <typename Value>
  Options& add(const std::string& name, Value& value, const std::string& description,
               const std::optional<CLI::Validator>& check = {}) {
    CLI::Option* option = app_.add_option(name, value, description)->capture_default_str();
    constexpr bool is_list = requires { value.emplace_back(); };
    if (is_list) option->delimiter(',');
    constexpr bool has_text = std::is_same_v<Value, std::string> || std::is_same_v<Value, Texts>;
    if (check || !has_text) option->check(check.value_or(CLI::PositiveNumber));
    return *this;
  }
  Options& flag(const std::string& name, bool& value, const std::string& description) {
    app_.add_flag(name, value, description);
    return *this;
  }
  Options& help(const std::string& text) {
    app_.footer(text);
    return *this;
  }

  // Options of many subcommands, with their defaults.
  Options& runs(int count = 5) { return add("--runs", request_.runs = count, "counted runs of each"); }
  Options& sizes(const std::vector<std::size_t>& values,
                 const std::string& description = "numbers of points") {
    return add("--sizes", request_.sizes = values, description);
  }
  Options& distributions(const Texts& names) {
    return add("--distributions", request_.distributions = names, "which (see flaunay generate --help)");
  }
  Options& modes(const Texts& names = {"blocks"}) {
    return add("--modes", request_.modes = names, "flaunay's modes", CLI::IsMember(mode_names()));
  }
  Options& quick(const std::string& points = "3,000 points") {
    return flag("--quick", request_.quick, points + ": shows that it works, and no more");
  }
  Options& program(const std::string& name) {
    return add("--program", request_.program, "default: " + name + " beside this program");
  }

 private:
  CLI::App& app_;
  Request& request_;
};

/// Any value is valid.
inline const CLI::Validator kAny;

/// The work of the chosen subcommand, given the command line as the record shows it; returns the exit code.
using Action = std::function<int(const std::string& command_line)>;

/// Measures, prints the tables, and writes the record if one was asked for.
int measure_and_record(const std::string& subcommand, const std::string& command_line, const Request& request,
                       const std::function<Result()>& measure);

/// All subcommands by name, each with the function that adds it to the program.
using Subcommands = std::map<std::string, std::function<void(CLI::App&, Action&)>>;
Subcommands& all_subcommands();

/// A subcommand. Each is an object in the file of its name, whose constructor adds it to the list.
struct Subcommand {
  template <typename OwnRequest>
  Subcommand(const std::string& name, const std::string& description, const std::string& help,
             Result (*measure)(const OwnRequest&),
             std::type_identity_t<void (*)(Options&, OwnRequest&)> add_options) {
    all_subcommands()[name] = [=](CLI::App& app, Action& action) {
      const auto request = std::make_shared<OwnRequest>();
      CLI::App* const command = app.add_subcommand(name, description);
      Options options(*command, *request);
      options.help(help);
      add_options(options, *request);
      command->callback([=, &action] {
        action = [=](const std::string& line) {
          return measure_and_record(name, line, *request, [=] { return measure(*request); });
        };
      });
    };
  }
};

}  // namespace flaunay::bench
