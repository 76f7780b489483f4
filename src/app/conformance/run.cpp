#include "app/conformance/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "app/command/json.hpp"
#include "app/command/output.hpp"
#include "app/command/progress.hpp"
#include "app/conformance/calls.hpp"
#include "files/file.hpp"
#include "files/output.hpp"
#include "host/opencl/launch_check.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::conformance {

std::string Arrays::difference_from(const Arrays& expected) const {
  for (std::size_t k = 0; k < std::max(arrays_.size(), expected.arrays_.size()); ++k) {
    if (k >= arrays_.size() || k >= expected.arrays_.size()) {
      return fmt::format("{} arrays on the device, {} on the host", arrays_.size(), expected.arrays_.size());
    }
    const Array &found = arrays_[k], &wanted = expected.arrays_[k];
    if (found.size != wanted.size) {
      return fmt::format("{}: {} values on the device, {} on the host", found.name, found.size, wanted.size);
    }
    if (found.bytes == wanted.bytes) continue;
    const auto byte = static_cast<std::size_t>(
        std::mismatch(found.bytes.begin(), found.bytes.end(), wanted.bytes.begin()).first -
        found.bytes.begin());
    const std::size_t index = byte / (found.bytes.size() / found.size);
    return fmt::format("{}, value {} of {}: {} on the device, {} on the host", found.name, index, found.size,
                       found.text(index), wanted.text(index));
  }
  return "";
}

std::size_t Arrays::bytes() const {
  return std::accumulate(arrays_.begin(), arrays_.end(), std::size_t{0},
                         [](std::size_t sum, const Array& array) { return sum + array.bytes.size(); });
}

namespace {

using cli::Json;

// The results for one device, in a file that is written after every call.
class Record {
 public:
  Record(std::string path, const Json& device) : path_(std::move(path)) {
    if (!path_.empty() && io::find_target(path_).exists) {
      json_ = Json::parse(io::read_file(path_, "a record of --test"), nullptr, false);
    }
    // After a difference everything is run again: kernels may have been mended since.
    const auto differs = [](const Json& kernel) { return kernel.at("difference") != ""; };
    if (!json_.is_object() || json_.value("device", Json()) != device ||
        std::any_of(kernels().begin(), kernels().end(), differs)) {
      json_ = {{"device", device}, {"calls", Json::object()}, {"kernels", Json::object()}};
    }
  }
  bool has_passed(const std::string& call) const {
    const auto& calls = json_.at("calls");
    return calls.contains(call) && calls.at(call).at("difference") == "";
  }
  Json& calls() { return json_.at("calls"); }
  Json& kernels() { return json_.at("kernels"); }
  void write() const {
    if (path_.empty()) return;
    io::Outputs outputs;
    outputs.open(path_).print("{}", cli::text_of(json_));
    outputs.commit();
  }

 private:
  std::string path_;
  Json json_;
};

Json described(const DeviceInfo& device, const Request& request) {
  return {{"name", device.name},     {"platform", device.platform},
          {"driver", device.driver}, {"fixed point", device.fixed_point},
          {"flaunay", version()},    {"tuning", tuning_in_environment()},
          {"points", request.points}};
}

void add_kernels(Json& kernels, const std::map<std::string, host::LaunchCheck::Tested>& tested) {
  for (const auto& [name, kernel] : tested) {
    Json& entry = kernels[name];
    if (entry.is_null()) entry = {{"launches", 0}, {"compared", false}, {"difference", ""}};
    entry["launches"] = entry["launches"].get<std::size_t>() + kernel.launches;
    entry["compared"] = entry["compared"] == true || kernel.was_compared;
    if (entry["difference"] == "") entry["difference"] = kernel.difference;
  }
}

}  // namespace

bool run(const Request& request) {
  const auto is_asked_for = [&](const Call& call) {
    return request.only.empty() || request.only == call.name;
  };
  if (std::none_of(calls().begin(), calls().end(), is_asked_for)) {
    std::string names;
    for (const Call& call : calls()) names += " " + call.name;
    throw Error(ErrorKind::usage, fmt::format("there is no call {}; there are{}", request.only, names));
  }
  Triangulator device(request.device), host("host");
  // The choice for all calls may be the host.
  const std::string host_name = host.device().name;
  if (request.device.empty() && device.device().name == host_name) device = Triangulator("#0");
  const DeviceInfo info = device.device();
  if (info.name == host_name) {
    throw Error(ErrorKind::usage, "the host is what devices are compared with: give another device");
  }
  Record record(request.record, described(info, request));
  cli::print(
      fmt::format("{}, {}, {}: calls and kernels against the host\n", info.name, info.platform, info.driver));
  for (const Call& call : calls()) {
    if (!is_asked_for(call)) continue;
    if (request.only.empty() && record.has_passed(call.name)) {
      cli::print(fmt::format("{:12} passed, as {} has it\n", call.name, request.record));
      continue;
    }
    Arrays expected, found;
    call.make(host, request.points, expected);
    const cli::Stopwatch watch;
    std::string difference;
    // Fixed point has other bits than the host's doubles.
    host::LaunchCheck check(!info.fixed_point);
    try {
      call.make(device, request.points, found);
      difference = found.difference_from(expected);
    } catch (const Error& error) {
      difference = error.what();
    }
    record.calls()[call.name] = {
        {"difference", difference}, {"seconds", watch.seconds()}, {"bytes", found.bytes()}};
    add_kernels(record.kernels(), check.kernels());
    record.write();
    cli::print(fmt::format("{:12} {:6.1f} s, {} bytes, {} kernels: {}\n", call.name, watch.seconds(),
                           found.bytes(), check.kernels().size(),
                           difference.empty() ? "the same" : "DIFFERENT: " + difference));
  }

  std::size_t compared = 0, differences = 0;
  for (const auto& [name, kernel] : record.kernels().items()) {
    compared += kernel.at("compared") == true;
    if (kernel.at("difference") == "") continue;
    ++differences;
    cli::print(fmt::format("kernel {}: DIFFERENT: {}\n", name, kernel.at("difference").get<std::string>()));
  }
  for (const auto& [name, call] : record.calls().items()) differences += call.at("difference") != "";
  cli::print(fmt::format("{} kernels launched, {} of them compared with the host; {} differences\n",
                         record.kernels().size(), compared, differences));
  return differences == 0;
}

}  // namespace flaunay::conformance
