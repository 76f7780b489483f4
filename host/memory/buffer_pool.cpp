#include "host/memory/buffer_pool.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include "host/error.hpp"

namespace flaunay::host {
namespace {

// Drivers give no less to a buffer.
constexpr std::size_t kSmallest = std::size_t{1} << 16;
// Sizes are rounded up in steps of at least such a share of them, and of less than twice that: similar ones
// are the same.
constexpr std::size_t kSteps = 8;
// A buffer serves arrays that need at least half of it.
constexpr std::size_t kMostSpare = 2;
// The pool holds at most this many times the bytes that were in use at once.
constexpr std::size_t kMostHeld = 2;

std::size_t rounded_up(std::size_t bytes) {
  std::size_t step = kSmallest;
  while (step < bytes / kSteps) step *= 2;
  return (bytes + step - 1) / step * step;
}

}  // namespace

std::shared_ptr<_cl_mem> BufferPool::take(std::size_t bytes, std::size_t largest) {
  const std::size_t wanted = std::max(bytes, std::min(rounded_up(std::max<std::size_t>(bytes, 1)), largest));
  std::size_t size = wanted;
  std::shared_ptr<_cl_mem> memory;
  std::unique_lock lock(mutex_);
  const auto found = idle_.lower_bound(wanted);
  if (found != idle_.end() && found->first / kMostSpare <= wanted) {
    size = found->first;
    memory = std::move(found->second);
    idle_.erase(found);
  } else {
    // Sizes that nobody asks for any more would otherwise stay.
    const std::size_t most = kMostHeld * std::max(most_in_use_, in_use_ + wanted);
    while (!idle_.empty() && bytes_ + wanted > most) drop_one();
    memory = make(wanted);
    bytes_ += wanted;
    ++made_;
  }
  in_use_ += size;
  most_in_use_ = std::max(most_in_use_, in_use_);
  // If there is no memory for the pointer, the buffer is given back at once.
  lock.unlock();
  _cl_mem* const handle = memory.get();
  return {handle, [pool = shared_from_this(), owned = std::move(memory), size](cl_mem) mutable {
            pool->give_back(std::move(owned), size);
          }};
}

std::shared_ptr<_cl_mem> BufferPool::make(std::size_t bytes) {
  try {
    return make_(bytes);
  } catch (const DeviceError&) {
    if (idle_.empty()) throw;
  }
  while (!idle_.empty()) drop_one();
  return make_(bytes);
}

void BufferPool::give_back(std::shared_ptr<_cl_mem> memory, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  in_use_ -= bytes;
  try {
    idle_.emplace(bytes, std::move(memory));
  } catch (const std::bad_alloc&) {
    bytes_ -= bytes;
  }
}

void BufferPool::drop_one() {
  const auto largest = std::prev(idle_.end());
  bytes_ -= largest->first;
  idle_.erase(largest);
}

std::size_t BufferPool::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

std::size_t BufferPool::made() const {
  const std::lock_guard lock(mutex_);
  return made_;
}

}  // namespace flaunay::host
