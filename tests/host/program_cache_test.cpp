// The cache of compiled programs: what comes back is what was stored, or nothing.
#include "host/opencl/program_cache.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "host/launch/vector_operations.hpp"
#include "host/opencl/device.hpp"
#include "host/runtime.hpp"
#include "tests/support/device.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::host {
namespace {

namespace fs = std::filesystem;
using testing::ScopedEnvironment;
using testing::TemporaryFolder;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const fs::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

TEST(SmallProgramCache, ReturnsWhatWasStored) {
  const TemporaryFolder folder;
  const ProgramCache cache(folder.path() + "/made/when/needed");
  EXPECT_FALSE(cache.load("key"));
  const std::string program("\0binary\n", 8);
  cache.store("key", program);
  cache.store("other", "");
  EXPECT_EQ(cache.load("key"), program);
  EXPECT_EQ(cache.load("other"), "");
  EXPECT_FALSE(cache.load("kez"));
  cache.store("key", "newer");
  EXPECT_EQ(ProgramCache(cache.folder()).load("key"), "newer");
  EXPECT_EQ(files_in(cache.folder()).size(), 2u);
}

TEST(SmallProgramCache, IgnoresDamagedAndForeignFiles) {
  const TemporaryFolder folder;
  const ProgramCache cache(folder.path());
  cache.store("key", "program");
  const fs::path file = files_in(folder.path()).at(0);
  const std::string whole = content_of(file);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    write(file, damaged);
    EXPECT_FALSE(cache.load("key")) << "byte " << i;
    write(file, whole.substr(0, i));
    EXPECT_FALSE(cache.load("key")) << "length " << i;
  }
  write(file, whole + "x");
  EXPECT_FALSE(cache.load("key"));
  // A file of another key, as if its name had been changed; its key and program are as long.
  cache.store("kez", "another");
  for (const fs::path& path : files_in(folder.path())) {
    if (path != file) fs::rename(path, file);
  }
  EXPECT_FALSE(cache.load("key"));
  cache.store("key", "program");
  EXPECT_EQ(cache.load("key"), "program");
}

mode_t mode_of(const fs::path& path) {
  struct stat status {};
  EXPECT_EQ(lstat(path.c_str(), &status), 0) << path;
  return status.st_mode & 07777;
}

TEST(SmallProgramCache, IsTheUsersAloneWhateverTheUmask) {
  const TemporaryFolder folder;
  for (const mode_t mask : {0, 022, 077}) {
    const fs::path parent = fs::path(folder.path()) / std::to_string(mask);
    const mode_t before = umask(mask);
    ProgramCache(parent / "cache").store("key", "program");
    umask(before);
    EXPECT_EQ(mode_of(parent), 0700U);
    EXPECT_EQ(mode_of(parent / "cache"), 0700U);
    EXPECT_EQ(mode_of(files_in(parent / "cache").at(0)), 0600U);
  }
}

TEST(SmallProgramCache, IsNotUsedIfOthersCanWriteToIt) {
  const TemporaryFolder folder;
  const ProgramCache cache(folder.path());
  cache.store("key", "program");
  const fs::path file = files_in(folder.path()).at(0);
  for (const mode_t mode : {0777U, 01777U, 0770U, 0702U}) {
    SCOPED_TRACE(mode);
    ASSERT_EQ(chmod(folder.path().c_str(), mode), 0);
    EXPECT_FALSE(cache.load("key"));
    cache.store("other", "program");
    EXPECT_EQ(files_in(folder.path()).size(), 1U);
    EXPECT_EQ(mode_of(folder.path()), mode) << "not ours to change";
    ASSERT_EQ(chmod(folder.path().c_str(), 0755), 0);
    EXPECT_EQ(cache.load("key"), "program");
    ASSERT_EQ(chmod(file.c_str(), mode), 0);
    EXPECT_FALSE(cache.load("key"));
    cache.store("key", "program");
    EXPECT_EQ(cache.load("key"), "program");
  }
  constexpr uid_t kAnother = 12345;
  if (chown(file.c_str(), kAnother, getegid()) != 0) GTEST_SKIP() << "files cannot be given away here";
  EXPECT_FALSE(cache.load("key"));
  cache.store("key", "program");
  EXPECT_EQ(cache.load("key"), "program");
  ASSERT_EQ(chown(folder.path().c_str(), kAnother, getegid()), 0);
  EXPECT_FALSE(cache.load("key"));
  cache.store("other", "program");
  EXPECT_EQ(files_in(folder.path()).size(), 1U);
}

TEST(SmallProgramCache, LoadsFilesOnly) {
  const TemporaryFolder folder, elsewhere;
  const ProgramCache cache(folder.path());
  cache.store("key", "program");
  const fs::path file = files_in(folder.path()).at(0), moved = fs::path(elsewhere.path()) / "moved";
  fs::rename(file, moved);
  const auto expect_replaced = [&](const char* what) {
    alarm(60);  // if it waits for a writer, or reads without end
    EXPECT_FALSE(cache.load("key")) << what;
    cache.store("key", "program");
    EXPECT_EQ(cache.load("key"), "program") << what;
    alarm(0);
    fs::remove(file);
  };
  for (const fs::path& target : {moved, fs::path("/dev/zero"), fs::path(elsewhere.path()) / "nothing"}) {
    fs::create_symlink(target, file);
    expect_replaced(target.c_str());
  }
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  expect_replaced("FIFO");
  write(file, "large");
  fs::resize_file(file, std::uintmax_t{1} << 40);
  expect_replaced("larger than memory");
  EXPECT_EQ(files_in(elsewhere.path()).size(), 1U);
}

TEST(SmallProgramCache, FollowsNoLinks) {
  const TemporaryFolder folder, elsewhere;
  const ProgramCache cache(folder.path());
  cache.store("key", "program");
  const fs::path file = files_in(folder.path()).at(0), precious = fs::path(elsewhere.path()) / "precious";
  write(precious, "precious");
  fs::remove(file);
  fs::create_symlink(precious, file);
  // Names that were guessed.
  for (int k = 0; k < 2000; ++k) {
    fs::create_symlink(precious,
                       file.string() + "." + std::to_string(getpid()) + "-" + std::to_string(k) + ".partial");
  }
  cache.store("key", "program");
  EXPECT_EQ(cache.load("key"), "program");
  EXPECT_EQ(content_of(precious), "precious");
}

TEST(SmallProgramCache, IsBoundedAndDropsTheOldest) {
  const TemporaryFolder folder;
  const ProgramCache cache(folder.path(), 5000);
  const std::string program(1000, 'x');
  for (int k = 0; k < 10; ++k) {
    cache.store(std::to_string(k), program);
    // File systems' times can be coarse.
    for (const fs::path& path : files_in(folder.path())) {
      fs::last_write_time(path, fs::last_write_time(path) - std::chrono::seconds(10));
    }
  }
  std::size_t bytes = 0;
  for (const fs::path& path : files_in(folder.path())) bytes += fs::file_size(path);
  EXPECT_LE(bytes, 5000u);
  EXPECT_FALSE(cache.load("0"));
  EXPECT_EQ(cache.load("9"), program);
  cache.store("10", std::string(5000, 'x'));
  EXPECT_EQ(cache.load("9"), program) << "what is too large takes no other's place";
}

TEST(SmallProgramCache, NeedsNoFolder) {
  for (const std::string folder : {"", "/proc/no such folder", "/dev/null"}) {
    const ProgramCache cache(folder);
    cache.store("key", "program");
    EXPECT_FALSE(cache.load("key")) << folder;
  }
}

TEST(SmallProgramCache, IsFoundByTheEnvironment) {
  const ScopedEnvironment home("HOME", "/home/someone");
  const ScopedEnvironment xdg("XDG_CACHE_HOME", "/caches");
  {
    const ScopedEnvironment own("FLAUNAY_CACHE_DIR", "/elsewhere");
    EXPECT_EQ(default_cache_folder(), "/elsewhere");
  }
  const ScopedEnvironment own("FLAUNAY_CACHE_DIR", nullptr);
  EXPECT_EQ(default_cache_folder(), "/caches/flaunay");
  const ScopedEnvironment relative("XDG_CACHE_HOME", "not/absolute");
  EXPECT_EQ(default_cache_folder(), "/home/someone/.cache/flaunay");
  const ScopedEnvironment homeless("HOME", nullptr);
  EXPECT_EQ(default_cache_folder(), "");
}

TEST(SmallProgramCache, ServesManyProcessesAtOnce) {
  const TemporaryFolder folder;
  constexpr int kProcesses = 16;
  std::vector<pid_t> children;
  for (int p = 0; p < kProcesses; ++p) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      alarm(120);
      const ProgramCache cache(folder.path(), 20000);
      for (int round = 0; round < 50; ++round) {
        const std::string key = std::to_string(round % 4);
        const std::string program(1000 + 1000 * (round % 4), key[0]);
        cache.store(key, program);
        const auto loaded = cache.load(key);
        if (loaded && *loaded != program) _exit(1);
      }
      _exit(0);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "status " << status;
  }
  EXPECT_EQ(files_in(folder.path()).size(), 4u) << "unfinished files are left";
}

std::vector<cl_uint> sums_of_a_new_runtime(bool& compiled) {
  const auto device = find_device("");
  Runtime runtime(device, settings_for(device));
  compiled = false;
  const Runtime::BeforeCompiling watch(runtime, [&compiled] { compiled = true; });
  const Arena::Scope scope(runtime.arena());
  const auto values = testing::upload(runtime, std::vector<cl_uint>{1, 2, 3, 0});
  exclusive_scan(runtime, values, 3, values);
  return testing::download(runtime, values, 4);
}

TEST(SmallProgramCache, SparesRuntimesTheCompiler) {
  const TemporaryFolder folder;
  const ScopedEnvironment own("FLAUNAY_CACHE_DIR", folder.path().c_str());
  const std::vector<cl_uint> expected = {0, 1, 3, 6};
  bool compiled = false;
  EXPECT_EQ(sums_of_a_new_runtime(compiled), expected);
  EXPECT_TRUE(compiled);
  const std::vector<fs::path> files = files_in(folder.path());
  if (files.empty()) GTEST_SKIP() << "the driver has no binaries";
  EXPECT_EQ(sums_of_a_new_runtime(compiled), expected);
  EXPECT_FALSE(compiled);
  // A file that is whole, but whose binary is none for the driver.
  const std::string content = content_of(files[0]);
  const std::string key = content.substr(content.find('\n') + 1 + 16);
  write(files[0], "damaged");
  EXPECT_EQ(sums_of_a_new_runtime(compiled), expected);
  EXPECT_TRUE(compiled);
}

}  // namespace
}  // namespace flaunay::host
