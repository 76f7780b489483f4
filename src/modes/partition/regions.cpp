#include "modes/partition/regions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <numeric>

#include "flaunay/flaunay.hpp"
#include "geometry/cells.hpp"
#include "geometry/halfedges.hpp"
#include "host/native/threads.hpp"
#include "statistics/counter.hpp"

namespace flaunay::partition {
using namespace geometry;
using namespace statistics;

namespace {

// Several regions per thread balance the load; smaller regions would not be worth their overhead.
constexpr std::size_t kRegionsPerThread = 4;
constexpr std::size_t kLeastPointsPerRegion = 1024;

using Ids = std::vector<std::int32_t>;

class RegionCutter {
 public:
  RegionCutter(const Predicates& predicates, const Point* points, std::size_t n,
               const std::vector<BorderEdge>& border, Mesh mesh)
      : predicates_(predicates),
        points_(points),
        n_(static_cast<std::int32_t>(n)),
        border_(border),
        mesh_(std::move(mesh)) {
    std::sort(border_.begin(), border_.end());
  }

  Ids run() {
    for (const BorderEdge& edge : border_) {
      if (edge.first == edge.second) fail("has an edge from a point to itself");
    }
    if (std::adjacent_find(border_.begin(), border_.end()) != border_.end()) fail("has an edge twice");
    if (!find_border()) {
      restore();
      if (!find_border()) fail("has an edge that is not Delaunay, or without a left side");
    }
    return inside();
  }

 private:
  [[noreturn]] static void fail(const char* reason) {
    throw Error(ErrorKind::input, fmt::format("its border {}", reason));
  }

  // One half-edge that leaves each vertex, or -1. At the hull it is the first one counter-clockwise.
  Ids first_halfedges() const {
    Ids first(n_, -1);
    const auto halfedges = static_cast<std::int32_t>(mesh_.triangles.size());
    for (std::int32_t h = 0; h < halfedges; ++h) {
      std::int32_t& out = first[mesh_.triangles[h]];
      if (out < 0 || mesh_.twins[h] < 0) out = h;
    }
    return first;
  }

  // Marks the half-edges of the border. Returns whether every border edge is an edge of the mesh.
  bool find_border() {
    const Ids first = first_halfedges();
    is_border_.assign(mesh_.triangles.size(), 0);
    bool complete = true;
    std::vector<char> wanted(n_, 0);
    for (auto begin = border_.begin(); begin != border_.end();) {
      const std::int32_t from = begin->first;
      auto end = begin;
      for (; end != border_.end() && end->first == from; ++end) wanted[end->second] = 1;
      std::int32_t h = first[from];
      while (h >= 0) {
        char& is_wanted = wanted[mesh_.triangles[next_halfedge(h)]];
        is_border_[h] = is_wanted;
        is_wanted = 0;
        h = mesh_.twins[previous_halfedge(h)];
        if (h == first[from]) break;
      }
      for (; begin != end; ++begin) {
        complete = complete && !wanted[begin->second];
        wanted[begin->second] = 0;
      }
    }
    return complete;
  }

  // Changes cells so that every border edge that is a chord of a cell becomes an edge of the mesh.
  void restore() {
    CellFinder finder(predicates_, points_, mesh_);
    Cell cell;
    Ids position(n_, -1);
    std::vector<Chord> chords;
    while (finder.next(cell)) {
      chords.clear();
      const auto corners = static_cast<std::int32_t>(cell.corners.size());
      for (std::int32_t k = 0; k < corners; ++k) position[cell.corners[k]] = k;
      for (const std::int32_t corner : cell.corners) {
        const auto [begin, end] =
            std::equal_range(border_.begin(), border_.end(), BorderEdge{corner, 0},
                             [](const BorderEdge& a, const BorderEdge& b) { return a.first < b.first; });
        for (auto edge = begin; edge != end; ++edge) {
          if (position[edge->second] < 0) continue;
          chords.push_back(std::minmax(position[corner], position[edge->second]));
        }
      }
      for (const std::int32_t corner : cell.corners) position[corner] = -1;
      if (chords.empty()) continue;
      std::sort(chords.begin(), chords.end(), [](const Chord& a, const Chord& b) {
        return a.second != b.second ? a.second < b.second : a.first > b.first;
      });
      if (!fan_cell(cell, chords, mesh_)) fail("crosses itself");
    }
  }

  // Finds the triangles inside by flooding from the left sides of border edges, without crossing any.
  Ids inside() const {
    std::vector<char> is_inside(mesh_.triangles.size() / 3, 0);
    Ids open;
    const auto reach = [&](std::int32_t t) {
      if (is_inside[t]) return;
      is_inside[t] = 1;
      open.push_back(t);
    };
    const auto halfedges = static_cast<std::int32_t>(mesh_.triangles.size());
    for (std::int32_t h = 0; h < halfedges; ++h) {
      if (is_border_[h]) reach(h / 3);
    }
    while (!open.empty()) {
      const std::int32_t t = open.back();
      open.pop_back();
      for (std::int32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (is_border_[h]) continue;
        const std::int32_t twin = mesh_.twins[h];
        if (twin < 0 || is_border_[twin]) fail("is not closed");
        reach(twin / 3);
      }
    }
    Ids triangles;
    for (std::size_t t = 0; t < is_inside.size(); ++t) {
      if (!is_inside[t]) continue;
      triangles.insert(triangles.end(), mesh_.triangles.begin() + 3 * t, mesh_.triangles.begin() + 3 * t + 3);
    }
    return triangles;
  }

  const Predicates& predicates_;
  const Point* const points_;
  const std::int32_t n_;
  std::vector<BorderEdge> border_;  // sorted
  Mesh mesh_;
  std::vector<char> is_border_;  // per half-edge
};

Ids largest_first(const RegionArrays& regions) {
  Ids order(regions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto size = [&regions](std::int32_t r) {
    return regions.point_offsets[r + 1] - regions.point_offsets[r] + regions.corner_offsets[r + 1] -
           regions.corner_offsets[r];
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return size(a) > size(b); });
  return order;
}

}  // namespace

Ids region_triangles(const Predicates& predicates, const Point* points, std::size_t n,
                     const std::vector<BorderEdge>& border, Mesh mesh) {
  return RegionCutter(predicates, points, n, border, std::move(mesh)).run();
}

Ids solve_region(const Predicates& predicates, const Point* points, const RegionArrays& regions,
                 std::size_t r, TriangulatePoints triangulate, Work* work) {
  const auto corner = [&](std::int32_t c, int k) { return regions.corners[3 * std::size_t(c) + k]; };
  const std::int32_t first_corner = regions.corner_offsets[r], last_corner = regions.corner_offsets[r + 1];
  Ids ids(regions.points.begin() + regions.point_offsets[r],
          regions.points.begin() + regions.point_offsets[r + 1]);
  const auto internal = static_cast<std::ptrdiff_t>(ids.size());
  for (std::int32_t c = first_corner; c < last_corner; ++c) ids.push_back(corner(c, 1));
  std::sort(ids.begin() + internal, ids.end());
  std::inplace_merge(ids.begin(), ids.begin() + internal, ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());

  std::vector<Point> own(ids.size());
  std::transform(ids.begin(), ids.end(), own.begin(), [points](std::int32_t id) { return points[id]; });
  const auto position = [&ids](std::int32_t id) {
    const auto found = std::lower_bound(ids.begin(), ids.end(), id);
    if (found == ids.end() || *found != id) throw Error(ErrorKind::input, "its border is not closed");
    return static_cast<std::int32_t>(found - ids.begin());
  };
  std::vector<BorderEdge> border;
  for (std::int32_t c = first_corner; c < last_corner; ++c) {
    border.emplace_back(position(corner(c, 1)), position(corner(c, 2)));
  }
  Ids triangles = region_triangles(predicates, own.data(), own.size(), border,
                                   triangulate(predicates, own.data(), own.size(), work));
  for (std::int32_t& vertex : triangles) vertex = ids[vertex];
  return triangles;
}

Ids solve_regions(const Predicates& predicates, const Point* points, const RegionArrays& regions,
                  TriangulatePoints triangulate, int threads, OperationCounts* counts) {
  std::vector<Work> works(counts != nullptr ? regions.size() : 0);
  const Ids order = largest_first(regions);
  std::vector<Ids> solutions(regions.size());
  std::vector<std::exception_ptr> failures(regions.size());
  host::Threads(static_cast<std::size_t>(threads)).share_each(order.size(), [&](std::size_t k) {
    const auto r = static_cast<std::size_t>(order[k]);
    try {
      solutions[r] =
          solve_region(predicates, points, regions, r, triangulate, counts != nullptr ? &works[r] : nullptr);
    } catch (...) {
      failures[r] = std::current_exception();
    }
  });
  for (std::size_t r = 0; r < failures.size(); ++r) {
    try {
      if (failures[r]) std::rethrow_exception(failures[r]);
    } catch (const Error& error) {
      throw Error(ErrorKind::internal,
                  fmt::format("region {}: {}; please report the input", r, error.what()));
    }
  }
  for (const Work& done : works) add_beside(*counts, sum_of(done));

  std::size_t total = 0;
  for (const Ids& solution : solutions) total += solution.size();
  Ids triangles;
  triangles.reserve(total);
  for (const Ids& solution : solutions) triangles.insert(triangles.end(), solution.begin(), solution.end());
  return triangles;
}

int levels_for(std::size_t n, int wanted, int threads) {
  if (wanted > 0) return wanted;
  const std::size_t regions =
      std::min(kRegionsPerThread * host::Threads(static_cast<std::size_t>(threads)).count(),
               n / kLeastPointsPerRegion);
  return static_cast<int>(log2_ceiling(std::max<std::size_t>(1, regions)));
}

}  // namespace flaunay::partition
