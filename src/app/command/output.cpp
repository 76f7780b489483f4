#include "app/command/output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "app/files/formats.hpp"
#include "files/file.hpp"
#include "flaunay/flaunay.hpp"
#include "host/system/process.hpp"

namespace flaunay::cli {

namespace {

// Standard output has a file.
bool has_file = false;

}  // namespace

bool print(const std::string& text) {
  errno = 0;
  std::FILE* const stream = has_file ? stderr : stdout;
  if (std::fwrite(text.data(), 1, text.size(), stream) == text.size() && std::fflush(stream) == 0)
    return true;
  if (errno == EPIPE || errno == EBADF) return false;
  throw Error(ErrorKind::input, fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

std::string notes_text(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += io::printable("note: " + note) + "\n";
  return text;
}

std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t c = 0; c + 1 < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c + 1 < row.size(); ++c) text += fmt::format("{:<{}}  ", row[c], widths[c]);
    text += row.back() + "\n";
  }
  return text;
}

void OutputFiles::take_standard_output(const std::string& path) {
  if (path != "-") return;
  has_file = true;
  system::end_on_closed_pipe();
}

void OutputFiles::add_mesh(const std::string& path, bool with_constraints) {
  if (path.empty()) return;
  take_standard_output(path);
  for (const std::string& file : io::mesh_files(path, with_constraints)) announce(file);
}

void OutputFiles::add(const std::string& path, const std::string& ending) {
  if (path.empty()) return;
  io::check_ending(path, ending);
  announce(path);
}

void OutputFiles::add_points(const std::string& path) {
  take_standard_output(path);
  io::format_of(path, io::Use::write_points);
  announce(path);
}

}  // namespace flaunay::cli
