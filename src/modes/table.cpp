#include "modes/table.hpp"

#include <fmt/format.h>

#include <utility>

#include "blocks/pipeline.hpp"
#include "call/frame.hpp"
#include "modes/dwyer/dwyer.hpp"
#include "modes/on_host.hpp"
#include "modes/partition/regions.hpp"
#include "modes/recursive/run.hpp"
#include "operations/counters.h"

namespace flaunay {
namespace call {
namespace {

using research::Mode;

// Records the launches of its scope, if that is wanted.
class Recording {
 public:
  Recording(Engine& engine, research::Record wanted) : runtime_(engine.runtime) {
    if (wanted == research::Record::nothing) return;
    const host::CountedWords steps{kernel::COUNTERS_LENGTH, kernel::COUNTER_STEPS, kernel::STEP_COUNTERS};
    runtime_.record_launches(wanted == research::Record::steps ? steps : host::CountedWords{});
  }
  ~Recording() { runtime_.stop_recording(); }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  std::vector<research::LaunchStatistics> launches() const {
    std::vector<research::LaunchStatistics> all;
    for (const host::Launch& launch : runtime_.recorded_launches()) {
      all.push_back(
          {launch.kernel, launch.work_items, launch.group, launch.busy, launch.elements, launch.bytes});
      all.back().seconds = launch.seconds;
      if (launch.counted.empty()) continue;
      all.back().longest_chain = launch.counted[0];
      all.back().steps = launch.counted[1] + (static_cast<std::uint64_t>(launch.counted[2]) << 32);
    }
    return all;
  }

 private:
  host::Runtime& runtime_;
};

research::Triangulation run_blocks(TriangulatorAccess::Implementation& self, const Request& request) {
  research::Triangulation result;
  const auto run = [&] {
    static_cast<Triangulation&>(result) = triangulate(self, request.points, request.offsets, request.options);
  };
  // Without a record no device is looked for if the sets are small.
  if (request.options.record == research::Record::nothing) {
    run();
    return result;
  }
  const Recording recording(self.for_host_memory(), request.options.record);
  run();
  result.launches = recording.launches();
  return result;
}

#ifndef FLAUNAY_WITHOUT_RESEARCH

// Runs the modes that go level by level.
research::Triangulation run_levels(TriangulatorAccess::Implementation& self, const Request& request,
                                   const flattened::Solvers& solvers) {
  const std::size_t n = request.offsets.back();
  Engine& asked = self.for_host_memory();
  Engine& engine = self.with_doubles(asked);
  engine.check_size(n);
  research::Triangulation result;
  static_cast<Triangulation&>(result) = empty_result(engine, request.offsets.size() - 1);
  if (n == 0) return result;
  const std::vector<double> doubles = widened(request.points);
  const double* const coordinates = doubles.empty() ? request.points.wide : doubles.data();
  const Recording recording(engine, request.options.record);
  engine.begin_call(request.options.profile);
  flattened::run(engine.runtime, {engine.persistent, engine.even, engine.odd}, coordinates, request.offsets,
                 request.options, solvers, result);
  engine.write_accounts(result.statistics);
  add_note(asked, engine, fmt::format("mode {}", research::to_string(request.options.mode)), "computed",
           result.statistics);
  result.launches = recording.launches();
  return result;
}

points::Rings solve_blocks(points::Workspace& work, const points::Blocks& blocks,
                           const host::Buffer<cl_int>& representatives) {
  // The order of rows follows from the edges, and is to be the same on all devices.
  work.ties_are_left = true;
  points::Rings rings = blocks::divide(work, blocks, representatives);
  blocks::await_rings(work, blocks, rings);
  return rings;
}

void write_rows(points::Workspace& work, const points::Blocks& blocks, const points::Rings& rings,
                const host::Buffer<cl_uint>& first_rows, const host::Buffer<cl_int>& triangles,
                const host::Buffer<cl_int>& twins) {
  blocks::MeshSizes sizes;
  sizes.first_rows = first_rows;
  points::DeviceMesh mesh;
  mesh.triangles = triangles;
  mesh.halfedges = twins;
  blocks::write_mesh(work, blocks, rings, sizes, mesh);
}

research::Triangulation run_flattened(TriangulatorAccess::Implementation& self, const Request& request) {
  flattened::Solvers solvers;
  solvers.blocks = block_solver();
  return run_levels(self, request, solvers);
}

// Dwyer's algorithm triangulates the regions that are left after the levels.
research::Triangulation run_partition(TriangulatorAccess::Implementation& self, const Request& request) {
  const research::Options& options = request.options;
  flattened::Solvers solvers;
  solvers.partition_levels =
      partition::levels_for(request.offsets.back(), options.partition_levels, options.threads);
  solvers.regions = [&](const geometry::PointSets& sets, const geometry::RegionArrays& regions,
                        research::OperationCounts* counts) {
    return partition::solve_regions(sets.predicates, sets.points.data(), regions, dwyer::triangulate,
                                    options.threads, counts);
  };
  return run_levels(self, request, solvers);
}

research::Triangulation run_recursive(const double* coordinates, const Request& request) {
  return modes::run_on_host(coordinates, request.offsets, request.options,
                            [](const geometry::PointSets& sets, const research::Options& options,
                               const statistics::Phases&, research::Triangulation& result) {
                              // Regions too large for the end game are triangulated like those of a
                              // partition.
                              const auto solve_region = [&sets](const geometry::RegionArrays& region,
                                                                research::Work& work) {
                                return partition::solve_region(sets.predicates, sets.points.data(), region, 0,
                                                               dwyer::triangulate, &work);
                              };
                              return geometry::Mesh{recursive::run(sets, options, solve_region, result), {}};
                            });
}

research::Triangulation run_dwyer(const double* coordinates, const Request& request) {
  return modes::run_on_host(coordinates, request.offsets, request.options, dwyer::run);
}

#endif

const ModeRow kModes[] = {
    {{Mode::blocks, "blocks", "blocks of points triangulated one per work-item, and merged (default)", false,
      false, false},
     run_blocks,
     nullptr},
#ifndef FLAUNAY_WITHOUT_RESEARCH
    {{Mode::flattened, "flattened", "all regions of a level at once, down to single points: no merge", false,
      true, true},
     run_flattened,
     nullptr},
    {{Mode::recursive_device, "recursive-device", "the same kernels, one region at a time", false, true,
      true},
     run_flattened,
     nullptr},
    {{Mode::recursive, "recursive", "plain recursion on the host, one thread", true, true, true},
     nullptr,
     run_recursive},
    {{Mode::partition, "partition", "some levels on the device, then Dwyer's algorithm on host threads",
      false, true, true},
     run_partition,
     nullptr},
    {{Mode::dwyer, "dwyer", "Dwyer's algorithm on the host, one thread", true, false, true},
     nullptr,
     run_dwyer},
#endif
};

}  // namespace

#ifdef FLAUNAY_WITHOUT_RESEARCH
constexpr const char* kNoSuchMode = "{} is no Mode of this library, which was built without FLAUNAY_RESEARCH";
#else
constexpr const char* kNoSuchMode = "{} is no Mode";
flattened::BlockSolver block_solver() { return {solve_blocks, write_rows}; }
#endif

const ModeRow& row_of(research::Mode mode) {
  for (const ModeRow& row : kModes) {
    if (row.info.mode == mode) return row;
  }
  throw Error(ErrorKind::usage, fmt::format(kNoSuchMode, static_cast<int>(mode)));
}

}  // namespace call

namespace research {

const std::vector<ModeInfo>& list_modes() {
  // Never destroyed, since threads and destructors of other objects may make calls until the process ends.
  static const auto& modes = *new std::vector<ModeInfo>([] {
    std::vector<ModeInfo> infos;
    for (const call::ModeRow& row : call::kModes) infos.push_back(row.info);
    return infos;
  }());
  return modes;
}

const char* to_string(Mode mode) noexcept {
  for (const call::ModeRow& row : call::kModes) {
    if (row.info.mode == mode) return row.info.name;
  }
  return "";
}

const char* to_string(Cut cut) noexcept { return cut == Cut::alternate ? "alternate" : "iqr"; }

const char* to_string(Finish finish) noexcept { return finish == Finish::levels ? "levels" : "blocks"; }

const char* to_string(Hull hull) noexcept {
  switch (hull) {
    case Hull::prune:
      return "prune";
    case Hull::quickhull:
      return "quickhull";
    case Hull::balanced:
      return "balanced";
    case Hull::monotone_chain:
      return "monotone-chain";
  }
  return "";
}

}  // namespace research
}  // namespace flaunay
