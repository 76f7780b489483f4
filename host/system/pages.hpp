// Aligned memory, in huge pages where the system has them, and memory on disks: pages_posix.cpp and
// pages_windows.cpp.
#pragma once

#include <cstddef>
#include <string>

namespace flaunay::system {

constexpr std::size_t kHugePage = std::size_t{2} << 20;

/// Null if there is not enough memory. bytes: a multiple of the alignment.
void* allocate_aligned(std::size_t alignment, std::size_t bytes);
void free_aligned(void* memory);

/// Asks the system to use huge pages for [begin, begin + bytes), memory that was not accessed before.
void prefer_huge_pages(void* begin, std::size_t bytes);

/// Memory that is a new file in a folder, without a name, which the system may keep on the disk. All bytes
/// are 0. Null if there cannot be one: errno is the reason, or 0 where systems have none. bytes: at least 1.
void* allocate_on_disk(const std::string& folder, std::size_t bytes);
void free_on_disk(void* memory, std::size_t bytes);

}  // namespace flaunay::system
