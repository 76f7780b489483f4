#include "bench/measuring/calls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace flaunay::bench {
namespace {

using research::Hull;

constexpr Hull kHulls[] = {Hull::prune, Hull::quickhull, Hull::balanced, Hull::monotone_chain};

template <typename Values, typename NameOf>
std::vector<std::string> names_of(const Values& values, const NameOf& name_of) {
  std::vector<std::string> names;
  for (const auto& value : values) names.emplace_back(name_of(value));
  return names;
}

}  // namespace

std::vector<std::string> mode_names() {
  return names_of(research::list_modes(), [](const research::ModeInfo& mode) { return mode.name; });
}

std::vector<std::string> hull_names() {
  return names_of(kHulls, [](Hull hull) { return research::to_string(hull); });
}

const research::ModeInfo& mode_named(const std::string& name) {
  for (const research::ModeInfo& mode : research::list_modes()) {
    if (name == mode.name) return mode;
  }
  throw Error(ErrorKind::usage, fmt::format("no mode is called '{}'", name));
}

Hull hull_named(const std::string& name) {
  const std::vector<std::string> names = hull_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw Error(ErrorKind::usage, fmt::format("no hull is called '{}'", name));
  return kHulls[found - names.begin()];
}

std::string opencl_device(const std::string& given) {
  const char* const named = std::getenv("FLAUNAY_DEVICE");
  if (!given.empty() || (named != nullptr && *named != '\0')) return given;
  return Triangulator().device().platform == "without OpenCL" ? "#0" : given;
}

research::Options options_of(const std::string& mode, const std::string& hull) {
  research::Options options;
  options.mode = mode_named(mode).mode;
  options.hull = hull_named(hull);
  return options;
}

research::Triangulation call(Triangulator& triangulator, const Input& input,
                             const research::Options& options) {
  return research::triangulate(triangulator, input.coordinates.data(), input.offsets, options);
}

research::Triangulation call(Triangulator& triangulator, const double* coordinates, std::size_t n,
                             const research::Options& options) {
  return research::triangulate(triangulator, coordinates, n, options);
}

research::Triangulation call_on_host(const Input& input, const research::Options& options) {
  return research::triangulate_on_host(input.coordinates.data(), input.offsets, options);
}

const char* component_name(std::size_t component) {
  static const char* const kNames[research::kComponents] = {"cut", "hull", "merge", "split", "endgame"};
  return kNames[component];
}

research::Work::Components totals(const research::Work& work) {
  research::Work::Components sums = work.start;
  for (const research::Work::Components& level : work.levels) {
    for (std::size_t c = 0; c < research::kComponents; ++c) sums[c] += level[c];
  }
  return sums;
}

research::OperationCounts total(const research::Work::Components& components) {
  research::OperationCounts sum;
  for (const research::OperationCounts& counts : components) sum += counts;
  return sum;
}

std::size_t DeviceMemory::peak(const Input& input, const research::Options& options) {
  Triangulator& triangulator =
      triangulators_.try_emplace({options.mode, options.hull}, device_).first->second;
  return call(triangulator, input, options).statistics.device_bytes_peak;
}

}  // namespace flaunay::bench
