#include "files/disk_space.hpp"

#include <array>
#include <cerrno>
#include <map>
#include <optional>

#include "files/file.hpp"
#include "files/output.hpp"
#include "files/scratch.hpp"

namespace flaunay::io {
namespace {

std::string readable(std::uint64_t bytes) {
  constexpr std::array<const char*, 4> kUnits = {"KiB", "MiB", "GiB", "TiB"};
  double size = static_cast<double>(bytes) / 1024;
  std::size_t unit = 0;
  for (; size >= 1024 && unit + 1 < kUnits.size(); ++unit) size /= 1024;
  return fmt::format("{:.1f} {}", size, kUnits[unit]);
}

}  // namespace

void check_disk_space(const std::vector<SizedOutput>& files) {
  struct Disk {
    std::string path, folder;  // of the first of its files
    std::uint64_t needed = 0;
    bool has_outputs = false, has_scratch = false;
  };
  std::map<std::uint64_t, Disk> disks;
  for (const SizedOutput& file : files) {
    if (file.path.empty() || file.path == "-") continue;
    std::string folder = file.path;
    if (!file.is_scratch) {
      const Target target = find_target(file.path);
      if (target.is_direct) continue;
      folder = target.folder;
    }
    const std::optional<system::FileStatus> status = system::status_of(folder);
    if (!status) {
      fail(file.path, "has no room for a scratch file: {}", system_reason(errno));
    }
    Disk& disk = disks.try_emplace(status->disk, Disk{file.path, folder}).first->second;
    disk.needed += file.bytes;
    (file.is_scratch ? disk.has_scratch : disk.has_outputs) = true;
  }
  for (const auto& [device, disk] : disks) {
    const std::uint64_t room = free_bytes(disk.folder);
    if (disk.needed <= room) continue;
    if (!disk.has_outputs) {
      fail(disk.path, "has room for {}, but the scratch file needs {}; name another scratch folder",
           readable(room), readable(disk.needed));
    }
    fail(disk.path, "the disk of '{}' has room for {}, but the outputs{} need {}", disk.folder,
         readable(room), disk.has_scratch ? " and the scratch file" : "", readable(disk.needed));
  }
}

}  // namespace flaunay::io
