// The accounts of a runtime since they were last reset: counts, times, and with a log every launch.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "host/launch/launch_log.hpp"

namespace flaunay::host {

/// The launches of one kernel and their time, if profiling is on.
struct KernelTime {
  std::size_t launches = 0;
  double seconds = 0;
};

struct Accounts {
  std::size_t launches = 0;
  std::size_t waits = 0;  ///< times the host waits for the device
  std::size_t bytes_to_device = 0;
  std::size_t bytes_to_host = 0;
  double build_seconds = 0;      ///< of compiling programs, since the last reset
  double all_build_seconds = 0;  ///< of compiling programs, never reset
  std::map<std::string, KernelTime> times;
  std::unique_ptr<LaunchLog> log;  ///< null unless launches are recorded

  /// Properties of the next launch, for its record.
  struct Next {
    std::size_t elements = 1;  ///< how many each work-item goes through, at most
    std::size_t spread = 1;    ///< one of this many consecutive work-items has work
    /// How many work-items have work, if the launch spreads these over more.
    std::size_t busy = std::numeric_limits<std::size_t>::max();
  };
  Next next{};

  void add_launch(const char* kernel, std::size_t work_items, std::size_t group) {
    ++launches;
    const Next noted = std::exchange(next, {});
    if (log == nullptr) return;
    log->add({kernel, std::min(work_items, noted.busy), group, (group + noted.spread - 1) / noted.spread,
              noted.elements});
  }
  /// what: "fill" or "copy".
  void add_transfer(const char* what, std::size_t bytes) {
    ++launches;
    if (log != nullptr) log->add({what, 0, 0, 0, 0, bytes});
  }
  /// launch: its position in the log, if there is one.
  void add_time(const std::string& kernel, std::size_t launch, double seconds) {
    KernelTime& time = times[kernel];
    ++time.launches;
    time.seconds += seconds;
    if (log != nullptr) log->set_seconds(launch, seconds);
  }
  std::size_t last_launch() const { return log != nullptr ? log->last() : 0; }
  void reset() {
    launches = waits = bytes_to_device = bytes_to_host = 0;
    build_seconds = 0;
    times.clear();
    if (log != nullptr) log->clear();
  }
};

}  // namespace flaunay::host
