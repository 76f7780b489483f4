#include "app/verify/window.hpp"

#include <algorithm>
#include <vector>

namespace flaunay::prove {

Window::Window(std::uint64_t most_rows, std::size_t piece_rows)
    : corners(3 * most_rows),
      ids(3 * most_rows),
      coordinates(6 * most_rows),
      begins_(3 * most_rows + 1),
      keys_(3 * most_rows),
      twins_(3 * most_rows),
      claimed_(3 * piece_rows),
      piece_rows_(piece_rows) {}

void Window::check(io::RowSource* neighbors, OpenEdges& edges) {
  check_orientations();
  match_half_edges();
  check_edges(neighbors, edges);
}

void Window::check_orientations() {
  for (std::uint32_t t = 0; t < rows; ++t) {
    const int turn =
        predicates_.orient2d(place(corners[3 * t]), place(corners[3 * t + 1]), place(corners[3 * t + 2]));
    if (turn < 0) violate("{} is clockwise", describe_row(t));
    if (turn == 0) violate("{} is degenerate: its corners are collinear", describe_row(t));
  }
}

void Window::match_half_edges() {
  const std::uint32_t count = 3 * static_cast<std::uint32_t>(rows);
  const std::uint32_t repeated =
      half_edges_.match(count, vertices, begins_.data(), keys_.data(), twins_.data());
  if (repeated == count) return;
  violate("{} has the edge from point {} to point {}, which {} has too", describe_row(repeated / 3),
          ids[origin(repeated)], ids[target(repeated)], describe_row(half_edges_.first_like(repeated) / 3));
}

void Window::check_edges(io::RowSource* neighbors, OpenEdges& edges) {
  constexpr std::size_t kBatch = 4096;
  std::vector<OpenEdge> open;
  for (std::uint32_t t = 0, in_piece = 0; t < rows; ++t, ++in_piece) {
    if (in_piece == piece_rows_) in_piece = 0;
    if (neighbors != nullptr && in_piece == 0) {
      neighbors->read(first_row + t, std::min<std::uint64_t>(piece_rows_, rows - t), claimed_.data());
    }
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t h = 3 * t + k, twin = twins_[h];
      const std::int64_t claimed = neighbors != nullptr ? claimed_[3 * std::size_t{in_piece} + k] : 0;
      if (twin == kNone) {
        open.push_back(
            {3 * first_row + h, claimed, vertex(origin(h)), vertex(target(h)), vertex(corners[h])});
        continue;
      }
      if (twin > h) check_pair(h, twin);
      const auto expected = static_cast<std::int64_t>(first_row + twin / 3);
      if (neighbors != nullptr && claimed != expected) {
        violate("{} has neighbor {} opposite to point {}, but it should be {}", describe_row(t), claimed,
                ids[corners[h]], expected);
      }
    }
    if (open.size() >= kBatch) {
      edges.add(open.data(), open.size());
      open.clear();
    }
  }
  edges.add(open.data(), open.size());
}

void Window::check_pair(std::uint32_t half_edge, std::uint32_t twin) {
  const std::uint32_t t = half_edge / 3;
  const int side = predicates_.incircle(place(corners[3 * t]), place(corners[3 * t + 1]),
                                        place(corners[3 * t + 2]), place(corners[twin]));
  if (side > 0) {
    violate("{} is not Delaunay: its circle contains {}, a corner of triangle {}", describe_row(t),
            describe(vertex(corners[twin])), first_row + twin / 3);
  }
  cocircular_ += side == 0;
  ++matched_;
}

}  // namespace flaunay::prove
