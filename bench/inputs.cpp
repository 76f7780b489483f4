#include "inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/generate.hpp"

namespace flaunay::bench {
namespace {

constexpr std::uint64_t kSeed = 1;

template <typename Value>
using Named = std::vector<std::pair<std::string, Value>>;

const Named<Mode>& named_modes() {
  static const Named<Mode> kModes = {{"flattened", Mode::flattened},
                                     {"recursive-device", Mode::recursive_device},
                                     {"recursive", Mode::recursive},
                                     {"partition", Mode::partition},
                                     {"dwyer", Mode::dwyer}};
  return kModes;
}

const Named<Hull>& named_hulls() {
  static const Named<Hull> kHulls = {{"prune", Hull::prune},
                                     {"quickhull", Hull::quickhull},
                                     {"balanced", Hull::balanced},
                                     {"monotone-chain", Hull::monotone_chain}};
  return kHulls;
}

template <typename Value>
std::vector<std::string> names_of(const Named<Value>& all) {
  std::vector<std::string> names;
  for (const auto& entry : all) names.push_back(entry.first);
  return names;
}

template <typename Value>
Value find_named(const Named<Value>& all, const std::string& name, const char* kind) {
  for (const auto& entry : all) {
    if (entry.first == name) return entry.second;
  }
  throw Error(ErrorKind::usage, fmt::format("no {} is called '{}'", kind, name));
}

}  // namespace

std::vector<Input> make_inputs(const std::vector<std::string>& distributions,
                               std::vector<std::size_t> sizes) {
  std::sort(sizes.begin(), sizes.end());
  std::vector<Input> inputs;
  for (const std::size_t n : sizes) {
    for (const std::string& distribution : distributions) {
      inputs.push_back({distribution, n, io::generate(distribution, n, kSeed)});
    }
  }
  return inputs;
}

std::string input_name(const Input& input) {
  return fmt::format("{}, {} points", input.distribution, input.n);
}

const std::vector<std::string>& mode_names() {
  static const std::vector<std::string> kNames = names_of(named_modes());
  return kNames;
}

const std::vector<std::string>& hull_names() {
  static const std::vector<std::string> kNames = names_of(named_hulls());
  return kNames;
}

Mode mode_named(const std::string& name) { return find_named(named_modes(), name, "mode"); }

Hull hull_named(const std::string& name) { return find_named(named_hulls(), name, "hull"); }

Triangulation run_mode(Triangulator& triangulator, const io::Points& points, const Options& options) {
  return triangulator.triangulate(points.coordinates.data(), points.size(), options);
}

void prepare_mode(Triangulator& triangulator, const Options& options) {
  constexpr std::size_t kEnoughForAllKernels = 3000;
  run_mode(triangulator, io::generate("uniform", kEnoughForAllKernels, kSeed), options);
}

plot::Axis size_axis(const std::vector<std::size_t>& sizes) {
  const bool powers_of_two =
      std::all_of(sizes.begin(), sizes.end(), [](std::size_t n) { return n > 0 && (n & (n - 1)) == 0; });
  return {"points", powers_of_two ? plot::Scale::log2 : plot::Scale::log10};
}

}  // namespace flaunay::bench
