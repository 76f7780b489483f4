// Tuning: by device, by the environment, and as a device allows.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "blocks/limits.h"
#include "host/launch/vector_operations.hpp"
#include "operations/limits.h"
#include "points/limits.h"
#include "tests/host/support.hpp"

namespace flaunay::host {
namespace {

TEST(SmallTuning, IsNamedByTheEnvironment) {
  const auto device = find_device("");
  EXPECT_NE(tuning_named("small").map_group, tuning_named("gpu").map_group);
  EXPECT_NE(tuning_named("cpu").chunk_group, tuning_named("gpu").chunk_group);
  {
    const ScopedEnvironment unset("FLAUNAY_TUNING", nullptr);
    const bool is_simulator = device.name().find("Oclgrind") != std::string::npos;
    const bool cpu = (device.type() & CL_DEVICE_TYPE_CPU) != 0;
    const char* const kind = is_simulator ? "gpu:32" : cpu ? "cpu" : "gpu";
    EXPECT_EQ(settings_for(device).sizes->map_group, tuning_named(kind).map_group);
  }
  for (const char* const name : {"fast", "gpu:", "gpu:0", "gpu:1025", "gpu:x", "gpu:-1", "gpu:32 ",
                                 "gpu:032x", "gpu:99999999999999999999", "cpu:32", "GPU"}) {
    const ScopedEnvironment wrong("FLAUNAY_TUNING", name);
    const std::string message = message_of([&] { settings_for(device); }, CL_SUCCESS);
    EXPECT_TRUE(contains(message, std::string("'") + name + "'")) << message;
  }
}

// Kernels halve parts that local memory holds down to leaves.
TEST(SmallTuning, PartsHaveAPowerOfTwoOfVertices) {
  const auto device = find_device("");
  const bool has_room = limits_of(device).local_memory >= kernel::LOCAL_PART_BYTES;
  for (const auto& [given, vertices] : {std::pair{"511", 256u}, {"300", 256u}, {"1000", 512u}, {"0", 0u}}) {
    const Settings settings = settings_for(device, std::string("gpu,local_vertices=") + given);
    EXPECT_EQ(settings.sizes->tuning().local_vertices, has_room ? vertices : 0u) << given;
  }
}

TEST(SmallTuning, DependsOnTypeAndName) {
  constexpr cl_device_type kCpu = CL_DEVICE_TYPE_CPU, kGpu = CL_DEVICE_TYPE_GPU;
  const auto tuning_of = [](const char* name, cl_device_type type) {
    return kind_of_device(name, type, 4).tuning;
  };
  {
    const ScopedEnvironment unset("FLAUNAY_TUNING", nullptr);
    EXPECT_EQ(tuning_of("a", kCpu).chunk_group, 1u);
    EXPECT_GT(tuning_of("a", kCpu).fetch_ahead, 0u);
    EXPECT_EQ(tuning_of("a", kCpu).in_host_memory, 1u);
    // Devices that are both, as simulators say, are none of a CPU's cores.
    for (const cl_device_type type : {kGpu, kCpu | kGpu, cl_device_type{CL_DEVICE_TYPE_ACCELERATOR}}) {
      EXPECT_EQ(tuning_of("a", type).chunk_group, 64u) << type;
      EXPECT_EQ(tuning_of("a", type).fetch_ahead, 0u) << type;
      EXPECT_EQ(tuning_of("a", type).in_host_memory, 0u) << type;
    }
    for (const cl_device_type type : {kCpu, kCpu | kGpu}) {
      const Tuning simulator = tuning_of("Oclgrind Simulator", type);
      EXPECT_EQ(simulator.chunk_group, 32u);
      EXPECT_EQ(simulator.tile_group, 32u);
      EXPECT_EQ(simulator.fetch_ahead, 0u);
    }
  }
  const ScopedEnvironment variable("FLAUNAY_TUNING", "block_points=7");
  EXPECT_EQ(tuning_of("Oclgrind Simulator", kCpu | kGpu).block_points, 7u);
  EXPECT_EQ(tuning_of("Oclgrind Simulator", kCpu | kGpu).chunk_group, 32u) << "the rest stays as by name";
  const ScopedEnvironment other("FLAUNAY_TUNING", "cpu");
  EXPECT_EQ(tuning_of("Oclgrind Simulator", kCpu | kGpu).chunk_group, 1u);
}

TEST(SmallTuning, EveryValueCanBeOverridden) {
  const Tuning tuning = tuning_named("gpu,block_group=64,samples_per_block=7,fetch_ahead=0");
  EXPECT_EQ(tuning.block_group, 64u);
  EXPECT_EQ(tuning.samples_per_block, 7u);
  EXPECT_EQ(tuning.block_points, tuning_named("gpu").block_points);
  EXPECT_EQ(tuning_named("chunk_least=77").chunk_least, 77u);
  for (const char* const wrong :
       {"gpu,block_group", "gpu,no_such_value=1", "block_group=x", "block_group=64,gpu", ","}) {
    const ScopedEnvironment variable("FLAUNAY_TUNING", wrong);
    const std::string message = message_of([&] { settings_for(find_device("")); }, CL_SUCCESS);
    EXPECT_TRUE(contains(message, std::string("'") + wrong + "'")) << message;
  }
}

TEST(SmallTuning, FixedPointIsChosenByTheRateOfFp64OrByHand) {
  // Of no device, since those without fp64 have no choice.
  const auto kind_named = [](const char* name) {
    const ScopedEnvironment variable("FLAUNAY_TUNING", name);
    return kind_of_device("a", CL_DEVICE_TYPE_GPU, 4);
  };
  EXPECT_FALSE(kind_named("gpu").capabilities.fixed_point);
  EXPECT_GT(kind_named("gpu").tuning.fixed_point_from, 0u);
  EXPECT_EQ(kind_named("gpu,fixed_point=0").tuning.fixed_point_from, 0u);
  EXPECT_EQ(kind_named("gpu,fixed_point=1").tuning.fixed_point_from, 0u);
  EXPECT_EQ(kind_named("cpu").tuning.fixed_point_from, 0u);
  const auto names_it = [&](const char* name) {
    return kind_named(name).capabilities.build_options().find("-DFIXED_POINT") != std::string::npos;
  };
  EXPECT_FALSE(names_it("gpu"));
  EXPECT_TRUE(names_it("gpu,fixed_point=1"));
}

TEST(SmallTuning, GroupsOfAGivenSize) {
  const std::size_t most = limits_of(find_device("")).work_group;
  for (const std::size_t group : {1, 32, 256}) {
    if (group > most) continue;
    const Tuning tuning = tuning_named("gpu:" + std::to_string(group));
    EXPECT_EQ(tuning.map_group, group);
    EXPECT_EQ(tuning.private_group, group);
    EXPECT_EQ(tuning.chunk_group, group);
    EXPECT_EQ(tuning.sort_group, group);
    EXPECT_EQ(tuning.tile_group, group);
    EXPECT_EQ(tuning.sort_bits, tuning_named("gpu").sort_bits);
  }
}

TEST(SmallTuning, GroupsThatTakeTilesHaveALimit) {
  EXPECT_LE(tuning_named("gpu:1024").tile_group, static_cast<std::size_t>(kernel::LARGEST_TILE_GROUP));
  EXPECT_LE(tuning_named("gpu,tile_group=999").tile_group,
            static_cast<std::size_t>(kernel::LARGEST_TILE_GROUP));
}

TEST(SmallTuning, FitsTheDevice) {
  const std::size_t kilobyte = 1024;
  const auto fitted = [](Tuning tuning, const DeviceLimits& limits) {
    fit(tuning, limits);
    return tuning;
  };
  const Tuning gpu = fitted(tuning_named("gpu"), {1024, 64 * kilobyte});
  Tuning small = fitted(gpu, {64, 64 * kilobyte});
  EXPECT_EQ(small.map_group, 64u);
  EXPECT_EQ(small.private_group, 64u);
  EXPECT_EQ(small.chunk_group, 64u);
  EXPECT_EQ(small.sort_group, 64u);
  EXPECT_EQ(small.tile_group, 64u);
  for (const std::size_t local : {64 * kilobyte, 32 * kilobyte, 32 * kilobyte - 1, 16 * kilobyte}) {
    const Tuning tuning = fitted(gpu, {1024, local});
    EXPECT_EQ(tuning.tile_group, gpu.tile_group);
    EXPECT_EQ(tuning.local_bytes, local < 32 * kilobyte ? 16 * kilobyte : 32 * kilobyte);
    const std::string option = "-DLOCAL_BYTES=" + std::to_string(tuning.local_bytes);
    EXPECT_TRUE(contains(tuning.build_options(), option)) << tuning.build_options();
  }
  EXPECT_EQ(fitted(gpu, {1024, 16 * kilobyte - 1}).tile_group, 0u) << "too little local memory for tiles";
  EXPECT_EQ(fitted(tuning_named("cpu"), {1024, 64 * kilobyte}).tile_group, 0u);
  small = fitted(gpu, {1, 64 * kilobyte});
  EXPECT_EQ(small.map_group, 1u);
  EXPECT_EQ(small.sort_group, 1u);
  // The sort's tables: a counter of 4 bytes for each digit and work-item.
  for (const std::size_t bytes :
       {32 * kilobyte, 4 * kilobyte, 1000 * std::size_t{1}, 64 * std::size_t{1}, 8 * std::size_t{1}}) {
    small = fitted(gpu, {1024, bytes});
    EXPECT_LE(4 * small.sort_group << small.sort_bits, bytes);
    EXPECT_GE(small.sort_bits, 1u);
    EXPECT_GE(small.sort_group, 1u);
    EXPECT_EQ(small.map_group, gpu.map_group);
  }
}

TEST(SmallTuning, SizesOfTilesFitTheKernels) {
  const Tuning most = tuning_named("gpu,point_tile=99999,sample_tile=99999,block_bits=30");
  EXPECT_EQ(most.point_tile, static_cast<std::size_t>(kernel::LARGEST_POINT_TILE));
  EXPECT_EQ(most.sample_tile, static_cast<std::size_t>(kernel::LARGEST_SAMPLE_TILE));
  EXPECT_EQ(most.block_bits, static_cast<std::size_t>(kernel::MOST_BLOCK_BITS));
  const Tuning least = tuning_named("gpu,point_tile=0,sample_tile=0,block_bits=0,scan_items=0,scan_groups=0");
  for (const std::size_t size :
       {least.point_tile, least.sample_tile, least.block_bits, least.scan_items, least.scan_groups}) {
    EXPECT_EQ(size, 1u);
  }
}

TEST(Tuning, AGroupThatAKernelCannotHaveIsAnErrorWithItsName) {
  Runtime runtime(find_device(""), settings_for(find_device("")));
  Tuning tuning = tuning_named("gpu");
  // Tables that are larger than any device's local memory, even for groups of one.
  tuning.sort_bits = 26;
  tuning.sort_group = 2;
  runtime.set_sizes(std::make_shared<Tuning>(tuning));
  const auto keys = upload(runtime, std::vector<cl_ulong>{3, 1, 2});
  const auto payloads = upload(runtime, std::vector<cl_int>{0, 1, 2});
  // Some compilers refuse the kernel, others say that it cannot have a group.
  std::string message;
  try {
    sort_by_key(runtime, keys, payloads, 3);
  } catch (const DeviceError& error) {
    message = error.what();
  }
  EXPECT_TRUE(contains(message, "sort_count")) << message;
}

TEST(SmallTuning, ChunksAreNeitherTooSmallNorTooMany) {
  Tuning tuning = tuning_named("small");
  tuning.chunk_least = 10;
  tuning.chunks_most = 0;
  for (const std::size_t n : {0, 1, 10, 11, 1000}) EXPECT_EQ(tuning.chunk(n), 10u);
  tuning.chunks_most = 4;
  for (std::size_t n = 0; n < 200; ++n) {
    EXPECT_GE(tuning.chunk(n), 10u);
    EXPECT_LE((n + tuning.chunk(n) - 1) / tuning.chunk(n), 4u);
    if (n <= 40) {
      EXPECT_EQ(tuning.chunk(n), 10u);
    }
  }
}

}  // namespace
}  // namespace flaunay::host
