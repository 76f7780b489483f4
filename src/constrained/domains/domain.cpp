#include "constrained/domains/domain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "constrained/fill_rules.h"
#include "geometry/arguments.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/constrained/domain.cl.hpp"
#include "launchers/constrained/seeds.cl.hpp"
#include "points/device_mesh.hpp"
#include "points/query_range.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::constrained {

static_assert(static_cast<int>(FillRule::nesting) == kernel::FILL_NESTING);
static_assert(static_cast<int>(FillRule::even_odd) == kernel::FILL_EVEN_ODD);
static_assert(static_cast<int>(FillRule::winding) == kernel::FILL_WINDING);
static_assert(static_cast<int>(Outside::keep) == kernel::OUTSIDE_KEEP);
static_assert(static_cast<int>(Outside::hull) == kernel::OUTSIDE_HULL);
static_assert(static_cast<int>(Outside::holes) == kernel::OUTSIDE_HOLES);

namespace {

// After this many times Tuning::depth_rounds levels the host takes over: one pass over all borders per level
// would take longer if there are very many levels.
constexpr std::size_t kMostBatches = 4;

constexpr cl_int kNone = std::numeric_limits<cl_int>::max();

template <typename T>
Buffer<T> filled(host::Runtime& runtime, std::size_t count, T value) {
  const auto buffer = runtime.arena().allocate<T>(count);
  runtime.fill(buffer, count, value);
  return buffer;
}

// The segments that are crossed at each constraint edge.
struct Weights {
  cl_int mask = 0;  ///< of the slots
  Buffer<cl_uint> needed{}, sums{};
  Buffer<cl_int> slots{};
};

// Throws if segments are no closed curves.
void check_closed(host::Runtime& runtime, const DomainMesh& mesh, FillRule rule) {
  const auto balances = filled(runtime, mesh.points(), cl_uint{0});
  runtime.map(mesh.segments, kernels::count_ends{.rule = rule,
                                                 .segments = mesh.segment_ends,
                                                 .representatives = mesh.representatives,
                                                 .balances = balances});
  const auto bad = filled(runtime, 1, kNone);
  runtime.map(mesh.points(), kernels::find_unbalanced{.rule = rule, .balances = balances, .bad = bad});
  const cl_int point = runtime.read_one(bad, 0);
  if (point == kNone) return;
  double place[2];
  runtime.read(mesh.coordinates, 2 * static_cast<std::size_t>(point), 2, place);
  throw Error(
      ErrorKind::input,
      fmt::format(
          "segments are no closed curves at point {} ({:.17g}, {:.17g}): {}", point, place[0], place[1],
          rule == FillRule::winding ? "not as many begin there as end" : "an odd number of them ends there"));
}

Weights weigh_edges(host::Runtime& runtime, const DomainMesh& mesh, const DepthRules& rules) {
  Weights weights;
  weights.needed = filled(runtime, 1, cl_uint{0});
  if (rules.fill == FillRule::nesting) return weights;
  // One place more at the end, where segments along the last edge end.
  weights.sums = filled(runtime, mesh.edges + 2, cl_uint{0});
  runtime.map(mesh.segments, kernels::cover_edges{.rule = rules.fill,
                                                  .input = mesh.coordinates.as<cl_ulong>(),
                                                  .segments = mesh.segment_ends,
                                                  .representatives = mesh.representatives,
                                                  .piece_offsets = mesh.piece_offsets,
                                                  .piece_edges = mesh.piece_edges,
                                                  .edges = mesh.constraint_edges,
                                                  .changes = weights.sums});
  if (!rules.are_closed) check_closed(runtime, mesh, rules.fill);
  host::exclusive_scan(runtime, weights.sums, mesh.edges + 1, weights.sums);
  runtime.map(mesh.edges,
              kernels::find_even{.rule = rules.fill, .sums = weights.sums, .needed = weights.needed});
  std::size_t size = 8;
  while (size < 2 * mesh.edges) size *= 2;
  weights.mask = static_cast<cl_int>(size - 1);
  weights.slots = filled(runtime, size, cl_int{-1});
  runtime.map(mesh.edges, kernels::list_edges{.mask = weights.mask,
                                              .needed = weights.needed,
                                              .edges = mesh.constraint_edges,
                                              .slots = weights.slots});
  return weights;
}

// The borders between regions, and how far these are from the outside.
struct Borders {
  std::size_t count = 0;
  Buffer<cl_int> regions{}, steps{};
  Buffer<cl_int> levels{}, potentials{};  ///< by region
};

Borders find_borders(host::Runtime& runtime, const DomainMesh& mesh, const DepthRules& rules,
                     const Regions& regions) {
  const std::size_t triangles = mesh.triangle_count();
  Borders borders;
  borders.levels = filled(runtime, regions.count, cl_int{kernel::UNREACHED});
  borders.potentials = filled(runtime, regions.count, cl_int{0});
  const auto places = runtime.arena().allocate<cl_uint>(triangles + 1);
  runtime.map(triangles, kernels::count_borders{.neighbors = mesh.neighbors,
                                                .constrained = mesh.constrained,
                                                .regions = regions.of_triangles,
                                                .counts = places,
                                                .levels = borders.levels});
  host::exclusive_scan(runtime, places, triangles, places);
  const Weights weights = weigh_edges(runtime, mesh, rules);
  borders.count = runtime.read_one(places, triangles);
  borders.regions = runtime.arena().allocate<cl_int>(2 * borders.count);
  borders.steps = runtime.arena().allocate<cl_int>(borders.count);
  if (borders.count == 0) return borders;
  runtime.map(triangles, kernels::write_borders{
                             .rule = rules.fill,
                             .mask = weights.mask,
                             .triangulation = {.triangles = mesh.triangles, .neighbors = mesh.neighbors},
                             .constrained = mesh.constrained,
                             .regions = regions.of_triangles,
                             .places = places,
                             .input = mesh.coordinates.as<cl_ulong>(),
                             .needed = weights.needed,
                             .sums = weights.sums,
                             .edges = mesh.constraint_edges,
                             .slots = weights.slots,
                             .borders = borders.regions,
                             .steps = borders.steps});
  return borders;
}

// Computes the levels of regions, and their potentials: the sums of steps from the outside. between: two
// regions per border; the first may be -1, the outside. steps: from the first to the second region. levels:
// known levels are correct, all regions up to the largest known level are known, and other regions are
// UNREACHED. O(regions + borders).
void walk_borders(const std::vector<std::int32_t>& between, const std::vector<std::int32_t>& steps,
                  std::vector<std::int32_t>& levels, std::vector<std::int32_t>& potentials) {
  const auto outside = static_cast<std::int32_t>(levels.size());
  levels.push_back(0);
  potentials.push_back(0);
  const auto region = [&](std::size_t end) { return between[end] < 0 ? outside : between[end]; };
  // The ends of borders, grouped by region.
  std::vector<std::int32_t> offsets(levels.size() + 1, 0), ends(between.size());
  for (std::size_t end = 0; end < between.size(); ++end) ++offsets[region(end) + 1];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  std::vector<std::int32_t> place(offsets.begin(), offsets.end() - 1);
  for (std::size_t end = 0; end < between.size(); ++end) {
    ends[place[region(end)]++] = static_cast<std::int32_t>(end);
  }
  std::vector<std::int32_t> queue;
  for (std::int32_t r = 0; r <= outside; ++r) {
    if (levels[r] != kernel::UNREACHED) queue.push_back(r);
  }
  std::stable_sort(queue.begin(), queue.end(),
                   [&](std::int32_t a, std::int32_t b) { return levels[a] < levels[b]; });
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::int32_t from = queue[head];
    for (std::int32_t i = offsets[from]; i < offsets[from + 1]; ++i) {
      const std::int32_t end = ends[i], to = region(static_cast<std::size_t>(end ^ 1));
      if (levels[to] != kernel::UNREACHED) continue;
      levels[to] = levels[from] + 1;
      potentials[to] = potentials[from] + (end % 2 == 0 ? steps[end / 2] : -steps[end / 2]);
      queue.push_back(to);
    }
  }
  levels.pop_back();
  potentials.pop_back();
}

// Reaches deep regions on the host.
void reach_on_host(host::Runtime& runtime, FillRule rule, const Borders& borders, std::size_t regions) {
  std::vector<cl_int> between(2 * borders.count), steps(borders.count), levels(regions), potentials(regions);
  const host::Runtime::Settled settled(runtime);
  runtime.read_later(borders.regions, 0, between.size(), between.data());
  runtime.read_later(borders.levels, 0, regions, levels.data());
  if (rule != FillRule::nesting) {
    runtime.read_later(borders.steps, 0, steps.size(), steps.data());
    runtime.read_later(borders.potentials, 0, regions, potentials.data());
  }
  runtime.finish();
  walk_borders(between, steps, levels, potentials);
  runtime.write_kept(borders.levels, std::move(levels));
  if (rule != FillRule::nesting) runtime.write_kept(borders.potentials, std::move(potentials));
}

void reach_all(host::Runtime& runtime, FillRule rule, const Borders& borders, std::size_t regions) {
  const std::size_t rounds = tuning_of(runtime).depth_rounds, most = kMostBatches * rounds;
  const auto reached = filled(runtime, most, cl_int{0});
  for (std::size_t level = 0; level < most; ++level) {
    runtime.map(borders.count, kernels::reach_regions{.rule = rule,
                                                      .level = level,
                                                      .borders = borders.regions,
                                                      .steps = borders.steps,
                                                      .levels = borders.levels,
                                                      .potentials = borders.potentials,
                                                      .reached = reached});
    if ((level + 1) % rounds == 0 && runtime.read_one(reached, level) == 0) return;
  }
  reach_on_host(runtime, rule, borders, regions);
}

std::string place_of(const Places& places, std::size_t k) {
  return fmt::format("({:.17g}, {:.17g})", places.coordinates[2 * k], places.coordinates[2 * k + 1]);
}

// The first place of a set that is too far from its points, or too fine.
[[noreturn]] void throw_range(const Places& places, std::size_t first, std::size_t last,
                              const geometry::Magnitudes& points) {
  std::size_t place = first;
  const auto fits = [&](std::size_t k) {
    const auto both = geometry::joined(points, geometry::inspect(places.coordinates, k, k + 1));
    return geometry::bits_of(both) <= points::kOrientLimits.most_bits();
  };
  while (place + 1 < last && fits(place)) ++place;
  throw Error(ErrorKind::input, fmt::format("{} {} at {} is too fine or too far away to be exact",
                                            places.name, place, place_of(places, place)));
}

Places checked_places(const char* name, const double* coordinates, std::size_t count,
                      std::vector<std::size_t> offsets, std::size_t sets) {
  if (offsets.empty() && sets == 1) offsets = {0, count};
  if (offsets.size() != sets + 1 || offsets.back() != count) {
    throw Error(ErrorKind::usage, fmt::format("the offsets of {} {}s do not fit {} sets", count, name, sets));
  }
  check_offsets(offsets);
  return {name, coordinates, count, std::move(offsets)};
}

// Places, sorted and scaled.
struct Seeds {
  std::vector<std::size_t> offsets;         // of sets
  std::vector<kernel::query_frame> frames;  // how sets are scaled
  float bound = 0;                          // of orientations
  std::vector<cl_double2> places;           // in each set by ascending x, scaled
  std::vector<std::int32_t> numbers;        // the caller's numbers of the places
};

Seeds make_seeds(const Places& places, const double* coordinates, const std::vector<std::size_t>& offsets,
                 const std::vector<std::size_t>& added_offsets) {
  Seeds seeds;
  const std::size_t n = offsets.back(), sets = offsets.size() - 1;
  seeds.offsets = places.offsets;
  seeds.frames.resize(sets);
  seeds.places.reserve(places.count);
  seeds.numbers.resize(places.count);
  std::iota(seeds.numbers.begin(), seeds.numbers.end(), 0);
  for (std::size_t s = 0; s < sets; ++s) {
    const std::size_t first = seeds.offsets[s], last = seeds.offsets[s + 1];
    if (first == last) continue;
    const geometry::Magnitudes own = geometry::inspect(places.coordinates, first, last);
    if (own.bad != kernel::NO_BAD) {
      const auto bad = static_cast<std::size_t>(own.bad);
      throw Error(ErrorKind::input,
                  fmt::format("{} {} is not finite: {}", places.name, bad, place_of(places, bad)));
    }
    const geometry::Magnitudes points =
        geometry::joined(geometry::inspect(coordinates, offsets[s], offsets[s + 1]),
                         geometry::inspect(coordinates, n + added_offsets[s], n + added_offsets[s + 1]));
    const geometry::Magnitudes both = geometry::joined(points, own);
    if (geometry::bits_of(both) > points::kOrientLimits.most_bits()) {
      throw_range(places, first, last, points);
    }
    const points::QueryScaling scaling = points::query_scaling(both, 0);
    seeds.frames[s] = scaling.frames[0];
    seeds.bound = std::max(seeds.bound, scaling.orient_bound);
    const auto numbers = seeds.numbers.begin();
    std::sort(numbers + static_cast<std::ptrdiff_t>(first), numbers + static_cast<std::ptrdiff_t>(last),
              [&](std::int32_t a, std::int32_t b) {
                const double x = places.coordinates[2 * static_cast<std::size_t>(a)],
                             other = places.coordinates[2 * static_cast<std::size_t>(b)];
                return x != other ? x < other : a < b;
              });
    for (std::size_t h = first; h < last; ++h) {
      const auto place = kernel::scaled_point(seeds.numbers[h], places.coordinates, seeds.frames[s].scale);
      seeds.places.push_back({{place.x, place.y}});
    }
  }
  return seeds;
}

// Finds the region of each triangle; returns the number of regions.
std::size_t join_regions(host::Runtime& runtime, const DomainMesh& mesh, std::size_t chunk,
                         const Buffer<cl_int>& regions) {
  const std::size_t triangles = mesh.triangle_count();
  const auto parents = runtime.arena().allocate<cl_int>(triangles);
  const auto numbers = runtime.arena().allocate<cl_uint>(triangles + 1);
  runtime.chunks(triangles, chunk,
                 kernels::start_regions{
                     .neighbors = mesh.neighbors, .constrained = mesh.constrained, .parents = parents});
  runtime.map(
      triangles,
      kernels::join_regions{
          .length = chunk, .neighbors = mesh.neighbors, .constrained = mesh.constrained, .parents = parents});
  runtime.map(triangles, kernels::find_roots{.parents = parents, .regions = regions, .counts = numbers});
  host::exclusive_scan(runtime, numbers, triangles, numbers);
  runtime.map(triangles, kernels::number_regions{.numbers = numbers, .regions = regions});
  return runtime.read_one(numbers, triangles);
}

// As join_regions, for triangles that are one chunk.
std::size_t visit_regions(host::Runtime& runtime, const DomainMesh& mesh, const Buffer<cl_int>& regions) {
  const std::size_t triangles = mesh.triangle_count();
  if (triangles == 0) return 0;
  const auto count = runtime.arena().allocate<cl_uint>(1);
  runtime.launch(1, 1, triangles,
                 kernels::visit_regions{.neighbors = mesh.neighbors,
                                        .constrained = mesh.constrained,
                                        .regions = regions,
                                        .visited = runtime.arena().allocate<cl_int>(triangles + 3),
                                        .count = count});
  return runtime.read_one(count, 0);
}

}  // namespace

Regions find_regions(host::Runtime& runtime, const DomainMesh& mesh) {
  const std::size_t triangles = mesh.triangle_count();
  Regions regions;
  regions.of_triangles = runtime.arena().allocate<cl_int>(triangles);
  {
    Arena::Scope scope(runtime.arena());
    const std::size_t chunk = runtime.sizes().chunk(triangles);
    regions.count = triangles <= chunk ? visit_regions(runtime, mesh, regions.of_triangles)
                                       : join_regions(runtime, mesh, chunk, regions.of_triangles);
  }
  regions.left = filled(runtime, regions.count, cl_uchar{1});
  return regions;
}

void find_depths(host::Runtime& runtime, const DomainMesh& mesh, const DepthRules& rules, Regions& regions) {
  regions.depths = runtime.arena().allocate<cl_int>(regions.count);
  Arena::Scope scope(runtime.arena());
  const Borders borders = find_borders(runtime, mesh, rules, regions);
  if (borders.count > 0) reach_all(runtime, rules.fill, borders, regions.count);
  runtime.map(regions.count, kernels::finish_regions{.rule = rules.fill,
                                                     .outside = rules.outside,
                                                     .levels = borders.levels,
                                                     .potentials = borders.potentials,
                                                     .depths = regions.depths,
                                                     .left = regions.left});
}

Places holes_of(const Constraints& constraints, std::size_t sets) {
  return checked_places("hole", constraints.holes, constraints.hole_count, constraints.hole_offsets, sets);
}

Places seeds_of(const Constraints& constraints, std::size_t sets) {
  return checked_places("seed", constraints.seeds, constraints.seed_count, constraints.seed_offsets, sets);
}

std::vector<std::int32_t> find_places(host::Runtime& runtime, const DomainMesh& mesh, const Places& places,
                                      const double* coordinates, const std::vector<std::size_t>& offsets,
                                      const std::vector<std::size_t>& added_offsets) {
  Seeds seeds = make_seeds(places, coordinates, offsets, added_offsets);
  const std::size_t count = places.count;
  std::vector<std::int32_t> triangles(count);
  if (count == 0) return triangles;
  Arena::Scope scope(runtime.arena());
  const auto found = filled(runtime, count, kNone);
  const auto barred = filled(runtime, count, cl_uchar{0});
  const auto offsets_of = [&](const std::vector<std::size_t>& begins) {
    return runtime.upload(runtime.arena(), points::integers(begins));
  };
  runtime.map(mesh.triangle_count(),
              kernels::find_seeds{.sets = mesh.triangle_offsets.size() - 1,
                                  .triangle_offsets = offsets_of(mesh.triangle_offsets),
                                  .seed_offsets = offsets_of(seeds.offsets),
                                  .frames = runtime.upload(runtime.arena(), seeds.frames),
                                  .bound = seeds.bound,
                                  .input = mesh.coordinates,
                                  .triangles = mesh.triangles,
                                  .constrained = mesh.constrained,
                                  .seeds = runtime.upload(runtime.arena(), std::move(seeds.places)),
                                  .found = found,
                                  .barred = barred});
  std::vector<cl_int> first(count);
  std::vector<std::uint8_t> on_constraint(count);
  const host::Runtime::Settled settled(runtime);
  runtime.read_later(found, 0, count, first.data());
  runtime.read_later(barred, 0, count, on_constraint.data());
  runtime.finish();
  for (std::size_t h = 0; h < count; ++h) {
    triangles[seeds.numbers[h]] = first[h] == kNone       ? kNowhere
                                  : on_constraint[h] != 0 ? kOnConstraint
                                                          : first[h];
  }
  return triangles;
}

void check_found(const Places& places, const std::vector<std::int32_t>& found) {
  const auto bad = std::find_if(found.begin(), found.end(), [](std::int32_t t) { return t < 0; });
  if (bad == found.end()) return;
  const auto place = static_cast<std::size_t>(bad - found.begin());
  throw Error(ErrorKind::input, fmt::format("{} {} at {} is {}", places.name, place, place_of(places, place),
                                            *bad == kOnConstraint ? "on a constraint" : "in no triangle"));
}

void drop_holes(host::Runtime& runtime, const std::vector<std::int32_t>& triangles, Regions& regions) {
  if (triangles.empty()) return;
  Arena::Scope scope(runtime.arena());
  runtime.map(triangles.size(), kernels::drop_holes{.found = runtime.upload(runtime.arena(), triangles),
                                                    .regions = regions.of_triangles,
                                                    .left = regions.left});
}

LeftPlaces place_left(host::Runtime& runtime, const DomainMesh& mesh, const Regions& regions) {
  const std::size_t triangles = mesh.triangle_count(), ends = mesh.triangle_offsets.size();
  LeftPlaces places;
  places.triangles = runtime.arena().allocate<cl_uint>(triangles + 1);
  places.numbers = runtime.arena().allocate<cl_uint>(regions.count + 1);
  Arena::Scope scope(runtime.arena());
  const auto offsets = runtime.arena().allocate<cl_uint>(ends);
  runtime.map(
      triangles,
      kernels::count_left{.regions = regions.of_triangles, .left = regions.left, .counts = places.triangles});
  host::exclusive_scan(runtime, places.triangles, triangles, places.triangles);
  runtime.map(regions.count, kernels::count_regions{.left = regions.left, .counts = places.numbers});
  host::exclusive_scan(runtime, places.numbers, regions.count, places.numbers);
  runtime.map(ends, kernels::find_offsets{.triangle_offsets = runtime.upload(
                                              runtime.arena(), points::integers(mesh.triangle_offsets)),
                                          .places = places.triangles,
                                          .offsets = offsets});
  std::vector<cl_uint> found(ends);
  cl_uint left = 0;
  const host::Runtime::Settled settled(runtime);
  runtime.read_later(offsets, 0, ends, found.data());
  runtime.read_later(places.numbers, regions.count, 1, &left);
  runtime.finish();
  places.triangle_offsets.assign(found.begin(), found.end());
  places.regions = left;
  return places;
}

void write_left(host::Runtime& runtime, const DomainMesh& mesh, const LeftPlaces& places,
                const LeftBuffers& left, Regions& regions) {
  runtime.map(mesh.triangle_count(),
              kernels::write_left{.triangulation = {.triangles = mesh.triangles, .neighbors = mesh.neighbors},
                                  .constrained = mesh.constrained,
                                  .regions = regions.of_triangles,
                                  .places = places.triangles,
                                  .numbers = places.numbers,
                                  .left_triangles = left.triangles,
                                  .left_neighbors = left.neighbors,
                                  .left_constrained = left.constrained,
                                  .left_regions = left.regions});
  for (Buffer<cl_int>* labels : {&regions.depths, &regions.polygons, &regions.seeds}) {
    if (labels->size() == 0) continue;
    const auto numbered = runtime.arena().allocate<cl_int>(places.regions);
    runtime.map(regions.count, kernels::number_labels{
                                   .numbers = places.numbers, .labels = *labels, .left_labels = numbered});
    *labels = numbered;
  }
  regions.of_triangles = left.regions;
}

void write_labels(host::Runtime& runtime, std::size_t n, const Buffer<cl_int>& regions,
                  const Buffer<cl_int>& labels, const Buffer<cl_int>& triangle_labels) {
  runtime.map(
      n, kernels::write_labels{.regions = regions, .labels = labels, .triangle_labels = triangle_labels});
}

}  // namespace flaunay::constrained
