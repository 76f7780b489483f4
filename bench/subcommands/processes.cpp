// flaunay-bench processes and ranks: the programs as whole processes, from file to files.
#include "bench/measuring/processes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "bench/measuring/command.hpp"

namespace flaunay::bench::processes {
namespace {

using Words = std::vector<std::string>;

/// To triangles and neighbours.
Words triangulate(const std::string& program, const std::string& points, const Folder& folder) {
  return {program,       "triangulate",       points, "--triangles", folder.file("t.npy"),
          "--neighbors", folder.file("n.npy")};
}

/// Runs a program that writes statistics into the folder.
Json statistics_of(Words words, const Folder& folder, Outcome& outcome) {
  append(words, {"--stats", folder.file("s.json")});
  outcome = run_program(words);
  Json statistics;
  std::ifstream(folder.file("s.json")) >> statistics;
  return statistics;
}

/// The share of a round's points that are handed on.
double handed_on_percent(const Json& round, double points) {
  return 100 * round.at("handed_on").get<double>() / points;
}

// ---- processes

// Before an option: with no kernels that were compiled before.
constexpr std::string_view kCold = "cold:";

struct ProcessesRequest : Request {
  Words choices{"default", "device=host", "device=#0", "cold:device=#0", "mode=dwyer"};
  std::string folder;
};

/// The words of the command for an option such as mode=dwyer.
Words words_of(const std::string& option, const Folder& folder) {
  if (option == "default") return {};
  const std::size_t equals = std::min(option.find('='), option.size());
  Words words{"--" + option.substr(0, equals)};
  if (equals < option.size()) words.push_back(option.substr(equals + 1));
  if (words.front() == "--memory") append(words, {"--scratch", folder.file("")});
  return words;
}

Outcome run_process(Words words, bool is_cold, const Folder& folder) {
  const Folder empty;
  if (is_cold) {
    // flaunay's and PoCL's.
    const Words cold = {"env", "FLAUNAY_CACHE_DIR=" + empty.file("a"), "POCL_CACHE_DIR=" + empty.file("b")};
    for (const char* name : {"a", "b"}) std::filesystem::create_directory(empty.file(name));
    words.insert(words.begin(), cold.begin(), cold.end());
  }
  Outcome outcome;
  const Json statistics = statistics_of(words, folder, outcome);
  const auto chunks = statistics.find("chunks");
  if (chunks == statistics.end()) return outcome;
  const Json &rounds = chunks->at("rounds"), &first = rounds.front();
  outcome.details["chunks"] = chunks->at("number");
  outcome.details["rounds"] = rounds.size();
  outcome.details["handed_on_percent"] = handed_on_percent(first, first.at("points").get<double>());
  return outcome;
}

Result measure_processes(const ProcessesRequest& request) {
  Result result;
  for (const std::string& distribution : request.distributions) {
    for (const std::size_t n : request.sizes) {
      const Folder folder(request.folder);
      Jobs jobs;
      for (const std::string& choice : request.choices) {
        const bool is_cold = choice.compare(0, kCold.size(), kCold) == 0;
        const std::string option = is_cold ? choice.substr(kCold.size()) : choice;
        Words words =
            triangulate(program_or(request.program, "flaunay"), folder.write(distribution, n), folder);
        append(words, words_of(option, folder));
        jobs.push_back({{{"option", choice}, {"distribution", distribution}, {"n", n}},
                        [words, is_cold, &folder] { return run_process(words, is_cold, folder); }});
      }
      measure(jobs, request.runs, 0);
      add_rows(result, jobs);
    }
  }
  result.agree &= result.tables["skipped"].empty();
  result.device = Triangulator(request.device).device();
  return result;
}

const Subcommand kProcesses(
    "processes", "the command as whole processes, from file to files, in chunks too",
    R"(Times are wall times of flaunay triangulate from .npy to .npy, triangles and neighbours, with the operating
system's and the drivers' caches filled by the first run. Those of the same points take turns. Options that begin with
cold: run with empty folders of compiled kernels each time; memory=1G triangulates in chunks. Peaks are of resident
memory. The files take 64 bytes per point, and 24 more for chunks.)",
    measure_processes, [](Options& options, ProcessesRequest& request) {
      options.program("flaunay")
          .add("--folder", request.folder, "the folder for the files; default: that for temporary files")
          .sizes({1000, 1000000})
          .distributions({"uniform"})
          .add("--options", request.choices, "options of the command to compare, such as mode=dwyer")
          .runs(11);
    });

// ---- ranks

struct RanksRequest : Request {
  std::string launcher = "mpirun --oversubscribe";
  std::vector<int> counts{1, 2, 4};
  std::vector<std::size_t> sizes_per_rank{1000000};
};

Outcome run_ranks(const Words& words, const Folder& folder, std::size_t n, int count) {
  constexpr double kPointBytes = 16;
  Outcome outcome;
  const Json statistics = statistics_of(words, folder, outcome);
  const Json &rounds = statistics.at("rounds"), &first = rounds.at(0);
  const auto points = static_cast<double>(n), mean = points / count;
  double cpu_seconds = 0, sent = 0, most_sent = 0, most_bytes = 0;
  for (const Json& rank : statistics.at("ranks")) {
    const auto own = rank.at("bytes_sent").get<double>();
    cpu_seconds += rank.at("cpu_seconds").get<double>();
    sent += own;
    most_sent = std::max(most_sent, own);
    most_bytes = std::max(most_bytes, rank.at("peak_bytes").get<double>());
  }
  outcome.seconds = statistics.at("seconds").at("triangulating");
  outcome.processor_seconds = cpu_seconds;
  outcome.details = {{"rounds", rounds.size()},
                     {"handed_on_percent", handed_on_percent(first, points)},
                     {"bytes_sent_over_own", sent / (kPointBytes * points)},
                     {"most_bytes_sent_over_own", most_sent / (kPointBytes * mean)},
                     {"most_points_over_mean", first.at("most_points_of_a_rank").get<double>() / mean},
                     {"most_bytes_per_point", most_bytes / mean}};
  return outcome;
}

Json targets_of(const RanksRequest& request, const Jobs& jobs) {
  Json targets = Json::array();
  const int most = *std::max_element(request.counts.begin(), request.counts.end());
  for (const std::string& distribution : request.distributions) {
    const Json strong{{"scaling", "strong"}, {"distribution", distribution}};
    const Job *const one = find_job(jobs, changed(strong, {{"ranks", 1}})), *const all = find_job(
                                                                                jobs,
                                                                                changed(strong,
                                                                                        {{"ranks", most}}));
    std::optional<double> over_one;
    if (one != nullptr)
      over_one = summary(all->processor_seconds).median / summary(one->processor_seconds).median;
    const std::string name = fmt::format("{} ranks, {}", most, distribution);
    targets.push_back(target("CPU time over that of one rank", name, 1.3, 1.1, over_one));
    targets.push_back(target("bytes that a rank sends over its points' own", name, 1.2, 1.05,
                             all->details.at("most_bytes_sent_over_own").get<double>()));
    targets.push_back(target("points of the fullest rank over the mean", name, 1.3, 1.1,
                             all->details.at("most_points_over_mean").get<double>()));
  }
  return targets;
}

Result measure_ranks(const RanksRequest& request) {
  const Folder folder;
  const std::string device = request.device.empty() ? "host" : request.device;
  std::istringstream launcher(request.launcher);
  const Words start{std::istream_iterator<std::string>(launcher), {}};
  Jobs jobs;
  const auto add = [&](const char* scaling, const std::string& distribution, std::size_t n, int ranks) {
    Words words = start;
    append(words, {"-n", std::to_string(ranks)});
    append(words,
           triangulate(program_or(request.program, "flaunay-mpi"), folder.write(distribution, n), folder));
    append(words, {"--device", device});
    jobs.push_back({{{"scaling", scaling}, {"distribution", distribution}, {"n", n}, {"ranks", ranks}},
                    [words, &folder, n, ranks] { return run_ranks(words, folder, n, ranks); }});
  };
  for (const std::string& distribution : request.distributions) {
    for (const int ranks : request.counts) {
      for (const std::size_t n : request.sizes) add("strong", distribution, n, ranks);
      for (const std::size_t n : request.sizes_per_rank) {
        add("weak", distribution, n * static_cast<std::size_t>(ranks), ranks);
      }
    }
  }
  // So that more ranks are not fewer threads for each.
  setenv("FLAUNAY_THREADS", "1", 0);
  measure(jobs, request.runs);
  Result result(Triangulator(device).device());
  add_rows(result, jobs);
  result.tables["targets"] = targets_of(request, jobs);
  return result;
}

const Subcommand kRanks(
    "ranks", "flaunay-mpi on several numbers of ranks, strong and weak scaling",
    R"(Times are those of the triangulation, without files. Each rank has one thread unless FLAUNAY_THREADS is set.
Processor times are those of all ranks together, without files. Bytes are those of points and results that ranks send
to others. Needs a build with FLAUNAY_MPI.)",
    measure_ranks, [](Options& options, RanksRequest& request) {
      options.program("flaunay-mpi")
          .add("--launcher", request.launcher, "what starts ranks, with -n for their number")
          .add("--counts", request.counts, "numbers of ranks")
          .sizes({4000000}, "numbers of points, for strong scaling")
          .add("--sizes-per-rank", request.sizes_per_rank, "numbers of points of a rank, for weak scaling")
          .distributions({"uniform", "kuzmin", "line"})
          .runs(3);
    });

}  // namespace
}  // namespace flaunay::bench::processes
