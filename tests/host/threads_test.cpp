// Threads that share work: every element once, also in a process that was forked.
#include "host/native/threads.hpp"

#include <gtest/gtest.h>
#ifndef _WIN32
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "host/error.hpp"
#include "tests/support/device.hpp"

namespace flaunay::host {
namespace {

// Whether [0, n) was taken in parts of the right size, each element once.
bool shares_well(Threads& threads, std::size_t n, std::size_t part) {
  std::vector<std::atomic<int>> taken(n);
  std::atomic<bool> fits{true};
  threads.share(n, part, [&](std::size_t begin, std::size_t end) {
    const bool is_whole = begin == 0 && end == n;
    if (!is_whole && (begin % part != 0 || end - begin > part || begin >= end)) fits = false;
    for (std::size_t i = begin; i < end; ++i) ++taken[i];
  });
  for (const std::atomic<int>& times : taken) fits = fits && times == 1;
  return fits;
}

TEST(SmallThreads, TakeEveryElementOnce) {
  for (const std::size_t count : {1, 2, 5}) {
    Threads threads(count);
    EXPECT_EQ(threads.count(), count);
    for (const std::size_t n : {0, 1, 2, 3, 7, 64, 1000, 12345}) {
      for (const std::size_t part : {1, 2, 3, 64, 5000}) {
        EXPECT_TRUE(shares_well(threads, n, part)) << count << " threads, " << n << " in parts of " << part;
      }
    }
  }
}

TEST(SmallThreads, OneAfterTheOtherWithoutLosingAny) {
  Threads threads(3);
  for (int round = 0; round < 3000; ++round) ASSERT_TRUE(shares_well(threads, 5, 1)) << "round " << round;
}

TEST(SmallThreads, ThrowWhatAnyOfThemThrows) {
  Threads threads(4);
  const auto caller = std::this_thread::get_id();
  for (int round = 0; round < 200; ++round) {
    for (const bool helper_fails : {false, true}) {
      std::atomic<bool> has_failed{false};
      const auto fail = [&](std::size_t, std::size_t) {
        while ((std::this_thread::get_id() == caller) == helper_fails && !has_failed)
          std::this_thread::yield();
        has_failed = true;
        throw std::runtime_error("one");
      };
      EXPECT_THROW(threads.share(1000, 1, fail), std::runtime_error);
      ASSERT_TRUE(shares_well(threads, 100, 1)) << "round " << round;
    }
  }
}

TEST(SmallThreads, AreCountedByTheEnvironment) {
  const testing::ScopedEnvironment three("FLAUNAY_THREADS", "3");
  EXPECT_EQ(Threads().count(), 3u);
  {
    const testing::ScopedEnvironment unset("FLAUNAY_THREADS", nullptr);
    EXPECT_GE(Threads().count(), 1u);
    EXPECT_LE(Threads().count(), std::thread::hardware_concurrency());
  }
  for (const char* const wrong : {"0", "-1", "x", "2x", "1025", "99999999999999999999"}) {
    const testing::ScopedEnvironment variable("FLAUNAY_THREADS", wrong);
    try {
      Threads();
      ADD_FAILURE() << wrong;
    } catch (const DeviceError& error) {
      EXPECT_NE(std::string(error.what()).find(wrong), std::string::npos) << error.what();
    }
  }
}

#ifndef _WIN32
TEST(SmallThreads, ForkedProcessesHaveTheirOwn) {
  Threads threads(3);
  ASSERT_TRUE(shares_well(threads, 100, 1));
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    alarm(60);
    _exit(shares_well(threads, 100, 1) ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "status " << status;
  EXPECT_TRUE(shares_well(threads, 100, 1));
}
#endif

}  // namespace
}  // namespace flaunay::host
