// Where the command's results go: standard output, and files that are all written or none.
#pragma once

#include <string>
#include <vector>

#include "files/output.hpp"

namespace flaunay::cli {

/// Writes text to standard output, or to standard error if the former has a file, and flushes it. Returns
/// false if nobody can read it, because standard output or the pipe is closed, which is not an error; throws
/// Error(input) for any other failure, such as a full disk.
bool print(const std::string& text);
/// A line for each note.
std::string notes_text(const std::vector<std::string>& notes);

/// Rows as lines, in columns that are as wide as their widest entries; the last one is not filled up.
std::string aligned(const std::vector<std::vector<std::string>>& rows);

/// The files that one run writes, by what is in them.
class OutputFiles : public io::Outputs {
 public:
  using io::Outputs::Outputs;

  // These announce files. An empty path means that there is none. They throw Error(usage) for another ending,
  // and what announce throws.
  /// A mesh in one of the formats of write_mesh. "-" is standard output.
  void add_mesh(const std::string& path, bool with_constraints = false);
  void add(const std::string& path, const std::string& ending);
  /// Points in one of the formats of write_points. "-" is standard output.
  void add_points(const std::string& path);

 private:
  static void take_standard_output(const std::string& path);
};

}  // namespace flaunay::cli
