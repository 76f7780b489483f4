#include "program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <system_error>

#include "flaunay/flaunay.hpp"
#include "timing.hpp"

extern char** environ;

namespace flaunay::bench {
namespace {

namespace fs = std::filesystem;

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

double seconds_of(const timeval& time) {
  constexpr double kMicrosecond = 1e-6;
  return static_cast<double>(time.tv_sec) + kMicrosecond * static_cast<double>(time.tv_usec);
}

}  // namespace

Folder::Folder(const std::string& parent) {
  std::string name =
      ((parent.empty() ? fs::temp_directory_path() : fs::path(parent)) / "flaunay-bench-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw Error(ErrorKind::input, fmt::format("cannot make a folder such as {}", name));
  }
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

Spent run_program(std::vector<std::string> words, std::vector<std::string> environment) {
  std::vector<char*> pointers = pointers_to(words), variables = pointers_to(environment);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const Stopwatch watch;
  pid_t child = 0;
  const int code = posix_spawnp(&child, pointers.front(), &actions, nullptr, pointers.data(),
                                environment.empty() ? environ : variables.data());
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  rusage usage{};
  if (code != 0 || wait4(child, &status, 0, &usage) != child || !WIFEXITED(status) ||
      WEXITSTATUS(status) != 0) {
    throw Error(ErrorKind::device, fmt::format("{} could not be run, or failed", fmt::join(words, " ")));
  }
  constexpr std::size_t kKibibyte = 1024;
  return {watch.seconds(), seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime),
          kKibibyte * static_cast<std::size_t>(usage.ru_maxrss)};
}

std::string beside_this(const std::string& name) {
  return (fs::read_symlink("/proc/self/exe").parent_path() / name).string();
}

}  // namespace flaunay::bench
