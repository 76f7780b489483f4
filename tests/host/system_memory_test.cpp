// What the system says of memory, from files as Linux has them.
#include "host/memory/system_memory.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <limits>
#include <string>

#include "tests/support/device.hpp"
#include "tests/support/sanitized.hpp"

namespace flaunay::host {
namespace {

using testing::TemporaryFolder;

constexpr std::size_t kMegabyte = std::size_t{1} << 20;
constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

class SmallSystemMemory : public ::testing::Test {
 protected:
  MemoryFiles files() const { return {folder_.path() + "/proc", folder_.path() + "/cgroup"}; }
  void machine(std::size_t available_megabytes, std::size_t swap_megabytes) {
    folder_.write("proc/meminfo",
                  "MemTotal:       99999999 kB\nMemFree:            1234 kB\nMemAvailable:   " +
                      std::to_string(1024 * available_megabytes) +
                      " kB\nSwapTotal:  77777777 kB\nSwapFree:  " + std::to_string(1024 * swap_megabytes) +
                      " kB\n");
  }
  void groups(const std::string& lines) { folder_.write("proc/self/cgroup", lines); }
  void version1(const std::string& group, std::size_t limit, std::size_t used, std::size_t reclaimable) {
    const std::string path = "cgroup/memory" + group + "/";
    folder_.write(path + "memory.limit_in_bytes", std::to_string(limit) + "\n");
    folder_.write(path + "memory.usage_in_bytes", std::to_string(used) + "\n");
    folder_.write(path + "memory.stat",
                  "cache 5\ninactive_file 7\ntotal_inactive_file " + std::to_string(reclaimable) + "\n");
  }
  void version2(const std::string& group, const std::string& limit, std::size_t used,
                std::size_t reclaimable) {
    const std::string path = "cgroup" + group + "/";
    folder_.write(path + "memory.max", limit + "\n");
    folder_.write(path + "memory.current", std::to_string(used) + "\n");
    folder_.write(path + "memory.stat",
                  "anon 5\ninactive_file " + std::to_string(reclaimable) + "\nactive_file 9\n");
  }
  void expect(std::size_t bytes, const std::string& limit) const {
    const MemoryLeft left = memory_left(files());
    EXPECT_EQ(left.bytes, bytes);
    EXPECT_NE(left.limit.find(limit), std::string::npos) << left.limit;
  }

  TemporaryFolder folder_;
};

TEST_F(SmallSystemMemory, NothingIsKnown) { expect(kUnlimited, ""); }

TEST_F(SmallSystemMemory, Machine) {
  machine(300, 0);
  expect(300 * kMegabyte, "free memory of the machine");
  machine(300, 50);
  expect(350 * kMegabyte, "free memory of the machine");
}

TEST_F(SmallSystemMemory, GroupsOfVersion2) {
  machine(3000, 0);
  groups("0::/user/work\n");
  version2("/user/work", "max", 100 * kMegabyte, 0);
  expect(3000 * kMegabyte, "machine");
  version2("/user/work", std::to_string(500 * kMegabyte), 100 * kMegabyte, 0);
  expect(400 * kMegabyte, "/user/work/memory.max");
  version2("/user/work", std::to_string(500 * kMegabyte), 100 * kMegabyte, 30 * kMegabyte);
  expect(430 * kMegabyte, "/user/work/memory.max");
  // The group around it.
  version2("/user", std::to_string(800 * kMegabyte), 700 * kMegabyte, 0);
  expect(100 * kMegabyte, "/user/memory.max");
  version2("/user", std::to_string(800 * kMegabyte), 900 * kMegabyte, 0);
  expect(0, "/user/memory.max");
}

TEST_F(SmallSystemMemory, GroupsOfVersion1) {
  machine(3000, 0);
  groups("9:name=systemd:/\n4:cpu,memory:/user/work\n1:cpu:/\n0::/\n");
  version1("/user/work", 500 * kMegabyte, 100 * kMegabyte, 20 * kMegabyte);
  expect(420 * kMegabyte, "/user/work/memory.limit_in_bytes");
  // No limit is a large number.
  version1("/user/work", 9223372036854771712U, 100 * kMegabyte, 0);
  expect(3000 * kMegabyte, "machine");
}

TEST_F(SmallSystemMemory, AContainerSeesItsGroupAsTheRoot) {
  machine(3000, 0);
  groups("0::/docker/0123456789\n");
  version2("", std::to_string(200 * kMegabyte), 50 * kMegabyte, 0);
  expect(150 * kMegabyte, "cgroup/memory.max");
}

TEST_F(SmallSystemMemory, FilesThatSayNothing) {
  folder_.write("proc/meminfo", "MemTotal: many kB\n");
  groups("nonsense\n0:\n::\n4:memory:relative\n");
  expect(kUnlimited, "");
  groups("0::/user\n");
  folder_.write("cgroup/user/memory.max", "\n");
  expect(kUnlimited, "");
}

/// A limit of this process, put back at the end.
class ScopedLimit {
 public:
  ScopedLimit(decltype(RLIMIT_AS) kind, std::size_t bytes) : kind_(kind) {
    getrlimit(kind_, &before_);
    rlimit changed = before_;
    changed.rlim_cur = bytes;
    setrlimit(kind_, &changed);
  }
  ~ScopedLimit() { setrlimit(kind_, &before_); }

 private:
  decltype(RLIMIT_AS) kind_;
  rlimit before_{};
};

TEST_F(SmallSystemMemory, LimitsOfTheProcess) {
  if (testing::is_sanitized()) GTEST_SKIP() << "the limits leave no room for the sanitizer's own memory";
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  folder_.write("proc/self/statm", "1000 500 300 20 0 400 0\n");
  machine(3000000, 0);
  // Far above what this process has, so that it is not in the way.
  const std::size_t limit = std::size_t{1} << 40;
  {
    const ScopedLimit space(RLIMIT_AS, limit);
    const MemoryLeft left = address_space_left(files());
    EXPECT_EQ(left.bytes, limit - 1000 * page);
    EXPECT_NE(left.limit.find("ulimit -v"), std::string::npos) << left.limit;
    expect(limit - 1000 * page, "ulimit -v");
    const ScopedLimit data(RLIMIT_DATA, limit / 2);
    EXPECT_EQ(address_space_left(files()).bytes, limit / 2 - 400 * page);
    expect(limit / 2 - 400 * page, "ulimit -d");
  }
}

TEST_F(SmallSystemMemory, OfThisMachine) {
  const MemoryLeft left = memory_left();
  EXPECT_GT(left.bytes, 16 * kMegabyte);
  EXPECT_LT(left.bytes, kUnlimited);
  EXPECT_FALSE(left.limit.empty());
}

}  // namespace
}  // namespace flaunay::host
