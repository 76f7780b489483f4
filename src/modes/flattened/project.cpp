#include "launchers/flattened/project.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
using namespace statistics;

void project(Workspace& work, const PointTable& table, Level& level) {
  if (level.is_small) return;
  level.projections = work.scratch().allocate<cl_double2>(level.points);
  work.runtime.map(level.points, kernels::project_points{.regions = level.point_regions,
                                                         .lists = level,
                                                         .cuts = level.cuts(table),
                                                         .projections = level.projections});
  work.add_depth(Component::hull, kernel::PROJECT_OPERATIONS);
}

}  // namespace flaunay::flattened
