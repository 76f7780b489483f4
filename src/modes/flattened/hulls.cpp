// The dividing paths of a level: runs the stages that compute them, by the hull variant. Launches no kernel
// itself.
#include "flattened/limits.h"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
using namespace statistics;

namespace {

Paths pruned_hull(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                  LevelStatistics& statistics, int& rounds);

// Computes paths whose chords are good enough to prune a level's points by: the hulls of one candidate per
// bucket. As long as there are many candidates, they are pruned in the same way first.
Paths chord_paths(Workspace& work, const PointTable& table, const Level& level, LevelStatistics& statistics) {
  const Buffer<cl_uchar> flags = candidates(work, level);
  const HullPoints chosen = gather(work, table, level, flags, level.points, work.scratch());
  statistics.candidates += chosen.size;
  int rounds = 0;
  if (chosen.size > kernel::MANY_CANDIDATES * level.regions) {
    const Level thin = level_of(work, level, chosen);
    const Paths paths =
        pruned_hull(work, table, thin, work.scratch().allocate<cl_uchar>(thin.points), statistics, rounds);
    statistics.candidate_rounds += rounds;
    return paths;
  }
  Paths paths = quickhull(work, table, level, chosen, rounds);
  statistics.candidate_rounds += rounds;
  return strict(work, table, level, paths);
}

// Prunes by chord paths and continues with quickhull below them. flags: prune's decisions about all points
// and corners. The points for quickhull are stored where the next level will be, so that all memory of prune
// is released before quickhull begins. rounds: the number of rounds of quickhull.
Paths pruned_hull(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                  LevelStatistics& statistics, int& rounds) {
  Arena& scratch = work.scratch();
  Arena::Scope waiting_scope(*work.children);
  HullPoints survivors;
  {
    Arena::Scope scope(scratch);
    const Paths paths = chord_paths(work, table, level, statistics);
    const Pruned pruned = allocate_pruned(work, level, flags);
    prune(work, table, level, paths, false, pruned);
    survivors = gather_below(work, table, level, paths, pruned, *work.children);
  }
  statistics.survivors = survivors.size;
  return strict(work, table, level, quickhull(work, table, level, survivors, rounds));
}

Paths plain_hull(Workspace& work, const PointTable& table, const Level& level, const Buffer<cl_uchar>& flags,
                 LevelStatistics& statistics) {
  Arena::Scope waiting_scope(*work.children);
  const std::size_t elements = level.points + level.corners;
  work.runtime.fill(flags, elements, cl_uchar{1});
  const HullPoints all = gather(work, table, level, flags, elements, *work.children);
  statistics.survivors = all.size;
  return strict(work, table, level, quickhull(work, table, level, all, statistics.hull_rounds));
}

}  // namespace

Paths hulls(Workspace& work, const PointTable& table, const Level& level, LevelStatistics& statistics) {
  if (level.is_small) {
    const auto flags = work.scratch().allocate<cl_uchar>(level.corners);
    Paths paths = lone_paths(work, table, level, flags, statistics);
    paths.flags = flags;
    return paths;
  }
  const auto flags = work.scratch().allocate<cl_uchar>(level.points + level.corners);
  Paths paths = work.hull == Hull::monotone_chain ? chain_paths(work, table, level, flags, statistics)
                : work.hull == Hull::prune
                    ? pruned_hull(work, table, level, flags, statistics, statistics.hull_rounds)
                    : plain_hull(work, table, level, flags, statistics);
  paths.flags = flags;
  return paths;
}

}  // namespace flaunay::flattened
