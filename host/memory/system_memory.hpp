// The memory that the system and the limits of this process leave, which devices that work in host memory
// cannot exceed. OpenCL implementations do not tell, and some end the process where memory lacks.
#pragma once

#include <cstddef>
#include <string>

namespace flaunay::host {

constexpr std::size_t kMebibyte = std::size_t{1} << 20;

/// A number of bytes, and what limits it, for messages.
struct MemoryLeft {
  std::size_t bytes;
  std::string limit;  ///< "the limit of the address space (ulimit -v)" and others
};

/// Where Linux tells of memory. Tests have folders of their own.
struct MemoryFiles {
  std::string process = "/proc";
  std::string groups = "/sys/fs/cgroup";
};

/// The address space that the limits of the process leave; the largest number of bytes if there is no limit.
MemoryLeft address_space_left(const MemoryFiles& files = {});

/// The memory that the process can still use: the least of the machine's free memory with its swap space, the
/// rest below the limits of the control groups, and the address space. The largest number of bytes if nothing
/// is known. Reads some files, which takes a tenth of a millisecond.
MemoryLeft memory_left(const MemoryFiles& files = {});

/// The bytes of memory that the machine has; 0 if that is not known.
std::size_t physical_memory();

/// Throws DeviceError, with the missing amount and its limit, unless this many bytes are left, and some more
/// for the OpenCL implementation itself. what: the purpose of the bytes, such as "a buffer".
void require_memory(std::size_t bytes, const std::string& what);

/// "512 MiB".
std::string mebibytes(std::size_t bytes);

}  // namespace flaunay::host
