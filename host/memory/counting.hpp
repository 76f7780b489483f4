// A back end that runs nothing, by which a runtime counts the memory that work would take.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "host/backend.hpp"

namespace flaunay::host {

/// Reads do nothing: destinations keep their values. No kernel is launched.
class CountingBackend : public Backend {
 public:
  /// alignment: of arrays, equal to the alignment in the runtime whose memory is counted.
  CountingBackend(Accounts& accounts, std::size_t alignment) : Backend(accounts), alignment_(alignment) {}

  std::string name() const override { return "counting"; }
  MemorySource memory() const override { return {{}, true, alignment_, kMostBytes}; }
  void read(cl_mem, std::size_t, std::size_t, void*, bool) override {}
  void write(cl_mem, std::size_t, std::size_t, const void*, bool) override {}
  void fill(cl_mem, std::size_t, std::size_t, const void*, std::size_t) override {}
  void copy(cl_mem, std::size_t, cl_mem, std::size_t, std::size_t) override {}
  std::shared_ptr<_cl_mem> wrap(void*, std::size_t, cl_mem_flags) override { return nullptr; }
  void touch_new(void*, std::size_t) override {}
  void use_queue(cl_command_queue, bool) override {}

 private:
  std::size_t alignment_;
};

}  // namespace flaunay::host
