// The arena: device memory by scopes.
#include "host/memory/arena.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "host/error.hpp"
#include "tests/host/support.hpp"

namespace flaunay::host {
namespace {

struct Place {
  cl_mem block;
  std::size_t begin, end;
};

template <typename T>
Place place_of(const Buffer<T>& buffer) {
  Place place{};
  std::size_t size = 0;
  FLAUNAY_CL(clGetMemObjectInfo(buffer.memory(), CL_MEM_ASSOCIATED_MEMOBJECT, sizeof place.block,
                                &place.block, nullptr));
  FLAUNAY_CL(clGetMemObjectInfo(buffer.memory(), CL_MEM_OFFSET, sizeof place.begin, &place.begin, nullptr));
  FLAUNAY_CL(clGetMemObjectInfo(buffer.memory(), CL_MEM_SIZE, sizeof size, &size, nullptr));
  place.end = place.begin + size;
  return place;
}

class SmallArena : public ::testing::Test {
 protected:
  SmallArena() : runtime_(find_device(""), settings_for(find_device(""))) {}
  MemorySource memory_for(ArrayMemory arrays) const {
    MemorySource source = runtime_.memory();
    source.arrays = arrays;
    return source;
  }

  Runtime runtime_;
  Arena arena_{memory_for(ArrayMemory::parts)};
};

TEST_F(SmallArena, UsesBuffersAgain) {
  Arena arena(memory_for(ArrayMemory::reused));
  const auto work = [&](std::size_t size) {
    const Arena::Scope scope(arena);
    std::vector<Buffer<cl_uint>> buffers;
    for (cl_uint k = 0; k < 8; ++k) {
      buffers.push_back(arena.allocate<cl_uint>(k * size));
      runtime_.fill(buffers.back(), buffers.back().size(), k);
      for (cl_uint j = 0; j < k; ++j) EXPECT_NE(buffers[j].memory(), buffers[k].memory());
    }
    for (cl_uint k = 0; k < 8; ++k) {
      std::vector<cl_uint> values(buffers[k].size());
      runtime_.read(buffers[k], 0, values.size(), values.data());
      EXPECT_EQ(values, std::vector<cl_uint>(values.size(), k));
    }
  };
  work(100000);
  const std::size_t made = arena.block_allocations(), held = arena.held_bytes();
  EXPECT_EQ(made, 8u);
  EXPECT_GE(held, 28 * 400000u);
  EXPECT_LE(held, 28 * 450000u + (8u << 16));
  const std::size_t peak = arena.peak_bytes();
  EXPECT_GE(peak, 28 * 400000u);
  work(100000);
  work(99000);
  EXPECT_EQ(arena.block_allocations(), made);
  EXPECT_EQ(arena.held_bytes(), held);
  EXPECT_EQ(arena.peak_bytes(), peak);
  // Buffers that are too large for what is asked for are not kept without end.
  for (std::size_t size = 60000; size > 100; size = size * 9 / 10) work(size);
  EXPECT_LE(arena.held_bytes(), 2 * held);
}

TEST_F(SmallArena, HoldsTwiceWhatWasInUseAtOnce) {
  Arena arena(memory_for(ArrayMemory::reused));
  constexpr std::size_t kUnit = std::size_t{1} << 20;
  const auto use = [&](const std::vector<std::size_t>& sizes) {
    const Arena::Scope scope(arena);
    std::vector<Buffer<cl_uchar>> buffers;
    for (const std::size_t size : sizes) buffers.push_back(arena.allocate<cl_uchar>(size * kUnit));
  };
  use({2, 2, 2, 2});
  for (const std::size_t size : {3, 4, 5, 6, 7}) use({size});
  EXPECT_LE(arena.held_bytes(), 16 * kUnit);
}

TEST_F(SmallArena, LentMemoryMayEndBeforeItsFirstBuffer) {
  arena_.lend(allocate_memory(runtime_.memory(), 4096), 1, 2);
  EXPECT_THROW(arena_.allocate<cl_uint>(1), DeviceError);
  arena_.lend(nullptr, 0, 0);
}

TEST_F(SmallArena, ReusedBuffersOutliveTheirArena) {
  Buffer<cl_uint> kept;
  {
    Arena arena(memory_for(ArrayMemory::reused));
    kept = arena.allocate<cl_uint>(1000);
  }
  runtime_.fill(kept, 1000, cl_uint{7});
  EXPECT_EQ(runtime_.read_one(kept, 999), 7u);
}

TEST_F(SmallArena, GivesAlignedBuffersThatDoNotOverlap) {
  const std::size_t base = runtime_.device().get_info<cl_uint>(CL_DEVICE_MEM_BASE_ADDR_ALIGN) / 8;
  const std::size_t sizes[] = {1, 0, 127, 128, 129, 1000, 3, 0, 2000000, 5, 4000001, 1};
  std::vector<Place> places;
  for (const std::size_t size : sizes) {
    const auto buffer = arena_.allocate<cl_uchar>(size);
    EXPECT_EQ(buffer.size(), size);
    const Place place = place_of(buffer);
    EXPECT_GE(place.end - place.begin, std::max<std::size_t>(size, 1));
    EXPECT_EQ(place.begin % std::max<std::size_t>(base, 128), 0u);
    for (const Place& other : places) {
      EXPECT_TRUE(place.block != other.block || place.begin >= other.end || other.begin >= place.end);
    }
    places.push_back(place);
  }
}

TEST_F(SmallArena, GivesMemoryThatHoldsItsContents) {
  std::vector<Buffer<cl_uint>> buffers;
  for (cl_uint k = 0; k < 12; ++k) {
    buffers.push_back(arena_.allocate<cl_uint>(10 + k * 10000));
    runtime_.fill(buffers.back(), buffers.back().size(), k);
  }
  for (cl_uint k = 0; k < 12; ++k) {
    std::vector<cl_uint> values(buffers[k].size());
    runtime_.read(buffers[k], 0, values.size(), values.data());
    EXPECT_EQ(values, std::vector<cl_uint>(values.size(), k));
  }
}

TEST_F(SmallArena, ReleasesByScopes) {
  const auto outer = arena_.allocate<cl_int>(10);
  Place first{};
  {
    const Arena::Scope scope(arena_);
    first = place_of(arena_.allocate<cl_int>(100));
    {
      const Arena::Scope inner(arena_);
      EXPECT_GE(place_of(arena_.allocate<cl_int>(7)).begin, first.end);
    }
    // What the inner scope had is free, what the outer one has is not.
    EXPECT_EQ(place_of(arena_.allocate<cl_int>(9)).begin, first.end);
  }
  const Place again = place_of(arena_.allocate<cl_int>(3));
  EXPECT_EQ(again.block, first.block);
  EXPECT_EQ(again.begin, first.begin);
  EXPECT_GE(again.begin, place_of(outer).end);
}

TEST_F(SmallArena, GrowsByBlocksAndKeepsThem) {
  const auto work = [&] {
    const Arena::Scope scope(arena_);
    arena_.allocate<cl_uchar>(1000);
    const Arena::Scope inner(arena_);
    arena_.allocate<cl_uchar>(3000000);
    arena_.allocate<cl_uchar>(9000000);
    arena_.allocate<cl_uchar>(100);
  };
  EXPECT_EQ(arena_.held_bytes(), 0u);
  work();
  const std::size_t blocks = arena_.block_allocations();
  const std::size_t held = arena_.held_bytes();
  EXPECT_GE(blocks, 2u);
  EXPECT_LE(blocks, 4u);
  EXPECT_GE(held, 12000000u);
  for (int k = 0; k < 3; ++k) work();
  EXPECT_EQ(arena_.block_allocations(), blocks);
  EXPECT_EQ(arena_.held_bytes(), held);
}

TEST_F(SmallArena, MakesFewBlocksForManySmallBuffers) {
  for (int k = 0; k < 3000; ++k) arena_.allocate<cl_uchar>(10000);
  EXPECT_GE(arena_.held_bytes(), 30000000u);
  EXPECT_LE(arena_.held_bytes(), 60000000u);  // not much in vain
  EXPECT_LE(arena_.block_allocations(), 25u);
}

TEST_F(SmallArena, ReservesOneBlock) {
  arena_.reserve(20000000);
  EXPECT_GE(arena_.held_bytes(), 20000000u);
  EXPECT_EQ(arena_.block_allocations(), 1u);
  arena_.reserve(10000000);  // is there already
  EXPECT_EQ(arena_.block_allocations(), 1u);
  {
    const Arena::Scope scope(arena_);
    const Place a = place_of(arena_.allocate<cl_uchar>(9000000));
    const Place b = place_of(arena_.allocate<cl_uchar>(9000000));
    EXPECT_EQ(a.block, b.block);
    EXPECT_EQ(arena_.block_allocations(), 1u);
    arena_.reserve(40000000);  // too late: something is allocated
    EXPECT_EQ(arena_.block_allocations(), 1u);
  }
  arena_.reserve(40000000);
  EXPECT_EQ(arena_.block_allocations(), 2u);
  EXPECT_GE(arena_.held_bytes(), 40000000u);
  EXPECT_LT(arena_.held_bytes(), 60000000u);  // instead of the smaller one
}

TEST_F(SmallArena, KnowsItsPeak) {
  arena_.reserve(4000000);
  EXPECT_EQ(arena_.peak_bytes(), 0u);
  {
    const Arena::Scope scope(arena_);
    arena_.allocate<cl_uchar>(1 << 20);
    arena_.allocate<cl_uchar>(1 << 19);
    EXPECT_EQ(arena_.peak_bytes(), 3u << 19);
  }
  const Arena::Scope scope(arena_);
  arena_.allocate<cl_uchar>(1 << 18);
  EXPECT_EQ(arena_.peak_bytes(), 3u << 19);
  arena_.reset_peak();
  EXPECT_EQ(arena_.peak_bytes(), 0u);
  arena_.allocate<cl_uchar>(1 << 17);
  EXPECT_EQ(arena_.peak_bytes(), 3u << 17);  // with what was there before
  arena_.allocate<cl_uchar>(8 << 20);        // in another block
  EXPECT_GE(arena_.peak_bytes(), (3u << 17) + (8u << 20));
  EXPECT_LE(arena_.peak_bytes(), arena_.held_bytes());
}

TEST_F(SmallArena, SaysWhatIsTooLarge) {
  const std::size_t largest = runtime_.device().max_memory_alloc_size();
  const std::size_t wanted = largest / 4096 * 4096 + 4096;
  const std::string message = message_of([&] { arena_.allocate<cl_uchar>(wanted); }, CL_INVALID_BUFFER_SIZE);
  EXPECT_TRUE(contains(message, std::to_string(wanted))) << message;
  EXPECT_TRUE(contains(message, std::to_string(largest))) << message;
  EXPECT_EQ(arena_.block_allocations(), 0u);
  // And goes on.
  const auto buffer = arena_.allocate<cl_int>(1);
  const cl_int value = 5;
  runtime_.write(buffer, 0, 1, &value);
  EXPECT_EQ(runtime_.read_one(buffer, 0), 5);
}

}  // namespace
}  // namespace flaunay::host
