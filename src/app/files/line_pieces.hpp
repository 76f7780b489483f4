// Reads text in pieces of whole lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "files/file.hpp"

namespace flaunay::io {

/// The lines of a file, or of standard input for "-", in pieces of some MiB.
class LinePieces {
 public:
  /// expected: what should be in the file, for messages.
  LinePieces(const std::string& path, std::string_view expected)
      : path_(shown_path(path)), expected_(expected), file_(path, expected) {}

  /// Goes to the next whole lines, which are valid until the next call; false at the end.
  bool next(std::string_view& lines) {
    constexpr std::size_t kPiece = std::size_t{1} << 22, kLongestLine = std::size_t{1} << 26;
    used_ -= given_;
    std::memmove(buffer_.data(), buffer_.data() + given_, used_);
    given_ = 0;
    while (!ended_ && given_ == 0) {
      if (used_ > kLongestLine) {
        fail(path_, "has a line of more than {} bytes; expected {}", kLongestLine, expected_);
      }
      buffer_.resize(used_ + kPiece);
      const std::size_t got = file_.read_next(buffer_.data() + used_, kPiece);
      ended_ = got < kPiece;
      const std::size_t line_end = std::string_view(buffer_).substr(used_, got).rfind('\n');
      if (line_end != std::string_view::npos) given_ = used_ + line_end + 1;
      used_ += got;
    }
    if (ended_) given_ = used_;
    lines = std::string_view(buffer_).substr(0, given_);
    return given_ > 0;
  }
  /// The size of a regular file; unknown, -1, of a pipe.
  std::int64_t file_size() const { return file_.size(); }

 private:
  const std::string path_, expected_;
  InputFile file_;
  std::string buffer_;
  std::size_t used_ = 0;   // bytes in the buffer
  std::size_t given_ = 0;  // of them, those that the last call returned
  bool ended_ = false;
};

}  // namespace flaunay::io
