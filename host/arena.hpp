// Device memory: one stack of typed buffers, carved from blocks that live as long as the arena.
#pragma once

#include <CL/cl.h>

#include <boost/compute/context.hpp>
#include <boost/compute/device.hpp>
#include <cstddef>
#include <memory>
#include <vector>

namespace flaunay::host {

/// A run of T in device memory. A handle: copies refer to the same memory.
template <typename T>
class Buffer {
 public:
  Buffer() = default;
  Buffer(std::shared_ptr<_cl_mem> memory, std::size_t size) : memory_(std::move(memory)), size_(size) {}
  cl_mem memory() const { return memory_.get(); }
  std::size_t size() const { return size_; }

 private:
  std::shared_ptr<_cl_mem> memory_;
  std::size_t size_ = 0;
};

/// A stack: what was allocated last is released first, by scopes. Work already enqueued on an in-order queue
/// may go on using released memory, since whatever reuses it is enqueued later. If the blocks do not suffice,
/// a further block is allocated, and kept. A CPU's blocks are in huge pages where the system gives them.
class Arena {
 public:
  Arena(boost::compute::context context, const boost::compute::device& device);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// Makes one block of `bytes`, or of as many as the device allows in one piece, if nothing is allocated and
  /// the blocks hold less. Throws DeviceError if the device cannot give it.
  void reserve(std::size_t bytes);

  /// From now on, `bytes` of that buffer from `offset` on take the place of the own blocks, and there are no
  /// others: allocate throws DeviceError where they do not suffice. Null ends that. Nothing may be allocated.
  void lend(const std::shared_ptr<_cl_mem>& memory, std::size_t offset, std::size_t bytes);

  /// From now on every allocation is an OpenCL buffer of its own and of its own size, so that a simulator
  /// sees every access beyond it. Slow.
  void separate_buffers() { separate_ = true; }

  template <typename T>
  Buffer<T> allocate(std::size_t count) {
    return Buffer<T>(allocate_bytes(count, sizeof(T)), count);
  }

  /// Releases, at its end, all that was allocated since its begin.
  class Scope {
   public:
    explicit Scope(Arena& arena) : arena_(arena), block_(arena.current_), used_(arena.blocks_[block_].used) {}
    ~Scope() { arena_.release(block_, used_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Arena& arena_;
    std::size_t block_;
    std::size_t used_;
  };

  /// Every array begins at a multiple of so many bytes.
  std::size_t alignment() const { return alignment_; }
  /// Bytes in use at most since reset_peak, without gaps at the ends of blocks.
  std::size_t peak_bytes() const { return peak_; }
  /// Bytes of all blocks, own and lent.
  std::size_t held_bytes() const;
  /// Blocks, and separate buffers, made so far: no more blocks for the same work done again.
  std::size_t block_allocations() const { return block_allocations_; }
  void reset_peak() { peak_ = 0; }

 private:
  struct Block {
    std::shared_ptr<_cl_mem> memory;
    std::size_t offset = 0;  // where it begins in that
    std::size_t size = 0;
    std::size_t used = 0;
  };
  std::shared_ptr<_cl_mem> allocate_bytes(std::size_t count, std::size_t size);
  std::shared_ptr<_cl_mem> allocate_block(std::size_t bytes);
  void check_size(std::size_t bytes) const;
  void release(std::size_t block, std::size_t used);

  boost::compute::context context_;
  bool separate_ = false;
  bool is_lent_ = false;
  bool in_host_memory_;
  std::size_t alignment_;
  std::size_t largest_;
  std::vector<Block> blocks_;
  std::vector<Block> own_blocks_;  // while others are lent
  std::size_t current_ = 0;
  std::size_t peak_ = 0;
  std::size_t block_allocations_ = 0;
};

/// A buffer for kernels to read and write; a CPU's in huge pages where the system gives them.
std::shared_ptr<_cl_mem> allocate_device_memory(cl_context context, bool in_host_memory, std::size_t bytes);

/// Asks the system for huge pages in [begin, begin + bytes), memory not yet touched.
void prefer_huge_pages(void* begin, std::size_t bytes);

}  // namespace flaunay::host
