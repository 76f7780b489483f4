// Threads of the host that share the work-items of a launch.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace flaunay::host {

/// The number of threads that run native kernels: the environment variable FLAUNAY_THREADS, or one per core
/// that this process may use. Throws DeviceError if FLAUNAY_THREADS is not a number from 1 to 1024.
std::size_t native_threads();

/// Threads that wait for work, and do it together with the thread that has it. Must be used by one thread at
/// a time. They are started when there is work for several; a forked process starts its own.
class Threads {
 public:
  using Work = std::function<void(std::size_t begin, std::size_t end)>;

  /// count: the number of threads including the caller's; 0: native_threads().
  explicit Threads(std::size_t count = 0);
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  std::size_t count() const { return count_; }
  /// Calls work(begin, end) on all threads, for parts of [0, n) with `part` elements each, or fewer at the
  /// end; calls begin in ascending order. Returns when all is done. If a call throws, no more calls begin,
  /// and the exception is thrown here; of several exceptions, that of the first part is. If the system
  /// refuses threads, the others do their work.
  void share(std::size_t n, std::size_t part, const Work& work);
  /// Copies bytes, many by all threads. They must not overlap.
  void copy(char* to, const char* from, std::size_t bytes);
  /// Calls work(k) for each k below n.
  template <typename WorkOnOne>
  void share_each(std::size_t n, const WorkOnOne& work) {
    share(n, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) work(k);
    });
  }

 private:
  struct Pool;
  std::size_t count_;
  std::unique_ptr<Pool> pool_;
};

}  // namespace flaunay::host
