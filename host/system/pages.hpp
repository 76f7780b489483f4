// Aligned memory, in huge pages where the system has them: pages_posix.cpp and pages_windows.cpp.
#pragma once

#include <cstddef>

namespace flaunay::system {

constexpr std::size_t kHugePage = std::size_t{2} << 20;

/// Null if there is not enough memory. bytes: a multiple of the alignment.
void* allocate_aligned(std::size_t alignment, std::size_t bytes);
void free_aligned(void* memory);

/// Asks the system to use huge pages for [begin, begin + bytes), memory that was not accessed before.
void prefer_huge_pages(void* begin, std::size_t bytes);

}  // namespace flaunay::system
