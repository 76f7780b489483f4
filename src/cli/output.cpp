#include "cli/output.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "flaunay/flaunay.hpp"
#include "io/file.hpp"
#include "io/mesh.hpp"
#include "io/points.hpp"
#include "io/scratch.hpp"

namespace flaunay::cli {

bool print(const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
    return true;
  if (errno == EPIPE || errno == EBADF) return false;
  throw Error(ErrorKind::input, fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

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
    const io::Target target = io::find_target(file.path);
    if (target.is_direct) continue;
    const auto same = [&](const Disk& disk) { return disk.device == target.folder_id.device; };
    auto disk = std::find_if(disks.begin(), disks.end(), same);
    if (disk == disks.end())
      disk = disks.insert(disk, {target.folder_id.device, file.path, target.folder, 0});
    disk->needed += file.bytes;
  }
  for (const Disk& disk : disks) {
    const std::uint64_t room = io::free_bytes(disk.folder);
    if (disk.needed > room) {
      io::fail(disk.path, "the disk of '{}' has room for {}, but the outputs need {}", disk.folder,
               readable(room), readable(disk.needed));
    }
  }
}

OutputFiles::OutputFiles(const std::string& input) : input_(input) {}

void OutputFiles::reserve(const std::string& path) {
  const io::Target target = io::find_target(path);
  struct stat input {};
  const bool is_file = input_ != "-" && ::stat(input_.c_str(), &input) == 0;
  if (is_file && target.exists && target.id == io::file_id(input)) {
    throw Error(ErrorKind::usage, fmt::format("{}: this output would overwrite the input", path));
  }
  for (const io::Target& other : announced_) {
    if (io::is_same(target, other)) {
      throw Error(ErrorKind::usage, fmt::format("{}: two outputs have the same path", path));
    }
  }
  announced_.push_back(target);
}

void OutputFiles::add_mesh(const std::string& path) {
  if (path.empty()) return;
  io::check_mesh_output(path);
  reserve(path);
  const std::string ending = io::ending_of(path);
  if (ending == ".ele") reserve(path.substr(0, path.size() - ending.size()) + ".node");
}

void OutputFiles::add(const std::string& path, const std::string& ending) {
  if (path.empty()) return;
  io::check_output(path, ending);
  reserve(path);
}

void OutputFiles::add_points(const std::string& path) {
  if (path == "-") return;
  io::check_points_output(path);
  io::check_output(path, io::ending_of(path));
  reserve(path);
}

}  // namespace flaunay::cli
