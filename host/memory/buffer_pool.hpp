// Buffers of a device that are used again.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

namespace flaunay::host {

/// Keeps the buffers that are not in use any more for those who need one of about that size. Work on an
/// in-order queue may go on using a buffer that was given back. All functions can be called by several
/// threads.
class BufferPool : public std::enable_shared_from_this<BufferPool> {
 public:
  using Make = std::function<std::shared_ptr<_cl_mem>(std::size_t bytes)>;

  /// make: makes a buffer; it throws DeviceError if there is no memory for it.
  explicit BufferPool(Make make) : make_(std::move(make)) {}

  /// Returns a buffer of at least `bytes` bytes. `largest` is the limit for one buffer. The buffer comes back
  /// to the pool when the last copy of the pointer is gone. The pool keeps about as much as was in use at
  /// once. O(log b) for b buffers.
  std::shared_ptr<_cl_mem> take(std::size_t bytes, std::size_t largest);

  /// The bytes of all buffers, in use or not.
  std::size_t bytes() const;
  /// The number of buffers made so far.
  std::size_t made() const;

 private:
  std::shared_ptr<_cl_mem> make(std::size_t bytes);
  void give_back(std::shared_ptr<_cl_mem> memory, std::size_t bytes);
  void drop_one();

  Make make_;
  mutable std::mutex mutex_;
  std::multimap<std::size_t, std::shared_ptr<_cl_mem>> idle_;
  std::size_t bytes_ = 0, in_use_ = 0, most_in_use_ = 0, made_ = 0;
};

}  // namespace flaunay::host
