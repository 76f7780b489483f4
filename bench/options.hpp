// Options that several subcommands have, and what follows from them.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.hpp"
#include "plot.hpp"

namespace flaunay::bench {

/// How often and on what to measure, and where to write what came out.
struct Measurement {
  int runs = 5;
  std::string device, json_path, plot_path;
};

/// --runs, --device, --json and --plot.
void add_measurement_options(CLI::App* command, Measurement& measurement);
void add_device_option(CLI::App* command, std::string& device);
void add_sizes_option(CLI::App* command, std::vector<std::size_t>& sizes,
                      const std::string& description = "numbers of points");
void add_distributions_option(CLI::App* command, std::vector<std::string>& distributions);
void add_modes_option(CLI::App* command, std::vector<std::string>& modes);
void add_limit_option(CLI::App* command, double& limit, const std::string& description);

/// Throws Error(input) unless the measurement's files can be written: before hours of measuring.
void check_writable(const Measurement& measurement);

/// Writes those of the measurement's files that were asked for.
void write_files(const Measurement& measurement, const nlohmann::json& record,
                 const std::function<plot::Figure()>& figure);

/// What the subcommand does if it is chosen.
template <typename Request>
void set_action(CLI::App* command, Action& action, const std::shared_ptr<Request>& request,
                int (*run)(const Request& request, const std::string& command)) {
  command->callback([request, run, &action] {
    action = [request, run](const std::string& line) { return run(*request, line); };
  });
}

}  // namespace flaunay::bench
