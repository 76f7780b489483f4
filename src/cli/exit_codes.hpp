// The exit codes of `flaunay` and `flaunay-bench`.
#pragma once

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

}  // namespace flaunay::cli
