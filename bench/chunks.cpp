// flaunay-bench chunks: triangulations in chunks, as whole processes from file to files.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "command.hpp"
#include "inputs.hpp"
#include "program.hpp"
#include "timing.hpp"

namespace flaunay::bench::chunks {
namespace {

struct Request : Measurement {
  std::string program, folder;
  std::vector<std::size_t> sizes{10000000};
  std::vector<std::string> distributions{"uniform", "kuzmin", "line"};
  std::vector<std::string> memories{"1G"};
  std::size_t in_memory = 10000000;

  std::string command() const { return program.empty() ? beside_this("flaunay") : program; }
};

// A process that is run several times: with a limit of memory, or, if that is empty, without chunks.
struct Run {
  std::string distribution;
  std::size_t n;
  std::string memory;
  std::vector<Spent> spent{};
  Json statistics{};
};

std::vector<std::string> words_of(const Request& request, const Run& run, const Folder& folder) {
  std::vector<std::string> words = {
      request.command(),    "triangulate", folder.file("points.npy"), "--triangles",
      folder.file("t.npy"), "--neighbors", folder.file("n.npy"),      "--stats",
      folder.file("s.json")};
  if (!run.memory.empty()) words.insert(words.end(), {"--memory", run.memory, "--scratch", folder.file("")});
  return words;
}

Json row_of(const Run& run) {
  std::vector<double> seconds, cpu_seconds;
  std::size_t peak = 0;
  for (const Spent& spent : run.spent) {
    seconds.push_back(spent.seconds);
    cpu_seconds.push_back(spent.cpu_seconds);
    peak = std::max(peak, spent.resident_peak);
  }
  Json row = {
      {"distribution", run.distribution}, {"n", run.n}, {"memory", run.memory.empty() ? "all" : run.memory}};
  add_seconds(row, seconds);
  row["points_per_second"] = static_cast<double>(run.n) / summary(seconds).median;
  row["cpu_seconds_median"] = summary(cpu_seconds).median;
  constexpr double kMebibyte = 1 << 20;
  row["resident_peak_mib"] = static_cast<double>(peak) / kMebibyte;
  const auto chunks = run.statistics.find("chunks");
  const bool is_cut = chunks != run.statistics.end();
  row["chunks"] = is_cut ? (*chunks)["number"] : Json();
  row["rounds"] = is_cut ? Json((*chunks)["rounds"].size()) : Json();
  row["handed_on_percent"] = Json();
  if (is_cut) {
    const Json& first = (*chunks)["rounds"].front();
    row["handed_on_percent"] = 100 * first["handed_on"].get<double>() / first["points"].get<double>();
  }
  return row;
}

Result measure_chunks(const Request& request) {
  Result result;
  result.tables["results"] = Json::array();
  const Folder folder(request.folder);
  for (const std::string& distribution : request.distributions) {
    std::vector<std::size_t> sizes = request.sizes;
    if (request.in_memory != 0) sizes.push_back(request.in_memory);
    std::sort(sizes.begin(), sizes.end());
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    for (const std::size_t n : sizes) {
      run_program(
          {request.command(), "generate", distribution, std::to_string(n), "-o", folder.file("points.npy")});
      std::vector<Run> runs;
      const bool is_cut = std::find(request.sizes.begin(), request.sizes.end(), n) != request.sizes.end();
      if (n == request.in_memory) runs.push_back({distribution, n, ""});
      for (const std::string& memory : request.memories) {
        if (is_cut) runs.push_back({distribution, n, memory});
      }
      for (int r = 0; r < request.runs; ++r) {
        for (Run& run : runs) {
          run.spent.push_back(run_program(words_of(request, run, folder)));
          std::ifstream(folder.file("s.json")) >> run.statistics;
        }
      }
      for (const Run& run : runs) result.tables["results"].push_back(row_of(run));
    }
  }
  result.device = Triangulator(request.device).device();
  return result;
}

}  // namespace

void add(CLI::App& app, Action& action) {
  const auto request = std::make_shared<Request>();
  request->runs = 3;
  CLI::App* command = add_command(app, action, "chunks", "triangulations in chunks, from file to files",
                                  "Whole processes of flaunay triangulate from .npy to .npy, triangles and "
                                  "neighbours, with --memory and, for one "
                                  "number of points, without. Those of the same points take turns. Peaks are "
                                  "of resident memory. The files take "
                                  "64 bytes per point, and 24 for chunks.",
                                  request, measure_chunks);
  command->add_option("--program", request->program, "the command; default: flaunay beside this program");
  command->add_option("--folder", request->folder,
                      "the folder for the files; default: that for temporary files");
  add_sizes_option(command, request->sizes);
  add_distributions_option(command, request->distributions);
  add_option(command, "--memory", request->memories, "limits of memory, as for flaunay triangulate");
  command->add_option("--in-memory", request->in_memory, "points of the runs without chunks; 0: none")
      ->capture_default_str();
  add_runs_option(command, request->runs);
}

}  // namespace flaunay::bench::chunks
