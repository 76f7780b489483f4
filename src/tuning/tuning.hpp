// The tuning table: every size that affects the speed, per kind of device, with its reason.
#pragma once

#include <boost/compute/device.hpp>
#include <cstddef>
#include <memory>
#include <string>

#include "host/error.hpp"
#include "host/runtime.hpp"

namespace flaunay {

/// The sizes for one device. tuning.cpp has the values and the reasons.
struct Tuning : host::Sizes {
  /// Number of work-items that share a list whose length only the device knows.
  std::size_t list_workers = 1;
  /// Number of work-items that share the blocks, and the size of their work-groups.
  std::size_t block_workers = 1;
  std::size_t block_group = 1;
  /// Other than 0: the halves of all blocks are solved and merged at once; 0: one work-item solves a block.
  std::size_t blocks_in_parallel = 0;
  /// The largest work-group that sorts and halves a block.
  std::size_t halve_group = 1;
  /// A launch of fewer merges than this has about this many work-items, most of them idle, so that the merges
  /// are in different warps. If more cavities of constraints than this are filled at once, floating point is
  /// tried first, with fewer registers.
  std::size_t merge_items = 0;
  /// Work-groups triangulate parts of blocks with at most this many vertices in local memory, at most
  /// kernel::LOCAL_VERTICES; 0: none.
  std::size_t local_vertices = 0;
  /// Of at most this many points, work-groups find the star of each vertex, instead of merges.
  std::size_t star_points = 0;
  /// Halves of blocks with at least this many points together are merged from both ends of their seam.
  std::size_t seam_points = 1;
  /// The least number of work-items launched per leaf. One of them works.
  std::size_t leaf_spread = 1;
  /// The work-group that sews the seam of a merge.
  std::size_t sewing_group = 1;
  /// Blocks with more than this many times block_points points are triangulated by a single work-item, which
  /// has its own scratch memory.
  std::size_t large_blocks = 1;
  /// The scratch memory of all work-items that solve blocks is limited to this many times the points.
  std::size_t scratch_per_point = 1;
  /// Pairs of edges that are fetched into the cache before they are needed; 0: none.
  std::size_t fetch_ahead = 0;
  /// Each work-item of a group makes a chain of about chain_points points of a region, in groups of at least
  /// chain_group_least work-items.
  std::size_t chain_points = 1;
  std::size_t chain_group_least = 1;
  /// Mode flattened makes paths with one work-item per region if regions have at most this many internal
  /// points, and at most this many corners on average.
  std::size_t hull_alone_most = 0;
  /// If work-groups take tiles (tile_group): the points and samples per tile, at most as many as fit
  /// local_bytes, and the bits of a block's number per pass over the points, at most kernel::MOST_BLOCK_BITS.
  std::size_t point_tile = 1;
  std::size_t sample_tile = 1;
  std::size_t block_bits = 1;
  /// If a locator gets at least this many queries, it sorts them by their place in the plane.
  std::size_t sorted_queries_least = 1;
  /// The smallest number of vertices per leaf of a locator's tree.
  std::size_t vertices_per_leaf = 1;
  /// Sets with this many triangles have levels for the search for nearest points, if a query needs them.
  std::size_t levels_from = 1;
  /// How many vertices a vertex of the next level stands for; at least 2.
  std::size_t level_ratio = 2;
  /// A query visits at most this many triangles on its way, and then as many neighbours, before it needs
  /// levels. In a mesh with constraints, it then walks straight.
  std::size_t walk_most = 1;
  /// In fixed point, a query off the grid visits at most this many more neighbours before the call computes
  /// in doubles; 0: the call does so at once.
  std::size_t off_grid_most = 1;

  /// Chains of at most chain_wrapped_most vertices are triangulated by gift-wrapping. For longer chains of at
  /// most chain_alone_most vertices, one work-item per chain inserts the vertices.
  std::size_t chain_wrapped_most = 2;
  std::size_t chain_alone_most = 2;
  /// In longer chains, a vertex that would remove more triangles than this is inserted earlier instead.
  std::size_t chain_walk_most = 1;

  /// If the walks along segments visit more than this many triangles per triangle and segment, the segments
  /// are inserted in stages.
  std::size_t walked_most = 1;
  /// If segments have more than this many edges per point and segment, overlapping segments are joined first.
  std::size_t pieces_most = 1;

  /// Sets of at most a block's points each, and of at most this many together, are triangulated on the
  /// calling thread if no device is named; 0: none.
  std::size_t host_points = 0;

  /// With more sets, run natively, each thread computes groups of sets with about this many points, or one
  /// larger set; 0: there are no groups.
  std::size_t group_points = 0;

  /// The calling thread inserts the segments of small sets one after the other, in at most this many steps
  /// per point and segment. Sets that need more steps are left to the kernels. 0: all sets are.
  std::size_t segment_steps = 0;

  /// The largest number of points per chunk, as a rule, if the points do not fit memory.
  std::size_t chunk_points = 1;

  /// The largest number of points of a block in rounds after the first, as a rule; 0: blocks are merged
  /// instead of rounds.
  std::size_t round_points = 0;
  /// Samples per block, for the trees that cut in gaps; at most a tile of them.
  std::size_t samples_per_gap_block = 1;
  /// If more than this share of a round's points is not final, its blocks are merged instead, or if some may
  /// not be solved, the blocks of the next round.
  std::size_t merge_from_percent = 1;

  /// Levels of regions that are reached from outside between two waits.
  std::size_t depth_rounds = 1;

  /// A GPU computes in fixed point if single precision is at least this many times as fast as double
  /// precision (tuning/arithmetic.hpp); 0: the speeds are not measured.
  std::size_t fixed_point_from = 0;

  // The order of triangles depends on the following sizes. So they are the same for every device, and only
  // tests change them.

  /// The largest number of corners of a region that one work-item triangulates in private memory.
  std::size_t small_region = 1;
  /// The largest number of points of a block.
  std::size_t block_points = 1;
  /// Mode flattened hands regions to the solver of blocks when they have at most this many internal points.
  std::size_t region_points = 1;
  /// Samples per block, for the tree of cuts.
  std::size_t samples_per_block = 1;
  /// If a batch inserts, or removes, more than this percentage of the existing points, all points are
  /// triangulated anew.
  std::size_t inserted_percent = 0;
  std::size_t removed_percent = 0;
  /// If a batch moves more than this percentage, the mesh is mended only if hardly any edge changes.
  std::size_t moved_percent = 0;

  const Tuning& tuning() const override { return *this; }
  std::shared_ptr<host::Sizes> copy() const override { return std::make_shared<Tuning>(*this); }
  std::string build_options() const override;
};

/// The environment variable FLAUNAY_TUNING; empty if it is not set.
std::string tuning_in_environment();

/// The capabilities that a device's properties tell, and the sizes for it, reduced to its limits. For tests
/// and experiments, `given` overrides both. It has the form of FLAUNAY_TUNING: a kind ("cpu", "gpu", "gpu:N"
/// with all work-groups of N work-items, 1 to 1024, "small", "small-blocks"), or values by name
/// ("block_group=64"), or both, separated by commas. Throws DeviceError, which lists the allowed values, if
/// it is not valid.
host::Settings settings_for(const boost::compute::device& device,
                            const std::string& given = tuning_in_environment());

/// The sizes and capabilities for a device of this name, type and number of compute units, without its
/// limits.
struct KindOfDevice {
  Tuning tuning;
  host::Capabilities capabilities;
};
KindOfDevice kind_of_device(const std::string& name, cl_device_type type, std::size_t units,
                            const std::string& given = tuning_in_environment());

/// The sizes for kernels that run natively on the host. `given` overrides them, too, except values that are
/// compiled into the kernels.
std::shared_ptr<const Tuning> native_tuning(const std::string& given = tuning_in_environment());

inline const Tuning& tuning_of(const host::Runtime& runtime) { return runtime.sizes().tuning(); }

}  // namespace flaunay
