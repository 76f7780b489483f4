#include "files/output.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <optional>
#include <system_error>

#include "files/file.hpp"

namespace flaunay::io {
namespace {

namespace fs = std::filesystem;

constexpr int kStandardOutput = 1, kStandardError = 2;

/// The path to which a chain of symbolic links leads, whether something is there or not.
std::string followed(std::string path) {
  constexpr int kMostLinks = 40;  // as in Linux
  for (int links = 0; links < kMostLinks; ++links) {
    std::error_code is_no_link;
    const fs::path next = fs::read_symlink(path, is_no_link);
    if (is_no_link) return path;
    path = (fs::path(path).parent_path() / next).string();
  }
  fail(path, "cannot be written: {}", system_reason(ELOOP));
}

[[noreturn]] void fail_same_path(const std::string& path) {
  throw Error(ErrorKind::usage, fmt::format("{}: two outputs have the same path", path));
}

}  // namespace

Target find_target(const std::string& path) {
  Target target;
  const std::optional<system::FileStatus> status = system::status_of(path);
  target.exists = status.has_value();
  if (!target.exists && errno != ENOENT) fail(path, "cannot be written: {}", system_reason(errno));
  if (target.exists) {
    if (status->kind == system::FileKind::folder) fail(path, "cannot be written: {}", system_reason(EISDIR));
    // Checked, because a rename would replace even a write-protected file.
    if (!system::is_writable(path)) fail(path, "cannot be written: {}", system_reason(errno));
    target.is_direct = status->kind != system::FileKind::regular;
    target.permissions = status->permissions;
  }
  target.path = target.is_direct ? path : followed(path);
  const std::size_t name = system::last_name(target.path);
  target.folder = name == 0 ? "./" : target.path.substr(0, name);
  if (name == target.path.size()) fail(path, "cannot be created: {}", system_reason(EISDIR));
  if (!system::status_of(target.folder)) {
    fail(path, "cannot be created in folder '{}': {}", target.folder, system_reason(errno));
  }
  return target;
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
  if (path == "-") {
    target_.is_direct = true;
    return;
  }
  target_ = find_target(path);
  if (target_.is_direct) return;
  const Uninterrupted made;
  const std::string partial = system::temporary_path(target_.path, "partial");
  descriptor_ = system::open_file(partial, system::Access::create);
  if (descriptor_ < 0) {
    if (errno == EEXIST) fail_same_path(path);
    fail(path_, "cannot be created in folder '{}': {}", target_.folder, system_reason(errno));
  }
  partial_ = Temporary(partial);
  if (target_.exists) system::set_permissions(descriptor_, target_.permissions);
}

OutputFile::OutputFile(const std::string& path, const std::string& partial)
    : path_(path),
      partial_(partial),
      descriptor_(system::open_file(partial, system::Access::write)),
      is_used_(true) {
  if (descriptor_ < 0) fail(path_, "cannot be opened for writing: {}", system_reason(errno));
}

OutputFile::~OutputFile() {
  if (descriptor_ > kStandardError) system::close_file(descriptor_);
}

void OutputFile::start() {
  is_used_ = true;
  if (!target_.is_direct) return;
  descriptor_ = path_ == "-" ? kStandardOutput : system::open_file(path_, system::Access::write);
  if (descriptor_ < 0) fail(path_, "cannot be opened for writing: {}", system_reason(errno));
}

void OutputFile::write(const void* data, std::size_t bytes) {
  if (bytes < kFull) {
    const char* begin = static_cast<const char*>(data);
    buffer_.append(begin, begin + bytes);
    if (buffer_.size() >= kFull) flush();
  } else {
    flush();
    check_written(system::write_next(descriptor_, data, bytes));
  }
}

void OutputFile::flush() {
  check_written(system::write_next(descriptor_, buffer_.data(), buffer_.size()));
  buffer_.clear();
}

void OutputFile::write_at(std::uint64_t place, const void* data, std::size_t bytes) {
  check_written(system::write_at(descriptor_, place, data, bytes));
}

void OutputFile::cut(std::uint64_t bytes) { check_written(system::cut_file(descriptor_, bytes)); }

void OutputFile::check_written(bool is_written) const {
  if (!is_written) fail(path_, "cannot be written: {}", system_reason(errno));
}

void OutputFile::close() {
  flush();
  if (descriptor_ > kStandardError) check_written(system::close_file(std::exchange(descriptor_, -1)));
}

void Outputs::announce(const std::string& path) {
  for (const std::string& input : inputs_) {
    if (input == "-" || !is_one_file(input, path)) continue;
    throw Error(ErrorKind::usage, fmt::format("{}: this output would overwrite the input", path));
  }
  auto file = std::make_unique<OutputFile>(path);
  const auto is_same = [&](const auto& other) { return is_one_file(other->path_, path); };
  if (file->target_.is_direct && std::any_of(files_.begin(), files_.end(), is_same)) fail_same_path(path);
  files_.push_back(std::move(file));
}

OutputFile& Outputs::open(const std::string& path) {
  const auto find = [&] {
    return std::find_if(files_.begin(), files_.end(),
                        [&](const auto& file) { return !file->is_used_ && file->path_ == path; });
  };
  if (find() == files_.end()) announce(path);
  OutputFile& file = **find();
  file.start();
  return file;
}

OutputFile& Outputs::join(const std::string& path, const std::string& partial) {
  return *files_.emplace_back(std::make_unique<OutputFile>(path, partial));
}

void Outputs::close() {
  for (auto file = files_.rbegin(); file != files_.rend() && (*file)->descriptor_ >= 0; ++file) {
    if (!(*file)->is_used_) continue;
    (*file)->close();
    closed_in_ = (*file)->target_.folder;
  }
}

void Outputs::write_out() {
  for (const auto& file : files_) {
    if (!file->is_used_ || file->descriptor_ < 0) continue;
    file->flush();
    // Some file systems find only now that the disk is full. Others have no such call.
    const bool is_written = file->target_.is_direct || system::write_to_disk(file->descriptor_);
    file->check_written(is_written || errno == EINVAL || errno == EROFS);
  }
  if (closed_in_.empty()) return;
  // Once, because there may be thousands of files.
  if (!system::write_folder_to_disk(closed_in_)) {
    fail(closed_in_, "cannot be written: {}", system_reason(errno));
  }
}

void Outputs::commit() {
  std::erase_if(files_, [](const auto& file) { return !file->is_used_; });
  write_out();
  const Uninterrupted until_placed;
  for (const auto& file : files_) file->close();
  try {
    for (const std::string& path : removed_) {
      keep_old(path, {path, path.substr(0, system::last_name(path))}, /* is_removed */ true);
    }
    for (const auto& file : files_) {
      if (!file->target_.is_direct) place(*file);
    }
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}; {}", error.what(), take_back()));
  }
  for (const Placed& placed : placed_) system::remove_file(placed.old);
  Outputs none;
  none.notes = std::move(notes);
  *this = std::move(none);
}

void Outputs::place(const OutputFile& file) {
  const Target now = find_target(file.target_.path);
  if (now.is_direct) fail(file.path_, "cannot be replaced: is no regular file");
  if (now.exists) keep_old(file.path_, now, /* is_removed */ false);
  if (!system::rename_file(file.partial_path(), now.path)) {
    fail(file.path_, "cannot be put in place: {}", system_reason(errno));
  }
  if (!now.exists) placed_.push_back({file.path_, now.path, ""});
}

void Outputs::keep_old(const std::string& path, const Target& target, bool is_removed) {
  const std::string old = system::temporary_path(target.path, "old");
  // With a link, there is a file all the time. Not every file system has links.
  const bool is_linked = !is_removed && system::link_file(target.path, old);
  if (!is_linked && !system::rename_file(target.path, old)) {
    fail(path, "cannot be replaced: {}", system_reason(errno));
  }
  placed_.push_back({path, target.path, old});
}

std::string Outputs::take_back() {
  std::string left;
  for (; !placed_.empty(); placed_.pop_back()) {
    const auto& [path, target, old] = placed_.back();
    if (old.empty()) {
      if (!system::remove_file(target)) left += fmt::format("; {} is the new file already", path);
    } else if (is_one_file(old, target)) {
      system::remove_file(old);
    } else if (!system::rename_file(old, target)) {
      left += fmt::format("; {} could not be put back: the old file is {}", path, old);
    }
  }
  return left.empty() ? "all outputs are as they were" : left.substr(2);
}

}  // namespace flaunay::io
