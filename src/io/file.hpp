// Reads and writes whole files. An OutputFile replaces its target only on success.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "flaunay/flaunay.hpp"

namespace flaunay::io {

// The binary formats are little-endian and are read and written as they lie in memory.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "flaunay::io needs a little-endian host");

/// Throws Error(input) with a message that starts with path.
template <typename... Arguments>
[[noreturn]] void fail(const std::string& path, fmt::format_string<Arguments...> format,
                       Arguments&&... arguments) {
  throw Error(ErrorKind::input,
              fmt::format("{}: {}", path, fmt::format(format, std::forward<Arguments>(arguments)...)));
}

inline std::string system_reason(int error_number) { return std::strerror(error_number); }

/// The part of the file's name from its last dot, in lower case; empty if there is no dot.
inline std::string ending_of(const std::string& path) {
  const std::string name = path.substr(path.find_last_of('/') + 1);
  const std::size_t dot = name.find_last_of('.');
  if (dot == std::string::npos) return "";
  std::string ending = name.substr(dot);
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

/// Throws Error(usage) saying that the ending of path is not among `expected`.
[[noreturn]] inline void fail_ending(const std::string& path, std::string_view expected) {
  const std::string ending = ending_of(path);
  throw Error(ErrorKind::usage,
              ending.empty() ? fmt::format("{}: has no ending; expected {}", path, expected)
                             : fmt::format("{}: unknown ending '{}'; expected {}", path, ending, expected));
}

/// The name of a path of read_file in messages.
inline std::string shown_path(const std::string& path) {
  return path == "-" ? std::string("- (standard input)") : path;
}

/// A file being read; "-" is standard input. Its beginning can be checked before the rest is read.
/// Throws Error(input).
class InputFile {
 public:
  /// expected: what should be in the file, for messages.
  InputFile(const std::string& path, std::string_view expected)
      : name_(shown_path(path)),
        expected_(expected),
        descriptor_(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    struct stat status {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
      const int reason = errno;
      close();
      fail(name_, "cannot be opened: {}; expected {}", system_reason(reason), expected_);
    }
    if (S_ISDIR(status.st_mode)) {
      close();
      fail(name_, "cannot be read: {}; expected {}", system_reason(EISDIR), expected_);
    }
    // The size of a regular file is known; room for one byte more detects the end in the same call. For pipes
    // the buffer grows.
    whole_ = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) + 1 : 1 << 16;
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile() { close(); }

  /// The first `count` bytes, or all if there are fewer. The view is valid until the next call.
  std::string_view first(std::size_t count) {
    read_until(count);
    return std::string_view(bytes_.data(), std::min(count, used_));
  }

  /// All bytes. Nothing can be read afterwards.
  std::string all() {
    for (std::size_t room = whole_; !ended_; room *= 2) read_until(room);
    bytes_.resize(used_);
    return std::move(bytes_);
  }

 private:
  /// Reads until there are `count` bytes or the file ends.
  void read_until(std::size_t count) {
    if (bytes_.size() < count) bytes_.resize(count);
    while (used_ < count && !ended_) {
      const ssize_t got = ::read(descriptor_, &bytes_[used_], count - used_);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) fail(name_, "cannot be read: {}", system_reason(errno));
      ended_ = got == 0;
      used_ += static_cast<std::size_t>(got);
    }
    if (used_ == 0 && ended_) fail(name_, "is empty (zero bytes); expected {}", expected_);
  }
  void close() {
    if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
  }

  std::string name_;
  std::string expected_;
  int descriptor_;
  std::size_t whole_ = 0;  // room for all bytes of a regular file
  std::string bytes_;      // the first used_ bytes were read
  std::size_t used_ = 0;
  bool ended_ = false;
};

/// The bytes of the file at path, or of standard input for "-". `expected` says what should have been in it.
inline std::string read_file(const std::string& path, std::string_view expected) {
  return InputFile(path, expected).all();
}

/// A file being written. The bytes go to a temporary file in the target's folder. commit renames it to the
/// target; without commit it is removed, so a failure leaves the target as it was. Targets that are not
/// regular files (devices, pipes, "-" for standard output) are written directly. Throws Error(input).
class OutputFile {
 public:
  explicit OutputFile(const std::string& path) : path_(path) {
    if (path == "-") {
      descriptor_ = STDOUT_FILENO;
      return;
    }
    const Target target = find_target(path);
    target_ = target.path;
    if (target.direct) {
      descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
      if (descriptor_ < 0) fail(path_, "cannot be opened for writing: {}", system_reason(errno));
    } else {
      create_temporary(target);
    }
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile() {
    if (descriptor_ > STDERR_FILENO) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  /// Throws the error that writing would throw if the path cannot be created. Leaves no file behind.
  static void check(const std::string& path) {
    if (!find_target(path).direct) OutputFile probe(path);
  }

  template <typename... Arguments>
  void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(fmt::appender(buffer_), format, std::forward<Arguments>(arguments)...);
    flush_if_full();
  }
  void write(const void* data, std::size_t bytes) {
    const char* begin = static_cast<const char*>(data);
    if (bytes >= kFull) {
      flush();
      write_through(begin, bytes);
    } else {
      buffer_.append(begin, begin + bytes);
      flush_if_full();
    }
  }
  template <typename Value>
  void write_value(const Value& value) {
    write(&value, sizeof value);
  }

  /// Writes everything and closes the file; the target is still untouched.
  void finish() {
    flush();
    if (descriptor_ > STDERR_FILENO) {
      const int closed = ::close(descriptor_);
      descriptor_ = -1;
      if (closed != 0) fail(path_, "cannot be written: {}", system_reason(errno));
    }
  }
  /// Calls finish, then replaces the target.
  void commit() {
    finish();
    if (temporary_.empty()) return;
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
      fail(path_, "cannot be replaced by the written file: {}", system_reason(errno));
    }
    temporary_.clear();
  }

 private:
  static constexpr std::size_t kFull = std::size_t{1} << 20;

  struct Target {
    std::string path;     // symbolic links followed
    bool direct = false;  // exists and is not a regular file
    bool exists = false;
    mode_t mode = 0;
  };

  static Target find_target(const std::string& path) {
    Target target;
    target.path = path;
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) {
      if (errno != ENOENT) fail(path, "cannot be written: {}", system_reason(errno));
      return target;
    }
    if (S_ISDIR(status.st_mode)) fail(path, "cannot be written: {}", system_reason(EISDIR));
    // Checked, because a rename would replace even a write-protected file.
    if (::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0)
      fail(path, "cannot be written: {}", system_reason(errno));
    target.exists = true;
    target.direct = !S_ISREG(status.st_mode);
    target.mode = status.st_mode & 07777;
    std::error_code error;
    const std::filesystem::path real = std::filesystem::canonical(path, error);
    if (!error) target.path = real.string();
    return target;
  }

  void create_temporary(const Target& target) {
    const std::size_t slash = target_.find_last_of('/');
    const std::string folder = slash == std::string::npos ? "." : target_.substr(0, slash + 1);
    for (int attempt = 0;; ++attempt) {
      // A short name of its own, because the target's may be as long as the file system allows.
      const std::string name = fmt::format("{}/.flaunay-{}-{}.tmp", folder, ::getpid(), attempt);
      descriptor_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (descriptor_ >= 0) {
        temporary_ = name;
        break;
      }
      if (errno != EEXIST) {
        fail(path_, "cannot be created in folder '{}': {}", folder, system_reason(errno));
      }
    }
    // Errors are ignored: some file systems have no modes.
    if (target.exists && ::fchmod(descriptor_, target.mode) != 0) return;
  }

  void flush_if_full() {
    if (buffer_.size() >= kFull) flush();
  }
  void flush() {
    write_through(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  void write_through(const char* data, std::size_t bytes) {
    while (bytes > 0) {
      const ssize_t written = ::write(descriptor_, data, bytes);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(path_, "cannot be written: {}", system_reason(errno));
      data += written;
      bytes -= static_cast<std::size_t>(written);
    }
  }

  std::string path_;
  std::string target_;
  std::string temporary_;  // empty: written directly, or already in place
  int descriptor_ = -1;
  fmt::memory_buffer buffer_;
};

}  // namespace flaunay::io
