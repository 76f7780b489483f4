// Independent pieces of work on several host threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace flaunay::host {

/// The number of threads to use: `threads` if it is positive, otherwise one per core.
inline std::size_t host_threads(int threads) {
  return threads > 0 ? static_cast<std::size_t>(threads) : std::max(1U, std::thread::hardware_concurrency());
}

/// Calls task(k) for all k below count, on several threads including the calling one; calls begin in
/// ascending order. After a failure no more calls begin; the exception of the smallest k that failed is
/// thrown.
template <typename Task>
void for_each_index(std::size_t count, int threads, const Task& task) {
  std::atomic<std::size_t> next{0};
  std::mutex failure_mutex;
  std::exception_ptr failure;
  std::size_t failed = count;
  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) {
      try {
        task(k);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(failure_mutex);
        if (k < failed) failure = std::current_exception();
        failed = std::min(failed, k);
        next = count;
      }
    }
  };
  std::vector<std::thread> others;
  others.reserve(std::min(host_threads(threads), count));
  try {
    while (others.size() + 1 < std::min(host_threads(threads), count)) others.emplace_back(work);
  } catch (const std::exception&) {
    // If there is no thread, or no memory for it, the others do its work.
  }
  work();
  for (std::thread& thread : others) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace flaunay::host
