#include "constrained/crossings/first_crossing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "constrained/crossings/crossing.hpp"
#include "constrained/crossings/lines.hpp"
#include "constrained/crossings/segment_grid.hpp"
#include "constrained/crossings/segment_set.hpp"
#include "geometry/magnitudes.hpp"
#include "predicates/area.h"

namespace flaunay::constrained {
using namespace geometry;
namespace {

// Pairs of the first segments that are compared, per segment of the whole list.
constexpr double kPairsPerSegment = 1;

constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();

// Two segments that cross, the one with the larger index first. So the error names the least pair.
using Crossing = std::pair<std::int32_t, std::int32_t>;

Crossing crossing_of(std::int32_t a, std::int32_t b) { return {std::max(a, b), std::min(a, b)}; }

Predicates predicates_of_any() {
  Predicates predicates;
  predicates.bounds.orient = ORIENT_BOUND;
  return predicates;
}

Point scaled(const double* coordinates, std::int32_t i, int shift) {
  const double* const p = coordinates + 2 * static_cast<std::size_t>(i);
  // Adding 0 turns -0 into 0.
  return {std::ldexp(p[0], shift) + 0.0, std::ldexp(p[1], shift) + 0.0};
}

// From the lexicographically smaller end to the other one.
Line scaled_line(const double* coordinates, const std::int32_t* segments, std::size_t s, int shift) {
  Line line{scaled(coordinates, segments[2 * s], shift), scaled(coordinates, segments[2 * s + 1], shift)};
  if (kernel::comes_before(line.b, line.a)) std::swap(line.a, line.b);
  return line;
}

// Where the first line crosses the second one, rounded: at the ratio of the exact distances of its ends.
Point crossing_place(const Line& first, const Line& second) {
  const auto [a, b] = first;
  const double before = std::fabs(kernel::area_exact(second.a, second.b, a)),
               after = std::fabs(kernel::area_exact(second.a, second.b, b));
  const double ratio = before / (before + after);
  return {a.x + ratio * (b.x - a.x), a.y + ratio * (b.y - a.y)};
}

[[noreturn]] void throw_crossing(const double* coordinates, const std::vector<std::size_t>& offsets,
                                 const std::int32_t* segments, Crossing crossing) {
  const SetScalings scalings = set_scalings(
      coordinates, offsets,
      [coordinates](std::size_t first, std::size_t last) { return inspect(coordinates, first, last); });
  const auto later = static_cast<std::size_t>(crossing.first),
             earlier = static_cast<std::size_t>(crossing.second);
  const int shift = scalings.shift(set_of(offsets, segments[2 * later]));
  const Point place = crossing_place(scaled_line(coordinates, segments, later, shift),
                                     scaled_line(coordinates, segments, earlier, shift));
  throw CrossingError(
      fmt::format("segments {} (points {} and {}) and {} (points {} and {}) cross near ({:.17g}, {:.17g})",
                  earlier, segments[2 * earlier], segments[2 * earlier + 1], later, segments[2 * later],
                  segments[2 * later + 1], std::ldexp(place.x, -shift), std::ldexp(place.y, -shift)),
      crossing.second, crossing.first);
}

// The segments of one set, cut into edges without inner vertices: edges that cross then do so at no point.
class CutSegments {
 public:
  explicit CutSegments(const SegmentSet& set)
      : points_(set.vertices.points.data()),
        edges_(cut_at_vertices(predicates_, points_, set.pieces, set.vertices.sorted)),
        owners_(first_pieces(edges_.edges.size(), edges_.ranges)) {}

  // The least crossing of these segments, or kNone.
  Crossing least_crossing() const {
    std::int32_t later = some_later(kNone);
    if (later == kNone) return {kNone, kNone};
    // Some segment up to `later` crosses an earlier one, none before `first` does.
    for (std::int32_t first = 0; first < later;) {
      const std::int32_t middle = first + (later - first) / 2, found = some_later(middle);
      if (found == kNone) {
        first = middle + 1;
      } else {
        later = found;
      }
    }
    Crossing least{kNone, kNone};
    visit_crossings(later, [&least](Crossing crossing) {
      least = std::min(least, crossing);
      return true;
    });
    return least;
  }

 private:
  // A segment up to the last one that crosses an earlier one, or kNone.
  std::int32_t some_later(std::int32_t last) const {
    std::int32_t later = kNone;
    visit_crossings(last, [&later](Crossing crossing) {
      later = crossing.first;
      return false;
    });
    return later;
  }

  // Compares edges; each stands for the first segment that has it.
  template <typename Found>
  void visit_crossings(std::int32_t last, const Found& found) const {
    std::vector<Piece> edges;
    Ids owners;
    for (std::size_t e = 0; e < owners_.size(); ++e) {
      if (owners_[e] > last) continue;
      edges.push_back(edges_.edges[e]);
      owners.push_back(owners_[e]);
    }
    find_crossings_by_place(predicates_, points_, edges, [&](std::int32_t e, std::int32_t f) {
      return found(crossing_of(owners[e], owners[f]));
    });
  }

  const Predicates predicates_ = predicates_of_any();
  const Point* points_;
  LineEdges edges_;
  Ids owners_;  // per edge
};

}  // namespace

void check_first_segments(const double* coordinates, const std::vector<std::size_t>& offsets,
                          const std::int32_t* segments, std::size_t segment_count) {
  if (offsets.size() != 2 || segment_count < 2) return;
  const auto pairs = kPairsPerSegment * static_cast<double>(segment_count);
  const auto count = std::min(segment_count, 1 + static_cast<std::size_t>(std::sqrt(2 * pairs)));
  int largest = std::numeric_limits<int>::min();
  for (std::size_t k = 0; k < 2 * count; ++k) {
    if (segments[k] < 0 || static_cast<std::size_t>(segments[k]) >= offsets.back()) return;
    const double* p = coordinates + 2 * static_cast<std::size_t>(segments[k]);
    for (const double c : {p[0], p[1]}) largest = std::max(largest, c == 0 ? largest : std::ilogb(c));
  }
  if (largest == std::numeric_limits<int>::min()) return;
  const int shift = kernel::LARGEST_EXPONENT - largest;
  const Predicates predicates = predicates_of_any();
  std::vector<Line> lines;
  for (std::size_t s = 0; s < count; ++s) {
    const Line line = scaled_line(coordinates, segments, s, shift);
    for (std::size_t earlier = 0; earlier < lines.size(); ++earlier) {
      if (!cross(predicates, lines[earlier], line)) continue;
      const Point place = round_crossing(lines[earlier], line, std::ldexp(1.0, kernel::LOWEST_EXPONENT));
      // There may be a point.
      if (predicates.orient(line.a, line.b, place) == 0) return;
      throw_crossing(coordinates, offsets, segments,
                     crossing_of(static_cast<std::int32_t>(s), static_cast<std::int32_t>(earlier)));
    }
    lines.push_back(line);
  }
}

void check_crossings(const double* coordinates, const std::vector<std::size_t>& offsets,
                     const Ids& segments) {
  const std::vector<Ids> by_set = segments_of_sets(coordinates, offsets, segments);
  Crossing least{kNone, kNone};
  for (std::size_t set = 0; set < by_set.size(); ++set) {
    const Ids& numbers = by_set[set];
    if (numbers.size() < 2) continue;
    const SegmentSet of_set(coordinates, offsets, set, segments, numbers);
    const Crossing found = CutSegments(of_set).least_crossing();
    if (found.first != kNone) least = std::min(least, {numbers[found.first], numbers[found.second]});
  }
  if (least.first != kNone) throw_crossing(coordinates, offsets, segments.data(), least);
}

}  // namespace flaunay::constrained
