#include "derived/locator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "flaunay/flaunay.hpp"
#include "host/vector_operations.hpp"
#include "input/inspect.hpp"

namespace flaunay::derived {
namespace {

// Vertices of a leaf, at least: a walk from the sample in it takes a few steps.
constexpr std::size_t kVerticesPerLeaf = 16;
// Smaller trees save nothing.
constexpr int kLeastDepth = 4;

// One sample is a leaf.
constexpr std::size_t kSamplesPerLeaf = 1;

std::vector<cl_int> integers(const std::vector<std::size_t>& offsets) {
  return {offsets.begin(), offsets.end()};
}

void check_sizes(const Mesh& mesh) {
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

// By Euler's formula, of a set's triangles and hull; duplicates do not count. 0: no tree.
int depth_for(std::size_t triangles, std::size_t hull) {
  const std::size_t vertices = triangles == 0 ? 0 : (triangles + 2 + hull) / 2;
  int depth = 0;
  while (vertices >> (depth + 1) >= kVerticesPerLeaf) ++depth;
  return depth < kLeastDepth ? 0 : depth;
}

// The sets' records, and those sets that have trees; a tree has as many nodes as leaves.
std::vector<MeshSet> make_records(const Mesh& mesh, std::vector<hybrid::SetToCut>& cut) {
  std::vector<MeshSet> records;
  std::size_t leaves = 0;
  for (std::size_t s = 0; s < mesh.sets(); ++s) {
    const std::size_t triangle = mesh.triangle_offsets[s],
                      triangles = mesh.triangle_offsets[s + 1] - triangle;
    const std::size_t hull = mesh.hull_offsets[s], hull_end = mesh.hull_offsets[s + 1];
    const int depth = depth_for(triangles, hull_end - hull);
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

// Trees of the points, and for each leaf a triangle at the sample in it.
void make_trees(host::Runtime& runtime, Arena& own, const Mesh& mesh,
                const std::vector<hybrid::SetToCut>& cut, const Buffer<cl_int>& incident, Locator& locator) {
  Arena::Scope scope(runtime.arena());
  const hybrid::CutTrees trees(runtime, cut, kSamplesPerLeaf);
  locator.nodes = own.allocate<hybrid::CutNode>(trees.nodes());
  locator.starts = own.allocate<cl_int>(trees.samples());
  if (cut.empty()) return;
  const hybrid::CutTrees::Samples samples = trees.draw(mesh.coordinates);
  const auto by_leaf = trees.cut(samples.points, locator.nodes);
  runtime.map("locate", "start_triangles", trees.samples(), static_cast<cl_int>(mesh.points()),
              static_cast<cl_int>(mesh.triangle_count() - 1), by_leaf, samples.indices, mesh.representatives,
              incident, locator.starts);
}

// What is wrong with the indices: the first place of each kind, or none.
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

// Offsets as kernels read them.
struct Offsets {
  Buffer<cl_int> points, triangles, hull;
};

// Triangles, and their vertices in their order. incident: by point, for starts.
void fill_faces(host::Runtime& runtime, const Mesh& mesh, const std::array<double, 3>& powers,
                const Offsets& offsets, const Buffer<cl_int>& faults, const Buffer<cl_int>& incident,
                Locator& locator) {
  const std::size_t n = mesh.points(), triangles = mesh.triangle_count();
  Arena::Scope scope(runtime.arena());
  const auto counts = runtime.arena().allocate<cl_uint>(triangles + 1);
  const auto numbers = runtime.arena().allocate<cl_int>(n);
  runtime.fill(incident, n, std::numeric_limits<cl_int>::max());
  runtime.fill(numbers, n, cl_int{0});
  runtime.map("locate", "make_faces", triangles, static_cast<cl_int>(mesh.sets()), offsets.triangles,
              offsets.points, mesh.triangles, mesh.neighbors, locator.faces, incident, faults);
  runtime.map("locate", "count_vertices", triangles, locator.faces, incident, counts);
  host::exclusive_scan(runtime, counts, triangles, counts);
  runtime.map("locate", "number_vertices", triangles, locator.faces, incident, counts, mesh.coordinates,
              powers[0], powers[1], powers[2], numbers, locator.points, locator.source,
              locator.first_triangle);
  runtime.map("locate", "renumber_faces", triangles, numbers, locator.faces);
  runtime.fill(locator.clearances, n, std::numeric_limits<cl_int>::max());
  runtime.map("locate", "measure_clearances", triangles, locator.faces, locator.points, locator.clearances);
}

void fill_hull(host::Runtime& runtime, const Mesh& mesh, const std::array<double, 3>& powers,
               const Offsets& offsets, const Buffer<cl_int>& faults, Locator& locator) {
  runtime.map("locate", "place_hull", mesh.hull_offsets.back(), static_cast<cl_int>(mesh.sets()),
              offsets.hull, offsets.points, mesh.hull, mesh.coordinates, powers[0], powers[1], powers[2],
              locator.hull_points, locator.hull, faults);
}

// What passes over queries need beside their own arrays.
struct Pass {
  QueryScaling scaling;
  std::array<double, 3> powers;
  cl_int sets;
  Buffer<cl_int> query_offsets;  // not read of one set
  bool are_placed;               // by now; else the first pass does it
  Buffer<cl_ulong> keys;         // the leaves of placed queries
  Buffer<cl_int> order;          // the query at a place
  Buffer<cl_double2> placed;     // scaled
};

// By leaves, which are near each other in memory as in the plane.
void sort_queries(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries,
                  std::size_t m, Pass& pass) {
  pass.keys = runtime.arena().allocate<cl_ulong>(m);
  pass.order = runtime.arena().allocate<cl_int>(m);
  runtime.chunks("locate", "find_query_leaves", m, runtime.tuning().chunk(m), pass.sets, pass.query_offsets,
                 locator.records, locator.nodes, queries, pass.keys, pass.order);
  host::sort_by_key(runtime, pass.keys, pass.order, m);
  pass.placed = runtime.arena().allocate<cl_double2>(m);
  runtime.map("locate", "place_queries", m, pass.order, queries, pass.powers[0], pass.powers[1],
              pass.powers[2], pass.placed);
}

Pass prepare(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries, std::size_t m,
             const std::vector<std::size_t>& query_offsets) {
  check_offsets(query_offsets);
  if (query_offsets.size() != locator.sets + 1 || query_offsets.back() != m) {
    throw Error(
        ErrorKind::usage,
        fmt::format("offsets of queries are of {} sets and end with {}; there are {} queries of {} sets",
                    query_offsets.size() - 1, query_offsets.back(), m, locator.sets));
  }
  Pass pass{};
  pass.scaling = query_scaling(runtime, locator.magnitudes, locator.shift, queries, m);
  pass.powers = pass.scaling.powers();
  pass.sets = static_cast<cl_int>(locator.sets);
  pass.query_offsets = runtime.arena().allocate<cl_int>(locator.sets + 1);
  if (locator.sets > 1) {
    runtime.write_kept(pass.query_offsets, integers(query_offsets));
  }
  const bool has_trees = locator.starts.size() > 0;
  pass.are_placed = has_trees && m >= runtime.tuning().sorted_queries_least;
  if (pass.are_placed) {
    sort_queries(runtime, locator, queries, m, pass);
  } else {
    pass.keys = runtime.arena().allocate<cl_ulong>(0);
    pass.order = runtime.arena().allocate<cl_int>(m);
    pass.placed = runtime.arena().allocate<cl_double2>(m);
  }
  return pass;
}

// is_answer: see the kernel.
void find_triangles(host::Runtime& runtime, const Locator& locator, const Pass& pass, bool is_answer,
                    const Buffer<cl_double>& queries, std::size_t m, const Buffer<cl_int>& found) {
  runtime.chunks("locate", "find_triangles", m, runtime.tuning().chunk(m), pass.sets, cl_int{pass.are_placed},
                 cl_int{is_answer}, pass.query_offsets, locator.records, locator.nodes, locator.starts,
                 queries, pass.powers[0], pass.powers[1], pass.powers[2], pass.keys, pass.order, pass.placed,
                 pass.scaling.orient_bound, pass.scaling.unit, locator.points, locator.faces,
                 locator.first_triangle, found);
}

}  // namespace

Locator make_locator(host::Runtime& runtime, Arena& own, const Mesh& mesh) {
  Arena& scratch = runtime.arena();
  Arena::Scope scope(scratch);
  const std::size_t n = mesh.points(), triangles = mesh.triangle_count();
  check_sizes(mesh);
  Locator locator;
  locator.sets = mesh.sets();
  locator.magnitudes = inspect(runtime, mesh.coordinates, n);
  const Scaling scaling = scaling_for(runtime, mesh.coordinates, n, locator.magnitudes);
  locator.shift = scaling.shift;
  locator.points = own.allocate<cl_double2>(n);
  locator.source = own.allocate<cl_int>(n);
  locator.first_triangle = own.allocate<cl_int>(n);
  locator.clearances = own.allocate<cl_int>(n);
  locator.faces = own.allocate<Face>(triangles);
  locator.hull_points = own.allocate<cl_double2>(mesh.hull_offsets.back());
  locator.hull = own.allocate<cl_int>(mesh.hull_offsets.back());

  Faults faults;
  const host::Runtime::Settled settled(runtime);
  const auto device_faults = scratch.allocate<cl_int>(3);
  runtime.write_later(device_faults, 0, 3, &faults.triangle);
  const auto incident = scratch.allocate<cl_int>(n);
  const Offsets offsets{runtime.upload(scratch, integers(mesh.point_offsets)),
                        runtime.upload(scratch, integers(mesh.triangle_offsets)),
                        runtime.upload(scratch, integers(mesh.hull_offsets))};
  fill_faces(runtime, mesh, scaling.powers(), offsets, device_faults, incident, locator);
  fill_hull(runtime, mesh, scaling.powers(), offsets, device_faults, locator);
  runtime.map("locate", "check_representatives", n, static_cast<cl_int>(mesh.sets()), offsets.points,
              mesh.representatives, device_faults);
  std::vector<hybrid::SetToCut> cut;
  locator.records = runtime.upload(own, make_records(mesh, cut));
  make_trees(runtime, own, mesh, cut, incident, locator);
  runtime.read(device_faults, 0, 3, &faults.triangle);
  throw_faults(faults);
  return locator;
}

void locate(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries, std::size_t m,
            const std::vector<std::size_t>& query_offsets, const Buffer<cl_int>& triangles) {
  Arena::Scope scope(runtime.arena());
  const Pass pass = prepare(runtime, locator, queries, m, query_offsets);
  find_triangles(runtime, locator, pass, true, queries, m, triangles);
}

void nearest(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries, std::size_t m,
             const std::vector<std::size_t>& query_offsets, const Buffer<cl_int>& points) {
  Arena::Scope scope(runtime.arena());
  const Pass pass = prepare(runtime, locator, queries, m, query_offsets);
  const auto found = runtime.arena().allocate<cl_int>(m);
  find_triangles(runtime, locator, pass, false, queries, m, found);
  runtime.map("locate", "nearest_points", m, pass.sets, pass.query_offsets, locator.records, pass.order,
              pass.placed, pass.scaling.nearness_bound, pass.scaling.unit, locator.points, locator.source,
              locator.clearances, locator.faces, locator.hull_points, locator.hull, found, points);
}

void interpolate(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& values,
                 const Buffer<cl_double>& queries, std::size_t m,
                 const std::vector<std::size_t>& query_offsets, const Buffer<cl_double>& results) {
  Arena::Scope scope(runtime.arena());
  const Pass pass = prepare(runtime, locator, queries, m, query_offsets);
  const auto found = runtime.arena().allocate<cl_int>(m);
  find_triangles(runtime, locator, pass, false, queries, m, found);
  runtime.map("locate", "interpolate_queries", m, pass.order, pass.placed, pass.scaling.orient_bound,
              pass.scaling.unit, locator.points, locator.source, locator.faces, found, values, results);
}

}  // namespace flaunay::derived
