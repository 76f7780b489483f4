#include "tuning/tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <optional>
#include <vector>

#include "blocks/limits.h"
#include "flattened/limits.h"
#include "host/error.hpp"
#include "host/native/threads.hpp"
#include "host/opencl/device.hpp"
#include "operations/limits.h"
#include "operations/prefetch.h"
#include "points/limits.h"

namespace flaunay {
namespace {

using host::DeviceError;

constexpr std::size_t kSmallRegion = kernel::DEFAULT_SMALL_REGION;
constexpr std::size_t kLargestGroup = 1024;  // of work-items
constexpr std::size_t kLargestValue = std::size_t{1} << 30;
// From this rate of fp32 over that of fp64 on, fixed point takes less time on a GPU, by the model
// (bench/predictions/predict.py).
constexpr std::size_t kSlowFp64 = 24;

// A value of the table: a number, or a number per compute unit of the device.
struct Amount {
  std::size_t number;
  bool is_per_unit = false;
};
constexpr Amount per_unit(std::size_t number) { return {number, true}; }

struct Row {
  const char* name;
  std::size_t Tuning::*member;
  Amount cpu, gpu;
  Amount small;  ///< odd sizes that make every boundary occur on small input, for tests
  const char* reason;
};

constexpr Row kTable[] = {
    {"map_group",
     &Tuning::map_group,
     {256},
     {256},
     {3},
     "A CPU runs a group in one loop, which it enters once; 8 warps hide a GPU's latency."},
    {"private_group",
     &Tuning::private_group,
     {16},
     {256},
     {3},
     "PoCL keeps the private arrays of a group, up to 2.2 KB per work-item, on a thread's stack; a GPU as "
     "map_group."},
    {"chunk_group",
     &Tuning::chunk_group,
     {1},
     {64},
     {2},
     "On a CPU a work-item with its chunk is a task for a core; on a GPU two warps share a multiprocessor."},
    {"chunk_least",
     &Tuning::chunk_least,
     {1024},
     {32},
     {5},
     "A CPU's chunk must outweigh its launch; a GPU needs many work-items more than long ones."},
    {"chunks_most",
     &Tuning::chunks_most,
     per_unit(8),
     {0},
     {0},
     "A few chunks per core balance the load; more would only make the scan of their sums longer."},
    {"sort_bits",
     &Tuning::sort_bits,
     {8},
     {4},
     {3},
     "256 counters fit a core's first-level cache; a GPU has them in local memory for each work-item."},
    {"sort_group",
     &Tuning::sort_group,
     {1},
     {128},
     {4},
     "As chunks on a CPU; on a GPU what local memory has room for."},
    {"sort_items",
     &Tuning::sort_items,
     {0},
     {16},
     {3},
     "As chunks on a CPU; on a GPU enough to make use of the counters."},
    {"tile_group",
     &Tuning::tile_group,
     {0},
     {256},
     {0},
     "A CPU's core does alone what a group of a GPU shares; barriers would only cost it time."},
    {"scan_items",
     &Tuning::scan_items,
     {8},
     {8},
     {3},
     "As many additions as the group needs steps to scan its sums."},
    {"scan_tiles_alone",
     &Tuning::scan_tiles_alone,
     {4},
     {4},
     {2},
     "A few more tiles for one group take no longer than another launch."},
    {"scan_groups",
     &Tuning::scan_groups,
     {1024},
     {1024},
     {3},
     "About as many as large GPUs run at once; each adds up the sums of those before, 4 a work-item."},
    {"chain_points",
     &Tuning::chain_points,
     {4},
     {4},
     {2},
     "A work-item's chain of as many points costs what joining two such chains does."},
    {"chain_group_least",
     &Tuning::chain_group_least,
     {1},
     {32},
     {1},
     "A warp takes a region, however small; on a CPU a work-item does."},
    {"hull_alone_most",
     &Tuning::hull_alone_most,
     {128},
     {0},
     {4},
     "To prune so few points takes longer than a chain of all. Work-items of a GPU would wait for the "
     "longest."},
    {"point_tile",
     &Tuning::point_tile,
     {2048},
     {2048},
     {7},
     "Local memory sorts a tile, so that neighbours write to neighbouring places."},
    {"sample_tile",
     &Tuning::sample_tile,
     {1024},
     {1024},
     {6},
     "What 32 KB of local memory hold with both orders, half with 16 KB; larger nodes cost two launches a "
     "level."},
    {"block_bits",
     &Tuning::block_bits,
     {10},
     {10},
     {2},
     "A tile's counts are then half as many as its points; one pass serves 2 million points."},
    {"list_workers",
     &Tuning::list_workers,
     per_unit(16),
     {16384},
     {7},
     "Lists of undecided predicates are short as a rule, and of uneven cost."},
    {"block_workers",
     &Tuning::block_workers,
     per_unit(2),
     {16384},
     {3},
     "Blocks are handed out one by one; a CPU's work-items keep their scratch in a core's cache."},
    {"block_group",
     &Tuning::block_group,
     {1},
     {32},
     {2},
     "Work-items that solve blocks diverge: a warp is enough."},
    {"blocks_in_parallel",
     &Tuning::blocks_in_parallel,
     {0},
     {1},
     {0},
     "A core is fastest alone with its block; thousands of lanes share the halves of all blocks."},
    {"halve_group",
     &Tuning::halve_group,
     {1},
     {256},
     {4},
     "Eight points of a block for each work-item; six groups fit the local memory of a multiprocessor."},
    {"merge_items",
     &Tuning::merge_items,
     {0},
     {65536},
     {30},
     "As many as a GPU has room for; where merges are fewer, each has a warp of its own and waits for no "
     "other."},
    {"leaf_spread",
     &Tuning::leaf_spread,
     {1},
     {3},
     {2},
     "Of a warp every third lane makes a leaf: caches hold what so many keep in private memory. An H100 "
     "takes 1.2 ms "
     "instead of 3.1 for 10 million points."},
    {"local_vertices",
     &Tuning::local_vertices,
     {0},
     {kernel::LOCAL_VERTICES},
     {16},
     "What 48 KB of local memory hold. There a step takes a third of the time, as predicted, not measured, "
     "and "
     "all heights take one launch."},
    {"star_points",
     &Tuning::star_points,
     {0},
     {16384},
     {0},
     "Each vertex is compared with all of its part, some eight times: of more points, that takes longer than "
     "merges, "
     "which wait for each other."},
    {"seam_points",
     &Tuning::seam_points,
     {16},
     {4},
     {4},
     "From here on two walks save more than what a further launch costs: on an H100, of 10 million points, "
     "64 ms "
     "with 16 and 52 with 4."},
    {"sewing_group",
     &Tuning::sewing_group,
     {1},
     {256},
     {4},
     "As many work-items as edges cross the seam of a large merge, as a rule."},
    {"large_blocks",
     &Tuning::large_blocks,
     {4},
     {4},
     {4},
     "Equal points cannot be cut; one large block must not make the scratch of all work-items as large."},
    {"scratch_per_point",
     &Tuning::scratch_per_point,
     {2},
     {2},
     {2},
     "Memory stays proportional to the points."},
    {"fetch_ahead",
     &Tuning::fetch_ahead,
     {CPU_FETCH_AHEAD},
     {0},
     {0},
     "Edges lead anywhere within a block. GPUs hide waiting otherwise."},
    {"sorted_queries_least",
     &Tuning::sorted_queries_least,
     {16384},
     {16384},
     {4},
     "From here on sorting queries saves more than it costs (PoCL, 2 cores: 0.56 to 0.17 s per million)."},
    {"vertices_per_leaf",
     &Tuning::vertices_per_leaf,
     {16},
     {16},
     {16},
     "A walk from the sample in a leaf takes a few steps."},
    {"levels_from",
     &Tuning::levels_from,
     {2048},
     {2048},
     {8},
     "A walk through all of a smaller set takes microseconds."},
    {"level_ratio",
     &Tuning::level_ratio,
     {16},
     {16},
     {3},
     "Fewer steps per level with a smaller one, but more memory: 1 / 15 of the mesh's with this one."},
    {"walk_most",
     &Tuning::walk_most,
     {128},
     {128},
     {2},
     "Of uniform points a query needs some 10 triangles and 20 neighbours."},
    {"off_grid_most",
     &Tuning::off_grid_most,
     {16384},
     {16384},
     {16384},
     "Takes one work-item milliseconds; the host would first have to make a locator of its own."},
    {"chain_wrapped_most",
     &Tuning::chain_wrapped_most,
     {24},
     {128},
     {5},
     "With more, insertion takes less time than gift-wrapping. A GPU's rounds take hundreds of launches, as "
     "long as a "
     "thousand in-circle tests after each other."},
    {"chain_alone_most",
     &Tuning::chain_alone_most,
     {kLargestValue},
     {128},
     {9},
     "A core does alone what takes many work-items of a GPU rounds; one of its work-items would take "
     "seconds."},
    {"chain_walk_most",
     &Tuning::chain_walk_most,
     {1024},
     {1024},
     {8},
     "To begin again takes about as long as a walk of so many steps on a GPU; one vertex in hundreds has as "
     "many edges "
     "at most."},
    {"walked_most",
     &Tuning::walked_most,
     {2},
     {64},
     {0},
     "Stages make walks short, but each takes a pass over all triangles, and on a GPU about fifty launches."},
    {"pieces_most",
     &Tuning::pieces_most,
     {2},
     {16},
     {0},
     "The host joins segments one after the other; a GPU sorts many edges in that time."},
    {"host_points",
     &Tuning::host_points,
     {6000},
     {20000},
     {0},
     "Below, waking threads or a GPU takes longer than doing the work."},
    {"group_points",
     &Tuning::group_points,
     {1500},
     {0},
     {0},
     "With what a constrained triangulation needs, a group stays in a core's second-level cache."},
    {"segment_steps",
     &Tuning::segment_steps,
     {50},
     {50},
     {1},
     "Cavities are gift-wrapped, which takes the square of their size; kernels insert large ones at random."},
    {"chunk_points",
     &Tuning::chunk_points,
     {1 << 20},
     {1 << 24},
     {1 << 20},
     "Chunks of 2^20 points took 0.8 of the time of those of 2^22 on two cores, whose caches are small, and "
     "0.9 of "
     "that of those of 2^18; they hand on 0.4 % of uniform points. A GPU needs many to be busy."},
    {"round_points",
     &Tuning::round_points,
     {0},
     {512},
     {0},
     "Two cores merge blocks in less time than rounds take. On a GPU merges end in one work-item, and the "
     "longest merge "
     "of a block decides: 512 have shorter ones than 1024, 256 need a round more."},
    {"samples_per_gap_block",
     &Tuning::samples_per_gap_block,
     {64},
     {64},
     {4},
     "Fewer do not show the gaps between the points along old cuts."},
    {"merge_from_percent",
     &Tuning::merge_from_percent,
     {50},
     {50},
     {50},
     "Uniform points leave 28 % of the first round, in parts of 512, and 11 % of the second; points on a "
     "circle leave all."},
    {"in_host_memory",
     &Tuning::in_host_memory,
     {1},
     {0},
     {0},
     "A CPU's kernels need no copies of the caller's memory."},
    {"staging_bytes",
     &Tuning::staging_bytes,
     {0},
     {std::size_t{1} << 22},
     {3000},
     "A GPU copies several times faster from and to pinned memory. Larger chunks would begin later, smaller "
     "ones would wake up the threads that copy more often; 4 of them are kept."},
    {"separate_buffers",
     &Tuning::separate_buffers,
     {0},
     {2},
     {1},
     "1 shows a simulator every access beyond an array. 2 are used again: with parts of one buffer, NVIDIA's "
     "driver takes 8 times as long for a call on a million points."},
    {"depth_rounds",
     &Tuning::depth_rounds,
     {2},
     {16},
     {1},
     "A GPU's launch that does nothing costs less than a wait. Few domains are more than 3 deep."},
    {"fixed_point_from",
     &Tuning::fixed_point_from,
     {0},
     {kSlowFp64},
     {0},
     "GPUs have 1/2 of fp32's rate, or 1/16 to 1/64. By the model, fixed point takes 1.03 of the time at "
     "1/16, 0.94 at 1/32 and 0.77 at 1/64."},
    {"small_region",
     &Tuning::small_region,
     {kSmallRegion},
     {kSmallRegion},
     {kSmallRegion},
     "What a work-item keeps in private memory; larger regions are rare."},
    {"block_points",
     &Tuning::block_points,
     {2048},
     {2048},
     {2048},
     "With what its solution needs, a block stays in a core's second-level cache."},
    {"region_points",
     &Tuning::region_points,
     {4096},
     {4096},
     {4096},
     "A level more takes longer than blocks of twice the size, whose borders are a smaller part of them."},
    {"samples_per_block",
     &Tuning::samples_per_block,
     {16},
     {16},
     {16},
     "The largest of so many blocks holds less than twice its share of the points, as a rule."},
    {"inserted_percent",
     &Tuning::inserted_percent,
     {10},
     {10},
     {10},
     "On one thread a point takes 4 us, and 0.5 in a call on all points."},
    {"removed_percent",
     &Tuning::removed_percent,
     {12},
     {12},
     {12},
     "On one thread a point takes 3 us, and 0.5 in a call on all points."},
    {"moved_percent",
     &Tuning::moved_percent,
     {6},
     {6},
     {6},
     "On one thread a point whose edges change takes up to 7 us, and 0.5 in a call on all points."},
};

struct CapabilityRow {
  const char* name;
  bool host::Capabilities::*member;
  bool cpu, gpu, small;
  const char* reason;
};

constexpr CapabilityRow kCapabilities[] = {
    {"atomic_reads", &host::Capabilities::atomic_reads, false, true, true,
     "Caches of CPUs are coherent. Other groups' values are read by atomic operations where they may not "
     "be."},
    {"split_products", &host::Capabilities::split_products, false, false, false,
     "17 operations in place of 2; the self-test sets it for a device whose fma rounds twice."},
    {"fixed_point", &host::Capabilities::fixed_point, false, false, false,
     "Set for devices without fp64, and by its rate where that is measured (fixed_point_from)."},
    {"loops_end_early", &host::Capabilities::loops_end_early, false, false, false,
     "Set by the self-test, for Mesa's llvmpipe; calls are limited to few points."},
};

// Columns of the tables.
struct Column {
  Amount Row::*size;
  bool CapabilityRow::*capability;
};
constexpr Column kCpu{&Row::cpu, &CapabilityRow::cpu}, kGpu{&Row::gpu, &CapabilityRow::gpu},
    kSmall{&Row::small, &CapabilityRow::small};

// Devices that their kind's column does not suit, by a part of their name; tuning: as FLAUNAY_TUNING has it.
struct NamedDevice {
  const char* name;
  const char* tuning;
  const char* reason;
};
constexpr NamedDevice kNamedDevices[] = {
    {"Oclgrind", "gpu:32",
     "A simulated work-item takes as long if it is idle as if it works; a warp shows all races."},
    {"llvmpipe", "gpu,star_points=0,sewing_group=8,off_grid_most=0",
     "Its loops end after 65535 turns, so that work-items must have little to do; it cannot compile "
     "__builtin_prefetch, may refuse to unmap what it mapped, crashes when larger groups sew, and goes "
     "nowhere from a vertex to one that is nearer to a query off the grid."},
};

constexpr std::size_t kPointsOfASmallBlock = 6;

[[noreturn]] void throw_unknown(const std::string& given) {
  throw DeviceError(
      fmt::format("FLAUNAY_TUNING is '{}'; it can be cpu, gpu, gpu:N with groups of N work-items (1 to {}), "
                  "small, or small-blocks, and values by name such as block_group=64, separated by commas",
                  given, kLargestGroup));
}

// The facts about a device on which the table depends.
struct Target {
  std::string name;
  bool is_cpu;
  std::size_t units;
};

KindOfDevice values_of(const Column& column, const Target& target) {
  const std::size_t units = std::max<std::size_t>(1, target.units);
  KindOfDevice kind;
  for (const Row& row : kTable) {
    const Amount& amount = row.*column.size;
    kind.tuning.*row.member = amount.is_per_unit ? amount.number * units : amount.number;
  }
  for (const CapabilityRow& row : kCapabilities) kind.capabilities.*row.member = row.*column.capability;
  return kind;
}

// Reads a positive number, which is at most `most`.
std::optional<std::size_t> number_of(const std::string& digits, std::size_t most) {
  constexpr std::size_t kMostDigits = 10;
  if (digits.empty() || digits.size() > kMostDigits ||
      digits.find_first_not_of("0123456789") != std::string::npos) {
    return {};
  }
  const std::size_t number = std::stoul(digits);
  return number <= most ? std::optional(number) : std::nullopt;
}

std::optional<KindOfDevice> kind_named(const std::string& name, const Target& target) {
  if (name == "cpu") return values_of(kCpu, target);
  if (name == "gpu") return values_of(kGpu, target);
  if (name == "small") return values_of(kSmall, target);
  if (name == "small-blocks") {
    KindOfDevice kind = values_of(kSmall, target);
    kind.tuning.block_points = kind.tuning.region_points = kPointsOfASmallBlock;
    return kind;
  }
  const std::string prefix = "gpu:";
  if (name.compare(0, prefix.size(), prefix) != 0) return {};
  const auto group = number_of(name.substr(prefix.size()), kLargestGroup);
  if (!group || *group == 0) return {};
  KindOfDevice kind = values_of(kGpu, target);
  Tuning& tuning = kind.tuning;
  tuning.map_group = tuning.private_group = tuning.chunk_group = tuning.sort_group = tuning.block_group =
      tuning.halve_group = tuning.sewing_group = *group;
  tuning.tile_group = std::min<std::size_t>(*group, kernel::LARGEST_TILE_GROUP);
  return kind;
}

// Reads "name=value" with a name of the tables; returns false if it is something else.
bool override_value(KindOfDevice& kind, const std::string& part) {
  const std::size_t equals = part.find('=');
  if (equals == std::string::npos) return false;
  const auto number = number_of(part.substr(equals + 1), kLargestValue);
  if (!number) return false;
  const auto is_named = [&](const auto& row) { return part.compare(0, equals, row.name) == 0; };
  const auto row = std::find_if(std::begin(kTable), std::end(kTable), is_named);
  if (row != std::end(kTable)) {
    kind.tuning.*row->member = *number;
    return true;
  }
  const auto capability = std::find_if(std::begin(kCapabilities), std::end(kCapabilities), is_named);
  if (capability == std::end(kCapabilities)) return false;
  kind.capabilities.*capability->member = *number != 0;
  // A choice by hand needs no measurement.
  if (capability->member == &host::Capabilities::fixed_point) kind.tuning.fixed_point_from = 0;
  return true;
}

std::vector<std::string> parts_of(const std::string& list) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    parts.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

// given: in the form of FLAUNAY_TUNING; values that it does not set are as in `kind`.
KindOfDevice overridden(KindOfDevice kind, const std::string& given, const Target& target) {
  if (given.empty()) return kind;
  bool is_first = true;
  for (const std::string& part : parts_of(given)) {
    const auto named = is_first ? kind_named(part, target) : std::nullopt;
    if (named) {
      kind = *named;
    } else if (!override_value(kind, part)) {
      throw_unknown(given);
    }
    is_first = false;
  }
  return kind;
}

// The tuning values for the target's name; empty if its name is not listed.
std::string tuning_by_name(const Target& target) {
  for (const NamedDevice& named : kNamedDevices) {
    if (target.name.find(named.name) != std::string::npos) return named.tuning;
  }
  return "";
}

KindOfDevice kind_of_target(const Target& target, const std::string& given) {
  const KindOfDevice own =
      overridden(values_of(target.is_cpu ? kCpu : kGpu, target), tuning_by_name(target), target);
  return overridden(own, given, target);
}

// Reduces sizes so that kernels have enough local memory.
void fit_tiles(Tuning& tuning) {
  const auto fit = [](std::size_t& size, std::size_t most) { size = std::clamp<std::size_t>(size, 1, most); };
  const std::size_t samples = tuning.local_bytes / kernel::LOCAL_BYTES_PER_SAMPLE;
  fit(tuning.point_tile, tuning.local_bytes / kernel::LOCAL_BYTES_PER_POINT);
  fit(tuning.sample_tile, samples);
  fit(tuning.samples_per_gap_block, samples);
  fit(tuning.block_bits, kernel::MOST_BLOCK_BITS);
  fit(tuning.sewing_group, kernel::LARGEST_TILE_GROUP);
  // Parts have LEAF_VERTICES times a power of two.
  tuning.local_vertices =
      std::min<std::size_t>(std::bit_floor(tuning.local_vertices), kernel::LOCAL_VERTICES);
}

}  // namespace

std::string Tuning::build_options() const {
  return fmt::format("{} -DSMALL_REGION={} -DFETCH_AHEAD={}", Sizes::build_options(), small_region,
                     fetch_ahead);
}

std::string tuning_in_environment() {
  const char* const given = std::getenv("FLAUNAY_TUNING");
  return given != nullptr ? given : "";
}

KindOfDevice kind_of_device(const std::string& name, cl_device_type type, std::size_t units,
                            const std::string& given) {
  // Simulators may be of several types.
  const bool is_cpu = (type & CL_DEVICE_TYPE_CPU) != 0 && (type & CL_DEVICE_TYPE_GPU) == 0;
  return kind_of_target({name, is_cpu, units}, given);
}

host::Settings settings_for(const boost::compute::device& device, const std::string& given) {
  KindOfDevice kind = kind_of_device(device.name(), device.type(), device.compute_units(), given);
  Tuning& tuning = kind.tuning;
  const host::DeviceLimits limits = host::limits_of(device);
  host::fit(tuning, limits);
  fit_tiles(tuning);
  if (limits.local_memory < kernel::LOCAL_PART_BYTES) tuning.local_vertices = 0;
  if (limits.local_memory < tuning.local_bytes) tuning.blocks_in_parallel = 0;
  if (given.empty() && host::shares_host_memory(device)) tuning.staging_bytes = 0;
  if (!host::has_fp64(device)) {
    kind.capabilities.fixed_point = true;
    tuning.fixed_point_from = 0;
  }
  for (std::size_t* group : {&tuning.block_group, &tuning.halve_group, &tuning.sewing_group}) {
    *group = std::clamp<std::size_t>(*group, 1, std::clamp<std::size_t>(limits.work_group, 1, kLargestGroup));
  }
  return {std::make_shared<Tuning>(tuning), kind.capabilities};
}

std::shared_ptr<const Tuning> native_tuning(const std::string& given) {
  const Target host{host::kHostName, true, host::native_threads()};
  auto tuning = std::make_shared<Tuning>(kind_of_target(host, given).tuning);
  // Sizes for which native kernels were compiled cannot be changed. Native kernels always work in host
  // memory, on whole blocks.
  const Tuning compiled = values_of(kCpu, host).tuning;
  tuning->sort_bits = compiled.sort_bits;
  tuning->sort_group = compiled.sort_group;
  tuning->fetch_ahead = compiled.fetch_ahead;
  tuning->tile_group = compiled.tile_group;
  tuning->in_host_memory = 1;
  tuning->blocks_in_parallel = 0;
  return tuning;
}

}  // namespace flaunay
