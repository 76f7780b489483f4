#include "constrained/refinement/result.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "constrained/edges_by_ends.hpp"
#include "mesh/corners.hpp"
#include "mesh/rows.hpp"

namespace flaunay::constrained {
namespace {

using Ids = std::vector<std::int32_t>;

// For each point the hull vertex that it is, and for each hull vertex the next one of its set.
struct HullPlaces {
  HullPlaces(const Triangulation& mesh, std::size_t points) : of_points(points, -1), next(mesh.hull.size()) {
    for (std::size_t i = 0; i < next.size(); ++i) {
      of_points[mesh.hull[i]] = static_cast<std::int32_t>(i);
      next[i] = static_cast<std::int32_t>(i + 1);
    }
    for (std::size_t s = 0; s + 1 < mesh.hull_offsets.size(); ++s) {
      const std::size_t first = mesh.hull_offsets[s], end = mesh.hull_offsets[s + 1];
      if (first < end) next[end - 1] = static_cast<std::int32_t>(first);
    }
  }
  Ids of_points, next;
};

// The corners for which something is true, in their order.
template <typename Is>
Ids corners_that(host::Runtime& threads, std::size_t corners, const Is& is) {
  std::vector<Ids> parts(corners / host::Runtime::kPart + 1);
  threads.share_parts(corners, [&](std::size_t begin, std::size_t end) {
    Ids found;
    for (std::size_t c = begin; c < end; ++c) {
      if (is(c)) found.push_back(static_cast<std::int32_t>(c));
    }
    parts[begin / host::Runtime::kPart] = std::move(found);
  });
  Ids all;
  for (const Ids& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

FixedEdges fixed_edges(host::Runtime& threads, const ConstrainedTriangulation& mesh, std::size_t points) {
  const std::size_t constraint_count = mesh.constraint_edges.size() / 2;
  const EdgesByEnds constraints(mesh.constraint_edges, constraint_count > 0 ? points : 0);
  const HullPlaces hull(mesh, points);
  FixedEdges edges;
  threads.resize(edges.of_corners, mesh.triangles.size());
  edges.of_constraints.assign(constraint_count, -1);
  edges.of_hull.assign(mesh.hull.size(), -1);
  const Ids corners = corners_that(threads, mesh.triangles.size(), [&](std::size_t c) {
    edges.of_corners[c] = -1;
    return mesh.neighbors[c] < 0 || mesh.constrained[c] != 0;
  });
  for (const std::int32_t corner : corners) {
    const auto c = static_cast<std::size_t>(corner);
    const bool is_border = mesh.neighbors[c] < 0, is_constraint = mesh.constrained[c] != 0;
    const auto [a, b] = mesh::edge_opposite(mesh.triangles, c);
    const std::int32_t place = is_border ? hull.of_points[a] : -1;
    std::int32_t border = -1, constraint = -1;
    if (is_constraint) constraint = constraints.number(a, b);
    std::int32_t& number = is_constraint ? edges.of_constraints[constraint] : border;
    if (number < 0) {
      number = static_cast<std::int32_t>(edges.is_border.size());
      edges.is_border.push_back(is_border ? 1 : 0);
      const bool is_turned =
          is_constraint && mesh.constraint_edges[2 * static_cast<std::size_t>(constraint)] != a;
      edges.ends.push_back(is_turned ? b : a);
      edges.ends.push_back(is_turned ? a : b);
    }
    edges.of_corners[c] = number;
    if (place >= 0 && mesh.hull[hull.next[place]] == b) edges.of_hull[place] = number;
  }
  return edges;
}

// Which edges must not be split, as in MeshToRefine.
std::vector<std::uint8_t> kept_edges(const Refinement& wanted, const FixedEdges& edges,
                                     const ConstrainedTriangulation& mesh) {
  if (wanted.kept == KeptEdges::none && wanted.kept_segments == nullptr) return {};
  std::vector<std::uint8_t> kept = edges.is_border;
  if (wanted.kept != KeptEdges::border) std::fill(kept.begin(), kept.end(), wanted.kept == KeptEdges::all);
  if (wanted.kept_segments == nullptr) return kept;
  for (std::size_t s = 0; s + 1 < mesh.piece_offsets.size(); ++s) {
    if (wanted.kept_segments[s] == 0) continue;
    for (std::int32_t p = mesh.piece_offsets[s]; p < mesh.piece_offsets[s + 1]; ++p) {
      for (std::int32_t e = mesh.piece_edges[2 * p]; e < mesh.piece_edges[2 * p + 1]; ++e) {
        if (edges.of_constraints[e] >= 0) kept[edges.of_constraints[e]] = 1;
      }
    }
  }
  return kept;
}

// The largest area of each triangle: the smallest of the limits for all triangles, for its region and for
// itself. Empty without limits.
std::vector<double> largest_areas(const Refinement& wanted, const Ids& seeds,
                                  const std::vector<double>& areas, std::size_t triangles) {
  const bool has_seeds = wanted.seed_areas != nullptr && !seeds.empty();
  if (!has_seeds && areas.empty() && !(wanted.max_area > 0)) return {};
  const auto smaller = [](double a, double b) { return a > 0 && b > 0 ? std::min(a, b) : std::max(a, b); };
  std::vector<double> all(triangles, wanted.max_area);
  for (std::size_t t = 0; t < triangles; ++t) {
    if (has_seeds && seeds[t] >= 0) all[t] = smaller(all[t], wanted.seed_areas[seeds[t]]);
    if (!areas.empty()) all[t] = smaller(all[t], areas[t]);
  }
  return all;
}

// The points that were added on each edge, from its first end to its second one.
class EdgeChains {
 public:
  EdgeChains(host::Runtime& threads, const FixedEdges& edges, const RefinedMesh& mesh, std::size_t points) {
    const auto first_added = static_cast<std::int32_t>(points);
    // The points before and after each one that was added, and the first one of each edge.
    Ids links(mesh.added.size(), -1), first(edges.is_border.size(), -1);
    const Ids corners = corners_that(threads, mesh.triangles.size(), [&](std::size_t c) {
      // A piece between two triangles counts once.
      return mesh.edges[c] >= 0 &&
             (mesh.neighbors[c] < 0 || static_cast<std::size_t>(mesh.neighbors[c]) >= c / 3);
    });
    for (const std::int32_t c : corners) {
      const std::int32_t e = mesh.edges[c];
      const auto [a, b] = mesh::edge_opposite(mesh.triangles, c);
      for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
        if (from >= first_added) {
          std::int32_t* const link = &links[2 * static_cast<std::size_t>(from - first_added)];
          link[link[0] < 0 ? 0 : 1] = to;
        } else if (from == edges.ends[2 * static_cast<std::size_t>(e)]) {
          first[e] = to;
        }
      }
    }
    offsets_.push_back(0);
    for (std::size_t e = 0; e < first.size(); ++e) {
      std::int32_t before = edges.ends[2 * e], v = first[e];
      while (v != edges.ends[2 * e + 1]) {
        vertices_.push_back(v);
        const std::int32_t* const link = &links[2 * static_cast<std::size_t>(v - first_added)];
        before = std::exchange(v, link[link[0] == before ? 1 : 0]);
      }
      offsets_.push_back(vertices_.size());
    }
  }
  // Calls add(v) for each point of an edge; edge -1 has none.
  template <typename Add>
  void visit(std::int32_t edge, bool is_turned, const Add& add) const {
    if (edge < 0) return;
    const std::size_t begin = offsets_[edge], end = offsets_[edge + 1];
    for (std::size_t k = begin; k < end; ++k) add(vertices_[is_turned ? begin + end - 1 - k : k]);
  }
  std::size_t vertices() const { return vertices_.size(); }

 private:
  std::vector<std::size_t> offsets_;
  Ids vertices_;
};

void split_constraints(const FixedEdges& edges, const EdgeChains& chains, ConstrainedTriangulation& result) {
  Ids all, segments, first(1, 0);
  all.reserve(result.constraint_edges.size() + 2 * chains.vertices());
  for (std::size_t e = 0; e < edges.of_constraints.size(); ++e) {
    const auto end_piece = [&](std::int32_t v) {
      all.push_back(v);
      segments.push_back(result.edge_segments[e]);
    };
    all.push_back(result.constraint_edges[2 * e]);
    chains.visit(edges.of_constraints[e], false, [&](std::int32_t v) {
      end_piece(v);
      all.push_back(v);
    });
    end_piece(result.constraint_edges[2 * e + 1]);
    first.push_back(static_cast<std::int32_t>(segments.size()));
  }
  result.constraint_edges = std::move(all);
  result.edge_segments = std::move(segments);
  for (std::int32_t& edge : result.piece_edges) edge = first[edge];
}

void split_hull(const FixedEdges& edges, const EdgeChains& chains, Triangulation& result) {
  Ids hull;
  std::vector<std::size_t> offsets;
  for (std::size_t i = 0, s = 0; i <= result.hull.size(); ++i) {
    for (; s < result.hull_offsets.size() && result.hull_offsets[s] == i; ++s) offsets.push_back(hull.size());
    if (i == result.hull.size()) break;
    const std::int32_t v = result.hull[i], edge = edges.of_hull[i];
    hull.push_back(v);
    chains.visit(edge, edge >= 0 && edges.ends[2 * static_cast<std::size_t>(edge)] != v,
                 [&hull](std::int32_t between) { hull.push_back(between); });
  }
  result.hull = std::move(hull);
  result.hull_offsets = std::move(offsets);
}

// Renumbers the added points, after the n other points. A set's points keep their order, so triangles begin
// with the same corners.
void renumber_points(std::size_t n, const Ids& numbers, ConstrainedTriangulation& result) {
  const auto first = static_cast<std::int32_t>(n);
  for (Ids* vertices : {&result.triangles, &result.hull, &result.constraint_edges, &result.representatives}) {
    for (std::int32_t& v : *vertices) v = v < first ? v : first + numbers[v - first];
  }
  mesh::permute(numbers, 2, result.added_points);
  Ids added(result.representatives.begin() + first, result.representatives.end());
  mesh::permute(numbers, 1, added);
  std::copy(added.begin(), added.end(), result.representatives.begin() + first);
}

// Makes the added points of each set consecutive: points that splitting added come first.
void sort_by_sets(std::size_t n, const RefinedOffsets& sets, ConstrainedTriangulation& result) {
  const std::size_t set_count = sets.added.size() - 1;
  std::vector<std::size_t> splits = result.added_offsets;
  splits.resize(set_count + 1, 0);
  if (set_count > 1 && splits.back() > 0) {
    Ids numbers;
    for (std::size_t s = 0; s < set_count; ++s) {
      for (std::size_t k = splits[s]; k < splits[s + 1]; ++k)
        numbers.push_back(static_cast<std::int32_t>(k + sets.added[s]));
    }
    for (std::size_t s = 0; s < set_count; ++s) {
      for (std::size_t k = sets.added[s]; k < sets.added[s + 1]; ++k)
        numbers.push_back(static_cast<std::int32_t>(splits[s + 1] + k));
    }
    renumber_points(n, numbers, result);
  }
  result.added_offsets = sets.added;
  for (std::size_t s = 0; s <= set_count; ++s) result.added_offsets[s] += splits[s];
  result.triangle_offsets = sets.triangles;
}

}  // namespace

MeshToRefine take_mesh(host::Runtime& threads, const double* coordinates, std::size_t points,
                       const Refinement& wanted, const Ids& seeds, const std::vector<double>& areas,
                       ConstrainedTriangulation& result, FixedEdges& edges) {
  edges = fixed_edges(threads, result, points);
  MeshToRefine mesh;
  mesh.coordinates = coordinates;
  mesh.points = points;
  mesh.kept_edges = kept_edges(wanted, edges, result);
  mesh.largest_areas = largest_areas(wanted, seeds, areas, result.triangles.size() / 3);
  mesh.triangles = std::move(result.triangles);
  mesh.neighbors = std::move(result.neighbors);
  mesh.edges = std::move(edges.of_corners);
  mesh.edge_ends = edges.ends;
  return mesh;
}

std::size_t expected_points(const MeshToRefine& mesh, std::size_t first, std::size_t end) {
  double expected = 2.0 * static_cast<double>(end - first);
  for (std::size_t t = first; t < end && !mesh.largest_areas.empty(); ++t) {
    if (mesh.largest_areas[t] <= 0) continue;
    expected += Shape(mesh.coordinates, &mesh.triangles[3 * t]).doubled_area() / 2 / mesh.largest_areas[t];
  }
  return static_cast<std::size_t>(std::min(expected, 0x1p53));
}

void write_mesh(host::Runtime& threads, const FixedEdges& edges, std::size_t n, const RefinedOffsets& sets,
                RefinedMesh& mesh, ConstrainedTriangulation& result) {
  const std::size_t before = result.representatives.size();
  const EdgeChains chains(threads, edges, mesh, before);
  threads.resize(result.representatives, before + mesh.added.size() / 2);
  if (result.added_points.empty()) {
    result.added_points = std::move(mesh.added);
  } else {
    result.added_points.insert(result.added_points.end(), mesh.added.begin(), mesh.added.end());
  }
  std::iota(result.representatives.begin() + static_cast<std::ptrdiff_t>(before),
            result.representatives.end(), static_cast<std::int32_t>(before));
  split_constraints(edges, chains, result);
  split_hull(edges, chains, result);
  std::vector<std::uint8_t> is_constraint(edges.is_border.size() + 1, 0);  // the first one is for no edge
  for (const std::int32_t edge : edges.of_constraints) {
    if (edge >= 0) is_constraint[edge + 1] = 1;
  }
  result.constrained = {};
  threads.resize(result.constrained, mesh.edges.size());
  threads.share_parts(mesh.edges.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) result.constrained[c] = is_constraint[mesh.edges[c] + 1];
  });
  result.triangles = std::move(mesh.triangles);
  result.neighbors = std::move(mesh.neighbors);
  for (Ids* labels : {&result.depths, &result.regions, &result.polygons})
    mesh::inherit(mesh.parents, *labels);
  mesh::inherit(mesh.parents, result.triangle_attributes);
  result.refinement = std::move(mesh.report);
  sort_by_sets(n, sets, result);
  mesh::renumber_labels(result.regions);
}

void measure_angles(host::Runtime& threads, const double* coordinates, std::size_t n, bool with_mean,
                    ConstrainedTriangulation& result) {
  constexpr std::size_t kPart = host::Runtime::kPart;
  const std::size_t count = result.triangles.size() / 3;
  const std::vector<double>& added = result.added_points;
  const auto largest_of = [&](const double* values, std::size_t size) {
    std::vector<double> parts(size / kPart + 1, 0);
    threads.share_parts(size, [&](std::size_t begin, std::size_t end) {
      double largest = 0;
      for (std::size_t i = begin; i < end; ++i) largest = std::max(largest, std::fabs(values[i]));
      parts[begin / kPart] = largest;
    });
    return *std::max_element(parts.begin(), parts.end());
  };
  const double largest = std::max(largest_of(coordinates, 2 * n), largest_of(added.data(), added.size()));
  // With all binary places that there may be, squares of lengths are doubles if the largest one is near 1.
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  const bool is_scaled = exponent < -7 || exponent > 250;
  const double* const points[] = {coordinates, added.data()};
  std::vector<Angles> parts(count / kPart + 1, Angles(with_mean));
  threads.share_parts(count, [&](std::size_t begin, std::size_t end) {
    constexpr std::int32_t kCorners[3] = {0, 1, 2};
    Angles angles(with_mean);
    for (std::size_t t = begin; t < end; ++t) {
      double places[6];
      for (std::size_t k = 0; k < 3; ++k) {
        // Without branches, which could not be predicted.
        const auto v = static_cast<std::size_t>(result.triangles[3 * t + k]);
        const std::size_t is_added = v < n ? 0 : 1;
        const double* const place = points[is_added] + 2 * (v - is_added * n);
        places[2 * k] = place[0];
        places[2 * k + 1] = place[1];
      }
      for (std::size_t i = 0; is_scaled && i < 6; ++i) places[i] = std::ldexp(places[i], -exponent);
      angles.add(places, kCorners);
    }
    parts[begin / kPart] = angles;
  });
  for (std::size_t k = 1; k < parts.size(); ++k) parts[0].add(parts[k]);
  result.refinement.smallest_angle = parts[0].smallest();
  result.refinement.largest_angle = parts[0].largest();
  result.refinement.mean_angle = parts[0].mean();
}

}  // namespace flaunay::constrained
