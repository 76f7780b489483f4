// Reads whole files; errors that name a file.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "files/printable.hpp"
#include "flaunay/flaunay.hpp"
#include "host/system/files.hpp"

namespace flaunay::io {

// The binary formats are little-endian and are read and written as they lie in memory.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "flaunay::io needs a little-endian host");

/// Throws Error(input) with a printable message that starts with path.
template <typename... Arguments>
[[noreturn]] void fail(const std::string& path, fmt::format_string<Arguments...> format,
                       Arguments&&... arguments) {
  const std::string text = fmt::format(format, std::forward<Arguments>(arguments)...);
  throw Error(ErrorKind::input, printable(fmt::format("{}: {}", path, text)));
}

inline std::string system_reason(int error_number) { return std::strerror(error_number); }

/// The text with the letters of ASCII in lower case.
inline std::string lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}
/// The part of the file's name from its last dot, in lower case; empty if there is no dot.
inline std::string ending_of(const std::string& path) {
  const std::string name = path.substr(system::last_name(path));
  const std::size_t dot = name.find_last_of('.');
  if (dot == std::string::npos) return "";
  return lower(name.substr(dot));
}

/// Throws Error(usage) saying that the ending of path is not among `expected`.
[[noreturn]] inline void fail_ending(const std::string& path, std::string_view expected) {
  const std::string ending = ending_of(path);
  throw Error(ErrorKind::usage,
              ending.empty() ? fmt::format("{}: has no ending; expected {}", path, expected)
                             : fmt::format("{}: unknown ending '{}'; expected {}", path, ending, expected));
}

inline void check_ending(const std::string& path, std::string_view expected) {
  if (ending_of(path) != expected) fail_ending(path, expected);
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
        descriptor_(path == "-" ? kStandardInput : system::open_file(path, system::Access::read)) {
    std::optional<system::FileStatus> status;
    if (descriptor_ >= 0) status = system::status_of(descriptor_);
    const bool is_open = status.has_value();
    const int reason = !is_open ? errno : status->kind == system::FileKind::folder ? EISDIR : 0;
    if (reason != 0) {
      close();
      fail(name_, "cannot be {}: {}; expected {}", is_open ? "read" : "opened", system_reason(reason),
           expected_);
    }
    if (status->kind == system::FileKind::regular && status->bytes > 0) {
      size_ = static_cast<std::int64_t>(status->bytes);
    }
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile() { close(); }

  /// The first `count` bytes, or all if there are fewer. The view is valid until the next call.
  std::string_view first(std::size_t count) {
    read_until(count);
    return std::string_view(bytes_.data(), std::min(count, used_));
  }

  /// The size of a regular file, or of a pipe that was loaded; unknown, -1, of other pipes.
  std::int64_t size() const { return size_; }

  /// Reads all of a pipe into memory. Later reads behave as with a regular file.
  void load_pipe() {
    if (size_ >= 0) return;
    load();
    size_ = static_cast<std::int64_t>(used_);
    is_loaded_ = true;
  }

  /// Reads the next bytes after the end of this function's last call, independently of the other functions.
  /// Returns how many there are; fewer than `count` at the end.
  std::size_t read_next(char* to, std::size_t count) {
    if (ended_) return 0;
    const std::size_t got = system::move_bytes(
        count, [&](std::size_t done) { return system::read_some(descriptor_, to + done, count - done); });
    if (got < count && errno != 0) fail(name_, "cannot be read: {}", system_reason(errno));
    ended_ = got < count;
    used_ += got;
    if (used_ == 0 && ended_) fail(name_, "is empty (zero bytes); expected {}", expected_);
    return got;
  }

  /// Reads the bytes [begin, begin + count) of a file whose size is known, at any time. Fails if they are not
  /// there, since callers know the size of the file from before.
  void read_at(std::uint64_t begin, std::size_t count, void* to) const {
    if (is_loaded_ && begin + count <= used_) {
      std::memcpy(to, bytes_.data() + begin, count);
      return;
    }
    const std::size_t got = system::read_at(descriptor_, begin, count, to);
    if (got < count && errno != 0) fail(name_, "cannot be read: {}", system_reason(errno));
    if (got < count) {
      fail(name_, "ends after {} bytes, but had {} when it was opened: it became shorter while it was read",
           begin + got, size_);
    }
  }

  /// All bytes. Nothing can be read afterwards.
  std::string all() {
    load();
    return std::move(bytes_);
  }

 private:
  static constexpr int kStandardInput = 0;

  void load() {
    // Room for one byte more than a regular file has detects its end in the same call. For pipes the buffer
    // grows.
    std::size_t room = size_ >= 0 ? static_cast<std::size_t>(size_) + 1 : std::size_t{1} << 16;
    for (; !ended_; room *= 2) read_until(room);
    bytes_.resize(used_);
  }
  /// Reads until there are `count` bytes or the file ends.
  void read_until(std::size_t count) {
    if (bytes_.size() < count) bytes_.resize(count);
    if (used_ < count) read_next(&bytes_[used_], count - used_);
  }
  void close() {
    if (descriptor_ > kStandardInput) system::close_file(descriptor_);
  }

  std::string name_;
  std::string expected_;
  int descriptor_;
  std::int64_t size_ = -1;
  std::string bytes_;  // the first used_ bytes were read
  std::size_t used_ = 0;
  bool ended_ = false, is_loaded_ = false;
};

/// The bytes of the file at path, or of standard input for "-". `expected` says what should have been in it.
inline std::string read_file(const std::string& path, std::string_view expected) {
  return InputFile(path, expected).all();
}

}  // namespace flaunay::io
