#include <fmt/format.h>

#include <numeric>

#include "host/vector_operations.hpp"
#include "hybrid/stages.hpp"

namespace flaunay::hybrid {
namespace {

struct SetSizes {
  std::vector<std::size_t> triangle_offsets, hull_offsets;  // sets + 1
  std::size_t vertices = 0;
};

// By Euler's formula: d points, of which h are on the hull, make 2d - 2 - h triangles. Points on one line are
// walked there and back, so h is 2d - 2.
SetSizes set_sizes(const Blocks& blocks, const Rings& rings, const std::vector<cl_int>& walked) {
  SetSizes sizes;
  sizes.triangle_offsets.assign(1, 0);
  sizes.hull_offsets.assign(1, 0);
  for (std::size_t s = 0; s < blocks.sets; ++s) {
    const cl_int points = std::accumulate(rings.distinct.begin() + blocks.set_blocks[s],
                                          rings.distinct.begin() + blocks.set_blocks[s + 1], 0);
    const cl_int triangles = points < 3 ? 0 : 2 * points - 2 - walked[s];
    sizes.vertices += points;
    sizes.triangle_offsets.push_back(sizes.triangle_offsets.back() + triangles);
    sizes.hull_offsets.push_back(sizes.hull_offsets.back() + (triangles == 0 ? points : walked[s]));
  }
  return sizes;
}

// Page faults would cost more than the writing.
void touch(std::vector<std::int32_t>& values, std::size_t count) {
  values.reserve(count);
  host::prefer_huge_pages(values.data(), count * sizeof(std::int32_t));
  values.resize(count);
}

// Touched memory that stays unused is given back if it is much.
void cut(std::vector<std::int32_t>& values, std::size_t count) {
  values.resize(count);
  if (values.capacity() / 2 > count) values.shrink_to_fit();
}

// offsets must stay until the next wait.
void write_hulls(Workspace& work, const Blocks& blocks, const Rings& rings,
                 const std::vector<cl_int>& offsets, Triangulation& result) {
  host::Runtime& runtime = work.runtime;
  const auto device_offsets = work.scratch().allocate<cl_int>(offsets.size());
  runtime.write_later(device_offsets, 0, offsets.size(), offsets.data());
  result.hull.resize(result.hull_offsets.back());
  const auto hull = runtime.output(result.hull);
  runtime.map("mesh", "write_hulls", blocks.sets, blocks.device_set_blocks, rings.block_ends,
              rings.vertex_edge, rings.edges, blocks.source, device_offsets, hull);
  runtime.fetch_later(hull, result.hull);
}

}  // namespace

void prepare_result(const Blocks& blocks, bool neighbors, Triangulation& result) {
  // A vertex is the middle one of two triangles at most.
  touch(result.triangles, 6 * blocks.points);
  if (neighbors) touch(result.neighbors, 6 * blocks.points);
}

void write_mesh(Workspace& work, const Blocks& blocks, const Rings& rings, bool neighbors,
                Triangulation& result) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  std::vector<cl_int> walked(blocks.sets), hull_offsets;
  const host::Runtime::Settled settled(runtime);
  const auto hull_sizes = scratch.allocate<cl_int>(blocks.sets);
  const auto rows = scratch.allocate<cl_uint>(blocks.points + 1);
  runtime.map("mesh", "vertex_triangles", blocks.points, rings.vertex_edge, rows);
  runtime.map("mesh", "mark_outside", blocks.sets, blocks.device_set_blocks, rings.block_ends,
              rings.vertex_edge, rings.edges, rows, hull_sizes);
  host::exclusive_scan(runtime, rows, blocks.points, rows);

  runtime.read_later(hull_sizes, 0, blocks.sets, walked.data());
  const cl_uint counted = runtime.read_one(rows, blocks.points);
  SetSizes sizes = set_sizes(blocks, rings, walked);
  const std::size_t triangles = sizes.triangle_offsets.back();
  if (counted != triangles) {
    throw Error(ErrorKind::internal,
                fmt::format("{} triangles instead of {}; please report the input", counted, triangles));
  }
  result.triangle_offsets = std::move(sizes.triangle_offsets);
  result.hull_offsets = std::move(sizes.hull_offsets);
  result.statistics.duplicates = blocks.points - sizes.vertices;

  const std::size_t pairs = rings.edges.size() / 2;
  const auto corner_of_edge = scratch.allocate<cl_int>(neighbors ? rings.edges.size() : 0);
  cut(result.triangles, 3 * triangles);
  const auto device_triangles = runtime.output(result.triangles);
  runtime.chunks("mesh", "write_triangles", pairs, runtime.tuning().chunk(pairs), cl_int{neighbors},
                 blocks.vertices, blocks.source, rings.edges, rows, device_triangles, corner_of_edge);
  runtime.fetch_later(device_triangles, result.triangles);
  if (neighbors) {
    cut(result.neighbors, 3 * triangles);
    const auto device_neighbors = runtime.output(result.neighbors);
    runtime.map("mesh", "write_neighbors", pairs, rings.edges, corner_of_edge, device_neighbors);
    runtime.fetch_later(device_neighbors, result.neighbors);
  }
  hull_offsets.assign(result.hull_offsets.begin(), result.hull_offsets.end());
  write_hulls(work, blocks, rings, hull_offsets, result);
  runtime.finish();
}

}  // namespace flaunay::hybrid
