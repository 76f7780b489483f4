// Options that several subcommands have.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::cli {

/// Beyond these levels there are more regions than indices.
constexpr int kMostPartitionLevels = 30;

/// The points, as the first argument.
void add_input(CLI::App* command, std::string& path);

/// An option that takes a path. An empty one, as from an unset shell variable, is a mistake and not "none".
CLI::Option* add_path(CLI::App* command, const std::string& option, std::string& path,
                      const std::string& description);

void add_cut(CLI::App* command, Cut& cut);
/// variants: those that the subcommand can use.
void add_hull_variant(CLI::App* command, Hull& variant, const std::vector<Hull>& variants,
                      const std::string& description);
void add_device(CLI::App* command, std::string& device);
CLI::Option* add_threads(CLI::App* command, int& threads, const std::string& description);
void add_quiet(CLI::App* command, bool& quiet);

/// As --cut takes it.
const char* to_string(Cut cut);

/// Throws Error(usage) with the reason if the option was given.
void refuse(const CLI::App& command, const std::string& option, const std::string& reason);

/// An option whose values are an enumeration's, by their names.
template <typename Choice>
void add_choice(CLI::App* command, const std::string& option, Choice& value, const std::string& description,
                const std::vector<Choice>& choices) {
  std::vector<std::string> names;
  for (const Choice choice : choices) names.emplace_back(to_string(choice));
  const auto choose = [&value, choices](const std::string& name) {
    for (const Choice choice : choices) {
      if (to_string(choice) == name) value = choice;
    }
  };
  command->add_option_function<std::string>(option, choose, description)
      ->check(CLI::IsMember(names))
      ->default_str(names.front());
}

}  // namespace flaunay::cli
