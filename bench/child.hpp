// Work in a process of its own, for what must be ended when it takes too long, whose memory is to be told
// from all else, or whose driver is to read another environment.
#pragma once

#include <functional>
#include <string>

namespace flaunay::bench {

/// What became of a child process.
struct Answer {
  std::string text;     ///< what its work returned
  std::string failure;  ///< empty if it went well
};

/// Runs work in a copy of this process, which is ended after `limit` seconds (0: never). To be called before
/// there is a device: a child process has none of the threads of its parent's driver.
Answer ask_child(const std::function<std::string()>& work, double limit = 0);

}  // namespace flaunay::bench
