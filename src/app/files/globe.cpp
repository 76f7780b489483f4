#include "app/files/globe.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flaunay::io {
namespace {

constexpr double kTurn = 360, kDateLine = 180, kPole = 90;

bool is_pole(const OnGlobe& p) { return std::fabs(p[1]) == kPole; }
/// The way from one longitude to another, the shorter way around.
double step(double from, double to) { return std::remainder(to - from, kTurn); }

/// The corners with longitudes that go on where others end. At a pole all longitudes meet, so that it is a
/// line there.
GlobeRing unrolled(const GlobeRing& corners) {
  GlobeRing ring;
  const auto first =
      std::find_if(corners.begin(), corners.end(), [](const OnGlobe& p) { return !is_pole(p); });
  if (first == corners.end()) return ring;
  double x = std::remainder((*first)[0], kTurn), pole = 0;
  for (std::size_t k = 0; k <= corners.size(); ++k) {
    const auto at = static_cast<std::size_t>(first - corners.begin()) + k;
    const OnGlobe& p = corners[at % corners.size()];
    if (is_pole(p)) {
      pole = p[1];
      ring.push_back({x, pole});
      continue;
    }
    x += step(x, p[0]);
    if (pole != 0) ring.push_back({x, pole});
    pole = 0;
    if (k < corners.size()) ring.push_back({x, p[1]});
  }
  // Where it does not come back, it goes around a pole: eastwards around the one in the north.
  const double around = std::round((x - ring.front()[0]) / kTurn);
  if (around != 0) {
    const double latitude = around > 0 ? kPole : -kPole;
    ring.insert(ring.end(), {OnGlobe{x, ring.front()[1]}, {x, latitude}, {ring.front()[0], latitude}});
  }
  return ring;
}

/// The part where sign * (longitude - line) is positive or 0 (Sutherland and Hodgman, 1974).
GlobeRing clipped(const GlobeRing& ring, double line, double sign) {
  GlobeRing part;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const OnGlobe &a = ring[k], &b = ring[(k + 1) % ring.size()];
    const double from = sign * (a[0] - line), to = sign * (b[0] - line);
    if (from >= 0) part.push_back(a);
    if ((from < 0 && to > 0) || (from > 0 && to < 0))
      part.push_back({line, a[1] + (b[1] - a[1]) * (from / (from - to))});
  }
  return part;
}

}  // namespace

std::vector<GlobeRing> cut_at_date_line(const GlobeRing& corners) {
  std::vector<GlobeRing> parts;
  const GlobeRing ring = unrolled(corners);
  for (int turn = -1; turn <= 1; ++turn) {
    const double west = -kDateLine + turn * kTurn;
    GlobeRing part = clipped(clipped(ring, west, 1), west + kTurn, -1);
    const auto is_on = [&](const OnGlobe& p) { return p[0] == part.front()[0]; };
    // A part that only touches the line has no area.
    if (part.size() < 3 || std::all_of(part.begin(), part.end(), is_on)) continue;
    for (OnGlobe& p : part) p[0] -= turn * kTurn;
    parts.push_back(part);
  }
  return parts;
}

}  // namespace flaunay::io
