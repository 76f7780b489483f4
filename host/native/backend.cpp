#include "host/native/backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "host/clock.hpp"
#include "host/error.hpp"

namespace flaunay::host {

// A part of a launch is several groups, but small enough that threads do not wait long for the last part.
constexpr std::size_t kPartsPerThread = 8;

void NativeBackend::launch(const KernelName& name, NativeFunction function, void* const* arguments,
                           std::size_t work_items, std::size_t group) {
  if (function == nullptr) throw DeviceError(fmt::format("kernel {} needs an OpenCL device", name.name));
  accounts().add_launch(name.name, work_items, group);
  const double begin = profiling_ ? now() : 0;
  const std::size_t part = std::max(group, work_items / (kPartsPerThread * threads_.count()));
  if (work_items <= part || threads_.count() == 1) {
    function({0, work_items, work_items}, arguments);
  } else {
    threads_.share(work_items, part, [&](std::size_t first, std::size_t last) {
      function({first, last, work_items}, arguments);
    });
  }
  if (profiling_) accounts().add_time(name.name, accounts().last_launch(), now() - begin);
}

void NativeBackend::read(cl_mem from, std::size_t offset, std::size_t bytes, void* to, bool) {
  std::memcpy(to, address_of(from) + offset, bytes);
}

void NativeBackend::write(cl_mem to, std::size_t offset, std::size_t bytes, const void* from, bool) {
  copy_bytes(address_of(to) + offset, static_cast<const char*>(from), bytes);
}

void NativeBackend::copy_bytes(char* to, const char* from, std::size_t bytes) {
  if (to < from + bytes && from < to + bytes) {
    std::memmove(to, from, bytes);
  } else {
    threads_.copy(to, from, bytes);
  }
}

void NativeBackend::fill(cl_mem to, std::size_t offset, std::size_t bytes, const void* value,
                         std::size_t value_bytes) {
  char* const begin = address_of(to) + offset;
  if (value_bytes == sizeof(cl_uint)) {
    cl_uint word;
    std::memcpy(&word, value, sizeof word);
    std::fill_n(reinterpret_cast<cl_uint*>(begin), bytes / sizeof word, word);
    return;
  }
  for (std::size_t at = 0; at < bytes; at += value_bytes) std::memcpy(begin + at, value, value_bytes);
}

void NativeBackend::copy(cl_mem from, std::size_t from_offset, cl_mem to, std::size_t to_offset,
                         std::size_t bytes) {
  copy_bytes(address_of(to) + to_offset, address_of(from) + from_offset, bytes);
}

std::shared_ptr<_cl_mem> NativeBackend::wrap(void* memory, std::size_t, cl_mem_flags) {
  return {std::shared_ptr<void>(), handle_of(memory)};
}

// The threads share the work that the system has with it.
void NativeBackend::touch_new(void* begin, std::size_t bytes) {
  constexpr std::size_t kPage = 4096, kPagesPerPart = 512;
  auto* const pages = static_cast<volatile unsigned char*>(begin);
  threads_.share((bytes + kPage - 1) / kPage, kPagesPerPart, [&](std::size_t first, std::size_t last) {
    for (std::size_t page = first; page < last; ++page) pages[page * kPage] = 0;
  });
}

}  // namespace flaunay::host
