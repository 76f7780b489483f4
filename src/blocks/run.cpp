#include "blocks/run.hpp"

namespace flaunay::blocks {
namespace {

// The share of the time that is over when a phase ends, for progress.
constexpr double kBlocksMade = 0.15;
constexpr double kTriangulated = 0.8;

}  // namespace

void Outcome::write(std::size_t n, Statistics& statistics) const {
  statistics.points = n;
  statistics.duplicates = n - sizes.vertices;
  statistics.undecided = undecided;
  statistics.triangles = sizes.triangles();
  statistics.hull_vertices = sizes.hull_vertices();
}

Outcome run(host::Runtime& runtime, Arena& persistent, const std::vector<std::size_t>& offsets,
            Exchange& exchange, statistics::Phases& phases) {
  Workspace work{runtime, persistent};
  Rings rings;
  const host::Runtime::Settled settled(runtime);

  phases.progress("blocks", 0);
  const auto representatives = exchange.representatives();
  const Blocks blocks = [&] {
    Arena::Scope points_scope(runtime.arena());
    return make_blocks(work, exchange.points(), offsets, representatives);
  }();
  phases.end("blocks");

  phases.progress("triangulate", kBlocksMade);
  rings = divide(work, blocks, representatives);
  exchange.while_device_computes();
  await_rings(work, blocks, rings);
  phases.end("triangulate");

  phases.progress("output", kTriangulated);
  Outcome outcome{count_mesh(work, blocks, rings), rings.undecided};
  write_mesh(work, blocks, rings, outcome.sizes, exchange.mesh(outcome.sizes));
  return outcome;
}

}  // namespace flaunay::blocks
