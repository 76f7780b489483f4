#include <malloc.h>

#include <cerrno>

#include "host/system/pages.hpp"

namespace flaunay::system {

void* allocate_aligned(std::size_t alignment, std::size_t bytes) { return _aligned_malloc(bytes, alignment); }

void free_aligned(void* memory) { _aligned_free(memory); }

// Only users with a privilege have such pages.
void prefer_huge_pages(void*, std::size_t) {}

void* allocate_on_disk(const std::string&, std::size_t) {
  errno = 0;
  return nullptr;
}

void free_on_disk(void*, std::size_t) {}

}  // namespace flaunay::system
