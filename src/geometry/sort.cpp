#include "geometry/sort.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "statistics/costs.hpp"

namespace flaunay::geometry {

using statistics::log2_ceiling;
namespace {

constexpr int kDigitBits = 8;
constexpr int kDigits = 64 / kDigitBits;
constexpr std::size_t kDigitValues = std::size_t{1} << kDigitBits;
// Fewer elements than this are sorted faster by comparisons.
constexpr std::size_t kRadixLeast = 2048;

std::size_t digit_of(std::uint64_t key, int digit) {
  return (key >> (digit * kDigitBits)) & (kDigitValues - 1);
}

// Leaves a 0 before each of 16 bits.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 8) & 0x00ff00ff;
  bits = (bits | bits << 4) & 0x0f0f0f0f;
  bits = (bits | bits << 2) & 0x33333333;
  return (bits | bits << 1) & 0x55555555;
}

}  // namespace

std::uint64_t place_on_curve(double x, double y) {
  const auto bits = [](double part) { return part > 0 ? static_cast<std::uint64_t>(part * 0xffff) : 0; };
  return spread(bits(x)) | spread(bits(y)) << 1;
}

std::uint64_t sort_key(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const std::uint64_t sign = std::uint64_t{1} << 63;
  return bits & sign ? ~bits : bits | sign;
}

void sort_by_key(std::vector<Keyed>& elements) {
  const std::size_t n = elements.size();
  if (n < kRadixLeast) {
    std::stable_sort(elements.begin(), elements.end(),
                     [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    return;
  }
  std::array<std::array<std::size_t, kDigitValues>, kDigits> counts{};
  for (const Keyed& element : elements) {
    for (int digit = 0; digit < kDigits; ++digit) ++counts[digit][digit_of(element.key, digit)];
  }
  const std::unique_ptr<Keyed[]> scratch(new Keyed[n]);
  Keyed* from = elements.data();
  Keyed* to = scratch.get();
  for (int digit = 0; digit < kDigits; ++digit) {
    std::array<std::size_t, kDigitValues>& first = counts[digit];
    if (first[digit_of(from[0].key, digit)] == n) continue;  // all keys have the same digit
    std::size_t sum = 0;
    for (std::size_t& count : first) {
      const std::size_t size = count;
      count = sum;
      sum += size;
    }
    for (std::size_t i = 0; i < n; ++i) to[first[digit_of(from[i].key, digit)]++] = from[i];
    std::swap(from, to);
  }
  if (from != elements.data()) std::copy(from, from + n, elements.data());
}

std::uint64_t comparisons_to_sort(std::size_t n) {
  if (n < 2) return 0;
  const std::uint64_t log = log2_ceiling(n);
  return n * log - (std::uint64_t{1} << log) + 1;
}

std::uint64_t depth_of_sort(std::size_t n) {
  const std::uint64_t rounds = log2_ceiling(n);
  return rounds * (rounds + 1) / 2;
}

}  // namespace flaunay::geometry
