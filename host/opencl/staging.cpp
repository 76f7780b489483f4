#include "host/opencl/staging.hpp"

#include <algorithm>
#include <utility>

#include "host/error.hpp"

namespace flaunay::host {

// One thread copies at about 10 GB/s, a bus at up to 55; more threads take longer to wake up.
constexpr std::size_t kMostCopyThreads = 8;

Staging::Staging(const boost::compute::command_queue& queue, std::size_t chunk_bytes)
    : queue_(queue), chunk_bytes_(chunk_bytes), threads_(std::min(native_threads(), kMostCopyThreads)) {
  cl_int code = CL_SUCCESS;
  const std::size_t bytes = kChunks * chunk_bytes;
  cl_mem buffer = clCreateBuffer(queue.get_context().get(), CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, bytes,
                                 nullptr, &code);
  check_call(code, "clCreateBuffer");
  memory_ = {buffer, [](cl_mem memory) { clReleaseMemObject(memory); }};
  // It stays mapped: the device only uses the memory behind it.
  void* const mapped = clEnqueueMapBuffer(queue.get(), buffer, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes,
                                          0, nullptr, nullptr, &code);
  check_call(code, "clEnqueueMapBuffer");
  for (std::size_t k = 0; k < kChunks; ++k) {
    chunks_[k].memory = static_cast<char*>(mapped) + k * chunk_bytes;
  }
}

Staging::~Staging() {
  forget();
  clEnqueueUnmapMemObject(queue_.get(), memory_.get(), chunks_[0].memory, 0, nullptr, nullptr);
  clFinish(queue_.get());
}

void Staging::transfer(std::size_t bytes, const char* from, char* to, const Enqueue& enqueue) {
  try {
    for (std::size_t begin = 0; begin < bytes; begin += chunk_bytes_) {
      Chunk& chunk = chunks_[next_];
      next_ = (next_ + 1) % kChunks;
      complete(chunk);
      chunk.bytes = std::min(bytes - begin, chunk_bytes_);
      if (from != nullptr) threads_.copy(chunk.memory, from + begin, chunk.bytes);
      enqueue(begin, chunk.bytes, chunk.memory, &chunk.event);
      if (to != nullptr) chunk.to = to + begin;
    }
  } catch (...) {
    forget();
    throw;
  }
}

void Staging::complete(Chunk& chunk) {
  if (chunk.event == nullptr) return;
  cl_int code = clWaitForEvents(1, &chunk.event), status = CL_COMPLETE;
  if (code != CL_SUCCESS)  // which does not say what went wrong
    clGetEventInfo(chunk.event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr);
  if (status < 0) code = status;
  clReleaseEvent(std::exchange(chunk.event, nullptr));
  check_call(code, "clWaitForEvents");
  if (chunk.to != nullptr) threads_.copy(std::exchange(chunk.to, nullptr), chunk.memory, chunk.bytes);
}

void Staging::finish() {
  try {
    for (std::size_t k = 0; k < kChunks; ++k) {
      Chunk& chunk = chunks_[(next_ + k) % kChunks];
      if (chunk.to != nullptr) complete(chunk);
    }
  } catch (...) {
    forget();
    throw;
  }
}

// Waits for what is under way, whose bytes go nowhere: where they should go may not exist any more.
void Staging::forget() noexcept {
  for (Chunk& chunk : chunks_) {
    chunk.to = nullptr;
    if (chunk.event == nullptr) continue;
    clWaitForEvents(1, &chunk.event);
    clReleaseEvent(std::exchange(chunk.event, nullptr));
  }
}

}  // namespace flaunay::host
