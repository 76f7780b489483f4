#include "child.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "timing.hpp"

namespace flaunay::bench {
namespace {

/// Whether all of it could be written.
bool write_all(int pipe, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(pipe, text.data() + done, text.size() - done);
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

[[noreturn]] void answer(const std::function<std::string()>& work, int pipe) {
  bool told = false;
  try {
    told = write_all(pipe, work());
  } catch (const std::exception& error) {
    fmt::print(stderr, "flaunay-bench: {}\n", error.what());
  }
  std::fflush(nullptr);
  // Without destructors and exit handlers: those belong to the parent.
  _exit(told ? EXIT_SUCCESS : EXIT_FAILURE);
}

/// Whether something can be read, or the other end is closed, before so many seconds are over.
bool wait_for(int pipe, double seconds) {
  pollfd waiting{pipe, POLLIN, 0};
  return poll(&waiting, 1, static_cast<int>(1e3 * std::max(0.0, seconds))) > 0;
}

/// Reads until the other end is closed; whether it is before the limit is over.
bool read_all(int pipe, double limit, std::string& text) {
  const Stopwatch watch;
  char bytes[4096];
  for (;;) {
    if (limit > 0 && !wait_for(pipe, limit - watch.seconds())) return false;
    const ssize_t count = read(pipe, bytes, sizeof bytes);
    if (count <= 0) return true;
    text.append(bytes, static_cast<std::size_t>(count));
  }
}

std::string failure_of(int status) {
  if (WIFSIGNALED(status)) return fmt::format("was ended by signal {}", WTERMSIG(status));
  return WIFEXITED(status) && WEXITSTATUS(status) == EXIT_SUCCESS ? "" : "failed";
}

}  // namespace

Answer ask_child(const std::function<std::string()>& work, double limit) {
  int ends[2];
  if (pipe(ends) != 0) return {"", "cannot make a pipe"};
  std::fflush(nullptr);  // what is buffered would be written twice
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    return {"", "cannot make a process"};
  }
  if (child == 0) {
    close(ends[0]);
    answer(work, ends[1]);
  }
  close(ends[1]);
  Answer result;
  const bool in_time = read_all(ends[0], limit, result.text);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  result.failure = in_time ? failure_of(status) : fmt::format("took more than {:g} s", limit);
  return result;
}

}  // namespace flaunay::bench
