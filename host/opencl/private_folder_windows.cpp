#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "host/opencl/private_folder.hpp"
#include "host/system/files.hpp"
#include "host/system/wide.hpp"

namespace flaunay::host {
namespace {

namespace fs = std::filesystem;

fs::path path_of(const std::string& name) { return system::wide(name); }

}  // namespace

int make_private_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(path_of(folder), error);
  return error ? EACCES : 0;
}

PrivateFolder::PrivateFolder(const std::string& folder) : folder_(folder) {
  const std::optional<system::FileStatus> status = system::status_of(folder);
  is_open_ = status && status->kind == system::FileKind::folder;
  if (!is_open_ && (status || errno != ENOENT)) reason_ = std::strerror(status ? ENOTDIR : errno);
}

PrivateFolder::~PrivateFolder() = default;

std::optional<std::string> PrivateFolder::read(const std::string& name, std::size_t most_bytes) const {
  const std::string file = folder_ + "/" + name;
  const std::optional<system::FileStatus> status = system::status_of(file);
  if (!status || status->kind != system::FileKind::regular || status->bytes > most_bytes) return {};
  std::string content(status->bytes, '\0');
  std::ifstream stream(path_of(file), std::ios::binary);
  if (!stream.read(content.data(), static_cast<std::streamsize>(content.size()))) return {};
  return content;
}

bool PrivateFolder::write(const std::string& name, const std::string& content) const {
  const std::string file = folder_ + "/" + name, unfinished = system::temporary_path(file, "partial");
  const int descriptor = system::open_file(unfinished, system::Access::create);
  if (descriptor < 0) return false;  // another thread may be writing it
  const bool is_written = system::write_next(descriptor, content.data(), content.size());
  if (system::close_file(descriptor) && is_written && system::rename_file(unfinished, file)) return true;
  system::remove_file(unfinished);
  return false;
}

}  // namespace flaunay::host
