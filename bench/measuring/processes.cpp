#include "bench/measuring/processes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <system_error>

#include "app/files/points.hpp"
#include "bench/measuring/timing.hpp"
#include "files/output.hpp"
#include "flaunay/flaunay.hpp"

extern char** environ;

namespace flaunay::bench {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void answer(const std::function<std::string()>& work, int pipe) {
  bool told = false;
  try {
    const std::string text = work();
    std::FILE* const parent = fdopen(pipe, "w");
    told = std::fwrite(text.data(), 1, text.size(), parent) == text.size();
  } catch (const std::exception& error) {
    fmt::print(stderr, "flaunay-bench: {}\n", error.what());
  }
  told = std::fflush(nullptr) == 0 && told;
  // Without destructors and exit handlers: those belong to the parent.
  _exit(told ? EXIT_SUCCESS : EXIT_FAILURE);
}

/// Reads until the other end is closed; whether it is before the limit is over.
bool read_all(int pipe, double limit, std::string& text) {
  const Stopwatch watch;
  char bytes[4096];
  for (;;) {
    pollfd waiting{pipe, POLLIN, 0};
    const double left = std::max(0.0, limit - watch.seconds());
    if (limit > 0 && poll(&waiting, 1, static_cast<int>(1e3 * left)) <= 0) return false;
    const ssize_t count = read(pipe, bytes, sizeof bytes);
    if (count <= 0) return true;
    text.append(bytes, static_cast<std::size_t>(count));
  }
}

std::string failure_of(int status) {
  if (WIFSIGNALED(status)) return fmt::format("was ended by signal {}", WTERMSIG(status));
  return WIFEXITED(status) && WEXITSTATUS(status) == EXIT_SUCCESS ? "" : "failed";
}

double seconds_in(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Answer ask_child(const std::function<std::string()>& work, double limit) {
  int ends[2];
  if (pipe(ends) != 0) return {"", "cannot make a pipe"};
  std::fflush(nullptr);  // what is buffered would be written twice
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    answer(work, ends[1]);
  }
  close(ends[1]);
  Answer result;
  const bool in_time = child < 0 || read_all(ends[0], limit, result.text);
  close(ends[0]);
  if (child < 0) return {"", "cannot make a process"};
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  result.failure = in_time ? failure_of(status) : fmt::format("took more than {:g} s", limit);
  return result;
}

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

WithVariable::WithVariable(const char* name, const std::string& value)
    : name_(name), was_set_(std::getenv(name) != nullptr), before_(variable(name)) {
  setenv(name, value.c_str(), 1);
}

WithVariable::~WithVariable() {
  if (was_set_) {
    setenv(name_, before_.c_str(), 1);
  } else {
    unsetenv(name_);
  }
}

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

std::string Folder::write(const std::string& name, const std::string& distribution, std::size_t n) const {
  if (!fs::exists(file(name))) {
    io::Outputs outputs;
    io::write_points(outputs, file(name), {make_input(distribution, n).coordinates});
    outputs.commit();
  }
  return file(name);
}

ProcessUse run_program(std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  const Stopwatch watch;
  pid_t child = 0;
  const int code = posix_spawnp(&child, pointers.front(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  rusage usage{};
  if (code != 0 || wait4(child, &status, 0, &usage) != child || !failure_of(status).empty()) {
    throw Error(ErrorKind::device, fmt::format("{} could not be run, or failed", fmt::join(words, " ")));
  }
  constexpr std::size_t kKibibyte = 1024;
  return {watch.seconds(), seconds_in(usage.ru_utime) + seconds_in(usage.ru_stime),
          kKibibyte * static_cast<std::size_t>(usage.ru_maxrss)};
}

std::string program_or(const std::string& given, const std::string& name) {
  return given.empty() ? (fs::read_symlink("/proc/self/exe").parent_path() / name).string() : given;
}

}  // namespace flaunay::bench
