#include "constrained/crossings/segment_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "constrained/crossings/crossing.hpp"

namespace flaunay::constrained {
using namespace geometry;

namespace {

// Up to this many segments share a single cell.
constexpr std::size_t kInOneCell = 96;
// All pairs are compared if their number is at most this times the number of entries, the segments in cells.
constexpr std::size_t kPairsPerEntry = 24;
// Otherwise kFirstPairsPerEntry pairs per entry, and as long as one in kPairsPerCrossing crosses.
constexpr std::size_t kPairsPerCrossing = 32;
constexpr std::size_t kFirstPairsPerEntry = 4;

// Whether the bounding boxes of two lines have no common point.
bool are_boxes_apart(const Line& p, const Line& q) {
  return p.a.x > q.b.x || q.a.x > p.b.x || std::min(p.a.y, p.b.y) > std::max(q.a.y, q.b.y) ||
         std::min(q.a.y, q.b.y) > std::max(p.a.y, p.b.y);
}

}  // namespace

std::int32_t SegmentGrid::Axis::cell(double x) const {
  const double k = (x - low) / step;
  return k > 0 ? std::min(cells - 1, static_cast<std::int32_t>(std::min(k, 0x1p30))) : 0;
}

SegmentGrid::SegmentGrid(const std::vector<Line>& lines) : lines_(lines) {
  const auto count = static_cast<double>(lines.size());
  double low_y = HUGE_VAL, high_y = -HUGE_VAL, low_x = HUGE_VAL, high_x = -HUGE_VAL, length_x = 0,
         length_y = 0;
  for (const auto& [a, b] : lines) {
    low_x = std::min(low_x, a.x);
    high_x = std::max(high_x, b.x);
    low_y = std::min({low_y, a.y, b.y});
    high_y = std::max({high_y, a.y, b.y});
    length_x += (b.x - a.x) / count;
    length_y += std::fabs(b.y - a.y) / count;
  }
  padding_ = 0x1p-40 * std::max({std::fabs(low_x), std::fabs(high_x), std::fabs(low_y), std::fabs(high_y)});
  const auto axis = [&](double low, double high, double mean_length) -> Axis {
    const double step = std::max({(high - low) / std::sqrt(count), mean_length, 8 * padding_});
    if (lines.size() <= kInOneCell || !(step < high - low)) return {low, HUGE_VAL, 1};
    return {low, step, 1 + static_cast<std::int32_t>((high - low) / step)};
  };
  x_ = axis(low_x, high_x, length_x);
  y_ = axis(low_y, high_y, length_y);
  if (cells() == 1) {
    offsets_ = {0, static_cast<std::uint32_t>(lines.size())};
    segments_.resize(lines.size());
    std::iota(segments_.begin(), segments_.end(), 0);
    return;
  }
  offsets_.assign(cells() + 2, 0);
  for (const Line& line : lines) {
    visit_cells(line, [this](std::size_t cell) { ++offsets_[cell + 2]; });
  }
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  segments_.resize(offsets_.back());
  for (std::size_t s = 0; s < lines.size(); ++s) {
    visit_cells(lines[s],
                [&](std::size_t cell) { segments_[offsets_[cell + 1]++] = static_cast<std::int32_t>(s); });
  }
  offsets_.pop_back();
}

// Visits the cells that a segment has in each column, padded.
template <typename Visit>
void SegmentGrid::visit_cells(const Line& line, const Visit& visit) const {
  const auto [a, b] = line;
  const std::int32_t first = x_.cell(a.x - padding_), last = x_.cell(b.x + padding_);
  const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0;
  for (std::int32_t column = first; column <= last; ++column) {
    double from = a.y, to = b.y;
    if (first != last && b.x > a.x) {
      const double left = x_.low + column * x_.step - padding_, right = left + x_.step + 2 * padding_;
      if (left > a.x) from = a.y + (std::min(left, b.x) - a.x) * slope;
      if (right < b.x) to = a.y + (std::max(right, a.x) - a.x) * slope;
    }
    const std::int32_t bottom = y_.cell(std::min(from, to) - padding_),
                       top = y_.cell(std::max(from, to) + padding_);
    for (std::int32_t row = bottom; row <= top; ++row) {
      visit(cell_at(column, row));
    }
  }
}

// Whether two segments cross in another cell. Their place is wrong by less than the padding, so both are in
// its cell.
bool SegmentGrid::is_elsewhere(const Line& p, const Line& q, std::size_t cell) const {
  if (cells() == 1) return false;
  const double px = p.b.x - p.a.x, py = p.b.y - p.a.y, qx = q.b.x - q.a.x, qy = q.b.y - q.a.y;
  const double left = px * qy, right = py * qx, cross = left - right;
  const bool are_nearly_parallel = 64 * std::fabs(cross) < std::fabs(left) + std::fabs(right);
  if (are_nearly_parallel)
    return cell_of(round_crossing(p, q, std::ldexp(1.0, kernel::LOWEST_EXPONENT))) != cell;
  const double part = ((q.a.x - p.a.x) * qy - (q.a.y - p.a.y) * qx) / cross;
  return cell_of({p.a.x + part * px, p.a.y + part * py}) != cell;
}

bool SegmentGrid::find_crossings(const Predicates& predicates, const FoundPair& found) const {
  std::size_t pairs = 0;
  for (std::size_t c = 0; c < cells(); ++c) {
    const std::size_t count = offsets_[c + 1] - offsets_[c];
    pairs += count * count / 2;
  }
  const bool is_bounded = lines_.size() > kInOneCell && pairs > kPairsPerEntry * segments_.size();
  std::size_t compared = 0, most = kFirstPairsPerEntry * segments_.size();
  std::vector<Line> here;
  for (std::size_t c = 0; c < cells(); ++c) {
    const std::uint32_t begin = offsets_[c], end = offsets_[c + 1];
    here.clear();
    for (std::uint32_t k = begin; k < end; ++k) {
      if (is_bounded && compared > most) return false;
      compared += k - begin;
      const Line line = lines_[segments_[k]];
      for (std::uint32_t j = begin; j < k; ++j) {
        const Line& other = here[j - begin];
        if (are_boxes_apart(line, other) || !cross(predicates, line, other)) continue;
        if (is_elsewhere(line, other, c)) continue;
        most += kPairsPerCrossing;
        if (!found(segments_[j], segments_[k])) return true;
      }
      here.push_back(line);
    }
  }
  return true;
}

bool SegmentGrid::find_near(const std::vector<Point>& points, double distance, const FoundPair& found) const {
  std::size_t pairs = 0;
  for (const Point p : points) {
    const std::size_t c = cell_of(p);
    pairs += offsets_[c + 1] - offsets_[c];
  }
  if (pairs > kPairsPerEntry * (segments_.size() + points.size())) return false;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const std::size_t c = cell_of(points[v]);
    for (std::uint32_t k = offsets_[c]; k < offsets_[c + 1]; ++k) {
      // The padding is more than the rounding.
      if (may_be_near({points[v], points[v]}, lines_[segments_[k]], distance + 0x1p-10 * padding_) &&
          !found(segments_[k], static_cast<std::int32_t>(v))) {
        return false;
      }
    }
  }
  return true;
}

std::vector<Line> lines_of(const Point* points, const std::vector<Piece>& pieces) {
  std::vector<Line> lines;
  lines.reserve(pieces.size());
  for (const Piece piece : pieces) lines.push_back({points[piece.from], points[piece.to]});
  return lines;
}

void find_crossings_by_place(const Predicates& predicates, const Point* points,
                             const std::vector<Piece>& pieces, const FoundPair& found) {
  const std::vector<Line> lines = lines_of(points, pieces);
  if (!SegmentGrid(lines).find_crossings(predicates, found)) {
    find_crossings(predicates, points, pieces, found);
  }
}

}  // namespace flaunay::constrained
