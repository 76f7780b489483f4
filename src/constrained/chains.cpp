#include "constrained/chains.hpp"

#include "launchers/constrained/chains.cl.hpp"

namespace flaunay::constrained {

void triangulate_chains(host::Runtime& runtime, const DeviceChains& chains, const Buffer<cl_int>& triangles) {
  runtime.map(chains.count, kernels::triangulate_chains{.bound = chains.circle_bound,
                                                        .points = chains.points,
                                                        .offsets = chains.offsets,
                                                        .chain = chains.chain,
                                                        .triangles = triangles});
}

}  // namespace flaunay::constrained
