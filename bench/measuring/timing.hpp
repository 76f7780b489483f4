// Runs that take turns, and what is said about their times.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "bench/measuring/command.hpp"

namespace flaunay::bench {

/// Seconds since it was made.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

template <typename Work>
double seconds_of(const Work& work) {
  const Stopwatch watch;
  work();
  return watch.seconds();
}

/// Tells standard error what is running, and how far all of it is: on a terminal one line that is rewritten,
/// elsewhere a line every ten seconds.
class Progress {
 public:
  explicit Progress(std::size_t steps);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// The next of the steps begins.
  void step(const std::string& what);
  /// Steps that will not come after all.
  void drop(std::size_t steps) { steps_ -= steps; }
  /// A message that stays.
  void say(const std::string& message);

 private:
  void clear();

  std::size_t steps_, begun_ = 0;
  bool terminal_;
  Stopwatch all_;
  double shown_at_ = 0;
};

struct Summary {
  double median = 0, low = 0, high = 0;
};

/// Of at least one value; the median of an even number is the mean of the middle two.
Summary summary(std::vector<double> values);

/// Something to run again and again.
struct Job {
  Json row;                     ///< of the record; its values are the job's title
  std::function<double()> run;  ///< runs once and returns the seconds that count
  /// Jobs of a series differ in size only and stand in ascending order.
  std::string series = {};
  std::vector<double> seconds = {};            ///< of the counted runs
  std::vector<double> processor_seconds = {};  ///< the same runs, of all threads of the process
  std::string skipped = {};                    ///< why it has none; else empty

  std::string title() const;
  double median() const { return summary(seconds).median; }
  double processor_median() const { return summary(processor_seconds).median; }
};

/// Runs all jobs in turn, once without counting and then `runs` times, so that a machine's changing speed
/// affects all alike. Whatever takes less than 0.05 s is repeated within a run, which then gives the mean. A
/// job that throws Error is skipped, with its message; so are the jobs of a series after one whose uncounted
/// run took longer than the limit in seconds (0: no limit).
void run_interleaved(const std::vector<Job*>& jobs, int runs, double limit = 0);

template <typename Jobs>
std::vector<Job*> pointers_to(Jobs& jobs) {
  std::vector<Job*> pointers;
  for (auto& job : jobs) pointers.push_back(&job);
  return pointers;
}

/// Runs all jobs in turn, and gives their rows the times. Throws Error if a job is skipped, because nothing
/// can be set beside it.
void measure_rows(std::vector<Job>& jobs, int runs, bool of_processor = false);

/// The rows of jobs, in their order.
Json rows_of(const std::vector<Job>& jobs);

}  // namespace flaunay::bench
