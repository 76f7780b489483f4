// The phases of one call: their times, and the calls of Options::progress.
#pragma once

#include <chrono>
#include <functional>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::statistics {

// In the modes that run on the host: the share of the time that is over when a phase ends, for progress.
constexpr double kSorted = 0.2;
constexpr double kTriangulated = 0.8;

class Phases {
 public:
  /// Seconds on a clock that may stand still during work that belongs to no phase.
  using Clock = std::function<double()>;

  explicit Phases(const Options& options, Clock clock = wall_clock)
      : options_(options), clock_(std::move(clock)) {}

  /// Whether the caller wants progress.
  bool are_heard() const { return options_.progress != nullptr; }
  void progress(const char* stage, double done) const {
    if (!are_heard()) return;
    done_ = done;
    options_.progress(stage, -1, done);
  }
  /// Says that something else has to be done first.
  void interrupt(const char* stage) const { progress(stage, done_); }
  void end(const char* name) {
    const double now = clock_();
    phases_.push_back({name, now - last_});
    last_ = now;
  }
  void write(Statistics& statistics) const {
    statistics.seconds = last_ - begin_;
    statistics.phases = phases_;
  }

 private:
  static double wall_clock() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  const Options& options_;
  const Clock clock_;
  const double begin_ = clock_();
  double last_ = begin_;
  mutable double done_ = 0;  // as last reported
  std::vector<PhaseStatistics> phases_;
};

}  // namespace flaunay::statistics
