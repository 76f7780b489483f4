#include "cli/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace flaunay::cli {

namespace {

// Below this, preparing the device is not worth mentioning.
constexpr double kNoticeableSeconds = 0.05;

double points_per_second(const Statistics& statistics) {
  return statistics.seconds > 0 ? static_cast<double>(statistics.points) / statistics.seconds : 0;
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace

std::string summary(const Statistics& statistics, const RunFacts& facts) {
  std::string times = fmt::format("reading {:.3f} s", facts.reading_seconds);
  auto out = std::back_inserter(times);
  if (statistics.build_seconds >= kNoticeableSeconds) {
    fmt::format_to(out, ", compiling kernels {:.3f} s", statistics.build_seconds);
  }
  for (const PhaseStatistics& phase : statistics.phases) {
    fmt::format_to(out, ", {} {:.3f} s", phase.name, phase.seconds);
  }
  fmt::format_to(out, ", writing {:.3f} s", facts.writing_seconds);
  return fmt::format("{}, {}, {}, {}; {}; triangulated in {:.3f} s, {:.0f} points per second\n",
                     counted(statistics.points, "point", "points"),
                     counted(statistics.duplicates, "duplicate", "duplicates"),
                     counted(statistics.triangles, "triangle", "triangles"),
                     counted(statistics.hull_vertices, "hull vertex", "hull vertices"), times,
                     statistics.seconds, points_per_second(statistics));
}

std::string degenerate_note(const Statistics& statistics) {
  if (statistics.triangles > 0) return "";
  const std::size_t distinct = statistics.points - statistics.duplicates;
  if (distinct == 0) return "note: no points, so no triangles\n";
  if (distinct == 1) return "note: only one distinct point: no triangles; the hull is that point\n";
  if (distinct == 2) return "note: only two distinct points: no triangles; the hull is those, in order\n";
  return fmt::format(
      "note: all {} distinct points are on one line: no triangles; the hull is those, in order\n", distinct);
}

std::string kernel_table(const Statistics& statistics) {
  std::vector<KernelStatistics> kernels = statistics.kernels;
  std::stable_sort(kernels.begin(), kernels.end(),
                   [](const auto& a, const auto& b) { return a.seconds > b.seconds; });
  std::size_t width = 6;
  double total = 0;
  for (const KernelStatistics& kernel : kernels) {
    width = std::max(width, kernel.name.size());
    total += kernel.seconds;
  }
  std::string table =
      fmt::format("{:<{}}  {:>9}  {:>9}  {:>6}\n", "kernel", width, "launches", "ms", "share");
  for (const KernelStatistics& kernel : kernels) {
    fmt::format_to(std::back_inserter(table), "{:<{}}  {:>9}  {:>9.3f}  {:>5.1f}%\n", kernel.name, width,
                   kernel.launches, 1e3 * kernel.seconds, total > 0 ? 100 * kernel.seconds / total : 0);
  }
  return table;
}

std::string statistics_json(const Statistics& statistics, const RunFacts& facts) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["flaunay"] = version();
  json["device"] = statistics.device;
  json["mode"] = facts.mode;
  json["cut"] = facts.cut;
  json["input"] = facts.input;
  json["points"] = statistics.points;
  json["duplicates"] = statistics.duplicates;
  json["triangles"] = statistics.triangles;
  json["hull_vertices"] = statistics.hull_vertices;
  json["seconds"] = {{"reading", facts.reading_seconds},
                     {"opening_device", facts.opening_seconds},
                     {"building_programs", statistics.build_seconds},
                     {"triangulating", statistics.seconds},
                     {"writing", facts.writing_seconds}};
  json["points_per_second"] = points_per_second(statistics);
  json["kernel_launches"] = statistics.kernel_launches;
  json["host_waits"] = statistics.host_waits;
  json["device_bytes_peak"] = statistics.device_bytes_peak;
  json["device_bytes_per_point"] =
      statistics.points == 0
          ? 0.0
          : static_cast<double>(statistics.device_bytes_peak) / static_cast<double>(statistics.points);
  json["undecided_predicates"] = statistics.undecided;
  json["phases"] = Json::array();
  for (const PhaseStatistics& phase : statistics.phases) {
    json["phases"].push_back({{"name", phase.name}, {"seconds", phase.seconds}});
  }
  json["levels"] = Json::array();
  for (const LevelStatistics& level : statistics.levels) {
    json["levels"].push_back({{"regions", level.regions},
                              {"internal_points", level.internal_points},
                              {"corners", level.corners},
                              {"largest_region", level.largest_region},
                              {"candidates", level.candidates},
                              {"survivors", level.survivors},
                              {"path_vertices", level.path_vertices},
                              {"candidate_rounds", level.candidate_rounds},
                              {"hull_rounds", level.hull_rounds},
                              {"seconds", level.seconds}});
  }
  if (!statistics.kernels.empty()) {
    json["kernels"] = Json::array();
    for (const KernelStatistics& kernel : statistics.kernels) {
      json["kernels"].push_back(
          {{"name", kernel.name}, {"launches", kernel.launches}, {"seconds", kernel.seconds}});
    }
  }
  // Names of files need not be UTF-8, JSON must.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace flaunay::cli
