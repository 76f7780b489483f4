#include "blocks/run.hpp"

#include <utility>

#include "blocks/rounds.hpp"
#include "blocks/weighted.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
using namespace points;

void Outcome::write(std::size_t n, Statistics& statistics) const {
  statistics.points = n;
  statistics.duplicates = n - sizes.vertices - hidden;
  statistics.undecided = undecided;
  statistics.rounds = rounds;
  statistics.round_points = round_points;
  statistics.merged_points = merged_points;
  statistics.triangles = sizes.triangles();
  statistics.hull_vertices = sizes.hull_vertices();
}

geometry::Fitted<Outcome> run(host::Runtime& runtime, Arena& persistent,
                              const std::vector<std::size_t>& offsets, const Exchange& exchange,
                              statistics::Phases& phases) {
  if (exchange.weights == nullptr && tuning_of(runtime).round_points > 0)
    return run_rounds(runtime, persistent, offsets, exchange, phases);
  Workspace work{runtime, persistent};
  points::Weights weights;
  Rings rings;
  const host::Runtime::Settled settled(runtime);

  phases.progress("blocks", 0);
  const Buffer<cl_int>& representatives = exchange.representatives;
  const geometry::Fitted<Blocks> made = [&] {
    Arena::Scope points_scope(runtime.arena());
    return make_blocks(work, exchange.points(), offsets, representatives, exchange.host_points);
  }();
  if (!made) return made.too_wide();
  const Blocks& blocks = *made;
  if (exchange.weights != nullptr) {
    weights = exchange.weights->solver->scale(work, *exchange.weights, offsets, blocks.shifts);
    work.weights = &weights;
  }
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
  if (work.weights != nullptr) outcome.hidden = weights.solver->settle(work, blocks, rings, representatives);
  phases.progress("output", kMeshCounted);
  write_mesh(work, blocks, rings, outcome.sizes, exchange.mesh(outcome.sizes), &milestones);
  milestones.report();
  return outcome;
}

points::DeviceMesh run(host::Runtime& runtime, Arena& persistent, const std::vector<std::size_t>& offsets,
                       const Buffer<cl_double>& coordinates, Arena& results) {
  return run(runtime, persistent, offsets, coordinates, results, nullptr);
}

points::DeviceMesh run(host::Runtime& runtime, Arena& persistent, const std::vector<std::size_t>& offsets,
                       const Buffer<cl_double>& coordinates, Arena& results, const points::Weights* weights) {
  const std::size_t n = offsets.back();
  points::DeviceMesh mesh;
  mesh.point_offsets = offsets;
  mesh.coordinates = coordinates;
  mesh.triangles = results.allocate<cl_int>(3 * kMostTrianglesPerPoint * n);
  mesh.neighbors = results.allocate<cl_int>(3 * kMostTrianglesPerPoint * n);
  mesh.hull = results.allocate<cl_int>(n);
  mesh.representatives = results.allocate<cl_int>(n);
  const Exchange exchange{[&] { return coordinates; },
                          mesh.representatives,
                          true,
                          [&](const MeshSizes&) { return mesh; },
                          [] {},
                          weights};
  const Options unheard;
  statistics::Phases phases(unheard);
  MeshSizes sizes = (*run(runtime, persistent, offsets, exchange, phases)).sizes;
  mesh.triangle_offsets = std::move(sizes.triangle_offsets);
  mesh.hull_offsets = std::move(sizes.hull_offsets);
  return mesh;
}

}  // namespace flaunay::blocks
