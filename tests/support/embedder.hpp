// A program that has an OpenCL context of its own: what embeds flaunay.
#pragma once

#include <CL/cl.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "flaunay/device_memory.hpp"

namespace flaunay::testing {

inline void check(cl_int code, const char* what) {
  if (code != CL_SUCCESS) throw std::runtime_error(std::string(what) + ": " + std::to_string(code));
}

using Memory = std::shared_ptr<_cl_mem>;
using Queue = std::shared_ptr<_cl_command_queue>;

class Embedder {
 public:
  explicit Embedder(cl_device_id device) : device_(device) {
    cl_int code = CL_SUCCESS;
    context_.reset(clCreateContext(nullptr, 1, &device, nullptr, nullptr, &code), clReleaseContext);
    check(code, "clCreateContext");
    queue_ = make_queue();
  }

  cl_context context() const { return context_.get(); }
  cl_device_id device() const { return device_; }
  cl_command_queue queue() const { return queue_.get(); }

  Queue make_queue(cl_command_queue_properties properties = 0) const {
    cl_int code = CL_SUCCESS;
    Queue queue(clCreateCommandQueue(context_.get(), device_, properties, &code), clReleaseCommandQueue);
    check(code, "clCreateCommandQueue");
    return queue;
  }
  Memory make_buffer(std::size_t bytes, cl_mem_flags flags = CL_MEM_READ_WRITE) const {
    cl_int code = CL_SUCCESS;
    Memory memory(clCreateBuffer(context_.get(), flags, bytes, nullptr, &code), clReleaseMemObject);
    check(code, "clCreateBuffer");
    return memory;
  }
  template <typename T>
  Memory upload(const std::vector<T>& values) const {
    const std::size_t bytes = values.size() * sizeof(T);
    Memory memory = make_buffer(bytes + 1);
    if (bytes > 0) {
      check(
          clEnqueueWriteBuffer(queue(), memory.get(), CL_TRUE, 0, bytes, values.data(), 0, nullptr, nullptr),
          "clEnqueueWriteBuffer");
    }
    return memory;
  }
  /// On `queue`, or the own one: waits for what was enqueued there.
  template <typename T>
  std::vector<T> download(cl_mem memory, std::size_t count, cl_command_queue queue = nullptr) const {
    std::vector<T> values(count);
    if (count == 0) return values;
    if (queue == nullptr) queue = queue_.get();
    check(
        clEnqueueReadBuffer(queue, memory, CL_TRUE, 0, count * sizeof(T), values.data(), 0, nullptr, nullptr),
        "clEnqueueReadBuffer");
    return values;
  }

 private:
  cl_device_id device_;
  std::shared_ptr<_cl_context> context_;
  Queue queue_;
};

}  // namespace flaunay::testing
