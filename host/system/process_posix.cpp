#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <thread>

#include "host/system/process.hpp"

namespace flaunay::system {
namespace {

// The system gives a file the lowest free descriptor. If a standard stream is closed, that would be the
// stream's descriptor, and the stream's output would go into the file.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // In the other direction, so that using the stream is still an error.
    ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

void wait_and_clean_up(const sigset_t& signals, void (*clean_up)()) {
  int signal_number = 0;
  if (sigwait(&signals, &signal_number) != 0) return;
  clean_up();
  ::signal(signal_number, SIG_DFL);
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, signal_number);
  pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  ::raise(signal_number);
}

}  // namespace

void prepare_streams() {
  occupy_closed_streams();
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
}

void end_on_closed_pipe() { ::signal(SIGPIPE, SIG_DFL); }

std::vector<std::string> arguments_of_main(int argc, char** argv) { return {argv, argv + argc}; }

void clean_up_when_interrupted(void (*clean_up)()) {
  sigset_t blocked, awaited;
  pthread_sigmask(SIG_BLOCK, nullptr, &blocked);
  sigemptyset(&awaited);
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    sigaction(signal_number, nullptr, &action);
    if (action.sa_handler != SIG_IGN && sigismember(&blocked, signal_number) == 0) {
      sigaddset(&awaited, signal_number);
    }
  }
  // A thread that waits may do what a signal handler may not, such as taking a lock. All other threads
  // inherit the blocked signals.
  pthread_sigmask(SIG_BLOCK, &awaited, nullptr);
  try {
    std::thread([awaited, clean_up] { wait_and_clean_up(awaited, clean_up); }).detach();
  } catch (const std::system_error&) {
    // If the system refuses the thread, signals end the process at once, and incomplete files stay.
    pthread_sigmask(SIG_UNBLOCK, &awaited, nullptr);
  }
}

std::size_t terminal_width() {
  const char* const type = std::getenv("TERM");
  if (isatty(STDERR_FILENO) != 1 || (type != nullptr && std::string_view(type) == "dumb")) return 0;
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

void write_to_terminal(const std::string& text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace flaunay::system
