// Points in text formats, read in pieces.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "files/file.hpp"

namespace flaunay::io {

/// Reads the points of a text that comes in pieces of whole lines. Throws Error(input) that names the line
/// and the column in the file.
class PointText {
 public:
  virtual ~PointText() = default;
  /// Appends the points of the next lines.
  virtual void parse(std::string_view lines, std::vector<double>& coordinates) = 0;
  /// After the last piece: checks that nothing is missing.
  virtual void finish() {}
};

/// Two numbers per line.
std::unique_ptr<PointText> pair_text(const std::string& path);
/// Triangle's .node format.
std::unique_ptr<PointText> node_text(const std::string& path);

/// The lines of a file, or of standard input for "-", in pieces of some MiB.
class LinePieces {
 public:
  /// expected: what should be in the file, for messages.
  LinePieces(const std::string& path, std::string_view expected);
  /// Goes to the next whole lines, which are valid until the next call; false at the end.
  bool next(std::string_view& lines);
  /// The size of a regular file; unknown, -1, of a pipe.
  std::int64_t file_size() const { return file_.size(); }

 private:
  std::string path_, expected_;
  InputFile file_;
  std::string buffer_;
  std::size_t used_ = 0;   // bytes in the buffer
  std::size_t given_ = 0;  // of them, those that the last call returned
  bool ended_ = false;
};

}  // namespace flaunay::io
