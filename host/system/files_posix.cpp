#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include "host/system/files.hpp"

namespace flaunay::system {
namespace {

FileStatus status_from(const struct stat& status) {
  const FileKind kind = S_ISREG(status.st_mode)   ? FileKind::regular
                        : S_ISDIR(status.st_mode) ? FileKind::folder
                                                  : FileKind::other;
  return {kind, static_cast<std::uint64_t>(status.st_size), static_cast<std::uint64_t>(status.st_dev),
          status.st_mode & 07777U};
}

}  // namespace

int open_file(const std::string& name, Access access) {
  const int how = access == Access::read    ? O_RDONLY
                  : access == Access::write ? O_WRONLY
                                            : O_WRONLY | O_CREAT | O_EXCL;
  return ::open(name.c_str(), how | O_CLOEXEC, 0666);
}

int open_unnamed(const std::string& folder) {
#ifdef O_TMPFILE
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
  if (unnamed >= 0) return unnamed;
#endif
  // Not every file system can do that.
  std::string path = folder + "/.flaunay-XXXXXX";
  const int file = ::mkostemp(path.data(), O_CLOEXEC);
  if (file >= 0) ::unlink(path.c_str());
  return file;
}

bool close_file(int file) { return ::close(file) == 0; }

std::int64_t read_some(int file, void* to, std::size_t bytes) { return ::read(file, to, bytes); }
std::int64_t write_some(int file, const void* data, std::size_t bytes) { return ::write(file, data, bytes); }
std::int64_t read_some_at(int file, std::uint64_t place, void* to, std::size_t bytes) {
  return ::pread(file, to, bytes, static_cast<off_t>(place));
}
std::int64_t write_some_at(int file, std::uint64_t place, const void* data, std::size_t bytes) {
  return ::pwrite(file, data, bytes, static_cast<off_t>(place));
}

bool cut_file(int file, std::uint64_t bytes) { return ::ftruncate(file, static_cast<off_t>(bytes)) == 0; }

bool write_to_disk(int file) { return ::fsync(file) == 0; }

bool write_folder_to_disk(const std::string& name) {
  const int folder = ::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
#ifdef __linux__
  const bool is_written = folder >= 0 && ::syncfs(folder) == 0;
#else
  const bool is_written = folder >= 0 && ::fsync(folder) == 0;
#endif
  const int reason = errno;
  if (folder >= 0) ::close(folder);
  errno = reason;
  return is_written;
}

void release_bytes([[maybe_unused]] int file, [[maybe_unused]] std::uint64_t begin,
                   [[maybe_unused]] std::uint64_t count) {
#ifdef __linux__
  // If this fails, nothing is wrong but that the room is given back later.
  static_cast<void>(::fallocate(file, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(begin),
                                static_cast<off_t>(count)));
#endif
}

std::optional<FileStatus> status_of(int file) {
  struct stat status {};
  if (::fstat(file, &status) != 0) return {};
  return status_from(status);
}

std::optional<FileStatus> status_of(const std::string& name) {
  struct stat status {};
  if (::stat(name.c_str(), &status) != 0) return {};
  return status_from(status);
}

void set_permissions(int file, unsigned permissions) {
  // Errors are ignored: some file systems have no modes.
  if (::fchmod(file, permissions) != 0) return;
}

bool is_readable(const std::string& name) { return ::access(name.c_str(), R_OK) == 0; }

bool is_writable(const std::string& name) {
  return ::faccessat(AT_FDCWD, name.c_str(), W_OK, AT_EACCESS) == 0;
}

bool is_one_file(const std::string& a, const std::string& b) {
  struct stat of_a {
  }, of_b{};
  return ::stat(a.c_str(), &of_a) == 0 && ::stat(b.c_str(), &of_b) == 0 && of_a.st_dev == of_b.st_dev &&
         of_a.st_ino == of_b.st_ino;
}

bool rename_file(const std::string& from, const std::string& to) {
  return std::rename(from.c_str(), to.c_str()) == 0;
}

bool link_file(const std::string& name, const std::string& second) {
  return ::link(name.c_str(), second.c_str()) == 0;
}

bool remove_file(const std::string& name) { return std::remove(name.c_str()) == 0; }

std::size_t last_name(const std::string& path) { return path.find_last_of('/') + 1; }

std::string temporary_folder() {
  const std::string usual = environment("TMPDIR");
  return usual.empty() ? "/tmp" : usual;
}

std::string cache_folder() {
  // Relative paths are not used.
  const std::string caches = environment("XDG_CACHE_HOME"), home = environment("HOME");
  if (caches.starts_with('/')) return caches;
  return home.starts_with('/') ? home + "/.cache" : "";
}

std::string environment(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr ? value : "";
}

}  // namespace flaunay::system
