// The phases of one call: their times, and the calls of Options::progress.
#pragma once

#include <chrono>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::statistics {

// In the modes that run on the host: the share of the time that is over when a phase ends, for progress.
constexpr double kSorted = 0.2;
constexpr double kTriangulated = 0.8;

class Phases {
 public:
  explicit Phases(const Options& options) : options_(options) {}

  void progress(const char* stage, double done) const {
    if (options_.progress) options_.progress(stage, -1, done);
  }
  void end(const char* name) {
    const Clock::time_point now = Clock::now();
    phases_.push_back({name, std::chrono::duration<double>(now - last_).count()});
    last_ = now;
  }
  void write(Statistics& statistics) const {
    statistics.seconds = std::chrono::duration<double>(last_ - begin_).count();
    statistics.phases = phases_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  const Options& options_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
  std::vector<PhaseStatistics> phases_;
};

}  // namespace flaunay::statistics
