// Files of a test's own.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::io {

/// A fresh folder for each test, removed after it.
class FolderTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = "flaunay-io-" + std::to_string(std::random_device()());
    folder_ = (std::filesystem::temp_directory_path() / name).string();
    ASSERT_TRUE(std::filesystem::create_directory(folder_));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  static std::string read(const std::string& file) {
    std::ostringstream bytes;
    bytes << std::ifstream(file, std::ios::binary).rdbuf();
    return bytes.str();
  }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      all.insert(entry.path().filename().string());
    return all;
  }

  static void expect_error(ErrorKind kind, const std::string& start, const std::vector<std::string>& parts,
                           const std::function<void()>& action) {
    try {
      action();
      ADD_FAILURE() << "no error; expected one about " << start;
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_EQ(error.kind(), kind) << message;
      EXPECT_EQ(message.compare(0, start.size(), start), 0) << message << "\ndoes not begin with " << start;
      for (const std::string& part : parts) {
        EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks " << part;
      }
    }
  }

  std::string folder_;
};

template <typename Value>
std::string raw(const std::vector<Value>& values) {
  std::string bytes(values.size() * sizeof(Value), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

}  // namespace flaunay::io
