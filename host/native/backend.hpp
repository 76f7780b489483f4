// Runs kernels that are compiled as C++, on threads of the host, without OpenCL.
#pragma once

#include "host/backend.hpp"
#include "host/native/threads.hpp"

namespace flaunay::host {

class NativeBackend : public Backend {
 public:
  /// threads: see Threads.
  NativeBackend(Accounts& accounts, std::size_t threads) : Backend(accounts), threads_(threads) {}

  std::string name() const override { return "host"; }
  MemorySource memory() const override { return native_memory(); }
  std::size_t threads() const override { return threads_.count(); }

  /// Throws DeviceError if the kernel is not compiled for the host.
  void launch(const KernelName& name, NativeFunction function, void* const* arguments, std::size_t work_items,
              std::size_t group) override;
  void share(std::size_t n, const std::function<void(std::size_t)>& work) override {
    threads_.share_each(n, work);
  }
  void read(cl_mem from, std::size_t offset, std::size_t bytes, void* to, bool wait) override;
  void write(cl_mem to, std::size_t offset, std::size_t bytes, const void* from, bool wait) override;
  void fill(cl_mem to, std::size_t offset, std::size_t bytes, const void* value,
            std::size_t value_bytes) override;
  void copy(cl_mem from, std::size_t from_offset, cl_mem to, std::size_t to_offset,
            std::size_t bytes) override;
  std::shared_ptr<_cl_mem> wrap(void* memory, std::size_t bytes, cl_mem_flags access) override;
  void touch_new(void* begin, std::size_t bytes) override;
  void use_queue(cl_command_queue, bool profiling) override { profiling_ = profiling; }

 private:
  void copy_bytes(char* to, const char* from, std::size_t bytes);

  Threads threads_;
  bool profiling_ = false;
};

}  // namespace flaunay::host
