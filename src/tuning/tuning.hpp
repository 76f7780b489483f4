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
  /// Other than 0: blocks are solved by halves, those of all blocks at once; else by one work-item per block.
  std::size_t blocks_in_parallel = 0;
  /// The largest work-group that sorts and halves a block.
  std::size_t halve_group = 1;
  /// A launch of merges that are fewer than this has about so many work-items, most of them idle, so that
  /// merges are not in one warp. If more cavities of constraints than this are filled at once, floating point
  /// is tried first, with fewer registers.
  std::size_t merge_items = 0;
  /// Halves of blocks that have at least so many points together are merged from both ends of their seam.
  std::size_t seam_points = 1;
  /// Work-items that a leaf takes at least, of which one works.
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
  /// Of a region's points a work-item of a group makes a chain of about so many, in groups of at least this
  /// size.
  std::size_t chain_points = 1;
  std::size_t chain_group_least = 1;
  /// Mode flattened makes paths with a work-item per region where regions have at most so many internal
  /// points and, on average, corners.
  std::size_t hull_alone_most = 0;
  /// If work-groups take tiles (tile_group): the points and samples per tile, at most what local_bytes holds,
  /// and the bits of a block's number per pass over the points, at most kernel::MOST_BLOCK_BITS.
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
  /// A query looks at so many triangles on its way, and then at so many neighbours, before it needs levels;
  /// in a mesh with constraints, before it walks straight.
  std::size_t walk_most = 1;
  /// In fixed point, a query between the places of the grid looks at so many more neighbours, or the call
  /// computes in doubles; 0: it does so at once.
  std::size_t off_grid_most = 1;

  /// Chains of at most this many vertices are triangulated by gift-wrapping, and of those with more, a
  /// work-item each inserts the vertices of chains of at most chain_alone_most.
  std::size_t chain_wrapped_most = 2;
  std::size_t chain_alone_most = 2;
  /// Of longer chains, if a vertex takes away more triangles than this, it is inserted earlier instead.
  std::size_t chain_walk_most = 1;

  /// If segments are walked along through more triangles than so many per triangle and segment, they are
  /// inserted in stages.
  std::size_t walked_most = 1;
  /// If they have more edges in all than so many per point and segment, those that overlap are joined first.
  std::size_t pieces_most = 1;

  /// Sets of at most a block's points each, and of at most this many together, are triangulated on the
  /// calling thread if no device is named; 0: none.
  std::size_t host_points = 0;

  /// Of more sets, natively, each thread computes groups that have so many points, or a set; 0: there are no
  /// groups.
  std::size_t group_points = 0;

  /// The calling thread inserts the segments of small sets one after the other in so many steps per point and
  /// segment; those that take more are left to the kernels. 0: all are.
  std::size_t segment_steps = 0;

  /// The largest number of points of a chunk, of those that do not fit memory, as a rule.
  std::size_t chunk_points = 1;

  /// The largest number of points of a block in rounds after the first, as a rule; 0: blocks are merged
  /// instead of rounds.
  std::size_t round_points = 0;
  /// Samples per block, for the trees that cut in gaps; at most a tile of them.
  std::size_t samples_per_gap_block = 1;
  /// If a round leaves more than so many percent of its points, its blocks are merged, or if some may not be
  /// solved, those of the next one.
  std::size_t merge_from_percent = 1;

  /// So many levels of regions are reached from outside between two waits.
  std::size_t depth_rounds = 1;

  /// If single precision is at least so many times as fast as double precision on a GPU, it computes in fixed
  /// point (tuning/arithmetic.hpp); 0: the rates are not asked for.
  std::size_t fixed_point_from = 0;

  // The order of triangles depends on the following sizes. So they are the same for every device, and only
  // tests change them.

  /// The largest number of corners of a region that one work-item triangulates in private memory.
  std::size_t small_region = 1;
  /// The largest number of points of a block.
  std::size_t block_points = 1;
  /// Mode flattened hands regions to the solver of blocks when they have at most so many internal points.
  std::size_t region_points = 1;
  /// Samples per block, for the tree of cuts.
  std::size_t samples_per_block = 1;
  /// If a batch inserts, or removes, more than so many percent of the points that there are, all points are
  /// triangulated anew.
  std::size_t inserted_percent = 0;
  std::size_t removed_percent = 0;
  /// If a batch moves more than so many percent, the mesh is mended only if hardly an edge of it changes.
  std::size_t moved_percent = 0;

  const Tuning& tuning() const override { return *this; }
  std::shared_ptr<host::Sizes> copy() const override { return std::make_shared<Tuning>(*this); }
  std::string build_options() const override;
};

/// The environment variable FLAUNAY_TUNING; empty if it is not set.
std::string tuning_in_environment();

/// What a device can do as far as its properties tell, and the sizes for it, reduced to its limits. For tests
/// and experiments, `given` overrides both, which is as FLAUNAY_TUNING has it: a kind ("cpu", "gpu", "gpu:N"
/// with all work-groups of N work-items, 1 to 1024, "small", "small-blocks"), or values by name
/// ("block_group=64"), or both, separated by commas. Throws DeviceError, which says what is allowed, if it is
/// not valid.
host::Settings settings_for(const boost::compute::device& device,
                            const std::string& given = tuning_in_environment());

/// What is taken for a device of this name, type and number of compute units, whatever its limits are.
struct KindOfDevice {
  Tuning tuning;
  host::Capabilities capabilities;
};
KindOfDevice kind_of_device(const std::string& name, cl_device_type type, std::size_t units,
                            const std::string& given = tuning_in_environment());

/// The sizes for kernels that run natively on the host. `given` overrides them, too, except what the kernels
/// are compiled for.
std::shared_ptr<const Tuning> native_tuning(const std::string& given = tuning_in_environment());

inline const Tuning& tuning_of(const host::Runtime& runtime) { return runtime.sizes().tuning(); }

}  // namespace flaunay
