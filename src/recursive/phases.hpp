// The phases of one call: their times, and what the caller hears of them.
#pragma once

#include <chrono>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::recursive {

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

}  // namespace flaunay::recursive
