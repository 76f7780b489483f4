// flaunay-bench ranks: flaunay-mpi on several numbers of ranks, on the same points (strong scaling) and on as
// many points for each rank (weak scaling).
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

#include "app/files/points.hpp"
#include "command.hpp"
#include "files/output.hpp"
#include "inputs.hpp"
#include "program.hpp"
#include "timing.hpp"

namespace flaunay::bench::ranks {
namespace {

constexpr double kPointBytes = 16;

struct Request : Measurement {
  std::string program, launcher = "mpirun --oversubscribe";
  std::vector<int> counts{1, 2, 4};
  std::vector<std::size_t> sizes{4000000}, sizes_per_rank{1000000};
  std::vector<std::string> distributions{"uniform", "kuzmin", "line"};
};

/// A number of ranks on an input.
struct Case {
  std::string scaling, distribution, points;
  std::size_t n;
  int ranks;
  std::vector<double> seconds = {}, cpu_seconds = {};
  Json statistics = {};  ///< of the last run
};

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

double sum_of(const Json& ranks, const char* key) {
  double sum = 0;
  for (const Json& rank : ranks) sum += rank.at(key).get<double>();
  return sum;
}

double most_of(const Json& ranks, const char* key) {
  double most = 0;
  for (const Json& rank : ranks) most = std::max(most, rank.at(key).get<double>());
  return most;
}

/// Runs it once, and returns the seconds of the triangulation without files.
double run_case(const Request& request, const Folder& folder, Case& each) {
  std::vector<std::string> words = words_of(request.launcher);
  const std::string stats = folder.file("stats.json");
  const std::string program = request.program.empty() ? beside_this("flaunay-mpi") : request.program;
  for (const std::string& word :
       {std::string("-n"), std::to_string(each.ranks), program, std::string("triangulate"), each.points,
        std::string("--triangles"), folder.file("t.npy"), std::string("--neighbors"), folder.file("n.npy"),
        std::string("--stats"), stats, std::string("--device"), request.device}) {
    words.push_back(word);
  }
  run_program(words);
  std::ifstream file(stats);
  each.statistics = Json::parse(file);
  each.cpu_seconds.push_back(sum_of(each.statistics.at("ranks"), "cpu_seconds"));
  return each.statistics.at("seconds").at("triangulating");
}

Json row_of(const Case& each) {
  Json row{
      {"scaling", each.scaling}, {"distribution", each.distribution}, {"n", each.n}, {"ranks", each.ranks}};
  add_seconds(row, each.seconds);
  const Json &rounds = each.statistics.at("rounds"), &ranks = each.statistics.at("ranks");
  const auto n = static_cast<double>(each.n);
  row["cpu_seconds"] = summary(each.cpu_seconds).median;
  row["rounds"] = rounds.size();
  row["handed_on_percent"] = 100 * rounds.at(0).at("handed_on").get<double>() / n;
  row["bytes_sent_over_own"] = sum_of(ranks, "bytes_sent") / (kPointBytes * n);
  row["most_bytes_sent_over_own"] = most_of(ranks, "bytes_sent") * each.ranks / (kPointBytes * n);
  row["most_points_over_mean"] = rounds.at(0).at("most_points_of_a_rank").get<double>() * each.ranks / n;
  row["most_bytes_per_point"] = most_of(ranks, "peak_bytes") * each.ranks / n;
  return row;
}

std::optional<double> number(const Json& rows, const char* scaling, const std::string& distribution,
                             int ranks, const char* key) {
  for (const Json& row : rows) {
    if (row.at("scaling") == scaling && row.at("distribution") == distribution && row.at("ranks") == ranks)
      return row.at(key).get<double>();
  }
  return std::nullopt;
}

Json targets_of(const Request& request, const Json& rows) {
  Json targets = Json::array();
  const int most = *std::max_element(request.counts.begin(), request.counts.end());
  const auto of = [&](const std::string& distribution, int ranks, const char* key) {
    return number(rows, "strong", distribution, ranks, key);
  };
  for (const std::string& distribution : request.distributions) {
    const std::string name = fmt::format("{} ranks, {}", most, distribution);
    targets.push_back(
        target("CPU time over that of one rank", name, 1.3, 1.1,
               ratio(of(distribution, most, "cpu_seconds"), of(distribution, 1, "cpu_seconds"))));
    targets.push_back(target("bytes that a rank sends over its points' own", name, 1.2, 1.05,
                             of(distribution, most, "most_bytes_sent_over_own")));
    targets.push_back(target("points of the fullest rank over the mean", name, 1.3, 1.1,
                             of(distribution, most, "most_points_over_mean")));
  }
  return targets;
}

Result measure_ranks(const Request& given) {
  Request request = given;
  if (request.device.empty()) request.device = "host";
  const Folder folder;
  std::vector<Case> cases;
  const auto add = [&](const std::string& scaling, const std::string& distribution, std::size_t n,
                       int ranks) {
    const std::string points = folder.file(fmt::format("{}-{}.npy", distribution, n));
    if (!std::filesystem::exists(points)) {
      io::Outputs outputs;
      io::write_points(outputs, points, {make_input(distribution, n).coordinates});
      outputs.commit();
    }
    cases.push_back({scaling, distribution, points, n, ranks});
  };
  for (const std::string& distribution : request.distributions) {
    for (const int ranks : request.counts) {
      for (const std::size_t n : request.sizes) add("strong", distribution, n, ranks);
      for (const std::size_t n : request.sizes_per_rank)
        add("weak", distribution, n * static_cast<std::size_t>(ranks), ranks);
    }
  }
  // So that more ranks are not fewer threads for each.
  setenv("FLAUNAY_THREADS", "1", 0);
  for (int run = 0; run < request.runs; ++run) {
    for (Case& each : cases) each.seconds.push_back(run_case(request, folder, each));
  }
  Result result;
  result.tables["results"] = Json::array();
  for (const Case& each : cases) result.tables["results"].push_back(row_of(each));
  result.tables["targets"] = targets_of(request, result.tables["results"]);
  result.device = Triangulator(request.device).device();
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  request->runs = 3;
  CLI::App* command =
      add_command(app, action, "ranks", "flaunay-mpi on several numbers of ranks, strong and weak scaling",
                  "Times are those of the triangulation, without files. Each rank has one thread unless "
                  "FLAUNAY_THREADS is set. "
                  "CPU time is that of all ranks together. Bytes are those of points and results that ranks "
                  "send to others. Needs "
                  "a build with FLAUNAY_MPI.",
                  request, measure_ranks);
  command->add_option("--program", request->program, "default: flaunay-mpi beside this program");
  command->add_option("--launcher", request->launcher, "what starts ranks, with -n for their number")
      ->capture_default_str();
  add_option(command, "--counts", request->counts, "numbers of ranks");
  add_sizes_option(command, request->sizes, "numbers of points, for strong scaling");
  add_option(command, "--sizes-per-rank", request->sizes_per_rank,
             "numbers of points of a rank, for weak scaling");
  add_distributions_option(command, request->distributions);
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::ranks
