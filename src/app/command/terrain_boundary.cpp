#include "app/command/terrain_boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace flaunay::cli {

Boundary::Boundary(const std::string& path, const io::Map& polygons) {
  if (polygons.polygon_count() == 0) io::fail(path, "has no polygon");
  // Of pixels and contours. Here differences and products of two coordinates are finite, too.
  constexpr double kFarthest = 0x1p509;
  for (std::size_t i = 0; i < polygons.points.size(); ++i) {
    const double x = polygons.points.coordinates[2 * i], y = polygons.points.coordinates[2 * i + 1];
    if (std::fabs(x) < kFarthest && std::fabs(y) < kFarthest) continue;
    io::fail(path, "position {} is ({}, {}); expected coordinates below 2^509, as those of points must be", i,
             x, y);
  }
  double high = -std::numeric_limits<double>::infinity(), heights = 0;
  low_ = std::numeric_limits<double>::infinity();
  for (std::size_t polygon = 0; polygon < polygons.polygon_count(); ++polygon) {
    const std::size_t first = polygons.ring_offsets[polygons.polygon_offsets[polygon]];
    const std::size_t last = polygons.ring_offsets[polygons.polygon_offsets[polygon + 1]];
    for (std::size_t s = first; s < last; ++s) {
      const double* a = &polygons.points.coordinates[2 * static_cast<std::size_t>(polygons.segments[2 * s])];
      const double* b =
          &polygons.points.coordinates[2 * static_cast<std::size_t>(polygons.segments[2 * s + 1])];
      if (a[1] > b[1]) std::swap(a, b);
      edges_.push_back({a[0], a[1], b[0], b[1], polygon});
      low_ = std::min(low_, a[1]);
      high = std::max(high, b[1]);
      heights += b[1] - a[1];
    }
  }
  // So many bands that an edge is in about four of them.
  constexpr double kBands = 4;
  const auto count = static_cast<double>(edges_.size());
  const double bands = heights > 0 ? std::clamp(kBands * count * (high - low_) / heights, 1.0, count) : 1;
  bands_.resize(static_cast<std::size_t>(bands));
  bands_by_ = high > low_ ? static_cast<double>(bands_.size()) / (high - low_) : 0;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    for (std::size_t k = band_of(edges_[e].ay); k <= band_of(edges_[e].by); ++k) {
      bands_[k].push_back(static_cast<std::uint32_t>(e));
    }
  }
}

std::size_t Boundary::band_of(double y) const {
  return static_cast<std::size_t>(
      std::clamp((y - low_) * bands_by_, 0.0, static_cast<double>(bands_.size() - 1)));
}

void Boundary::leave_out(const RasterGrid& grid, double* pixels) const {
  struct Crossing {
    std::size_t row, polygon;
    double x;
    bool operator<(const Crossing& other) const {
      return std::tie(row, polygon, x) < std::tie(other.row, other.polygon, other.x);
    }
  };
  std::vector<Crossing> crossings;
  const auto row_of = [&](double y) {
    return std::clamp((y - grid.y) / grid.dy, -1.0, static_cast<double>(grid.rows));
  };
  for (const Edge& edge : edges_) {
    // Rows go down. One more on each side, since the quotient is rounded.
    const double top = std::max(std::floor(row_of(edge.by)) - 1, 0.0);
    const double bottom = std::min(std::ceil(row_of(edge.ay)) + 1, static_cast<double>(grid.rows) - 1);
    for (double r = top; r <= bottom; ++r) {
      const double y = grid.y + r * grid.dy;
      if (edge.ay <= y && y < edge.by) {
        crossings.push_back({static_cast<std::size_t>(r), edge.polygon, edge.x_at(y)});
      }
    }
  }
  std::sort(crossings.begin(), crossings.end());
  std::vector<char> is_inside(grid.columns);
  auto next = crossings.begin();
  for (std::size_t row = 0; row < grid.rows; ++row) {
    std::fill(is_inside.begin(), is_inside.end(), 0);
    for (; next != crossings.end() && next->row == row; next += 2) {
      const double columns = static_cast<double>(grid.columns);
      const double begin = std::clamp(std::ceil((next->x - grid.x) / grid.dx), 0.0, columns);
      const double end = std::clamp(std::ceil(((next + 1)->x - grid.x) / grid.dx), 0.0, columns);
      std::fill(is_inside.begin() + static_cast<std::ptrdiff_t>(begin),
                is_inside.begin() + static_cast<std::ptrdiff_t>(end), 1);
    }
    double* const line = pixels + row * grid.columns;
    for (std::size_t column = 0; column < grid.columns; ++column) {
      if (is_inside[column] == 0) line[column] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

bool Boundary::has(Place place) const {
  std::vector<std::size_t> crossed;  // polygons, once for each edge to the left
  for (const std::uint32_t e : bands_[band_of(place.y)]) {
    const Edge& edge = edges_[e];
    if (edge.ay <= place.y && place.y < edge.by && edge.x_at(place.y) <= place.x)
      crossed.push_back(edge.polygon);
  }
  std::sort(crossed.begin(), crossed.end());
  for (auto first = crossed.begin(), last = first; first != crossed.end(); first = last) {
    last = std::find_if(first, crossed.end(), [&](std::size_t polygon) { return polygon != *first; });
    if ((last - first) % 2 != 0) return true;
  }
  return false;
}

// The shares of the way from p to q at which edges may be, and 1. Nothing if no edge is near: then all of the
// way is inside, or nothing, as the place p is.
void Boundary::find_cuts(Place p, Place q, std::vector<double>& cuts) const {
  constexpr double kMargin = 0x1p-30;
  const auto [left, right] = std::minmax(p.x, q.x);
  const auto [low, high] = std::minmax(p.y, q.y);
  const double dx = q.x - p.x, dy = q.y - p.y;
  cuts.clear();
  for (std::size_t k = band_of(low); k <= band_of(high); ++k) {
    for (const std::uint32_t i : bands_[k]) {
      const Edge& e = edges_[i];
      if (std::max(e.ax, e.bx) < left || std::min(e.ax, e.bx) > right || e.by < low || e.ay > high) continue;
      cuts.push_back(1);
      const double ex = e.bx - e.ax, ey = e.by - e.ay, across = dx * ey - dy * ex;
      if (across != 0) {
        const double along = ((e.ax - p.x) * dy - (e.ay - p.y) * dx) / across;
        if (-kMargin <= along && along <= 1 + kMargin)
          cuts.push_back(((e.ax - p.x) * ey - (e.ay - p.y) * ex) / across);
      } else {
        for (const Place end : {Place{e.ax, e.ay}, Place{e.bx, e.by}})
          cuts.push_back(((end.x - p.x) * dx + (end.y - p.y) * dy) / (dx * dx + dy * dy));
      }
    }
  }
  std::sort(cuts.begin(), cuts.end());
}

std::vector<Boundary::Line> Boundary::pieces_of(const Line& line) const {
  std::vector<Line> pieces;
  Line piece;
  const auto end_piece = [&] {
    if (piece.size() > 1) pieces.push_back(piece);
    piece.clear();
  };
  const auto append = [&](Place place) {
    if (piece.empty() || !(piece.back() == place)) piece.push_back(place);
  };
  std::vector<double> cuts;
  bool is_in = has({line[0].x / 2 + line[1].x / 2, line[0].y / 2 + line[1].y / 2}), is_whole = true;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Place p = line[i], q = line[i + 1];
    const auto at = [&](double share) {
      return share >= 1 ? q : Place{p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)};
    };
    find_cuts(p, q, cuts);
    double before = 0;
    if (is_in) append(p);
    for (const double cut : cuts) {
      if (cut < 0 || cut > 1 || cut == before) continue;
      is_in = has(at(before / 2 + cut / 2));
      is_whole = is_whole && is_in;
      if (is_in) {
        append(at(before));
        append(at(cut));
      } else {
        end_piece();
      }
      before = cut;
    }
    if (is_in) {
      append(q);
    } else {
      is_whole = false;
      end_piece();
    }
  }
  end_piece();
  // A closed line that has been cut elsewhere goes on at its first point.
  const bool is_closed = line.front() == line.back();
  if (!is_whole && is_closed && pieces.size() > 1 && pieces.front().front() == line.front() &&
      pieces.back().back() == line.back()) {
    pieces.back().insert(pieces.back().end(), pieces.front().begin() + 1, pieces.front().end());
    pieces.erase(pieces.begin());
  }
  // There and back, if both ways cross the boundary at the same rounded place.
  const auto is_nothing = [](const Line& each) { return each.size() == 3 && each.front() == each.back(); };
  pieces.erase(std::remove_if(pieces.begin(), pieces.end(), is_nothing), pieces.end());
  return pieces;
}

Contours Boundary::clipped(const Contours& lines) const {
  Contours result;
  result.offsets.push_back(0);
  for (std::size_t i = 0; i < lines.heights.size();) {
    std::vector<Line> pieces;
    const std::int32_t height = lines.heights[i];
    for (; i < lines.heights.size() && lines.heights[i] == height; ++i) {
      Line line;
      for (std::size_t p = lines.offsets[i]; p < lines.offsets[i + 1]; ++p) {
        line.push_back({lines.coordinates[2 * p], lines.coordinates[2 * p + 1]});
      }
      for (Line& piece : pieces_of(line)) pieces.push_back(std::move(piece));
    }
    std::sort(pieces.begin(), pieces.end());
    for (const Line& piece : pieces) {
      for (const Place& place : piece)
        result.coordinates.insert(result.coordinates.end(), {place.x, place.y});
      result.offsets.push_back(result.coordinates.size() / 2);
      result.heights.push_back(height);
    }
  }
  return result;
}

}  // namespace flaunay::cli
