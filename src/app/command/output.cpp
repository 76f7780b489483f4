#include "app/command/output.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

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

OutputFiles::OutputFiles(const std::string& input, const std::vector<std::string>& more) : inputs_(more) {
  inputs_.push_back(input);
}

void OutputFiles::reserve(const std::string& path) {
  const io::Target target = io::find_target(path);
  for (const std::string& name : inputs_) {
    struct stat input {};
    const bool is_file = name != "-" && ::stat(name.c_str(), &input) == 0;
    if (is_file && target.exists && target.id == io::file_id(input)) {
      throw Error(ErrorKind::usage, fmt::format("{}: this output would overwrite the input", path));
    }
  }
  for (const io::Target& other : announced_) {
    if (io::is_same(target, other)) {
      throw Error(ErrorKind::usage, fmt::format("{}: two outputs have the same path", path));
    }
  }
  announced_.push_back(target);
}

void OutputFiles::add_mesh(const std::string& path, bool with_constraints) {
  if (path.empty()) return;
  io::check_mesh_output(path, with_constraints);
  for (const std::string& file : io::mesh_files(path, with_constraints)) reserve(file);
}

void OutputFiles::add(const std::string& path, const std::string& ending) {
  if (path.empty()) return;
  io::check_output(path, ending);
  reserve(path);
}

void OutputFiles::add_points(const std::string& path) {
  if (path == "-") return;
  io::check_points_output(path);
  io::check_output(path, io::ending_of(path));
  reserve(path);
}

}  // namespace flaunay::cli
