#include "inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <random>

#include "io/generate.hpp"

namespace flaunay::bench {
namespace {

constexpr std::uint64_t kSeed = 1;

template <typename Value>
using Named = std::vector<std::pair<std::string, Value>>;

template <typename Value>
Named<Value> with_names(std::initializer_list<Value> values) {
  Named<Value> named;
  for (const Value value : values) named.push_back({to_string(value), value});
  return named;
}

const Named<Mode>& named_modes() {
  static const auto kModes = with_names(
      {Mode::hybrid, Mode::flattened, Mode::recursive_device, Mode::recursive, Mode::partition, Mode::dwyer});
  return kModes;
}

const Named<Hull>& named_hulls() {
  static const auto kHulls = with_names({Hull::prune, Hull::quickhull, Hull::balanced, Hull::monotone_chain});
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

constexpr const char* kAllEqual = "all-equal";

/// Another set: appends n points of the distribution.
void append_set(Input& input, const std::string& distribution, std::size_t n) {
  const std::vector<double> set =
      distribution == kAllEqual ? std::vector<double>(2 * n, 0.5)
                                : io::generate(distribution, n, kSeed + input.offsets.size()).coordinates;
  std::vector<double>& all = input.points.coordinates;
  all.insert(all.end(), set.begin(), set.end());
  input.n += n;
  input.offsets.push_back(input.n);
}

/// At least x with probability 8 / (8 + x).
std::size_t heavy_tailed_size(std::mt19937_64& random) {
  const double rest = 1 - static_cast<double>(random() >> 11) * 0x1p-53;
  return static_cast<std::size_t>(8 / rest - 8);
}

}  // namespace

Input make_input(const std::string& distribution, std::size_t n) {
  return {distribution, n, io::generate(distribution, n, kSeed), {0, n}};
}

Input equal_sets(std::size_t sets, std::size_t size) {
  Input input{fmt::format("{} sets of {}", sets, size), 0, {}, {0}};
  for (std::size_t s = 0; s < sets; ++s) append_set(input, "uniform", size);
  return input;
}

Input heavy_tailed_sets(std::size_t n) {
  static const std::vector<std::string> kKinds = {"collinear", "grid", kAllEqual, "mostly-equal",
                                                  "small-integers"};
  constexpr std::size_t kOneInSets = 4;
  std::mt19937_64 random(kSeed);
  Input input{"", 0, {}, {0}};
  for (std::size_t s = 0; input.n < n; ++s) {
    const std::size_t size =
        std::min({heavy_tailed_size(random), std::max<std::size_t>(1, n / 10), n - input.n});
    append_set(input, s % kOneInSets == 0 ? kKinds[s / kOneInSets % kKinds.size()] : "uniform", size);
  }
  input.distribution = fmt::format("{} sets of all sizes", input.offsets.size() - 1);
  return input;
}

std::vector<Input> make_inputs(const std::vector<std::string>& distributions,
                               std::vector<std::size_t> sizes) {
  std::sort(sizes.begin(), sizes.end());
  std::vector<Input> inputs;
  for (const std::size_t n : sizes) {
    for (const std::string& distribution : distributions) {
      inputs.push_back(make_input(distribution, n));
    }
  }
  return inputs;
}

std::string input_name(const Input& input) {
  return fmt::format("{}, {} points", input.distribution, input.n);
}

std::string default_mode_name() { return to_string(kDefaultMode); }

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

Triangulation run_mode(Triangulator& triangulator, const Input& input, const Options& options) {
  return triangulator.triangulate(input.points.coordinates.data(), input.offsets, options);
}

void prepare_mode(Triangulator& triangulator, const Options& options) {
  constexpr std::size_t kEnoughForAllKernels = 3000;
  run_mode(triangulator, make_input("uniform", kEnoughForAllKernels), options);
}

std::size_t DeviceMemory::peak(const Input& input, const Options& options) {
  Triangulator& triangulator =
      triangulators_.try_emplace({options.mode, options.hull}, device_).first->second;
  return run_mode(triangulator, input, options).statistics.device_bytes_peak;
}

std::vector<std::size_t> powers_of_two(int least, int most) {
  std::vector<std::size_t> powers;
  for (int exponent = least; exponent <= most; ++exponent) powers.push_back(std::size_t{1} << exponent);
  return powers;
}

plot::Axis size_axis(const std::vector<std::size_t>& sizes) {
  const bool powers_of_two =
      std::all_of(sizes.begin(), sizes.end(), [](std::size_t n) { return n > 0 && (n & (n - 1)) == 0; });
  return {"points", powers_of_two ? plot::Scale::log2 : plot::Scale::log10};
}

}  // namespace flaunay::bench
