#include "files/disk_space.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>

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
    dev_t device;
    std::string path, folder;  // of one of its files
    std::uint64_t needed;
    bool has_outputs, has_scratch;
  };
  std::vector<Disk> disks;
  for (const SizedOutput& file : files) {
    if (file.path.empty() || file.path == "-") continue;
    Disk found{0, file.path, file.path, 0, !file.is_scratch, file.is_scratch};
    if (file.is_scratch) {
      struct stat status {};
      if (::stat(file.path.c_str(), &status) != 0) {
        fail(file.path, "has no room for a scratch file: {}", system_reason(errno));
      }
      found.device = status.st_dev;
    } else {
      const Target target = find_target(file.path);
      if (target.is_direct) continue;
      found.device = target.folder_id.device;
      found.folder = target.folder;
    }
    const auto same = [&](const Disk& disk) { return disk.device == found.device; };
    auto disk = std::find_if(disks.begin(), disks.end(), same);
    if (disk == disks.end()) disk = disks.insert(disk, found);
    disk->needed += file.bytes;
    disk->has_outputs |= found.has_outputs;
    disk->has_scratch |= found.has_scratch;
  }
  for (const Disk& disk : disks) {
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
