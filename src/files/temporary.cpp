#include "files/temporary.hpp"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <cstdio>
#include <set>
#include <system_error>
#include <thread>

namespace flaunay::io {
namespace {

struct Registry {
  std::recursive_mutex mutex;
  std::set<std::string> paths;
};

// Never destroyed, because the thread that waits for signals may use it until the process ends.
Registry& registry() {
  static Registry& all = *new Registry;
  return all;
}

void wait_and_clean_up(const sigset_t& signals) {
  int signal_number = 0;
  if (sigwait(&signals, &signal_number) != 0) return;
  Registry& all = registry();
  // Locked until the end, so that no more are made.
  all.mutex.lock();
  // Backwards, so that a folder comes after what is in it.
  std::for_each(all.paths.rbegin(), all.paths.rend(),
                [](const std::string& path) { std::remove(path.c_str()); });
  ::signal(signal_number, SIG_DFL);
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, signal_number);
  pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  ::raise(signal_number);
}

}  // namespace

void clean_up_when_interrupted() {
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
    std::thread([awaited] { wait_and_clean_up(awaited); }).detach();
  } catch (const std::system_error&) {
    // If the system refuses the thread, signals end the process at once, and what is not complete stays.
    pthread_sigmask(SIG_UNBLOCK, &awaited, nullptr);
  }
}

Uninterrupted::Uninterrupted() : lock_(registry().mutex) {}

Temporary::Temporary(std::string path) : path_(std::move(path)) {
  const Uninterrupted registered;
  registry().paths.insert(path_);
}

Temporary::~Temporary() {
  if (path_.empty()) return;
  const Uninterrupted removed;
  std::remove(path_.c_str());
  registry().paths.erase(path_);
}

}  // namespace flaunay::io
