#include "constrained/domains/domain_on_host.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "constrained/domains/borders.hpp"
#include "geometry/halfedges.hpp"
#include "geometry/predicates.hpp"

namespace flaunay::constrained {
namespace {

using Ids = std::vector<std::int32_t>;

// What is crossed at edges on a path from their right to their left.
class EdgeWeights {
 public:
  EdgeWeights(const double* coordinates, std::size_t points, const Constraints& constraints,
              const DepthRules& rules, const ConstrainedTriangulation& mesh)
      : coordinates_(coordinates), sums_(mesh.constraint_edges.size() / 2 + 1, 0) {
    if (rules.fill == FillRule::nesting) return;
    Ids balances(points, 0);
    for (std::size_t s = 0; s < constraints.segment_count; ++s) {
      cover(s, constraints.segments, rules.fill, mesh, balances);
    }
    for (std::size_t i = 0; i < points && !rules.are_closed; ++i) {
      if (rules.fill == FillRule::winding ? balances[i] != 0 : balances[i] % 2 != 0) {
        throw_not_closed(rules.fill, i, coordinates[2 * i], coordinates[2 * i + 1]);
      }
    }
    std::partial_sum(sums_.begin(), sums_.end(), sums_.begin());
    numbers_.reserve(sums_.size());
    for (std::size_t e = 0; e + 1 < sums_.size(); ++e) {
      numbers_.emplace(key(mesh.constraint_edges[2 * e], mesh.constraint_edges[2 * e + 1]), e);
    }
  }

  std::int32_t crossed(std::int32_t v, std::int32_t w) const {
    const auto from = numbers_.find(key(v, w)), to = numbers_.find(key(w, v));
    if (from != numbers_.end()) return sums_[from->second];
    return to != numbers_.end() ? -sums_[to->second] : 0;
  }

 private:
  static std::uint64_t key(std::int32_t from, std::int32_t to) {
    return static_cast<std::uint64_t>(from) << 32 | static_cast<std::uint32_t>(to);
  }
  geometry::Point point(std::int32_t i) const {
    return {coordinates_[2 * static_cast<std::size_t>(i)], coordinates_[2 * static_cast<std::size_t>(i) + 1]};
  }
  // Goes along the pieces of a segment, from its lexicographically smaller end.
  void cover(std::size_t s, const std::int32_t* segments, FillRule rule, const ConstrainedTriangulation& mesh,
             Ids& balances) {
    const std::int32_t a = mesh.representatives[segments[2 * s]],
                       b = mesh.representatives[segments[2 * s + 1]];
    if (a == b) return;
    balances[a] += 1;
    balances[b] += rule == FillRule::winding ? -1 : 1;
    const bool is_turned = kernel::comes_before(point(b), point(a)) != 0;
    std::int32_t from = is_turned ? b : a;
    for (std::int32_t p = mesh.piece_offsets[s]; p < mesh.piece_offsets[s + 1]; ++p) {
      const std::int32_t first = mesh.piece_edges[2 * p], end = mesh.piece_edges[2 * p + 1];
      if (first == end) continue;
      const std::int32_t low = mesh.constraint_edges[2 * first], high = mesh.constraint_edges[2 * end - 1];
      const bool is_backward = low != from;
      from = is_backward ? low : high;
      const std::int32_t amount = rule == FillRule::winding && is_backward != is_turned ? -1 : 1;
      sums_[first] += amount;
      sums_[end] -= amount;
    }
  }

  const double* coordinates_;
  Ids sums_;
  std::unordered_map<std::uint64_t, std::size_t> numbers_;
};

void find_depths(const ConstrainedTriangulation& mesh, const DepthRules& rules, const EdgeWeights& weights,
                 HostRegions& regions) {
  const Ids& of = regions.of_triangles;
  Ids between, steps, levels(regions.left.size(), kernel::UNREACHED), potentials(levels.size(), 0);
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(of.size()); ++t) {
    for (std::int32_t k = 0; k < 3; ++k) {
      const std::int32_t u = mesh.neighbors[3 * t + k];
      if (mesh.constrained[3 * t + k] == 0) {
        if (u < 0) levels[of[t]] = 0;
      } else if (u < t && (u < 0 || of[u] != of[t])) {
        between.insert(between.end(), {u < 0 ? -1 : of[u], of[t]});
        steps.push_back(
            weights.crossed(mesh.triangles[3 * t + (k + 1) % 3], mesh.triangles[3 * t + (k + 2) % 3]));
      }
    }
  }
  walk_borders(between, steps, levels, potentials);
  regions.depths.resize(levels.size());
  for (std::size_t r = 0; r < levels.size(); ++r) {
    const auto rule = static_cast<int>(rules.fill);
    regions.depths[r] = kernel::depth_of(levels[r], potentials[r], rule);
    regions.left[r] =
        static_cast<char>(kernel::is_left(regions.depths[r], rule, static_cast<int>(rules.outside)));
  }
}

void drop_holes(const double* coordinates, const std::vector<std::size_t>& offsets,
                const Constraints& constraints, const ConstrainedTriangulation& mesh, HostRegions& regions) {
  if (constraints.hole_count == 0) return;
  const Places places = holes_of(constraints, offsets.size() - 1);
  const Seeds seeds = make_seeds(places, magnitudes_at(places, coordinates, offsets, mesh.added_offsets));
  Ids found(seeds.places.size(), -1);
  std::vector<std::uint8_t> barred(seeds.places.size(), 0);
  for (std::size_t s = 0; s + 1 < seeds.offsets.size(); ++s) {
    if (seeds.offsets[s] == seeds.offsets[s + 1]) continue;
    for (std::size_t t = mesh.triangle_offsets[s]; t < mesh.triangle_offsets[s + 1]; ++t) {
      geometry::Point p[3];
      for (int k = 0; k < 3; ++k) {
        p[k] = kernel::scaled_point(mesh.triangles[3 * t + k], coordinates, seeds.frames[s].scale);
      }
      const auto [least, most] = std::minmax({p[0].x, p[1].x, p[2].x});
      const auto first = seeds.places.begin() + static_cast<std::ptrdiff_t>(seeds.offsets[s]),
                 last = seeds.places.begin() + static_cast<std::ptrdiff_t>(seeds.offsets[s + 1]);
      const auto low = std::lower_bound(first, last, least,
                                        [](const geometry::Point& place, double x) { return place.x < x; });
      for (auto h = static_cast<std::size_t>(low - seeds.places.begin());
           h < seeds.offsets[s + 1] && seeds.places[h].x <= most; ++h) {
        int sides[3];
        for (int k = 0; k < 3; ++k) {
          sides[k] = kernel::orient_sign(p[(k + 1) % 3], p[(k + 2) % 3], seeds.places[h], seeds.bound);
        }
        if (std::min({sides[0], sides[1], sides[2]}) < 0) continue;
        if (found[h] < 0) found[h] = static_cast<std::int32_t>(t);
        for (int k = 0; k < 3; ++k) {
          if (sides[k] == 0 && mesh.constrained[3 * t + k] != 0) barred[h] = 1;
        }
      }
    }
  }
  found = in_order(seeds, found, barred);
  check_found(places, found);
  for (const std::int32_t t : found) regions.left[regions.of_triangles[t]] = 0;
}

}  // namespace

HostRegions find_regions_on_host(const ConstrainedTriangulation& mesh) {
  const auto triangles = static_cast<std::int32_t>(mesh.triangles.size() / 3);
  HostRegions regions;
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

namespace {

void leave(ConstrainedTriangulation& mesh, HostRegions& regions) {
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
    if (!mesh.polygons.empty()) mesh.polygons[to] = mesh.polygons[t];
  }
  mesh.triangle_offsets = std::move(offsets);
  mesh.triangles.resize(3 * static_cast<std::size_t>(count));
  mesh.neighbors.resize(mesh.triangles.size());
  mesh.constrained.resize(mesh.triangles.size());
  regions.of_triangles.resize(static_cast<std::size_t>(count));
  if (!mesh.polygons.empty()) mesh.polygons.resize(regions.of_triangles.size());
}

}  // namespace

void leave_on_host(const double* coordinates, const std::vector<std::size_t>& offsets,
                   const Constraints& constraints, bool labels, HostRegions& regions,
                   ConstrainedTriangulation& result) {
  drop_holes(coordinates, offsets, constraints, result, regions);
  if (std::find(regions.left.begin(), regions.left.end(), 0) != regions.left.end()) leave(result, regions);
  if (!labels) return;
  result.depths.resize(regions.of_triangles.size());
  for (std::size_t t = 0; t < result.depths.size(); ++t) {
    result.depths[t] = regions.depths[regions.of_triangles[t]];
  }
  result.regions = std::move(regions.of_triangles);
}

std::vector<geometry::Magnitudes> magnitudes_at(const Places& places, const double* coordinates,
                                                const std::vector<std::size_t>& offsets,
                                                const std::vector<std::size_t>& added_offsets) {
  const std::size_t sets = offsets.size() - 1, n = offsets.back();
  std::vector<geometry::Magnitudes> magnitudes(sets);
  for (std::size_t s = 0; s < sets; ++s) {
    if (places.offsets[s] == places.offsets[s + 1]) continue;
    magnitudes[s] =
        geometry::joined(geometry::inspect(coordinates, offsets[s], offsets[s + 1]),
                         geometry::inspect(coordinates, n + added_offsets[s], n + added_offsets[s + 1]));
  }
  return magnitudes;
}

void apply_domains_on_host(const double* coordinates, const std::vector<std::size_t>& offsets,
                           const Constraints& constraints, const DomainRequest& request,
                           ConstrainedTriangulation& result) {
  HostRegions regions = find_regions_on_host(result);
  if (request.needs_depths()) {
    const EdgeWeights weights(coordinates, offsets.back(), constraints, request.rules, result);
    find_depths(result, request.rules, weights, regions);
  }
  leave_on_host(coordinates, offsets, constraints, request.labels, regions, result);
}

}  // namespace flaunay::constrained
