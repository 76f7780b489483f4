// Where the command's results go: standard output, and files that are all written or none.
#pragma once

#include <string>
#include <vector>

#include "files/output.hpp"

namespace flaunay::cli {

/// Writes text to standard output and flushes it. Returns false if nobody can read it, because standard
/// output or the pipe is closed, which is not an error; throws Error(input) for any other failure, such as a
/// full disk.
bool print(const std::string& text);

/// The files that one run writes: first all are announced, to find errors before the work begins; in the end
/// they are written, and committed together.
class OutputFiles {
 public:
  /// input and more: files that no output may overwrite; "-" for none.
  explicit OutputFiles(const std::string& input, std::vector<std::string> more = {});

  /// Announces a mesh in one of the formats of write_mesh. An empty path means that there is none. Throws
  /// Error(usage) if the ending is unknown or another file of this run has the path, Error(input) if the file
  /// cannot be created.
  void add_mesh(const std::string& path, bool with_constraints = false);
  /// Announces a file whose ending must be `ending`, with the same errors.
  void add(const std::string& path, const std::string& ending);
  /// Announces points in one of the formats of write_points, with the same errors. "-" is standard output.
  void add_points(const std::string& path);

  /// Where the announced files are written.
  io::Outputs& files() { return files_; }

 private:
  void announce(const std::string& path);

  std::vector<std::string> inputs_;
  io::Outputs files_;
};

}  // namespace flaunay::cli
