#include "geometry/cells.hpp"

#include <algorithm>
#include <cstddef>

#include "flaunay/flaunay.hpp"
#include "geometry/halfedges.hpp"

namespace flaunay::geometry {
namespace {

// Triangulates a convex polygon with chords. A stack holds the open corners, which no chord has cut off yet.
class Fan {
 public:
  Fan(const Cell& cell, Mesh& mesh) : cell_(cell), mesh_(mesh) {}

  bool run(const std::vector<Chord>& chords) {
    const auto corners = static_cast<std::int32_t>(cell_.corners.size());
    auto chord = chords.begin();
    open_.push_back({0, -1});
    for (std::int32_t k = 1; k < corners; ++k) {
      open_.push_back({k, cell_.outer[k - 1]});
      for (; chord != chords.end() && chord->second == k; ++chord) {
        const auto begin = std::lower_bound(
            open_.begin(), open_.end(), chord->first,
            [](const OpenCorner& open, std::int32_t corner) { return open.corner < corner; });
        if (begin->corner != chord->first) return false;
        cut_off(begin - open_.begin());
      }
    }
    cut_off(0);
    join(open_.back().beyond, cell_.outer.back());
    return true;
  }

 private:
  struct OpenCorner {
    std::int32_t corner;
    std::int32_t beyond;  // the twin of the edge from the previous open corner to this one
  };

  // Replaces the open corners after the given one by a fan of triangles; the given one and the last remain,
  // joined by an edge.
  void cut_off(std::size_t begin) {
    for (std::size_t k = begin + 1; k + 1 < open_.size(); ++k) {
      const std::int32_t h = 3 * cell_.triangles[made_++];
      mesh_.triangles[h] = cell_.corners[open_[begin].corner];
      mesh_.triangles[h + 1] = cell_.corners[open_[k].corner];
      mesh_.triangles[h + 2] = cell_.corners[open_[k + 1].corner];
      join(h, open_[k].beyond);
      join(h + 1, open_[k + 1].beyond);
      open_[k + 1].beyond = h + 2;
    }
    open_.erase(open_.begin() + begin + 1, open_.end() - 1);
  }

  void join(std::int32_t a, std::int32_t b) {
    if (a >= 0) mesh_.twins[a] = b;
    if (b >= 0) mesh_.twins[b] = a;
  }

  const Cell& cell_;
  Mesh& mesh_;
  std::vector<OpenCorner> open_;
  std::size_t made_ = 0;
};

}  // namespace

CellFinder::CellFinder(const Predicates& predicates, const Point* points, const Mesh& mesh)
    : mesh_(mesh), dissolved_(mesh.triangles.size(), 0) {
  const auto halfedges = static_cast<std::int32_t>(mesh.triangles.size());
  for (std::int32_t h = 0; h < halfedges; ++h) {
    const std::int32_t twin = mesh.twins[h];
    if (twin < h) continue;
    const std::int32_t* const t = &mesh.triangles[h - h % 3];
    const int side = predicates.circle(points[t[0]], points[t[1]], points[t[2]],
                                       points[mesh.triangles[previous_halfedge(twin)]]);
    if (side > 0) throw Error(ErrorKind::internal, "an edge is not Delaunay; please report the input");
    if (side == 0) {
      dissolved_[h] = dissolved_[twin] = 1;
      seeds_.push_back(h / 3);
    }
  }
  if (!seeds_.empty()) done_.assign(mesh.triangles.size() / 3, 0);
}

bool CellFinder::next(Cell& cell) {
  while (position_ < seeds_.size() && done_[seeds_[position_]]) ++position_;
  if (position_ == seeds_.size()) return false;
  flood(seeds_[position_], cell);
  std::int32_t start = -1;
  for (const std::int32_t t : cell.triangles) {
    for (std::int32_t h = 3 * t; h < 3 * t + 3; ++h) {
      if (!dissolved_[h] && (start < 0 || mesh_.triangles[h] < mesh_.triangles[start])) start = h;
    }
  }
  walk(start, cell);
  if (cell.corners.size() != cell.triangles.size() + 2) {
    throw Error(ErrorKind::internal, "a cocircular cell has a hole; please report the input");
  }
  return true;
}

void CellFinder::flood(std::int32_t seed, Cell& cell) {
  cell.triangles.assign(1, seed);
  done_[seed] = 1;
  for (std::size_t k = 0; k < cell.triangles.size(); ++k) {
    for (std::int32_t h = 3 * cell.triangles[k], end = h + 3; h < end; ++h) {
      if (!dissolved_[h] || done_[mesh_.twins[h] / 3]) continue;
      done_[mesh_.twins[h] / 3] = 1;
      cell.triangles.push_back(mesh_.twins[h] / 3);
    }
  }
  std::sort(cell.triangles.begin(), cell.triangles.end());
}

void CellFinder::walk(std::int32_t start, Cell& cell) const {
  cell.corners.clear();
  cell.outer.clear();
  std::int32_t h = start;
  do {
    cell.corners.push_back(mesh_.triangles[h]);
    cell.outer.push_back(mesh_.twins[h]);
    h = next_halfedge(h);
    while (dissolved_[h]) h = next_halfedge(mesh_.twins[h]);
  } while (h != start);
}

bool fan_cell(const Cell& cell, const std::vector<Chord>& chords, Mesh& mesh) {
  return Fan(cell, mesh).run(chords);
}

}  // namespace flaunay::geometry
