#include <windows.h>
// After windows.h.
#include <psapi.h>

#include <algorithm>
#include <limits>

#include "host/memory/system_memory.hpp"

namespace flaunay::host {
namespace {

MEMORYSTATUSEX machine() {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof status;
  GlobalMemoryStatusEx(&status);
  return status;
}

std::size_t difference(std::size_t whole, std::size_t used) { return whole - std::min(whole, used); }

}  // namespace

// A process of 64 bits has no limit but that of its memory.
MemoryLeft address_space_left(const MemoryFiles&) { return {std::numeric_limits<std::size_t>::max(), ""}; }

MemoryLeft memory_left(const MemoryFiles&) {
  MemoryLeft left{machine().ullAvailPageFile, "the free memory of the machine"};
  const auto limit = [&left](std::size_t bytes, const char* what) {
    if (bytes < left.bytes) left = {bytes, what};
  };
  JOBOBJECT_EXTENDED_LIMIT_INFORMATION job{};
  PROCESS_MEMORY_COUNTERS used{};
  if (QueryInformationJobObject(nullptr, JobObjectExtendedLimitInformation, &job, sizeof job, nullptr) ==
          FALSE ||
      GetProcessMemoryInfo(GetCurrentProcess(), &used, sizeof used) == FALSE) {
    return left;
  }
  const DWORD limits = job.BasicLimitInformation.LimitFlags;
  if ((limits & JOB_OBJECT_LIMIT_PROCESS_MEMORY) != 0) {
    limit(difference(job.ProcessMemoryLimit, used.PagefileUsage), "the job's memory limit for a process");
  }
  // The memory that other processes of the job use is not known.
  if ((limits & JOB_OBJECT_LIMIT_JOB_MEMORY) != 0) {
    limit(difference(job.JobMemoryLimit, used.PagefileUsage), "the memory limit of the job");
  }
  return left;
}

std::size_t physical_memory() { return machine().ullTotalPhys; }

}  // namespace flaunay::host
