#include "bench/measuring/processes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <optional>
#include <system_error>

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

}  // namespace

Answer ask_child(const std::function<std::string()>& work, double limit) {
  constexpr std::size_t kKibibyte = 1024;
  int ends[2];
  // Closed by the program that takes the child's place, if one does.
  if (pipe2(ends, O_CLOEXEC) != 0) return {"", "cannot make a pipe"};
  std::fflush(nullptr);  // buffered output would be written twice
  const pid_t child = fork();
  if (child == 0) answer(work, ends[1]);
  close(ends[1]);
  Answer result;
  const bool in_time = child < 0 || read_all(ends[0], limit, result.text);
  close(ends[0]);
  if (child < 0) return {"", "cannot make a process"};
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  result.resident_peak = kKibibyte * static_cast<std::size_t>(usage.ru_maxrss);
  if (!in_time) {
    result.failure = fmt::format("took more than {:g} s", limit);
  } else if (WIFSIGNALED(status)) {
    result.failure = fmt::format("was ended by signal {}", WTERMSIG(status));
  } else if (WEXITSTATUS(status) != EXIT_SUCCESS) {
    result.failure = "failed";
  }
  return result;
}

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

Triangulator triangulator_with(const char* name, const std::string& value, const std::string& device) {
  const bool was_set = std::getenv(name) != nullptr;
  const std::string before = variable(name);
  setenv(name, value.c_str(), 1);
  Triangulator triangulator(device);
  was_set ? setenv(name, before.c_str(), 1) : unsetenv(name);
  return triangulator;
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

std::string Folder::write(const std::string& distribution, std::size_t n) const {
  const std::string path = file(fmt::format("{}-{}.npy", distribution, n));
  if (!fs::exists(path)) {
    run_program({program_or("", "flaunay"), "generate", distribution, std::to_string(n), "-o", path});
  }
  return path;
}

Outcome run_program(std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const Stopwatch watch;
  const Answer answer = ask_child([&]() -> std::string {
    dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
    execvp(pointers.front(), pointers.data());
    throw Error(ErrorKind::device, fmt::format("{} cannot be run", words.front()));
  });
  const double seconds = watch.seconds();
  if (!answer.failure.empty()) {
    throw Error(ErrorKind::device, fmt::format("{} {}", fmt::join(words, " "), answer.failure));
  }
  return {seconds, {{"resident_peak_mib", static_cast<double>(answer.resident_peak) / (1 << 20)}}};
}

std::string program_or(const std::string& given, const std::string& name) {
  return given.empty() ? (fs::read_symlink("/proc/self/exe").parent_path() / name).string() : given;
}

}  // namespace flaunay::bench
