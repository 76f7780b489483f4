// flaunay-bench processes: the command as a whole process, from its start to its end.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "app/files/points.hpp"
#include "command.hpp"
#include "files/output.hpp"
#include "inputs.hpp"
#include "program.hpp"
#include "timing.hpp"

extern char** environ;

namespace flaunay::bench::processes {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNoOption = "default";
// Before an option: with no kernels that were compiled before.
constexpr std::string_view kCold = "cold:";

struct Request : Measurement {
  std::string program;
  std::vector<std::size_t> sizes{1000, 1000000};
  std::vector<std::string> choices{kNoOption, "device=host", "device=#0", "cold:device=#0", "mode=dwyer"};
};

// The environment of this process, and folders without compiled kernels: flaunay's and PoCL's.
std::vector<std::string> cold_environment(const Folder& empty) {
  std::vector<std::string> all;
  for (char** variable = environ; *variable != nullptr; ++variable) all.emplace_back(*variable);
  for (const std::string name : {"FLAUNAY_CACHE_DIR=", "POCL_CACHE_DIR="}) {
    const auto is_named = [&](const std::string& text) { return text.compare(0, name.size(), name) == 0; };
    all.erase(std::remove_if(all.begin(), all.end(), is_named), all.end());
    const std::string folder = empty.file(name.substr(0, name.size() - 1));
    fs::create_directory(folder);
    all.push_back(name + folder);
  }
  return all;
}

double run_timed(const std::vector<std::string>& words, bool is_cold) {
  if (!is_cold) return run_program(words).seconds;
  const Folder empty;
  return run_program(words, cold_environment(empty)).seconds;
}

Result measure_processes(const Request& request) {
  const std::string program = request.program.empty() ? beside_this("flaunay") : request.program;
  const Folder folder;
  std::vector<Job> jobs;
  Result result;
  result.tables["results"] = Json::array();
  std::vector<Json> rows;
  for (const std::size_t n : request.sizes) {
    const std::string points = folder.file(fmt::format("{}.npy", n));
    io::Outputs outputs;
    io::write_points(outputs, points, {make_input("uniform", n).coordinates});
    outputs.commit();
    for (const std::string& choice : request.choices) {
      std::vector<std::string> words = {program, "triangulate", points};
      const bool is_cold = choice.compare(0, kCold.size(), kCold) == 0;
      const std::string option = is_cold ? choice.substr(kCold.size()) : choice;
      if (option != kNoOption) {
        const std::size_t equals = std::min(option.find('='), option.size());
        words.push_back("--" + option.substr(0, equals));
        if (equals < option.size()) words.push_back(option.substr(equals + 1));
      }
      for (const char* word : {"--triangles", "t.npy", "--neighbors", "n.npy"}) {
        words.push_back(*word == '-' ? word : folder.file(word));
      }
      jobs.push_back({fmt::format("flaunay {}, {} points", choice, n),
                      [words, is_cold] { return run_timed(words, is_cold); }});
      rows.push_back({{"option", choice}, {"distribution", "uniform"}, {"n", n}});
    }
  }
  run_interleaved(jobs, request.runs);
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    if (!jobs[k].skipped.empty()) {
      rows[k]["skipped"] = jobs[k].skipped;
      result.agree = false;
    } else {
      add_seconds(rows[k], jobs[k].seconds);
    }
    result.tables["results"].push_back(rows[k]);
  }
  result.device = Triangulator(request.device).device();
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  request->runs = 11;
  CLI::App* command = add_command(
      app, action, "processes", "the command as whole processes, from start to end",
      "Times are wall times of flaunay triangulate from .npy to .npy, triangles and neighbours, with the "
      "operating system's and the drivers' caches filled by a first run that is not counted. All take turns. "
      "Options that begin with cold: run with empty folders of compiled kernels each time.",
      request, measure_processes);
  command->add_option("--program", request->program, "the command; default: flaunay beside this program");
  add_sizes_option(command, request->sizes);
  add_option(command, "--options", request->choices, "options of the command to compare, such as mode=dwyer");
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::processes
