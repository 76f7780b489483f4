#include "blocks/run.hpp"

#include <utility>

#include "blocks/rounds.hpp"
#include "mesh/limits.h"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
using namespace points;

void Outcome::write(std::size_t n, Statistics& statistics) const {
  statistics.points = n;
  statistics.duplicates = n - sizes.vertices;
  statistics.undecided = undecided;
  statistics.rounds = rounds;
  statistics.round_points = round_points;
  statistics.merged_points = merged_points;
  statistics.triangles = sizes.triangles();
  statistics.hull_vertices = sizes.hull_vertices();
}

namespace {

// In ascending order.
std::vector<cl_int> hidden_points(host::Runtime& runtime, const Blocks& blocks, const Rings& rings) {
  std::vector<cl_int> edges(blocks.points), source(blocks.points), hidden;
  runtime.read(rings.vertex_edge, 0, blocks.points, edges.data());
  runtime.read(blocks.source, 0, blocks.points, source.data());
  std::vector<cl_uchar> is_hidden(blocks.points);
  for (std::size_t v = 0; v < blocks.points; ++v) {
    is_hidden[static_cast<std::size_t>(source[v])] |= edges[v] == kernel::HIDDEN_VERTEX;
  }
  for (std::size_t i = 0; i < blocks.points; ++i) {
    if (is_hidden[i] != 0) hidden.push_back(static_cast<cl_int>(i));
  }
  return hidden;
}

}  // namespace

geometry::Fitted<Outcome> run(host::Runtime& runtime, Arena& persistent,
                              const std::vector<std::size_t>& offsets, const Exchange& exchange,
                              statistics::Phases& phases) {
  if (exchange.weights == nullptr && tuning_of(runtime).round_points > 0)
    return run_rounds(runtime, persistent, offsets, exchange, phases);
  Workspace work{runtime, persistent};
  work.weights = exchange.weights;
  Rings rings;
  const host::Runtime::Settled settled(runtime);

  phases.progress("blocks", 0);
  const Buffer<cl_int>& representatives = exchange.representatives;
  const geometry::Fitted<Blocks> made = [&] {
    Arena::Scope points_scope(runtime.arena());
    return make_blocks(work, exchange.points(), offsets, representatives);
  }();
  if (!made) return made.too_wide();
  const Blocks& blocks = *made;
  phases.end("blocks");

  phases.progress("triangulate", kBlocksMade);
  Milestones milestones(runtime, phases);
  rings = divide(work, blocks, representatives, &milestones);
  exchange.while_device_computes();
  milestones.report();
  await_rings(work, blocks, rings);
  if (runtime.at_most(rings.ties_left > 0, true)) make_fans(work, blocks, rings);
  phases.end("triangulate");

  phases.progress("output", kBlocksMerged);
  Outcome outcome;
  outcome.sizes = count_mesh(work, blocks, rings);
  outcome.undecided = rings.undecided;
  phases.progress("output", kMeshCounted);
  write_mesh(work, blocks, rings, outcome.sizes, exchange.mesh(outcome.sizes), &milestones);
  milestones.report();
  if (work.weights != nullptr) outcome.hidden = hidden_points(runtime, blocks, rings);
  return outcome;
}

points::DeviceMesh run(host::Runtime& runtime, Arena& persistent, const std::vector<std::size_t>& offsets,
                       const Buffer<cl_double>& coordinates, Arena& results) {
  const std::size_t n = offsets.back();
  points::DeviceMesh mesh;
  mesh.point_offsets = offsets;
  mesh.coordinates = coordinates;
  mesh.triangles = results.allocate<cl_int>(3 * kMostTrianglesPerPoint * n);
  mesh.neighbors = results.allocate<cl_int>(3 * kMostTrianglesPerPoint * n);
  mesh.hull = results.allocate<cl_int>(n);
  mesh.representatives = results.allocate<cl_int>(n);
  const Exchange exchange{[&] { return coordinates; }, mesh.representatives, true,
                          [&](const MeshSizes&) { return mesh; }};
  const Options unheard;
  statistics::Phases phases(unheard);
  MeshSizes sizes = (*run(runtime, persistent, offsets, exchange, phases)).sizes;
  mesh.triangle_offsets = std::move(sizes.triangle_offsets);
  mesh.hull_offsets = std::move(sizes.hull_offsets);
  return mesh;
}

}  // namespace flaunay::blocks
