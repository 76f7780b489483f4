#include "host/native/threads.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#ifdef __linux__
#include <sched.h>
#endif

#include "host/error.hpp"

namespace flaunay::host {
namespace {

constexpr std::size_t kMostThreads = 1024;

std::size_t usable_cores() {
#ifdef __linux__
  cpu_set_t cores;
  if (sched_getaffinity(0, sizeof cores, &cores) == 0) return static_cast<std::size_t>(CPU_COUNT(&cores));
#endif
  return std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

}  // namespace

std::size_t native_threads() {
  const char* const given = std::getenv("FLAUNAY_THREADS");
  if (given == nullptr || *given == '\0') return std::min(usable_cores(), kMostThreads);
  std::size_t count = 0;
  const char* const end = given + std::strlen(given);
  const auto [stop, error] = std::from_chars(given, end, count);
  if (error != std::errc() || stop != end || count < 1 || count > kMostThreads) {
    throw DeviceError(fmt::format("FLAUNAY_THREADS is '{}'; expected a number of threads from 1 to {}", given,
                                  kMostThreads));
  }
  return count;
}

struct Threads::Pool {
  // One call of share.
  struct Job {
    const Work& work;
    std::size_t n, part;
    std::atomic<std::size_t> next{0};
    std::mutex failing{};
    std::size_t failed = n;  // where the first part begins that has failed
    std::exception_ptr failure{};

    // An exception may end neither a thread, nor the job as long as others work on it.
    void run() noexcept {
      for (std::size_t begin = next.fetch_add(part); begin < n; begin = next.fetch_add(part)) {
        try {
          work(begin, std::min(n, begin + part));
        } catch (...) {
          const std::lock_guard lock(failing);
          if (begin < failed) failure = std::current_exception();
          failed = std::min(failed, begin);
          next = n;
        }
      }
    }
  };

  explicit Pool(std::size_t helpers) : process(getpid()) {
    threads.reserve(helpers);
    try {
      while (threads.size() < helpers) threads.emplace_back([this] { serve(); });
    } catch (const std::exception&) {
      // If there is no thread, or no memory for it, the others do its work.
    }
  }
  ~Pool() {
    {
      const std::lock_guard lock(mutex);
      is_over = true;
    }
    wake.notify_all();
    for (std::thread& thread : threads) thread.join();
  }

  void serve() {
    std::unique_lock lock(mutex);
    for (std::size_t seen = 0;;) {
      wake.wait(lock, [&] { return is_over || jobs != seen; });
      if (is_over) return;
      seen = jobs;
      // A thread that wakes up late may find that the job is done.
      if (job == nullptr) continue;
      Job& own = *job;
      ++busy;
      lock.unlock();
      own.run();
      lock.lock();
      if (--busy == 0) done.notify_one();
    }
  }

  void share(Job& own) {
    {
      const std::lock_guard lock(mutex);
      job = &own;
      ++jobs;
    }
    wake.notify_all();
    own.run();
    std::unique_lock lock(mutex);
    job = nullptr;
    done.wait(lock, [&] { return busy == 0; });
    if (own.failure) std::rethrow_exception(own.failure);
  }

  const pid_t process;
  std::mutex mutex;
  std::condition_variable wake, done;
  Job* job = nullptr;
  std::size_t jobs = 0;  // number of jobs so far
  std::size_t busy = 0;  // threads at work on the job
  bool is_over = false;
  std::vector<std::thread> threads;
};

Threads::Threads(std::size_t count) : count_(count > 0 ? count : native_threads()) {}

Threads::~Threads() {
  if (pool_ && pool_->process != getpid()) pool_.release();
}

void Threads::share(std::size_t n, std::size_t part, const Work& work) {
  if (n == 0) return;
  if (count_ == 1 || n <= part) return work(0, n);
  // The threads of a forked process's parent do not exist here and cannot be joined, so their pool is given
  // up.
  if (pool_ && pool_->process != getpid()) pool_.release();
  if (!pool_) pool_ = std::make_unique<Pool>(count_ - 1);
  Pool::Job job{work, n, part};
  pool_->share(job);
}

void Threads::copy(char* to, const char* from, std::size_t bytes) {
  constexpr std::size_t kPart = std::size_t{1} << 19;
  share(bytes, kPart,
        [&](std::size_t begin, std::size_t end) { std::memcpy(to + begin, from + begin, end - begin); });
}

}  // namespace flaunay::host
