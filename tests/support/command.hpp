// Runs the command as its users do: the built executable, with files in a folder of each test's own.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "tests/support/paths.hpp"

extern char** environ;

namespace flaunay::command {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;
using Environment = std::map<std::string, std::string>;

constexpr int kSuccess = 0, kFailure = 1, kUsage = 2, kBadInput = 3, kDevice = 4;

// What needs no device must not open one: these runs find no OpenCL platform at all. Sanitized builds look
// for leaks here; with a device they would find those of the OpenCL implementation.
inline const Environment kNoPlatform = {{"OCL_ICD_VENDORS", "/nonexistent"},
                                        {"ASAN_OPTIONS", "detect_leaks=1"}};

struct Outcome {
  int exit_code = -1;
  int signal = 0;  ///< that ended it
  std::string out;
  std::string err;
};

inline std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void write_file(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(text.find(part), std::string::npos) << "no \"" << part << "\" in: " << text;
  }
}

/// The environment of a child: this one's, with changes.
class ChildEnvironment {
 public:
  explicit ChildEnvironment(const Environment& changes) {
    Environment all = {{"ASAN_OPTIONS", "detect_leaks=0"}};
    for (char** variable = environ; *variable != nullptr; ++variable) {
      const std::string text = *variable;
      all.emplace(text.substr(0, text.find('=')), text.substr(text.find('=') + 1));
    }
    for (const auto& [name, value] : changes) all[name] = value;
    for (const auto& [name, value] : all) variables_.push_back(name + "=" + value);
    for (std::string& variable : variables_) pointers_.push_back(variable.data());
    pointers_.push_back(nullptr);
  }
  char** get() { return pointers_.data(); }

 private:
  std::vector<std::string> variables_;
  std::vector<char*> pointers_;
};

/// Starts a program, with the signals as they are for one that a user starts.
inline pid_t spawn_program(Arguments words, const Environment& changes, posix_spawn_file_actions_t* actions) {
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t signals;
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ChildEnvironment environment(changes);
  pid_t child = -1;
  EXPECT_EQ(posix_spawn(&child, pointers.front(), actions, &attributes, pointers.data(), environment.get()),
            0);
  posix_spawnattr_destroy(&attributes);
  return child;
}

inline pid_t spawn(const Arguments& arguments, const Environment& changes,
                   posix_spawn_file_actions_t* actions) {
  Arguments words = {flaunay::flaunay_executable()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return spawn_program(words, changes, actions);
}

inline int exit_code_of(pid_t child) {
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class CommandTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "flaunay-cli-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
    fs::create_directory(directory_ / "streams");
    fs::create_directory(directory_ / "files");
  }

  void TearDown() override { fs::remove_all(directory_); }

  /// A path for the test's own files.
  std::string path(const std::string& name) const { return (directory_ / "files" / name).string(); }

  std::string write(const std::string& name, const std::string& bytes) const {
    write_file(path(name), bytes);
    return path(name);
  }

  /// The names of the test's files, sorted.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(directory_ / "files")) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  Outcome run(const Arguments& arguments, const Environment& environment = {}, const std::string& input = "",
              const std::string& out_path = "") const {
    Arguments words = {flaunay::flaunay_executable()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return run_program(words, environment, input, out_path);
  }

  /// Runs a script of the shell in the folder of the test's files; $FLAUNAY is the command.
  Outcome run_script(const std::string& script, Environment environment = kNoPlatform) const {
    environment["FLAUNAY"] = flaunay::flaunay_executable();
    environment["FILES"] = path("");
    return run_program({"/bin/sh", "-c", "cd \"$FILES\" && " + script}, environment, "", "");
  }

  Outcome run_program(const Arguments& words, const Environment& environment, const std::string& input,
                      const std::string& out_path) const {
    const std::string in = (directory_ / "streams/in").string();
    const std::string out = out_path.empty() ? (directory_ / "streams/out").string() : out_path;
    const std::string err = (directory_ / "streams/err").string();
    write_file(in, input);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, in.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
    const pid_t child = spawn_program(words, environment, &actions);
    posix_spawn_file_actions_destroy(&actions);
    Outcome outcome;
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
    if (out_path.empty()) outcome.out = contents(out);
    outcome.err = contents(err);
    return outcome;
  }

  /// Runs and expects success without a word on standard error, which is no terminal.
  Outcome run_well(const Arguments& arguments, const Environment& environment = {},
                   const std::string& input = "") const {
    Outcome outcome = run(arguments, environment, input);
    EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return outcome;
  }

  /// Runs and expects one message on standard error that holds all the parts, and no new files.
  void expect_error(int exit_code, const std::vector<std::string>& parts, const Arguments& arguments,
                    const Environment& environment = kNoPlatform, const std::string& input = "") const {
    std::string command = "flaunay";
    for (const std::string& argument : arguments) command += " " + argument;
    SCOPED_TRACE(command);
    const std::vector<std::string> before = files();
    const Outcome outcome = run(arguments, environment, input);
    EXPECT_EQ(outcome.exit_code, exit_code);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.rfind("flaunay: ", 0), 0u) << outcome.err;
    EXPECT_EQ(outcome.err.find("flaunay: ", 1), std::string::npos)
        << "more than one message: " << outcome.err;
    EXPECT_EQ(outcome.err.find("internal"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find('\n') + 1, outcome.err.size()) << "not one line: " << outcome.err;
    expect_parts(outcome.err, parts);
    EXPECT_EQ(files(), before);
  }

  fs::path directory_;
};

inline std::string data(const std::string& name) { return flaunay::test_data() + "/" + name; }

}  // namespace flaunay::command
