// Writes files. The files of a run replace their targets together when all are complete, or not at all.
#pragma once

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "files/temporary.hpp"

namespace flaunay::io {

/// The type of the indices in a file.
enum class IndexType { int32, int64 };

/// What the system tells files apart by, whatever their paths.
struct FileId {
  dev_t device = 0;
  ino_t number = 0;

  bool operator==(const FileId&) const = default;
};
inline FileId file_id(const struct stat& status) { return {status.st_dev, status.st_ino}; }

/// Where an output goes, with symbolic links followed, also those to files that do not exist yet.
struct Target {
  std::string folder;  ///< ends with a slash
  std::string name;    ///< in the folder
  FileId folder_id;
  bool exists = false;
  bool is_direct = false;  ///< it exists and is no regular file, such as a device or a pipe
  FileId id;               ///< if it exists
  mode_t mode = 0;         ///< if it exists

  std::string path() const { return folder + name; }
};

/// Throws Error(input) if a file cannot be written there.
Target find_target(const std::string& path);

/// Whether both are one file, or would be one if they existed. Some folders do not tell upper case from lower
/// case.
bool is_same(const Target& a, const Target& b);

/// A file being written. Its bytes go to a file without a name in the target's folder, or to a temporary file
/// where the system has no files without names. Targets that are no regular files (devices, pipes, "-" for
/// standard output) are written directly. All functions throw Error(input).
class OutputFile {
 public:
  explicit OutputFile(const std::string& path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Throws the error that writing would throw if the path cannot be created. Leaves no file behind.
  static void check(const std::string& path);

  template <typename... Arguments>
  void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(fmt::appender(buffer_), format, std::forward<Arguments>(arguments)...);
    flush_if_full();
  }
  void write(const void* data, std::size_t bytes);
  /// Writes at a place of the file, counted in bytes from its beginning, whatever else is written. Only
  /// regular files have places.
  void write_at(std::uint64_t place, const void* data, std::size_t bytes);
  template <typename Value>
  void write_value(const Value& value) {
    write(&value, sizeof value);
  }

 private:
  friend class Outputs;

  static constexpr std::size_t kFull = std::size_t{1} << 20;

  /// Whether it replaces its target in the end; otherwise it is written directly.
  bool is_placed() const { return path_ != "-" && !target_.is_direct; }
  void open_temporary();
  void flush_if_full() {
    if (buffer_.size() >= kFull) flush();
  }
  void flush();
  void write_through(const char* data, std::size_t bytes);
  void write_to_disk();
  void give_name();
  void close();

  std::string path_;  // as the user wrote it
  Target target_;
  Temporary temporary_;  // none while the file has no name, and if it is written directly
  int descriptor_ = -1;
  FileId id_;  // of the written file
  fmt::memory_buffer buffer_;
};

/// Checks a path before any work. Throws Error(usage) unless it ends in `ending` (".npy", ".json"), and
/// Error(input) if the file cannot be created. Leaves no new file behind.
void check_output(const std::string& path, const std::string& ending);

/// The files that one run writes.
class Outputs {
 public:
  /// The reference is valid until commit.
  OutputFile& open(const std::string& path);

  /// Writes all files to the disk. The targets are still untouched.
  void write_out();
  /// Calls write_out, and then replaces the targets. If that fails for one, all targets stay as they were, or
  /// are made so again; the message says if that fails too.
  void commit();
  /// The same, but does not wait until the files are on the disk. For many small files in a new folder.
  void commit_without_waiting();

 private:
  struct Placed {
    OutputFile* file;
    bool has_replaced;  // what was there has the temporary name now
  };
  void place_all();
  void place(OutputFile& file);
  std::string take_back();

  std::vector<std::unique_ptr<OutputFile>> files_;
  std::vector<Placed> placed_;
};

}  // namespace flaunay::io
