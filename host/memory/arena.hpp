// Device memory: a stack of typed buffers, as a rule inside of larger blocks that live as long as the arena.
#pragma once

#include <CL/cl.h>

#include <boost/compute/context.hpp>
#include <boost/compute/device.hpp>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "host/memory/buffer_pool.hpp"

namespace flaunay::host {

/// An array of T in device memory. Copies of this handle refer to the same memory.
template <typename T>
class Buffer {
 public:
  Buffer() = default;
  Buffer(std::shared_ptr<_cl_mem> memory, std::size_t size) : memory_(std::move(memory)), size_(size) {}
  cl_mem memory() const { return memory_.get(); }
  /// The memory, which a copy of this pointer keeps alive.
  const std::shared_ptr<_cl_mem>& kept_memory() const { return memory_; }
  std::size_t size() const { return size_; }
  /// Returns the same memory as an array of another type.
  template <typename U>
  Buffer<U> as() const {
    return {memory_, size_ * sizeof(T) / sizeof(U)};
  }

 private:
  std::shared_ptr<_cl_mem> memory_;
  std::size_t size_ = 0;
};

/// How arrays get their memory.
enum class ArrayMemory {
  parts,     ///< parts of larger blocks
  separate,  ///< a buffer each of exactly its size, so that a simulator detects every access out of bounds;
             ///< slow
  reused     ///< a buffer each, of those that are not in use any more
};

/// Where memory for kernels comes from.
struct MemorySource {
  boost::compute::context context;  ///< null: kernels run natively, in the memory of the process
  bool in_host_memory;              ///< whether kernels run in host memory
  std::size_t alignment;            ///< every array begins at a multiple of this many bytes
  std::size_t largest;              ///< the largest number of bytes in one piece
  ArrayMemory arrays = ArrayMemory::parts;
};
/// No array has more bytes. The sum of two such sizes can be computed, even when they are rounded up.
constexpr std::size_t kMostBytes = (std::numeric_limits<std::size_t>::max() >> 1) - (std::size_t{1} << 16);
/// The memory of an OpenCL device.
MemorySource memory_of(const boost::compute::context& context, const boost::compute::device& device);
/// The memory of the process, for kernels that run natively.
MemorySource native_memory();

/// For kernels that run natively, the handle of an array is its address.
inline cl_mem handle_of(void* address) { return reinterpret_cast<cl_mem>(address); }
inline char* address_of(cl_mem memory) { return reinterpret_cast<char*>(memory); }

/// A stack allocator: scopes release the last allocations. Work that is enqueued on an in-order queue may go
/// on using released memory, because the work that reuses it is enqueued later. If the blocks are full, a
/// further block is allocated and kept. On a CPU, blocks use huge pages if the system provides them. Where
/// arrays are buffers of their own, scopes only count them.
class Arena {
 public:
  /// pool: for arrays that are separate buffers, the pool of another arena, which counts its bytes; null: the
  /// arena makes a pool.
  explicit Arena(MemorySource source, std::shared_ptr<BufferPool> pool = nullptr);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// If nothing is allocated and the blocks hold less than `bytes`, replaces them by one block of that size,
  /// or of the largest size that the device allows for one buffer. Throws DeviceError if the device has not
  /// enough memory.
  void reserve(std::size_t bytes);

  /// Makes allocations use `bytes` bytes of the given buffer from `offset` on, and no other memory: allocate
  /// throws DeviceError if they do not suffice. Null: the arena uses its own blocks again. Must not be called
  /// while anything is allocated.
  void lend(const std::shared_ptr<_cl_mem>& memory, std::size_t offset, std::size_t bytes);

  /// Makes the arena count bytes only: it has no memory, and its arrays must not be accessed.
  void count_only() { lend({std::shared_ptr<void>(), handle_of(this)}, 0, kMostBytes); }

  template <typename T>
  Buffer<T> allocate(std::size_t count) {
    return Buffer<T>(allocate_bytes(count, sizeof(T)), count);
  }

  /// Its destructor releases everything that was allocated since its construction.
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

  /// Every array begins at a multiple of this many bytes.
  std::size_t alignment() const { return source_.alignment; }
  /// The largest number of bytes in use since reset_peak, without unused ends of blocks.
  std::size_t peak_bytes() const { return peak_; }
  /// The bytes of all blocks, the arena's own and lent ones.
  std::size_t held_bytes() const;
  /// The number of blocks and separate buffers made so far. Repeating the same work makes no more blocks.
  std::size_t block_allocations() const;
  void reset_peak() { peak_ = 0; }
  /// Null unless buffers are reused.
  const std::shared_ptr<BufferPool>& pool() const { return pool_; }

 private:
  struct Block {
    std::shared_ptr<_cl_mem> memory;
    std::size_t offset = 0;  // of the block in its memory
    std::size_t size = 0;
    std::size_t used = 0;
  };
  std::shared_ptr<_cl_mem> allocate_bytes(std::size_t count, std::size_t size);
  std::shared_ptr<_cl_mem> allocate_block(std::size_t bytes);
  std::shared_ptr<_cl_mem> part_of(const std::shared_ptr<_cl_mem>& memory, std::size_t begin,
                                   std::size_t bytes) const;
  void check_size(std::size_t bytes) const;
  void release(std::size_t block, std::size_t used);

  MemorySource source_;
  std::shared_ptr<BufferPool> pool_;  // null unless buffers are reused
  bool counts_pool_ = false;
  bool is_lent_ = false;
  std::vector<Block> blocks_;
  std::vector<Block> own_blocks_;  // kept here while a buffer is lent
  std::size_t current_ = 0;
  std::size_t peak_ = 0;
  std::size_t block_allocations_ = 0;
};

/// Allocates memory that kernels read and write. On a CPU it uses huge pages if the system provides them, and
/// throws DeviceError if the system has not enough memory.
std::shared_ptr<_cl_mem> allocate_memory(const MemorySource& source, std::size_t bytes);

}  // namespace flaunay::host
