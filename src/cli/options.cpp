#include "cli/options.hpp"

#include <fmt/format.h>

namespace flaunay::cli {

void add_input(CLI::App* command, std::string& path) {
  command
      ->add_option("input", path,
                   "Points: .npy, .node, .xy, .txt, .csv, .bin, or - for text from standard input")
      ->required();
}

CLI::Option* add_path(CLI::App* command, const std::string& option, std::string& path,
                      const std::string& description) {
  const CLI::Validator not_empty(
      [](std::string& text) { return text.empty() ? std::string("the path is empty") : std::string(); },
      "PATH");
  return command->add_option(option, path, description)->check(not_empty);
}

void add_cut(CLI::App* command, Cut& cut) {
  add_choice<Cut>(command, "--cut", cut, "Cut across the longer interquartile range, or alternate x and y",
                  {Cut::interquartile, Cut::alternate});
}

void add_hull_variant(CLI::App* command, Hull& variant, const std::vector<Hull>& variants,
                      const std::string& description) {
  add_choice(command, "--hull-variant", variant, description, variants);
}

void add_device(CLI::App* command, std::string& device) {
  command->add_option("--device", device, "OpenCL device: part of its name, or #k; see flaunay devices");
}

CLI::Option* add_threads(CLI::App* command, int& threads, const std::string& description) {
  constexpr int kMostThreads = 1024;
  return command->add_option("--threads", threads, description)->check(CLI::Range(1, kMostThreads));
}

void add_quiet(CLI::App* command, bool& quiet) {
  command->add_flag("--quiet", quiet, "No progress, no tables and no final line");
}

const char* to_string(Cut cut) { return cut == Cut::alternate ? "alternate" : "iqr"; }

void refuse(const CLI::App& command, const std::string& option, const std::string& reason) {
  if (command.count(option) > 0) throw Error(ErrorKind::usage, fmt::format("{}: {}", option, reason));
}

}  // namespace flaunay::cli
