#include "host/native/backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "host/clock.hpp"
#include "host/error.hpp"

namespace flaunay::host {
namespace {

class NativeKernel : public Kernel {
 public:
  NativeKernel(const char* name, NativeFunction made, bool counts)
      : Kernel(name), function(made), counts_(counts) {}

  void set_argument(cl_uint index, const void* value, std::size_t bytes) override {
    if (values_.size() <= index) add_values(index + 1);
    std::memcpy(values_[index].bytes, value, bytes);
  }
  bool takes_counters(cl_uint) const override { return counts_; }
  void** values() { return places_.data(); }

  const NativeFunction function;

 private:
  struct Value {
    alignas(8) unsigned char bytes[kLargestArgument];
  };
  void add_values(std::size_t count) {
    places_.resize(count);
    values_.resize(count);
    for (std::size_t k = 0; k < count; ++k) places_[k] = values_[k].bytes;
  }

  const bool counts_;
  std::vector<Value> values_;
  std::vector<void*> places_;  // of the values
};

}  // namespace

std::unique_ptr<Kernel> NativeBackend::make_kernel(const KernelName& wanted, const std::string&,
                                                   bool counting) {
  if (wanted.native == nullptr) {
    throw DeviceError(fmt::format("kernel {} needs an OpenCL device", wanted.name));
  }
  const bool counts = counting && wanted.counting != nullptr;
  return std::make_unique<NativeKernel>(wanted.name, counts ? wanted.counting : wanted.native, counts);
}

// Parts of a launch are several groups, but not so many that threads would wait for the last one for long.
constexpr std::size_t kPartsPerThread = 8;

void NativeBackend::launch(Kernel& kernel, std::size_t work_items, std::size_t group) {
  auto& native = static_cast<NativeKernel&>(kernel);
  accounts().add_launch(kernel.name(), work_items, group);
  const double begin = profiling_ ? now() : 0;
  threads_.share(work_items, std::max(group, work_items / (kPartsPerThread * threads_.count())),
                 [&](std::size_t first, std::size_t last) {
                   native.function({first, last, work_items}, native.values());
                 });
  if (profiling_) accounts().add_time(kernel.name(), accounts().last_launch(), now() - begin);
}

void NativeBackend::read(cl_mem from, std::size_t offset, std::size_t bytes, void* to, bool) {
  std::memcpy(to, address_of(from) + offset, bytes);
}

void NativeBackend::write(cl_mem to, std::size_t offset, std::size_t bytes, const void* from, bool) {
  std::memcpy(address_of(to) + offset, from, bytes);
}

void NativeBackend::fill(cl_mem to, std::size_t offset, std::size_t bytes, const void* value,
                         std::size_t value_bytes) {
  for (std::size_t at = 0; at < bytes; at += value_bytes) {
    std::memcpy(address_of(to) + offset + at, value, value_bytes);
  }
}

void NativeBackend::copy(cl_mem from, std::size_t from_offset, cl_mem to, std::size_t to_offset,
                         std::size_t bytes) {
  std::memmove(address_of(to) + to_offset, address_of(from) + from_offset, bytes);
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
