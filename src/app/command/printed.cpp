#include "app/command/printed.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <string_view>

#include "flaunay/flaunay.hpp"

namespace flaunay::cli {
namespace {

/// "-o" and "--output" of an option; none of a positional argument.
std::vector<std::string> words_of(const CLI::Option& option) {
  std::vector<std::string> words;
  for (const std::string& name : option.get_snames()) words.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) words.push_back("--" + name);
  return words;
}

std::vector<std::string> words_of(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* const option : command.get_options()) {
    for (const std::string& word : words_of(*option)) words.push_back(word);
  }
  return words;
}

/// The values of an option that takes one of several words: CLI11 describes them as TEXT:{iqr,alternate}.
std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.rfind('}');
  if (begin == type.npos || end == type.npos) return {};
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::vector<const CLI::App*> subcommands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string names_of_subcommands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* const command : subcommands_of(app)) names.push_back(command->get_name());
  return fmt::format("{}", fmt::join(names, " "));
}

/// Lines of a case statement on "SUBCOMMAND WORD-BEFORE", for words that take one of several values.
template <typename Line>
std::string for_choices(const CLI::App& app, const Line& line) {
  std::string lines;
  for (const CLI::App* const command : subcommands_of(app)) {
    for (const CLI::Option* const option : command->get_options()) {
      const std::vector<std::string> choices = choices_of(*option);
      if (choices.empty()) continue;
      for (const std::string& word : words_of(*option))
        lines += line(command->get_name() + " " + word, choices);
    }
  }
  return lines;
}

std::string for_bash(const CLI::App& app) {
  std::string options;
  for (const CLI::App* const command : subcommands_of(app)) {
    options +=
        fmt::format("    {}) words='{}' ;;\n", command->get_name(), fmt::join(words_of(*command), " "));
  }
  const std::string choices = for_choices(app, [](const std::string& before, const auto& values) {
    return fmt::format("    '{}') words='{}' ;;\n", before, fmt::join(values, " "));
  });
  return fmt::format(R"(# Completion of flaunay for bash, which flaunay --print bash has made.
_flaunay() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" words=''
  COMPREPLY=()
  case "${{COMP_WORDS[1]}} ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{}  esac
  if ((COMP_CWORD == 1)); then
    words='{} {}'
  elif [[ $word == -* ]]; then
    case "${{COMP_WORDS[1]}}" in
{}    esac
  fi
  # Without words, names of files.
  [[ -z $words ]] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
}}
complete -o default -F _flaunay flaunay
)",
                     choices, names_of_subcommands(app), fmt::join(words_of(app), " "), options);
}

std::string for_zsh(const CLI::App& app) {
  std::string options;
  for (const CLI::App* const command : subcommands_of(app)) {
    options +=
        fmt::format("    {}) compadd -- {} ;;\n", command->get_name(), fmt::join(words_of(*command), " "));
  }
  const std::string choices = for_choices(app, [](const std::string& before, const auto& values) {
    return fmt::format("  '{}') compadd -- {}; return ;;\n", before, fmt::join(values, " "));
  });
  return fmt::format(R"(#compdef flaunay
# Completion of flaunay for zsh, which flaunay --print zsh has made.
case "$words[2] $words[CURRENT-1]" in
{}esac
if ((CURRENT == 2)); then
  compadd -- {} {}
elif [[ $words[CURRENT] == -* ]]; then
  case "$words[2]" in
{}  esac
else
  _files
fi
)",
                     choices, names_of_subcommands(app), fmt::join(words_of(app), " "), options);
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return result + "'";
}

std::string for_fish(const CLI::App& app) {
  std::string lines = "# Completion of flaunay for fish, which flaunay --print fish has made.\n";
  const auto add = [&lines](const std::string& condition, const CLI::Option& option) {
    lines += "complete -c flaunay -n " + condition;
    for (const std::string& name : option.get_snames()) lines += " -s " + name;
    for (const std::string& name : option.get_lnames()) lines += " -l " + name;
    const std::vector<std::string> choices = choices_of(option);
    if (!choices.empty()) {
      lines += fmt::format(" -x -a '{}'", fmt::join(choices, " "));
    } else if (takes_value(option)) {
      lines += " -r";
    }
    lines += " -d " + quoted(option.get_description()) + "\n";
  };
  for (const CLI::Option* const option : app.get_options()) add("__fish_use_subcommand", *option);
  for (const CLI::App* const command : subcommands_of(app)) {
    lines += fmt::format("complete -c flaunay -n __fish_use_subcommand -f -a {} -d {}\n", command->get_name(),
                         quoted(command->get_description()));
    for (const CLI::Option* const option : command->get_options()) {
      if (!option->get_positional())
        add("'__fish_seen_subcommand_from " + command->get_name() + "'", *option);
    }
  }
  return lines;
}

/// Text of a manual page as it is to be read.
std::string in_roff(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else {
      result += c == '-' ? std::string("\\-") : std::string(1, c);
    }
  }
  return result;
}

std::string item_in_roff(const CLI::Option& option) {
  std::vector<std::string> words = words_of(option);
  if (option.get_positional()) words = {option.get_name(true)};
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "\\fB" : ", \\fB") + in_roff(word) + "\\fR";
  const std::vector<std::string> choices = choices_of(option);
  const std::string type = option.get_type_name();
  if (!choices.empty()) {
    line += " " + in_roff(fmt::format("{}", fmt::join(choices, "|")));
  } else if (takes_value(option) && !option.get_positional()) {
    line += " \\fI" + in_roff(type.substr(type.rfind(':') + 1)) + "\\fR";
  }
  return fmt::format(".TP\n{}\n{}\n", line, in_roff(option.get_description()));
}

std::string manual(const CLI::App& app) {
  std::string page = fmt::format(
      ".TH FLAUNAY 1 \"\" \"flaunay {}\" \"User Commands\"\n.SH NAME\nflaunay \\- {}\n"
      ".SH SYNOPSIS\n\\fBflaunay\\fR \\fISUBCOMMAND\\fR [\\fIARGUMENT\\fR...]\n.SH OPTIONS\n",
      version(), in_roff(app.get_description()));
  for (const CLI::Option* const option : app.get_options()) page += item_in_roff(*option);
  for (const CLI::App* const command : subcommands_of(app)) {
    page += fmt::format(".SH {}\n{}.\n", in_roff(command->get_name()), in_roff(command->get_description()));
    for (const std::string& group : command->get_groups()) {
      std::string items;
      for (const CLI::Option* const option : command->get_options()) {
        if (option->get_group() == group && option != command->get_help_ptr()) items += item_in_roff(*option);
      }
      if (!items.empty()) page += fmt::format(".SS {}\n", in_roff(group)) + items;
    }
    if (!command->get_footer().empty())
      page += fmt::format(".PP\n.nf\n{}\n.fi\n", in_roff(command->get_footer()));
  }
  return page + ".SH ENVIRONMENT\n" + in_roff(app.get_footer()) + "\n";
}

/// How many characters have to be replaced, put in or left out.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (const char c : a) {
    std::size_t diagonal = row[0]++;
    for (std::size_t k = 1; k < row.size(); ++k) {
      const std::size_t replaced = diagonal + (c == b[k - 1] ? 0 : 1);
      diagonal = row[k];
      row[k] = std::min({row[k] + 1, row[k - 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

const std::vector<std::string>& printable_kinds() {
  static const std::vector<std::string> kinds = {"bash", "zsh", "fish", "man"};
  return kinds;
}

std::string printed(const CLI::App& app, const std::string& kind) {
  if (kind == "bash") return for_bash(app);
  if (kind == "zsh") return for_zsh(app);
  return kind == "fish" ? for_fish(app) : manual(app);
}

std::string suggestion(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  std::vector<std::string> known = words_of(chosen.empty() ? app : *chosen.front());
  if (chosen.empty()) {
    for (const CLI::App* const command : subcommands_of(app)) known.push_back(command->get_name());
  }
  for (const std::string& argument : app.remaining(true)) {
    const std::string word = argument.substr(0, argument.find('='));
    const auto is_nearer = [&word](const std::string& a, const std::string& b) {
      return distance(word, a) < distance(word, b);
    };
    const std::string& best = *std::min_element(known.begin(), known.end(), is_nearer);
    if (3 * distance(word, best) <= word.size()) return fmt::format("; did you mean {}, not {}?", best, word);
  }
  return "";
}

}  // namespace flaunay::cli
