#include "flattened/stages.hpp"
#include "launchers/flattened/hull_depth.cl.hpp"

namespace flaunay::flattened {

void decide_depths(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                   const Buffer<cl_int>& ids, const Buffer<cl_int>& chord, std::size_t count, bool keep_on,
                   const Buffer<cl_uchar>& flags) {
  const auto list = pack_undecided(work, flags, count);
  run_list(work, kernels::hull_depth_exact{.count = work.list_length,
                                           .list = list,
                                           .keep_on = keep_on,
                                           .own_path = false,
                                           .ids = ids,
                                           .chord = chord,
                                           .path = paths.vertices,
                                           .path_region = paths.regions,
                                           .axis = level.axis,
                                           .cut = level.cut,
                                           .points = table.points,
                                           .flags = flags});
}

void decide_vertices(Workspace& work, const PointTable& table, const Level& level, const Paths& paths,
                     const Buffer<cl_uchar>& flags) {
  const auto list = pack_undecided(work, flags, paths.size);
  run_list(work, kernels::hull_depth_exact{.count = work.list_length,
                                           .list = list,
                                           .keep_on = false,
                                           .own_path = true,
                                           .ids = paths.vertices,
                                           .chord = paths.vertices,
                                           .path = paths.vertices,
                                           .path_region = paths.regions,
                                           .axis = level.axis,
                                           .cut = level.cut,
                                           .points = table.points,
                                           .flags = flags});
}

}  // namespace flaunay::flattened
