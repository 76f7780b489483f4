// A file for data that does not fit memory, which vanishes with the process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace flaunay::io {

/// The folder itself, or if it is empty TMPDIR, or else the system's (/tmp).
std::string scratch_folder(const std::string& folder);

/// How many bytes can be written in a folder; the largest number if the system does not say.
std::uint64_t free_bytes(const std::string& folder);

/// A file without a name. Throws Error(input) that names the folder.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& folder);
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile();

  void append(const void* data, std::size_t bytes);
  /// Writes at any place, also beyond the end; size() does not count it. Several threads may call it.
  void write_at(std::uint64_t begin, const void* data, std::size_t bytes);
  /// Reads bytes that were written.
  void read_at(std::uint64_t begin, std::size_t count, void* to) const;
  std::uint64_t size() const { return size_; }

  /// Gives the room of bytes that are not read again back, where the file system can.
  void release(std::uint64_t begin, std::uint64_t count);
  /// The most bytes that it had, without those that were given back.
  std::uint64_t largest_bytes() const { return largest_; }

  /// Fails unless the folder has room for this many more bytes. what: the purpose of the bytes.
  void require_room(std::uint64_t bytes, const std::string& what) const;

 private:
  std::string folder_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0, held_ = 0, largest_ = 0;
};

}  // namespace flaunay::io
