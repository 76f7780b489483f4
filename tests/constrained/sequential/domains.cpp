#include "tests/constrained/sequential/domains.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

#include "prove/exact.hpp"

namespace flaunay::sequential {
namespace {

using Ids = std::vector<std::int32_t>;

struct Regions {
  Ids of_triangles, depths;
  std::vector<char> left;
};

Regions find_regions(const ConstrainedTriangulation& mesh) {
  const auto triangles = static_cast<std::int32_t>(mesh.triangles.size() / 3);
  Regions regions;
  regions.of_triangles.assign(static_cast<std::size_t>(triangles), -1);
  Ids open;
  for (std::int32_t first = 0; first < triangles; ++first) {
    if (regions.of_triangles[first] >= 0) continue;
    const auto region = static_cast<std::int32_t>(regions.left.size());
    regions.left.push_back(1);
    regions.of_triangles[first] = region;
    open.assign(1, first);
    while (!open.empty()) {
      const std::int32_t t = open.back();
      open.pop_back();
      for (std::int32_t k = 3 * t; k < 3 * t + 3; ++k) {
        const std::int32_t u = mesh.neighbors[k];
        if (u < 0 || mesh.constrained[k] != 0 || regions.of_triangles[u] >= 0) continue;
        regions.of_triangles[u] = region;
        open.push_back(u);
      }
    }
  }
  return regions;
}

// What is crossed at edges on a path from their right to their left.
class EdgeWeights {
 public:
  EdgeWeights(const double* coordinates, const Constraints& constraints, FillRule rule,
              const ConstrainedTriangulation& mesh) {
    const auto place = [coordinates](std::int32_t i) {
      return std::pair(coordinates[2 * static_cast<std::size_t>(i)],
                       coordinates[2 * static_cast<std::size_t>(i) + 1]);
    };
    for (std::size_t s = 0; s < constraints.segment_count && rule != FillRule::nesting; ++s) {
      const bool is_turned = rule == FillRule::winding &&
                             place(constraints.segments[2 * s + 1]) < place(constraints.segments[2 * s]);
      for (std::int32_t e = mesh.piece_edges[2 * s]; e < mesh.piece_edges[2 * s + 1]; ++e) {
        weights_[key(mesh.constraint_edges[2 * e], mesh.constraint_edges[2 * e + 1])] += is_turned ? -1 : 1;
      }
    }
  }

  std::int32_t crossed(std::int32_t v, std::int32_t w) const {
    const auto from = weights_.find(key(v, w)), to = weights_.find(key(w, v));
    return from != weights_.end() ? from->second : to != weights_.end() ? -to->second : 0;
  }

 private:
  static std::uint64_t key(std::int32_t from, std::int32_t to) {
    return static_cast<std::uint64_t>(from) << 32 | static_cast<std::uint32_t>(to);
  }
  std::unordered_map<std::uint64_t, std::int32_t> weights_;
};

bool is_left(std::int32_t depth, FillRule rule, Outside outside) {
  if (outside == Outside::keep) return true;
  return outside == Outside::holes && rule == FillRule::nesting ? depth % 2 != 0 : depth != 0;
}

// Goes from region to region over their borders, those next to the outside first.
void find_depths(const ConstrainedTriangulation& mesh, const constrained::DepthRules& rules,
                 const EdgeWeights& weights, Regions& regions) {
  struct Border {
    std::int32_t to, step;
  };
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
  const auto outside = static_cast<std::int32_t>(regions.left.size());
  std::vector<std::vector<Border>> borders(regions.left.size() + 1);
  Ids levels(borders.size(), kFar), potentials(borders.size(), 0), queue = {outside};
  levels[outside] = 0;
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(mesh.triangles.size()); ++c) {
    const std::int32_t t = c - c % 3, region = regions.of_triangles[c / 3];
    const std::int32_t beyond = mesh.neighbors[c] < 0 ? outside : regions.of_triangles[mesh.neighbors[c]];
    if (mesh.constrained[c] == 0) {
      if (beyond == outside && std::exchange(levels[region], 0) != 0) queue.push_back(region);
    } else if (beyond != region) {
      const std::int32_t in =
          weights.crossed(mesh.triangles[t + (c + 1) % 3], mesh.triangles[t + (c + 2) % 3]);
      borders[beyond].push_back({region, in});
      if (beyond == outside) borders[region].push_back({outside, -in});
    }
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    for (const Border& border : borders[queue[head]]) {
      if (levels[border.to] != kFar) continue;
      levels[border.to] = levels[queue[head]] + 1;
      potentials[border.to] = potentials[queue[head]] + border.step;
      queue.push_back(border.to);
    }
  }
  for (std::int32_t r = 0; r < outside; ++r) {
    regions.depths.push_back(rules.fill == FillRule::nesting    ? levels[r]
                             : rules.fill == FillRule::even_odd ? potentials[r] & 1
                                                                : potentials[r]);
    regions.left[r] = is_left(regions.depths[r], rules.fill, rules.outside) ? 1 : 0;
  }
}

void drop_holes(const double* coordinates, const Constraints& constraints,
                const ConstrainedTriangulation& mesh, Regions& regions) {
  ExactPredicates exact;
  std::vector<std::size_t> offsets = constraints.hole_offsets;
  if (offsets.empty()) offsets = {0, constraints.hole_count};
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    for (std::size_t h = offsets[s]; h < offsets[s + 1]; ++h) {
      const auto contains_hole = [&](std::size_t t) {
        const double* p[3];
        for (std::size_t k = 0; k < 3; ++k) {
          p[k] = coordinates + 2 * static_cast<std::size_t>(mesh.triangles[3 * t + k]);
        }
        const double* const hole = constraints.holes + 2 * h;
        return exact.orient2d(p[0], p[1], hole) >= 0 && exact.orient2d(p[1], p[2], hole) >= 0 &&
               exact.orient2d(p[2], p[0], hole) >= 0;
      };
      for (std::size_t t = mesh.triangle_offsets[s]; t < mesh.triangle_offsets[s + 1]; ++t) {
        if (contains_hole(t)) regions.left[regions.of_triangles[t]] = 0;
      }
    }
  }
}

void leave(ConstrainedTriangulation& mesh, Regions& regions) {
  const std::size_t triangles = mesh.triangles.size() / 3;
  Ids places(triangles, -1), numbers(regions.left.size(), -1);
  std::int32_t count = 0;
  std::vector<std::size_t> offsets;
  for (std::size_t t = 0; t <= triangles; ++t) {
    while (offsets.size() < mesh.triangle_offsets.size() && mesh.triangle_offsets[offsets.size()] == t) {
      offsets.push_back(static_cast<std::size_t>(count));
    }
    if (t < triangles && regions.left[regions.of_triangles[t]] != 0) places[t] = count++;
  }
  std::int32_t left = 0;
  for (std::size_t r = 0; r < numbers.size(); ++r) {
    if (regions.left[r] == 0) continue;
    if (!regions.depths.empty()) regions.depths[left] = regions.depths[r];
    numbers[r] = left++;
  }
  for (std::size_t t = 0; t < triangles; ++t) {
    if (places[t] < 0) continue;
    const auto to = static_cast<std::size_t>(places[t]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t u = mesh.neighbors[3 * t + k];
      mesh.triangles[3 * to + k] = mesh.triangles[3 * t + k];
      mesh.neighbors[3 * to + k] = u < 0 ? -1 : places[u];
      mesh.constrained[3 * to + k] = mesh.constrained[3 * t + k];
    }
    regions.of_triangles[to] = numbers[regions.of_triangles[t]];
  }
  mesh.triangle_offsets = std::move(offsets);
  mesh.triangles.resize(3 * static_cast<std::size_t>(count));
  mesh.neighbors.resize(mesh.triangles.size());
  mesh.constrained.resize(mesh.triangles.size());
  regions.of_triangles.resize(static_cast<std::size_t>(count));
}

}  // namespace

void apply_domains(const double* coordinates, const Constraints& constraints,
                   const call::DomainRequest& request, ConstrainedTriangulation& mesh) {
  Regions regions = find_regions(mesh);
  if (request.needs_depths()) {
    find_depths(mesh, request.rules, EdgeWeights(coordinates, constraints, request.rules.fill, mesh),
                regions);
  }
  drop_holes(coordinates, constraints, mesh, regions);
  leave(mesh, regions);
  if (!request.labels) return;
  for (const std::int32_t region : regions.of_triangles) mesh.depths.push_back(regions.depths[region]);
  mesh.regions = std::move(regions.of_triangles);
}

}  // namespace flaunay::sequential
