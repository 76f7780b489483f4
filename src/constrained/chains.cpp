#include "constrained/chains.hpp"

#include "launchers/constrained/chains.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::constrained {
namespace {

// What kernels/shared/chains.h needs for the chains' vertices.
struct Scratch {
  Buffer<cl_double2> places;
  Buffer<kernel::chain_vertex> vertices;
  Buffer<kernel::chain_edge> edges;

  Scratch(host::Arena& arena, std::size_t count)
      : places(arena.allocate<cl_double2>(count)),
        vertices(arena.allocate<kernel::chain_vertex>(count)),
        edges(arena.allocate<kernel::chain_edge>(3 * count)) {}
};

}  // namespace

void triangulate_chains(host::Runtime& runtime, const DeviceChains& chains, const Buffer<cl_int>& triangles) {
  if (chains.count == 0 || chains.vertices == 0) return;
  const Tuning& tuning = tuning_of(runtime);
  host::Arena::Scope scope(runtime.arena());
  const Scratch scratch(runtime.arena(), chains.vertices);
  runtime.map(chains.vertices, kernels::gather_vertices{.count = chains.count,
                                                        .offsets = chains.offsets,
                                                        .points = chains.points,
                                                        .chain = chains.chain,
                                                        .places = scratch.places});
  runtime.launch(chains.count, tuning.block_group, chains.count,
                 kernels::triangulate_chains{.wrapped_most = tuning.chain_wrapped_most,
                                             .alone_most = tuning.chain_alone_most,
                                             .bound = chains.circle_bound,
                                             .offsets = chains.offsets,
                                             .places = scratch.places,
                                             .vertices = scratch.vertices,
                                             .edges = scratch.edges,
                                             .triangles = triangles});
}

}  // namespace flaunay::constrained
