#include "call/refine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "call/frame.hpp"
#include "constrained/refinement/angles.hpp"
#include "constrained/refinement/bounds.hpp"
#include "constrained/refinement/refine.hpp"
#include "statistics/phases.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::call {
namespace {

using Ids = std::vector<std::int32_t>;
using constrained::MeshToRefine;
using constrained::RefinedMesh;

// The ends of the edge opposite to a corner, with its triangle on the left.
std::array<std::int32_t, 2> ends_of(const Ids& triangles, std::size_t corner) {
  const std::size_t first = corner - corner % 3;
  return {triangles[first + (corner + 1) % 3], triangles[first + (corner + 2) % 3]};
}

// The constraint edges and borders that the triangles of a result have. They are numbered anew.
struct FixedEdges {
  Ids of_corners;                       // as in MeshToRefine
  Ids ends;                             // 2 per edge; of constraint edges in their order
  std::vector<std::uint8_t> is_border;  // per edge
  Ids of_constraints;                   // per constraint edge: its number here, or -1
  Ids of_hull;                          // per hull vertex: the number of the edge to the next one, or -1
};

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

FixedEdges fixed_edges(const ConstrainedTriangulation& mesh, std::size_t points) {
  const auto key = [](std::int32_t a, std::int32_t b) {
    const auto low = static_cast<std::uint64_t>(std::min(a, b)),
               high = static_cast<std::uint64_t>(std::max(a, b));
    return high << 32 | low;
  };
  const std::size_t constraint_count = mesh.constraint_edges.size() / 2;
  std::unordered_map<std::uint64_t, std::int32_t> numbers(constraint_count);
  for (std::size_t e = 0; e < constraint_count; ++e) {
    numbers.emplace(key(mesh.constraint_edges[2 * e], mesh.constraint_edges[2 * e + 1]), e);
  }
  const HullPlaces hull(mesh, points);
  FixedEdges edges;
  edges.of_corners.assign(mesh.triangles.size(), -1);
  edges.of_constraints.assign(constraint_count, -1);
  edges.of_hull.assign(mesh.hull.size(), -1);
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const bool is_border = mesh.neighbors[c] < 0, is_constraint = mesh.constrained[c] != 0;
    if (!is_border && !is_constraint) continue;
    auto [a, b] = ends_of(mesh.triangles, c);
    const std::int32_t place = is_border ? hull.of_points[a] : -1;
    std::int32_t border = -1, constraint = -1;
    if (is_constraint) constraint = numbers.at(key(a, b));
    std::int32_t& number = is_constraint ? edges.of_constraints[constraint] : border;
    if (number < 0) {
      number = static_cast<std::int32_t>(edges.is_border.size());
      edges.is_border.push_back(is_border ? 1 : 0);
      const bool is_turned =
          is_constraint && mesh.constraint_edges[2 * static_cast<std::size_t>(constraint)] != a;
      edges.ends.insert(edges.ends.end(), {is_turned ? b : a, is_turned ? a : b});
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

// Of the areas that all triangles, those of a region, and each may have, the smallest one. Empty if there is
// none.
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

// About how many points some triangles will have. Only what is far more than there are changes where the work
// is done.
double expected_points(const MeshToRefine& mesh, std::size_t first, std::size_t end) {
  double expected = 2.0 * static_cast<double>(end - first);
  for (std::size_t t = first; t < end && !mesh.largest_areas.empty(); ++t) {
    if (mesh.largest_areas[t] <= 0) continue;
    expected += constrained::Shape(mesh.coordinates, &mesh.triangles[3 * t]).doubled_area() / 2 /
                mesh.largest_areas[t];
  }
  return expected;
}

// The points that were added on each edge, from its first end to its second one.
class EdgeChains {
 public:
  EdgeChains(const FixedEdges& edges, const RefinedMesh& mesh, std::size_t points) {
    const auto first_added = static_cast<std::int32_t>(points);
    // The points before and after each one that was added, and the first one of each edge.
    Ids links(2 * mesh.added_edges.size(), -1), first(edges.is_border.size(), -1);
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
      const std::int32_t e = mesh.edges[c], beyond = mesh.neighbors[c];
      // A piece between two triangles counts once.
      if (e < 0 || (beyond >= 0 && static_cast<std::size_t>(beyond) < c / 3)) continue;
      const auto [a, b] = ends_of(mesh.triangles, c);
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
  // Adds those of an edge to a list; of edge -1 there are none.
  void append(std::int32_t edge, bool is_turned, Ids& to) const {
    if (edge < 0) return;
    const auto begin = vertices_.begin() + static_cast<std::ptrdiff_t>(offsets_[edge]),
               end = vertices_.begin() + static_cast<std::ptrdiff_t>(offsets_[edge + 1]);
    if (is_turned) {
      to.insert(to.end(), std::make_reverse_iterator(end), std::make_reverse_iterator(begin));
    } else {
      to.insert(to.end(), begin, end);
    }
  }

 private:
  std::vector<std::size_t> offsets_;
  Ids vertices_;
};

void split_constraints(const FixedEdges& edges, const EdgeChains& chains, ConstrainedTriangulation& result) {
  Ids all, segments, first(1, 0), chain;
  for (std::size_t e = 0; e < edges.of_constraints.size(); ++e) {
    chain.assign(1, result.constraint_edges[2 * e]);
    chains.append(edges.of_constraints[e], false, chain);
    chain.push_back(result.constraint_edges[2 * e + 1]);
    for (std::size_t k = 1; k < chain.size(); ++k) {
      all.insert(all.end(), {chain[k - 1], chain[k]});
      segments.push_back(result.edge_segments[e]);
    }
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
    chains.append(edge, edge >= 0 && edges.ends[2 * static_cast<std::size_t>(edge)] != v, hull);
  }
  result.hull = std::move(hull);
  result.hull_offsets = std::move(offsets);
}

// Triangles have what those had that they are parts of.
template <typename T>
void inherit(const Ids& parents, std::vector<T>& values) {
  if (values.empty()) return;
  std::vector<T> own;
  own.reserve(parents.size());
  for (const std::int32_t parent : parents) own.push_back(values[parent]);
  values = std::move(own);
}

// Numbers things by their sets, in their order within one. new_numbers: empty if nothing changes. Returns
// where sets begin, and the end.
std::vector<std::size_t> number_by_sets(const Ids& sets, std::size_t set_count, Ids& new_numbers) {
  std::vector<std::size_t> offsets(set_count + 1, 0);
  for (const std::int32_t set : sets) ++offsets[set + 1];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  if (std::is_sorted(sets.begin(), sets.end())) return offsets;
  std::vector<std::size_t> next = offsets;
  for (const std::int32_t set : sets) new_numbers.push_back(static_cast<std::int32_t>(next[set]++));
  return offsets;
}

template <typename T>
void permute(const Ids& numbers, std::size_t columns, std::vector<T>& rows) {
  std::vector<T> permuted(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    permuted[columns * static_cast<std::size_t>(numbers[i / columns]) + i % columns] = rows[i];
  }
  rows = std::move(permuted);
}

// For each triangle the number of its set.
Ids sets_of(const std::vector<std::size_t>& offsets) {
  Ids sets;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s)
    sets.resize(offsets[s + 1], static_cast<std::int32_t>(s));
  return sets;
}

// Numbers the points that were added, of which there are n others, by their sets. A set's points keep their
// order, so triangles begin with the same corners.
void renumber_points(std::size_t n, const Ids& numbers, ConstrainedTriangulation& result) {
  if (numbers.empty()) return;
  const auto first = static_cast<std::int32_t>(n);
  for (Ids* vertices : {&result.triangles, &result.hull, &result.constraint_edges, &result.representatives}) {
    for (std::int32_t& v : *vertices) v = v < first ? v : first + numbers[v - first];
  }
  permute(numbers, 2, result.added_points);
  Ids added(result.representatives.begin() + first, result.representatives.end());
  permute(numbers, 1, added);
  std::copy(added.begin(), added.end(), result.representatives.begin() + first);
}

void renumber_triangles(const Ids& numbers, ConstrainedTriangulation& result) {
  if (numbers.empty()) return;
  for (std::int32_t& neighbor : result.neighbors) neighbor = neighbor < 0 ? neighbor : numbers[neighbor];
  permute(numbers, 3, result.triangles);
  permute(numbers, 3, result.neighbors);
  permute(numbers, 3, result.constrained);
  for (Ids* labels : {&result.depths, &result.regions, &result.polygons}) permute(numbers, 1, *labels);
  permute(numbers, 1, result.triangle_attributes);
  RefinementReport& report = result.refinement;
  std::vector<std::pair<std::int32_t, Excuse>> bad;
  for (std::size_t k = 0; k < report.excuses.size(); ++k) {
    bad.emplace_back(numbers[report.bad_triangles[k]], report.excuses[k]);
  }
  std::sort(bad.begin(), bad.end());
  for (std::size_t k = 0; k < bad.size(); ++k) {
    std::tie(report.bad_triangles[k], report.excuses[k]) = bad[k];
  }
}

// Makes the points of each set follow each other, and its triangles. parents: of triangles.
void sort_by_sets(std::size_t n, const Ids& parents, ConstrainedTriangulation& result) {
  const std::size_t set_count = result.triangle_offsets.size() - 1;
  Ids of_triangles = sets_of(result.triangle_offsets), of_points = sets_of(result.added_offsets);
  inherit(parents, of_triangles);
  of_points.resize(result.added_points.size() / 2, 0);
  for (std::size_t c = 0; c < result.triangles.size(); ++c) {
    const auto v = static_cast<std::size_t>(result.triangles[c]);
    if (v >= n) of_points[v - n] = of_triangles[c / 3];
  }
  Ids numbers;
  result.added_offsets = number_by_sets(of_points, set_count, numbers);
  renumber_points(n, numbers, result);
  numbers.clear();
  result.triangle_offsets = number_by_sets(of_triangles, set_count, numbers);
  renumber_triangles(numbers, result);
}

// Writes the mesh to the result, with its own numbers of points and triangles.
void write_mesh(const FixedEdges& edges, const EdgeChains& chains, RefinedMesh& mesh,
                ConstrainedTriangulation& result) {
  result.added_points.insert(result.added_points.end(), mesh.added.begin(), mesh.added.end());
  const std::size_t before = result.representatives.size();
  result.representatives.resize(before + mesh.added_edges.size());
  std::iota(result.representatives.begin() + static_cast<std::ptrdiff_t>(before),
            result.representatives.end(), static_cast<std::int32_t>(before));
  split_constraints(edges, chains, result);
  split_hull(edges, chains, result);
  std::vector<std::uint8_t> is_constraint(edges.is_border.size(), 0);
  for (const std::int32_t edge : edges.of_constraints) {
    if (edge >= 0) is_constraint[edge] = 1;
  }
  result.constrained.clear();
  for (const std::int32_t edge : mesh.edges) result.constrained.push_back(edge < 0 ? 0 : is_constraint[edge]);
  result.triangles = std::move(mesh.triangles);
  result.neighbors = std::move(mesh.neighbors);
  for (Ids* labels : {&result.depths, &result.regions, &result.polygons}) inherit(mesh.parents, *labels);
  inherit(mesh.parents, result.triangle_attributes);
  result.refinement = std::move(mesh.report);
}

RefinedMesh refine_on(Engine& engine, const MeshToRefine& mesh, bool profile, const Refinement& wanted,
                      Statistics& statistics) {
  RefinedMesh refined;
  {
    Frame call(engine, profile);
    refined = constrained::refine(engine.runtime, mesh, wanted);
    call.end();
  }
  if (&engine != &Engine::of_thread()) add_accounts(engine, statistics);
  return refined;
}

// The numbers of one set's points, triangles and edges in the mesh of all sets.
struct SetNumbers {
  std::size_t first_point = 0, points = 0, first_split = 0, splits = 0, first_triangle = 0, triangles = 0,
              first_edge = 0, edges = 0;

  // Those of its own: its points, and then those that splitting added.
  std::int32_t own(std::int32_t v) const {
    const auto i = static_cast<std::size_t>(v);
    return static_cast<std::int32_t>(i >= first_split ? i - first_split + points : i - first_point);
  }
  // first_added: of the points that were added to this set, in all sets.
  std::int32_t of_all(std::int32_t v, std::size_t first_added) const {
    const auto i = static_cast<std::size_t>(v);
    return static_cast<std::int32_t>(i < points            ? first_point + i
                                     : i < points + splits ? first_split + i - points
                                                           : first_added + i - points - splits);
  }
};

std::vector<SetNumbers> numbers_of_sets(const MeshToRefine& mesh, const std::vector<std::size_t>& offsets,
                                        const ConstrainedTriangulation& result) {
  std::vector<SetNumbers> sets(offsets.size() - 1);
  std::size_t edges = 0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    SetNumbers& set = sets[s];
    set.first_point = offsets[s];
    set.points = offsets[s + 1] - offsets[s];
    set.first_split = offsets.back();
    if (!result.added_offsets.empty()) {
      set.first_split += result.added_offsets[s];
      set.splits = result.added_offsets[s + 1] - result.added_offsets[s];
    }
    set.first_triangle = result.triangle_offsets[s];
    set.triangles = result.triangle_offsets[s + 1] - set.first_triangle;
    // They are numbered in the order of triangles.
    set.first_edge = edges;
    for (std::size_t c = 3 * set.first_triangle; c < 3 * (set.first_triangle + set.triangles); ++c)
      edges = std::max(edges, static_cast<std::size_t>(mesh.edges[c] + 1));
    set.edges = edges - set.first_edge;
  }
  return sets;
}

template <typename T>
std::vector<T> part_of(const std::vector<T>& all, std::size_t first, std::size_t count) {
  if (all.empty()) return {};
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

// The mesh of one set, by numbers of its own. coordinates: where those of its points go.
MeshToRefine mesh_of_set(const MeshToRefine& all, const SetNumbers& set, std::vector<double>& coordinates) {
  const auto append = [&](std::size_t first, std::size_t count) {
    coordinates.insert(coordinates.end(), all.coordinates + 2 * first, all.coordinates + 2 * (first + count));
  };
  append(set.first_point, set.points);
  append(set.first_split, set.splits);
  MeshToRefine mesh;
  mesh.coordinates = coordinates.data();
  mesh.points = set.points + set.splits;
  mesh.triangles = part_of(all.triangles, 3 * set.first_triangle, 3 * set.triangles);
  mesh.neighbors = part_of(all.neighbors, 3 * set.first_triangle, 3 * set.triangles);
  mesh.edges = part_of(all.edges, 3 * set.first_triangle, 3 * set.triangles);
  mesh.edge_ends = part_of(all.edge_ends, 2 * set.first_edge, 2 * set.edges);
  mesh.kept_edges = part_of(all.kept_edges, set.first_edge, set.edges);
  mesh.largest_areas = part_of(all.largest_areas, set.first_triangle, set.triangles);
  for (Ids* vertices : {&mesh.triangles, &mesh.edge_ends}) {
    for (std::int32_t& v : *vertices) v = set.own(v);
  }
  const auto shift = [](Ids& values, std::size_t by) {
    for (std::int32_t& value : values) value = value < 0 ? value : value - static_cast<std::int32_t>(by);
  };
  shift(mesh.neighbors, set.first_triangle);
  shift(mesh.edges, set.first_edge);
  return mesh;
}

// Adds the result of a set to that of all sets, of which there were so many points before.
void append_set(const RefinedMesh& own, const SetNumbers& set, std::size_t points, RefinedMesh& all) {
  const std::size_t first_added = points + all.added_edges.size(), first_triangle = all.parents.size();
  const auto append = [](auto& to, const auto& from, std::size_t by) {
    for (const auto value : from) to.push_back(value < 0 ? value : value + static_cast<std::int32_t>(by));
  };
  for (const std::int32_t v : own.triangles) all.triangles.push_back(set.of_all(v, first_added));
  append(all.neighbors, own.neighbors, first_triangle);
  append(all.edges, own.edges, set.first_edge);
  append(all.parents, own.parents, set.first_triangle);
  append(all.added_edges, own.added_edges, set.first_edge);
  append(all.report.bad_triangles, own.report.bad_triangles, first_triangle);
  all.added.insert(all.added.end(), own.added.begin(), own.added.end());
  all.added_places.insert(all.added_places.end(), own.added_places.begin(), own.added_places.end());
  all.report.excuses.insert(all.report.excuses.end(), own.report.excuses.begin(), own.report.excuses.end());
  all.report.rounds = std::max(all.report.rounds, own.report.rounds);
  all.report.added_points += own.report.added_points;
  all.report.split_points += own.report.split_points;
  all.before_smoothing.add(own.before_smoothing);
}

// Refines sets one by one, small ones on threads, so that each is as if it were alone.
RefinedMesh refine_sets(Implementation& self, Engine& engine, const MeshToRefine& all,
                        const std::vector<SetNumbers>& sets, bool profile, const Refinement& wanted,
                        Statistics& statistics) {
  std::vector<RefinedMesh> parts(sets.size());
  std::vector<std::size_t> small;
  const auto refine_set = [&](std::size_t s, Engine& by) {
    std::vector<double> coordinates;
    const MeshToRefine mesh = mesh_of_set(all, sets[s], coordinates);
    parts[s] = refine_on(by, mesh, profile, wanted, statistics);
  };
  const auto most = static_cast<double>(self.host_tuning().host_points);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const std::size_t first = sets[s].first_triangle, end = first + sets[s].triangles;
    if (first == end) continue;
    if (!profile && expected_points(all, first, end) <= most) {
      small.push_back(s);
    } else {
      refine_set(s, engine);
    }
  }
  const auto on_thread = [&](std::size_t k) { refine_set(small[k], Engine::of_thread()); };
  // The caller's function has one thread.
  if (wanted.areas_at || &engine == &Engine::of_thread()) {
    for (std::size_t k = 0; k < small.size(); ++k) on_thread(k);
  } else {
    self.native().runtime.share(small.size(), on_thread);
  }
  RefinedMesh joined;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    append_set(parts[s], sets[s], all.points, joined);
    parts[s] = {};
  }
  return joined;
}

}  // namespace

void renumber_regions(Ids& regions) {
  if (regions.empty()) return;
  Ids numbers(*std::max_element(regions.begin(), regions.end()) + 1, -1);
  std::int32_t next = 0;
  for (std::int32_t& region : regions) {
    std::int32_t& number = numbers[region];
    if (number < 0) number = next++;
    region = number;
  }
}

void measure_angles(const double* coordinates, std::size_t n, bool with_mean,
                    ConstrainedTriangulation& result) {
  std::vector<double> all(coordinates, coordinates + 2 * n);
  all.insert(all.end(), result.added_points.begin(), result.added_points.end());
  double largest = 0;
  for (const double x : all) largest = std::max(largest, std::fabs(x));
  // With all binary places that there may be, squares of lengths are doubles if the largest one is near 1.
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  if (exponent < -7 || exponent > 250) {
    for (double& x : all) x = std::ldexp(x, -exponent);
  }
  constrained::Angles angles(with_mean);
  for (std::size_t t = 0; t < result.triangles.size(); t += 3) angles.add(all.data(), &result.triangles[t]);
  result.refinement.smallest_angle = angles.smallest();
  result.refinement.largest_angle = angles.largest();
  result.refinement.mean_angle = angles.mean();
}

void check_refinement(const Refinement& wanted, std::size_t seeds) {
  constrained::quality_bounds(wanted.min_angle);
  constrained::check_areas(&wanted.max_area, 1, "all triangles");
  if (wanted.seed_areas != nullptr) constrained::check_areas(wanted.seed_areas, seeds, "seed");
  if (wanted.mesh.areas != nullptr)
    constrained::check_areas(wanted.mesh.areas, wanted.mesh.count, "triangle of the mesh");
  expect(wanted.min_edge == kDefaultMinEdge || (wanted.min_edge >= 0 && std::isfinite(wanted.min_edge)), [&] {
    return fmt::format("the smallest edge is {}, but it must be a length from 0 on", wanted.min_edge);
  });
}

void refine(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
            const ConstrainedOptions& options, const Ids& seeds, const std::vector<double>& areas,
            ConstrainedTriangulation& result) {
  const Refinement& wanted = options.refinement;
  const std::size_t n = offsets.back(), points = n + result.added_points.size() / 2;
  FixedEdges edges = fixed_edges(result, points);
  MeshToRefine mesh;
  mesh.coordinates = coordinates;
  mesh.points = points;
  mesh.triangles = result.triangles;
  mesh.neighbors = result.neighbors;
  mesh.edges = edges.of_corners;
  mesh.edge_ends = edges.ends;
  mesh.kept_edges = kept_edges(wanted, edges, result);
  mesh.largest_areas = largest_areas(wanted, seeds, areas, result.triangles.size() / 3);

  const bool may_stay = !self.is_named() && !options.profile &&
                        expected_points(mesh, 0, mesh.triangles.size() / 3) <=
                            static_cast<double>(self.host_tuning().host_points);
  Engine& asked = may_stay ? Engine::of_thread() : self.for_host_memory();
  Engine& engine = self.with_doubles(asked);
  add_note(asked, engine, "refinement", "refined", result.statistics);
  const statistics::Phases phases(options);
  const host::Runtime::BeforeCompiling announce(engine.runtime,
                                                [&] { phases.interrupt("compiling kernels"); });
  phases.progress("refine", 0);
  RefinedMesh refined = offsets.size() > 2
                            ? refine_sets(self, engine, mesh, numbers_of_sets(mesh, offsets, result),
                                          options.profile, wanted, result.statistics)
                            : refine_on(engine, mesh, options.profile, wanted, result.statistics);

  write_mesh(edges, EdgeChains(edges, refined, points), refined, result);
  sort_by_sets(n, refined.parents, result);
  renumber_regions(result.regions);
  measure_angles(coordinates, n, wanted.smoothing_steps > 0, result);
  result.refinement.smallest_angle_before = refined.before_smoothing.smallest();
  result.refinement.mean_angle_before = refined.before_smoothing.mean();
  result.statistics.points += result.refinement.added_points;
  result.statistics.hull_vertices = result.hull.size();
}

}  // namespace flaunay::call
