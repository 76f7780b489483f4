#include "derived/contours/contours.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace flaunay::contours {
namespace {

using Ids = std::vector<std::int32_t>;

struct Place {
  double x, y;
};
bool operator==(Place a, Place b) { return a.x == b.x && a.y == b.y; }
bool operator<(Place a, Place b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }
using Line = std::vector<Place>;

// Triangles are shared among threads in runs of so many.
constexpr std::size_t kRun = 1 << 16;

class Surface {
 public:
  Surface(const MeshView& mesh, const double* values, double max_edge)
      : mesh_(mesh), values_(values), longest_(max_edge * max_edge) {}

  std::size_t size() const { return mesh_.count; }
  const std::int32_t* corners(std::int32_t t) const {
    return mesh_.triangles + 3 * static_cast<std::size_t>(t);
  }
  double value(std::int32_t v) const { return values_[v]; }
  /// The triangle opposite to a corner, or -1 if there is none that has lines.
  std::int32_t beyond(std::int32_t t, int corner) const {
    const std::int32_t u =
        mesh_.neighbors[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(corner)];
    return u >= 0 && is_part(u) ? u : -1;
  }
  /// Whether the triangle has lines.
  bool is_part(std::int32_t t) const {
    const std::int32_t* const v = corners(t);
    for (int k = 0; k < 3; ++k) {
      if (!std::isfinite(values_[v[k]])) return false;
    }
    for (int k = 0; k < 3 && std::isfinite(longest_); ++k) {
      const Place a = place(v[k]), b = place(v[(k + 1) % 3]);
      if ((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y) > longest_) return false;
    }
    return true;
  }
  /// Throws Error(usage) unless all indices are those of points and triangles.
  void check(std::size_t first, std::size_t last) const {
    for (std::size_t c = 3 * first; c < 3 * last; ++c) {
      const std::int32_t v = mesh_.triangles[c], u = mesh_.neighbors[c];
      if (v >= 0 && static_cast<std::size_t>(v) < mesh_.points && u >= -1 &&
          u < static_cast<std::int64_t>(mesh_.count))
        continue;
      throw Error(ErrorKind::usage,
                  fmt::format("triangles: triangle {} has a corner that is none of the {} points, or a "
                              "neighbour that is none of the {} triangles",
                              c / 3, mesh_.points, mesh_.count));
    }
  }
  /// Where an edge has the height, which one of its ends is below, and the other one not.
  Place crossing(std::int32_t v, std::int32_t w, double height) const {
    // From the same end whichever triangle asks.
    if (place(w) < place(v)) std::swap(v, w);
    const Place a = place(v), b = place(w);
    if (values_[v] == height) return a;
    if (values_[w] == height) return b;
    // Halves, so that no difference overflows.
    const double part = (height / 2 - values_[v] / 2) / (values_[w] / 2 - values_[v] / 2);
    return {between(a.x, b.x, part), between(a.y, b.y, part)};
  }

 private:
  Place place(std::int32_t v) const {
    const double* const p = mesh_.coordinates + 2 * static_cast<std::size_t>(v);
    return {p[0], p[1]};
  }
  static double between(double a, double b, double part) {
    return std::clamp(a + part * (b - a), std::min(a, b), std::max(a, b));
  }

  const MeshView& mesh_;
  const double* values_;
  double longest_;
};

// The lines of one height.
class Tracer {
 public:
  Tracer(const Surface& surface, double height) : surface_(surface), height_(height) {}

  /// crossed: all triangles with corners on both sides.
  std::vector<Line> lines(const Ids& crossed) {
    is_traced_.assign(surface_.size(), false);
    for (const std::int32_t t : crossed) {
      if (surface_.beyond(t, entry(t)) < 0) trace(t);
    }
    for (const std::int32_t t : crossed) {
      if (!is_traced_[static_cast<std::size_t>(t)]) trace(t);
    }
    std::sort(lines_.begin(), lines_.end());
    return std::move(lines_);
  }

 private:
  bool is_above(std::int32_t t, int k) const { return surface_.value(surface_.corners(t)[k]) >= height_; }
  // The corners opposite to the edges on which the line enters and leaves a triangle: counter-clockwise
  // around it, the first one leads down, and the other one up.
  int entry(std::int32_t t) const {
    int k = 0;
    while (!is_above(t, (k + 1) % 3) || is_above(t, (k + 2) % 3)) ++k;
    return k;
  }
  int exit(std::int32_t t) const {
    int k = 0;
    while (is_above(t, (k + 1) % 3) || !is_above(t, (k + 2) % 3)) ++k;
    return k;
  }
  Place crossing(std::int32_t t, int k) const {
    const std::int32_t* const v = surface_.corners(t);
    return surface_.crossing(v[(k + 1) % 3], v[(k + 2) % 3], height_);
  }

  void trace(std::int32_t first) {
    Line line = {crossing(first, entry(first))};
    std::int32_t t = first;
    do {
      is_traced_[static_cast<std::size_t>(t)] = true;
      const int k = exit(t);
      const Place place = crossing(t, k);
      if (!(place == line.back())) line.push_back(place);
      t = surface_.beyond(t, k);
    } while (t >= 0 && !is_traced_[static_cast<std::size_t>(t)]);
    // Also if it begins and ends at the same vertex of the border.
    const bool is_closed = line.front() == line.back();
    if (line.size() < (is_closed ? 4 : 2)) return;
    if (is_closed) begin_at_smallest(line);
    lines_.push_back(std::move(line));
  }
  // Of a closed line, which may have its smallest point more than once.
  static void begin_at_smallest(Line& line) {
    line.pop_back();
    const Place smallest = *std::min_element(line.begin(), line.end());
    Line best;
    for (auto at = line.begin(); at != line.end(); ++at) {
      if (!(*at == smallest)) continue;
      Line turned(at, line.end());
      turned.insert(turned.end(), line.begin(), at);
      if (best.empty() || turned < best) best = std::move(turned);
    }
    line = std::move(best);
    line.push_back(line.front());
  }

  const Surface& surface_;
  double height_;
  std::vector<bool> is_traced_;
  std::vector<Line> lines_;
};

// For each run of triangles and each height the triangles with corners on both sides.
std::vector<Ids> find_crossed(host::Runtime& runtime, const Surface& surface,
                              const std::vector<double>& heights) {
  const std::size_t runs = (surface.size() + kRun - 1) / kRun;
  std::vector<Ids> crossed(runs * heights.size());
  runtime.share(runs, [&](std::size_t run) {
    const std::size_t first = run * kRun, last = std::min(surface.size(), first + kRun);
    surface.check(first, last);
    for (auto t = static_cast<std::int32_t>(first); t < static_cast<std::int64_t>(last); ++t) {
      const std::int32_t* const v = surface.corners(t);
      const auto [low, high] = std::minmax({surface.value(v[0]), surface.value(v[1]), surface.value(v[2])});
      if (!(low < high)) continue;
      auto height = std::upper_bound(heights.begin(), heights.end(), low);
      if (height == heights.end() || *height > high || !surface.is_part(t)) continue;
      for (; height != heights.end() && *height <= high; ++height) {
        crossed[run * heights.size() + static_cast<std::size_t>(height - heights.begin())].push_back(t);
      }
    }
  });
  return crossed;
}

}  // namespace

Contours compute(host::Runtime& runtime, const MeshView& mesh, const double* values,
                 const std::vector<double>& heights, double max_edge) {
  const Surface surface(mesh, values, max_edge);
  const std::size_t levels = heights.size();
  std::vector<Ids> crossed = find_crossed(runtime, surface, heights);
  std::vector<std::vector<Line>> lines(levels);
  runtime.share(levels, [&](std::size_t level) {
    Ids all;
    for (std::size_t i = level; i < crossed.size(); i += levels) {
      all.insert(all.end(), crossed[i].begin(), crossed[i].end());
      crossed[i] = {};
    }
    lines[level] = Tracer(surface, heights[level]).lines(all);
  });
  Contours result;
  result.offsets.push_back(0);
  for (std::size_t level = 0; level < levels; ++level) {
    for (const Line& line : lines[level]) {
      for (const Place& place : line) result.coordinates.insert(result.coordinates.end(), {place.x, place.y});
      result.offsets.push_back(result.coordinates.size() / 2);
      result.heights.push_back(static_cast<std::int32_t>(level));
    }
  }
  return result;
}

}  // namespace flaunay::contours
