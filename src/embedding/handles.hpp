// What a caller hands over, checked before any work is done with it.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"

namespace flaunay {

/// The way into a DeviceBuffer.
struct DeviceBufferAccess {
  static void set(DeviceBuffer& buffer, std::shared_ptr<_cl_mem> memory, std::size_t bytes) {
    buffer.memory_ = std::move(memory);
    buffer.bytes_ = bytes;
    buffer.is_callers_ = false;
  }
  static const std::shared_ptr<_cl_mem>& memory(const DeviceBuffer& buffer) { return buffer.memory_; }
};

namespace embedding {

/// Numbers of points or sets beyond it make no sense, and their sums and products could overflow.
constexpr std::size_t kMostCountable = std::size_t{1} << 40;

/// Who does what with a buffer: kernels, or the host, or both do all.
enum class Access { read, write, host, workspace };

std::shared_ptr<_cl_mem> retained(cl_mem memory);

/// Throws Error(usage) unless `memory` is a buffer of the context, of so many bytes at least, that kernels
/// may read or write. what: its name in the error, such as "points".
void check_buffer(host::Runtime& runtime, cl_mem memory, std::size_t bytes, Access access,
                  const std::string& what);

/// Sets the caller's event to null. Throws Error(usage) unless the queue is null or one of the runtime's
/// context and device, made for profiling if that is wanted, and events are of the context. That one was
/// released is noticed as a rule, not always.
void check_enqueue(host::Runtime& runtime, const Enqueue& enqueue);

/// Throws Error(usage) if two of these are the same buffer; null ones are none.
void check_distinct(std::vector<cl_mem> buffers);

/// The sets' offsets, read from the device if they are there. Throws Error(usage) if they do not increase
/// from 0 to the number of points.
std::vector<std::size_t> checked_offsets(host::Runtime& runtime, const DevicePoints& points);

/// The points as doubles from the buffer's begin on: in place, or a copy in `copies`. The buffer was checked.
host::Buffer<cl_double> wide_points(host::Runtime& runtime, host::Arena& copies, const DevicePoints& points);

/// Throws Error(usage) if the buffer is missing or too small.
void check_points(host::Runtime& runtime, const DevicePoints& points, const std::string& what);

/// A buffer that was computed before.
template <typename T>
host::Buffer<T> input_buffer(host::Runtime& runtime, const DeviceBuffer& buffer, std::size_t count,
                             const std::string& what) {
  check_buffer(runtime, buffer.memory(), count * sizeof(T), Access::read, what);
  return {DeviceBufferAccess::memory(buffer), count};
}

/// Makes the buffer, or a larger one, if it is flaunay's own, and counts that. Throws Error(usage) if the
/// caller's is too small.
void make_result(host::Runtime& runtime, DeviceBuffer& buffer, std::size_t bytes, const std::string& what,
                 std::size_t& made);

template <typename T>
host::Buffer<T> result_buffer(host::Runtime& runtime, DeviceBuffer& buffer, std::size_t count,
                              const std::string& what, std::size_t& made) {
  make_result(runtime, buffer, count * sizeof(T), what, made);
  return {DeviceBufferAccess::memory(buffer), count};
}

/// One call on the caller's queue: begins with what it is to wait for, and ends with its event.
class QueuedCall {
 public:
  /// It was checked.
  QueuedCall(host::Runtime& runtime, const Enqueue& enqueue);
  /// Lets the device begin; sets the event.
  void end();

 private:
  host::Runtime& runtime_;
  const Enqueue& enqueue_;
  host::Runtime::Settled settled_;
};

}  // namespace embedding
}  // namespace flaunay
