#include "app/command/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "app/files/formats.hpp"
#include "files/file.hpp"

namespace flaunay::cli {

void add_columns(CLI::App* command, io::Columns& columns, const std::string& what) {
  command
      ->add_option(
          "--columns", columns.names,
          fmt::format(
              "Of text and .npy, the columns with {}: names of a header, or numbers from 0; default: the "
              "first ones",
              what))
      ->delimiter(',')
      ->expected(2, 3)
      ->allow_extra_args(false)
      ->type_name("X,Y[,Z]");
}

CLI::Option* add_heights(CLI::App* command, io::Columns& columns) {
  return command
      ->add_option(
          "--height", columns.heights,
          "Of layers and GeoJSON, the field that has the height, in place of that of positions; of several, "
          "the first one that a layer has")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("FIELD");
}

void add_line_heights(CLI::App* command, std::vector<std::string>& fields, const std::string& of) {
  command->add_option("--line-height", fields, fmt::format("Of {}, in place of --height", of))
      ->needs(of)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("FIELD");
}

void add_fields(CLI::App* command, io::Columns& columns, const std::string& text) {
  command->add_option("--fields", columns.fields, text)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("FIELD");
}

void check_fields(const CLI::App& command, const std::string& input, const std::string& edges) {
  std::vector<std::string> names = command.get_option("--fields")->results();
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) refuse(command, "--fields", io::printable("names " + *twice + " twice"));
  if (io::has_fields(input)) return;
  const std::string shown = io::shown_path(input);
  if (io::is_column_text(input)) {
    if (!io::has_fields(edges))
      refuse(command, "--height", shown + " has columns: say by --columns which have x, y and the height");
    return;
  }
  const std::string reason = shown + " has no fields; layers, GeoJSON and text have some";
  refuse(command, "--fields", reason);
  if (!io::has_fields(edges)) refuse(command, "--height", reason);
}

CLI::Option* add_crs(CLI::App* command, std::string& crs) {
  return command->add_option(
      "--crs", crs, "The system of the coordinates, such as EPSG:25832, in place of that of the files");
}

void add_input(CLI::App* command, std::string& path, io::Columns& columns) {
  command
      ->add_option(
          "input", path,
          fmt::format(
              "Points: {}, or - for text from standard input; of these, {} are maps. Of files with several "
              "layers, one: FILE.gpkg:LAYER",
              io::endings_for(io::Use::read_points), io::endings_for(io::Use::read_map)))
      ->required();
  add_columns(command, columns, "x, y and perhaps a height");
}

CLI::Option* add_path(CLI::App* command, const std::string& option, std::string& path,
                      const std::string& description) {
  const CLI::Validator not_empty(
      [](std::string& text) { return text.empty() ? std::string("the path is empty") : std::string(); },
      "PATH");
  return command->add_option(option, path, description)->check(not_empty);
}

void end_group(CLI::App* command, const std::string& heading) {
  const std::string others = command->get_help_ptr()->get_group();
  for (CLI::Option* const option : command->get_options()) {
    if (option->get_group() == others && option != command->get_help_ptr()) option->group(heading);
  }
}

std::string examples(const std::vector<std::string>& lines) {
  return fmt::format("Examples:\n  {}\n", fmt::join(lines, "\n  "));
}

void add_cut(CLI::App* command, Cut& cut) {
  add_choice<Cut>(command, "--cut", cut,
                  "How regions are cut: across the longer interquartile range, or in x and y in turn",
                  {Cut::interquartile, Cut::alternate});
}

void add_hull_variant(CLI::App* command, Hull& variant, const std::vector<Hull>& variants,
                      const std::string& description) {
  add_choice(command, "--hull-variant", variant, description, variants);
}

CLI::Option* add_device(CLI::App* command, std::string& device) {
  return command->add_option(
      "--device", device, "OpenCL device: a part of its name, or #k for the k-th that flaunay devices lists");
}

CLI::Option* add_threads(CLI::App* command, int& threads, const std::string& description) {
  constexpr int kMostThreads = 1024;
  return command->add_option("--threads", threads, description)->check(CLI::Range(1, kMostThreads));
}

CLI::Option* add_memory(CLI::App* command, std::uint64_t& bytes, const std::string& description) {
  constexpr std::uint64_t kLeast = 1;
  CLI::Validator size =
      CLI::AsSizeValue(false) & CLI::Range(kLeast, std::numeric_limits<std::uint64_t>::max());
  // CLI11 itself would turn negative numbers into large ones.
  const CLI::Validator not_negative(
      [](std::string& text) {
        return text.find('-') == std::string::npos ? "" : fmt::format("{} is below 1", text);
      },
      "");
  return command->add_option("--memory", bytes, description)
      ->transform(size.description("SIZE"))
      ->transform(not_negative);  // CLI11 calls the last one first
}

void add_quiet(CLI::App* command, bool& quiet) {
  command->add_flag("--quiet", quiet, "No progress, no tables and no final line");
}

void refuse(const CLI::App& command, const std::string& option, const std::string& reason) {
  if (command.count(option) > 0) throw Error(ErrorKind::usage, fmt::format("{}: {}", option, reason));
}

void refuse_all(const CLI::App& command, const std::vector<std::string>& options, const std::string& reason) {
  for (const std::string& option : options) refuse(command, option, reason);
}

void refuse_all_but(const CLI::App& command, const std::vector<std::string>& own,
                    const std::vector<std::string>& others) {
  const auto contains = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const CLI::Option* const option : command.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || option->get_positional() || contains(own, name) || contains(others, name)) {
      continue;
    }
    std::vector<std::string> all(own.begin() + 1, own.end());
    all.insert(all.end(), others.begin(), others.end());
    throw Error(ErrorKind::usage, fmt::format("{}: does not go with {}, which has {}", name, own.front(),
                                              fmt::join(all, ", ")));
  }
}

}  // namespace flaunay::cli
