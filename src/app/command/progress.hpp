// The progress line on the terminal, and a stopwatch.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace flaunay::cli {

/// Rewrites one line of standard error until it is destroyed, then clears it. Shows nothing if standard error
/// is not a terminal, if it is not wanted, or in the first half second. A separate thread draws the line, so
/// that stages that report nothing (reading, compiling) are shown, too.
class Progress {
 public:
  explicit Progress(bool wanted);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// level: -1 if the stage has none; done: the finished share from 0 to 1, or -1 if it is unknown. If it
  /// grows for some seconds, the line says about how long the rest takes.
  void update(const std::string& stage, int level = -1, double done = -1);
  /// update as a function, for the options of calls.
  std::function<void(const std::string& stage, int level, double done)> callback() {
    return [this](const std::string& stage, int level, double done) { update(stage, level, done); };
  }
  /// For a stage that needs an explanation only if it takes longer: `if_slow` is shown after half a second.
  void update_slow(const std::string& stage, const std::string& if_slow);
  /// Clears the line and stops drawing. The destructor does this too.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void draw_until_finished();
  std::string line() const;

  std::mutex mutex_;
  std::condition_variable finish_asked_;
  bool finished_ = false;
  std::string stage_;
  std::string stage_if_slow_;  // may be empty
  Clock::time_point stage_start_;
  int level_ = -1;
  double done_ = -1;
  double first_done_ = -1;  // since when it has grown
  Clock::time_point first_time_;
  std::thread drawer_;
};

/// Seconds since it was made or last restarted.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  double restart() {
    const double elapsed = seconds();
    start_ = Clock::now();
    return elapsed;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace flaunay::cli
