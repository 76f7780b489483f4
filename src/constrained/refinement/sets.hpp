// Several sets that are refined one by one, so that each is as if it were alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "constrained/refinement/result.hpp"

namespace flaunay::constrained {

/// The numbers of one set's points, triangles and edges in the mesh of all sets.
struct SetNumbers {
  std::size_t first_point = 0, points = 0, first_split = 0, splits = 0, first_triangle = 0, triangles = 0,
              first_edge = 0, edges = 0;

  /// The number of a point among the set's own: its points, and then those that splitting added.
  std::int32_t own(std::int32_t v) const {
    const auto i = static_cast<std::size_t>(v);
    return static_cast<std::int32_t>(i >= first_split ? i - first_split + points : i - first_point);
  }
  /// How much larger numbers among all sets are than the set's own: for its points, for points that splitting
  /// added, and for points that refinement added. These begin with number `first_added` among all sets.
  std::array<std::int32_t, 3> shifts(std::size_t first_added) const {
    return {static_cast<std::int32_t>(first_point), static_cast<std::int32_t>(first_split - points),
            static_cast<std::int32_t>(first_added - points - splits)};
  }
};

/// The numbers of each set. offsets: of the caller's points; result: whose mesh it is.
std::vector<SetNumbers> numbers_of_sets(const MeshToRefine& mesh, const std::vector<std::size_t>& offsets,
                                        const ConstrainedTriangulation& result);

/// The mesh of one set, by numbers of its own. coordinates: set to the coordinates of its points.
MeshToRefine mesh_of_set(const MeshToRefine& all, const SetNumbers& set, std::vector<double>& coordinates);

/// Calls work(k) for each number below count, perhaps on several threads.
using ShareSets = std::function<void(std::size_t count, const std::function<void(std::size_t)>& work)>;

/// Joins the refined meshes of all sets and takes their memory. points: the number of points before
/// refinement. offsets: set to where each set begins.
RefinedMesh join_sets(host::Runtime& threads, const std::vector<SetNumbers>& sets,
                      std::vector<RefinedMesh>& parts, std::size_t points, const ShareSets& share,
                      RefinedOffsets& offsets);

}  // namespace flaunay::constrained
