#include "bench/measuring/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "app/files/generate.hpp"

namespace flaunay::bench {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr const char* kAllEqual = "all-equal";

/// Another set: appends n points of the distribution.
void append_set(Input& input, const std::string& distribution, std::size_t n) {
  append(input.coordinates, distribution == kAllEqual
                                ? std::vector<double>(2 * n, 0.5)
                                : io::generate(distribution, n, kSeed + input.offsets.size()).coordinates);
  input.n += n;
  input.offsets.push_back(input.n);
}

/// At least x with probability 8 / (8 + x).
std::size_t heavy_tailed_size(std::mt19937_64& random) {
  const double rest = 1 - static_cast<double>(random() >> 11) * 0x1p-53;
  return static_cast<std::size_t>(8 / rest - 8);
}

}  // namespace

Input make_input(const std::string& distribution, std::size_t n, std::uint64_t seed) {
  return {distribution, n, io::generate(distribution, n, seed).coordinates, {0, n}};
}

Input equal_sets(std::size_t sets, std::size_t size, const std::string& distribution) {
  Input input{fmt::format("{} sets of {}", sets, size), 0, {}, {0}};
  for (std::size_t s = 0; s < sets; ++s) append_set(input, distribution, size);
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
  input.distribution = fmt::format("{} sets of all sizes", input.sets());
  return input;
}

std::vector<Input> make_inputs(const std::vector<std::string>& distributions,
                               std::vector<std::size_t> sizes) {
  std::sort(sizes.begin(), sizes.end());
  std::vector<Input> inputs;
  for (const std::size_t n : sizes) {
    for (const std::string& distribution : distributions) inputs.push_back(make_input(distribution, n));
  }
  return inputs;
}

std::string input_name(const Input& input) {
  return fmt::format("{}, {} points", input.distribution, input.n);
}

std::vector<std::size_t> powers_of_two(int least, int most) {
  std::vector<std::size_t> powers;
  for (int exponent = least; exponent <= most; ++exponent) powers.push_back(std::size_t{1} << exponent);
  return powers;
}

std::string thousands(std::size_t n) {
  if (n % 1000000 == 0) return fmt::format("{}M", n / 1000000);
  return n % 1000 == 0 ? fmt::format("{}k", n / 1000) : fmt::format("{}", n);
}

}  // namespace flaunay::bench
