#include "app/command/output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "app/files/mesh.hpp"
#include "app/files/points.hpp"
#include "files/file.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::cli {

bool print(const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
    return true;
  if (errno == EPIPE || errno == EBADF) return false;
  throw Error(ErrorKind::input, fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

OutputFiles::OutputFiles(const std::string& input, std::vector<std::string> more) : inputs_(std::move(more)) {
  inputs_.push_back(input);
}

void OutputFiles::announce(const std::string& path) {
  const auto is_output = [&](const std::string& input) {
    return input != "-" && io::is_one_file(input, path);
  };
  if (std::any_of(inputs_.begin(), inputs_.end(), is_output)) {
    throw Error(ErrorKind::usage, fmt::format("{}: this output would overwrite the input", path));
  }
  files_.announce(path);
}

void OutputFiles::add_mesh(const std::string& path, bool with_constraints) {
  if (path.empty()) return;
  for (const std::string& file : io::mesh_files(path, with_constraints)) announce(file);
}

void OutputFiles::add(const std::string& path, const std::string& ending) {
  if (path.empty()) return;
  io::check_ending(path, ending);
  announce(path);
}

void OutputFiles::add_points(const std::string& path) {
  if (path == "-") return;
  io::check_points_output(path);
  announce(path);
}

}  // namespace flaunay::cli
