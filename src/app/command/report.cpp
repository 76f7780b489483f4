#include "app/command/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "app/command/json.hpp"
#include "files/file.hpp"

namespace flaunay::cli {

using research::kComponents;
using research::LevelStatistics;
using research::OperationCounts;
using research::Work;

namespace {

// Shorter preparations are not mentioned in the final line.
constexpr double kNoticeableSeconds = 0.05;

template <typename AnyStatistics>
double points_per_second(const AnyStatistics& statistics) {
  return statistics.seconds > 0 ? static_cast<double>(statistics.points) / statistics.seconds : 0;
}

double compiling_seconds(const Statistics& statistics, const RunFacts& facts) {
  return facts.compiling_seconds + statistics.build_seconds;
}

std::string counted(std::uint64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string phase_times(const std::vector<PhaseStatistics>& phases, double compiling, const RunFacts& facts) {
  std::string times = fmt::format("reading {:.3f} s", facts.reading_seconds);
  auto out = std::back_inserter(times);
  const auto add_if_noticeable = [&](const char* what, double seconds) {
    if (seconds >= kNoticeableSeconds) fmt::format_to(out, ", {} {:.3f} s", what, seconds);
  };
  add_if_noticeable("preparing the device", facts.opening_seconds);
  add_if_noticeable("compiling kernels", compiling);
  add_if_noticeable("solving", facts.solving_seconds);
  for (const PhaseStatistics& phase : phases) {
    fmt::format_to(out, ", {} {:.3f} s", phase.name, phase.seconds);
  }
  fmt::format_to(out, ", writing {:.3f} s", facts.writing_seconds);
  return times;
}

// The end of every final line.
std::string times_and_speed(const Statistics& statistics, const RunFacts& facts) {
  // Says so when no device was used, since one may have been expected.
  return fmt::format("{}; {}{} in {:.3f} s, {:.0f} points per second\n",
                     phase_times(statistics.phases, compiling_seconds(statistics, facts), facts),
                     facts.what_was_done, statistics.device == "host" ? " on the host" : "",
                     statistics.seconds, points_per_second(statistics));
}

template <typename AnyStatistics>
std::string counts(const AnyStatistics& statistics) {
  return fmt::format("{}, {}, {}, {}", counted(statistics.points, "point", "points"),
                     counted(statistics.duplicates, "duplicate", "duplicates"),
                     counted(statistics.triangles, "triangle", "triangles"),
                     counted(statistics.hull_vertices, "hull vertex", "hull vertices"));
}

std::string constraint_counts(const std::optional<ConstraintFacts>& constraints) {
  if (!constraints) return "";
  std::string text = fmt::format(", {}, {}", counted(constraints->segments, "segment", "segments"),
                                 counted(constraints->edges, "constraint edge", "constraint edges"));
  if (constraints->added_points > 0) {
    text += ", " + counted(constraints->added_points, "added point", "added points");
  }
  if (constraints->sets > 1) text += ", " + counted(constraints->sets, "set", "sets");
  return text;
}

std::uint64_t count_chunks(const ChunkStatistics& statistics) {
  std::uint64_t chunks = 0;
  for (const ChunkRound& round : statistics.rounds) chunks += round.chunks;
  return chunks;
}

Json text_or_null(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json constraints_json(const std::optional<ConstraintFacts>& constraints) {
  if (!constraints) return Json();
  return {{"segments", constraints->segments},
          {"pieces", constraints->pieces},
          {"constraint_edges", constraints->edges},
          {"added_points", constraints->added_points},
          {"holes", constraints->holes},
          {"sets", constraints->sets},
          {"crossings", constraints->crossings},
          {"outside", constraints->outside},
          {"fill", constraints->fill}};
}

// The names of excuses in statistics and in notes, from the first one on.
struct ExcuseNames {
  const char *key, *text;
};
constexpr std::array<ExcuseNames, 7> kExcuses = {{{"input_angle", "between segments at a small angle"},
                                                  {"near_apex", "near a small angle between segments"},
                                                  {"min_edge", "for --min-edge"},
                                                  {"kept", "at an edge that is kept"},
                                                  {"frozen", "at an edge that is too short to be split"},
                                                  {"most_points", "for --most-points"},
                                                  {"most_rounds", "for the limit of rounds"}}};

std::array<std::size_t, kExcuses.size()> count_excuses(const RefinementReport& report) {
  std::array<std::size_t, kExcuses.size()> counts{};
  for (const Excuse excuse : report.excuses) ++counts.at(static_cast<std::size_t>(excuse) - 1);
  return counts;
}

std::string refinement_counts(const std::optional<RefinementReport>& report) {
  if (!report) return "";
  return fmt::format(", angles from {:.2f} to {:.2f} degrees after {}", report->smallest_angle,
                     report->largest_angle, counted(report->rounds, "round", "rounds")) +
         (report->mean_angle > 0 ? fmt::format(", smallest ones {:.2f} on average, {:.2f} before smoothing",
                                               report->mean_angle, report->mean_angle_before)
                                 : "");
}

Json refinement_json(const std::optional<RefinementReport>& report) {
  if (!report) return Json();
  const auto counts = count_excuses(*report);
  Json bad;
  for (std::size_t k = 0; k < counts.size(); ++k) bad[kExcuses[k].key] = counts[k];
  return {{"rounds", report->rounds},
          {"added_points", report->added_points},
          {"split_points", report->split_points},
          {"smallest_angle", report->smallest_angle},
          {"largest_angle", report->largest_angle},
          {"mean_angle", report->mean_angle},
          {"smallest_angle_before", report->smallest_angle_before},
          {"mean_angle_before", report->mean_angle_before},
          {"bad_triangles", bad}};
}

OperationCounts sum_over_levels(const Work& work, std::size_t component) {
  OperationCounts sum = work.start[component];
  for (const Work::Components& level : work.levels) sum += level[component];
  return sum;
}

std::string work_row(const char* name, const OperationCounts& counts, std::size_t points) {
  const auto a_point = [points](std::uint64_t count) {
    return points == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(points);
  };
  return fmt::format("{:<9}  {:>10.1f}  {:>6.1f}  {:>12.1f}  {:>7.1f}  {:>10.1f}  {:>13}\n", name,
                     a_point(counts.arithmetic), a_point(counts.depths), a_point(counts.orientations),
                     a_point(counts.circles), a_point(counts.operations()), counts.critical_path);
}

}  // namespace

std::string summary(const Statistics& statistics, const RunFacts& facts) {
  return fmt::format("{}{}{}; {}", counts(statistics), constraint_counts(facts.constraints),
                     refinement_counts(facts.refinement), times_and_speed(statistics, facts));
}

std::string chunk_summary(const ChunkStatistics& statistics, const RunFacts& facts) {
  return fmt::format("{}; {}; triangulated in {} and {} in {:.3f} s, {:.0f} points per second\n",
                     counts(statistics), phase_times(statistics.phases, 0, facts),
                     counted(count_chunks(statistics), "chunk", "chunks"),
                     counted(statistics.rounds.size(), "round", "rounds"), statistics.seconds,
                     points_per_second(statistics));
}

std::string chunk_statistics_json(const ChunkStatistics& statistics, const RunFacts& facts) {
  Json json;
  json["flaunay"] = version();
  json["mode"] = facts.mode;
  json["input"] = facts.input;
  add_counts(json, statistics);
  json["seconds"] = {{"reading", facts.reading_seconds},
                     {"triangulating", statistics.seconds},
                     {"writing", facts.writing_seconds}};
  json["points_per_second"] = points_per_second(statistics);
  json["undecided_predicates"] = statistics.undecided;
  json["phases"] = phases_json(statistics.phases);
  Json devices = Json::array();
  for (std::size_t k = 0; k < statistics.devices.size(); ++k) {
    devices.push_back({{"device", statistics.devices[k]}, {"points", statistics.device_points.at(k)}});
  }
  json["chunks"] = {{"number", count_chunks(statistics)},
                    {"points", statistics.chunk_points},
                    {"scratch_bytes", statistics.scratch_bytes},
                    {"rounds", list_json(statistics.rounds,
                                         [](const ChunkRound& round) -> Json {
                                           return {{"points", round.points},
                                                   {"chunks", round.chunks},
                                                   {"triangles", round.triangles},
                                                   {"handed_on", round.handed_on}};
                                         })},
                    {"devices", devices},
                    {"host_points", statistics.host_points},
                    {"images", statistics.images}};
  json["note"] = text_or_null(statistics.note);
  return text_of(json);
}

std::string partition_summary(const research::Partition& partition, const RunFacts& facts) {
  std::size_t largest = 0;
  for (const research::Region& region : partition.regions) largest = std::max(largest, region.points.size());
  return fmt::format("{}, {}, {}, the largest of {}, {} finished; {}",
                     counted(partition.statistics.points, "point", "points"),
                     counted(partition.statistics.duplicates, "duplicate", "duplicates"),
                     counted(partition.regions.size(), "region", "regions"),
                     counted(largest, "point", "points"),
                     counted(partition.triangles.size() / 3, "triangle", "triangles"),
                     times_and_speed(partition.statistics, facts));
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

std::string withheld_note(const std::string& input, const io::Points& points) {
  if (points.withheld == 0) return "";
  return io::printable(fmt::format(
             "note: {} marks {} points as withheld; triangles have them, as rows are those of the "
             "file; flaunay terrain leaves them out",
             io::shown_path(input), points.withheld)) +
         "\n";
}

std::string excuses_text(const RefinementReport& report) {
  const auto counts = count_excuses(report);
  std::string text;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counted(counts[k], "triangle", "triangles"),
                        kExcuses[k].text);
  }
  return text;
}

std::string host_note(const std::string& note) { return note.empty() ? "" : "note: " + note + "\n"; }

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

std::string work_table(const research::Triangulation& result) {
  const std::size_t points = result.statistics.points;
  constexpr const char* kNames[kComponents] = {"cut", "hull", "merge", "split", "end game"};
  std::string table = "operations a point by component; the critical path in operations\n";
  fmt::format_to(std::back_inserter(table), "{:<9}  {:>10}  {:>6}  {:>12}  {:>7}  {:>10}  {:>13}\n",
                 "component", "arithmetic", "depths", "orientations", "circles", "operations",
                 "critical path");
  OperationCounts total;
  for (std::size_t c = 0; c < kComponents; ++c) {
    const OperationCounts counts = sum_over_levels(result.work, c);
    table += work_row(kNames[c], counts, points);
    total += counts;
  }
  return table + work_row("total", total, points);
}

std::string statistics_json(const research::Triangulation& result, const RunFacts& facts) {
  const Statistics& statistics = result.statistics;
  Json json;
  json["flaunay"] = version();
  // The keys are always the same; values that a mode does not have are null.
  json["device"] = statistics.device;
  json["note"] = text_or_null(statistics.note.empty() ? facts.compiling_note : statistics.note);
  json["mode"] = facts.mode;
  json["cut"] = text_or_null(facts.cut);
  json["hull_variant"] = text_or_null(facts.dividing_paths);
  json["input"] = facts.input;
  add_counts(json, statistics);
  json["constraints"] = constraints_json(facts.constraints);
  json["refinement"] = refinement_json(facts.refinement);
  json["seconds"] = {{"reading", facts.reading_seconds},
                     {"opening_device", facts.opening_seconds},
                     {"building_programs", compiling_seconds(statistics, facts)},
                     {"solving_regions", facts.solving_seconds},
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
  json["rounds"] = statistics.rounds;
  json["round_points"] = statistics.round_points;
  json["merged_points"] = statistics.merged_points;
  json["phases"] = phases_json(statistics.phases);
  json["levels"] = list_json(result.levels, [](const LevelStatistics& level) -> Json {
    return {{"regions", level.regions},
            {"internal_points", level.internal_points},
            {"corners", level.corners},
            {"largest_region", level.largest_region},
            {"candidates", level.candidates},
            {"survivors", level.survivors},
            {"path_vertices", level.path_vertices},
            {"candidate_rounds", level.candidate_rounds},
            {"hull_rounds", level.hull_rounds},
            {"seconds", level.seconds}};
  });
  if (!statistics.kernels.empty()) {
    json["kernels"] = list_json(statistics.kernels, [](const KernelStatistics& kernel) -> Json {
      return {{"name", kernel.name}, {"launches", kernel.launches}, {"seconds", kernel.seconds}};
    });
  }
  if (facts.counted) {
    const auto components = [](const Work::Components& work) -> Json {
      constexpr const char* kNames[kComponents] = {"cut", "hull", "merge", "split", "endgame"};
      Json named;
      for (std::size_t c = 0; c < kComponents; ++c) {
        named[kNames[c]] = {{"operations", work[c].operations()},
                            {"operations_with_bounds", work[c].operations_with_bounds()},
                            {"arithmetic", work[c].arithmetic},
                            {"depths", work[c].depths},
                            {"orientations", work[c].orientations},
                            {"circles", work[c].circles},
                            {"critical_path", work[c].critical_path}};
      }
      return named;
    };
    json["work"]["start"] = components(result.work.start);
    json["work"]["levels"] = list_json(result.work.levels, components);
    json["work"]["endgame_sizes"] = result.work.endgame_sizes;
  }
  return text_of(json);
}

}  // namespace flaunay::cli
