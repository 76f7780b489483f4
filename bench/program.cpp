#include "program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
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

}  // namespace

Folder::Folder() {
  std::string name = (fs::temp_directory_path() / "flaunay-bench-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw Error(ErrorKind::input, fmt::format("cannot make a folder such as {}", name));
  }
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string beside_this(const std::string& name) {
  return (fs::read_symlink("/proc/self/exe").parent_path() / name).string();
}

double run_program(std::vector<std::string> words, std::vector<std::string> variables) {
  std::vector<char*> arguments = pointers_to(words), environment = pointers_to(variables);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const Stopwatch watch;
  pid_t child = 0;
  const int code = posix_spawnp(&child, arguments.front(), &actions, nullptr, arguments.data(),
                                variables.empty() ? environ : environment.data());
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (code != 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw Error(ErrorKind::device, fmt::format("{} could not be run, or failed", fmt::join(words, " ")));
  }
  return watch.seconds();
}

}  // namespace flaunay::bench
