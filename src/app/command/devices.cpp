#include <fmt/format.h>

#include <string>
#include <vector>

#include "app/command/commands.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::cli {

namespace {

std::string gibibytes(std::size_t bytes) {
  return fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1024.0 * 1024 * 1024));
}

std::string self_test(const DeviceInfo& device) {
  if (device.self_test_passed) return device.fixed_point ? "passed, in fixed point" : "passed";
  return "failed: " + device.self_test_failure;
}

// The OpenCL devices; none, with a note that says why, if there is no OpenCL.
std::vector<DeviceInfo> opencl_devices() {
  try {
    Progress progress(true);
    progress.update_slow("testing devices", "testing devices: compiling kernels, cached for next time");
    return list_devices(true);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::device) throw;
    fmt::print(stderr, "note: {}\n", error.what());
    return {};
  }
}

int devices() {
  const DeviceInfo host = Triangulator("host").device();
  const std::vector<DeviceInfo> found = opencl_devices();

  std::vector<std::vector<std::string>> rows = {{"#", "name", "type", "platform", "driver", "fp64", "memory",
                                                 "available", "largest buffer", "units", "self-test"}};
  rows.push_back({"-", host.name, host.type, host.platform, host.version, "yes", gibibytes(host.memory_bytes),
                  gibibytes(host.available_bytes), "-", std::to_string(host.compute_units), self_test(host)});
  for (std::size_t k = 0; k < found.size(); ++k) {
    const DeviceInfo& device = found[k];
    rows.push_back({fmt::format("#{}", k), device.name, device.type, device.platform, device.driver,
                    device.fp64 ? "yes" : "no", gibibytes(device.memory_bytes),
                    gibibytes(device.available_bytes), gibibytes(device.largest_buffer_bytes),
                    std::to_string(device.compute_units), self_test(device)});
  }
  print(aligned(rows));
  return kSuccess;
}

}  // namespace

void add_devices(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("devices", "List the host and the OpenCL devices, with the result of the self-test");
  command->callback([&action] { action = devices; });
}

}  // namespace flaunay::cli
