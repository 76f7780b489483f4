#include "files/scratch.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <limits>

#include "files/file.hpp"
#include "files/temporary.hpp"

namespace flaunay::io {
namespace {

int open_scratch(const std::string& folder) {
#ifdef O_TMPFILE
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
  if (unnamed >= 0) return unnamed;
#endif
  // Not every file system can do that. No signal ends the process while the file has a name.
  const Uninterrupted named;
  std::string path = folder + "/.flaunay-XXXXXX";
  const int file = ::mkostemp(path.data(), O_CLOEXEC);
  if (file >= 0) ::unlink(path.c_str());
  return file;
}

}  // namespace

std::string scratch_folder(const std::string& folder) {
  if (!folder.empty()) return folder;
  const char* usual = std::getenv("TMPDIR");
  return usual != nullptr && *usual != '\0' ? usual : "/tmp";
}

std::uint64_t free_bytes(const std::string& folder) {
  struct statvfs system {};
  if (::statvfs(folder.c_str(), &system) != 0) return std::numeric_limits<std::uint64_t>::max();
  return static_cast<std::uint64_t>(system.f_bavail) * system.f_frsize;
}

ScratchFile::ScratchFile(const std::string& folder)
    : folder_(scratch_folder(folder)), descriptor_(open_scratch(folder_)) {
  if (descriptor_ < 0) fail(folder_, "has no room for a scratch file: {}", system_reason(errno));
}

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ScratchFile::append(const void* data, std::size_t bytes) {
  write_at(size_, data, bytes);
  size_ += bytes;
  held_ += bytes;
  largest_ = std::max(largest_, held_);
}

void ScratchFile::write_at(std::uint64_t begin, const void* data, std::size_t bytes) {
  if (io::write_at(descriptor_, begin, data, bytes)) return;
  fail(folder_, "the scratch file cannot be written at byte {}: {}", begin, system_reason(errno));
}

void ScratchFile::read_at(std::uint64_t begin, std::size_t count, void* to) const {
  if (io::read_at(descriptor_, begin, count, to) == count) return;
  fail(folder_, "the scratch file of {} bytes cannot be read at byte {}: {}", size_, begin,
       errno != 0 ? system_reason(errno) : "it ends there");
}

void ScratchFile::release(std::uint64_t begin, std::uint64_t count) {
  held_ -= count;
#ifdef __linux__
  // If this fails, nothing is wrong but that the room is given back later.
  static_cast<void>(::fallocate(descriptor_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE,
                                static_cast<off_t>(begin), static_cast<off_t>(count)));
#endif
}

void ScratchFile::require_room(std::uint64_t bytes, const std::string& what) const {
  const std::uint64_t room = free_bytes(folder_);
  if (bytes > room) {
    fail(folder_, "has room for {} bytes, but {} need about {}; name another scratch folder", room, what,
         bytes);
  }
}

}  // namespace flaunay::io
