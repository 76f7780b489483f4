#include "derived/locator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "flaunay/flaunay.hpp"
#include "host/vector_operations.hpp"

namespace flaunay::derived {
namespace {

// Vertices of a leaf, at least: a walk from the sample in it takes a few steps.
constexpr std::size_t kVerticesPerLeaf = 16;
// Smaller trees save nothing.
constexpr int kLeastDepth = 4;

// What the host decides: of each set the tree, and where walks begin, as start_triangles reads it.
struct Plan {
  std::vector<MeshSet> records;
  std::vector<hybrid::CutNode> nodes;
  std::vector<cl_int> starts;
};

std::vector<cl_int> integers(const std::vector<std::size_t>& offsets) {
  return {offsets.begin(), offsets.end()};
}

// The values must stay until the next wait.
template <typename T>
Buffer<T> upload(host::Runtime& runtime, Arena& arena, const std::vector<T>& values) {
  const auto buffer = arena.allocate<T>(values.size());
  runtime.write_later(buffer, 0, values.size(), values.data());
  return buffer;
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

std::vector<int> tree_depths(const Mesh& mesh) {
  std::vector<int> depths;
  for (std::size_t s = 0; s < mesh.sets(); ++s) {
    depths.push_back(depth_for(mesh.triangle_offsets[s + 1] - mesh.triangle_offsets[s],
                               mesh.hull_offsets[s + 1] - mesh.hull_offsets[s]));
  }
  return depths;
}

// A sample for each leaf of each tree, set by set.
std::vector<hybrid::NumberedSample> take_samples(host::Runtime& runtime, const Mesh& mesh,
                                                 const std::vector<int>& depths) {
  std::vector<cl_int> indices;
  for (std::size_t s = 0; s < depths.size(); ++s) {
    if (depths[s] == 0) continue;
    const std::size_t first = mesh.point_offsets[s], size = mesh.point_offsets[s + 1] - first;
    for (const cl_int i : hybrid::spread_indices(size, std::size_t{1} << depths[s])) {
      indices.push_back(static_cast<cl_int>(first) + i);
    }
  }
  std::vector<cl_double2> at(indices.size());
  Arena::Scope scope(runtime.arena());
  const auto device_indices = runtime.arena().allocate<cl_int>(indices.size());
  const auto device_samples = runtime.arena().allocate<cl_double2>(indices.size());
  runtime.write(device_indices, 0, indices.size(), indices.data());
  runtime.map("blocks", "gather_samples", indices.size(), device_indices, mesh.coordinates, device_samples);
  runtime.read(device_samples, 0, at.size(), at.data());
  std::vector<hybrid::NumberedSample> samples(indices.size());
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = {at[k], indices[k]};
  return samples;
}

Plan make_plan(host::Runtime& runtime, const Mesh& mesh) {
  Plan plan;
  const std::vector<int> depths = tree_depths(mesh);
  const std::vector<hybrid::NumberedSample> all = take_samples(runtime, mesh, depths);
  auto first = all.begin();
  for (std::size_t s = 0; s < mesh.sets(); ++s) {
    const std::size_t triangle = mesh.triangle_offsets[s], end = mesh.triangle_offsets[s + 1];
    plan.records.push_back({static_cast<cl_int>(plan.nodes.size()), depths[s],
                            static_cast<cl_int>(plan.starts.size()), static_cast<cl_int>(end - triangle),
                            static_cast<cl_int>(mesh.hull_offsets[s]),
                            static_cast<cl_int>(mesh.hull_offsets[s + 1])});
    if (depths[s] == 0) {
      plan.starts.push_back(~static_cast<cl_int>(triangle == end ? 0 : triangle));
      continue;
    }
    std::vector<hybrid::NumberedSample> samples(first, first + (std::ptrdiff_t{1} << depths[s]));
    first += static_cast<std::ptrdiff_t>(samples.size());
    const hybrid::CutTree tree = hybrid::cut_tree(samples, depths[s]);
    plan.nodes.insert(plan.nodes.end(), tree.nodes.begin(), tree.nodes.end());
    for (const hybrid::NumberedSample& sample : samples) plan.starts.push_back(sample.number);
  }
  return plan;
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

// For points that could not be triangulated the same error as there.
Scaling scaling_of(host::Runtime& runtime, const Mesh& mesh, const Magnitudes& magnitudes) {
  std::vector<double> coordinates;
  const std::size_t n = mesh.points();
  constexpr int kMostBits = 505;
  if (static_cast<std::size_t>(magnitudes.bad) < n || magnitudes.largest - magnitudes.lowest >= kMostBits) {
    coordinates.resize(2 * n);
    runtime.read(mesh.coordinates, 0, coordinates.size(), coordinates.data());
  }
  return scaling_for(coordinates.data(), n, magnitudes);
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

// What a pass over queries needs beside its own arrays.
struct Pass {
  QueryScaling scaling;
  std::array<double, 3> powers;
  cl_int sets;
  Buffer<cl_int> query_offsets;  // not read of one set
};

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
    const std::vector<cl_int> offsets = integers(query_offsets);
    runtime.write(pass.query_offsets, 0, offsets.size(), offsets.data());
  }
  return pass;
}

void find_triangles(host::Runtime& runtime, const Locator& locator, const Pass& pass, bool keep_outside,
                    const Buffer<cl_double>& queries, std::size_t m, const Buffer<cl_int>& found) {
  runtime.chunks("locate", "find_triangles", m, runtime.tuning().chunk(m), pass.sets, cl_int{keep_outside},
                 pass.query_offsets, locator.records, locator.nodes, locator.starts, queries, pass.powers[0],
                 pass.powers[1], pass.powers[2], pass.scaling.orient_bound, pass.scaling.unit, locator.points,
                 locator.faces, locator.first_triangle, found);
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
  const Scaling scaling = scaling_of(runtime, mesh, locator.magnitudes);
  locator.shift = scaling.shift;
  locator.points = own.allocate<cl_double2>(n);
  locator.source = own.allocate<cl_int>(n);
  locator.first_triangle = own.allocate<cl_int>(n);
  locator.clearances = own.allocate<cl_int>(n);
  locator.faces = own.allocate<Face>(triangles);
  locator.hull_points = own.allocate<cl_double2>(mesh.hull_offsets.back());
  locator.hull = own.allocate<cl_int>(mesh.hull_offsets.back());

  Faults faults;
  Plan plan;
  const std::vector<cl_int> point_offsets = integers(mesh.point_offsets);
  const std::vector<cl_int> triangle_offsets = integers(mesh.triangle_offsets);
  const std::vector<cl_int> hull_offsets = integers(mesh.hull_offsets);
  const host::Runtime::Settled settled(runtime);
  const auto device_faults = scratch.allocate<cl_int>(3);
  runtime.write_later(device_faults, 0, 3, &faults.triangle);
  const auto incident = scratch.allocate<cl_int>(n);
  const Offsets offsets{upload(runtime, scratch, point_offsets), upload(runtime, scratch, triangle_offsets),
                        upload(runtime, scratch, hull_offsets)};
  fill_faces(runtime, mesh, scaling.powers(), offsets, device_faults, incident, locator);
  fill_hull(runtime, mesh, scaling.powers(), offsets, device_faults, locator);
  runtime.map("locate", "check_representatives", n, static_cast<cl_int>(mesh.sets()), offsets.points,
              mesh.representatives, device_faults);
  // The device works while the host makes the trees.
  runtime.flush();
  plan = make_plan(runtime, mesh);
  runtime.read(device_faults, 0, 3, &faults.triangle);
  throw_faults(faults);
  locator.records = upload(runtime, own, plan.records);
  locator.nodes = upload(runtime, own, plan.nodes);
  locator.starts = upload(runtime, own, plan.starts);
  runtime.map("locate", "start_triangles", plan.starts.size(),
              static_cast<cl_int>(std::max<std::size_t>(triangles, 1) - 1), mesh.representatives, incident,
              locator.starts);
  runtime.finish();
  return locator;
}

void locate(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries, std::size_t m,
            const std::vector<std::size_t>& query_offsets, const Buffer<cl_int>& triangles) {
  Arena::Scope scope(runtime.arena());
  const Pass pass = prepare(runtime, locator, queries, m, query_offsets);
  find_triangles(runtime, locator, pass, false, queries, m, triangles);
}

void nearest(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries, std::size_t m,
             const std::vector<std::size_t>& query_offsets, const Buffer<cl_int>& points) {
  Arena::Scope scope(runtime.arena());
  const Pass pass = prepare(runtime, locator, queries, m, query_offsets);
  const auto found = runtime.arena().allocate<cl_int>(m);
  find_triangles(runtime, locator, pass, true, queries, m, found);
  runtime.map("locate", "nearest_points", m, pass.sets, pass.query_offsets, locator.records, queries,
              pass.powers[0], pass.powers[1], pass.powers[2], pass.scaling.nearness_bound, pass.scaling.unit,
              locator.points, locator.source, locator.clearances, locator.faces, locator.hull_points,
              locator.hull, found, points);
}

void interpolate(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& values,
                 const Buffer<cl_double>& queries, std::size_t m,
                 const std::vector<std::size_t>& query_offsets, const Buffer<cl_double>& results) {
  Arena::Scope scope(runtime.arena());
  const Pass pass = prepare(runtime, locator, queries, m, query_offsets);
  const auto found = runtime.arena().allocate<cl_int>(m);
  find_triangles(runtime, locator, pass, false, queries, m, found);
  runtime.map("locate", "interpolate_queries", m, queries, pass.powers[0], pass.powers[1], pass.powers[2],
              pass.scaling.orient_bound, pass.scaling.unit, locator.points, locator.source, locator.faces,
              found, values, results);
}

}  // namespace flaunay::derived
