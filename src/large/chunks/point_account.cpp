#include "large/chunks/point_account.hpp"

#include <algorithm>
#include <mutex>

#include "large/chunks/tree.hpp"

namespace flaunay::chunks {
namespace {

using kernel::double2;
using kernel::vertex_box;

constexpr std::size_t kAccountPart = std::size_t{1} << 14;  // points that a thread takes at once

}  // namespace

vertex_box no_box() {
  const vertex_box plane = whole_plane();
  return {plane.high, plane.low};
}

vertex_box joined(const vertex_box& a, const vertex_box& b) {
  return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y)},
          {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y)}};
}

PointAccount joined(const PointAccount& a, const PointAccount& b) {
  return {geometry::joined(a.magnitudes, b.magnitudes), joined(a.box, b.box)};
}

PointAccount account_of(host::Threads& threads, const double* coordinates, std::size_t n) {
  PointAccount all;
  std::mutex mutex;
  threads.share(n, kAccountPart, [&](std::size_t begin, std::size_t end) {
    PointAccount own;
    own.magnitudes = geometry::inspect(coordinates, begin, end);
    for (std::size_t i = begin; i < end; ++i) {
      const double2 p = {coordinates[2 * i], coordinates[2 * i + 1]};
      own.box = joined(own.box, {p, p});
    }
    const std::lock_guard lock(mutex);
    all = joined(all, own);
  });
  return all;
}

}  // namespace flaunay::chunks
