#include "modes/flattened/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "geometry/mesh.hpp"
#include "modes/flattened/levels.hpp"
#include "modes/flattened/regions.hpp"
#include "modes/flattened/stages.hpp"
#include "statistics/phases.hpp"

namespace flaunay::flattened {
using namespace geometry;
using namespace statistics;

namespace {

// Bytes per input point that the arenas reserve, which are enough for points in general position
// (docs/performance-history.md). If an input needs more, the arenas allocate further blocks.
constexpr std::size_t kPersistentBytesPerPoint = 30;
// Needed twice: for the current level and for the next one.
constexpr std::size_t kStateBytesPerPoint = 44, kStateBytesPerPointOfBlocks = 31;
constexpr std::size_t kScratchBytesPerPoint = 82, kScratchBytesPerPointOfBlocks = 108;
// The triangles and twins of all points, which can be in memory of the host.
constexpr std::size_t kMeshBytesPerPoint = 24;

// The share of the time that is over when a stage ends, for progress.
constexpr double kSorted = 0.05;
constexpr double kPartitioned = 0.4;
constexpr double kTriangulated = 0.9;
constexpr double kCanonical = 0.95;

// Operations are counted in levels alone.
bool ends_in_blocks(const research::Options& options) {
  return options.mode == research::Mode::flattened && options.finish == research::Finish::blocks &&
         !options.count;
}

// The state of one call: the sorted points, and the result so far.
class Call {
 public:
  Call(host::Runtime& runtime, const Memory& memory, const double* coordinates,
       const std::vector<std::size_t>& offsets, const research::Options& options,
       research::Triangulation& result);

  /// To be called after the last level: checks invariants, and reads the largest regions and the counts.
  void end_levels(std::size_t done, std::size_t wanted);
  void finish_statistics(const Borders& borders);

  statistics::Phases phases;
  const research::Options& options;
  research::Triangulation& result;

 private:
  Arena::Scope scope_;

 public:
  Workspace work;
  PointTable table;

 private:
  std::unique_ptr<Counting> counting_;
};

Call::Call(host::Runtime& runtime, const Memory& memory, const double* coordinates,
           const std::vector<std::size_t>& offsets, const research::Options& wanted,
           research::Triangulation& made)
    : phases(wanted, [&runtime] { return runtime.working_clock(); }),
      options(wanted),
      result(made),
      scope_(memory.persistent),
      work{runtime, memory.persistent, made.levels} {
  const std::size_t n = offsets.back();
  Arena& persistent = memory.persistent;
  const std::size_t mesh = runtime.sizes().in_host_memory != 0 ? 0 : kMeshBytesPerPoint;
  const bool in_blocks = ends_in_blocks(wanted);
  persistent.reserve(n * (kPersistentBytesPerPoint + mesh));
  for (Arena* const state : {&memory.even, &memory.odd}) {
    state->reserve(n * (in_blocks ? kStateBytesPerPointOfBlocks : kStateBytesPerPoint));
  }
  runtime.arena().reserve(n * (mesh + (in_blocks ? kScratchBytesPerPointOfBlocks : kScratchBytesPerPoint)));
  // Operations are counted by the paper's quickhull.
  const bool in_rounds = options.count || options.hull != Hull::prune;
  work.hull = in_rounds ? options.hull : Hull::monotone_chain;
  work.broken = persistent.allocate<cl_int>(1);
  work.list_length = persistent.allocate<cl_uint>(1);
  work.undecided = persistent.allocate<cl_uint>(1);
  work.largest = persistent.allocate<cl_int>(kMostLevels);
  runtime.fill(work.largest, kMostLevels, cl_int{0});
  runtime.fill(work.broken, 1, cl_int{0});
  runtime.fill(work.undecided, 1, cl_uint{0});
  if (options.count) {
    counting_ = std::make_unique<Counting>(runtime, persistent, result.work);
    work.counting = counting_.get();
  }
  phases.progress("sorting", 0.0);
  result.representatives.resize(n);
  table = ingest(work, coordinates, offsets, result.representatives.data());
  if (counting_) {
    const std::vector<cl_int> distinct = read_all(work, table.set_offsets, table.sets + 1);
    counting_->add_sort(offsets);
    counting_->add_sort({distinct.begin(), distinct.end()});
  }
  result.statistics.device = runtime.name();
  result.statistics.points = n;
  result.statistics.duplicates = n - table.count;
  phases.end("sort");
  phases.progress("borders", kSorted);
}

void Call::end_levels(std::size_t done, std::size_t wanted) {
  auto& levels = work.levels;
  std::vector<cl_int> largest(levels.size());
  const host::Runtime::Settled settled(work.runtime);
  work.runtime.read_later(work.largest, 0, levels.size(), largest.data());
  check_invariants(work);
  for (std::size_t l = 0; l < levels.size(); ++l) {
    levels[l].largest_region = static_cast<std::size_t>(largest[l]);
  }
  if (done != wanted) {
    throw Error(ErrorKind::internal,
                fmt::format("{} triangles instead of {}; please report the input", done, wanted));
  }
  if (counting_) counting_->finish();
  // The remaining steps are the same in every mode and are not counted.
  work.counting = nullptr;
  counting_.reset();
}

void Call::finish_statistics(const Borders& borders) {
  Statistics& statistics = result.statistics;
  statistics.undecided += work.runtime.read_one(work.undecided, 0);
  statistics.triangles = borders.triangles;
  statistics.hull_vertices = borders.size;
  phases.write(statistics);
}

// Copies all results to the host.
void write_result(Call& call, const Buffer<cl_int>& triangles, const Buffer<cl_int>& twins,
                  const Borders& borders) {
  call.phases.progress("output", kCanonical);
  read_rows(call.work, call.table, triangles, twins, borders.triangles, call.options, call.result);
  call.result.hull = read_indices(call.work, call.table, borders.hull, borders.size);
  call.result.hull_offsets = borders.hull_offsets;
  call.phases.end("output");
}

// They become the neighbours, if those are asked for.
Buffer<cl_int> memory_for_twins(Call& call, std::size_t count) {
  Arena& scratch = call.work.scratch();
  if (!call.options.neighbors && !call.options.halfedges) return scratch.allocate<cl_int>(3 * count);
  return result_memory(call.work, scratch, call.result.neighbors, 3 * count);
}

// Runs the levels to the bottom. Then makes the triangles canonical and finds neighbours.
void finish_levels(Call& call, Recursion& recursion, const Borders& borders) {
  if (call.options.mode == research::Mode::flattened) {
    recursion.flattened();
  } else {
    recursion.recursive();
  }
  call.end_levels(recursion.done(), borders.triangles);
  call.phases.end("levels");
  call.phases.progress("canonical form", kTriangulated);
  Workspace& work = call.work;
  const PointTable& table = call.table;
  const std::size_t count = borders.triangles;
  const Buffer<cl_int>& triangles = recursion.triangles();
  Arena::Scope scope(work.scratch());
  const auto twins = memory_for_twins(call, count);
  call.result.triangle_offsets = order_by_sets(work, table, triangles, {}, count);
  match_edges(work, triangles, count, twins);
  canonicalize(work, table, triangles, count, twins);
  check_invariants(work);
  call.phases.end("canonical form");
  write_result(call, triangles, twins, borders);
}

// Runs levels until regions are as small as blocks, which the solver of blocks triangulates.
void finish_blocks(Call& call, Recursion& recursion, const Borders& borders, const BlockSolver& solver) {
  Workspace& work = call.work;
  const PointTable& table = call.table;
  recursion.flattened(recursion.levels_to(tuning_of(work.runtime).region_points));
  call.phases.end("levels");
  call.phases.progress("regions", kPartitioned);
  const std::size_t count = borders.triangles;
  const Buffer<cl_int>& triangles = recursion.triangles();
  Arena::Scope scope(work.scratch());
  const auto twins = memory_for_twins(call, count);
  work.runtime.fill(twins, 3 * count, cl_int{-1});
  const SolvedRegions solved = solve_regions(work, table, recursion.level(), recursion.other_arena(), solver,
                                             triangles, recursion.done(), twins);
  call.end_levels(recursion.done() + solved.triangles, borders.triangles);
  call.result.statistics.undecided += solved.undecided;
  call.phases.end("regions");
  call.phases.progress("canonical form", kTriangulated);
  if (match_loose_edges(work, table, triangles, count, twins) || solved.ties > 0) {
    canonicalize(work, table, triangles, count, twins);
    check_invariants(work);
  }
  call.result.triangle_offsets = order_by_sets(work, table, triangles, twins, count);
  call.phases.end("canonical form");
  write_result(call, triangles, twins, borders);
}

// Runs a few levels on the device. The host triangulates the remaining regions and makes the result
// canonical.
void finish_partition(Call& call, Recursion& recursion, const Borders& borders, int levels,
                      const SolveRegions& solve_regions) {
  const research::Options& options = call.options;
  research::Triangulation& result = call.result;
  recursion.flattened(std::min<int>(levels, kMostLevels));
  const geometry::PointSets sets = to_host(call.work, call.table, result.representatives);
  std::vector<std::int32_t> triangles = recursion.read_triangles();
  const RegionArrays regions = recursion.read_regions();
  call.phases.end("partition");
  call.phases.progress("regions", kPartitioned);
  OperationCounts counts;
  const std::vector<std::int32_t> solved = solve_regions(sets, regions, options.count ? &counts : nullptr);
  triangles.insert(triangles.end(), solved.begin(), solved.end());
  call.end_levels(triangles.size() / 3, borders.triangles);
  Work& work = result.work;
  Work::Components& last = work.levels.empty() ? work.start : work.levels.back();
  add_beside(part_of(last, Component::endgame), counts);
  call.phases.end("regions");
  call.phases.progress("canonical form", kTriangulated);
  Triangulation finished = finish(sets, std::move(triangles), {}, options);
  finished.statistics = std::move(result.statistics);
  static_cast<Triangulation&>(result) = std::move(finished);
  call.phases.end("canonical form");
}

}  // namespace

void run(host::Runtime& runtime, const Memory& memory, const double* coordinates,
         const std::vector<std::size_t>& offsets, const research::Options& options, const Solvers& solvers,
         research::Triangulation& result) {
  Call call(runtime, memory, coordinates, offsets, options, result);
  const bool ends_early = ends_in_blocks(options) || options.mode == research::Mode::partition;
  Recursion recursion(call.work, call.table, options, {&memory.even, &memory.odd},
                      ends_early ? kPartitioned : kTriangulated);
  const Borders borders = recursion.begin(result.triangles);
  call.phases.end("borders");
  if (options.mode == research::Mode::partition) {
    finish_partition(call, recursion, borders, solvers.partition_levels, solvers.regions);
  } else if (ends_in_blocks(options)) {
    finish_blocks(call, recursion, borders, solvers.blocks);
  } else {
    finish_levels(call, recursion, borders);
  }
  call.finish_statistics(borders);
  call.phases.progress("output", 1);
}

void partition(host::Runtime& runtime, const Memory& memory, const double* coordinates, std::size_t n,
               int levels, const research::Options& options, research::Partition& result) {
  research::Triangulation made;
  Call call(runtime, memory, coordinates, {0, n}, options, made);
  Recursion recursion(call.work, call.table, options, {&memory.even, &memory.odd}, kTriangulated);
  const Borders borders = recursion.begin(made.triangles);
  call.phases.end("borders");
  recursion.flattened(std::min<int>(levels, kMostLevels));
  check_invariants(call.work);
  result.regions = to_input(call.work, call.table, recursion.read_regions());
  result.triangles = read_indices(call.work, call.table, recursion.triangles(), 3 * recursion.done());
  call.phases.end("levels");
  call.finish_statistics(borders);
  result.statistics = std::move(made.statistics);
  result.levels = std::move(made.levels);
  call.phases.progress("levels", 1);
}

}  // namespace flaunay::flattened
