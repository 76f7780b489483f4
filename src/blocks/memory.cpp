#include "blocks/memory.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "blocks/run.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
namespace {

// The memory that a call on sets of these sizes needs, whatever their points are.
WorkspaceBytes counted(const host::Runtime& runtime, const std::shared_ptr<host::Sizes>& sizes,
                       const std::vector<std::size_t>& offsets) {
  host::Runtime counting(runtime, sizes);
  Arena persistent(counting.memory());
  persistent.count_only();
  const std::size_t n = offsets.back();
  const auto representatives = persistent.allocate<cl_int>(n);
  const auto copy_of_points = [&] { return counting.arena().allocate<cl_double>(2 * n); };
  points::DeviceMesh mesh;
  for (auto* array : {&mesh.triangles, &mesh.neighbors, &mesh.halfedges, &mesh.hull})
    *array = representatives;
  const Options unheard;
  statistics::Phases phases(unheard);
  // There are no points that could be too wide.
  static_cast<void>(run(counting, persistent, offsets,
                        {copy_of_points, representatives, true, [&](const MeshSizes&) { return mesh; }},
                        phases));
  copy_of_points();  // for areas
  return {persistent.peak_bytes(), counting.arena().peak_bytes()};
}

// Only the number of sets is known. The memory they need follows from the number of points, of leaves and of
// trees, and from the tables of leaves by chunks. With blocks of half the size there are as many leaves as
// any sets can have. Sets of one size then have the most trees, and one set has the largest tables.
WorkspaceBytes counted_for_any(const host::Runtime& runtime, std::size_t n, std::size_t sets) {
  const auto tuning = std::make_shared<Tuning>(tuning_of(runtime));
  tuning->block_points = (tuning->block_points + 1) / 2;
  tuning->large_blocks *= 2;
  std::vector<std::size_t> equal(sets + 1), one(sets + 1, n);
  for (std::size_t s = 0; s <= sets; ++s) equal[s] = n * s / sets;
  one[0] = 0;
  const WorkspaceBytes a = counted(runtime, tuning, equal), b = counted(runtime, tuning, one);
  return {std::max(a.persistent, b.persistent), std::max(a.scratch, b.scratch)};
}

}  // namespace

WorkspaceBytes workspace_bytes(const host::Runtime& runtime, std::size_t n, std::size_t sets) {
  n = std::max<std::size_t>(n, 1);
  if (sets < 2) return counted(runtime, runtime.sizes().copy(), {0, n});
  constexpr std::size_t kMostCounted = std::size_t{1} << 14;
  if (sets <= kMostCounted) return counted_for_any(runtime, n, sets);
  // A further set needs at most as much memory as each of many sets with next to no points and one tree. A
  // few more sets account for the rounding of arrays' sizes.
  const WorkspaceBytes many = counted_for_any(runtime, n, kMostCounted),
                       few_points =
                           counted_for_any(runtime, tuning_of(runtime).block_points + 1, kMostCounted);
  const std::size_t others = sets - kMostCounted + 64;
  const auto with_others = [&](std::size_t bytes, std::size_t of_many) {
    return bytes + others * (of_many / kMostCounted + 1);
  };
  return {with_others(many.persistent, few_points.persistent), with_others(many.scratch, few_points.scratch)};
}

}  // namespace flaunay::blocks
