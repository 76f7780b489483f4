// What tests that run kernels share: arrays to and from the device with guards, and folders that are removed.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/opencl/device.hpp"
#include "host/runtime.hpp"
#include "tests/support/environment.hpp"

namespace flaunay::testing {

/// A fresh folder, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const std::string name = "flaunay-test-" + std::to_string(std::random_device()());
    path_ = (std::filesystem::temp_directory_path() / name).string();
    if (!std::filesystem::create_directory(path_)) throw std::runtime_error(path_ + " is there");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  void write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = std::filesystem::path(path_) / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
  }

 private:
  std::string path_;
};

/// Elements behind each array that no kernel may write.
constexpr std::size_t kGuard = 16;
constexpr unsigned char kGuardByte = 0xa5;

/// A buffer of `count` elements and guards, all of guard bytes: what a kernel leaves unwritten shows.
template <typename T>
host::Buffer<T> guarded(host::Runtime& runtime, std::size_t count) {
  const auto buffer = runtime.arena().allocate<T>(count + kGuard);
  host::Buffer<cl_uchar> bytes(std::shared_ptr<_cl_mem>(buffer.memory(), [buffer](cl_mem) {}), buffer.size());
  runtime.fill(bytes, (count + kGuard) * sizeof(T), cl_uchar{kGuardByte});
  return buffer;
}

template <typename T>
host::Buffer<T> upload(host::Runtime& runtime, const std::vector<T>& values) {
  const auto buffer = guarded<T>(runtime, values.size());
  runtime.write(buffer, 0, values.size(), values.data());
  return buffer;
}

/// The first `count` elements of a buffer made by guarded or upload for just so many.
template <typename T>
std::vector<T> download(host::Runtime& runtime, const host::Buffer<T>& buffer, std::size_t count) {
  std::vector<T> values(count + kGuard);
  EXPECT_EQ(buffer.size(), values.size());
  runtime.read(buffer, 0, values.size(), values.data());
  unsigned char expected[kGuard * sizeof(T)];
  std::memset(expected, kGuardByte, sizeof expected);
  EXPECT_EQ(std::memcmp(&values[count], expected, sizeof expected), 0) << "written beyond the end";
  values.resize(count);
  return values;
}

}  // namespace flaunay::testing
