// How `flaunay` and `flaunay-bench` report errors: exit codes, and messages on standard error.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "files/file.hpp"
#include "files/printable.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::cli {

enum ExitCode : int { kSuccess = 0, kFailure = 1, kUsage = 2, kBadInput = 3, kDevice = 4 };

inline ExitCode exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return kUsage;
    case ErrorKind::input:
      return kBadInput;
    case ErrorKind::device:
      return kDevice;
    case ErrorKind::internal:
      break;
  }
  return kFailure;
}

[[noreturn]] inline void fail_usage(const std::string& message) {
  throw Error(ErrorKind::usage, io::printable(message));
}

/// Writes the message on one line, and returns the code. The message of a device keeps its lines, because it
/// may contain what a compiler says.
inline int report_error(const char* program, int code, std::string_view message) {
  std::string text = std::string(program) + ": ";
  while (code == kDevice && message.find('\n') != message.npos) {
    const std::size_t end = message.find('\n');
    text += io::printable(message.substr(0, end)) + "\n";
    message.remove_prefix(end + 1);
  }
  text += io::printable(message) + "\n";
  std::fwrite(text.data(), 1, text.size(), stderr);
  return code;
}

/// The word that messages of an Error about an element begin with, such as "point", and the file with these
/// elements.
struct ElementFile {
  std::string element;
  std::string path;
};

/// Calls function. An Error whose message begins with an element gets the name of its file, since the library
/// does not know where elements come from.
template <typename Function>
auto naming_files(const std::vector<ElementFile>& files, const Function& function) {
  try {
    return function();
  } catch (const Error& error) {
    const std::string message = error.what();
    for (const ElementFile& file : files) {
      if (message.starts_with(file.element)) {
        throw Error(error.kind(), io::printable(io::shown_path(file.path) + ": " + message));
      }
    }
    throw;
  }
}

}  // namespace flaunay::cli
