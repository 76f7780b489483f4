#include "host/opencl/private_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

namespace flaunay::host {

int make_private_folder(const std::string& folder) {
  const auto make = [&folder] {
    const bool is_there = ::mkdir(folder.c_str(), S_IRWXU) == 0 || errno == EEXIST;
    return is_there ? 0 : errno;
  };
  const int error = make();
  const std::string above = std::filesystem::path(folder).parent_path();
  if (error != ENOENT || above.empty() || above == folder) return error;
  const int error_above = make_private_folder(above);
  return error_above != 0 ? error_above : make();
}

std::string who_else_writes(const struct stat& status) {
  if (status.st_uid != ::geteuid()) return fmt::format("it belongs to user {}", status.st_uid);
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) == 0) return "";
  return fmt::format("its mode {:04o} lets other users write to it (chmod go-w)", status.st_mode & 07777U);
}

}  // namespace flaunay::host
