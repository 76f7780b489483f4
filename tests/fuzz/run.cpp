#include "tests/fuzz/run.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>

#include "flaunay/flaunay.hpp"

namespace flaunay::fuzz {
namespace {

constexpr unsigned kLongestCheck = 120;  // seconds

char case_text[80];

/// Names the case if the library ends the process or does not return.
void report_signal(int number) {
  const char* const what = number == SIGALRM ? "\nfuzzing: does not end: " : "\nfuzzing: ends the process: ";
  for (const char* text : {what, static_cast<const char*>(case_text), "\n"}) {
    if (::write(STDERR_FILENO, text, std::char_traits<char>::length(text)) < 0) break;
  }
  ::signal(number, SIG_DFL);
  ::raise(number);
}

struct Request {
  double seconds = 60;
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
};

int run(const Request& request, const std::string& program, Fuzzer& fuzzer) {
  // Not earlier, since PoCL installs handlers of its own; its handler for SIGFPE is needed by kernels.
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGILL, SIGALRM, SIGTERM})
    ::signal(number, report_signal);
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                                   std::chrono::duration<double>(request.seconds));
  std::uint64_t number = request.first;
  do {
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;  // tells the seeds of neighbouring cases apart
    testing::FixtureRandom random(request.seed + kOdd * (number + 1));
    fmt::format_to_n(case_text, sizeof case_text - 1, "{} --seed {} --first {}", program, request.seed,
                     number);
    start_check();
    if (!fuzzer.run(random)) return 1;
    ++number;
  } while (Clock::now() < end);
  ::alarm(0);
  fmt::print("{} cases with {} (seed {})\n", number - request.first, fuzzer.summary(), request.seed);
  return 0;
}

}  // namespace

const char* case_name() { return case_text; }

void start_check() { ::alarm(kLongestCheck); }

int run_fuzzer(int argc, char** argv, const std::string& program, const std::string& description,
               const std::function<std::unique_ptr<Fuzzer>()>& make) {
  CLI::App app(description);
  Request request;
  app.add_option("--seconds", request.seconds, "How long; at least one case is run")->capture_default_str();
  app.add_option("--seed", request.seed, "Decides, with the number of a case, its points")
      ->capture_default_str();
  app.add_option("--first", request.first, "The number of the first case")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return run(request, program, *make());
  } catch (const Error& error) {
    fmt::print(stderr, "{}: {}\n", program, error.what());
    return 4;
  }
}

}  // namespace flaunay::fuzz
