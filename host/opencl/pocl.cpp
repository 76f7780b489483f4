#include "host/opencl/pocl.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "host/error.hpp"
#include "host/memory/system_memory.hpp"
#include "host/opencl/loader.hpp"
#include "host/opencl/private_folder.hpp"

namespace flaunay::host {
namespace {

namespace fs = std::filesystem;

// Measured with PoCL 3.1 and LLVM 15, on two cores, with a margin: with less, it ends the process where it
// makes threads, or its compiler hangs. Threads have their stacks besides.
constexpr std::size_t kSpaceForLibrary = 256 * kMebibyte;
constexpr std::size_t kSpaceForDevice = 64 * kMebibyte;
constexpr std::size_t kSpaceForCompiler = 192 * kMebibyte;
// A program with its kernels takes less than 1 MiB, and linking some temporary files.
constexpr std::size_t kSpaceOnDisk = 4 * kMebibyte;

std::size_t stack_of_thread() {
  constexpr std::size_t kWithoutLimit = 2 * kMebibyte;
  rlimit stack{};
  getrlimit(RLIMIT_STACK, &stack);
  return stack.rlim_cur == RLIM_INFINITY ? kWithoutLimit : stack.rlim_cur;
}

std::size_t space_for_device() {
  return kSpaceForDevice + std::thread::hardware_concurrency() * stack_of_thread();
}

void require_space(std::size_t bytes, const char* what) {
  const MemoryLeft left = address_space_left();
  if (left.bytes >= bytes) return;
  throw DeviceError(
      fmt::format("PoCL needs {} of address space {}, but {} leaves {}: raise the limit, or take "
                  "a mode that runs without a device (dwyer)",
                  mebibytes(bytes), what, left.limit, mebibytes(left.bytes)),
      CL_OUT_OF_HOST_MEMORY);
}

// Exists in PoCL's folder while no process uses it that has not ended well.
constexpr const char* kEndedWell = "/flaunay-ended-well";

bool is_recent(const fs::path& file) {
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  return !error && fs::file_time_type::clock::now() - written < std::chrono::hours(1);
}

[[noreturn]] void throw_cache_error(const std::string& folder, const std::string& reason) {
  throw DeviceError(
      fmt::format("PoCL cannot keep compiled kernels in {}: {}; mend that, or name another folder "
                  "in the environment variable POCL_CACHE_DIR",
                  folder, reason));
}

bool is_set(const char* value) { return value != nullptr && *value != '\0'; }

// Files on their way have other names: a kernel is renamed to <kernel>/<sizes>/<kernel>.so when it is
// complete.
bool is_compiled(const fs::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".bc") return path.filename() == "program.bc" || path.filename() == "parallel.bc";
  return extension == ".so" && path.stem() == path.parent_path().parent_path().filename();
}

}  // namespace

bool is_pocl(cl_platform_id platform) {
  char name[64] = "";
  return clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name - 1, name, nullptr) == CL_SUCCESS &&
         std::strstr(name, "Portable Computing Language") != nullptr;
}

void require_space_to_load_pocl() {
  const std::vector<std::string> drivers = installed_drivers();
  const auto driver = std::find_if(drivers.begin(), drivers.end(), [](const std::string& name) {
    return name.find("pocl") != std::string::npos;
  });
  if (driver == drivers.end()) return;
  if (void* const loaded = dlopen(driver->c_str(), RTLD_LAZY | RTLD_NOLOAD); loaded != nullptr) {
    dlclose(loaded);
    return;
  }
  require_space(kSpaceForLibrary + space_for_device(), "to be loaded and to open its device");
}

void require_space_for_pocl() { require_space(space_for_device(), "to open its device"); }

void require_pocl_compiler() {
  require_space(kSpaceForCompiler, "to compile kernels");
  require_pocl_folder();
  static std::once_flag is_clean;
  std::call_once(is_clean, [] {
    std::error_code ignored;
    const std::string folder = pocl_cache_folder();
    const fs::path note = folder + kEndedWell;
    if (!is_recent(note)) remove_empty_kernels(folder);
    fs::remove(note, ignored);
  });
}

void note_pocl_ended_well() noexcept {
  try {
    // Another user's link of this name is not followed.
    const int note = ::open((pocl_cache_folder() + kEndedWell).c_str(),
                            O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
    if (note >= 0) close(note);
  } catch (...) {
    // Then the next process looks.
  }
}

std::string pocl_cache_folder() {
  if (const char* folder = std::getenv("POCL_CACHE_DIR"); folder != nullptr) return folder;
  const char* kept = std::getenv("POCL_KERNEL_CACHE");
  const std::string part = kept != nullptr && std::strcmp(kept, "0") == 0 ? "/pocl/uncached" : "/pocl/kcache";
  if (const char* caches = std::getenv("XDG_CACHE_HOME"); is_set(caches)) return caches + part;
  if (const char* home = std::getenv("HOME"); home != nullptr) return home + ("/.cache" + part);
  return "/tmp" + part;
}

void require_pocl_folder() { require_cache_folder(pocl_cache_folder()); }

void require_cache_folder(const std::string& folder) {
  if (const int error = make_private_folder(folder); error != 0) {
    throw_cache_error(folder, std::strerror(error));
  }
  std::string probe = folder + "/flaunay-XXXXXX";
  const int file = mkstemp(probe.data());
  if (file < 0) throw_cache_error(folder, std::strerror(errno));
  close(file);
  unlink(probe.c_str());
  struct statvfs disk {};
  if (statvfs(folder.c_str(), &disk) != 0 || disk.f_blocks == 0) return;
  const std::size_t left = disk.f_bavail * disk.f_frsize;
  if (left < kSpaceOnDisk) {
    throw_cache_error(folder, fmt::format("{} are left on its file system, {} are needed", mebibytes(left),
                                          mebibytes(kSpaceOnDisk)));
  }
}

void remove_empty_kernels(const std::string& folder) {
  std::error_code error;
  fs::recursive_directory_iterator file(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && file != fs::recursive_directory_iterator(); file.increment(error)) {
    // Its name first, because asking for the size takes longer.
    if (!is_compiled(file->path())) continue;
    std::error_code ignored;
    if (file->file_size(ignored) == 0 && !ignored) fs::remove(file->path(), ignored);
  }
}

}  // namespace flaunay::host
