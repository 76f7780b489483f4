// The runtime: copies, errors and what they say, kernel files, accounts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "host/clock.hpp"
#include "host/error.hpp"
#include "host/launch/vector_operations.hpp"
#include "host/opencl/programs.hpp"
#include "launchers/operations/pack.cl.hpp"
#include "tests/host/support.hpp"
#include "tests/support/test_kernels.hpp"

namespace flaunay::host {
namespace {

TEST(SmallCopies, ReadWriteCopyAndFillPartsOfArrays) {
  Runtime& runtime = Runtimes::get("own");
  const Arena::Scope scope(runtime.arena());
  const auto a = upload(runtime, std::vector<cl_int>{0, 1, 2, 3, 4, 5});
  const cl_int two[] = {20, 30};
  runtime.write(a, 2, 2, two);
  runtime.write(a, 0, 0, two);
  EXPECT_EQ(download(runtime, a, 6), (std::vector<cl_int>{0, 1, 20, 30, 4, 5}));
  EXPECT_EQ(runtime.read_one(a, 3), 30);
  const auto b = upload(runtime, std::vector<cl_int>(6, -1));
  runtime.copy(a, 1, b, 3, 2);
  runtime.copy(a, 0, b, 0, 0);
  EXPECT_EQ(download(runtime, b, 6), (std::vector<cl_int>{-1, -1, -1, 1, 20, -1}));
  runtime.fill(b, 4, cl_int{8});
  runtime.fill(b, 0, cl_int{9});
  EXPECT_EQ(download(runtime, b, 6), (std::vector<cl_int>{8, 8, 8, 8, 20, -1}));
}

TEST(SmallResults, VectorsAreResizedNativelyAsOnADevice) {
  Runtime native(native_tuning());
  for (Runtime* runtime : {&Runtimes::get("own"), &native}) {
    std::vector<cl_int> values{1, 2, 3};
    runtime->resize(values, 3'000'000);
    ASSERT_EQ(values.size(), 3'000'000u);
    EXPECT_EQ(values[2], 3);
    EXPECT_EQ(std::count(values.begin() + 3, values.end(), 0), 3'000'000 - 3);
    runtime->resize(values, 2);
    runtime->resize(values, 5);
    EXPECT_EQ(values, (std::vector<cl_int>{1, 2, 0, 0, 0}));
    runtime->resize(values, 0);
    EXPECT_TRUE(values.empty());
  }
}

TEST(SmallError, NamesCallCodeKernelAndRemedy) {
  EXPECT_EQ(error_name(CL_SUCCESS), "CL_SUCCESS");
  EXPECT_EQ(error_name(-5), "CL_OUT_OF_RESOURCES");
  EXPECT_EQ(error_name(-1001), "CL_PLATFORM_NOT_FOUND_KHR");
  EXPECT_EQ(error_name(-1234), "unknown OpenCL error -1234");
  EXPECT_TRUE(contains(error_advice(CL_OUT_OF_RESOURCES), "FLAUNAY_DEVICE"));
  EXPECT_EQ(error_advice(CL_INVALID_KERNEL_NAME), "");
  EXPECT_NO_THROW(check_call(CL_SUCCESS, "clFinish"));
  const std::string message =
      message_of([] { check_call(CL_MEM_OBJECT_ALLOCATION_FAILURE, "clThing", "scan_it"); },
                 CL_MEM_OBJECT_ALLOCATION_FAILURE);
  for (const char* const part :
       {"CL_MEM_OBJECT_ALLOCATION_FAILURE", "-4", "clThing", "kernel scan_it", "out of memory"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST(Error, ShowsTheCallsOwnText) {
  const std::string message = message_of([] { FLAUNAY_CL(clFinish(nullptr)); }, CL_INVALID_COMMAND_QUEUE);
  EXPECT_TRUE(contains(message, "CL_INVALID_COMMAND_QUEUE")) << message;
  EXPECT_TRUE(contains(message, "-36")) << message;
  EXPECT_TRUE(contains(message, "clFinish(nullptr)")) << message;
}

class LaunchError : public ::testing::Test {
 protected:
  LaunchError() : runtime_(find_device(""), settings_for(find_device(""))) {
    buffer_ = runtime_.arena().allocate<cl_int>(10);
  }
  Runtime runtime_;
  testing::TestKernels kernels_;
  Buffer<cl_int> buffer_;
};

TEST_F(LaunchError, UnknownKernel) {
  const std::string message =
      message_of([&] { testing::map_unchecked(runtime_, "plain", "no_such_kernel", 10, buffer_); },
                 CL_INVALID_KERNEL_NAME);
  for (const char* const part :
       {"CL_INVALID_KERNEL_NAME", "-46", "clCreateKernel", "plain.cl: no_such_kernel"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST_F(LaunchError, UnknownFile) {
  const std::string message = message_of(
      [&] { testing::map_unchecked(runtime_, "no_such_file", "kernel", 10, buffer_); }, CL_SUCCESS);
  EXPECT_TRUE(contains(message, "no_such_file.cl")) << message;
}

TEST_F(LaunchError, TooFewArguments) {
  const std::string message = message_of(
      [&] { testing::map_unchecked(runtime_, "plain", "move_int", 10, cl_int{4}, buffer_, buffer_); },
      CL_INVALID_KERNEL_ARGS);
  for (const char* const part :
       {"CL_INVALID_KERNEL_ARGS", "-52", "clEnqueueNDRangeKernel", "kernel move_int"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST_F(LaunchError, TooManyArguments) {
  const std::string message = message_of(
      [&] {
        testing::map_unchecked(runtime_, "plain", "move_int", 10, cl_int{4}, buffer_, buffer_, buffer_,
                               cl_int{4});
      },
      CL_INVALID_ARG_INDEX);
  for (const char* const part : {"CL_INVALID_ARG_INDEX", "-49", "clSetKernelArg", "kernel move_int"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST_F(LaunchError, ArgumentOfAnotherSize) {
  const std::string message = message_of(
      [&] {
        testing::map_unchecked(runtime_, "plain", "move_int", 10, cl_double{1}, buffer_, buffer_, buffer_);
      },
      CL_INVALID_ARG_SIZE);
  for (const char* const part : {"CL_INVALID_ARG_SIZE", "-51", "clSetKernelArg", "kernel move_int"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
}

TEST_F(LaunchError, TheRuntimeGoesOn) {
  EXPECT_THROW(testing::map_unchecked(runtime_, "plain", "no_such_kernel", 10, buffer_), DeviceError);
  EXPECT_THROW(testing::map_unchecked(runtime_, "plain", "move_int", 10, cl_int{4}, buffer_, buffer_),
               DeviceError);
  const auto places = upload(runtime_, std::vector<cl_int>{2, 0, 1}),
             values = upload(runtime_, std::vector<cl_int>{5, 6, 7});
  const auto moved = guarded<cl_int>(runtime_, 3);
  testing::map_unchecked(runtime_, "plain", "move_int", 3, cl_int{4}, places, values, moved);
  EXPECT_EQ(download(runtime_, moved, 3), (std::vector<cl_int>{10, 11, 9}));
}

TEST(KernelPath, ABuildFailureNamesTheFileAndShowsTheLog) {
  const TemporaryFolder folder;
  folder.write("broken.cl",
               "#include \"shared/fine.h\"\n\nkernel void f(global int* a) { a[0] = nonesuch; }\n");
  folder.write("shared/fine.h", "// nothing\n");
  const ScopedEnvironment path("FLAUNAY_KERNEL_PATH", folder.path().c_str());
  Runtime runtime(find_device(""), settings_for(find_device("")));
  const auto buffer = runtime.arena().allocate<cl_int>(1);
  const std::string message = message_of([&] { testing::map_unchecked(runtime, "broken", "f", 1, buffer); },
                                         CL_BUILD_PROGRAM_FAILURE);
  for (const char* const part :
       {"CL_BUILD_PROGRAM_FAILURE", "clBuildProgram", "kernels/broken.cl", "nonesuch"}) {
    EXPECT_TRUE(contains(message, part)) << message;
  }
  // The line of the file, in spite of what was put in place before it; NVIDIA's compiler counts those lines,
  // too.
  EXPECT_TRUE(contains(message, "broken.cl:3:") || contains(message, "<kernel>:6:")) << message;
}

TEST(KernelPath, AMissingFileIsNamed) {
  const TemporaryFolder folder;
  folder.write("lonely.cl", "#include \"shared/missing.h\"\n");
  const ScopedEnvironment path("FLAUNAY_KERNEL_PATH", folder.path().c_str());
  for (const auto& [file, missing] : std::map<std::string, std::string>{
           {"absent", folder.path() + "/absent.cl"}, {"lonely", folder.path() + "/shared/missing.h"}}) {
    const std::string message = message_of([f = file] { kernel_source(f); }, CL_SUCCESS);
    EXPECT_TRUE(contains(message, missing)) << message;
    EXPECT_TRUE(contains(message, "FLAUNAY_KERNEL_PATH")) << message;
  }
}

TEST(KernelPath, IncludesArePutInPlaceOnce) {
  const TemporaryFolder folder;
  folder.write("a.cl", "#include \"shared/b.h\"\n#include \"shared/c.h\"\nlast\n");
  folder.write("shared/b.h", "in b\n#include \"shared/c.h\"\n");
  folder.write("shared/c.h", "in c");
  const ScopedEnvironment path("FLAUNAY_KERNEL_PATH", folder.path().c_str());
  EXPECT_EQ(kernel_source("a"),
            "#line 1 \"a.cl\"\n#line 1 \"shared/b.h\"\nin b\n#line 1 \"shared/c.h\"\nin c\n"
            "#line 3 \"shared/b.h\"\n#line 2 \"a.cl\"\n#line 3 \"a.cl\"\nlast\n");
}

// Programs that were compiled before are used again as long as their text is the same.
TEST(KernelPath, OneMoreCodeOfARoomChangesNoOtherRoomsPrograms) {
  namespace fs = std::filesystem;
  const fs::path kernels = fs::absolute(fs::path(test_data()).parent_path().parent_path() / "kernels");
  const auto sources = [&kernels] {
    std::map<std::string, std::string> all;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kernels)) {
      const fs::path file = fs::relative(entry.path(), kernels).replace_extension();
      if (entry.path().extension() == ".cl") all[file.string()] = kernel_source(file.string());
    }
    return all;
  };
  const auto before = [&] {
    const ScopedEnvironment path("FLAUNAY_KERNEL_PATH", kernels.c_str());  // embedded text has no comments
    return sources();
  }();
  for (const std::string room : {"blocks", "constrained", "flattened", "points", "voronoi"}) {
    const testing::ChangedKernels changed(
        room + "/codes.h", [](const std::string& text) { return text + "INTEGER_CONSTANT(ONE_MORE, 1);\n"; });
    std::size_t changes = 0;
    for (const auto& [file, source] : sources()) {
      if (source == before.at(file)) continue;
      EXPECT_EQ(file.substr(0, file.find('/')), room) << file;
      ++changes;
    }
    EXPECT_GT(changes, 0u) << room;
  }
}

TEST(SmallPrograms, OptionsThatATextDoesNotNameAreLeftOut) {
  EXPECT_EQ(used_options("-cl-std=CL1.2 -DA=1 -DB -DAB=2 -DC", "#if AB > A_B\n_A (C)"),
            "-cl-std=CL1.2 -DAB=2 -DC");
  const std::string sizes = "-DSORT_BITS=4 -DSMALL_REGION=48";
  EXPECT_EQ(used_options(sizes, kernel_source("operations/sort")), "-DSORT_BITS=4");
  EXPECT_EQ(used_options(sizes, kernel_source("flattened/endgame")), "-DSMALL_REGION=48");
}

TEST(KernelPath, WithoutItTheKernelsAreEmbedded) {
  const ScopedEnvironment path("FLAUNAY_KERNEL_PATH", nullptr);
  EXPECT_TRUE(contains(kernel_source("operations/scan"), "scan_reduce_"));
  EXPECT_TRUE(contains(kernel_source("flattened/quickhull"), "define SEGMENTED_ARG_REDUCE"));
}

TEST(SmallAccounts, CountLaunchesAndWaits) {
  Runtime runtime(find_device(""), settings_for(find_device("")));
  const auto a = upload(runtime, std::vector<cl_uchar>(10));
  const auto b = upload(runtime, std::vector<cl_uint>(10));
  runtime.reset_accounts();
  EXPECT_EQ(runtime.accounts().launches, 0u);
  EXPECT_EQ(runtime.accounts().waits, 0u);
  EXPECT_EQ(runtime.accounts().build_seconds, 0.0);
  const double begin = now(), working_begin = runtime.working_clock();
  for (int k = 0; k < 3; ++k) runtime.map(10, kernels::flag_counts{.wanted = 1, .flags = a, .counts = b});
  const double working = runtime.working_clock() - working_begin;
  EXPECT_LE(working + runtime.accounts().build_seconds, now() - begin + 1e-6) << "but for rounding";
  runtime.map(0, kernels::flag_counts{.wanted = 1, .flags = a, .counts = b});  // nothing to launch
  EXPECT_EQ(runtime.accounts().launches, 3u);
  EXPECT_EQ(runtime.accounts().waits, 0u);
  EXPECT_GT(runtime.accounts().build_seconds, 0.0);
  runtime.finish();
  runtime.read_one(b, 1);
  EXPECT_EQ(runtime.accounts().waits, 2u);
  EXPECT_TRUE(runtime.kernel_times().empty());  // profiling is off
  runtime.reset_accounts();
  runtime.map(10, kernels::flag_counts{.wanted = 1, .flags = a, .counts = b});
  EXPECT_EQ(runtime.accounts().launches, 1u);
  EXPECT_EQ(runtime.accounts().build_seconds, 0.0);  // built already
}

TEST(Accounts, ProfilingCountsEachKernel) {
  Runtime runtime(find_device(""), settings_for(find_device("")));
  const auto a = upload(runtime, std::vector<cl_uchar>(10));
  const auto b = upload(runtime, std::vector<cl_uint>(10));
  runtime.set_profiling(true);
  // More than the events that are gathered at a time.
  for (int k = 0; k < 4100; ++k) runtime.launch(1, 1, kernels::add_count{.count = b, .sum = b});
  for (int k = 0; k < 2; ++k) runtime.map(10, kernels::flag_counts{.wanted = 1, .flags = a, .counts = b});
  auto times = runtime.kernel_times();
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times["add_count"].launches, 4100u);
  EXPECT_EQ(times["flag_counts"].launches, 2u);
  EXPECT_GE(times["add_count"].seconds, 0.0);
  runtime.map(10, kernels::flag_counts{.wanted = 1, .flags = a, .counts = b});
  EXPECT_EQ(runtime.kernel_times()["flag_counts"].launches, 3u);  // since the last reset

  runtime.set_profiling(false);
  runtime.map(10, kernels::flag_counts{.wanted = 1, .flags = a, .counts = b});
  EXPECT_EQ(runtime.kernel_times()["flag_counts"].launches, 3u);
  runtime.reset_accounts();
  EXPECT_TRUE(runtime.kernel_times().empty());
}

TEST(Accounts, ProfilingMeasuresTheTimeOfTheDevice) {
  Runtime runtime(find_device(""), settings_for(find_device("")));
  const std::size_t n = 1000000;
  const auto a = upload(runtime, std::vector<cl_uchar>(n));
  const auto b = guarded<cl_uint>(runtime, n);
  runtime.map(n, kernels::flag_counts{.wanted = 1, .flags = a, .counts = b});  // compiled on first use
  runtime.set_profiling(true);
  runtime.reset_accounts();
  for (int k = 0; k < 10; ++k) runtime.map(n, kernels::flag_counts{.wanted = 1, .flags = a, .counts = b});
  const double seconds = runtime.kernel_times()["flag_counts"].seconds;
  EXPECT_GT(seconds, 1e-6);
  EXPECT_LT(seconds, 10.0);
}

}  // namespace
}  // namespace flaunay::host
