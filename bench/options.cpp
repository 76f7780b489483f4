#include "options.hpp"

#include "inputs.hpp"
#include "record.hpp"

namespace flaunay::bench {

void add_measurement_options(CLI::App* command, Measurement& measurement) {
  command->add_option("--runs", measurement.runs, "counted runs of each")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_device_option(command, measurement.device);
  command->add_option("--json", measurement.json_path, "write the results here");
  command->add_option("--plot", measurement.plot_path, "write a plot here, as SVG");
}

void add_device_option(CLI::App* command, std::string& device) {
  command->add_option("--device", device, "device, as for flaunay triangulate");
}

void add_sizes_option(CLI::App* command, std::vector<std::size_t>& sizes, const std::string& description) {
  command->add_option("--sizes", sizes, description)
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void add_distributions_option(CLI::App* command, std::vector<std::string>& distributions) {
  command->add_option("--distributions", distributions, "which (see flaunay generate --help)")
      ->delimiter(',')
      ->capture_default_str();
}

void add_modes_option(CLI::App* command, std::vector<std::string>& modes) {
  command->add_option("--modes", modes, "flaunay's modes")
      ->delimiter(',')
      ->check(CLI::IsMember(mode_names()))
      ->capture_default_str();
}

void add_limit_option(CLI::App* command, double& limit, const std::string& description) {
  command->add_option("--limit", limit, description)->check(CLI::PositiveNumber)->capture_default_str();
}

void check_writable(const Measurement& measurement) {
  check_writable({measurement.json_path, measurement.plot_path});
}

void write_files(const Measurement& measurement, const nlohmann::json& record,
                 const std::function<plot::Figure()>& figure) {
  if (!measurement.json_path.empty()) write_record(measurement.json_path, record);
  if (!measurement.plot_path.empty()) plot::write(measurement.plot_path, figure());
}

}  // namespace flaunay::bench
