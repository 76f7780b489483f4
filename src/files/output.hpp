// Writes files. The files of a run replace their targets together when all are complete, or not at all.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "files/temporary.hpp"
#include "host/system/files.hpp"

namespace flaunay::io {

/// The type of the indices in a file.
enum class IndexType { int32, int64 };

/// Where an output goes, with symbolic links followed, also those to files that do not exist yet.
struct Target {
  std::string path;
  std::string folder;  ///< ends with a slash
  bool exists = false;
  bool is_direct = false;    ///< it exists and is no regular file, such as a device or a pipe
  unsigned permissions = 0;  ///< if it exists
};

using system::is_one_file;

/// Throws Error(input) if a file cannot be written there.
Target find_target(const std::string& path);

/// A file being written. Its bytes go to a partial file beside the target, whose name has the target's in it.
/// Targets that are no regular files (devices, pipes, "-" for standard output) are written directly. All
/// functions throw Error(input).
class OutputFile {
 public:
  /// Creates the partial file. Throws Error(usage) if this process writes another one for the same target.
  explicit OutputFile(const std::string& path);
  /// Opens the partial file that another process has created for the path, for write_at.
  OutputFile(const std::string& path, const std::string& partial);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  template <typename... Arguments>
  void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(fmt::appender(buffer_), format, std::forward<Arguments>(arguments)...);
    if (buffer_.size() >= kFull) flush();
  }
  void write(const void* data, std::size_t bytes);
  /// Writes at a place of the file, counted in bytes from its beginning, whatever else is written. Only
  /// regular files have places.
  void write_at(std::uint64_t place, const void* data, std::size_t bytes);
  /// Truncates a regular file to this size.
  void cut(std::uint64_t bytes);
  template <typename Value>
  void write_value(const Value& value) {
    write(&value, sizeof value);
  }

  /// As the user wrote it.
  const std::string& path() const { return path_; }
  /// Empty if the file is written directly.
  const std::string& partial_path() const { return partial_.path(); }

 private:
  friend class Outputs;

  static constexpr std::size_t kFull = std::size_t{1} << 20;

  void start();
  void flush();
  void close();
  void check_written(bool is_written) const;

  std::string path_;
  Target target_;
  Temporary partial_;
  int descriptor_ = -1;
  bool is_used_ = false;  // Outputs::open has returned it
  fmt::memory_buffer buffer_;
};

/// The files that one run writes. Files that are not committed change nothing.
class Outputs {
 public:
  /// inputs: files that no output may overwrite; "-" is ignored.
  explicit Outputs(std::vector<std::string> inputs = {}) : inputs_(std::move(inputs)) {}

  /// Creates a file that may be written later, to find errors before the work begins. Throws Error(input) if
  /// it cannot be created, Error(usage) if it is an input, or another file of this run has the path, however
  /// it is written.
  void announce(const std::string& path);
  /// A file that was announced, or else a new one. The reference is valid until commit.
  OutputFile& open(const std::string& path);
  /// Opens a partial file of another process, which commits it when this one has called write_out.
  OutputFile& join(const std::string& path, const std::string& partial);
  /// An old file, or a link to one, that commit removes. No output of this run may have the path.
  void remove(const std::string& path) { removed_.push_back(path); }

  std::vector<std::string> notes;  ///< a sentence for each thing that files do not keep

  /// Writes and closes the files that were opened, so that there may be more than the system keeps open.
  void close();
  /// Writes all files to the disk. The targets are still untouched.
  void write_out();
  /// Calls write_out, and then replaces the targets. If that fails for one, all targets stay as they were, or
  /// are made so again; the message says if that fails too.
  void commit();

 private:
  struct Placed {
    std::string path;  // as the user wrote it
    std::string target;
    std::string old;  // the file that was there, now; empty if there was none
  };
  void place(const OutputFile& file);
  void keep_old(const std::string& path, const Target& target, bool is_removed);
  std::string take_back();

  std::vector<std::string> inputs_;
  std::vector<std::unique_ptr<OutputFile>> files_;
  std::vector<std::string> removed_;
  std::vector<Placed> placed_;
  std::string closed_in_;  // a folder with files that were closed before they were on the disk
};

}  // namespace flaunay::io
