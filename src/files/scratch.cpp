#include "files/scratch.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "files/file.hpp"
#include "files/temporary.hpp"

namespace flaunay::io {
namespace {

int open_scratch(const std::string& folder) {
  // No signal ends the process while the file has a name.
  const Uninterrupted named;
  return system::open_unnamed(folder);
}

}  // namespace

std::string scratch_folder(const std::string& folder) {
  return folder.empty() ? system::temporary_folder() : folder;
}

std::uint64_t free_bytes(const std::string& folder) {
  std::error_code unknown;  // then it is the largest number
  return std::filesystem::space(folder, unknown).available;
}

ScratchFile::ScratchFile(const std::string& folder)
    : folder_(scratch_folder(folder)), descriptor_(open_scratch(folder_)) {
  if (descriptor_ < 0) fail(folder_, "has no room for a scratch file: {}", system_reason(errno));
}

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) system::close_file(descriptor_);
}

void ScratchFile::append(const void* data, std::size_t bytes) {
  write_at(size_, data, bytes);
  size_ += bytes;
  held_ += bytes;
  largest_ = std::max(largest_, held_);
}

void ScratchFile::write_at(std::uint64_t begin, const void* data, std::size_t bytes) {
  if (system::write_at(descriptor_, begin, data, bytes)) return;
  fail(folder_, "the scratch file cannot be written at byte {}: {}", begin, system_reason(errno));
}

void ScratchFile::read_at(std::uint64_t begin, std::size_t count, void* to) const {
  if (system::read_at(descriptor_, begin, count, to) == count) return;
  fail(folder_, "the scratch file of {} bytes cannot be read at byte {}: {}", size_, begin,
       errno != 0 ? system_reason(errno) : "it ends there");
}

void ScratchFile::release(std::uint64_t begin, std::uint64_t count) {
  held_ -= count;
  system::release_bytes(descriptor_, begin, count);
}

void ScratchFile::require_room(std::uint64_t bytes, const std::string& what) const {
  const std::uint64_t room = free_bytes(folder_);
  if (bytes > room) {
    fail(folder_, "has room for {} bytes, but {} need about {}; name another scratch folder", room, what,
         bytes);
  }
}

}  // namespace flaunay::io
