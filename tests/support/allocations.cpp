#include "tests/support/allocations.hpp"

#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace flaunay::testing {
namespace {

constexpr long kNever = std::numeric_limits<long>::max();
std::atomic<long> number{0}, first_failing{kNever}, last_failing{kNever}, live{0};

// Counts an allocation.
bool fails() {
  if (first_failing == kNever) return false;
  const long own = number++;
  return own >= first_failing && own <= last_failing;
}

void* allocate(std::size_t bytes, std::size_t alignment) {
  void* memory = nullptr;
  if (!fails() && posix_memalign(&memory, alignment, bytes) != 0) memory = nullptr;
  return memory;
}

void* allocate_object(std::size_t bytes, std::size_t alignment) {
  void* const memory = allocate(bytes, alignment);
  if (memory == nullptr) throw std::bad_alloc();
  ++live;
  return memory;
}

void free_object(void* memory) {
  if (memory != nullptr) --live;
  std::free(memory);
}

}  // namespace

FailingAllocations::FailingAllocations(std::size_t first, Failing failing) {
  number = 0;
  last_failing = failing == Failing::all ? kNever : static_cast<long>(first);
  first_failing = static_cast<long>(first);
}
FailingAllocations::~FailingAllocations() { first_failing = kNever; }
bool FailingAllocations::reached() const { return number > first_failing; }

long live_allocations() { return live; }

}  // namespace flaunay::testing

using flaunay::testing::allocate;
using flaunay::testing::allocate_object;
using flaunay::testing::fails;
using flaunay::testing::free_object;
using flaunay::testing::live;

void* operator new(std::size_t bytes) { return allocate_object(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate_object(bytes, static_cast<std::size_t>(alignment));
}
// Those of the standard library call the ones above, but those of a sanitizer do not.
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  void* const memory = allocate(bytes, alignof(std::max_align_t));
  if (memory != nullptr) ++live;
  return memory;
}
void* operator new[](std::size_t bytes) { return operator new(bytes); }
void* operator new[](std::size_t bytes, const std::nothrow_t& mark) noexcept {
  return operator new(bytes, mark);
}
void operator delete[](void* memory) noexcept { free_object(memory); }
void operator delete[](void* memory, std::size_t) noexcept { free_object(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { free_object(memory); }
void operator delete(void* memory) noexcept { free_object(memory); }
void operator delete(void* memory, std::size_t) noexcept { free_object(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { free_object(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { free_object(memory); }

// By which the library takes large arrays, and makes threads.
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  return allocate(bytes, alignment);
}

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*),
                              void* argument) {
  static auto* const real = reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
  return fails() ? EAGAIN : real(thread, attributes, work, argument);
}
