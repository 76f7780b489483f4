#include "io/disk_space.hpp"

#include <algorithm>
#include <array>

#include "io/file.hpp"
#include "io/output.hpp"
#include "io/scratch.hpp"

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
  };
  std::vector<Disk> disks;
  for (const SizedOutput& file : files) {
    if (file.path.empty() || file.path == "-") continue;
    const Target target = find_target(file.path);
    if (target.is_direct) continue;
    const auto same = [&](const Disk& disk) { return disk.device == target.folder_id.device; };
    auto disk = std::find_if(disks.begin(), disks.end(), same);
    if (disk == disks.end())
      disk = disks.insert(disk, {target.folder_id.device, file.path, target.folder, 0});
    disk->needed += file.bytes;
  }
  for (const Disk& disk : disks) {
    const std::uint64_t room = free_bytes(disk.folder);
    if (disk.needed > room) {
      fail(disk.path, "the disk of '{}' has room for {}, but the outputs need {}", disk.folder,
           readable(room), readable(disk.needed));
    }
  }
}

}  // namespace flaunay::io
