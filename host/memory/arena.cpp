#include "host/memory/arena.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

#include "host/error.hpp"
#include "host/memory/system_memory.hpp"
#include "host/system/pages.hpp"

namespace flaunay::host {
namespace {

constexpr std::size_t kSmallestBlock = std::size_t{1} << 20;
constexpr std::size_t kAlignment = 128;
// Without OpenCL there are no GPUs: the module for browsers need not have the pool.
#ifdef FLAUNAY_WITHOUT_OPENCL
constexpr bool kHasPools = false;
#else
constexpr bool kHasPools = true;
#endif

std::shared_ptr<_cl_mem> own(cl_mem memory) {
  return std::shared_ptr<_cl_mem>(memory, [](cl_mem m) { clReleaseMemObject(m); });
}

std::shared_ptr<_cl_mem> create_buffer(const boost::compute::context& context, std::size_t bytes) {
  cl_int code = CL_SUCCESS;
  cl_mem memory = clCreateBuffer(context.get(), CL_MEM_READ_WRITE, bytes, nullptr, &code);
  check_call(code, "clCreateBuffer");
  return own(memory);
}

// Kernels access large blocks irregularly: with pages of 4 KiB, address translation would take longer than
// the loads. Null if there is not enough memory.
void* allocate_pages(std::size_t bytes) {
  const std::size_t page = bytes < system::kHugePage ? kAlignment : system::kHugePage;
  void* const pages = system::allocate_aligned(page, (bytes + page - 1) / page * page);
  if (pages != nullptr && page == system::kHugePage) system::prefer_huge_pages(pages, bytes);
  return pages;
}

std::shared_ptr<_cl_mem> allocate_native(std::size_t bytes) {
  void* const pages = allocate_pages(bytes);
  if (pages == nullptr) throw std::bad_alloc();
  return {handle_of(pages), [](cl_mem memory) { system::free_aligned(address_of(memory)); }};
}

}  // namespace

MemorySource memory_of(const boost::compute::context& context, const boost::compute::device& device) {
  // At least a cache line, so that vector loads of one array never share a cache line with another array.
  const std::size_t alignment = device.get_info<cl_uint>(CL_DEVICE_MEM_BASE_ADDR_ALIGN) / 8;
  return {context, (device.type() & CL_DEVICE_TYPE_CPU) != 0, std::max(kAlignment, alignment),
          static_cast<std::size_t>(std::min<cl_ulong>(device.max_memory_alloc_size(), kMostBytes))};
}

MemorySource native_memory() { return {{}, true, kAlignment, kMostBytes}; }

Arena::Arena(MemorySource source, std::shared_ptr<BufferPool> pool) : source_(std::move(source)), blocks_(1) {
  if (!kHasPools || source_.arrays != ArrayMemory::reused) return;
  pool_ = std::move(pool);
  if (pool_ != nullptr) return;
  counts_pool_ = true;
  pool_ = std::make_shared<BufferPool>(
      [memory = source_](std::size_t bytes) { return allocate_memory(memory, bytes); });
}

Arena::~Arena() = default;

std::size_t Arena::held_bytes() const {
  std::size_t sum = 0;
  for (const Block& block : blocks_) sum += block.size;
  for (const Block& block : own_blocks_) sum += block.size;
  return sum + (kHasPools && counts_pool_ ? pool_->bytes() : 0);
}

std::size_t Arena::block_allocations() const {
  return block_allocations_ + (kHasPools && counts_pool_ ? pool_->made() : 0);
}

std::shared_ptr<_cl_mem> allocate_memory(const MemorySource& source, std::size_t bytes) {
  // Where memory lacks, an OpenCL implementation may end the process. To look takes longer than work on less
  // than this.
  constexpr std::size_t kNeverLacking = std::size_t{1} << 18;
  if (source.in_host_memory && bytes > kNeverLacking) require_memory(bytes, "a buffer");
  if (source.context.get() == nullptr) return allocate_native(bytes);
#ifdef __linux__
  if (source.in_host_memory && bytes >= system::kHugePage) {
    if (void* const pages = allocate_pages(bytes)) {
      cl_int code = CL_SUCCESS;
      cl_mem memory =
          clCreateBuffer(source.context.get(), CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, pages, &code);
      // The pages are freed with the buffer, which OpenCL keeps while enqueued work uses it.
      if (code == CL_SUCCESS) {
        code = clSetMemObjectDestructorCallback(
            memory, [](cl_mem, void* freed) { system::free_aligned(freed); }, pages);
        if (code == CL_SUCCESS) return own(memory);
        clReleaseMemObject(memory);
      }
      system::free_aligned(pages);
    }
  }
#endif
  return create_buffer(source.context, bytes);
}

void Arena::check_size(std::size_t bytes) const {
  if (bytes <= source_.largest) return;
  throw DeviceError(
      fmt::format("a buffer of {} bytes is more than the device allows in one piece ({} bytes); "
                  "use fewer points, or another device (FLAUNAY_DEVICE)",
                  bytes, source_.largest),
      CL_INVALID_BUFFER_SIZE);
}

std::shared_ptr<_cl_mem> Arena::allocate_block(std::size_t bytes) {
  if (is_lent_) {
    throw DeviceError(fmt::format("the memory that was lent lacks {} bytes", bytes), CL_INVALID_BUFFER_SIZE);
  }
  check_size(bytes);
  std::shared_ptr<_cl_mem> memory = allocate_memory(source_, bytes);
  ++block_allocations_;
  return memory;
}

void Arena::reserve(std::size_t bytes) {
  if (source_.arrays != ArrayMemory::parts || is_lent_ || current_ != 0 || blocks_[0].used != 0 ||
      held_bytes() >= bytes)
    return;
  bytes = std::min(std::max(bytes, kSmallestBlock), source_.largest);
  blocks_.assign(1, {});
  blocks_[0].memory = allocate_block(bytes);
  blocks_[0].size = bytes;
}

void Arena::lend(const std::shared_ptr<_cl_mem>& memory, std::size_t offset, std::size_t bytes) {
  if (is_lent_) blocks_ = std::exchange(own_blocks_, {});
  is_lent_ = false;
  if (memory == nullptr) return;
  own_blocks_ = std::exchange(blocks_, std::vector<Block>(1));
  is_lent_ = true;
  // OpenCL requires sub-buffers to begin at multiples of the alignment.
  const std::size_t begin = (offset + source_.alignment - 1) / source_.alignment * source_.alignment;
  blocks_[0] = {memory, begin, offset + bytes < begin ? 0 : offset + bytes - begin, 0};
}

std::shared_ptr<_cl_mem> Arena::part_of(const std::shared_ptr<_cl_mem>& memory, std::size_t begin,
                                        std::size_t bytes) const {
  if (source_.context.get() == nullptr) return {memory, handle_of(address_of(memory.get()) + begin)};
  cl_buffer_region region{begin, bytes};
  cl_int code = CL_SUCCESS;
  cl_mem part =
      clCreateSubBuffer(memory.get(), CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region, &code);
  check_call(code, "clCreateSubBuffer");
  return own(part);
}

std::shared_ptr<_cl_mem> Arena::allocate_bytes(std::size_t count, std::size_t size) {
  if (count > kMostBytes / size) {
    throw DeviceError(
        fmt::format("a buffer of {} elements of {} bytes is more than can be addressed", count, size),
        CL_INVALID_BUFFER_SIZE);
  }
  const std::size_t bytes = count * size;
  if (source_.arrays == ArrayMemory::separate && !is_lent_) {
    ++block_allocations_;
    const std::size_t exact = std::max<std::size_t>(bytes, 1);
    return source_.context.get() == nullptr ? allocate_native(exact) : create_buffer(source_.context, exact);
  }
  // OpenCL has no empty buffers, so an empty array gets some bytes, too.
  const std::size_t rounded =
      (std::max<std::size_t>(bytes, 1) + source_.alignment - 1) / source_.alignment * source_.alignment;
  if (kHasPools && pool_ != nullptr && !is_lent_) {
    check_size(bytes);
    blocks_[0].used += rounded;
    peak_ = std::max(peak_, blocks_[0].used);
    return pool_->take(bytes, source_.largest);
  }
  while (blocks_[current_].used + rounded > blocks_[current_].size) {
    if (current_ + 1 == blocks_.size()) blocks_.emplace_back();
    Block& next = blocks_[current_ + 1];
    if (next.size < rounded) {
      // An eighth of the memory held now, so that there are few blocks and little unused memory.
      std::size_t block_size = std::max({rounded, kSmallestBlock, held_bytes() / 8});
      block_size = std::max(rounded, std::min(block_size, source_.largest));
      next.memory.reset();
      next.size = 0;
      next.memory = allocate_block(block_size);
      next.size = block_size;
    }
    next.used = 0;
    ++current_;
  }
  Block& block = blocks_[current_];
  const std::size_t begin = block.offset + block.used;
  std::shared_ptr<_cl_mem> memory = part_of(block.memory, begin, rounded);
  block.used += rounded;
  std::size_t used = 0;
  for (std::size_t b = 0; b <= current_; ++b) used += blocks_[b].used;
  peak_ = std::max(peak_, used);
  return memory;
}

void Arena::release(std::size_t block, std::size_t used) {
  current_ = block;
  blocks_[block].used = used;
}

}  // namespace flaunay::host
