// The folder in which PoCL keeps compiled kernels.
#include "host/opencl/pocl.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/host/support.hpp"

namespace flaunay::host {
namespace {

TEST(SmallPocl, EmptyKernelsAreRemovedAndNothingElse) {
  const TemporaryFolder folder;
  const std::string program = "AB/CDEF/";
  const std::string kernel = program + "project/256-1-1/";
  const std::vector<std::string> removed = {program + "program.bc", kernel + "project.so",
                                            kernel + "parallel.bc"};
  // What is empty by intention, and what another process is about to write.
  const std::vector<std::string> kept = {program + "last_accessed", kernel + "tempfile-1.so", "tempfile_x.bc",
                                         kernel + "project.so.o"};
  for (const auto* files : {&removed, &kept}) {
    for (const std::string& file : *files) folder.write(file, "");
  }
  folder.write(program + "cut/16-1-1/cut.so", "code");
  remove_empty_kernels(folder.path());
  const auto exists = [&](const std::string& file) {
    return std::filesystem::exists(folder.path() + "/" + file);
  };
  for (const std::string& file : removed) EXPECT_FALSE(exists(file)) << file;
  for (const std::string& file : kept) EXPECT_TRUE(exists(file)) << file;
  EXPECT_TRUE(exists(program + "cut/16-1-1/cut.so"));
  remove_empty_kernels(folder.path() + "/none");
}

TEST(SmallPocl, AFolderThatCannotBeUsedIsNamed) {
  const TemporaryFolder folder;
  require_cache_folder(folder.path() + "/new/folder");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() + "/new/folder"));
  folder.write("file", "");
  for (const std::string& wrong :
       {folder.path() + "/file", folder.path() + "/file/below", std::string("/proc/x")}) {
    const std::string message = message_of([&] { require_cache_folder(wrong); }, CL_SUCCESS);
    EXPECT_TRUE(contains(message, wrong) && contains(message, "POCL_CACHE_DIR")) << message;
  }
}

TEST(SmallPocl, ANewFolderIsTheUsersAlone) {
  const TemporaryFolder folder;
  const mode_t before = umask(0);
  require_cache_folder(folder.path() + "/new/folder");
  umask(before);
  for (const char* subfolder : {"/new", "/new/folder"}) {
    struct stat status {};
    ASSERT_EQ(stat((folder.path() + subfolder).c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0700U) << subfolder;
  }
}

TEST(SmallPocl, APlantedLinkIsNotFollowed) {
  const TemporaryFolder folder, elsewhere;
  const ScopedEnvironment own("POCL_CACHE_DIR", folder.path().c_str());
  note_pocl_ended_well();
  ASSERT_FALSE(std::filesystem::is_empty(folder.path()));
  const auto note = std::filesystem::directory_iterator(folder.path())->path();
  elsewhere.write("precious", "precious");
  for (const char* target : {"precious", "nothing"}) {
    std::filesystem::remove(note);
    std::filesystem::create_symlink(elsewhere.path() + "/" + target, note);
    note_pocl_ended_well();
  }
  EXPECT_EQ(std::filesystem::file_size(elsewhere.path() + "/precious"), 8U);
  EXPECT_FALSE(std::filesystem::exists(elsewhere.path() + "/nothing"));
}

TEST(SmallPocl, TheFolderIsThatOfTheEnvironment) {
  const ScopedEnvironment home("HOME", "/home/someone"), caches("XDG_CACHE_HOME", nullptr);
  const ScopedEnvironment kept("POCL_KERNEL_CACHE", nullptr), other("POCL_CACHE_DIR", nullptr);
  EXPECT_EQ(pocl_cache_folder(), "/home/someone/.cache/pocl/kcache");
  const ScopedEnvironment others("XDG_CACHE_HOME", "/caches");
  EXPECT_EQ(pocl_cache_folder(), "/caches/pocl/kcache");
  const ScopedEnvironment own("POCL_CACHE_DIR", "/kernels");
  EXPECT_EQ(pocl_cache_folder(), "/kernels");
}

}  // namespace
}  // namespace flaunay::host
