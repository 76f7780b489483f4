#include "call/areas.hpp"

#include "call/triangulate.hpp"
#include "host/native/threads.hpp"
#include "predicates/rounded_area.h"

namespace flaunay::call {

void write_areas(const HostPoints& points, const Options& options, Triangulation& result) {
  if (!options.areas) return;
  const std::vector<double> doubles = widened(points);
  const auto* const input =
      reinterpret_cast<const kernel::double_bits*>(points.wide != nullptr ? points.wide : doubles.data());
  const std::int32_t* const corners = result.triangles.data();
  result.areas.resize(result.triangles.size() / 3);
  const auto compute = [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      result.areas[t] = kernel::as_double(
          kernel::rounded_area(input, corners[3 * t], corners[3 * t + 1], corners[3 * t + 2]));
    }
  };
  // A thread is not worth its start for fewer.
  constexpr std::size_t kOfThread = 1 << 14;
  if (result.areas.size() < kOfThread) {
    compute(0, result.areas.size());
  } else {
    host::Threads().share(result.areas.size(), kOfThread, compute);
  }
}

}  // namespace flaunay::call
