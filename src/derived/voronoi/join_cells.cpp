// Cells of each group as polygons with holes: edges that two cells of a group share cancel.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "arithmetic/coordinates.h"
#include "flaunay/flaunay.hpp"
#include "geometry/arguments.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/predicates.hpp"
#include "operations/prefetch.h"

namespace flaunay {
namespace {

using geometry::Point;
using geometry::operator==;
using Numbers = std::vector<std::int32_t>;

std::int32_t number_of(std::size_t size) { return static_cast<std::int32_t>(size); }

std::uint64_t hash_of(Point p) {
  const std::uint64_t hash = kernel::as_ulong(p.x) * 0x9e3779b97f4a7c15 ^ kernel::as_ulong(p.y);
  return (hash ^ (hash >> 32)) * 0xd6e8feb86659fd93;
}

// A hash table of numbers that are 0 or more.
class Table {
 public:
  // Removes all, and makes room for this many.
  void reset(std::size_t count) {
    shift_ = 63;
    while (std::uint64_t{1} << (64 - shift_) < 2 * count) --shift_;
    slots_.assign(std::size_t{1} << (64 - shift_), -1);
  }
  // The slot of the number that fits; if there is none a free one, which has -1.
  template <typename Fits>
  std::int32_t& find(std::uint64_t hash, const Fits& fits) {
    std::size_t slot = hash >> shift_;
    while (slots_[slot] >= 0 && !fits(slots_[slot])) slot = (slot + 1) & (slots_.size() - 1);
    return slots_[slot];
  }

 private:
  Numbers slots_;
  int shift_ = 0;
};

// Cells and their edges have numbers in the order of groups, so that memory is read in that order. Edges
// without a twin are at the border of their group.
class Joiner {
 public:
  Joiner(const ClippedVoronoi& cells, const Numbers& groups, std::size_t group_count)
      : group_offsets_(group_count + 1, 0), members_(groups.size()), parts_(groups.size(), -1) {
    const std::size_t count = cells.vertices.size() / 2;
    const double* const vertices = cells.vertices.data();
    const geometry::Scaling scaling =
        geometry::scaling_for(vertices, 0, count, geometry::inspect(vertices, 0, count));
    scale_ = scaling.powers();
    predicates_.bounds = scaling.bounds;
    for (const std::int32_t group : groups) ++group_offsets_[group + 1];
    std::partial_sum(group_offsets_.begin(), group_offsets_.end(), group_offsets_.begin());
    Numbers next(group_offsets_.begin(), group_offsets_.end() - 1);
    for (std::size_t i = 0; i < groups.size(); ++i) members_[next[groups[i]]++] = number_of(i);
    begins_.reserve(count);
    cell_of_.reserve(count);
    constexpr std::size_t kAhead = 32;
    for (std::size_t cell = 0; cell < members_.size(); ++cell) {
      const std::size_t ahead = cells.offsets[members_[std::min(cell + kAhead, members_.size() - 1)]];
      kernel::fetch(vertices + 2 * ahead);
      const std::int32_t first = cells.offsets[members_[cell]], last = cells.offsets[members_[cell] + 1];
      offsets_.push_back(number_of(begins_.size()));
      moves_.push_back(first - offsets_.back());
      cell_of_.insert(cell_of_.end(), last - first, number_of(cell));
      for (std::int32_t k = first; k < last; ++k) begins_.push_back(place_of(k, vertices));
    }
    offsets_.push_back(number_of(begins_.size()));
    twins_.assign(count, -1);
    places_.resize(count);
    is_done_.assign(count, false);
    parents_.resize(members_.size());
    std::iota(parents_.begin(), parents_.end(), 0);
  }

  JoinedCells run(const std::vector<double>& bounds) {
    const std::size_t groups = group_offsets_.size() - 1;
    for (std::size_t group = 0; group < groups; ++group) find_twins(group);
    find_places(bounds);
    for (std::size_t group = 0; group < groups; ++group) {
      result_.group_offsets.push_back(number_of(result_.part_offsets.size()));
      make_rings(group);
      add_parts(group);
    }
    result_.group_offsets.push_back(number_of(result_.part_offsets.size()));
    result_.part_offsets.push_back(number_of(result_.ring_offsets.size()));
    result_.ring_offsets.push_back(number_of(result_.corners.size()));
    return std::move(result_);
  }

 private:
  struct Ring {
    std::size_t begin, end;  // of ring_edges_
    bool is_hole;
    std::int32_t part;
  };

  // Without a negative zero.
  static Point place_of(std::size_t i, const double* coordinates) {
    const Point p = kernel::vload2(i, coordinates);
    return {p.x + 0.0, p.y + 0.0};
  }
  std::int32_t first_edge(std::size_t group) const { return offsets_[group_offsets_[group]]; }
  std::int32_t next(std::int32_t edge) const {
    const std::int32_t cell = cell_of_[edge];
    return edge + 1 < offsets_[cell + 1] ? edge + 1 : offsets_[cell];
  }
  bool is_border(std::int32_t edge) const { return twins_[edge] < 0; }

  // An edge's twin is the same edge the other way round, of another cell of the group.
  void find_twins(std::size_t group) {
    const std::int32_t end = first_edge(group + 1);
    table_.reset(static_cast<std::size_t>(end - first_edge(group)));
    for (std::int32_t edge = first_edge(group); edge < end; ++edge) {
      const Point from = begins_[edge], to = begins_[next(edge)];
      std::int32_t& slot = table_.find(hash_of(from) + hash_of(to), [&](std::int32_t other) {
        return begins_[other] == to && begins_[next(other)] == from && is_border(other);
      });
      if (slot < 0) {
        slot = edge;
      } else {
        twins_[edge] = slot;
        twins_[slot] = edge;
      }
    }
  }

  // Numbers the places where edges of borders begin. Where two cells of a group meet at the bounds, only one
  // does, and there is no corner.
  void find_places(const std::vector<double>& bounds) {
    table_.reset(bounds.size() / 2 + std::count(twins_.begin(), twins_.end(), -1));
    std::vector<Point> at;
    const auto place_at = [&](Point p, bool stays) {
      std::int32_t& slot = table_.find(hash_of(p), [&](std::int32_t place) { return at[place] == p; });
      if (slot < 0) {
        slot = number_of(at.size());
        at.push_back(p);
        is_corner_.push_back(stays);
      } else {
        is_corner_[slot] = true;
      }
      return slot;
    };
    for (std::size_t i = 0; i < bounds.size() / 2; ++i) place_at(place_of(i, bounds.data()), true);
    for (std::int32_t edge = 0; edge < number_of(begins_.size()); ++edge) {
      if (is_border(edge)) places_[edge] = place_at(begins_[edge], bounds.empty());
    }
    positions_.assign(at.size(), -1);
  }

  // Follows the border of a group. Where a ring meets a place again, a part of it is a ring of its own.
  void make_rings(std::size_t group) {
    rings_.clear();
    ring_edges_.clear();
    for (std::int32_t first = first_edge(group); first < first_edge(group + 1); ++first) {
      if (!is_border(first) || is_done_[first]) continue;
      std::int32_t edge = first;
      do {
        is_done_[edge] = true;
        std::int32_t& position = positions_[places_[edge]];
        if (position >= 0) take_ring(static_cast<std::size_t>(position));
        position = number_of(path_.size());
        path_.push_back(edge);
        // The next edge is found by turning around the edge's end, through cells of the group. So where a
        // group touches itself in a point, each part goes on with its own edges.
        edge = next(edge);
        while (!is_border(edge)) edge = next(twins_[edge]);
      } while (edge != first);
      take_ring(0);
    }
  }

  // Takes the edges from the one at this position on out of the path, as a ring.
  void take_ring(std::size_t position) {
    const std::size_t begin = ring_edges_.size();
    for (std::size_t k = position; k < path_.size(); ++k) {
      const std::int32_t place = places_[path_[k]];
      positions_[place] = -1;
      if (is_corner_[place]) ring_edges_.push_back(path_[k]);
    }
    path_.resize(position);
    const std::size_t end = ring_edges_.size();
    const int turn = end < begin + 3 ? 0 : turn_of(begin, end);
    if (turn == 0) {
      ring_edges_.resize(begin);
    } else {
      rings_.push_back({begin, end, turn < 0, 0});
    }
  }

  // How a ring turns, exactly: at the first of its corners in the order of coordinates. 0: it has no area.
  int turn_of(std::size_t begin, std::size_t end) const {
    std::size_t first = begin;
    for (std::size_t k = begin; k < end; ++k) {
      if (kernel::comes_before(begins_[ring_edges_[k]], begins_[ring_edges_[first]])) first = k;
    }
    const auto at = [&](std::size_t k) {
      return kernel::scaled_point(ring_edges_[k], &begins_[0].x, scale_);
    };
    return predicates_.orient(at((first > begin ? first : end) - 1), at(first),
                              at(first + 1 < end ? first + 1 : begin));
  }

  // A cell that stands for all that are connected with this one.
  std::int32_t root(std::int32_t cell) {
    while (parents_[cell] != cell) cell = parents_[cell] = parents_[parents_[cell]];
    return cell;
  }

  // Appends the rings of a group to the result, in the order of the outer ones, each with its holes.
  void add_parts(std::size_t group) {
    std::int32_t parts = 0;
    for (Ring& ring : rings_) {
      if (!ring.is_hole) ring.part = parts++;
    }
    if (parts == 0) return;
    if (parts > 1 && parts < number_of(rings_.size())) {
      for (std::int32_t edge = first_edge(group); edge < first_edge(group + 1); ++edge) {
        if (!is_border(edge)) parents_[root(cell_of_[edge])] = root(cell_of_[twins_[edge]]);
      }
      const auto part_of = [&](const Ring& ring) -> std::int32_t& {
        return parts_[root(cell_of_[ring_edges_[ring.begin]])];
      };
      for (const Ring& ring : rings_) {
        if (!ring.is_hole) part_of(ring) = ring.part;
      }
      for (Ring& ring : rings_) ring.part = part_of(ring);
    }
    std::sort(rings_.begin(), rings_.end(), [](const Ring& a, const Ring& b) {
      return std::tie(a.part, a.is_hole, a.begin) < std::tie(b.part, b.is_hole, b.begin);
    });
    for (const Ring& ring : rings_) {
      if (ring.part < 0) continue;
      if (!ring.is_hole) result_.part_offsets.push_back(number_of(result_.ring_offsets.size()));
      result_.ring_offsets.push_back(number_of(result_.corners.size()));
      for (std::size_t k = ring.begin; k < ring.end; ++k) {
        result_.corners.push_back(ring_edges_[k] + moves_[cell_of_[ring_edges_[k]]]);
      }
    }
  }

  kernel::scaling scale_{};
  geometry::Predicates predicates_{};
  Numbers group_offsets_, members_;   // which cells a group has
  Numbers offsets_, moves_;           // per cell: its first edge; from edges to vertices
  Numbers parents_, parts_;           // per cell: of a tree of connected cells; of its root
  std::vector<Point> begins_;         // per edge
  Numbers cell_of_, twins_, places_;  // per edge
  std::vector<char> is_done_;         // per edge
  std::vector<char> is_corner_;       // per place
  Numbers positions_, path_;          // per place its position in the path, or -1
  Numbers ring_edges_;
  std::vector<Ring> rings_;  // of a group
  Table table_;
  JoinedCells result_;
};

}  // namespace

JoinedCells join_cells(const ClippedVoronoi& cells, const std::vector<std::int32_t>& groups,
                       std::size_t group_count, const std::vector<double>& bounds) {
  const std::size_t n = groups.size();
  check_count(n, "groups of points");
  check_count(group_count, "groups");
  expect(are_offsets({cells.offsets.begin(), cells.offsets.end()}, n, cells.vertices.size() / 2),
         "the offsets of the cells do not fit their groups and vertices");
  expect(are_indices(groups, group_count),
         "the numbers of groups must be below their count, and not negative");
  expect(std::all_of(bounds.begin(), bounds.end(), [](double x) { return std::isfinite(x); }),
         "the corners of the bounds must be finite");
  return Joiner(cells, groups, group_count).run(bounds);
}

}  // namespace flaunay
