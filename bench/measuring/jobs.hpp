// Jobs that take turns, and the rows that are made of their times.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/measuring/inputs.hpp"
#include "bench/measuring/result.hpp"
#include "flaunay/research.hpp"

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

/// The processor time of all threads of this process, and of its children that have ended.
double processor_seconds();

/// Reports the running job and the overall progress to standard error every ten seconds.
class Progress {
 public:
  explicit Progress(std::size_t steps) : steps_(steps) {}
  /// The next of the steps begins.
  void step(const std::string& what);

 private:
  std::size_t steps_, begun_ = 0;
  Stopwatch since_line_;
};

struct Summary {
  double median = 0, low = 0, high = 0;
};

/// Summarises at least one value. The median of an even number of values is the mean of the middle two.
Summary summary(std::vector<double> values);

/// The result of one run.
struct Outcome {
  Outcome(double of_run = 0, Json more = Json::object()) : seconds(of_run), details(std::move(more)) {}
  Outcome(double of_run, std::size_t triangles) : Outcome(of_run, {{"triangles", triangles}}) {}
  double seconds;
  Json details;  ///< more keys for the job's row
  /// If different from the processor time of the whole run.
  std::optional<double> processor_seconds = {};
};

/// Something to run again and again.
struct Job {
  Json row;                      ///< says what it is; its values are the job's title
  std::function<Outcome()> run;  ///< runs once
  /// Jobs of a series differ in size only and stand in ascending order.
  std::string series = {};
  /// Jobs for which this is equal, and not empty, must have as many triangles.
  std::string question = {};
  const Input* input = nullptr;                   ///< the points, if it triangulates some
  std::optional<research::Options> options = {};  ///< of flaunay's modes
  Json details = Json::object();                  ///< of the last run; earlier entries are kept
  std::vector<double> seconds = {};               ///< of the counted runs
  std::vector<double> processor_seconds = {};     ///< in the same runs
  std::string skipped = {};                       ///< why it has no times; else empty
  bool agrees = true;                             ///< whether it has as many triangles as it should

  std::string title() const;
  /// Measured with a right result: time for a wrong one says nothing.
  bool valid() const { return skipped.empty() && agrees && !seconds.empty(); }
  double median() const { return summary(seconds).median; }
};
using Jobs = std::vector<Job>;

/// Runs all jobs in turn, once without counting and then `runs` times, so that a machine's changing speed
/// affects all alike. Whatever takes less than 0.05 s is repeated within a run, which then gives the mean.
/// Jobs of a series after one whose uncounted run took longer than the limit in seconds (0: no limit) are
/// skipped. With a limit, so are jobs that throw Error; without one, nothing catches it.
void measure(Jobs& jobs, int runs, std::optional<double> limit = {});

/// The first of the valid jobs that have these values in their rows; null if no job has them.
const Job* find_job(const Jobs& jobs, const Json& keys);
std::optional<double> median_of(const Jobs& jobs, const Json& keys);

/// A job's row with some values replaced.
Json changed(Json row, const Json& keys);

/// Adds a row for each job to the tables "results" and "skipped". Jobs that have not as many triangles as
/// CGAL's with the same question, or as the first, are marked and told loudly; then, and if nothing was
/// measured, the result does not agree.
void add_rows(Result& result, Jobs& jobs);

}  // namespace flaunay::bench
