#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>

#include "host/memory/system_memory.hpp"

#ifdef __linux__
#include <sys/resource.h>
#endif

namespace flaunay::host {
namespace {

constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

void limit(MemoryLeft& left, std::size_t bytes, const std::string& what) {
  if (bytes < left.bytes) left = {bytes, what};
}

std::size_t difference(std::size_t whole, std::size_t used) { return whole - std::min(whole, used); }

// The number in a file of one number; none for "max", and for a file that cannot be read.
std::optional<std::size_t> number_in(const std::string& path) {
  std::ifstream file(path);
  std::size_t number = 0;
  if (file >> number) return number;
  return {};
}

// The number that follows a name at the beginning of a line.
std::optional<std::size_t> number_after(const std::string& path, const std::string& name) {
  std::ifstream file(path);
  for (std::string word; file >> word;) {
    std::size_t number = 0;
    if (word == name && file >> number) return number;
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return {};
}

// The names of the files of a version of control groups.
struct GroupFiles {
  const char* limit;
  const char* used;
  const char* reclaimable;  // the line of memory.stat with the files that can be dropped from memory
};
constexpr GroupFiles kVersion1 = {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr GroupFiles kVersion2 = {"memory.max", "memory.current", "inactive_file"};

// Limits `left` by a group and by all groups around it. Inside of a container, the path may be that outside
// of it, and only the last step finds files.
void limit_by_groups(MemoryLeft& left, const std::string& root, std::string path, const GroupFiles& names) {
  for (;;) {
    const std::string folder = root + path + "/";
    const auto most = number_in(folder + names.limit);
    const auto used = number_in(folder + names.used);
    if (most && used) {
      const std::size_t reclaimable = number_after(folder + "memory.stat", names.reclaimable).value_or(0);
      limit(left, difference(*most, difference(*used, reclaimable)),
            fmt::format("the memory limit of the control group ({}{})", folder, names.limit));
    }
    if (path.empty()) return;
    path.resize(path.rfind('/'));
  }
}

// Lines of the file are "number:controllers:path"; version 2 has number 0 and no controllers.
void limit_by_groups(MemoryLeft& left, const MemoryFiles& files) {
  std::ifstream groups(files.process + "/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = fmt::format(",{},", line.substr(first + 1, second - first - 1));
    std::string path = line.substr(second + 1);
    if (path.empty() || path.front() != '/') continue;
    if (path == "/") path.clear();
    if (controllers == ",,") {
      limit_by_groups(left, files.groups, path, kVersion2);
    } else if (controllers.find(",memory,") != std::string::npos) {
      limit_by_groups(left, files.groups + "/memory", path, kVersion1);
    }
  }
}

void limit_by_machine(MemoryLeft& left, const MemoryFiles& files) {
  const std::string path = files.process + "/meminfo";
  const auto available = number_after(path, "MemAvailable:");
  if (!available) return;
  constexpr std::size_t kUnit = 1024;
  limit(left, (*available + number_after(path, "SwapFree:").value_or(0)) * kUnit,
        "the free memory of the machine");
}

}  // namespace

MemoryLeft address_space_left([[maybe_unused]] const MemoryFiles& files) {
  MemoryLeft left{kUnlimited, ""};
#ifdef __linux__
  rlimit space{}, data{};
  getrlimit(RLIMIT_AS, &space);
  getrlimit(RLIMIT_DATA, &data);
  if (space.rlim_cur == RLIM_INFINITY && data.rlim_cur == RLIM_INFINITY) return left;
  // In pages: all, resident, shared, text, libraries, data with stack.
  std::ifstream file(files.process + "/self/statm");
  std::size_t all = 0, ignored = 0, used_data = 0;
  if (!(file >> all >> ignored >> ignored >> ignored >> ignored >> used_data)) return left;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  if (space.rlim_cur != RLIM_INFINITY) {
    limit(left, difference(space.rlim_cur, all * page), "the limit of the address space (ulimit -v)");
  }
  if (data.rlim_cur != RLIM_INFINITY) {
    limit(left, difference(data.rlim_cur, used_data * page), "the limit of the data segment (ulimit -d)");
  }
#endif
  return left;
}

MemoryLeft memory_left(const MemoryFiles& files) {
  MemoryLeft left = address_space_left(files);
  limit_by_machine(left, files);
  limit_by_groups(left, files);
  return left;
}

std::size_t physical_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), bytes = sysconf(_SC_PAGESIZE);
  return pages > 0 && bytes > 0 ? static_cast<std::size_t>(pages) * static_cast<std::size_t>(bytes) : 0;
}

}  // namespace flaunay::host
