// flaunay-bench processes, chunks and ranks: the programs as whole processes, from file to files.
#include "bench/measuring/processes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "bench/measuring/inputs.hpp"
#include "bench/measuring/timing.hpp"

namespace flaunay::bench::processes {
namespace {

using Words = std::vector<std::string>;

/// To triangles and neighbours.
Words triangulate(const std::string& program, const std::string& points, const Folder& folder) {
  return {program,       "triangulate",       points, "--triangles", folder.file("t.npy"),
          "--neighbors", folder.file("n.npy")};
}

double sum_of(const Json& rows, const char* key) {
  double sum = 0;
  for (const Json& row : rows) sum += row.at(key).get<double>();
  return sum;
}

double most_of(const Json& rows, const char* key) {
  double most = 0;
  for (const Json& row : rows) most = std::max(most, row.at(key).get<double>());
  return most;
}

/// A process that is run several times.
struct Run {
  Json row;
  Words words;
  std::vector<ProcessUse> uses = {};
  Json statistics = {};  ///< of the last

  void once(const Folder& folder) {
    uses.push_back(run_program(words));
    std::ifstream(folder.file("s.json")) >> statistics;
  }
  std::vector<double> all(double ProcessUse::*member) const {
    std::vector<double> values;
    for (const ProcessUse& use : uses) values.push_back(use.*member);
    return values;
  }
};

// ---- processes

// Before an option: with no kernels that were compiled before.
constexpr std::string_view kCold = "cold:";

struct ProcessesRequest : Request {
  Words choices{"default", "device=host", "device=#0", "cold:device=#0", "mode=dwyer"};
};

double run_timed(Words words, bool is_cold) {
  const Folder empty;
  if (is_cold) {
    // flaunay's and PoCL's.
    const Words cold = {"env", "FLAUNAY_CACHE_DIR=" + empty.file("a"), "POCL_CACHE_DIR=" + empty.file("b")};
    for (const char* name : {"a", "b"}) std::filesystem::create_directory(empty.file(name));
    words.insert(words.begin(), cold.begin(), cold.end());
  }
  return run_program(words).seconds;
}

Result measure_processes(const ProcessesRequest& request) {
  const Folder folder;
  std::vector<Job> jobs;
  for (const std::size_t n : request.sizes) {
    const std::string points = folder.write(fmt::format("{}.npy", n), "uniform", n);
    for (const std::string& choice : request.choices) {
      Words words = triangulate(program_or(request.program, "flaunay"), points, folder);
      const bool is_cold = choice.compare(0, kCold.size(), kCold) == 0;
      const std::string option = is_cold ? choice.substr(kCold.size()) : choice;
      if (option != "default") {
        const std::size_t equals = std::min(option.find('='), option.size());
        words.push_back("--" + option.substr(0, equals));
        if (equals < option.size()) words.push_back(option.substr(equals + 1));
      }
      jobs.push_back({{{"option", choice}, {"distribution", "uniform"}, {"n", n}},
                      [words, is_cold] { return run_timed(words, is_cold); }});
    }
  }
  run_interleaved(pointers_to(jobs), request.runs);
  Result result;
  for (Job& job : jobs) {
    if (job.skipped.empty()) {
      add_seconds(job.row, job.seconds);
    } else {
      job.row["skipped"] = job.skipped;
      result.agree = false;
    }
  }
  result.tables["results"] = rows_of(jobs);
  result.device = Triangulator(request.device).device();
  return result;
}

const Subcommand kProcesses("processes", "the command as whole processes, from start to end",
                            "Times are wall times of flaunay triangulate from .npy to .npy, triangles and "
                            "neighbours, with the operating "
                            "system's and the drivers' caches filled by a first run that is not counted. All "
                            "take turns. Options that "
                            "begin with cold: run with empty folders of compiled kernels each time.",
                            measure_processes, [](Options& options, ProcessesRequest& request) {
                              options.program("flaunay")
                                  .sizes({1000, 1000000})
                                  .add("--options", request.choices,
                                       "options of the command to compare, such as mode=dwyer")
                                  .runs(11);
                            });

// ---- chunks

struct ChunksRequest : Request {
  std::string folder;
  Words memories{"1G"};
  std::size_t in_memory = 10000000;
};

void complete(Run& run) {
  std::size_t peak = 0;
  for (const ProcessUse& use : run.uses) peak = std::max(peak, use.resident_peak);
  Json& row = run.row;
  add_seconds(row, run.all(&ProcessUse::seconds));
  row["points_per_second"] = row["n"].get<double>() / row["seconds_median"].get<double>();
  row["cpu_seconds_median"] = summary(run.all(&ProcessUse::cpu_seconds)).median;
  row["resident_peak_mib"] = static_cast<double>(peak) / (1 << 20);
  for (const char* key : {"chunks", "rounds", "handed_on_percent"}) row[key] = Json();
  const auto chunks = run.statistics.find("chunks");
  if (chunks == run.statistics.end()) return;
  const Json& rounds = (*chunks)["rounds"];
  row["chunks"] = (*chunks)["number"];
  row["rounds"] = rounds.size();
  row["handed_on_percent"] =
      100 * rounds.front()["handed_on"].get<double>() / rounds.front()["points"].get<double>();
}

Result measure_chunks(const ChunksRequest& request) {
  Result result;
  const Folder folder(request.folder);
  const std::string program = program_or(request.program, "flaunay"), points = folder.file("points.npy");
  std::vector<std::size_t> sizes = request.sizes;
  if (request.in_memory != 0) sizes.push_back(request.in_memory);
  std::sort(sizes.begin(), sizes.end());
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  for (const std::string& distribution : request.distributions) {
    for (const std::size_t n : sizes) {
      run_program({program, "generate", distribution, std::to_string(n), "-o", points});
      // Without chunks, and with limits of memory.
      Words memories = n == request.in_memory ? Words{"all"} : Words{};
      if (std::count(request.sizes.begin(), request.sizes.end(), n) > 0) append(memories, request.memories);
      std::vector<Run> runs;
      for (const std::string& memory : memories) {
        Words words = triangulate(program, points, folder);
        append(words, {"--stats", folder.file("s.json")});
        if (memory != "all") append(words, {"--memory", memory, "--scratch", folder.file("")});
        runs.push_back({{{"distribution", distribution}, {"n", n}, {"memory", memory}}, words});
      }
      for (int r = 0; r < request.runs; ++r) {
        for (Run& run : runs) run.once(folder);
      }
      for (Run& run : runs) {
        complete(run);
        result.tables["results"].push_back(run.row);
      }
    }
  }
  result.device = Triangulator(request.device).device();
  return result;
}

const Subcommand kChunks(
    "chunks", "triangulations in chunks, from file to files",
    "Whole processes of flaunay triangulate from .npy to .npy, triangles and neighbours, with --memory and, "
    "for "
    "one number of points, without. Those of the same points take turns. Peaks are of resident memory. The "
    "files "
    "take 64 bytes per point, and 24 for chunks.",
    measure_chunks, [](Options& options, ChunksRequest& request) {
      options.program("flaunay")
          .add("--folder", request.folder, "the folder for the files; default: that for temporary files")
          .sizes({10000000})
          .distributions({"uniform", "kuzmin", "line"})
          .add("--memory", request.memories, "limits of memory, as for flaunay triangulate")
          .add("--in-memory", request.in_memory, "points of the runs without chunks; 0: none", kAny)
          .runs(3);
    });

// ---- ranks

struct RanksRequest : Request {
  std::string launcher = "mpirun --oversubscribe";
  std::vector<int> counts{1, 2, 4};
  std::vector<std::size_t> sizes_per_rank{1000000};
};

void complete_of_ranks(Run& run, const std::vector<double>& seconds, const std::vector<double>& cpu_seconds) {
  constexpr double kPointBytes = 16;
  Json& row = run.row;
  add_seconds(row, seconds);
  const Json &rounds = run.statistics.at("rounds"), &ranks = run.statistics.at("ranks");
  const auto n = row["n"].get<double>(), count = row["ranks"].get<double>();
  row["cpu_seconds"] = summary(cpu_seconds).median;
  row["rounds"] = rounds.size();
  row["handed_on_percent"] = 100 * rounds.at(0).at("handed_on").get<double>() / n;
  row["bytes_sent_over_own"] = sum_of(ranks, "bytes_sent") / (kPointBytes * n);
  row["most_bytes_sent_over_own"] = most_of(ranks, "bytes_sent") * count / (kPointBytes * n);
  row["most_points_over_mean"] = rounds.at(0).at("most_points_of_a_rank").get<double>() * count / n;
  row["most_bytes_per_point"] = most_of(ranks, "peak_bytes") * count / n;
}

Json targets_of(const RanksRequest& request, const Json& rows) {
  Json targets = Json::array();
  const int most = *std::max_element(request.counts.begin(), request.counts.end());
  for (const std::string& distribution : request.distributions) {
    const auto of = [&](int ranks, const char* key) -> std::optional<double> {
      for (const Json& row : rows) {
        const bool is_it =
            row["scaling"] == "strong" && row["distribution"] == distribution && row["ranks"] == ranks;
        if (is_it) return row.at(key).get<double>();
      }
      return {};
    };
    const std::string name = fmt::format("{} ranks, {}", most, distribution);
    targets.push_back(target("CPU time over that of one rank", name, 1.3, 1.1,
                             ratio(of(most, "cpu_seconds"), of(1, "cpu_seconds"))));
    targets.push_back(target("bytes that a rank sends over its points' own", name, 1.2, 1.05,
                             of(most, "most_bytes_sent_over_own")));
    targets.push_back(target("points of the fullest rank over the mean", name, 1.3, 1.1,
                             of(most, "most_points_over_mean")));
  }
  return targets;
}

Result measure_ranks(const RanksRequest& request) {
  const Folder folder;
  const std::string device = request.device.empty() ? "host" : request.device;
  std::istringstream launcher(request.launcher);
  const Words start{std::istream_iterator<std::string>(launcher), {}};
  std::vector<Run> runs;
  const auto add = [&](const char* scaling, const std::string& distribution, std::size_t n, int ranks) {
    Words words = start;
    append(words, {"-n", std::to_string(ranks)});
    append(words,
           triangulate(program_or(request.program, "flaunay-mpi"),
                       folder.write(fmt::format("{}-{}.npy", distribution, n), distribution, n), folder));
    append(words, {"--stats", folder.file("s.json"), "--device", device});
    runs.push_back(
        {{{"scaling", scaling}, {"distribution", distribution}, {"n", n}, {"ranks", ranks}}, words});
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
  std::vector<std::vector<double>> seconds(runs.size()), cpu_seconds(runs.size());
  for (int r = 0; r < request.runs; ++r) {
    for (std::size_t k = 0; k < runs.size(); ++k) {
      runs[k].once(folder);
      seconds[k].push_back(runs[k].statistics.at("seconds").at("triangulating"));
      cpu_seconds[k].push_back(sum_of(runs[k].statistics.at("ranks"), "cpu_seconds"));
    }
  }
  Result result(Triangulator(device).device());
  for (std::size_t k = 0; k < runs.size(); ++k) {
    complete_of_ranks(runs[k], seconds[k], cpu_seconds[k]);
    result.tables["results"].push_back(runs[k].row);
  }
  result.tables["targets"] = targets_of(request, result.tables["results"]);
  return result;
}

const Subcommand kRanks(
    "ranks", "flaunay-mpi on several numbers of ranks, strong and weak scaling",
    "Times are those of the triangulation, without files. Each rank has one thread unless FLAUNAY_THREADS is "
    "set. CPU time is that of all ranks together. Bytes are those of points and results that ranks send to "
    "others. Needs a build with FLAUNAY_MPI.",
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
