// Large transfers through pinned memory: sizes around chunks, several at once, errors between, threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <boost/compute/command_queue.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "host/error.hpp"
#include "tests/host/support.hpp"

namespace flaunay::host {
namespace {

constexpr std::size_t kChunk = 4096;

std::unique_ptr<Runtime> staged(std::size_t separate_buffers = 2) {
  const auto device = find_device("");
  auto tuning = std::make_shared<Tuning>(tuning_named("gpu"));
  tuning->staging_bytes = kChunk;
  tuning->separate_buffers = separate_buffers;
  return std::make_unique<Runtime>(device, Settings{std::move(tuning), settings_for(device).capabilities});
}

std::vector<cl_uchar> numbers(std::size_t count, std::size_t first) {
  std::vector<cl_uchar> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<cl_uchar>((first + i) * 2654435761u >> 13);
  return values;
}

// Writes parts of an array that are as long as the sizes say, reads each back while the next one is written,
// and compares. Parts lie at the same places of arrays of the host: with odd gaps at unaligned addresses.
void expect_round_trips(Runtime& runtime, const std::vector<std::size_t>& sizes, std::size_t gap) {
  const Arena::Scope scope(runtime.arena());
  const std::size_t all = std::accumulate(sizes.begin(), sizes.end(), gap * (sizes.size() + 1));
  const auto array = runtime.arena().allocate<cl_uchar>(all);
  const std::vector<cl_uchar> given = numbers(all, gap);
  std::vector<cl_uchar> expected(all, 7), found(all, 7), whole(all);
  runtime.fill(array, all, cl_uchar{7});
  const Runtime::Settled settled(runtime);
  std::size_t first = gap, before = 0, size_before = 0;
  for (const std::size_t size : sizes) {
    std::copy_n(given.begin() + first, size, expected.begin() + first);
    runtime.write_later(array, first, size, given.data() + first);
    runtime.read_later(array, before, size_before, found.data() + before);
    before = first;
    size_before = size;
    first += size + gap;
  }
  runtime.read_later(array, before, size_before, found.data() + before);
  runtime.read(array, 0, all, whole.data());
  expect_same(found, expected, "each part");
  expect_same(whole, expected, "all parts");
}

TEST(SmallStaging, SizesAroundChunks) {
  for (const std::size_t separate_buffers : {0, 1, 2}) {
    SCOPED_TRACE(separate_buffers);
    const auto runtime = staged(separate_buffers);
    for (const std::size_t chunks : {0, 1, 3, 4, 5, 11}) {
      const std::size_t size = chunks * kChunk;
      expect_round_trips(*runtime, {size + 1}, 0);
      expect_round_trips(*runtime, {size + kChunk / 4 - 1, size + kChunk - 1, size + kChunk, 3, size + 1}, 5);
    }
  }
}

TEST(SmallStaging, EveryWaitBringsWhatWasRead) {
  const auto runtime = staged();
  const auto values = numbers(5 * kChunk + 3, 1);
  const auto array = upload(*runtime, values);
  const auto one = upload(*runtime, std::vector<cl_int>{4});
  const auto finish = [&] { runtime->finish(); };
  const auto read = [&] { EXPECT_EQ(runtime->read_one(one, 0), 4); };
  const auto await = [&] {
    const cl_event event = runtime->mark();
    runtime->await(event);
    clReleaseEvent(event);
  };
  for (const auto& wait : std::vector<std::function<void()>>{finish, read, await}) {
    std::vector<cl_uchar> found(values.size());
    runtime->read_later(array, 0, found.size(), found.data());
    wait();
    expect_same(found, values, "values");
  }
}

TEST(SmallStaging, QueuesInAnyOrder) {
  const auto runtime = staged();
  const boost::compute::command_queue unordered(runtime->context(), runtime->device(),
                                                CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
  for (const cl_command_queue queue : {unordered.get(), cl_command_queue{}}) {
    runtime->use_queue(queue, false);
    expect_round_trips(*runtime, {9 * kChunk + 1, kChunk, 2 * kChunk - 1}, 3);
  }
}

// Behind commands that have not begun, as many chunks are written as there are without waiting for any.
TEST(SmallStaging, WritesWaitForChunksAlone) {
  const auto runtime = staged(1);
  const boost::compute::command_queue queue(runtime->context(), runtime->device());
  const auto values = numbers(9 * kChunk + 1, 1);
  std::vector<cl_uchar> found(values.size());
  const auto array = runtime->arena().allocate<cl_uchar>(values.size());
  cl_int code = CL_SUCCESS;
  const cl_event ready = clCreateUserEvent(runtime->context().get(), &code);
  check_call(code, "clCreateUserEvent");
  runtime->use_queue(queue.get(), false);
  runtime->wait_for({ready});
  runtime->write_later(array, 0, 4 * kChunk, values.data());
  std::atomic<bool> is_ready{false};
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    is_ready = true;
    clSetUserEventStatus(ready, CL_COMPLETE);
  });
  runtime->write_later(array, 4 * kChunk, values.size() - 4 * kChunk, values.data() + 4 * kChunk);
  EXPECT_TRUE(is_ready);
  runtime->read(array, 0, found.size(), found.data());
  expect_same(found, values, "values");
  other.join();
  clReleaseEvent(ready);
}

// After an error, nothing goes to where earlier reads should have gone.
TEST(SmallStaging, ErrorsBetweenChunks) {
  const auto runtime = staged(1);
  const std::size_t there = 3 * kChunk;
  const auto array = runtime->arena().allocate<cl_uchar>(there);
  runtime->fill(array, there, cl_uchar{1});
  const std::vector<cl_uchar> untouched(9 * kChunk, 9);
  std::vector<cl_uchar> values(untouched.size());
  for (const bool waits : {false, true}) {
    message_of(
        [&] {
          if (waits) return runtime->read(array, 0, values.size(), values.data());
          runtime->read_later(array, 0, values.size(), values.data());
        },
        CL_INVALID_VALUE);
    values = untouched;
    expect_round_trips(*runtime, {9 * kChunk + 1, kChunk}, 3);
    expect_same(values, untouched, "values after an error");
    message_of([&] { runtime->write(array, 0, values.size(), values.data()); }, CL_INVALID_VALUE);
    expect_round_trips(*runtime, {9 * kChunk + 1, kChunk}, 3);
  }
  try {
    std::vector<cl_uchar> gone(there);
    const Runtime::Settled settled(*runtime);
    runtime->read_later(array, 0, there, gone.data());
    throw std::runtime_error("between");
  } catch (const std::runtime_error&) {
  }
  expect_round_trips(*runtime, {9 * kChunk + 1, kChunk}, 3);
}

TEST(SmallStaging, EachRuntimeHasItsOwn) {
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < 3; ++k) {
    threads.emplace_back([k] {
      const auto runtime = staged(k);
      for (int round = 0; round < 20; ++round) expect_round_trips(*runtime, {7 * kChunk + k, kChunk}, k);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST(SmallStaging, ChunksOfAnotherSizeFollow) {
  const auto runtime = staged();
  for (const std::size_t bytes : {std::size_t{100}, std::size_t{0}, 3 * kChunk}) {
    std::vector<cl_uchar> found(kChunk);
    const auto values = numbers(kChunk, 3);
    const auto array = upload(*runtime, values);
    runtime->read_later(array, 0, found.size(), found.data());
    auto tuning = std::make_shared<Tuning>(runtime->sizes().tuning());
    tuning->staging_bytes = bytes;
    runtime->set_sizes(std::move(tuning));
    expect_round_trips(*runtime, {9 * kChunk + 1, kChunk}, 3);
    expect_same(found, values, "values of before");
  }
}

}  // namespace
}  // namespace flaunay::host
