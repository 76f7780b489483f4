// Options that several subcommands share.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "app/files/points.hpp"
#include "flaunay/research.hpp"
#include "geometry/enumerators.hpp"

namespace flaunay::cli {

using research::Cut;
using research::Finish;
using research::Hull;
using research::Mode;

/// With more levels there would be more regions than 32-bit indices.
constexpr int kMostPartitionLevels = 30;

/// The first positional argument, the file with the points, and --columns.
void add_input(CLI::App* command, std::string& path, io::Columns& columns);
/// --columns: which columns of text are read.
void add_columns(CLI::App* command, io::Columns& columns, const std::string& what);

/// --height: the field of layers that has heights.
CLI::Option* add_heights(CLI::App* command, io::Columns& columns);
/// --line-height, of the map of another option.
void add_line_heights(CLI::App* command, std::vector<std::string>& fields, const std::string& of);
/// --fields: the fields of points that are kept.
void add_fields(CLI::App* command, io::Columns& columns, const std::string& text);
/// Throws Error(usage) for --fields of an input without fields, and for --height if the edges have none
/// either.
void check_fields(const CLI::App& command, const std::string& input, const std::string& edges = "");
/// --crs: the system of the coordinates.
CLI::Option* add_crs(CLI::App* command, std::string& crs);

/// An option that takes a path. An empty path, as from an unset shell variable, is an error and does not mean
/// "none".
CLI::Option* add_path(CLI::App* command, const std::string& option, std::string& path,
                      const std::string& description);

/// Puts the options that were added since the last call below this heading of the help.
void end_group(CLI::App* command, const std::string& heading);
/// Examples for the end of the help, in lines.
std::string examples(const std::vector<std::string>& lines);

void add_cut(CLI::App* command, Cut& cut);
/// variants: those that the subcommand supports.
void add_hull_variant(CLI::App* command, Hull& variant, const std::vector<Hull>& variants,
                      const std::string& description);
CLI::Option* add_device(CLI::App* command, std::string& device);
CLI::Option* add_threads(CLI::App* command, int& threads, const std::string& description);
/// --memory: a number of bytes such as 4G, at least 1.
CLI::Option* add_memory(CLI::App* command, std::uint64_t& bytes, const std::string& description);
void add_quiet(CLI::App* command, bool& quiet);

/// Throws Error(usage) with the reason if the option was given on the command line.
void refuse(const CLI::App& command, const std::string& option, const std::string& reason);
void refuse_all(const CLI::App& command, const std::vector<std::string>& options, const std::string& reason);
/// Throws Error(usage) for options beside `own`, and those that go with the first of these, in `others`.
void refuse_all_but(const CLI::App& command, const std::vector<std::string>& own,
                    const std::vector<std::string>& others);

/// Names of values.
template <typename Choice>
using NamedChoices = std::vector<std::pair<std::string, Choice>>;

/// All enumerators.
template <typename Enum>
NamedChoices<Enum> all_of() {
  NamedChoices<Enum> choices;
  for (int k = 0; k < end_of_enumerators<Enum>(); ++k) {
    choices.emplace_back(word_of(static_cast<Enum>(k)), static_cast<Enum>(k));
  }
  return choices;
}

/// An option whose values are names.
template <typename Choice>
CLI::Option* add_named_choice(CLI::App* command, const std::string& option, Choice& value,
                              const std::string& description, const NamedChoices<Choice>& choices) {
  std::vector<std::string> names;
  for (const auto& choice : choices) names.push_back(choice.first);
  const auto choose = [&value, choices](const std::string& name) {
    for (const auto& choice : choices) {
      if (choice.first == name) value = choice.second;
    }
  };
  return command->add_option_function<std::string>(option, choose, description)->check(CLI::IsMember(names));
}

/// An option whose values are the names of enumerators; the first one is the default.
template <typename Choice>
void add_choice(CLI::App* command, const std::string& option, Choice& value, const std::string& description,
                const std::vector<Choice>& choices) {
  NamedChoices<Choice> named;
  for (const Choice choice : choices) named.emplace_back(to_string(choice), choice);
  add_named_choice(command, option, value, description, named)->default_str(named.front().first);
}

}  // namespace flaunay::cli
