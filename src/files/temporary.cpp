#include "files/temporary.hpp"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace flaunay::io {
namespace {

namespace fs = std::filesystem;

struct Existing {
  std::string path;
  Temporary::Contents contents;
};

struct Registry {
  std::recursive_mutex mutex;
  std::vector<Existing> existing;
};

// Never destroyed, because the thread that waits for signals may use it until the process ends.
Registry& registry() {
  static Registry& all = *new Registry;
  return all;
}

void remove_existing(const Existing& temporary) {
  std::error_code ignored;
  if (temporary.contents == Temporary::Contents::all) {
    fs::remove_all(temporary.path, ignored);
  } else {
    fs::remove(temporary.path, ignored);
  }
}

void end_by(int signal_number) {
  ::signal(signal_number, SIG_DFL);
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, signal_number);
  pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  ::raise(signal_number);
}

void wait_and_clean_up(const sigset_t& signals) {
  int signal_number = 0;
  if (sigwait(&signals, &signal_number) != 0) return;
  Registry& all = registry();
  // Locked until the end, so that no more are made.
  all.mutex.lock();
  // The newest first, because it may be in an older one.
  std::for_each(all.existing.rbegin(), all.existing.rend(), remove_existing);
  end_by(signal_number);
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
  // A thread that waits may do what a signal handler may not, such as listing a folder. All other threads
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

Temporary::Temporary(std::string path, Contents contents) : path_(std::move(path)), contents_(contents) {
  const Uninterrupted registered;
  registry().existing.push_back({path_, contents_});
}

Temporary::Temporary(Temporary&& other) noexcept { *this = std::move(other); }

Temporary& Temporary::operator=(Temporary&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(contents_, other.contents_);
  return *this;
}

Temporary::~Temporary() {
  if (path_.empty()) return;
  const Uninterrupted removed;
  remove_existing({path_, contents_});
  release();
}

void Temporary::release() {
  const Uninterrupted released;
  auto& existing = registry().existing;
  const auto own = std::find_if(existing.begin(), existing.end(),
                                [this](const Existing& one) { return one.path == path_; });
  if (own != existing.end()) existing.erase(own);
  path_.clear();
}

}  // namespace flaunay::io
