// flaunay-bench: times whole triangulations, points in memory to triangles and neighbours in memory. Runs of
// all inputs are interleaved, so that a machine's changing speed meets all of them alike; medians are to be
// quoted.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "io/generate.hpp"

namespace {

struct Input {
  std::string distribution;
  std::size_t n;
  flaunay::io::Points points;
  std::vector<double> seconds;
  flaunay::Statistics statistics;
};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Times flaunay on generated points; the first run of each input is not counted."};
  std::vector<std::string> distributions{"uniform", "normal", "kuzmin", "line"};
  std::vector<std::size_t> sizes{1000000};
  int runs = 5;
  std::string device, json_path;
  app.add_option("--distributions", distributions, "which (see flaunay generate --help)")->delimiter(',');
  app.add_option("--sizes", sizes, "numbers of points")->delimiter(',');
  app.add_option("--runs", runs, "counted runs of each input")->check(CLI::PositiveNumber);
  app.add_option("--device", device, "device, as for flaunay triangulate");
  app.add_option("--json", json_path, "write the results here");
  CLI11_PARSE(app, argc, argv);
  try {
    flaunay::Triangulator triangulator(device);
    std::vector<Input> inputs;
    for (const std::size_t n : sizes) {
      for (const std::string& distribution : distributions) {
        inputs.push_back({distribution, n, flaunay::io::generate(distribution, n, 1), {}, {}});
      }
    }
    for (int run = 0; run <= runs; ++run) {
      for (Input& input : inputs) {
        const double begin = now();
        auto mesh = triangulator.triangulate(input.points.coordinates.data(), input.n);
        if (run > 0) input.seconds.push_back(now() - begin);
        input.statistics = std::move(mesh.statistics);
      }
    }
    nlohmann::json results = nlohmann::json::array();
    fmt::print("{:<16} {:>9} {:>9} {:>9} {:>9} {:>7} {:>9} {:>6} {:>7} {:>6}\n", "distribution", "n",
               "median s", "min s", "max s", "ns/pt", "launches", "waits", "bytes/p", "levels");
    for (const Input& input : inputs) {
      const double middle = median(input.seconds);
      const auto [least, most] = std::minmax_element(input.seconds.begin(), input.seconds.end());
      const auto& s = input.statistics;
      fmt::print("{:<16} {:>9} {:>9.4f} {:>9.4f} {:>9.4f} {:>7.0f} {:>9} {:>6} {:>7.0f} {:>6}\n",
                 input.distribution, input.n, middle, *least, *most,
                 1e9 * middle / static_cast<double>(input.n), s.kernel_launches, s.host_waits,
                 static_cast<double>(s.device_bytes_peak) / static_cast<double>(input.n), s.levels.size());
      int candidate_rounds = 0, hull_rounds = 0, most_rounds = 0;
      for (const auto& level : s.levels) {
        candidate_rounds += level.candidate_rounds;
        hull_rounds += level.hull_rounds;
        most_rounds = std::max({most_rounds, level.candidate_rounds, level.hull_rounds});
      }
      results.push_back({{"implementation", "flaunay-flattened"},
                         {"distribution", input.distribution},
                         {"n", input.n},
                         {"seconds_median", middle},
                         {"seconds_min", *least},
                         {"seconds_max", *most},
                         {"bytes_peak", s.device_bytes_peak},
                         {"triangles", s.triangles},
                         {"levels", s.levels.size()},
                         {"candidate_rounds", candidate_rounds},
                         {"hull_rounds", hull_rounds},
                         {"rounds_most", most_rounds},
                         {"kernel_launches", s.kernel_launches},
                         {"host_waits", s.host_waits}});
    }
    if (!json_path.empty()) {
      std::string command = "flaunay-bench";
      for (int i = 1; i < argc; ++i) command += fmt::format(" {}", argv[i]);
      const flaunay::DeviceInfo info = triangulator.device();
      std::ofstream(json_path) << nlohmann::json{{"device", info.name},       {"driver", info.driver},
                                                 {"platform", info.platform}, {"commit", FLAUNAY_COMMIT},
                                                 {"command", command},        {"runs", runs},
                                                 {"results", results}}
                                      .dump(2)
                               << "\n";
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "flaunay-bench: {}\n", error.what());
    return 1;
  }
  return 0;
}
