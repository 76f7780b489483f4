#include "launchers/flattened/hull_depth.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {

void decide_depths(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                   const Buffer<cl_int>& ids, const Buffer<cl_int>& chord, std::size_t count, bool keep_on,
                   const Buffer<cl_uchar>& flags) {
  work.runtime.map_in_small_groups(count, kernels::hull_depth_exact{.keep_on = keep_on,
                                                                    .own_path = false,
                                                                    .ids = ids,
                                                                    .chord = chord,
                                                                    .path_vertices = paths,
                                                                    .cuts = level.cuts(table),
                                                                    .flags = flags,
                                                                    .undecided = work.undecided});
}

void decide_vertices(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                     const Buffer<cl_uchar>& flags) {
  work.runtime.map_in_small_groups(paths.size, kernels::hull_depth_exact{.keep_on = false,
                                                                         .own_path = true,
                                                                         .ids = paths.vertices,
                                                                         .chord = paths.vertices,
                                                                         .path_vertices = paths,
                                                                         .cuts = level.cuts(table),
                                                                         .flags = flags,
                                                                         .undecided = work.undecided});
}

}  // namespace flaunay::flattened
