#include "io/ring.hpp"

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

namespace flaunay::io {
namespace {

/// Twice the area: the sum of cross products of successive positions, relative to the first one.
template <typename Number, typename Add>
void sum_area(const double* coordinates, std::size_t n, const Add& add) {
  const Number x0 = coordinates[0], y0 = coordinates[1];
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Number ax = Number(coordinates[2 * i]) - x0, ay = Number(coordinates[2 * i + 1]) - y0;
    const Number bx = Number(coordinates[2 * i + 2]) - x0, by = Number(coordinates[2 * i + 3]) - y0;
    add(Number(ax * by), Number(ay * bx));
  }
}

}  // namespace

int ring_orientation(const double* coordinates, std::size_t n) {
  if (n < 3) return 0;
  long double area = 0, magnitude = 0;
  sum_area<long double>(coordinates, n, [&](long double left, long double right) {
    area += left - right;
    magnitude += std::fabs(left) + std::fabs(right);
  });
  // Differences and products have a relative error of a few units each, and each of n sums adds one.
  const long double bound =
      static_cast<long double>(n + 8) * std::numeric_limits<long double>::epsilon() * magnitude;
  if (area > bound) return 1;
  if (area < -bound) return -1;
  using Exact = boost::multiprecision::cpp_rational;
  Exact exact = 0;
  sum_area<Exact>(coordinates, n, [&](const Exact& left, const Exact& right) { exact += left - right; });
  return exact.sign();
}

}  // namespace flaunay::io
