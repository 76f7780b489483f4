// Files by descriptors, in one way on all systems: files_posix.cpp and files_windows.cpp. Names are in UTF-8
// and contents are bytes. Functions that fail leave the reason in errno.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace flaunay::system {

enum class Access {
  read,
  write,
  create  ///< writes a new file; fails if there is something of this name
};

/// Returns a descriptor, -1 if that fails. Folders can be opened for reading, and have a status.
int open_file(const std::string& name, Access access);
/// A file for reading and writing that has no name, or none that stays.
int open_unnamed(const std::string& folder);
bool close_file(int file);

/// Reads or writes some bytes, at a place of the file or after the last ones. Returns how many; -1 if that
/// fails; 0: there are no more. Several threads may use places of one file.
std::int64_t read_some(int file, void* to, std::size_t bytes);
std::int64_t write_some(int file, const void* data, std::size_t bytes);
std::int64_t read_some_at(int file, std::uint64_t place, void* to, std::size_t bytes);
std::int64_t write_some_at(int file, std::uint64_t place, const void* data, std::size_t bytes);
/// Truncates the file to this size. Returns whether it succeeded.
bool cut_file(int file, std::uint64_t bytes);

/// Calls `part(done)`, which reads or writes some of the bytes after those that are done, until all are or no
/// more come. Returns how many are done; if not all, errno is the reason, or 0 if no more came.
template <typename Part>
std::size_t move_bytes(std::size_t bytes, const Part& part) {
  std::size_t done = 0;
  while (done < bytes) {
    errno = 0;
    const std::int64_t more = part(done);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) break;
    done += static_cast<std::size_t>(more);
  }
  return done;
}
/// Whether all bytes were written to an open file, at a place of it or after the last ones.
inline bool write_at(int file, std::uint64_t place, const void* data, std::size_t bytes) {
  return bytes == move_bytes(bytes, [=](std::size_t done) {
           return write_some_at(file, place + done, static_cast<const char*>(data) + done, bytes - done);
         });
}
inline bool write_next(int file, const void* data, std::size_t bytes) {
  return bytes == move_bytes(bytes, [=](std::size_t done) {
           return write_some(file, static_cast<const char*>(data) + done, bytes - done);
         });
}
/// Reads from a place of an open file. Returns how many bytes there are, as move_bytes.
inline std::size_t read_at(int file, std::uint64_t place, std::size_t bytes, void* to) {
  return move_bytes(bytes, [=](std::size_t done) {
    return read_some_at(file, place + done, static_cast<char*>(to) + done, bytes - done);
  });
}

/// Returns when the written data is on the disk.
bool write_to_disk(int file);
/// As write_to_disk for the files that were written in a folder and closed, where systems can do that.
bool write_folder_to_disk(const std::string& folder);
/// Gives the room of these bytes back, where the file system can.
void release_bytes(int file, std::uint64_t begin, std::uint64_t count);

enum class FileKind { regular, folder, other };
struct FileStatus {
  FileKind kind;
  std::uint64_t bytes;
  std::uint64_t disk;    ///< files on one disk have the same number
  unsigned permissions;  ///< for set_permissions
};
std::optional<FileStatus> status_of(int file);
std::optional<FileStatus> status_of(const std::string& name);
/// Gives a file the permissions of another one, where file systems have them.
void set_permissions(int file, unsigned permissions);
bool is_readable(const std::string& name);
bool is_writable(const std::string& name);
/// Whether both are one file, or folder, that exists.
bool is_one_file(const std::string& a, const std::string& b);

/// Renames a file or folder in one step, and replaces a file that has the new name.
bool rename_file(const std::string& from, const std::string& to);
/// Gives a file a second name.
bool link_file(const std::string& name, const std::string& second);
/// Removes a file or an empty folder.
bool remove_file(const std::string& name);

/// Where in a path the last name begins, which ends it.
std::size_t last_name(const std::string& path);
/// The path of a file beside the one of this path: "partial" for one on its way there. For one path this
/// process has one such file, by the rules of the file system for names, and other processes have others.
std::string temporary_path(const std::string& path, const char* what);
/// A folder for files that nobody needs for long.
std::string temporary_folder();
/// The folder of the user's caches: XDG_CACHE_HOME or ~/.cache, or on Windows LOCALAPPDATA; empty if it is
/// not known.
std::string cache_folder();
/// The value of an environment variable; empty if it is not set.
std::string environment(const char* variable);

}  // namespace flaunay::system
