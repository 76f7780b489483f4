#include "constrained/chains.hpp"

#include "launchers/constrained/chains.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::constrained {
namespace {

// What kernels/shared/chains.h needs for the chains' vertices.
struct Scratch {
  Buffer<cl_double2> places;
  Buffer<cl_int> next, before, inside, order, corners, twins;

  Scratch(host::Arena& arena, std::size_t vertices)
      : places(arena.allocate<cl_double2>(vertices)),
        next(arena.allocate<cl_int>(vertices)),
        before(arena.allocate<cl_int>(vertices)),
        inside(arena.allocate<cl_int>(vertices)),
        order(arena.allocate<cl_int>(vertices)),
        corners(arena.allocate<cl_int>(3 * vertices)),
        twins(arena.allocate<cl_int>(3 * vertices)) {}
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
                                             .inserted_most = tuning.chain_alone_most,
                                             .bound = chains.circle_bound,
                                             .offsets = chains.offsets,
                                             .places = scratch.places,
                                             .next = scratch.next,
                                             .before = scratch.before,
                                             .inside = scratch.inside,
                                             .order = scratch.order,
                                             .corners = scratch.corners,
                                             .twins = scratch.twins,
                                             .triangles = triangles});
}

}  // namespace flaunay::constrained
