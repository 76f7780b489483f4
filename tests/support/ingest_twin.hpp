// The twin of the stage `ingest`: sorts, scales, finds duplicates.
#pragma once

#include <CL/cl.h>
#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <tuple>
#include <vector>

namespace flaunay::testing {

struct IngestTwin {
  int shift = 0;  ///< all coordinates are multiplied by 2^shift
  int bits = 0;   ///< from the leading bit of the largest coordinate to the lowest bit of any
  std::vector<cl_double2> points;
  std::vector<cl_int> source, set_of_id, set_offsets, y_order, representatives;
};

inline IngestTwin ingest_twin(const std::vector<double>& coordinates,
                              const std::vector<std::size_t>& offsets) {
  IngestTwin twin;
  const std::size_t n = coordinates.size() / 2;
  // Exponents of the leading bit and of the lowest one, over all coordinates.
  int largest = std::numeric_limits<int>::min(), lowest = std::numeric_limits<int>::max();
  for (const double c : coordinates) {
    if (c == 0) continue;
    int exponent = 0;
    const mpz_class mantissa(std::ldexp(std::frexp(c, &exponent), 53));
    largest = std::max(largest, exponent - 1);
    lowest = std::min(lowest, exponent - 53 + static_cast<int>(mpz_scan1(mantissa.get_mpz_t(), 0)));
  }
  if (lowest <= largest) twin.bits = largest - lowest + 1;
  if (lowest <= largest && largest > 249) twin.shift = 249 - largest;
  if (lowest <= largest && lowest < -255) twin.shift = -255 - lowest;

  std::vector<int> set(n), order(n);
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    std::fill(set.begin() + static_cast<std::ptrdiff_t>(offsets[s]),
              set.begin() + static_cast<std::ptrdiff_t>(offsets[s + 1]), static_cast<int>(s));
  }
  std::iota(order.begin(), order.end(), 0);
  const auto place = [&](int i) {
    return std::make_tuple(set[static_cast<std::size_t>(i)], coordinates[2 * static_cast<std::size_t>(i)],
                           coordinates[2 * static_cast<std::size_t>(i) + 1]);
  };
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return place(i) != place(j) ? place(i) < place(j) : i < j; });
  twin.representatives.resize(n);
  twin.set_offsets.assign(offsets.size(), 0);
  for (std::size_t k = 0; k < n; ++k) {
    if (k == 0 || place(order[k]) != place(order[k - 1])) {
      const auto [s, x, y] = place(order[k]);
      // Adding 0 makes +0 of -0.
      twin.points.push_back({{std::ldexp(x, twin.shift) + 0.0, std::ldexp(y, twin.shift) + 0.0}});
      twin.source.push_back(order[k]);
      twin.set_of_id.push_back(s);
    }
    twin.representatives[static_cast<std::size_t>(order[k])] = twin.source.back();
  }
  for (std::size_t s = 0; s < offsets.size(); ++s) {
    twin.set_offsets[s] = static_cast<cl_int>(
        std::lower_bound(twin.set_of_id.begin(), twin.set_of_id.end(), static_cast<int>(s)) -
        twin.set_of_id.begin());
  }
  twin.y_order.resize(twin.points.size());
  std::iota(twin.y_order.begin(), twin.y_order.end(), 0);
  std::sort(twin.y_order.begin(), twin.y_order.end(), [&](int i, int j) {
    const auto key = [&](int id) {
      const auto k = static_cast<std::size_t>(id);
      return std::make_tuple(twin.set_of_id[k], twin.points[k].s[1], twin.points[k].s[0]);
    };
    return key(i) < key(j);
  });
  return twin;
}

}  // namespace flaunay::testing
