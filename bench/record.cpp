#include "record.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <thread>

#include "io/file.hpp"

namespace flaunay::bench {
namespace {

/// What the host's processor calls itself, and how many threads it runs at once.
std::string host_description() {
  std::ifstream information("/proc/cpuinfo");
  std::string model = "unknown processor";
  for (std::string line; std::getline(information, line);) {
    const std::size_t colon = line.find(": ");
    if (line.compare(0, 10, "model name") == 0 && colon != std::string::npos) {
      model = line.substr(colon + 2);
      break;
    }
  }
  return fmt::format("{}, {} hardware threads", model, std::thread::hardware_concurrency());
}

}  // namespace

nlohmann::json record(const DeviceInfo& device, const std::string& command, int runs) {
  return {{"device", device.name},
          {"driver", device.driver},
          {"platform", device.platform},
          {"host", host_description()},
          {"commit", FLAUNAY_COMMIT},
          {"command", command},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
          {"runs", runs}};
}

std::string measured_on(const DeviceInfo& device, int runs) {
  const std::string times =
      runs == 1 ? "one run" : fmt::format("median of {} runs, minimum to maximum", runs);
  return fmt::format("{}; {}, driver {}", times, device.name, device.driver);
}

void write_record(const std::string& path, const nlohmann::json& record) {
  io::OutputFile file(path);
  const std::string text = record.dump(2) + "\n";
  file.write(text.data(), text.size());
  file.commit();
}

void check_writable(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (!path.empty()) io::OutputFile::check(path);
  }
}

}  // namespace flaunay::bench
