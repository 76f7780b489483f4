#include "bench/measuring/timing.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>

#include "flaunay/flaunay.hpp"

namespace flaunay::bench {
namespace {

constexpr double kSecondsBetweenLines = 10;

/// Means of one run.
struct Spent {
  double seconds = 0, processor_seconds = 0;
};

/// Runs it again until the clock and a cold cache do not matter.
Spent repeat(const Job& job) {
  constexpr double kEnoughSeconds = 0.05;
  double seconds = 0;
  int times = 0;
  const std::clock_t begin = std::clock();
  for (; seconds < kEnoughSeconds; ++times) seconds += job.run();
  return {seconds / times, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / times};
}

/// The uncounted run of each job. Afterwards the jobs that will not be counted are marked as skipped.
void warm_up(const std::vector<Job*>& jobs, std::size_t runs, double limit, Progress& progress) {
  std::map<std::string, std::string> ended;  // why, by series
  for (Job* const job : jobs) {
    if (const auto found = ended.find(job->series); found != ended.end()) {
      job->skipped = found->second;
      progress.drop(1 + runs);
      continue;
    }
    progress.step(fmt::format("first run, not counted: {}", job->title()));
    try {
      const double seconds = repeat(*job).seconds;
      if (limit > 0 && seconds > limit) {
        ended[job->series] = fmt::format("{} took {:.3g} s, more than {:g} s", job->title(), seconds, limit);
      }
    } catch (const Error& error) {
      job->skipped = error.what();
      progress.drop(runs);
    }
  }
}

}  // namespace

Progress::Progress(std::size_t steps) : steps_(steps), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
  if (terminal_) fmt::print(stderr, "\r\033[K");
}

void Progress::step(const std::string& what) {
  ++begun_;
  const std::string line = fmt::format("{} of {}: {}", begun_, steps_, what);
  if (terminal_) {
    fmt::print(stderr, "\r\033[K{}", line);
    std::fflush(stderr);
  } else if (all_.seconds() - shown_at_ > kSecondsBetweenLines) {
    shown_at_ = all_.seconds();
    fmt::print(stderr, "{}\n", line);
  }
}

void Progress::say(const std::string& message) {
  clear();
  fmt::print(stderr, "{}\n", message);
}

void run_interleaved(const std::vector<Job*>& jobs, int runs, double limit) {
  const auto rounds = static_cast<std::size_t>(runs);
  Progress progress(jobs.size() * (1 + rounds));
  warm_up(jobs, rounds, limit, progress);
  for (const Job* const job : jobs) {
    if (!job->skipped.empty()) progress.say(fmt::format("not measured: {}: {}", job->title(), job->skipped));
  }
  for (int run = 1; run <= runs; ++run) {
    for (Job* const job : jobs) {
      if (!job->skipped.empty()) continue;
      progress.step(fmt::format("run {} of {}: {}", run, runs, job->title()));
      const Spent spent = repeat(*job);
      job->seconds.push_back(spent.seconds);
      job->processor_seconds.push_back(spent.processor_seconds);
    }
  }
}

std::string Job::title() const {
  std::vector<std::string> values;
  for (const Json& value : row) values.push_back(value.is_string() ? value.get<std::string>() : value.dump());
  return fmt::format("{}", fmt::join(values, ", "));
}

void measure_rows(std::vector<Job>& jobs, int runs, bool of_processor) {
  run_interleaved(pointers_to(jobs), runs);
  for (Job& job : jobs) {
    if (!job.skipped.empty()) throw Error(ErrorKind::internal, job.title() + ": " + job.skipped);
    add_seconds(job.row, job.seconds);
    if (of_processor) job.row["processor_seconds_median"] = job.processor_median();
  }
}

Json rows_of(const std::vector<Job>& jobs) {
  Json rows = Json::array();
  for (const Job& job : jobs) rows.push_back(job.row);
  return rows;
}

Summary summary(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
  return {median, values.front(), values.back()};
}

}  // namespace flaunay::bench
