#include "bench/measuring/jobs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "flaunay/flaunay.hpp"

namespace flaunay::bench {
double processor_seconds() {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage;
    getrusage(who, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime}) {
      sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
  }
  return sum;
}

namespace {

/// Runs it until the clock and a cold cache do not matter; means of one run.
void run_once(Job& job) {
  constexpr double kEnoughSeconds = 0.05;
  double seconds = 0, of_processor = 0;
  int times = 0;
  const Stopwatch watch;
  for (; times == 0 || watch.seconds() < kEnoughSeconds; ++times) {
    const double before = processor_seconds();
    const Outcome outcome = job.run();
    seconds += outcome.seconds;
    of_processor += outcome.processor_seconds.value_or(processor_seconds() - before);
    job.details.update(outcome.details);
  }
  job.seconds.push_back(seconds / times);
  job.processor_seconds.push_back(of_processor / times);
}

/// Whether the job has as many triangles as the one beside it.
bool agrees(const Job& job, const Job& other) {
  const Json &own = job.details.at("triangles"), &expected = other.details.at("triangles");
  if (own == expected) return true;
  fmt::print(stderr, "WARNING: {} has {} triangles, {} has {}\n", job.title(), own.dump(), other.title(),
             expected.dump());
  return false;
}

Json measured_row(const Job& job) {
  Json row = job.row;
  add_seconds(row, job.seconds);
  row["processor_seconds_median"] = summary(job.processor_seconds).median;
  if (row.contains("n")) row["nanoseconds_per_point"] = 1e9 * job.median() / row["n"].get<double>();
  row.update(job.details);
  if (!job.question.empty()) row["agrees"] = job.agrees;
  return row;
}

}  // namespace

void Progress::step(const std::string& what) {
  constexpr double kSecondsBetweenLines = 10;
  ++begun_;
  if (since_line_.seconds() < kSecondsBetweenLines) return;
  fmt::print(stderr, "{} of {}: {}\n", begun_, steps_, what);
  since_line_ = {};
}

std::string Job::title() const {
  std::vector<std::string> values;
  for (const Json& value : row) values.push_back(value.is_string() ? value.get<std::string>() : value.dump());
  return fmt::format("{}", fmt::join(values, ", "));
}

void measure(Jobs& jobs, int runs, std::optional<double> limit) {
  Progress progress(jobs.size() * static_cast<std::size_t>(runs + 1));
  std::map<std::string, std::string> ended;  // why, by series
  for (int run = 0; run <= runs; ++run) {
    for (Job& job : jobs) {
      progress.step(run == 0 ? "first run, not counted: " + job.title()
                             : fmt::format("run {} of {}: {}", run, runs, job.title()));
      if (run == 0 && job.skipped.empty() && ended.count(job.series) > 0) job.skipped = ended[job.series];
      if (!job.skipped.empty()) continue;
      try {
        run_once(job);
      } catch (const Error& error) {
        if (!limit) throw;
        job.skipped = error.what();
      }
      if (run > 0 || job.seconds.empty()) continue;
      const double seconds = job.seconds.front();
      if (limit.value_or(0) > 0 && seconds > *limit) {
        ended[job.series] = fmt::format("{} took {:.3g} s, more than {:g} s", job.title(), seconds, *limit);
      }
      job.seconds.clear();
      job.processor_seconds.clear();
    }
  }
  for (const Job& job : jobs) {
    if (!job.skipped.empty()) fmt::print(stderr, "not measured: {}: {}\n", job.title(), job.skipped);
  }
}

const Job* find_job(const Jobs& jobs, const Json& keys) {
  const auto found = std::find_if(jobs.begin(), jobs.end(), [&](const Job& job) {
    const auto items = keys.items();
    return job.valid() && std::all_of(items.begin(), items.end(), [&](const auto& item) {
             return job.row.contains(item.key()) && job.row[item.key()] == item.value();
           });
  });
  return found == jobs.end() ? nullptr : &*found;
}

std::optional<double> median_of(const Jobs& jobs, const Json& keys) {
  const Job* const job = find_job(jobs, keys);
  return job == nullptr ? std::optional<double>() : job->median();
}

Json changed(Json row, const Json& keys) {
  row.update(keys);
  return row;
}

void add_rows(Result& result, Jobs& jobs) {
  std::map<std::string, const Job*> expected;
  bool any = false;
  for (const Job& job : jobs) {
    if (!job.valid()) continue;
    any = true;
    const Job*& chosen = expected.emplace(job.question, &job).first->second;
    if (job.row.value("implementation", "") == "cgal") chosen = &job;
  }
  result.agree &= any || jobs.empty();
  for (const char* table : {"results", "skipped"}) result.tables.emplace(table, Json::array());
  for (Job& job : jobs) {
    if (!job.skipped.empty()) {
      result.tables["skipped"].push_back(changed(job.row, {{"reason", job.skipped}}));
      continue;
    }
    if (!job.question.empty()) job.agrees = agrees(job, *expected.at(job.question));
    result.agree &= job.agrees;
    result.tables["results"].push_back(measured_row(job));
  }
}

Summary summary(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
  return {median, values.front(), values.back()};
}

}  // namespace flaunay::bench
