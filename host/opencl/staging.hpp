// Memory of the host that a device reaches fast, through which large transfers go.
#pragma once

#include <CL/cl.h>

#include <boost/compute/command_queue.hpp>
#include <cstddef>
#include <functional>
#include <memory>

#include "host/native/threads.hpp"

namespace flaunay::host {

/// Drivers pin memory that they allocate for the host: the device copies from and to it at the speed of its
/// bus, other memory several times slower. While one chunk of it is transferred, threads copy another one
/// from or to where the values are, in the order of the transfers. Used by one thread at a time.
class Staging {
 public:
  /// Enqueues the transfer of `bytes` bytes from `begin` on, without waiting, and sets its event.
  using Enqueue = std::function<void(std::size_t begin, std::size_t bytes, char* staged, cl_event* event)>;

  /// queue: of the device. Throws DeviceError if there is no such memory.
  Staging(const boost::compute::command_queue& queue, std::size_t chunk_bytes);
  ~Staging();
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  /// Transfers bytes to the device: enqueues the last chunks without waiting for them.
  void write(std::size_t bytes, const void* from, const Enqueue& enqueue) {
    transfer(bytes, static_cast<const char*>(from), nullptr, enqueue);
  }
  /// Transfers bytes to the host. The last chunks arrive by finish().
  void read(std::size_t bytes, void* to, const Enqueue& enqueue) {
    transfer(bytes, nullptr, static_cast<char*>(to), enqueue);
  }
  /// Waits until all that read() transfers has arrived. If that fails, nothing is written to the host later.
  void finish();

 private:
  // Some are transferred while one is copied. Memory does not grow with the transfer.
  static constexpr std::size_t kChunks = 4;
  struct Chunk {
    char* memory = nullptr;
    cl_event event = nullptr;  // of its transfer, or null if it is idle
    char* to = nullptr;        // where its bytes go after the transfer, or null
    std::size_t bytes = 0;
  };
  void transfer(std::size_t bytes, const char* from, char* to, const Enqueue& enqueue);
  void complete(Chunk& chunk);
  void forget() noexcept;

  boost::compute::command_queue queue_;
  std::size_t chunk_bytes_;
  Threads threads_;
  std::shared_ptr<_cl_mem> memory_;
  Chunk chunks_[kChunks];
  std::size_t next_ = 0;  // the chunk that has been idle or under way for longest
};

}  // namespace flaunay::host
