#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "app/command/commands.hpp"
#include "app/command/options.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/conformance/run.hpp"
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

int test(const conformance::Request& request) {
#ifdef FLAUNAY_WITHOUT_OPENCL
  fail_usage("--test: this build of flaunay does not use OpenCL devices");
#else
  return conformance::run(request) ? kSuccess : kFailure;
#endif
}

}  // namespace

void add_devices(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("devices", "List the host and the OpenCL devices, with the result of the self-test");
  const auto request = std::make_shared<conformance::Request>();
  const auto is_test = std::make_shared<bool>(false);
  CLI::Option* asks = command->add_flag(
      "--test", *is_test, "Test a device: every call and every kernel, byte by byte, against the host");
  add_device(command, request->device)->needs(asks);
  command->add_option("--only", request->only, "Of --test, only this call")->needs(asks);
  command->add_option("--points", request->points, "Of --test, about so many points per input")
      ->check(CLI::Range(32, 1000000))
      ->capture_default_str()
      ->needs(asks);
  add_path(command, "--record", request->record,
           "Of --test, a file for the results, as JSON; what has passed according to it is not run again")
      ->needs(asks);
  command->footer(examples({"flaunay devices", "flaunay devices --test --device '#0' --only sets"}));
  command->callback([&action, request, is_test] {
    action = [request, is_test] { return *is_test ? test(*request) : devices(); };
  });
}

}  // namespace flaunay::cli
