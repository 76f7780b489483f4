// What every result file carries, so that its numbers can be judged and had again.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "flaunay/flaunay.hpp"

namespace flaunay::bench {

/// device, driver, platform, host, commit, command, date and runs; results are added by whoever measures.
nlohmann::json record(const DeviceInfo& device, const std::string& command, int runs);

/// The same in a few words, as the subtitle of a plot.
std::string measured_on(const DeviceInfo& device, int runs);

/// Throws Error(input) if path cannot be written.
void write_record(const std::string& path, const nlohmann::json& record);

/// Throws Error(input) unless all the paths that are not empty can be written: before hours of measuring.
void check_writable(const std::vector<std::string>& paths);

}  // namespace flaunay::bench
