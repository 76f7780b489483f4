#include "cli/output.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "flaunay/flaunay.hpp"
#include "io/file.hpp"
#include "io/mesh.hpp"
#include "io/points.hpp"

namespace flaunay::cli {

namespace fs = std::filesystem;

namespace {

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return true;
  const fs::path canonical_a = fs::weakly_canonical(a, error);
  if (error) return a == b;
  const fs::path canonical_b = fs::weakly_canonical(b, error);
  return error ? a == b : canonical_a == canonical_b;
}

bool exists(const std::string& path) {
  std::error_code error;
  // A dangling symbolic link exists too.
  return fs::exists(fs::symlink_status(path, error));
}

}  // namespace

bool print(const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
    return true;
  if (errno == EPIPE) return false;
  throw Error(ErrorKind::input, fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

void write_text(const std::string& path, const std::string& text) {
  io::OutputFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

OutputFiles::OutputFiles(const std::string& input) : input_(input) {}

OutputFiles::~OutputFiles() {
  if (keep_) return;
  for (const File& file : files_) {
    std::error_code ignored;
    if (!file.existed) fs::remove(file.path, ignored);
  }
}

void OutputFiles::reserve(const std::string& path) {
  if (input_ != "-" && same_file(path, input_)) {
    throw Error(ErrorKind::usage, fmt::format("{}: this output would overwrite the input", path));
  }
  for (const File& file : files_) {
    if (same_file(path, file.path)) {
      throw Error(ErrorKind::usage, fmt::format("{}: two outputs have the same path", path));
    }
  }
  files_.push_back({path, exists(path)});
}

void OutputFiles::add_mesh(const std::string& path) {
  if (path.empty()) return;
  io::check_mesh_output(path);
  reserve(path);
  const std::string ending = io::ending_of(path);
  if (ending == ".ele") reserve(path.substr(0, path.size() - ending.size()) + ".node");
}

void OutputFiles::add(const std::string& path, const std::string& ending) {
  if (path.empty()) return;
  io::check_output(path, ending);
  reserve(path);
}

void OutputFiles::add_points(const std::string& path) {
  io::check_points_ending(path);
  io::check_output(path, io::ending_of(path));
  reserve(path);
}

}  // namespace flaunay::cli
