// Checks of the queues, events and buffers that a caller passes, before any work is done with them.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "call/implementation.hpp"
#include "flaunay/device_memory.hpp"
#include "host/runtime.hpp"

namespace flaunay {

/// Gives the library access to the private members of DeviceBuffer.
struct DeviceBufferAccess {
  static void set(DeviceBuffer& buffer, std::shared_ptr<_cl_mem> memory, std::size_t bytes) {
    buffer.memory_ = std::move(memory);
    buffer.bytes_ = bytes;
    buffer.is_callers_ = false;
  }
  static const std::shared_ptr<_cl_mem>& memory(const DeviceBuffer& buffer) { return buffer.memory_; }
};

namespace call {

/// How a buffer is used: kernels read it, kernels write it, the host reads it, or kernels and host do both.
enum class Access { read, write, host, workspace };

std::shared_ptr<_cl_mem> retained(cl_mem memory);

/// Throws Error(usage) unless `memory` is a buffer of the context, has at least this many bytes, and permits
/// the access. what: the buffer's name in the message, such as "points".
void check_buffer(host::Runtime& runtime, cl_mem memory, std::size_t bytes, Access access,
                  const std::string& what);

/// Runs a public call on device memory; see take_turn. The caller's event is null if it fails.
template <typename Work>
auto take_turn(Implementation& self, const Enqueue& enqueue, const Work& work) {
  if (enqueue.event != nullptr) *enqueue.event = nullptr;
  return take_turn(self, work);
}

/// Throws Error(usage) unless the queue is null or belongs to the runtime's
/// context and device and supports profiling if that is asked for, and all events belong to the context.
/// Released handles are dangling pointers and cannot be detected.
void check_enqueue(host::Runtime& runtime, const Enqueue& enqueue);

/// Throws Error(usage) if two of these are the same buffer. Null pointers are ignored.
void check_distinct(std::vector<cl_mem> buffers);

/// Returns the offsets of the sets, which are read from the device if they are there. Throws Error(usage)
/// unless they go from 0 to the number of points without decreasing.
std::vector<std::size_t> checked_offsets(host::Runtime& runtime, const DevicePoints& points);

/// Throws Error(usage) if the buffer of points is missing or too small, or if a number is no precision, and
/// Error(input) if there are too many points or sets.
void check_device_points(host::Runtime& runtime, const DevicePoints& points, const char* what);

/// Provides a buffer of at least this size for results. If it is flaunay's own, makes it or replaces it by a
/// larger one, and increments `made`. Throws Error(usage) if the caller's buffer is too small.
void make_result(host::Runtime& runtime, DeviceBuffer& buffer, std::size_t bytes, const std::string& what,
                 std::size_t& made);

template <typename T>
host::Buffer<T> result_buffer(host::Runtime& runtime, DeviceBuffer& buffer, std::size_t count,
                              const std::string& what, std::size_t& made) {
  make_result(runtime, buffer, count * sizeof(T), what, made);
  return {DeviceBufferAccess::memory(buffer), count};
}

/// Enqueues the copy of an array to a buffer, which the host may not be allowed to write.
template <typename T>
void write_result(host::Runtime& runtime, const host::Buffer<T>& to, std::vector<T> values) {
  const std::size_t count = values.size();
  if (count == 0) return;
  const host::Buffer<T> copy(host::allocate_memory(runtime.memory(), count * sizeof(T)), count);
  runtime.write_kept(copy, std::move(values));
  runtime.copy(copy, 0, to, 0, count);
}

/// A call on the caller's queue. It begins by waiting for the caller's events, and ends by setting the
/// caller's event.
class QueuedCall {
 public:
  /// enqueue: must have passed check_enqueue.
  QueuedCall(host::Runtime& runtime, const Enqueue& enqueue);
  /// Sets the caller's event and submits the work to the device.
  void end();

 private:
  host::Runtime& runtime_;
  const Enqueue& enqueue_;
  host::Runtime::Settled settled_;
};

}  // namespace call
}  // namespace flaunay
