#include "derived/contours/contours.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "constrained/crossings/split.hpp"
#include "derived/surface.hpp"
#include "geometry/arguments.hpp"
#include "predicates/bounds.h"
#include "raster/edges.h"

namespace flaunay::contours {
namespace {

using Ids = std::vector<std::int32_t>;

// Triangles are shared among threads in runs of this many.
constexpr std::size_t kRun = 1 << 16;

// Closed lines that are cut off are left out if twice their area is at most this, times their length and the
// power of two at or below their largest coordinate.
constexpr double kThin = 0x1p-50;

// Returns whether the place is another one than the last.
bool append(Line& line, const Place& place) {
  const bool is_another = line.empty() || !(place == line.back());
  if (is_another) line.push_back(place);
  return is_another;
}

// Products below kTiny may have lost digits, and products of coordinates above kLargest may overflow.
constexpr double kTiny = 0x1p-960, kLargest = 0x1p500;

// Whether three places certainly turn left.
bool turn_left(Place a, Place b, Place c) {
  const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
  return left - right > ORIENT_BOUND * (std::fabs(left) + std::fabs(right)) + kTiny;
}

// A place on a side, and how far away from the nearer end, as a part of the side.
struct Crossing : Place {
  double part;
};

class Surface {
 public:
  Surface(const MeshView& mesh, const double* values, double max_edge)
      : mesh_(mesh), values_(values), longest_(max_edge * max_edge) {
    double largest = 0;
    for (std::size_t c = 0; c < 2 * mesh.points; ++c)
      largest = std::max(largest, std::fabs(mesh.coordinates[c]));
    rounding_ = largest < kLargest ? 0x1p-47 * largest : HUGE_VAL;
  }

  std::size_t size() const { return mesh_.count; }
  const std::int32_t* corners(std::int32_t t) const {
    return mesh_.triangles + 3 * static_cast<std::size_t>(t);
  }
  double value(std::int32_t v) const { return values_[v]; }
  Place place(std::int32_t v) const {
    const double* const p = mesh_.coordinates + 2 * static_cast<std::size_t>(v);
    return {p[0], p[1]};
  }
  std::int32_t neighbor(std::int32_t t, int corner) const {
    return mesh_.neighbors[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(corner)];
  }
  /// The side opposite to a corner if its other triangle belongs to another part.
  std::optional<Side> open_side(std::int32_t t, int corner) const {
    if (neighbor(t, corner) != t) return std::nullopt;
    const Place a = place(corners(t)[(corner + 1) % 3]), b = place(corners(t)[(corner + 2) % 3]);
    return Side{std::min(a, b), std::max(a, b)};
  }
  /// Whether the triangle has lines.
  bool is_part(std::int32_t t) const {
    const std::int32_t* const v = corners(t);
    for (int k = 0; k < 3; ++k) {
      if (!std::isfinite(values_[v[k]])) return false;
    }
    if (!std::isfinite(longest_)) return true;
    const Place a = place(v[0]), b = place(v[1]), c = place(v[2]);
    const kernel::double2 places[] = {{a.x, a.y}, {b.x, b.y}, {c.x, c.y}};
    return kernel::has_longer_edge(places, longest_) == 0;
  }
  /// Throws Error(usage) unless all indices are in the range of points and triangles.
  void check(std::size_t first, std::size_t last) const {
    for (std::size_t c = 3 * first; c < 3 * last; ++c) {
      const std::int32_t v = mesh_.triangles[c], u = mesh_.neighbors[c];
      if (v >= 0 && static_cast<std::size_t>(v) < mesh_.points && u >= -1 &&
          u < static_cast<std::int64_t>(mesh_.count))
        continue;
      refuse_triangle(c / 3, mesh_.points, mesh_.count);
    }
  }
  /// Where an edge has the height, which one of its ends is below, and the other one not.
  Crossing crossing(std::int32_t v, std::int32_t w, double height) const {
    // From the same end whichever triangle asks.
    if (place(w) < place(v)) std::swap(v, w);
    const Place a = place(v), b = place(w);
    if (values_[v] == height) return {a, 0};
    if (values_[w] == height) return {b, 0};
    // Halves, so that no difference overflows.
    const double part = (height / 2 - values_[v] / 2) / (values_[w] / 2 - values_[v] / 2);
    return {{between(a.x, b.x, part), between(a.y, b.y, part)}, std::min(part, 1 - part)};
  }
  /// Whether two crossings, on the sides from corner s to a and b, are so far apart that rounding cannot
  /// change the order of the lines in the triangle.
  bool is_wide(Place s, Place a, Place b, double parts) const {
    const double ax = a.x - s.x, ay = a.y - s.y, bx = b.x - s.x, by = b.y - s.y;
    return (ax * by - ay * bx) * parts >
           rounding_ * (std::fabs(ax) + std::fabs(ay) + std::fabs(bx) + std::fabs(by)) + kTiny;
  }

 private:
  static double between(double a, double b, double part) {
    return std::clamp(a + part * (b - a), std::min(a, b), std::max(a, b));
  }

  const MeshView& mesh_;
  const double* values_;
  double longest_;
  double rounding_;
};

// The pieces of one height.
class Tracer {
 public:
  Tracer(const Surface& surface, double height, std::vector<Piece>& pieces)
      : surface_(surface), height_(height), pieces_(pieces) {}

  /// crossed: all triangles with corners on both sides.
  void trace_all(const Ids& crossed) {
    if (crossed.empty()) return;
    states_.assign(surface_.size(), State::not_crossed);
    for (const std::int32_t t : crossed) state(t) = State::crossed;
    for (const std::int32_t t : crossed) {
      if (beyond(t, entry(t)) < 0) trace(t, true);
    }
    for (const std::int32_t t : crossed) {
      if (state(t) == State::crossed) trace(t, false);
    }
  }

 private:
  enum class State : std::uint8_t { not_crossed, crossed, traced };

  State& state(std::int32_t t) { return states_[static_cast<std::size_t>(t)]; }
  // The triangle beyond the side opposite to this corner, or -1 if no line crosses a triangle there.
  std::int32_t beyond(std::int32_t t, int corner) {
    const std::int32_t u = surface_.neighbor(t, corner);
    return u >= 0 && u != t && state(u) != State::not_crossed ? u : -1;
  }
  bool is_above(std::int32_t t, int k) const { return surface_.value(surface_.corners(t)[k]) >= height_; }
  // The corners opposite to the edges on which the line enters and leaves a triangle: counter-clockwise
  // around it, the first one leads down, and the other one up.
  int entry(std::int32_t t) const {
    const bool is_last_above = is_above(t, 2);
    return is_above(t, 1) && !is_last_above ? 0 : !is_above(t, 0) && is_last_above ? 1 : 2;
  }
  int exit(std::int32_t t) const {
    const bool is_last_above = is_above(t, 2);
    return !is_above(t, 1) && is_last_above ? 0 : is_above(t, 0) && !is_last_above ? 1 : 2;
  }
  bool is_at_height(std::int32_t v) const { return surface_.value(v) == height_; }

  // Whether rounding keeps the order of the parts into which the line divides a triangle: the part cut off at
  // one corner, and two triangles between the line and the other corners, unless it goes through these.
  bool is_in_order(std::int32_t t, int exit, const Crossing& from, const Crossing& to,
                   bool is_at_border) const {
    const std::int32_t* const v = surface_.corners(t);
    const std::int32_t c = v[exit], before = v[exit == 0 ? 2 : exit - 1], after = v[exit == 2 ? 0 : exit + 1];
    const bool is_left = surface_.value(c) >= height_;
    const std::int32_t cut_off = is_left ? after : before, on_a = is_left ? before : c,
                       on_b = is_left ? c : after;
    const Place s = surface_.place(cut_off), a = surface_.place(on_a), b = surface_.place(on_b);
    if (surface_.is_wide(s, a, b, from.part * to.part)) return true;
    if (is_at_border) return false;
    const Place &m = is_left ? to : from, &w = is_left ? from : to;
    return is_at_height(cut_off) || (turn_left(s, m, w) && (is_at_height(on_a) || turn_left(m, a, b)) &&
                                     (is_at_height(on_b) || turn_left(m, b, w)));
  }

  // Adds the place where the line crosses a side.
  Crossing go_to(std::int32_t t, int side, Piece& piece) const {
    const std::int32_t* const v = surface_.corners(t);
    const Crossing crossing = surface_.crossing(v[(side + 1) % 3], v[(side + 2) % 3], height_);
    if (append(piece.line, crossing) && crossing.part == 0) piece.vertices.push_back(crossing);
    return crossing;
  }

  // is_open: whether the line begins at the border, or on a side between parts.
  void trace(std::int32_t first, bool is_open) {
    const int begin = entry(first);
    Piece piece;
    Crossing from = go_to(first, begin, piece);
    piece.begin = surface_.open_side(first, begin);
    piece.is_in_order = !is_open || surface_.neighbor(first, begin) < 0 || piece.begin;
    std::int32_t t = first;
    do {
      state(t) = State::traced;
      const int k = exit(t);
      const Crossing to = go_to(t, k, piece);
      const std::int32_t next = beyond(t, k);
      piece.is_in_order =
          piece.is_in_order && is_in_order(t, k, from, to, next < 0 || (is_open && t == first));
      if (next < 0) {
        piece.end = surface_.open_side(t, k);
        piece.is_in_order = piece.is_in_order && (surface_.neighbor(t, k) < 0 || piece.end);
      }
      t = next;
      from = to;
    } while (t >= 0 && state(t) != State::traced);
    pieces_.push_back(std::move(piece));
  }

  const Surface& surface_;
  double height_;
  std::vector<Piece>& pieces_;
  std::vector<State> states_;
};

// Rotates a closed line so that it begins at its smallest point. If it visits that point more than once, the
// lexicographically smallest rotation is taken.
void begin_at_smallest(Line& line) {
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

// Whether a closed line is hardly wider than rounding.
bool is_thin(const Line& ring) {
  double largest = 0, length = 0, area = 0;
  for (const Place& place : ring) largest = std::max({largest, std::fabs(place.x), std::fabs(place.y)});
  // Relative to the largest coordinate, so that nothing overflows.
  const auto scaled = [exponent = std::ilogb(largest)](Place place) -> Place {
    return {std::ldexp(place.x, -exponent), std::ldexp(place.y, -exponent)};
  };
  const Place first = scaled(ring.front());
  Place last = first;
  for (const Place& place : ring) {
    const Place next = scaled(place);
    length += std::fabs(next.x - last.x) + std::fabs(next.y - last.y);
    area += (last.x - first.x) * (next.y - first.y) - (last.y - first.y) * (next.x - first.x);
    last = next;
  }
  return std::fabs(area) <= kThin * length;
}

// In ascending order, those that are there twice.
Line repeated(Line places) {
  std::sort(places.begin(), places.end());
  Line twice;
  for (auto p = std::adjacent_find(places.begin(), places.end()); p != places.end();
       p = std::adjacent_find(std::upper_bound(p, places.end(), *p), places.end()))
    twice.push_back(*p);
  return twice;
}

// Adds the parts of a line that goes through places again: the part in between is a closed line. No part goes
// through a place twice.
void add_parts(const Line& line, const Line& twice, std::vector<Line>& lines) {
  std::vector<std::size_t> last(twice.size(), line.size());
  Line path;
  for (const Place& place : line) {
    const auto found = std::lower_bound(twice.begin(), twice.end(), place);
    if (found != twice.end() && *found == place) {
      std::size_t& begin = last[static_cast<std::size_t>(found - twice.begin())];
      if (begin < path.size() && path[begin] == place) {
        const auto first = path.begin() + static_cast<std::ptrdiff_t>(begin);
        Line ring(first, path.end());
        ring.push_back(place);
        path.erase(first, path.end());
        if (ring.size() >= 4 && (ring.size() == line.size() || !is_thin(ring))) {
          begin_at_smallest(ring);
          lines.push_back(std::move(ring));
        }
      }
      begin = path.size();
    }
    path.push_back(place);
  }
  if (path.size() > 1) lines.push_back(std::move(path));
}

// The line with all places at which its pieces meet, as constrained::noded makes them.
Line noded(const Line& line) {
  std::vector<geometry::Point> path;
  path.reserve(line.size());
  for (const Place& place : line) path.push_back({place.x, place.y});
  Line result;
  for (const geometry::Point& p : constrained::noded(path)) result.push_back({p.x, p.y});
  return result;
}

// Adds a line; its parts, if it meets itself.
void add_line(Piece& piece, std::vector<Line>& lines) {
  Line& line = piece.line;
  // Also if it begins and ends at the same vertex of the border.
  const bool is_closed = line.front() == line.back();
  if (line.size() < (is_closed ? 4 : 2)) return;
  if (is_closed) begin_at_smallest(line);
  if (!piece.is_in_order) {
    line = noded(line);
    piece.vertices.assign(line.begin(), line.end() - (is_closed ? 1 : 0));
  }
  Line twice = repeated(std::move(piece.vertices));
  if (!twice.empty()) {
    if (is_closed) twice.insert(std::lower_bound(twice.begin(), twice.end(), line.front()), line.front());
    add_parts(line, twice, lines);
  } else {
    lines.push_back(std::move(line));
  }
}

// Joins pieces of one height where one ends on the side on which another one begins.
std::vector<Line> joined(std::vector<Piece>& pieces) {
  constexpr auto kNone = std::numeric_limits<std::size_t>::max();
  std::vector<std::pair<Side, std::size_t>> begins;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].begin) begins.emplace_back(*pieces[i].begin, i);
  }
  std::sort(begins.begin(), begins.end());
  std::vector<std::size_t> next(pieces.size(), kNone);
  std::vector<bool> is_continued(pieces.size(), false), is_joined(pieces.size(), false);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!pieces[i].end) continue;
    const auto found =
        std::lower_bound(begins.begin(), begins.end(), std::pair(*pieces[i].end, std::size_t{0}));
    if (found == begins.end() || !(found->first == *pieces[i].end)) continue;
    next[i] = found->second;
    is_continued[found->second] = true;
  }
  std::vector<Line> lines;
  const auto join = [&](std::size_t i) {
    Piece whole;
    for (; i != kNone && !is_joined[i]; i = next[i]) {
      is_joined[i] = true;
      if (whole.line.empty()) {
        whole = std::move(pieces[i]);
        continue;
      }
      for (const Place& place : pieces[i].line) append(whole.line, place);
      whole.vertices.insert(whole.vertices.end(), pieces[i].vertices.begin(), pieces[i].vertices.end());
      whole.is_in_order = whole.is_in_order && pieces[i].is_in_order;
    }
    add_line(whole, lines);
  };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (is_continued[i]) continue;
    pieces[i].is_in_order = pieces[i].is_in_order && !pieces[i].begin;
    join(i);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!is_joined[i]) join(i);
  }
  std::sort(lines.begin(), lines.end());
  return lines;
}

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

void check(const std::vector<double>& heights, double max_edge) {
  expect(std::all_of(heights.begin(), heights.end(), [](double h) { return std::isfinite(h); }),
         "heights of contours must be finite");
  expect(std::adjacent_find(heights.begin(), heights.end(), std::greater_equal<>()) == heights.end(),
         "heights of contours must increase");
  expect(max_edge >= 0, "max_edge must be a length");
}

void Lines::add(host::Runtime& runtime, const MeshView& mesh, const double* values) {
  const std::size_t levels = heights_.size();
  if (levels == 0) return;
  const Surface surface(mesh, values, max_edge_);
  std::vector<Ids> crossed = find_crossed(runtime, surface, heights_);
  runtime.share(levels, [&](std::size_t level) {
    Ids all;
    for (std::size_t i = level; i < crossed.size(); i += levels) {
      all.insert(all.end(), crossed[i].begin(), crossed[i].end());
      crossed[i] = {};
    }
    Tracer(surface, heights_[level], pieces_[level]).trace_all(all);
  });
}

Contours Lines::finish(host::Runtime& runtime) {
  std::vector<std::vector<Line>> lines(heights_.size());
  runtime.share(heights_.size(), [&](std::size_t level) {
    lines[level] = joined(pieces_[level]);
    pieces_[level] = {};
  });
  Contours result;
  result.offsets.push_back(0);
  for (std::size_t level = 0; level < lines.size(); ++level) {
    for (const Line& line : lines[level]) {
      for (const Place& place : line) result.coordinates.insert(result.coordinates.end(), {place.x, place.y});
      result.offsets.push_back(result.coordinates.size() / 2);
      result.heights.push_back(static_cast<std::int32_t>(level));
    }
    lines[level] = {};
  }
  return result;
}

}  // namespace flaunay::contours
