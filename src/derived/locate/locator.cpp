#include "derived/locate/locator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "flaunay/flaunay.hpp"
#include "geometry/arguments.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/locate/fixed_point.cl.hpp"
#include "points/inspect.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::locate {
using namespace geometry;
using namespace points;

namespace {

// Smaller trees save no time.
constexpr int kLeastDepth = 4;

// Each leaf holds one sample.
constexpr std::size_t kSamplesPerLeaf = 1;

void check_sizes(const DeviceMesh& mesh) {
  for (std::size_t s = 0; s < mesh.sets(); ++s) {
    const std::size_t points = mesh.point_offsets[s + 1] - mesh.point_offsets[s];
    const std::size_t triangles = mesh.triangle_offsets[s + 1] - mesh.triangle_offsets[s];
    const std::size_t hull = mesh.hull_offsets[s + 1] - mesh.hull_offsets[s];
    if (triangles > 2 * points || hull > points) {
      throw Error(ErrorKind::input, fmt::format("{} points cannot have {} triangles and {} hull vertices",
                                                points, triangles, hull));
    }
  }
}

// The depth of a set's tree, 0 for no tree. The number of vertices, without duplicates, follows from Euler's
// formula.
int depth_for(std::size_t triangles, std::size_t hull, std::size_t vertices_per_leaf) {
  const std::size_t vertices = triangles == 0 ? 0 : (triangles + 2 + hull) / 2;
  int depth = 0;
  while (vertices >> (depth + 1) >= vertices_per_leaf) ++depth;
  return depth < kLeastDepth ? 0 : depth;
}

// Makes the records of sets, and lists the sets that have trees. A tree has as many nodes as leaves.
std::vector<kernel::mesh_set> make_records(const DeviceMesh& mesh, std::size_t vertices_per_leaf,
                                           std::vector<points::SetToCut>& cut) {
  std::vector<kernel::mesh_set> records;
  std::size_t leaves = 0;
  for (std::size_t s = 0; s < mesh.sets(); ++s) {
    const std::size_t triangle = mesh.triangle_offsets[s],
                      triangles = mesh.triangle_offsets[s + 1] - triangle;
    const std::size_t hull = mesh.hull_offsets[s], hull_end = mesh.hull_offsets[s + 1];
    const int depth = depth_for(triangles, hull_end - hull, vertices_per_leaf);
    const std::size_t start = depth == 0 ? triangle : leaves;
    records.push_back({static_cast<cl_int>(leaves), depth, static_cast<cl_int>(start),
                       static_cast<cl_int>(triangles), static_cast<cl_int>(hull),
                       static_cast<cl_int>(hull_end)});
    if (depth == 0) continue;
    const std::size_t first = mesh.point_offsets[s];
    cut.push_back({depth, first, mesh.point_offsets[s + 1] - first});
    leaves += std::size_t{1} << depth;
  }
  return records;
}

// Makes the trees, and finds per leaf a triangle at its sample.
// input: the points as queries go down the trees.
void make_trees(host::Runtime& runtime, Arena& own, const DeviceMesh& mesh, const Buffer<cl_double>& input,
                const std::vector<points::SetToCut>& cut, const Buffer<cl_int>& incident, Locator& locator) {
  Arena::Scope scope(runtime.arena());
  const points::CutTrees trees(runtime, cut, kSamplesPerLeaf);
  locator.nodes = own.allocate<kernel::cut_node>(trees.nodes());
  locator.starts = own.allocate<cl_int>(trees.samples());
  if (cut.empty()) return;
  const points::CutTrees::Samples samples = trees.draw(input);
  const auto by_leaf = trees.cut(samples.points, locator.nodes);
  runtime.map(trees.samples(), kernels::start_triangles{.points = mesh.points(),
                                                        .last = mesh.triangle_count() - 1,
                                                        .by_leaf = by_leaf,
                                                        .drawn = samples.indices,
                                                        .representatives = mesh.representatives,
                                                        .incident = incident,
                                                        .starts = locator.starts});
}

// The first wrong index of each kind, or kNone. Kernels set these.
struct Faults {
  static constexpr cl_int kNone = std::numeric_limits<cl_int>::max();
  cl_int triangle = kNone, hull = kNone, representative = kNone;
};

void throw_faults(const Faults& faults) {
  const auto check = [](cl_int place, const char* what) {
    if (place == Faults::kNone) return;
    throw Error(
        ErrorKind::input,
        fmt::format("{} {} is not that of a triangulation of these points with its neighbours", what, place));
  };
  check(faults.triangle, "triangle");
  check(faults.hull, "hull vertex");
  check(faults.representative, "representative");
}

// The offsets of sets on the device.
struct Offsets {
  Buffer<cl_int> points, triangles, hull;
};

// Computes the faces, and the vertices in the order of their first triangles. incident: a triangle per point,
// for `starts`.
void fill_faces(host::Runtime& runtime, const DeviceMesh& mesh, const UniformPoints& input,
                const Offsets& offsets, const Buffer<cl_int>& faults, const Buffer<cl_int>& incident,
                Locator& locator) {
  const std::size_t n = mesh.points(), triangles = mesh.triangle_count();
  Arena::Scope scope(runtime.arena());
  const auto counts = runtime.arena().allocate<cl_uint>(triangles + 1);
  const auto numbers = runtime.arena().allocate<cl_int>(n);
  runtime.fill(incident, n, std::numeric_limits<cl_int>::max());
  runtime.fill(numbers, n, cl_int{0});
  runtime.map(triangles, kernels::make_faces{.sets = mesh.sets(),
                                             .triangle_offsets = offsets.triangles,
                                             .point_offsets = offsets.points,
                                             .triangles = mesh.triangles,
                                             .neighbors = mesh.neighbors,
                                             .faces = locator.faces,
                                             .incident = incident,
                                             .bad = faults});
  runtime.map(triangles,
              kernels::count_vertices{.faces = locator.faces, .incident = incident, .counts = counts});
  host::exclusive_scan(runtime, counts, triangles, counts);
  runtime.map(triangles, kernels::number_vertices{.faces = locator.faces,
                                                  .incident = incident,
                                                  .firsts = counts,
                                                  .input = input.coordinates,
                                                  .scale = input.scaling.powers(),
                                                  .numbers = numbers,
                                                  .points = locator.points,
                                                  .source = locator.source,
                                                  .first_triangle = locator.first_triangle});
  runtime.map(mesh.sets() + 1, kernels::find_first_vertices{.triangle_offsets = offsets.triangles,
                                                            .firsts = counts,
                                                            .first_vertices = locator.first_vertices});
  runtime.map(triangles, kernels::renumber_faces{.numbers = numbers, .faces = locator.faces});
}

void fill_hull(host::Runtime& runtime, const DeviceMesh& mesh, const UniformPoints& input,
               const Offsets& offsets, const Buffer<cl_int>& faults, Locator& locator) {
  runtime.map(mesh.hull_offsets.back(), kernels::place_hull{.sets = mesh.sets(),
                                                            .offsets = offsets.hull,
                                                            .point_offsets = offsets.points,
                                                            .hull = mesh.hull,
                                                            .input = input.coordinates,
                                                            .scale = input.scaling.powers(),
                                                            .points = locator.hull_points,
                                                            .source = locator.hull,
                                                            .bad = faults});
}

// Arguments that all kernels on one call's queries share. Without trees, the first kernel places the queries.
struct Pass : LocatedQueries {
  float nearness_bound;
  bool is_off_grid;       // whether some queries are not on the grid: see QueryScaling
  Magnitudes both;        // of points and of queries, if some are off the grid
  bool are_placed;        // whether `placed` is filled
  Buffer<cl_ulong> keys;  // the leaves of placed queries
};

kernels::searched_mesh searched_mesh(const Locator& locator, const Stars& stars) {
  return {.records = locator.records,
          .points = locator.points,
          .source = locator.source,
          .clearances = locator.clearances,
          .faces = locator.faces,
          .hull_points = locator.hull_points,
          .hull = locator.hull,
          .starts = stars.starts,
          .fans = stars.fans};
}

// How far queries walk in large sets before they give up.
struct WalkLimits {
  std::size_t long_from, most;  // the least number of triangles of a large set; the most steps
};
constexpr WalkLimits kNoLimits{std::numeric_limits<cl_int>::max(), 0};

// Sorts queries by leaves, so that queries near each other in the plane are near each other in memory.
void sort_queries(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries,
                  std::size_t m, Pass& pass) {
  pass.keys = runtime.arena().allocate<cl_ulong>(m);
  pass.order = runtime.arena().allocate<cl_int>(m);
  runtime.chunks(m, runtime.sizes().chunk(m),
                 kernels::find_query_leaves{.sets = pass.sets,
                                            .query_offsets = pass.query_offsets,
                                            .records = locator.records,
                                            .frames = pass.frames,
                                            .nodes = locator.nodes,
                                            .queries = queries,
                                            .keys = pass.keys,
                                            .order = pass.order});
  host::sort_by_key(runtime, pass.keys, pass.order, m);
  pass.placed = runtime.arena().allocate<cl_double2>(m);
  runtime.map(m, kernels::place_queries{.sets = pass.sets,
                                        .query_offsets = pass.query_offsets,
                                        .frames = pass.frames,
                                        .order = pass.order,
                                        .queries = queries,
                                        .placed = pass.placed});
}

Fitted<Pass> prepare(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries,
                     std::size_t m, const std::vector<std::size_t>& query_offsets,
                     const QueryLimits& limits = kOrientLimits) {
  check_offsets(query_offsets);
  if (query_offsets.size() != locator.sets + 1 || query_offsets.back() != m) {
    throw Error(
        ErrorKind::usage,
        fmt::format("offsets of queries are of {} sets and end with {}; there are {} queries of {} sets",
                    query_offsets.size() - 1, query_offsets.back(), m, locator.sets));
  }
  Pass pass{};
  Fitted<QueryScaling> fitted = query_scaling(runtime, locator.range, queries, query_offsets, limits);
  if (!fitted) return fitted.too_wide();
  QueryScaling scaling = *std::move(fitted);
  pass.orient_bound = scaling.orient_bound;
  pass.nearness_bound = scaling.nearness_bound;
  pass.is_off_grid = scaling.is_off_grid;
  pass.both = scaling.both;
  pass.frames = runtime.upload(runtime.arena(), std::move(scaling.frames));
  pass.sets = static_cast<cl_int>(locator.sets);
  pass.query_offsets = runtime.arena().allocate<cl_int>(locator.sets + 1);
  if (locator.sets > 1) {
    runtime.write_kept(pass.query_offsets, integers(query_offsets));
  }
  const bool has_trees = locator.starts.size() > 0;
  pass.are_placed = has_trees && m >= tuning_of(runtime).sorted_queries_least;
  if (pass.are_placed) {
    sort_queries(runtime, locator, queries, m, pass);
  } else {
    pass.keys = runtime.arena().allocate<cl_ulong>(0);
    pass.order = runtime.arena().allocate<cl_int>(m);
    pass.placed = runtime.arena().allocate<cl_double2>(m);
  }
  return pass;
}

// Finds the triangle of each query. is_answer: see the kernel find_triangles.
void find_triangles(host::Runtime& runtime, const Locator& locator, const Pass& pass, bool is_answer,
                    WalkLimits limits, const Buffer<cl_double>& queries, std::size_t m,
                    const Buffer<cl_int>& found) {
  runtime.chunks(
      m, runtime.sizes().chunk(m),
      kernels::find_triangles{
          .sets = pass.sets,
          .options = kernel::walk_options{pass.are_placed, is_answer, static_cast<cl_int>(limits.long_from),
                                          static_cast<cl_int>(limits.most)},
          .query_offsets = pass.query_offsets,
          .query_trees = {.records = locator.records, .nodes = locator.nodes, .starts = locator.starts},
          .frames = pass.frames,
          .queries = queries,
          .keys = pass.keys,
          .order = pass.order,
          .placed = pass.placed,
          .bound = pass.orient_bound,
          .walked_mesh = locator,
          .found = found});
}

// Finds the triangle of each query in a mesh with constraints. found: by place. answers: by query, if there
// are some.
void find_in_constrained(host::Runtime& runtime, const Locator& locator, const Pass& pass,
                         const Buffer<cl_double>& queries, std::size_t m, const Buffer<cl_int>& found,
                         const Buffer<cl_int>* answers) {
  // Visibility walks may circle; straight ones take longer per step.
  const WalkLimits limits{0, tuning_of(runtime).walk_most};
  find_triangles(runtime, locator, pass, false, limits, queries, m, found);
  runtime.map(
      m, kernels::find_in_constrained{
             .placed_queries = pass,
             .kept = locator.kept,
             .is_answer = answers != nullptr,
             .query_trees = {.records = locator.records, .nodes = locator.nodes, .starts = locator.starts},
             .queries = queries,
             .bound = pass.orient_bound,
             .walked_mesh = locator,
             .found = found,
             .answers = answers != nullptr ? *answers : found});
}

// Walks from triangles of the grid, by place in `found`, to those of queries off the grid. answers: by query.
void locate_off_grid(host::Runtime& runtime, const Locator& locator, const Pass& pass,
                     const Buffer<cl_double>& queries, std::size_t m, const Buffer<cl_int>& found,
                     const Buffer<cl_int>& answers) {
  runtime.map(m, kernels::locate_off_grid{.placed_queries = pass,
                                          .records = locator.records,
                                          .queries = queries,
                                          .walked_mesh = locator,
                                          .found = found,
                                          .answers = answers});
}

// Goes on from vertices to those nearest to queries off the grid, and makes points of all. Waits once. A
// query to which it is far to go does not fit.
Fitted<Done> nearest_off_grid(host::Runtime& runtime, const Locator& locator, const Pass& pass,
                              const Buffer<cl_double>& queries, std::size_t m, const Buffer<cl_int>& points) {
  const auto unanswered = runtime.arena().allocate<cl_int>(1);
  runtime.fill(unanswered, 1, cl_int{0});
  runtime.map(m, kernels::nearest_off_grid{.placed_queries = pass,
                                           .most = tuning_of(runtime).off_grid_most,
                                           .records = locator.records,
                                           .queries = queries,
                                           .points = locator.points,
                                           .source = locator.source,
                                           .clearances = locator.clearances,
                                           .faces = locator.faces,
                                           .first_triangle = locator.first_triangle,
                                           .hull_points = locator.hull_points,
                                           .hull = locator.hull,
                                           .nearest = points,
                                           .unanswered = unanswered});
  if (m > 0 && runtime.read_one(unanswered, 0) != 0) return TooWide{pass.both};
  return Done();
}

// input: the points of the mesh. vertices_per_leaf: of the trees.
Locator make_locator(host::Runtime& runtime, Arena& own, const DeviceMesh& mesh, const UniformPoints& input,
                     std::size_t vertices_per_leaf) {
  Arena& scratch = runtime.arena();
  const std::size_t n = mesh.points(), triangles = mesh.triangle_count();
  check_sizes(mesh);
  Locator locator;
  locator.sets = mesh.sets();
  locator.point_offsets = mesh.point_offsets;
  locator.points = own.allocate<cl_double2>(n);
  locator.source = own.allocate<cl_int>(n);
  locator.first_triangle = own.allocate<cl_int>(n);
  locator.clearances = own.allocate<cl_int>(n);
  locator.faces = own.allocate<kernel::face>(triangles);
  locator.hull_points = own.allocate<cl_double2>(mesh.hull_offsets.back());
  locator.hull = own.allocate<cl_int>(mesh.hull_offsets.back());
  locator.first_vertices = own.allocate<cl_int>(mesh.sets() + 1);
  for (std::size_t s = 0; s < mesh.sets(); ++s) {
    locator.most_triangles =
        std::max(locator.most_triangles, mesh.triangle_offsets[s + 1] - mesh.triangle_offsets[s]);
  }

  Faults faults;
  const host::Runtime::Settled settled(runtime);
  const auto device_faults = scratch.allocate<cl_int>(3);
  runtime.write_later(device_faults, 0, 3, &faults.triangle);
  const auto incident = scratch.allocate<cl_int>(n);
  const Offsets offsets{runtime.upload(scratch, integers(mesh.point_offsets)),
                        runtime.upload(scratch, integers(mesh.triangle_offsets)),
                        runtime.upload(scratch, integers(mesh.hull_offsets))};
  fill_faces(runtime, mesh, input, offsets, device_faults, incident, locator);
  fill_hull(runtime, mesh, input, offsets, device_faults, locator);
  runtime.map(n, kernels::check_representatives{.sets = mesh.sets(),
                                                .point_offsets = offsets.points,
                                                .representatives = mesh.representatives,
                                                .bad = device_faults});
  std::vector<points::SetToCut> cut;
  locator.records = runtime.upload(own, make_records(mesh, vertices_per_leaf, cut));
  const bool is_fixed = runtime.capabilities().fixed_point;
  make_trees(runtime, own, mesh, is_fixed ? input.coordinates : mesh.coordinates, cut, incident, locator);
  runtime.read(device_faults, 0, 3, &faults.triangle);
  throw_faults(faults);
  return locator;
}

// Finds the nearest points by walks from the triangles and by the levels, if there are any; otherwise
// unanswered[0] says whether levels are needed.
void nearest_points(host::Runtime& runtime, const Locator& locator, const Pass& pass, WalkLimits limits,
                    std::size_t m, const Buffer<cl_int>& found, const Buffer<cl_int>& points,
                    const Buffer<cl_int>& unanswered) {
  const Levels& levels = locator.levels;
  const Locator none;
  const Locator& samples = locator.samples ? *locator.samples : none;
  runtime.map(m, kernels::nearest_points{.placed_queries = pass,
                                         .long_from = limits.long_from,
                                         .most_neighbors = limits.most,
                                         .are_vertices = pass.is_off_grid,
                                         .levels = {.levels = levels.count,
                                                    .sets_with_levels = levels.sets,
                                                    .first_vertices = locator.first_vertices,
                                                    .boxes = levels.boxes,
                                                    .long_sets = levels.long_sets,
                                                    .below = levels.below},
                                         .searched_mesh = searched_mesh(locator, levels.stars),
                                         .bound = pass.nearness_bound,
                                         .sample = searched_mesh(samples, levels.sample_stars),
                                         .found = found,
                                         .nearest = points,
                                         .unanswered = unanswered});
}

}  // namespace

Fitted<Locator> make_locator(host::Runtime& runtime, Arena& own, const DeviceMesh& mesh,
                             Triangulate triangulate) {
  Arena::Scope scope(runtime.arena());
  const Fitted<UniformPoints> input = make_uniform(runtime, mesh.coordinates, mesh.point_offsets);
  if (!input) return input.too_wide();
  Locator locator = make_locator(runtime, own, mesh, *input, tuning_of(runtime).vertices_per_leaf);
  locator.triangulate = triangulate;
  locator.kept = mesh.triangle_count();
  locator.range = {input->by_set, input->shifts};
  if (input->by_set.empty()) {
    locator.range.by_set = inspect_sets(runtime, mesh.coordinates, mesh.point_offsets);
  }
  return locator;
}

void constrain(host::Runtime& runtime, Arena& own, const std::vector<cl_uchar>& constrained,
               Locator& locator) {
  Arena::Scope scope(runtime.arena());
  locator.is_constrained = true;
  locator.kept = constrained.size() / 3;
  locator.visible = own.allocate<kernel::face>(locator.kept);
  runtime.map(locator.kept, kernels::cut_faces{.constrained = runtime.upload(runtime.arena(), constrained),
                                               .faces = locator.faces,
                                               .visible = locator.visible});
  runtime.finish();
}

Locator make_walk_locator(host::Runtime& runtime, Arena& own, const DeviceMesh& mesh) {
  Arena::Scope scope(runtime.arena());
  const UniformPoints input{mesh.coordinates, {}, {}, {}};
  return make_locator(runtime, own, mesh, input, std::numeric_limits<std::size_t>::max());
}

void measure_clearances(host::Runtime& runtime, Locator& locator) {
  runtime.fill(locator.clearances, locator.points.size(), std::numeric_limits<cl_int>::max());
  runtime.map(locator.faces.size(),
              kernels::measure_clearances{
                  .faces = locator.faces, .points = locator.points, .clearances = locator.clearances});
  locator.has_clearances = true;
}

Fitted<Done> locate(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries,
                    std::size_t m, const std::vector<std::size_t>& query_offsets,
                    const Buffer<cl_int>& triangles) {
  Arena::Scope scope(runtime.arena());
  const Fitted<Pass> pass = prepare(runtime, locator, queries, m, query_offsets);
  if (!pass) return pass.too_wide();
  if (locator.is_constrained) {
    if (pass->is_off_grid) return TooWide{pass->both};
    find_in_constrained(runtime, locator, *pass, queries, m, runtime.arena().allocate<cl_int>(m), &triangles);
    return Done();
  }
  if (!pass->is_off_grid) {
    find_triangles(runtime, locator, *pass, true, kNoLimits, queries, m, triangles);
    return Done();
  }
  const auto found = runtime.arena().allocate<cl_int>(m);
  find_triangles(runtime, locator, *pass, false, kNoLimits, queries, m, found);
  locate_off_grid(runtime, locator, *pass, queries, m, found, triangles);
  return Done();
}

Fitted<Done> nearest(host::Runtime& runtime, Locator& locator, const Buffer<cl_double>& queries,
                     std::size_t m, const std::vector<std::size_t>& query_offsets,
                     const Buffer<cl_int>& points) {
  Arena::Scope scope(runtime.arena());
  const Fitted<Pass> pass = prepare(runtime, locator, queries, m, query_offsets);
  if (!pass) return pass.too_wide();
  const Tuning& tuning = tuning_of(runtime);
  if (pass->is_off_grid && tuning.off_grid_most == 0) return TooWide{pass->both};
  const auto found = runtime.arena().allocate<cl_int>(m), unanswered = runtime.arena().allocate<cl_int>(1);
  const WalkLimits limits{tuning.levels_from, tuning.walk_most};
  if (!locator.has_clearances) {
    measure_clearances(runtime, locator);
    // A later call may use another queue.
    runtime.finish();
  }
  find_triangles(runtime, locator, *pass, false, limits, queries, m, found);
  runtime.fill(unanswered, 1, cl_int{0});
  nearest_points(runtime, locator, *pass, limits, m, found, points, unanswered);
  if (m > 0 && locator.most_triangles >= limits.long_from && locator.levels.count == 0 &&
      runtime.read_one(unanswered, 0) != 0) {
    make_levels(runtime, locator);
    nearest_points(runtime, locator, *pass, limits, m, found, points, unanswered);
  }
  return pass->is_off_grid ? nearest_off_grid(runtime, locator, *pass, queries, m, points) : Done();
}

LocatedQueries locate_by_place(host::Runtime& runtime, const Locator& locator,
                               const Buffer<cl_double>& queries, std::size_t m,
                               const std::vector<std::size_t>& query_offsets, const QueryLimits& limits) {
  Pass pass = *prepare(runtime, locator, queries, m, query_offsets, limits);
  pass.found = runtime.arena().allocate<cl_int>(m);
  if (locator.is_constrained) {
    find_in_constrained(runtime, locator, pass, queries, m, pass.found, nullptr);
  } else {
    find_triangles(runtime, locator, pass, false, kNoLimits, queries, m, pass.found);
  }
  return pass;
}

}  // namespace flaunay::locate
